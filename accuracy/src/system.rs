//! The scene as read by the peers' script: only the properties that all codes have.
//!
//! A scene with any other property is refused, and the error names the owner of the property: without it, the peers would simulate a different
//! system. Damping and positions at rest are those of moorline's model, in which a damping ratio and an open damping have values in N s.

use moorline::model::{Line as ModelLine, Model, Role};
use moorline::scene::{
    HarmonicMotion, Integrator, Line, LineType, MotionPath, Point, PointKind, Scene, Seabed, Vessel, Water,
};
use moorline::simulation::Simulation;
use nalgebra::Vector3;
use serde_json::{Value, json};

use crate::ladder::{HOST_STEPS, Setting};

/// Elements of the longest line in runs of the peers [-].
const ELEMENTS: [usize; 23] = [
    3, 4, 5, 6, 7, 8, 10, 12, 14, 17, 20, 24, 28, 34, 40, 44, 48, 52, 56, 62, 68, 74, 80,
];
/// Index of the coarsest of these meshes for lines on a seabed: fewer elements do not resolve the touchdown.
const ELEMENTS_ON_SEABED: usize = 5;
/// Greatest processor time of all passes of a single run of a peer [s].
const TIME_LIMIT: f64 = 60.0;
/// Elements of the longest line of the model from which positions at rest are taken [-].
const ELEMENTS_AT_REST: usize = 40;

/// Returns the scene as input of `peers.py`. The error names the owner of a property that the input does not contain.
pub(crate) fn described(name: &str, scene: &Scene) -> Result<Value, String> {
    admit_surroundings(scene)?;
    let meshed = Setting::new(ELEMENTS_AT_REST, Integrator::Auto, None).apply(scene);
    let rest = Simulation::new(&meshed).map_err(|error| error.to_string())?;
    let model = rest.model();
    let points = model.points.iter().zip(&scene.points);
    let points = points.enumerate().map(|(index, (point, written))| {
        let at_rest = rest.state().points[index].position;
        described_point(scene, written, &point.role, model, at_rest)
    });
    let lines = model.lines.iter().zip(&meshed.lines);
    let lines = lines.enumerate().map(|(index, (line, written))| {
        let profile = rest.state().lines[index].position.as_slice();
        described_line(&meshed, written, line, profile)
    });
    let lies = (0..model.lines.len()).any(|line| rest.laid_length(line) > 0.0);
    Ok(json!({
        "name": name,
        "gravity": scene.gravity,
        "density": scene.water.as_ref().map(|water| water.density),
        "seabed": scene.seabed.as_ref().map(|seabed| json!({
            "depth": seabed.depth, "stiffness": seabed.stiffness, "damping": seabed.damping,
        })),
        "lies_on_seabed": lies,
        "points": points.collect::<Result<Vec<Value>, String>>()?,
        "lines": lines.collect::<Result<Vec<Value>, String>>()?,
        "duration": scene.output.duration,
        "interval": scene.output.interval,
        "elements": &ELEMENTS[if lies { ELEMENTS_ON_SEABED } else { 0 }..],
        "hosts": HOST_STEPS,
        "time_limit_seconds": TIME_LIMIT,
    }))
}

/// Returns an error if `whole`, described by `what`, differs from the part of it that is given to the peers.
fn only<T: PartialEq>(whole: &T, given: &T, what: &str) -> Result<(), String> {
    match whole == given {
        true => Ok(()),
        false => Err(format!("{what} has properties that the peers are not given")),
    }
}

/// Refuses everything but still water over a level seabed without friction.
fn admit_surroundings(scene: &Scene) -> Result<(), String> {
    if let Some(water) = &scene.water {
        only(water, &Water::still(water.density), "the water")?;
    }
    if let Some(seabed) = &scene.seabed {
        let level = Seabed {
            depth: seabed.depth,
            stiffness: seabed.stiffness,
            damping: seabed.damping,
            contact: seabed.contact,
            ..Seabed::default()
        };
        only(seabed, &level, "the seabed")?;
    }
    Ok(())
}

