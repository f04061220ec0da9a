//! Points, vessels and their motions in words.

use std::f64::consts::PI;

use super::{given, join, significant, triple};
use crate::scene::check::quantity;
use crate::scene::table::Choice;
use crate::scene::{
    AngleOrder, Axis, HarmonicMotion, InitialShape, Line, MotionPath, MotionRow, Point, PointKind, Scene,
    Vessel,
};

/// Units of the axes of a motion: displacements, then rotations.
const UNITS: [&str; 6] = ["m", "m", "m", "rad", "rad", "rad"];

impl Scene {
    pub(super) fn point_in_words(&self, point: &Point) -> String {
        let frame = if point.on.is_some() {
            " in the frame of the vessel"
        } else {
            ""
        };
        let mut parts = vec![role(point), format!("at {} m{frame}", triple(point.position))];
        parts.extend(given(point, &["name", "position", "kind", "on", "free"]));
        parts.extend(self.sea_in_words(point));
        parts.extend(self.start_in_words(point).map(str::to_string));
        let mut lines = self.lines.iter();
        if point.moment.is_some() && lines.any(|line| self.bends(line) && line.joins(&point.name)) {
            parts.push("the moment about the line has no effect, since cables have no torsion".into());
        }
        let run = match (point.kind, &point.on) {
            (PointKind::Coupled, None) => self.run_in_words(&point.name),
            _ => String::new(),
        };
        format!("{}: {}{run}", point.name, parts.join(", "))
    }

    /// "; in `run` it oscillates by …".
    fn run_in_words(&self, body: &str) -> String {
        let motion = self.motion.get(body).map(motion_in_words);
        let motion = motion.unwrap_or_else(|| "stays at rest".to_string());
        format!("; in `run` it {motion}")
    }

    pub(super) fn vessel_in_words(&self, vessel: &Vessel) -> String {
        let (name, origin) = (&vessel.name, triple(vessel.position));
        let [roll, pitch, yaw] = vessel.attitude.map(significant);
        let attitude = match vessel.attitude == [0.0; 3] {
            true => String::new(),
            false => format!(", roll {roll} rad, pitch {pitch} rad, yaw {yaw} rad"),
        };
        let aboard = self.points.iter().filter(|point| point.on.as_ref() == Some(name));
        let aboard: Vec<&str> = aboard.map(|point| point.name.as_str()).collect();
        let carried = if aboard.is_empty() {
            "no point".to_string()
        } else {
            aboard.join(", ")
        };
        let run = self.run_in_words(name);
        let angles = match vessel.motion_angles {
            AngleOrder::Zyx => "",
            AngleOrder::Xyz => {
                "; roll, pitch and yaw of its motion in `run` are those of Rx(roll)·Ry(pitch)·Rz(yaw), as in MoorDyn, those of the FMU of \
                 Rz(yaw)·Ry(pitch)·Rx(roll)"
            }
        };
        format!("{name}: driven by the host, origin at {origin} m{attitude}, carries {carried}{run}{angles}")
    }

    /// Sentence on the effects of the water and the seabed on a point; `None` if neither acts.
    fn sea_in_words(&self, point: &Point) -> Option<String> {
        let water = self.water_at_point(point);
        let other = if point.kind == PointKind::Free {
            self.seabed_at_point(point)
        } else {
            let own = point.mass.is_some() || point.volume.is_some() || point.drag_area.is_some();
            own.then(|| "these forces act on the driving body in addition to those of the lines".to_string())
        };
        let said: Vec<String> = water.into_iter().chain(other).collect();
        (!said.is_empty()).then(|| said.join("; "))
    }

    /// Sentence on the start of a free point.
    fn start_in_words(&self, point: &Point) -> Option<&'static str> {
        let network = match point.kind {
            PointKind::Free => self.network_of(point),
            _ => return None,
        };
        let mut shapes = network.iter().map(|line| &line.initial);
        let settles = shapes.any(|shape| *shape == InitialShape::Static);
        (!network.is_empty()).then_some(match settles {
            true => "starts in static equilibrium",
            false => "starts at the given position, since no line of its network is `static`",
        })
    }

    /// The lines that are connected to a free point, directly or through other free points.
    fn network_of(&self, point: &Point) -> Vec<&Line> {
        let free: Vec<&str> = self.free_points().map(|point| point.name.as_str()).collect();
        let mut joined = vec![point.name.as_str()];
        let (mut network, mut rest): (Vec<&Line>, Vec<&Line>) = (vec![], self.lines.iter().collect());
        loop {
            let (reached, beyond): (Vec<&Line>, _) = rest
                .into_iter()
                .partition(|line| joined.iter().any(|point| line.joins(point)));
            if reached.is_empty() {
                return network;
            }
            let ends = reached
                .iter()
                .flat_map(|line| [line.from.as_str(), line.to.as_str()]);
            joined.extend(ends.filter(|end| free.contains(end)));
            network.extend(reached);
            rest = beyond;
        }
    }

    /// Returns whether the water's surface acts on any free point.
    pub(super) fn surface_matters(&self) -> bool {
        self.free_points().any(|point| self.radius(point).is_some())
    }

    /// Radius of the sphere that represents a point in the water [m]; `None` if the water has no effect on it.
    fn radius(&self, point: &Point) -> Option<f64> {
        self.water.as_ref()?;
        let of = |value: Option<f64>| value.filter(|value| *value > 0.0);
        let by_volume = of(point.volume).map(|volume| (0.75 * volume / PI).cbrt());
        by_volume.or_else(|| of(point.drag_area).map(|area| (area / PI).sqrt()))
    }

    fn water_at_point(&self, point: &Point) -> Option<String> {
        let radius = significant(self.radius(point)?);
        let acts = |value: Option<f64>| value.is_some_and(|value| value > 0.0);
        let volume = acts(point.volume);
        let effects = [
            ("buoyancy", volume),
            ("drag", acts(point.drag_area)),
            ("added mass", volume && acts(point.added_mass)),
        ];
        let of = |acting: bool| effects.iter().filter(move |(_, acts)| *acts == acting);
        let acting: Vec<&str> = of(true).map(|(effect, _)| *effect).collect();
        let absent: String = of(false).map(|(effect, _)| format!(", no {effect}")).collect();
        let acting = join(&acting);
        Some(format!(
            "in the water {acting} of a sphere of radius {radius} m as far as it is below z = 0{absent}"
        ))
    }

    fn seabed_at_point(&self, point: &Point) -> Option<String> {
        let seabed = self.seabed.as_ref()?;
        let weight = point.mass.unwrap_or(0.0) * self.gravity;
        let sinks = point.free.as_ref().is_none_or(|axes| axes.contains(&Axis::Z));
        (weight > 0.0 && sinks && seabed.stiffness > 0.0)
            .then(|| "on the seabed a spring that its weight in air compresses by 0.02 m".to_string())
    }
}

