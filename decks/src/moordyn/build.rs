//! MoorDyn deck -> Scene.

use moorline::scene::channel::Channel;
use moorline::scene::{
    self, Current, Friction, InitialShape, Output, PointKind, Sea, Seabed, TensionStrain, Water, Waves,
};

use super::deck::{Attachment, Body, Deck, Line, LineEnd, LineType, Point, Property, Rod};
use super::options::Meaning;
use crate::draft::{Draft, SEA_WATER, constant_force, coordinates, nonzero};
use crate::findings::Placed;

/// Fraction of the depth by which coordinates written with few digits may miss the seabed [-].
const ROUNDING: f64 = 1e-9;
/// File with the wave components.
const WAVES_FILE: &str = "wave_frequencies.txt";
/// File with a steady current.
const CURRENT_FILE: &str = "current_profile.txt";

/// Builds the scene of a deck without refused features; mistakes that remain concern values that the deck leaves to its host.
pub(super) fn build(deck: &Deck, draft: &mut Draft<'_>) {
    draft.scene.title = deck.title.clone();
    let bodies = deck.bodies.iter().map(|body| format!("body{}", body.id.value));
    draft.check_given(bodies.chain(deck.turbines().map(turbine)));
    for kind in &deck.line_types {
        add_line_type(kind, draft);
    }
    for point in &deck.points {
        add_point(point, deck, draft);
    }
    for rod in &deck.rods {
        add_rod(rod, deck, draft);
    }
    surroundings(deck, draft);
    for line in &deck.lines {
        add_line(line, deck, draft);
    }
    output(deck, draft);
    draft.check_vessels();
}

/// Name of the vessel for a turbine of a farm.
fn turbine(number: usize) -> String {
    format!("turbine{number}")
}

/// Value of a numeric property; the other variants have been refused.
fn plain(property: &Property) -> f64 {
    match property {
        Property::Number(value) => *value,
        Property::Parts(_) | Property::Named(_) => 0.0,
    }
}

/// Name of the file in the deck's folder that an option refers to: wave components (7) or a steady current (1); `None` for other options.
pub(super) fn water_file(key: &str, value: &str) -> Option<&'static str> {
    match (key.to_uppercase().as_str(), value) {
        ("WAVEKIN", "7") => Some(WAVES_FILE),
        ("CURRENTS" | "CURRENT", "1") => Some(CURRENT_FILE),
        _ => None,
    }
}

fn add_line_type(kind: &LineType, draft: &mut Draft<'_>) {
    let (ea, ba) = (&kind.stiffness.span, &kind.damping.span);
    let mut parts = vec![
        ("mass", &kind.mass.span, "Mass"),
        ("diameter", &kind.diameter.span, "Diam"),
        ("drag_normal", &kind.drag_normal.span, "Cd"),
        ("drag_tangential", &kind.drag_tangential.span, "CdAx"),
        ("added_mass_normal", &kind.added_mass_normal.span, "Ca"),
        ("added_mass_tangential", &kind.added_mass_tangential.span, "CaAx"),
    ];
    for key in [
        "axial_stiffness",
        "tension_strain",
        "static_stiffness",
        "dynamic_stiffness",
    ] {
        parts.push((key, ea, "EA"));
    }
    for key in [
        "static_damping",
        "dynamic_damping",
        "axial_damping",
        "damping_ratio",
    ] {
        parts.push((key, ba, "BA/-zeta"));
    }
    let bending = kind.bending.iter();
    parts.extend(bending.map(|bending| ("bending_stiffness", &bending.span, "EI")));
    draft.add_line_type(&kind.name, line_type(kind), &parts);
}

fn add_point(point: &Point, deck: &Deck, draft: &mut Draft<'_>) {
    let position = point.position.each_ref().map(|coordinate| coordinate.value);
    let mut made = attached(
        format!("point{}", point.id.value),
        &point.attachment,
        position,
        deck,
        draft,
    );
    if made.kind != PointKind::Fixed {
        made.mass = nonzero(point.mass.value);
        made.volume = nonzero(point.volume.value);
        made.drag_area = nonzero(point.drag_area.value);
        made.added_mass = nonzero(point.added_mass.value);
    }
    let force = point.force.as_ref();
    made.force = force.and_then(|force| constant_force(force.each_ref().map(|part| part.value)));
    let [x, y, z] = coordinates(&point.position);
    let parts = [
        x,
        y,
        z,
        ("on", &point.attachment.span, "Attachment"),
        ("mass", &point.mass.span, "Mass"),
        ("volume", &point.volume.span, "Volume"),
        ("drag_area", &point.drag_area.span, "CdA"),
        ("added_mass", &point.added_mass.span, "Ca"),
    ];
    draft.add_point(made, &point.id.span, &format!("point {}", point.id.value), &parts);
}

