//! A scene in words: what it models, and what it does not.

mod beam;
mod bending;
mod motions;
mod parting;
mod points;
mod seabed;
mod stretch;
mod surroundings;
mod vessels;
mod winch;

use std::f64::consts::PI;
use std::fmt::Write;

use super::channel::Channel;
use super::check::{integrator_name, number, quantity};
use super::notes::{chord, length};
use super::{
    Axis, ContactLaw, DAMPING_ELEMENTS, InitialShape, Integrator, Line, LineModel, LineType,
    NUMERICAL_DAMPING_RATIO, Point, PointForce, PointKind, Reconstruction, Scene, Strain, TimeFunction,
};
use motions::motion_in_words;
use vessels::vessel_in_words;

/// Widest line of the text, in characters.
const WIDTH: usize = 110;

/// What the tensions among the channels are, beside the variables of a line.
const TENSIONS_OF_CHANNELS: &str = "tensions among them are those of segments, as in MoorDyn-C: of the last one for FairTen, of the first for \
     AnchTen, of the two beside an inner node in the mean; `tension_a` and `tension_b` of a line are the forces on the points at its \
     ends, with the weight, drag and inertia of half a segment";

impl Scene {
    /// What the scene models and what it does not, in sentences; one line per line type, point and line.
    pub fn in_words(&self) -> String {
        let mut text = String::new();
        if !self.title.is_empty() {
            paragraph(&mut text, "", &self.title);
        }
        section(&mut text, "surroundings", &self.surroundings_in_words());
        let types = self.line_types.iter();
        let types: Vec<_> = types
            .map(|(name, kind)| self.line_type_in_words(name, kind))
            .collect();
        section(&mut text, "line types", &types);
        let points: Vec<_> = self
            .points
            .iter()
            .map(|point| self.point_in_words(point))
            .collect();
        let vessels: Vec<_> = self
            .vessels
            .iter()
            .map(|vessel| vessel_in_words(self, vessel))
            .collect();
        section(&mut text, "vessels", &vessels);
        section(&mut text, "points", &points);
        let lines: Vec<_> = self.lines.iter().map(|line| self.line_in_words(line)).collect();
        section(&mut text, "lines", &lines);
        section(&mut text, "solution", &self.solution_in_words());
        section(&mut text, "not modelled", &self.absences_in_words());
        text
    }

    /// Mass per unstretched length [kg/m]: the given one, else weight/gravity.
    pub(in crate::scene) fn mass(&self, line_type: &LineType) -> f64 {
        let of_weight = || line_type.weight.map(|weight| weight / self.gravity);
        line_type.mass.or_else(of_weight).unwrap_or(0.0)
    }

    /// Displaced mass of water per unstretched length [kg/m].
    fn displaced(&self, line_type: &LineType) -> f64 {
        match (&self.water, line_type.diameter) {
            (Some(water), Some(diameter)) => water.density * 0.25 * PI * diameter * diameter,
            _ => 0.0,
        }
    }

    /// Weight per unstretched length in the scene's surroundings [N/m].
    pub(in crate::scene) fn weight(&self, line_type: &LineType) -> f64 {
        let wet = || (self.mass(line_type) - self.displaced(line_type)) * self.gravity;
        line_type.weight.unwrap_or_else(wet)
    }

    fn surroundings_in_words(&self) -> Vec<String> {
        let gravity = if self.gravity == 0.0 {
            "no gravity: nothing has a weight".to_string()
        } else {
            format!("gravity {}, downwards along z", quantity(self.gravity, "m/s²"))
        };
        let water = match &self.water {
            Some(water) => surroundings::water_in_words(self, water),
            None => "no water".to_string(),
        };
        vec![gravity, water, self.seabed_in_words()]
    }

    fn seabed_in_words(&self) -> String {
        let Some(seabed) = &self.seabed else {
            return "no seabed".to_string();
        };
        let law = match seabed.contact {
            ContactLaw::Regularised => {
                "softened together to suit the mesh, with no less than 0.2 of critical damping left where the bed has it; a resting line lies on the bed"
            }
            ContactLaw::AsGiven => "exactly as given",
        };
        let chosen = match seabed.has_default_stiffness() {
            true => " (moorline's own choice)",
            false => "",
        };
        format!(
            "{}: normal spring of {} and damper of {}{chosen} per metre of line and of diameter, {law}; {}",
            seabed::shape_in_words(seabed),
            quantity(seabed.stiffness, "Pa/m"),
            quantity(seabed.damping, "Pa s/m"),
            seabed::friction_in_words(seabed),
        )
    }