/// Point at its position at rest [m], with its motion if a host drives it.
fn described_point(
    scene: &Scene,
    written: &Point,
    role: &Role,
    model: &Model,
    at_rest: Vector3<f64>,
) -> Result<Value, String> {
    let name = &written.name;
    let given = Point {
        on: written.on.clone(),
        mass: written.mass,
        volume: written.volume,
        drag_area: written.drag_area,
        added_mass: written.added_mass,
        ..Point::at(name.clone(), written.position, written.kind)
    };
    only(written, &given, &format!("point `{name}`"))?;
    let or_zero = |value: Option<f64>| value.unwrap_or(0.0);
    let own = [
        written.mass,
        written.volume,
        written.drag_area,
        written.added_mass,
    ]
    .map(or_zero);
    let ends = scene.lines.iter().filter(|line| line.joins(name)).count();
    let (kind, motion) = match role {
        Role::Free(_) => ("free", None),
        Role::Fixed => ("fixed", None),
        Role::Prescribed(_) => return Err(format!("point `{name}` follows a path of its own")),
        Role::Coupled { .. } | Role::Carried { .. } if ends != 1 || own != [0.0; 4] => {
            return Err(format!(
                "point `{name}` is driven, so it must be massless and have one line"
            ));
        }
        Role::Coupled { .. } => {
            let at_origin = (written.position, [0.0; 3], [0.0; 3]);
            ("coupled", Some(described_motion(scene, name, at_origin)?))
        }
        Role::Carried { vessel, .. } => {
            let name = &model.vessels[*vessel].name;
            let vessel = scene.vessels.iter().find(|vessel| vessel.name == *name);
            let Vessel {
                position, attitude, ..
            } = *vessel.ok_or("the vessel is lost")?;
            let frame = (position, attitude, written.position);
            ("coupled", Some(described_motion(scene, name, frame)?))
        }
    };
    let [mass, volume, drag_area, added_mass] = own;
    Ok(json!({
        "kind": kind, "position": at_rest.as_slice(), "motion": motion,
        "mass": mass, "volume": volume, "drag_area": drag_area, "added_mass": added_mass,
    }))
}

/// Motion of the point at `arm` [m] of a body at a position [m] and an attitude [rad].
fn described_motion(
    scene: &Scene,
    body: &str,
    (position, attitude, arm): ([f64; 3], [f64; 3], [f64; 3]),
) -> Result<Value, String> {
    let still = HarmonicMotion::default();
    let motion = match scene.motion.get(body) {
        None => &still,
        Some(MotionPath::Harmonic(motion)) => motion,
        Some(_) => {
            return Err(format!(
                "the motion of `{body}` is a table; peers follow sums of sines"
            ));
        }
    };
    Ok(json!({
        "position": position, "attitude": attitude, "arm": arm,
        "sines": [motion.x, motion.y, motion.z, motion.roll, motion.pitch, motion.yaw],
        "ramp": motion.ramp.unwrap_or(0.0),
    }))
}

/// Line, its sections with their properties, and the positions at rest of the joints between them [m].
fn described_line(
    scene: &Scene,
    written: &Line,
    line: &ModelLine,
    profile: &[Vector3<f64>],
) -> Result<Value, String> {
    let name = &written.name;
    let given = Line {
        elements: written.elements,
        clamped_a: written.clamped_a,
        clamped_b: written.clamped_b,
        ..Line::between(name, &written.from, &written.to, written.sections.clone())
    };
    only(written, &given, &format!("line `{name}`"))?;
    let mut sections = Vec::new();
    let mut first = 0;
    for section in &written.sections {
        let line_type = &scene.line_types[&section.line_type];
        let mut described = described_type(&section.line_type, line_type)?;
        described["length"] = json!(section.length);
        described["axial_damping"] = json!(line.segments.axial_damping[first]);
        described["start"] = json!(profile[first].as_slice());
        first += section.elements.ok_or("a section without elements")?;
        sections.push(described);
    }
    let index = |name: &str| scene.points.iter().position(|point| point.name == name);
    let driven = |name: &str| {
        let mut points = scene.points.iter();
        points.any(|point| point.name == name && point.kind == PointKind::Coupled)
    };
    Ok(json!({
        "from": index(&written.from), "to": index(&written.to), "sections": sections,
        "has_surface": line.surface.is_some(), "clamped": [written.clamped_a, written.clamped_b],
        "driven": match [&written.from, &written.to].map(|end| driven(end)) {
            [_, true] => Some("b"),
            [true, false] => Some("a"),
            [false, false] => None,
        },
    }))
}