/// Returns a point with its attachment. The position [m] is relative to the vessel if the point is carried by one.
fn attached(
    name: String,
    attachment: &Placed<Attachment>,
    position: [f64; 3],
    deck: &Deck,
    draft: &mut Draft<'_>,
) -> scene::Point {
    let point = |kind| scene::Point::at(name, position, kind);
    let origin = [0.0; 3];
    match attachment.value {
        Attachment::Free => point(PointKind::Free),
        Attachment::Coupled if draft.supplement.vessel.is_none() => point(PointKind::Coupled),
        Attachment::Coupled | Attachment::Vessel => {
            let vessel = draft.vessel_of_the_deck();
            draft.aboard(point(PointKind::Coupled), vessel, origin, origin)
        }
        Attachment::Turbine(number) => {
            needs_position(number, attachment, deck, draft);
            draft.aboard(point(PointKind::Coupled), &turbine(number), origin, origin)
        }
        Attachment::Body(id) => match deck.body(id) {
            Some(body) => on_body(point(PointKind::Fixed), body, draft),
            None => point(PointKind::Fixed),
        },
        Attachment::Fixed | Attachment::Pinned(_) | Attachment::CoupledPinned => point(PointKind::Fixed),
    }
}

/// Refuses a turbine of a farm without a position, which the host of the farm provides.
fn needs_position(number: usize, attachment: &Placed<Attachment>, deck: &Deck, draft: &mut Draft<'_>) {
    let several = deck.turbines().any(|other| other != number);
    let name = turbine(number);
    let placed = draft.supplement.positions.contains_key(&name);
    if several && !placed && !draft.has_vessel(&name) {
        let problem = format!(
            "the deck of a farm leaves to its host where the turbines stand: add `--at {name}=X,Y,Z` to the command, once for every \
             turbine"
        );
        draft
            .findings
            .wrong(format!("Turbine{number}"), attachment, problem);
    }
}

fn on_body(point: scene::Point, body: &Body, draft: &mut Draft<'_>) -> scene::Point {
    let place = body.position.each_ref().map(|coordinate| coordinate.value);
    let turn = turn_of(body);
    if body.attachment.value == Attachment::Fixed {
        let turned = applied(&turn, point.position);
        return scene::Point {
            position: [0, 1, 2].map(|axis| place[axis] + turned[axis]),
            ..point
        };
    }
    let name = format!("body{}", body.id.value);
    if !draft.has_vessel(&name) {
        let at = format!("vessels[{}]", draft.scene.vessels.len());
        draft.place(&at, &body.id.span, &format!("body {}", body.id.value), &[]);
    }
    draft.aboard(point, &name, place, attitude(&turn))
}

/// Adds the ends of a rod that lines are attached to. Rods that do more than hold lines have been refused.
fn add_rod(rod: &Rod, deck: &Deck, draft: &mut Draft<'_>) {
    let words = format!("rod {}", rod.id.value);
    let mut used = false;
    for (index, letter) in ["a", "b"].into_iter().enumerate() {
        let end = LineEnd::Rod(rod.id.value, index == 1);
        let mut ends = deck.lines.iter().flat_map(|line| &line.ends);
        if !ends.any(|placed| placed.value == end) {
            continue;
        }
        used = true;
        // The two ends of a rod of zero length are the same point, end A.
        let place = &rod.ends[if rod.segments.value == 0 { 0 } else { index }];
        let position = place.each_ref().map(|coordinate| coordinate.value);
        let name = format!("rod{}{letter}", rod.id.value);
        let point = attached(name, &rod.attachment, position, deck, draft);
        draft.add_point(point, &rod.id.span, &words, &coordinates(place));
    }
    let text = match (used, rod.segments.value) {
        (true, 0) => {
            "only holds the end of a line, in its own direction where the line has EI; in MoorDyn 2.7.2 a rod without segments turns freely"
        }
        (true, _) => "only holds the end of a line, in its own direction where the line has EI",
        (false, _) => "holds no line and is left out",
    };
    draft.findings.remark(&rod.id, format!("{words} {text}"));
}

