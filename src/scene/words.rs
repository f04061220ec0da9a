//! A scene in words: the sentences of `moorline check`.
//!
//! The given properties are written by a loop over the property table ([`given`]); each value describes itself ([`super::table::Value::in_words`]).
//! The modules here write the sentences on consequences of several keys, and on effects that are not modelled.

mod line_types;
mod lines;
mod points;
mod surroundings;

pub(super) use points::motion_in_words;

use super::channel::Channel;
use super::check::{number, quantity, rounded};
use super::table::{Choice, Kind, Table};
use super::{ForceOutput, Format, Frames, Integrator, InterfaceOutput, Output, Reconstruction, Scene};

/// Maximum width of the text, in characters.
const WIDTH: usize = 110;

/// Sentence on the relation of the tensions among the channels to the variables of a line.
const TENSIONS_OF_CHANNELS: &str = "tensions among them are those of MoorDyn: at an end (FairTen, AnchTen), the magnitude of the force on the \
     point with the weight and drag of half a segment; at an inner node, the mean of both segments; `tension_a` and `tension_b` of a line \
     include the inertia of the half segment too";

impl Scene {
    /// Describes the scene in sentences, with one line per line type, vessel, point and line.
    pub fn in_words(&self) -> String {
        let mut text = String::new();
        if !self.title.is_empty() {
            paragraph(&mut text, "", &self.title);
        }
        section(&mut text, "environment", self.surroundings_in_words());
        let types = self.line_types.iter();
        let types = types.map(|(name, kind)| self.line_type_in_words(name, kind));
        section(&mut text, "line types", types);
        let vessels = self.vessels.iter().map(|vessel| self.vessel_in_words(vessel));
        section(&mut text, "vessels", vessels);
        let points = self.points.iter().map(|point| self.point_in_words(point));
        section(&mut text, "points", points);
        section(
            &mut text,
            "lines",
            self.lines.iter().map(|line| self.line_in_words(line)),
        );
        section(&mut text, "solution", self.solution_in_words());
        section(&mut text, "not modelled", [self.absences().join("; ")]);
        text
    }

    fn solution_in_words(&self) -> Vec<String> {
        let (solver, output) = (&self.solver, &self.output);
        let of_cables = match solver.negative_tension {
            true => {
                "axial damping acts in compression and stiffness does not: tension may be negative, as in other codes"
            }
            false => self.compression_in_words(),
        };
        let compression = match self.lines.iter().any(|line| self.is_beam(line)) {
            true if self.all_beams() => "beams carry compression as well as tension".to_string(),
            true => format!("{of_cables}, except for beams, which carry compression as well as tension"),
            false => of_cables.to_string(),
        };
        let nodes = if output.profile.is_given() {
            " of all nodes"
        } else {
            ""
        };
        let tables = tables_in_words(output);
        let [duration, interval] = [output.duration, output.interval].map(|time| quantity(time, "s"));
        let inputs = match solver.input_reconstruction {
            Reconstruction::Smooth => None,
            Reconstruction::Jump => {
                Some("coupled points jump to the positions given by the host".to_string())
            }
            Reconstruction::Interpolate => {
                Some("inputs of the host apply at the end of its step".to_string())
            }
            Reconstruction::Filtered => Some("displacements given by the host are filtered".to_string()),
        };
        let channels = (!output.channels.is_empty())
            .then(|| format!("additional columns of `run`: {}", output.channels.join(", ")));
        let tensions = output.channels.iter().any(|name| Channel::is_tension(name));
        let always = [
            self.integrator_in_words(),
            format!(
                "target error of {}: {}",
                solver.tolerance_of.in_words(),
                percent(solver.tolerance)
            ),
            compression,
            format!("`run` simulates {duration}, with output{nodes} every {interval}{tables}"),
        ];
        let balance = output
            .energy_balance
            .then(|| "the energy balance is evaluated".to_string());
        let tensions = tensions.then(|| TENSIONS_OF_CHANNELS.to_string());
        let rest = [inputs, balance, channels, tensions].into_iter().flatten();
        let rest = rest.chain(interface_in_words(output).map(str::to_string));
        always.into_iter().chain(rest).collect()
    }

    fn integrator_in_words(&self) -> String {
        let integrator = match self.solver.integrator {
            Integrator::QuasiStatic => {
                let slides = self.seabed.as_ref().is_some_and(|seabed| seabed.friction.acts());
                let drag = self.current().map_or("", |_| " except that of the current");
                let laid = if slides {
                    ", with its own seabed friction"
                } else {
                    ""
                };
                return format!(
                    "quasi-static: an equilibrium at every output{laid}, no inertia, no drag{drag}"
                );
            }
            Integrator::Auto => "automatic choice of the integrator".to_string(),
            other => format!("integrator {}", other.word()),
        };
        let step = quantity(self.solver.time_step_max, "s");
        format!("{integrator}, time steps up to {step}")
    }