fn role(point: &Point) -> String {
    match (point.kind, &point.on, &point.free) {
        (PointKind::Coupled, Some(vessel), _) => format!("carried by {vessel}"),
        (PointKind::Coupled, None, _) => "coupled to the host".to_string(),
        (PointKind::Prescribed, ..) => "moves along its own path".to_string(),
        (PointKind::Free, _, Some(axes)) => {
            let axes: Vec<&str> = axes.iter().map(|axis| axis.word()).collect();
            format!("free along {} only", join(&axes))
        }
        (kind, ..) => kind.word().to_string(),
    }
}

/// "oscillates by 2.5 m every 12 s in x, 0.05 rad every 10 s in pitch, with a ramp of 15 s", for a sentence on a body.
pub(in crate::scene) fn motion_in_words(motion: &MotionPath) -> String {
    let follows = |what: String, rows: &[MotionRow]| match ranges_in_words(rows) {
        Some(ranges) => format!("follows {what}: {ranges}"),
        None => format!("stays at rest, by {what}"),
    };
    match motion {
        MotionPath::File(file) => {
            let count = file.rows.len();
            let what = format!("the {count} rows of {}, read as {},", file.file, file.columns);
            follows(what, &file.rows)
        }
        MotionPath::Table(rows) => follows(format!("a table of {} rows", rows.len()), rows),
        MotionPath::Harmonic(harmonic) => harmonic_in_words(harmonic),
    }
}

/// "x from 0 to 5 m and pitch from -0.1 to 0.1 rad"; `None` if all rows are zero.
fn ranges_in_words(rows: &[MotionRow]) -> Option<String> {
    let axes = crate::scene::motion_file::AXES.iter().zip(UNITS).enumerate();
    let said = axes.filter_map(|(axis, (name, unit))| {
        let values = rows.iter().map(|row| row[1 + axis]);
        let least = values.clone().fold(f64::INFINITY, f64::min);
        let most = values.fold(f64::NEG_INFINITY, f64::max);
        match (significant(least), significant(most)) {
            _ if least == 0.0 && most == 0.0 => None,
            (value, _) if least == most => Some(format!("{name} at {value} {unit}")),
            (least, most) => Some(format!("{name} from {least} to {most} {unit}")),
        }
    });
    let said: Vec<String> = said.collect();
    (!said.is_empty()).then(|| said.join(" and "))
}

fn harmonic_in_words(harmonic: &HarmonicMotion) -> String {
    let axes = harmonic.axes().into_iter().zip(UNITS);
    let axes = axes.filter_map(|((name, sines), unit)| {
        let sines = sines.iter().filter_map(|sine| {
            let (amplitude, period) = (sine.first()?, sine.get(1)?);
            let (size, period) = (quantity(amplitude.abs(), unit), quantity(*period, "s"));
            (*amplitude != 0.0).then(|| format!("{size} every {period}"))
        });
        let sines: Vec<String> = sines.collect();
        (!sines.is_empty()).then(|| format!("{} in {name}", join(&sines)))
    });
    let axes: Vec<String> = axes.collect();
    if axes.is_empty() {
        return "stays at rest".to_string();
    }
    let ramp = harmonic
        .ramp
        .map(|ramp| format!(", with a ramp of {}", quantity(ramp, "s")));
    format!("oscillates by {}{}", axes.join(", "), ramp.unwrap_or_default())
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
        assert_eq!(said, "oscillates by 0.05 rad every 10 s in pitch");
        motion.x = vec![vec![2.5, 12.0], vec![1.0, 90.0]];
        motion.ramp = Some(15.0);
        let said = motion_in_words(&MotionPath::Harmonic(motion));
        let expected = "oscillates by 2.5 m every 12 s and 1 m every 90 s in x, 0.05 rad every 10 s in pitch, with a ramp of 15 s";
        assert_eq!(said, expected);
        let still = HarmonicMotion {
            x: vec![vec![0.0, 12.0]],
            ..HarmonicMotion::default()
        };
        let said = motion_in_words(&MotionPath::Harmonic(still));
        assert_eq!(said, "stays at rest");
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
        assert_eq!(said, "stays at rest, by a table of 3 rows");
    }
}
