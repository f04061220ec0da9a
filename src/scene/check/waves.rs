//! Waves, and the flow of the water that a host gives.

use super::{Findings, quantity, rules};
use crate::scene::table::Table;
use crate::scene::{Integrator, Point, PointKind, Scene, Sea, SpectrumKind, WaveComponents, Waves};

pub(super) fn check(scene: &Scene, waves: &Waves, findings: &mut Findings) {
    let at = "water.waves";
    rules! { findings, at;
        "" if waves.seas.is_empty() => "there is no sea in the array: leave `waves` out for still water";
    }
    for (i, sea) in waves.seas.iter().enumerate() {
        let at = waves.path(i);
        check_sea(&at, sea, findings);
        if let (Some(ramp), Some(other)) = (sea.ramp, waves.ramp()) {
            rules! { findings, &at;
                "ramp" if ramp != other =>
                    "{} here and {} in another sea: all seas grow together, write one ramp",
                    quantity(ramp, "s"), quantity(other, "s");
            }
        }
    }
    rules! { findings, at;
        "" if scene.gravity <= 0.0 => "without gravity there are no waves: leave one of the two out";
    }
    check_lines(scene, at, ["waves move", "the waves"], findings);
}

/// Refuses anything on which the host's flow of the water cannot act.
pub(super) fn check_flow(scene: &Scene, findings: &mut Findings) {
    check_lines(scene, "water.flow", ["the flow moves", "the flow"], findings);
    let is_alone = |point: &Point| {
        let mut lines = scene.lines.iter();
        is_wet(point) && !lines.any(|line| line.joins(&point.name))
    };
    for (i, point) in scene.points.iter().enumerate() {
        rules! { findings, "points";
            "[{i}]" if point.kind != PointKind::Free && is_alone(point) =>
                "the host gives the flow at the nodes of lines, and no line ends at this point: leave out its `volume` and `drag_area`";
        }
    }
}

/// Returns whether water acts on the body of a point.
fn is_wet(point: &Point) -> bool {
    let mut sizes = [point.volume, point.drag_area].into_iter().flatten();
    sizes.any(|size| size > 0.0)
}

/// Checks that a sea is described in exactly one way, and that its keys belong to it.
fn check_sea(at: &str, sea: &Sea, findings: &mut Findings) {
    let rows = matches!(sea.components, Some(WaveComponents::Rows(_)));
    let file = sea.file.is_some();
    let ways = [sea.regular.is_some(), rows, sea.spectrum.is_some(), file];
    let ways = ways.iter().filter(|given| **given).count();
    rules! { findings, at;
        "" if ways == 0 =>
            "a sea needs `regular = {{ height = …, period = … }}`, `components = [[amplitude, period, direction, phase], …]`, `file` or \
             `spectrum = \"jonswap\"` with `significant_height` and `peak_period`";
        "file" if ways == 1 && file =>
            "a scene that comes as text cannot read files: write the rows as `components`";
        "" if ways > 1 =>
            "only one of `regular`, rows of `components`, `file` and `spectrum` describes a sea: write several seas as an array";
    }
    let drawn = matches!(sea.components, Some(WaveComponents::Number(_)));
    for (key, value) in sea.entries() {
        let (name, unit) = (key.name(), key.unit().unwrap_or_default());
        let needed = ["significant_height", "peak_period"].contains(&name);
        let of_spectrum = needed || ["peakedness", "direction", "spreading", "seed"].contains(&name);
        let of_spectrum = of_spectrum || name == "components" && drawn;
        rules! { findings, at;
            "{name}" if sea.spectrum.is_none() && of_spectrum && !value.is_absent() =>
                "this belongs to a spectrum: give `spectrum`, or leave it out";
            "" if sea.spectrum.is_some() && needed && value.is_absent() =>
                "missing key `{name}` [{unit}]: the spectrum needs it";
        }
    }
    let other = sea
        .spectrum
        .is_some_and(|spectrum| spectrum != SpectrumKind::Jonswap);
    let regular = sea.regular.as_ref();
    rules! { findings, at;
        "peakedness" if other && sea.peakedness.is_some() => "only a JONSWAP spectrum has one: leave it out";
        "regular" if regular.is_some_and(|regular| regular.half_height().is_none()) =>
            "a regular wave needs either its `height` or its `amplitude` [m]";
    }
}

/// Refuses lines that cannot be modelled in moving water. `moves` is the source of the motion as the beginning of a sentence, `source` its name.
fn check_lines(scene: &Scene, at: &str, [moves, source]: [&str; 2], findings: &mut Findings) {
    let still = scene.solver.integrator == Integrator::QuasiStatic;
    let beam = scene.type_of_beams(|line_type| line_type.diameter.is_some());
    let ends_beam = |point: &Point| {
        let mut lines = scene.lines.iter().filter(|line| scene.is_beam(line));
        lines.any(|line| line.joins(&point.name))
    };
    let wet = scene
        .free_points()
        .find(|point| is_wet(point) && ends_beam(point));
    rules! { findings, at;
        "" if still =>
            "{moves} no line that is quasi-static: take a dynamic integrator such as \"auto\", or leave {source} out";
        "" given name = beam.filter(|_| !still) =>
            "line type {name:?} is a beam, and beams are modelled in still water only: use the cable model, whose lines may bend too, or \
             leave out {source}";
        "" given point = wet.filter(|_| !still && beam.is_none()) =>
            "point {:?} is in the water at the end of a beam, and beams are modelled in still water only: use the cable model, or leave out \
             {source} or the point's volume and drag area", point.name;
    }
}
