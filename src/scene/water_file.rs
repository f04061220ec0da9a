//! Files of waves and currents in the formats of MoorDyn: rows of numbers separated by blanks.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;

use super::input_file;
use super::units::{self, Quantity};

/// Maximum number of rows.
const ROWS_MAX: usize = 100_000;
/// Number of lines above the rows of a current; only the units in the last one are read.
const CURRENT_HEAD: usize = 3;

/// Reads rows of frequency ω [rad/s], real and imaginary part of the amplitude A [m] and optionally direction β [rad]. Returns rows of
/// amplitude [m], period [s], direction [rad] and phase [rad] of the components of Σ |A| sin(ωt − kx + arg A), the sum in MoorDyn.
///
/// # Errors
/// The file and line of the mistake, and its correction.
pub(super) fn components(path: &Path) -> Result<Vec<[f64; 4]>, String> {
    let mut components = Vec::new();
    for (line, row) in rows(path, &text_of(path)?, 0)? {
        let wrong = |problem: &str| format!("{}, line {line}: {problem}", path.display());
        let (frequency, real, imaginary, direction) = match row.as_slice() {
            [frequency, real, imaginary] => (*frequency, *real, *imaginary, 0.0),
            [frequency, real, imaginary, direction] => (*frequency, *real, *imaginary, *direction),
            _ => {
                return Err(wrong(
                    "expected 3 or 4 numbers: ω [rad/s], real and imaginary part [m], direction [rad]",
                ));
            }
        };
        let amplitude = real.hypot(imaginary);
        if amplitude == 0.0 {
            continue;
        }
        if frequency <= 0.0 {
            return Err(wrong(
                "an elevation that does not change, or a negative frequency, is no wave: write amplitude 0 there",
            ));
        }
        let phase = FRAC_PI_2 - imaginary.atan2(real); // sin(a) = cos(½π − a)
        components.push([amplitude, TAU / frequency, direction, phase]);
    }
    if components.is_empty() {
        return Err(format!("{}: all amplitudes are 0", path.display()));
    }
    Ok(components)
}

/// Reads rows of height z [m] and velocity vx, vy, vz [m/s] below three lines of headings. Returns rows of z, vx and vy; vz must be 0.
///
/// # Errors
/// The file and line of the mistake, and its correction.
pub(super) fn profile(path: &Path) -> Result<Vec<[f64; 3]>, String> {
    let mut profile = Vec::new();
    let text = text_of(path)?;
    let (above, flow) = profile_units(path, &text)?;
    for (number, heading) in (1..).zip(text.lines().take(CURRENT_HEAD)) {
        if is_row(heading) {
            return Err(format!(
                "{}, line {number}: this row of numbers is among the three lines of headings, which are skipped: write three headings above the first row",
                path.display()
            ));
        }
    }
    for (line, row) in rows(path, &text, CURRENT_HEAD)? {
        let wrong = |problem: &str| format!("{}, line {line}: {problem}", path.display());
        match row.as_slice() {
            [z, x, y, 0.0] => profile.push([above * z, flow * x, flow * y]),
            [_, _, _, _] => {
                return Err(wrong(
                    "a profile that flows up or down is not modelled: write vz 0",
                ));
            }
            _ => return Err(wrong("expected 4 numbers: z [m], vx, vy, vz [m/s]")),
        }
    }
    if profile.is_empty() {
        let head = "there are no rows below the three lines of headings";
        return Err(format!("{}: {head}", path.display()));
    }
    Ok(profile)
}

