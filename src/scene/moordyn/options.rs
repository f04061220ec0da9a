//! OPTIONS: `value key comment`.

use super::deck::{Options, Property};
use super::tables::word_property;
use crate::scene::nearest::nearest;
use crate::scene::rows::{Findings, Placed, ROWS_MAX, Row, number, shown};

/// Keys in capitals that choose how MoorDyn solves, starts and writes: nothing here needs them.
const UNNEEDED: &[&str] = &[
    "DTM",
    "DT",
    "CFL",
    "TSCHEME",
    "DTIC",
    "ICDT",
    "CDSCALEIC",
    "ICDFAC",
    "THRESHIC",
    "ICTHRESH",
    "FILEIC",
    "ICGENDYNAMIC",
    "GENDYNAMICIC",
    "ICFILE",
    "WRITELOG",
    "WRITEUNITS",
    "DISABLEOUTPUT",
    "DISABLEOUTTIME",
    "OUTSWITCH",
    "INERTIALF",
    "INERTIALF_RAMPT",
    "ECHO",
    "DTWAVE",
    "UNIFYCURRENTGRID",
    "DTOUTSNAP",
];

/// Keys that say something, with what they mean.
const NEEDED: &[(&str, Meaning)] = &[
    ("G", Meaning::Gravity),
    ("GRAVITY", Meaning::Gravity),
    ("RHO", Meaning::Density),
    ("RHOW", Meaning::Density),
    ("WTRDNSTY", Meaning::Density),
    ("WTRDPTH", Meaning::Depth),
    ("WATERDEPTH", Meaning::Depth),
    ("DEPTH", Meaning::Depth),
    ("KBOT", Meaning::BedStiffness),
    ("KB", Meaning::BedStiffness),
    ("CBOT", Meaning::BedDamping),
    ("CB", Meaning::BedDamping),
    ("FRICTIONCOEFFICIENT", Meaning::Friction),
    ("MU_KT", Meaning::Friction),
    ("MU_KA", Meaning::Friction),
    ("FRICDAMP", Meaning::FrictionDamping),
    ("CV", Meaning::FrictionDamping),
    ("STATDYNFRICSCALE", Meaning::StaticFriction),
    ("MC", Meaning::StaticFriction),
    ("TMAXIC", Meaning::Relaxation),
    ("ICTMAX", Meaning::Relaxation),
    ("DTOUT", Meaning::OutputInterval),
    ("WAVEKIN", Meaning::Surroundings),
    ("WATERKIN", Meaning::Surroundings),
    ("CURRENTS", Meaning::Surroundings),
    ("CURRENT", Meaning::Surroundings),
    ("SEAFLOORFILE", Meaning::Soundings),
    ("BATHYMETRYFILE", Meaning::Soundings),
    ("BATHFILE", Meaning::Soundings),
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meaning {
    Gravity,
    Density,
    Depth,
    BedStiffness,
    BedDamping,
    Friction,
    FrictionDamping,
    StaticFriction,
    OutputInterval,
    Relaxation,
    Soundings,
    Surroundings,
}

fn meaning(key: &str) -> Option<Meaning> {
    let known = NEEDED.iter().find(|(known, _)| known.eq_ignore_ascii_case(key));
    known.map(|(_, meaning)| *meaning)
}

fn is_unneeded(key: &str) -> bool {
    UNNEEDED.iter().any(|known| known.eq_ignore_ascii_case(key))
}

/// Keys that name a file with a state to start from.
const STATE_FILES: [&str; 2] = ["FILEIC", "ICFILE"];

/// A row of OPTIONS.
struct Choice {
    key: Placed<String>,
    value: Placed<String>,
}

impl Choice {
    /// Whether another row says the same thing.
    fn repeats(&self, other: &Choice) -> bool {
        let (a, b) = (&self.key.value, &other.key.value);
        let several = [Meaning::Friction, Meaning::Surroundings].map(Some);
        let same = meaning(a).is_some() && meaning(a) == meaning(b) && !several.contains(&meaning(a));
        same || a.eq_ignore_ascii_case(b)
    }
}

/// Reads the rows of OPTIONS. MoorDyn goes on where it does not know a key, and takes the last of several values: so does this, with
/// remarks.
pub(super) fn read(rows: &[Row<'_>], findings: &mut Findings) -> Options {
    let mut options = Options::default();
    let choices = choices(rows, findings);
    for (index, Choice { key, value }) in choices.iter().enumerate() {
        let later = choices[index + 1..].iter().rev();
        if let Some(last) = later.clone().find(|later| later.repeats(&choices[index])) {
            let text = format!(
                "{} {} is given again below: the last value, {}, counts",
                key.value, value.value, last.value.value
            );
            findings.remark(key.span.start, text);
        } else if let Some(meaning) = meaning(&key.value) {
            take(&mut options, meaning, &key.value, value.clone(), findings);
        } else if is_unneeded(&key.value) {
            remark_on_state_file(key, value, findings);
            options.unneeded.push(key.clone());
        } else if meaning(&value.value).is_some() || is_unneeded(&value.value) {
            let problem = format!(
                "an option is written as value and key, here {} {}",
                shown(&key.value),
                value.value
            );
            findings.mistake("OPTIONS", key.span.clone(), problem);
        } else {
            findings.remark(key.span.start, unknown(&key.value));
        }
    }
    options
}

fn choices(rows: &[Row<'_>], findings: &mut Findings) -> Vec<Choice> {
    let mut choices = Vec::new();
    for row in rows.iter().take(ROWS_MAX) {
        let fields = row.fields();
        let [value, key, ..] = fields.as_slice() else {
            let problem = format!("expected a value and a key, found {}", shown(row.text.trim()));
            findings.mistake("OPTIONS", row.span(), problem);
            continue;
        };
        let [key, value] = [key, value].map(|field| Placed {
            value: field.text.to_string(),
            span: field.span.clone(),
        });
        choices.push(Choice { key, value });
    }
    choices
}

/// MoorDyn would start from the state in the file.
fn remark_on_state_file(key: &Placed<String>, value: &Placed<String>, findings: &mut Findings) {
    let names_one = STATE_FILES
        .iter()
        .any(|file| key.value.eq_ignore_ascii_case(file));
    if names_one && number(&value.value) != Ok(0.0) {
        let text = format!(
            "{} {}: the state in this file is not read, the run starts from equilibrium",
            key.value, value.value
        );
        findings.remark(key.span.start, text);
    }
}

fn unknown(key: &str) -> String {
    let known: Vec<&str> = NEEDED
        .iter()
        .map(|(key, _)| *key)
        .chain(UNNEEDED.iter().copied())
        .collect();
    let meant = nearest(key, known.iter().copied());
    let meant = meant.map_or(String::new(), |known| format!(", did you mean {known}?"));
    format!("the option {} is not known and left out{meant}", shown(key))
}

fn take(options: &mut Options, meaning: Meaning, key: &str, value: Placed<String>, findings: &mut Findings) {
    let mut placed = || match number(&value.value) {
        Ok(number) => Some(Placed {
            value: number,
            span: value.span.clone(),
        }),
        Err(problem) => {
            findings.mistake(format!("OPTIONS, {key}"), value.span.clone(), problem);
            None
        }
    };
    match meaning {
        Meaning::Gravity => options.gravity = placed(),
        Meaning::Density => options.density = placed(),
        Meaning::BedStiffness => options.bed_stiffness = placed(),
        Meaning::BedDamping => options.bed_damping = placed(),
        Meaning::OutputInterval => options.output_interval = placed(),
        Meaning::Friction => {
            let coefficient = placed();
            options.friction.extend(coefficient.map(|c| (key.to_string(), c)));
        }
        Meaning::FrictionDamping => options.friction_damping = placed(),
        Meaning::StaticFriction => options.static_friction = placed(),
        Meaning::Depth => match word_property(&value.value) {
            Ok(depth) => {
                options.depth = Some(Placed {
                    value: depth,
                    span: value.span,
                });
            }
            Err(problem) => findings.mistake(format!("OPTIONS, {key}"), value.span, problem),
        },
        // 0 asks for none of these, and other times to come to rest in change nothing here.
        Meaning::Surroundings | Meaning::Soundings | Meaning::Relaxation
            if (number(&value.value) == Ok(0.0)) != (meaning == Meaning::Relaxation) =>
        {
            options.unneeded.push(Placed {
                value: key.to_string(),
                span: value.span,
            })
        }
        Meaning::Relaxation => options.starts_at_once = Some(value.span),
        Meaning::Soundings => options.soundings = Some(value),
        Meaning::Surroundings => options.surroundings.push((key.to_string(), value)),
    }
    if meaning == Meaning::Depth
        && let Some(depth) = &options.depth
        && let Property::Parts(_) = depth.value
    {
        findings.mistake(
            format!("OPTIONS, {key}"),
            depth.span.clone(),
            "expected one depth [m], or the name of a file",
        );
    }
}