/// Gravity, water and seabed.
fn surroundings(deck: &Deck, draft: &mut Draft<'_>) {
    let options = &deck.options;
    let mut option = |at: &str, meaning, key: &str| {
        let given = options.numbers.get(&meaning)?;
        draft.places.put(at, &given.span, format!("OPTIONS, {key}"));
        Some(given.value)
    };
    let gravity = option("gravity", Meaning::Gravity, "g");
    let density = option("water.density", Meaning::Density, "rho");
    let stiffness = option("seabed.stiffness", Meaning::SeabedStiffness, "kBot");
    let damping = option("seabed.damping", Meaning::SeabedDamping, "cBot");
    draft.scene.gravity = gravity.unwrap_or(draft.scene.gravity);
    let mut water = Water::still(density.unwrap_or(SEA_WATER));
    moving_water(deck, &mut water, draft);
    draft.scene.water = Some(water);
    let file = soundings(deck, draft);
    let given = options.depth.as_ref().and_then(|depth| match depth.value {
        Property::Number(value) if file.is_some() => Some(value),
        Property::Number(value) => Some(down_to_the_anchors(&depth.with(value), draft)),
        _ => None,
    });
    let Some(depth) = draft.depth(given, file.is_some()) else {
        return;
    };
    if let Some(depth) = &options.depth {
        draft.places.put("seabed.depth", &depth.span, "OPTIONS, WtrDpth");
    }
    let level = Seabed::level(depth);
    draft.scene.seabed = Some(Seabed {
        stiffness: stiffness.unwrap_or(level.stiffness),
        damping: damping.unwrap_or(level.damping),
        friction: friction(deck, draft),
        file,
        ..level
    });
}

/// Returns the depth of a deck [m], increased to its deepest anchor if WtrDpth is less.
fn down_to_the_anchors(given: &Placed<f64>, draft: &mut Draft<'_>) -> f64 {
    let depth = given.value;
    let Some(anchor) = draft.deepest_anchor() else {
        return depth;
    };
    let anchored = -anchor.position[2];
    if !depth.is_finite() || anchored <= depth + ROUNDING * depth.abs().max(1.0) {
        return depth;
    }
    let text = format!(
        "WtrDpth {depth} m is less than the depth of {}, {anchored} m: the water is taken to be {anchored} m deep everywhere",
        anchor.name
    );
    draft.findings.remark(given, text);
    anchored
}

/// Reads waves and current from files in the folder of the deck.
fn moving_water(deck: &Deck, water: &mut Water, draft: &mut Draft<'_>) {
    for (key, value) in &deck.options.surroundings {
        let Some(name) = water_file(key, &value.value) else {
            continue;
        };
        let text = format!(
            "{key} {}: read from {name} in the folder of this file",
            value.value
        );
        draft.findings.remark(value, text);
        let file = Some(name.to_string());
        let at = if name == WAVES_FILE {
            let sea = Sea {
                file,
                ..Sea::default()
            };
            water.waves = Some(Waves { seas: vec![sea] });
            "water.waves"
        } else {
            water.current = Some(Current {
                file,
                ..Current::default()
            });
            "water.current"
        };
        draft.places.put(at, &value.span, format!("OPTIONS, {key}"));
    }
}

/// Returns the file of seabed depths, named instead of the depth or by its own option.
fn soundings(deck: &Deck, draft: &mut Draft<'_>) -> Option<String> {
    let named = deck.options.depth.as_ref().and_then(|depth| match &depth.value {
        Property::Named(name) => Some(depth.with(name.clone())),
        _ => None,
    });
    let file = named.or(deck.options.soundings.clone())?;
    for at in ["seabed.file", "seabed.grid"] {
        draft.places.put(at, &file.span, "OPTIONS, bathymetry");
    }
    Some(file.value.trim_matches('"').to_string())
}

/// Reads the friction of the seabed: one coefficient for all directions, or one across and one along the line.
fn friction(deck: &Deck, draft: &mut Draft<'_>) -> Friction {
    let coefficient = |key: &str| {
        let mut all = deck.options.friction.iter();
        all.find(|(other, _)| other.eq_ignore_ascii_case(key))
    };
    let whole = coefficient("FrictionCoefficient");
    let across = coefficient("mu_kT").or(whole);
    let along = coefficient("mu_kA").or(whole);
    for (at, given) in [
        ("seabed.friction.transverse", across),
        ("seabed.friction.axial", along),
        ("seabed.friction", along.or(across)),
    ] {
        if let Some((key, coefficient)) = given {
            draft.places.put(at, &coefficient.span, format!("OPTIONS, {key}"));
        }
    }
    let value = |given: Option<&(String, Placed<f64>)>| given.map_or(0.0, |(_, c)| c.value);
    Friction {
        transverse: value(across),
        axial: value(along),
    }
}

