//! Motions in words.

use super::significant;
use crate::scene::check::quantity;
use crate::scene::{HarmonicMotion, MotionPath, MotionRow};

/// Name and unit of the axes.
const AXES: [(&str, &str); 6] = [
    ("x", "m"),
    ("y", "m"),
    ("z", "m"),
    ("roll", "rad"),
    ("pitch", "rad"),
    ("yaw", "rad"),
];

/// "swings by 2.5 m every 12 s along x and 0.05 rad every 10 s in pitch, growing over 15 s", for a sentence about what moves.
pub(super) fn motion_in_words(motion: &MotionPath) -> String {
    let follows = |what: String, rows: &[MotionRow]| match ranges_in_words(rows) {
        Some(ranges) => format!("follows {what}: {ranges}"),
        None => format!("stays where it is, by {what}"),
    };
    match motion {
        MotionPath::File(file) => follows(
            format!(
                "the {} rows of {}, read as {},",
                file.rows.len(),
                file.file,
                file.columns
            ),
            &file.rows,
        ),
        MotionPath::Table(rows) => follows(format!("a table of {} rows", rows.len()), rows),
        MotionPath::Harmonic(harmonic) => harmonic_in_words(harmonic),
    }
}

/// "x from 0 to 5 m and pitch from -0.1 to 0.1 rad"; `None` where all rows are zero.
fn ranges_in_words(rows: &[MotionRow]) -> Option<String> {
    let said = AXES.iter().enumerate().filter_map(|(axis, (name, unit))| {
        let values = rows.iter().map(|row| row[1 + axis]);
        let least = values.clone().fold(f64::INFINITY, f64::min);
        let most = values.fold(f64::NEG_INFINITY, f64::max);
        if least == 0.0 && most == 0.0 {
            None
        } else if least == most {
            Some(format!("{name} at {} {unit}", significant(least)))
        } else {
            let (least, most) = (significant(least), significant(most));
            Some(format!("{name} from {least} to {most} {unit}"))
        }
    });
    let said: Vec<String> = said.collect();
    (!said.is_empty()).then(|| said.join(" and "))
}

fn harmonic_in_words(harmonic: &HarmonicMotion) -> String {
    let axes = harmonic.axes().into_iter().zip(AXES);
    let waves: Vec<String> = axes
        .flat_map(|((_, components), axis)| components.iter().map(move |sine| (axis, sine)))
        .filter_map(|((name, unit), sine)| {
            let (amplitude, period) = (sine.first()?, sine.get(1)?);
            let how = if unit == "m" { "along" } else { "in" };
            let (size, period) = (quantity(amplitude.abs(), unit), quantity(*period, "s"));
            (*amplitude != 0.0).then(|| format!("{size} every {period} {how} {name}"))
        })
        .collect();
    if waves.is_empty() {
        return "stays where it is".to_string();
    }
    let ramp = harmonic
        .ramp
        .map(|ramp| format!(", growing over {}", quantity(ramp, "s")));
    format!("swings by {}{}", waves.join(" and "), ramp.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_is_described_with_all_its_axes() {
        let mut motion = HarmonicMotion {
            pitch: vec![vec![-0.05, 10.0]],
            ..HarmonicMotion::default()
        };
        let said = motion_in_words(&MotionPath::Harmonic(motion.clone()));
        assert_eq!(said, "swings by 0.05 rad every 10 s in pitch");
        motion.x = vec![vec![2.5, 12.0]];
        motion.ramp = Some(15.0);
        let said = motion_in_words(&MotionPath::Harmonic(motion));
        let expected =
            "swings by 2.5 m every 12 s along x and 0.05 rad every 10 s in pitch, growing over 15 s";
        assert_eq!(said, expected);
        let still = HarmonicMotion {
            x: vec![vec![0.0, 12.0]],
            ..HarmonicMotion::default()
        };
        let said = motion_in_words(&MotionPath::Harmonic(still));
        assert_eq!(said, "stays where it is");
    }

    #[test]
    fn a_table_is_described_by_the_range_of_every_axis_that_moves() {
        let rows = vec![
            [0.0, 0.0, 0.0, 1.5, 0.0, -0.1, 0.0],
            [9.0, 5.0, 0.0, 1.5, 0.0, 0.2, 0.0],
        ];
        let said = motion_in_words(&MotionPath::Table(rows));
        assert_eq!(
            said,
            "follows a table of 2 rows: x from 0 to 5 m and z at 1.5 m and pitch from -0.1 to 0.2 rad"
        );
        let said = motion_in_words(&MotionPath::Table(vec![[0.0; 7]; 3]));
        assert_eq!(said, "stays where it is, by a table of 3 rows");
    }
}