fn text_of(path: &Path) -> Result<String, String> {
    let bytes = input_file::read_table(path, "a table of numbers")?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Returns whether a line consists of four numbers.
fn is_row(line: &str) -> bool {
    let words: Vec<&str> = line.split_whitespace().collect();
    words.len() == 4 && words.iter().all(|word| word.parse::<f64>().is_ok())
}

/// SI values of the units of heights [m] and velocities [m/s] in the last line of headings.
fn profile_units(path: &Path, text: &str) -> Result<(f64, f64), String> {
    let heading = text.lines().nth(CURRENT_HEAD - 1).unwrap_or_default();
    let wrong = |problem: String| format!("{}, line {CURRENT_HEAD}: {problem}", path.display());
    let of = |unit: &str, quantity| units::factor(unit, quantity).map_err(wrong);
    let found = units::bracketed(heading);
    let [above, flow @ ..] = &found[..] else {
        return Ok((1.0, 1.0));
    };
    if flow.len() != 3 {
        return match found.iter().any(|text| units::is_converted(text)) {
            true => Err(wrong(
                "a heading has a unit for each of its four columns, such as (m) (m/s) (m/s) (m/s), or none"
                    .into(),
            )),
            false => Ok((1.0, 1.0)),
        };
    }
    if flow.iter().any(|unit| *unit != flow[0]) {
        return Err(wrong(
            "the velocities have several units: one would be right".into(),
        ));
    }
    Ok((of(above, Quantity::Length)?, of(flow[0], Quantity::Speed)?))
}

/// Numbers of every line that contains any, with the line number; the first `head` lines are skipped.
fn rows(path: &Path, text: &str, head: usize) -> Result<Vec<(usize, Vec<f64>)>, String> {
    let name = path.display();
    let mut rows = Vec::new();
    for (index, line) in text.lines().enumerate().skip(head) {
        let content = line.split('#').next().unwrap_or_default();
        let mut numbers = Vec::new();
        for word in content.split_whitespace() {
            match word.parse::<f64>() {
                Ok(number) if number.is_finite() => numbers.push(number),
                _ => {
                    let shown: String = word.chars().take(40).collect();
                    return Err(format!("{name}, line {}: {shown:?} is no number", index + 1));
                }
            }
        }
        if rows.len() == ROWS_MAX {
            return Err(format!("{name}: more than {ROWS_MAX} rows"));
        }
        if !numbers.is_empty() {
            rows.push((index + 1, numbers));
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::fs;

    fn of<T>(text: &str, read: fn(&Path) -> Result<T, String>) -> Result<T, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("water.txt");
        fs::write(&path, text).unwrap();
        read(&path)
    }

    #[test]
    fn components_add_up_to_the_elevation_that_their_amplitudes_say() {
        let rows = of(
            "0.0 0.0 0.0\n0.5 1.0 -2.0\n0.9 0.0 0.5 0.3 # wind sea\n",
            components,
        )
        .unwrap();
        assert_eq!(rows.len(), 2);
        for t in [0.0, 1.3, 17.0] {
            let found: f64 = rows
                .iter()
                .map(|[a, period, _, phase]| a * (phase - TAU / period * t).cos())
                .sum();
            let sine = |a: f64, w: f64, phase: f64| a * (w * t + phase).sin();
            let expected = sine(5.0_f64.sqrt(), 0.5, f64::atan2(-2.0, 1.0)) + sine(0.5, 0.9, FRAC_PI_2);
            assert_relative_eq!(found, expected, epsilon = 1e-12);
        }
        assert_eq!(rows[1][2], 0.3);
    }

    #[test]
    fn a_current_stands_below_three_lines_of_headings() {
        let head = "--- currents ---\nz ux uy uz\n(m) (m/s) (m/s) (m/s)\n";
        let text = format!("{head}-50.0 0.1 0.2 0\n0.0 1.0 0 0\n");
        let rows = of(&text, profile).unwrap();
        assert_eq!(rows, vec![[-50.0, 0.1, 0.2], [0.0, 1.0, 0.0]]);
        let knots = head.replace("(m/s)", "(knots)");
        let unknown = of(&format!("{knots}0.0 1.0 0 0\n"), profile).unwrap_err();
        assert!(unknown.contains("line 3: unknown unit \"knots\""), "{unknown}");
        let slow = head.replace("(m/s)", "(cm/s)");
        let rows_slow = of(&format!("{slow}-50.0 10 20 0\n0.0 100 0 0\n"), profile).unwrap();
        assert_eq!(rows_slow, vec![[-50.0, 0.1, 0.2], [0.0, 1.0, 0.0]]);
        let rising = of(&format!("{head}0 1 0 0.5\n"), profile).unwrap_err();
        assert!(
            rising.contains("line 4") && rising.contains("up or down"),
            "{rising}"
        );
    }

    #[test]
    fn what_cannot_be_read_is_refused_with_file_and_line() {
        for (text, said) in [
            ("", "all amplitudes are 0"),
            ("0.5 1.0\n", "line 1: expected 3 or 4 numbers"),
            ("0.5 1.0 x\n", "line 1: \"x\" is no number"),
            ("0.5 nan 0\n", "is no number"),
            ("0.0 1.0 0.0\n", "is no wave"),
        ] {
            let problem = of(text, components).unwrap_err();
            assert!(
                problem.contains("water.txt") && problem.contains(said),
                "{problem}"
            );
        }
        assert!(of("", profile).unwrap_err().contains("no rows"));
        let missing = components(Path::new("/no/such/file.txt")).unwrap_err();
        assert!(missing.contains("no such file"), "{missing}");
    }
}