fn add_line(line: &Line, deck: &Deck, draft: &mut Draft<'_>) {
    let ends = line.ends.each_ref().map(|end| match end.value {
        LineEnd::Point(id) => format!("point{id}"),
        LineEnd::Rod(id, at_b) => format!("rod{id}{}", if at_b { "b" } else { "a" }),
    });
    let (name, elements) = (format!("line{}", line.id.value), Some(line.segments.value));
    let mut made = draft.line(name, ends, &line.line_type.value, line.length.value, elements);
    let line_type = &draft.scene.line_types[&made.sections[0].line_type];
    if line_type.damping_ratio.is_some() {
        made.sections[0].damping_elements = elements;
    }
    if line_type.bending_stiffness.is_some() {
        made.clamped_a = clamp(&line.ends[0], true, deck, draft);
        made.clamped_b = clamp(&line.ends[1], false, deck, draft);
    }
    if deck.options.starts_at_once.is_some() {
        made.initial = InitialShape::Catenary;
    }
    let parts = [
        ("from", &line.ends[0].span, "AttachA"),
        ("to", &line.ends[1].span, "AttachB"),
        ("sections[0].type", &line.line_type.span, "LineType"),
        ("sections[0].length", &line.length.span, "UnstrLen"),
        ("sections[0].elements", &line.segments.span, "NumSegs"),
    ];
    draft.add_line(made, &line.id.span, &format!("line {}", line.id.value), &parts);
}

/// Returns the direction from A to B, in global axes [-], of a line that leaves a rod at line end A or arrives at a rod at line end B: the line
/// continues the rod.
fn clamp(end: &Placed<LineEnd>, leaves: bool, deck: &Deck, draft: &mut Draft<'_>) -> Option<[f64; 3]> {
    let LineEnd::Rod(id, at_b) = end.value else {
        return None;
    };
    let rod = deck.rods.iter().find(|rod| rod.id.value == id)?;
    let along = axis(rod);
    if along == [0.0; 3] {
        let problem = "the two ends of the rod are the same point, so it has no direction to hold the line in: \
                       write an Xb Yb Zb that differs from Xa Ya Za";
        draft
            .findings
            .wrong(format!("rod {id}"), &rod.ends[1][0], problem);
        return None;
    }
    let body = match rod.attachment.value {
        Attachment::Body(id) => deck.body(id),
        _ => None,
    };
    let along = body.map_or(along, |body| applied(&turn_of(body), along));
    // A line that leaves at B or arrives at A is directed along the rod; one that leaves at A or arrives at B is directed against it.
    let sign = if leaves == at_b { 1.0 } else { -1.0 };
    Some(along.map(|part| sign * part))
}

/// Sets the output channels and the output interval, with a duration that holds one interval.
fn output(deck: &Deck, draft: &mut Draft<'_>) {
    for placed in &deck.outputs {
        let name = &placed.value;
        // MoorDyn warns of these and continues.
        if ["FX", "FY", "FZ"].contains(&name.to_uppercase().as_str()) {
            let text =
                format!("the output {name:?} names no object, and MoorDyn writes none for it: left out");
            draft.findings.remark(placed, text);
            continue;
        }
        let channels = &draft.scene.output.channels;
        let twice = channels
            .contains(name)
            .then(|| "it stands there already".to_string());
        let known = Channel::parse(name).and_then(|channel| channel.check(&draft.scene));
        if let Some(problem) = known.err().or(twice) {
            let text = format!("the output {name:?} is left out: {problem}");
            draft.findings.remark(placed, text);
            continue;
        }
        let at = format!("output.channels[{}]", channels.len());
        draft.places.put(at, &placed.span, format!("OUTPUTS, {name}"));
        draft.scene.output.channels.push(name.clone());
    }
    let interval = deck.options.numbers.get(&Meaning::OutputInterval);
    if let Some(interval) = interval.filter(|interval| interval.value != 0.0) {
        draft
            .places
            .put("output.interval", &interval.span, "OPTIONS, dtOut");
        draft.scene.output.interval = interval.value;
        draft.scene.output.duration = Output::default().duration.max(interval.value);
    }
}

