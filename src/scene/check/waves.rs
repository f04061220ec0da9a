//! Waves.

use super::{Bounds, Findings, quantity};
use crate::scene::{
    Integrator, LineModel, PointKind, RegularWave, Scene, Sea, SpectrumKind, WaveComponents, Waves,
};

/// Highest waves [m]: the highest ever measured had 32 m.
const HEIGHT: Bounds = Bounds::Magnitude(100.0);
/// Periods of waves [s]: from ripples in a tank to tides.
const PERIOD: Bounds = Bounds::Within(0.05, 1e5);
/// Directions and phases [rad].
const ANGLE: Bounds = Bounds::Magnitude(1e6);
/// Components of a spectrum, at most [-].
const COMPONENTS_MAX: u64 = 100_000;

pub(super) fn check(scene: &Scene, waves: &Waves, findings: &mut Findings) {
    let at = "water.waves";
    if waves.seas.is_empty() {
        findings.say(
            at,
            "there is no sea in the array: leave `waves` out for still water",
        );
    }
    for (i, sea) in waves.seas.iter().enumerate() {
        let at = match waves.seas.len() {
            1 => at.to_string(),
            _ => format!("{at}[{i}]"),
        };
        check_sea(&at, sea, findings);
        if let (Some(ramp), Some(other)) = (sea.ramp, waves.ramp())
            && ramp != other
        {
            let problem = format!(
                "{} here and {} in another sea: all seas grow together, write one ramp",
                quantity(ramp, "s"),
                quantity(other, "s")
            );
            findings.say(format!("{at}.ramp"), problem);
        }
    }
    if scene.gravity <= 0.0 {
        findings.say(at, "without gravity there are no waves: leave one of the two out");
    }
    check_lines(scene, findings);
}

/// Which of the three ways to describe a sea is taken, and whether its keys belong to it.
fn check_sea(at: &str, sea: &Sea, findings: &mut Findings) {
    findings.number_if(format!("{at}.ramp"), sea.ramp, Bounds::Positive(1e9), "s");
    let rows = matches!(sea.components, Some(WaveComponents::Rows(_)));
    let file = sea.file.is_some();
    let ways = [sea.regular.is_some(), rows, sea.spectrum.is_some(), file];
    match ways.iter().filter(|given| **given).count() {
        0 => findings.say(
            at,
            "a sea needs `regular = { height = …, period = … }`, `components = [[amplitude, period, direction, phase], …]`, `file` or \
             `spectrum = \"jonswap\"` with `significant_height` and `peak_period`",
        ),
        1 if file => findings.say(
            format!("{at}.file"),
            "a scene that comes as text cannot read files: write the rows as `components`",
        ),
        1 => {}
        _ => findings.say(
            at,
            "only one of `regular`, rows of `components`, `file` and `spectrum` describes a sea: write several seas as an array",
        ),
    }
    if sea.spectrum.is_some() {
        check_spectrum(at, sea, findings);
    } else {
        let drawn = matches!(sea.components, Some(WaveComponents::Number(_)));
        let of_spectrum = [
            ("significant_height", sea.significant_height.is_some()),
            ("peak_period", sea.peak_period.is_some()),
            ("peakedness", sea.peakedness.is_some()),
            ("direction", sea.direction.is_some()),
            ("spreading", sea.spreading.is_some()),
            ("seed", sea.seed.is_some()),
            ("components", drawn),
        ];
        for (key, _) in of_spectrum.iter().filter(|(_, given)| *given) {
            let problem = "this belongs to a spectrum: give `spectrum`, or leave it out";
            findings.say(format!("{at}.{key}"), problem);
        }
    }
    if let Some(regular) = &sea.regular {
        check_regular(&format!("{at}.regular"), regular, findings);
    }
    if let Some(WaveComponents::Rows(rows)) = &sea.components {
        check_rows(&format!("{at}.components"), rows, findings);
    }
}