/// Properties of a line type except its damping.
fn described_type(name: &str, line_type: &LineType) -> Result<Value, String> {
    let given = LineType {
        axial_stiffness: line_type.axial_stiffness,
        bending_stiffness: line_type.bending_stiffness,
        mass: line_type.mass,
        diameter: line_type.diameter,
        axial_damping: line_type.axial_damping,
        damping_ratio: line_type.damping_ratio,
        drag_normal: line_type.drag_normal,
        drag_tangential: line_type.drag_tangential,
        added_mass_normal: line_type.added_mass_normal,
        added_mass_tangential: line_type.added_mass_tangential,
        ..LineType::default()
    };
    only(line_type, &given, &format!("line type `{name}`"))?;
    let needed =
        |value: Option<f64>, key: &str| value.ok_or_else(|| format!("line type `{name}` has no {key}"));
    let or_zero = |value: Option<f64>| value.unwrap_or(0.0);
    Ok(json!({
        "mass": needed(line_type.mass, "mass")?,
        "diameter": needed(line_type.diameter, "diameter")?,
        "axial_stiffness": needed(line_type.axial_stiffness, "axial_stiffness")?,
        "bending_stiffness": or_zero(line_type.bending_stiffness),
        "drag_normal": or_zero(line_type.drag_normal),
        "drag_tangential": or_zero(line_type.drag_tangential),
        "added_mass_normal": or_zero(line_type.added_mass_normal),
        "added_mass_tangential": or_zero(line_type.added_mass_tangential),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use moorline::scene::{Current, Friction, LineEnd, Strain};

    const BRIDLE: &str = include_str!("../../scenes/bridle.toml");

    fn described_with(edit: impl Fn(&mut Scene)) -> Result<Value, String> {
        let mut scene = Scene::from_toml(BRIDLE).unwrap();
        edit(&mut scene);
        described("bridle", &scene)
    }

    #[test]
    fn a_system_is_described_with_its_damping_its_driven_ends_and_its_places_at_rest() {
        let system = described_with(|_| ()).unwrap();
        let driven: Vec<_> = (0..3)
            .map(|line| system["lines"][line]["driven"].as_str())
            .collect();
        assert_eq!(driven, [Some("b"), Some("b"), None]);
        assert!(
            system["lines"][0]["sections"][0]["axial_damping"]
                .as_f64()
                .unwrap()
                > 0.0
        );
        let [port, plate] = [0, 2].map(|point| &system["points"][point]);
        assert_eq!(port["motion"]["arm"], json!([20.0, 8.0, -2.0]));
        assert_eq!(port["motion"]["sines"][0], json!([[1.5, 11.0]]));
        // The plate sinks from its position in the scene.
        assert!(plate["position"][2].as_f64().unwrap() < -10.0);
        assert_eq!(system["lies_on_seabed"], json!(true));
    }

    #[test]
    fn properties_that_the_peers_are_not_given_are_refused_by_their_owner() {
        let refused = |edit: &dyn Fn(&mut Scene)| described_with(edit).unwrap_err();
        let friction = refused(&|scene| scene.seabed.as_mut().unwrap().friction = Friction::isotropic(0.5));
        assert!(friction.starts_with("the seabed has"), "{friction}");
        let current = refused(&|scene| scene.water.as_mut().unwrap().current = Some(Current::default()));
        assert!(current.starts_with("the water has"), "{current}");
        let strain = refused(&|scene| scene.line_types.get_mut("chain").unwrap().strain = Strain::Green);
        assert!(strain.starts_with("line type `chain` has"), "{strain}");
        let heavy = refused(&|scene| scene.points[0].mass = Some(10.0));
        assert!(heavy.starts_with("point `port` is driven"), "{heavy}");
        let release = refused(&|scene| scene.lines[0].release = Some(LineEnd::A));
        assert!(release.starts_with("line `leg_port` has"), "{release}");
        let table = refused(&|scene| {
            let rows = vec![[0.0; 7], [1.0; 7]];
            scene.motion.insert("barge".into(), MotionPath::Table(rows));
        });
        assert!(table.starts_with("the motion of `barge`"), "{table}");
    }
}