/// Returns a line type with its axial stiffness and damping.
fn stretch(kind: &LineType) -> scene::LineType {
    let mut line_type = scene::LineType::default();
    let (slow, damping) = match &kind.damping.value {
        Property::Parts(parts) => (parts[0], parts[1]),
        number => (plain(number), plain(number)),
    };
    match &kind.stiffness.value {
        Property::Parts(parts) => {
            line_type.static_stiffness = Some(parts[0]);
            line_type.dynamic_stiffness = Some(parts[1]);
            line_type.static_damping = Some(slow);
            let both = matches!(kind.damping.value, Property::Parts(_));
            let fast = if both { damping } else { 0.0 }; // MoorDyn's interpretation of a single BA
            line_type.dynamic_damping = (fast >= 0.0).then_some(fast);
            line_type.damping_ratio = (fast < 0.0).then_some(-fast);
            return line_type;
        }
        Property::Named(file) => line_type.tension_strain = Some(TensionStrain::from_file(file)),
        Property::Number(stiffness) => line_type.axial_stiffness = Some(*stiffness),
    }
    line_type.axial_damping = (damping >= 0.0).then_some(damping);
    line_type.damping_ratio = (damping < 0.0).then_some(-damping);
    line_type
}

fn line_type(kind: &LineType) -> scene::LineType {
    scene::LineType {
        mass: Some(kind.mass.value),
        diameter: Some(kind.diameter.value),
        bending_stiffness: kind
            .bending
            .as_ref()
            .and_then(|bending| nonzero(plain(&bending.value))),
        drag_normal: nonzero(kind.drag_normal.value),
        drag_tangential: nonzero(kind.drag_tangential.value),
        added_mass_normal: nonzero(kind.added_mass_normal.value),
        added_mass_tangential: nonzero(kind.added_mass_tangential.value),
        ..stretch(kind)
    }
}

/// Unit vector of a rod from A to B [-]; zero if the ends coincide.
fn axis(rod: &Rod) -> [f64; 3] {
    let along = [0, 1, 2].map(|axis| rod.ends[1][axis].value - rod.ends[0][axis].value);
    let length = along.iter().map(|part| part * part).sum::<f64>().sqrt();
    if length > 0.0 && length.is_finite() {
        along.map(|part| part / length)
    } else {
        [0.0; 3]
    }
}

/// Rotation matrix of a body.
fn turn_of(body: &Body) -> [[f64; 3]; 3] {
    rotation([0, 1, 2].map(|axis| body.attitude[axis].value.to_radians()))
}

/// Product of a matrix, given by rows, and a vector.
fn applied(turn: &[[f64; 3]; 3], vector: [f64; 3]) -> [f64; 3] {
    turn.map(|row| (0..3).map(|axis| row[axis] * vector[axis]).sum::<f64>())
}

/// Rows of the rotation matrix from body axes to global axes, R = Rx·Ry·Rz of the angles [rad], as in MoorDyn.
fn rotation([roll, pitch, yaw]: [f64; 3]) -> [[f64; 3]; 3] {
    let ((s1, c1), (s2, c2), (s3, c3)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
    [
        [c2 * c3, -c2 * s3, s2],
        [c1 * s3 + c3 * s1 * s2, c1 * c3 - s1 * s2 * s3, -c2 * s1],
        [s1 * s3 - c1 * c3 * s2, c3 * s1 + c1 * s2 * s3, c1 * c2],
    ]
}

/// Roll, pitch and yaw [rad] of the same rotation in the order of scenes, R = Rz·Ry·Rx.
fn attitude(turn: &[[f64; 3]; 3]) -> [f64; 3] {
    let pitch = (0.0 - turn[2][0]).clamp(-1.0, 1.0).asin();
    [turn[2][1].atan2(turn[2][2]), pitch, turn[1][0].atan2(turn[0][0])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attitudes_about_one_axis_mean_the_same_in_both_orders() {
        for axis in 0..3 {
            let mut angles = [0.0; 3];
            angles[axis] = 0.3;
            let same = attitude(&rotation(angles));
            for (angle, same) in angles.iter().zip(same) {
                assert!((angle - same).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn an_attitude_about_all_axes_is_the_same_turn() {
        let turn = rotation([0.2, -0.4, 0.7]);
        let [roll, pitch, yaw] = attitude(&turn);
        let ((s1, c1), (s2, c2), (s3, c3)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
        let same = [
            [c2 * c3, s1 * s2 * c3 - c1 * s3, c1 * s2 * c3 + s1 * s3],
            [c2 * s3, s1 * s2 * s3 + c1 * c3, c1 * s2 * s3 - s1 * c3],
            [-s2, s1 * c2, c1 * c2],
        ];
        for (row, same) in turn.iter().zip(same) {
            for (entry, same) in row.iter().zip(same) {
                assert!((entry - same).abs() < 1e-14);
            }
        }
    }
}