fn check_regular(at: &str, regular: &RegularWave, findings: &mut Findings) {
    if regular.half_height().is_none() {
        findings.say(
            at,
            "a regular wave needs either its `height` or its `amplitude` [m]",
        );
    }
    let positive = Bounds::Positive(100.0);
    findings.number_if(format!("{at}.height"), regular.height, positive, "m");
    findings.number_if(format!("{at}.amplitude"), regular.amplitude, positive, "m");
    findings.number(format!("{at}.period"), regular.period, PERIOD, "s");
    findings.number(format!("{at}.direction"), regular.direction, ANGLE, "rad");
    findings.number(format!("{at}.phase"), regular.phase, ANGLE, "rad");
}

fn check_rows(at: &str, rows: &[[f64; 4]], findings: &mut Findings) {
    if rows.is_empty() {
        findings.say(
            at,
            "there are no rows: write [[amplitude, period, direction, phase], …]",
        );
    }
    for (i, [amplitude, period, direction, phase]) in rows.iter().enumerate() {
        findings.number(format!("{at}[{i}][0]"), *amplitude, HEIGHT, "m");
        findings.number(format!("{at}[{i}][1]"), *period, PERIOD, "s");
        findings.number(format!("{at}[{i}][2]"), *direction, ANGLE, "rad");
        findings.number(format!("{at}[{i}][3]"), *phase, ANGLE, "rad");
    }
}

fn check_spectrum(at: &str, sea: &Sea, findings: &mut Findings) {
    for (key, value, bounds, unit) in [
        (
            "significant_height",
            sea.significant_height,
            Bounds::Positive(100.0),
            "m",
        ),
        ("peak_period", sea.peak_period, PERIOD, "s"),
    ] {
        match value {
            None => findings.say(at, format!("missing key `{key}` [{unit}]: the spectrum needs it")),
            Some(value) => {
                findings.number(format!("{at}.{key}"), value, bounds, unit);
            }
        }
    }
    let of_jonswap = sea.spectrum == Some(SpectrumKind::Jonswap);
    let peakedness = format!("{at}.peakedness");
    if !of_jonswap && sea.peakedness.is_some() {
        findings.say(peakedness, "only a JONSWAP spectrum has one: leave it out");
    } else {
        findings.number_if(peakedness, sea.peakedness, Bounds::Within(1.0, 10.0), "-");
    }
    findings.number_if(format!("{at}.direction"), sea.direction, ANGLE, "rad");
    let spreading = Bounds::Within(0.0, 1000.0);
    findings.number_if(format!("{at}.spreading"), sea.spreading, spreading, "-");
    if let Some(WaveComponents::Number(number)) = sea.components
        && !(1..=COMPONENTS_MAX).contains(&number)
    {
        let problem = format!("{number} components: write a number from 1 to {COMPONENTS_MAX}");
        findings.say(format!("{at}.components"), problem);
    }
}

/// Lines that cannot be modelled in waves.
fn check_lines(scene: &Scene, findings: &mut Findings) {
    let at = "water.waves";
    if scene.solver.integrator == Integrator::QuasiStatic {
        let problem = "waves move no line that is quasi-static: take a dynamic integrator such as \"auto\", or leave the waves out";
        return findings.say(at, problem);
    }
    let all_beams = scene.solver.integrator == Integrator::Beam;
    let beam = scene.line_types.iter().find(|(_, line_type)| {
        let wet = line_type.diameter.is_some();
        wet && (all_beams || line_type.model == LineModel::Beam)
    });
    if let Some((name, _)) = beam {
        let problem = format!(
            "line type {name:?} is a beam, and beams are modelled in still water only: use the cable model, whose lines may bend too, or \
             leave out the waves"
        );
        return findings.say(at, problem);
    }
    let beams = || scene.lines.iter().filter(|line| scene.is_beam(line));
    let wet = scene.points.iter().find(|point| {
        let mut wets = [point.volume, point.drag_area].into_iter().flatten();
        let wet = point.kind == PointKind::Free && wets.any(|value| value > 0.0);
        wet && beams().any(|line| line.from == point.name || line.to == point.name)
    });
    if let Some(point) = wet {
        let problem = format!(
            "point {:?} is in the water at the end of a beam, and beams are modelled in still water only: use the cable model, or leave out \
             the waves or the point's volume and drag area",
            point.name
        );
        findings.say(at, problem);
    }
}