    /// Effects that are not modelled.
    fn absences(&self) -> Vec<String> {
        let bending = (!self.all_beams()).then(|| self.absence_of_bending());
        let water = match &self.water {
            Some(_) => self.absences_of_water(),
            None => "buoyancy, drag and added mass".to_string(),
        };
        let seabed = match &self.seabed {
            Some(seabed) => (!seabed.friction.acts()).then_some("friction on the seabed"),
            None => Some("contact with a seabed"),
        };
        let still = self.solver.integrator == Integrator::QuasiStatic;
        let rest = [
            seabed,
            Some("contact of lines with each other"),
            still.then_some("inertia and damping"),
        ];
        let rest = rest.into_iter().flatten().map(str::to_string);
        bending.into_iter().chain([water]).chain(rest).collect()
    }
}

/// The given properties of a table in words, except those in `left_out`: "mass 126 kg/m".
fn given<T: Table>(table: &T, left_out: &[&str]) -> Vec<String> {
    let defaults = (T::SCHEMA.defaults)();
    let entries = table.entries().zip(defaults);
    let changed = entries.filter_map(|((key, value), default)| {
        let is_default = matches!(key.kind(), Kind::Words(_)) && value.write() == default;
        (!is_default && !left_out.contains(&key.name())).then_some((key, value))
    });
    changed
        .filter_map(|(key, value)| Some(format!("{} {}", key.label(), value.in_words(key)?)))
        .collect()
}

/// The given properties of a table within a table, in words: "(damping ratios 0.1 and 0.1, circular frequencies 1 and 9 rad/s)".
pub(super) fn group<T: Table>(table: &T) -> String {
    format!("({})", given(table, &[]).join(", "))
}

/// "a, b and c".
fn join<T: AsRef<str>>(parts: &[T]) -> String {
    let parts: Vec<&str> = parts.iter().map(AsRef::as_ref).collect();
    match parts[..] {
        [] => String::new(),
        [one] => one.to_string(),
        [ref first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// The first names of a list: "a, b, c and 4 more".
pub(crate) fn few(names: &[&str]) -> String {
    const SHOWN: usize = 3;
    let first = names[..names.len().min(SHOWN)].join(", ");
    match names.len().saturating_sub(SHOWN) {
        0 => first,
        more => format!("{first} and {more} more"),
    }
}

/// "(1, 0, 0)".
fn triple(values: [f64; 3]) -> String {
    let [x, y, z] = values.map(number);
    format!("({x}, {y}, {z})")
}

/// Appends a heading and its entries, or nothing if there are no entries.
fn section(text: &mut String, heading: &str, entries: impl IntoIterator<Item = String>) {
    for (i, entry) in entries.into_iter().enumerate() {
        if i == 0 {
            *text += &format!("{heading}\n");
        }
        paragraph(text, "  ", &entry);
    }
}

/// Appends a sentence, broken into lines at spaces.
pub(super) fn paragraph(text: &mut String, indent: &str, sentence: &str) {
    let mut width = 0;
    for word in sentence.split(' ') {
        let length = word.chars().count();
        if width == 0 {
            text.push_str(indent);
            width = indent.len();
        } else if width + 1 + length > WIDTH {
            text.push('\n');
            text.push_str(indent);
            text.push_str("    ");
            width = indent.len() + 4;
        } else {
            text.push(' ');
            width += 1;
        }
        text.push_str(word);
        width += length;
    }
    text.push('\n');
}

/// A number with five significant digits, enough to recognise it.
pub(super) fn significant(value: f64) -> String {
    number(rounded(value, 5))
}

/// A length with four digits.
pub(crate) fn metres(length: f64) -> String {
    quantity(rounded(length, 4), "m")
}

/// An instant of a run, such as `t = 0.4 s`, to the microsecond: times are sums of rounded steps.
pub(crate) fn instant(time: f64) -> String {
    format!("t = {}", quantity((time * 1e6).round() / 1e6, "s"))
}

/// A fraction [-] in percent.
pub(crate) fn percent(part: f64) -> String {
    format!("{} %", significant(100.0 * part))
}

/// ", as Parquet, with 6 significant digits, with a ParaView file every 1 s".
fn tables_in_words(output: &Output) -> String {
    let format = match output.format {
        Some(Format::Parquet) => ", as Parquet",
        Some(Format::Csv) => ", as CSV",
        None => "",
    };
    let digits = match output.digits {
        Some(digits) => format!(", with {digits} significant digits"),
        None => String::new(),
    };
    let shapes = match output.frames {
        None => String::new(),
        Some(Frames::Overview) => ", with ParaView files".to_string(),
        Some(Frames::None) => ", without ParaView files".to_string(),
        Some(Frames::Every(interval)) => {
            format!(", with a ParaView file every {}", quantity(interval, "s"))
        }
    };
    format!("{format}{digits}{shapes}")
}

/// Sentences on the output for hosts that solve for bodies together with their mooring.
fn interface_in_words(output: &Output) -> impl Iterator<Item = &'static str> {
    let interface = output.interface.map(|interface| match interface {
        InterfaceOutput::Mass => "outputs for a host: mass of the line ends",
        InterfaceOutput::Impedance => "outputs for a host: mass, damping and stiffness over the coming step",
    });
    let inertia = (output.force == ForceOutput::WithoutInertia)
        .then_some("forces on coupled points and vessels exclude the inertia of the line ends");
    let stiffness = output
        .stiffness
        .then_some("the quasi-static stiffness on vessels is an output");
    let derivatives = output
        .derivatives
        .then_some("the FMU gives derivatives of the forces");
    [interface, inertia, stiffness, derivatives].into_iter().flatten()
}