    /// Numbers of elements that the damping ratio of a line type refers to.
    fn damping_elements_in_words(&self, name: &str) -> String {
        let sections = self.lines.iter().flat_map(|line| &line.sections);
        let own = sections.filter(|section| section.line_type == name);
        let mut elements: Vec<usize> = own
            .map(|section| section.damping_elements.unwrap_or(DAMPING_ELEMENTS))
            .collect();
        elements.sort_unstable();
        elements.dedup();
        let elements: Vec<String> = elements.iter().map(usize::to_string).collect();
        elements.join(" or ")
    }

    fn line_type_in_words(&self, name: &str, line_type: &LineType) -> String {
        let mass = self.mass(line_type);
        let weight = significant(self.weight(line_type));
        let origin = match (line_type.weight, &self.water) {
            (Some(_), _) => "as given",
            (None, Some(_)) => "in water",
            (None, None) => "in air",
        };
        let mut parts = vec![
            format!("mass {} kg/m", significant(mass)),
            format!("weight {weight} N/m {origin}"),
        ];
        if let Some(diameter) = line_type.diameter {
            parts.push(format!("diameter {}", quantity(diameter, "m")));
        }
        parts.push(stretch::in_words(line_type, mass));
        let section = self.section_in_words(line_type);
        parts.extend(section.or_else(|| bending::stiffness_in_words(line_type)));
        let damped = self.damping_elements_in_words(name);
        parts.push(damping_in_words(line_type, &damped));
        if self.water.is_some() {
            parts.push(water_forces_in_words(line_type));
        }
        format!("{name}: {}", parts.join(", "))
    }

    fn point_in_words(&self, point: &Point) -> String {
        let [x, y, z] = point.position.map(number);
        let frame = if point.on.is_some() { " in its frame" } else { "" };
        let mut said = format!("{}: {}, at ({x}, {y}, {z}) m{frame}", point.name, role(point));
        if let Some(mass) = point.mass {
            write!(said, ", mass {}", quantity(mass, "kg")).expect("a String takes all");
        }
        if let Some(volume) = point.volume {
            write!(said, ", volume {}", quantity(volume, "m³")).expect("a String takes all");
        }
        if let Some(area) = point.drag_area {
            write!(said, ", drag area {}", quantity(area, "m²")).expect("a String takes all");
        }
        if let Some(coefficient) = point.added_mass {
            write!(said, ", added mass {} of its volume", number(coefficient)).expect("a String takes all");
        }
        if let Some(sea) = self.sea_in_words(point) {
            write!(said, ", {sea}").expect("a String takes all");
        }
        if let Some(start) = self.start_in_words(point) {
            write!(said, ", {start}").expect("a String takes all");
        }
        if let Some(force) = &point.force {
            write!(said, ", {}", force_in_words(force)).expect("a String takes all");
        }
        if let Some(moment) = &point.moment {
            write!(said, ", {}", beam::moment_in_words(moment)).expect("a String takes all");
            let mut lines = self.lines.iter();
            if lines.any(|line| bending::bends(self, line) && line.joins(&point.name)) {
                said += ", of which the part along the line does nothing, for a cable has no torsion";
            }
        }
        if let Some(motion) = &point.motion {
            write!(said, ", {}", motion_in_words(motion)).expect("a String takes all");
        }
        if point.kind == PointKind::Coupled && point.on.is_none() {
            let motion = self.motion.get(&point.name).map(motion_in_words);
            let motion = motion.unwrap_or_else(|| "stays where it is".to_string());
            write!(said, "; in `run` it {motion}").expect("a String takes all");
        }
        said
    }

    fn line_in_words(&self, line: &Line) -> String {
        let sections: Vec<String> = line
            .sections
            .iter()
            .map(|section| {
                let elements = match section.elements {
                    Some(1) => " in 1 element".to_string(),
                    Some(n) => format!(" in {n} elements"),
                    None => String::new(),
                };
                format!(
                    "{} of {}{elements}",
                    quantity(section.length, "m"),
                    section.line_type
                )
            })
            .collect();
        let length = length(line);
        let chord = chord(self, line).unwrap_or(0.0);
        let fit = fit_in_words(length, chord);
        let start = match &line.initial {
            InitialShape::Static => "starts in static equilibrium".to_string(),
            InitialShape::Catenary => {
                "starts on the catenary between its ends, or straight where it has none, at rest".to_string()
            }
            InitialShape::Straight => "starts straight, at rest".to_string(),
            InitialShape::Parabola(sag) => {
                format!(
                    "starts as a parabola with a sag of {}, at rest",
                    quantity(*sag, "m")
                )
            }
            InitialShape::Nodes(_) => "starts at the given nodes, at rest".to_string(),
        };
        let held = match self.hold_in_words(line) {
            Some(held) => Some(held),
            None => bending::bends(self, line).then(|| bending::ends_in_words(line)),
        };
        let held = held.map_or(String::new(), |held| format!("; {held}"));
        format!(
            "{}: from {} to {}, {}; {fit}; {start}{held}{}",
            line.name,
            line.from,
            line.to,
            sections.join(", "),
            parting::in_words(line) + &winch::in_words(line)
        )
    }

