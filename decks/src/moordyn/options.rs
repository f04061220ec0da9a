//! OPTIONS: `value key comment`.

use moorline::scene::rows::{Row, number, shown};

use super::deck::{Options, Property};
use super::tables::word_property;
use crate::findings::{Findings, Placed};
use crate::table::{ROWS_MAX, is_one_of, left_out, placed_text};

/// Keys, in capitals, that control the solution, start and output of MoorDyn and have no effect here.
const UNNEEDED: &str = "DTM DT CFL TSCHEME DTIC ICDT CDSCALEIC ICDFAC THRESHIC ICTHRESH FILEIC ICGENDYNAMIC \
    GENDYNAMICIC ICFILE WRITELOG WRITEUNITS DISABLEOUTPUT DISABLEOUTTIME OUTSWITCH INERTIALF \
    INERTIALF_RAMPT WAVEKIN_RAMPT ECHO DTWAVE UNIFYCURRENTGRID DTOUTSNAP";

/// Meanings of the keys with an effect, and the spellings of these keys in capitals.
const NEEDED: [(Meaning, &str); 12] = [
    (Meaning::Gravity, "G GRAVITY"),
    (Meaning::Density, "RHO RHOW WTRDNSTY"),
    (Meaning::Depth, "WTRDPTH WATERDEPTH DEPTH"),
    (Meaning::SeabedStiffness, "KBOT KB"),
    (Meaning::SeabedDamping, "CBOT CB"),
    (Meaning::Friction, "FRICTIONCOEFFICIENT MU_KT MU_KA"),
    (Meaning::FrictionDamping, "FRICDAMP CV"),
    (Meaning::StaticFriction, "STATDYNFRICSCALE MC"),
    (Meaning::Relaxation, "TMAXIC ICTMAX"),
    (Meaning::OutputInterval, "DTOUT"),
    (Meaning::Surroundings, "WAVEKIN WATERKIN CURRENTS CURRENT"),
    (Meaning::Soundings, "SEAFLOORFILE BATHYMETRYFILE BATHFILE"),
];

/// Meaning of an option.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Meaning {
    /// g [m/s²].
    Gravity,
    /// rho [kg/m³].
    Density,
    /// WtrDpth [m], or a file of soundings.
    Depth,
    /// kBot [Pa/m].
    SeabedStiffness,
    /// cBot [Pa s/m].
    SeabedDamping,
    /// Friction coefficients of the seabed [-].
    Friction,
    /// Slope of MoorDyn's friction against velocity below its limit [N s/m or -].
    FrictionDamping,
    /// Ratio of static to kinetic friction [-].
    StaticFriction,
    /// dtOut [s].
    OutputInterval,
    /// TmaxIC [s].
    Relaxation,
    /// File of seabed depths.
    Soundings,
    /// Waves and currents.
    Surroundings,
}

fn meaning(key: &str) -> Option<Meaning> {
    let known = NEEDED.iter().find(|(_, keys)| is_one_of(key, keys));
    known.map(|(meaning, _)| *meaning)
}

/// Keys of a file with the initial state.
const STATE_FILES: &str = "FILEIC ICFILE";

/// Key of the time over which MoorDyn-C raises the waves [s].
const WAVE_RAMP: &str = "WAVEKIN_RAMPT";

/// A row of OPTIONS.
struct Choice {
    key: Placed<String>,
    value: Placed<String>,
}

impl Choice {
    /// Returns whether another row sets the same option.
    fn repeats(&self, other: &Choice) -> bool {
        let (a, b) = (&self.key.value, &other.key.value);
        let several = [Meaning::Friction, Meaning::Surroundings].map(Some);
        let same = meaning(a).is_some() && meaning(a) == meaning(b) && !several.contains(&meaning(a));
        same || a.eq_ignore_ascii_case(b)
    }
}

/// Reads the rows of OPTIONS. As in MoorDyn, an unknown key is ignored and the last of several values counts, both with a remark.
pub(super) fn read(rows: &[Row<'_>], findings: &mut Findings) -> Options {
    let mut options = Options::default();
    let choices = choices(rows, findings);
    for (index, choice) in choices.iter().enumerate() {
        let Choice { key, value } = choice;
        let mut later = choices[index + 1..].iter().rev();
        if let Some(last) = later.find(|later| later.repeats(choice)) {
            let text = format!(
                "{} {} is given again below: the last value, {}, counts",
                key.value, value.value, last.value.value
            );
            findings.remark(key, text);
        } else if let Some(meaning) = meaning(&key.value) {
            take(&mut options, meaning, choice, findings);
        } else if is_one_of(&key.value, STATE_FILES) && number(&value.value) != Ok(0.0) {
            options.state_file = Some(key.with(format!("{} {}", key.value, value.value)));
        } else if is_one_of(&key.value, WAVE_RAMP) && number(&value.value) != Ok(0.0) {
            let text = format!(
                "{} is not read: the waves act in full from the start; `ramp` in `waves` of a scene raises them along half a cosine",
                key.value
            );
            findings.remark(key, text);
        } else if is_one_of(&key.value, UNNEEDED) {
            options.unneeded.push(key.clone());
        } else if meaning(&value.value).is_some() || is_one_of(&value.value, UNNEEDED) {
            let problem = format!(
                "an option is written as value and key, here {} {}",
                shown(&key.value),
                value.value
            );
            findings.wrong("OPTIONS", key, problem);
        } else {
            let keys = NEEDED.iter().map(|(_, keys)| *keys).chain([UNNEEDED]);
            let known: Vec<&str> = keys.flat_map(|keys| keys.split(' ')).collect();
            findings.remark(key, left_out("option", &key.value, known.iter().copied()));
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
        let [key, value] = [key, value].map(|field| placed_text(field.text, &field.span));
        choices.push(Choice { key, value });
    }
    choices
}

fn take(options: &mut Options, meaning: Meaning, Choice { key, value }: &Choice, findings: &mut Findings) {
    let is_zero = number(&value.value) == Ok(0.0);
    let mut wrong = |problem: String| findings.wrong(format!("OPTIONS, {}", key.value), value, problem);
    let mut placed = || {
        let number = number(&value.value).map_err(&mut wrong).ok()?;
        Some(value.with(number))
    };
    match meaning {
        Meaning::Friction => options.friction.extend(placed().map(|c| (key.value.clone(), c))),
        Meaning::Depth => match word_property(&value.value) {
            Ok(Property::Parts(_)) => wrong("expected one depth [m], or the name of a file".to_string()),
            Ok(depth) => options.depth = Some(value.with(depth)),
            Err(problem) => wrong(problem),
        },
        // 0 means none of these; relaxation times other than 0 have no effect here.
        Meaning::Surroundings | Meaning::Soundings | Meaning::Relaxation
            if is_zero != (meaning == Meaning::Relaxation) =>
        {
            options.unneeded.push(value.with(key.value.clone()));
        }
        Meaning::Relaxation => options.starts_at_once = Some(value.clone()),
        Meaning::Soundings => options.soundings = Some(value.clone()),
        Meaning::Surroundings => options.surroundings.push((key.value.clone(), value.clone())),
        number => options.numbers.extend(placed().map(|value| (number, value))),
    }
}