    fn solution_in_words(&self) -> Vec<String> {
        let solver = &self.solver;
        let integrator = match solver.integrator {
            Integrator::Auto => "integrator chosen from the step limits".to_string(),
            Integrator::QuasiStatic => {
                let flows = self.water.as_ref().is_some_and(|w| w.current.is_some());
                let drag = match flows {
                    true => "no drag but the current's",
                    false => "no drag",
                };
                let rub = self.seabed.as_ref().is_some_and(|bed| bed.friction.acts());
                let laid = match rub {
                    true => ", friction of the bed laid anew in each",
                    false => "",
                };
                format!("quasi-static: an equilibrium at every output, no inertia, {drag}{laid}")
            }
            other => format!("integrator {}", integrator_name(other)),
        };
        let integrator = if solver.integrator == Integrator::QuasiStatic {
            integrator
        } else {
            let step = quantity(solver.time_step_max, "s");
            format!("{integrator}, steps of at most {step}")
        };
        let tension = if solver.negative_tension {
            "axial damping acts in compression too, so tension can be negative (the peers' law)"
        } else if self.all_beams() {
            "beams push as they pull: tension may be negative"
        } else {
            bending::compression_in_words(self)
        };
        let output = &self.output;
        let mut said = vec![
            integrator,
            format!("target error of fairlead tension {}", percent(solver.tolerance)),
            tension.to_string(),
            format!(
                "`run` covers {} and writes every {}{}",
                quantity(output.duration, "s"),
                quantity(output.interval, "s"),
                if output.profile { ", with all nodes" } else { "" }
            ),
        ];
        match solver.input_reconstruction {
            Reconstruction::Smooth => {}
            Reconstruction::Jump => said.push("coupled points jump to where a host says".into()),
            Reconstruction::Interpolate => {
                said.push("what a host says holds for the end of its step".into());
            }
        }
        if !solver.energy_ledger {
            said.push("no energy ledger: `solver.energy_error` stays 0".into());
        }
        if !output.channels.is_empty() {
            let channels = output.channels.join(", ");
            said.push(format!("further columns of `run`: {channels}"));
            if output.channels.iter().any(|name| Channel::is_tension(name)) {
                said.push(TENSIONS_OF_CHANNELS.into());
            }
        }
        said
    }

    fn absences_in_words(&self) -> Vec<String> {
        let mut absent: Vec<&str> = Vec::new();
        if !self.all_beams() {
            absent.push(bending::absence_in_words(self));
        }
        if self.water.is_some() {
            absent.push(surroundings::absence_in_words(self));
        } else {
            absent.push("buoyancy, drag and added mass");
        }
        match &self.seabed {
            Some(seabed) if seabed.friction.acts() => {}
            Some(_) => absent.push("friction on the seabed"),
            None => absent.push("contact with a seabed"),
        }
        absent.push("contact of lines with each other");
        if self.solver.integrator == Integrator::QuasiStatic {
            absent.push("inertia and damping");
        }
        vec![absent.join("; ")]
    }
}

/// Appends a heading and its entries; nothing where there are none.
fn section(text: &mut String, heading: &str, entries: &[String]) {
    if entries.is_empty() {
        return;
    }
    text.push_str(heading);
    text.push('\n');
    for entry in entries {
        paragraph(text, "  ", entry);
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

/// Five significant digits: enough to recognise a number.
fn significant(value: f64) -> String {
    let rounded: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    number(rounded)
}

/// A part of a whole [-] in percent.
pub(crate) fn percent(part: f64) -> String {
    format!("{} %", significant(100.0 * part))
}

/// How much longer a line is than the distance between its ends, both in metres.
fn fit_in_words(length: f64, chord: f64) -> String {
    let chord_said = significant(chord);
    let slack = length - chord;
    if slack.abs() < 1e-9 * length {
        return format!("as long as its ends are apart, {chord_said} m");
    }
    let (difference, how) = if slack > 0.0 {
        (slack, "longer")
    } else {
        (-slack, "shorter")
    };
    format!(
        "{} m {how} than the distance between its ends, {chord_said} m",
        significant(difference)
    )
}

fn strain_in_words(strain: Strain) -> String {
    match strain {
        Strain::Engineering => "engineering".to_string(),
        Strain::Green => "Green-Lagrange".to_string(),
        Strain::Logarithmic(poisson_ratio) => {
            format!("logarithmic (Poisson's ratio {})", number(poisson_ratio))
        }
    }
}

fn damping_in_words(line_type: &LineType, elements: &str) -> String {
    let mut parts = Vec::new();
    if let Some(damping) = line_type.axial_damping {
        parts.push(format!("axial damping {}", quantity(damping, "N s")));
    }
    if let Some(ratio) = line_type.damping_ratio {
        parts.push(format!(
            "axial damping {} of critical of one of {elements} elements of a line, the same on every mesh",
            number(ratio)
        ));
    }
    if let Some(rayleigh) = &line_type.rayleigh {
        let [ratio_1, ratio_2] = rayleigh.ratios.map(number);
        let [frequency_1, frequency_2] = rayleigh.frequencies.map(number);
        parts.push(format!(
            "Rayleigh damping ratios {ratio_1} at {frequency_1} rad/s and {ratio_2} at {frequency_2} rad/s"
        ));
    }
    match (parts.is_empty(), line_type.model) {
        (false, _) => parts.join(" and "),
        (true, LineModel::Cable) if line_type.leaves_damping_open() => format!(
            "axial damping {} of critical in each segment, and no less than with {elements} elements (moorline's own choice)",
            number(NUMERICAL_DAMPING_RATIO)
        ),
        (true, _) => "no damping of its own".to_string(),
    }
}

/// "in the water buoyancy, drag (normal 2, tangential 0.4), added mass (normal 0.8); no tangential added mass".
fn water_forces_in_words(line_type: &LineType) -> String {
    let pair = |what: &str, normal: Option<f64>, tangential: Option<f64>| {
        let said = |direction: &str, value: Option<f64>| match value {
            Some(value) => format!("{direction} {}", number(value)),
            None => format!("{direction} none"),
        };
        if normal.is_none() && tangential.is_none() {
            format!("no {what}")
        } else {
            format!(
                "{what} ({}, {})",
                said("normal", normal),
                said("tangential", tangential)
            )
        }
    };
    let buoyancy = if line_type.weight.is_some() {
        "buoyancy within the weight"
    } else {
        "buoyancy"
    };
    let drag = pair("drag", line_type.drag_normal, line_type.drag_tangential);
    let added_mass = pair(
        "added mass",
        line_type.added_mass_normal,
        line_type.added_mass_tangential,
    );
    format!("{buoyancy}, {drag}, {added_mass}")
}

fn role(point: &Point) -> String {
    match (point.kind, &point.free) {
        (PointKind::Fixed, _) => "fixed".to_string(),
        (PointKind::Coupled, _) => match &point.on {
            Some(vessel) => format!("rides on {vessel}"),
            None => "coupled to the host".to_string(),
        },
        (PointKind::Prescribed, _) => "moved along its own path".to_string(),
        (PointKind::Free, None) => "free".to_string(),
        (PointKind::Free, Some(axes)) => {
            let names: Vec<&str> = axes
                .iter()
                .map(|axis| match axis {
                    Axis::X => "x",
                    Axis::Y => "y",
                    Axis::Z => "z",
                })
                .collect();
            format!("free along {} only", names.join(" and "))
        }
    }
}

fn force_in_words(force: &PointForce) -> String {
    let axes = [("x", &force.x), ("y", &force.y), ("z", &force.z)];
    let said: Vec<String> = axes
        .iter()
        .filter_map(|(axis, function)| {
            let function = function.as_ref()?;
            Some(format!("{} along {axis}", load_in_words(function, "N")))
        })
        .collect();
    format!("force {}", said.join(" and "))
}

fn load_in_words(function: &TimeFunction, unit: &str) -> String {
    let rise = |how: &str, [t0, f0, t1, f1]: [f64; 4]| {
        let [t0, f0, t1, f1] = [t0, f0, t1, f1].map(number);
        format!("{how} from {f0} {unit} at {t0} s to {f1} {unit} at {t1} s")
    };
    match function {
        TimeFunction::Constant(value) => quantity(*value, unit),
        TimeFunction::Step(numbers) => rise("rising smoothly", *numbers),
        TimeFunction::Ramp(numbers) => rise("rising straight", *numbers),
        TimeFunction::Table(rows) => format!("from a table of {} rows", rows.len()),
    }
}
