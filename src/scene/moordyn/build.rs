//! Deck -> Scene.

use std::collections::{BTreeMap, BTreeSet};

use super::deck::{Attachment, Body, Deck, Line, LineEnd, LineType, Point, Property, Rod};
use crate::scene::channel::Channel;
use crate::scene::from_deck::{self, SEA_WATER, Vessels, place_position};
use crate::scene::rows::{Findings, Placed};
use crate::scene::{
    self, AngleOrder, Current, Friction, InitialShape, Output, Places, PointForce, PointKind, Scene, Sea,
    Seabed, Section, Supplement, TensionStrain, TimeFunction, Water, Waves,
};

/// A deck on its way to a scene.
struct Builder<'d> {
    deck: &'d Deck,
    scene: Scene,
    vessels: Vessels<'d>,
    places: &'d mut Places,
    findings: &'d mut Findings,
    /// Line types by the name in the deck.
    types: BTreeMap<&'d str, String>,
}

/// The scene of a deck without refusals; `None` where something it leaves to its host is missing.
pub(super) fn scene(
    deck: &Deck,
    supplement: &Supplement,
    places: &mut Places,
    findings: &mut Findings,
) -> Option<Scene> {
    let mut builder = Builder {
        deck,
        scene: Scene {
            title: deck.title.clone(),
            ..Scene::default()
        },
        vessels: Vessels {
            supplement,
            motion_angles: AngleOrder::Xyz,
        },
        places,
        findings,
        types: BTreeMap::new(),
    };
    builder
        .vessels
        .check_given(names_of_vessels(deck), builder.findings);
    builder.line_types();
    builder.points();
    builder.rods();
    builder.surroundings(supplement);
    builder.lines();
    builder.output();
    let Builder {
        scene,
        vessels,
        findings,
        ..
    } = builder;
    vessels.check(&scene, findings);
    findings.mistakes.is_empty().then_some(scene)
}

/// Vessels that the bodies and turbines of a deck become.
fn names_of_vessels(deck: &Deck) -> impl Iterator<Item = String> {
    let turbines = deck
        .points
        .iter()
        .filter_map(|point| match point.attachment.value {
            Attachment::Turbine(number) => Some(format!("turbine{number}")),
            _ => None,
        });
    let bodies = deck.bodies.iter();
    bodies
        .map(|body| format!("body{}", body.id.value))
        .chain(turbines)
}

/// A number of a property; refusals have left no other.
fn plain(property: &Property) -> f64 {
    match property {
        Property::Number(value) => *value,
        Property::Parts(_) | Property::Named(_) => 0.0,
    }
}

/// Zero says that there is none.
fn given(value: f64) -> Option<f64> {
    (value != 0.0).then_some(value)
}

/// Share of the depth by which positions typed with few digits may miss the seabed [-].
const ROUNDING: f64 = 1e-9;

/// File of the components of waves.
const WAVES_FILE: &str = "wave_frequencies.txt";
/// File of a steady current.
const CURRENT_FILE: &str = "current_profile.txt";

/// The file beside a deck that an option asks for: of waves by components (7), or of a steady current (1); `None` of other options.
pub(super) fn water_file(key: &str, value: &str) -> Option<&'static str> {
    match (key.to_uppercase().as_str(), value) {
        ("WAVEKIN", "7") => Some(WAVES_FILE),
        ("CURRENTS" | "CURRENT", "1") => Some(CURRENT_FILE),
        _ => None,
    }
}

impl<'d> Builder<'d> {
    fn line_types(&mut self) {
        let mut taken = BTreeSet::new();
        for kind in &self.deck.line_types {
            let name = from_deck::type_name(&kind.name.value, &taken);
            from_deck::remark_on_name(&kind.name, &name, self.findings);
            taken.insert(name.clone());
            self.place_line_type(&name, kind);
            self.types.insert(&kind.name.value, name.clone());
            self.scene.line_types.insert(name, line_type(kind));
        }
    }

    fn place_line_type(&mut self, name: &str, kind: &LineType) {
        let at = format!("line_types.{}", scene::path::quoted(name));
        let words = format!("line type {}", kind.name.value);
        self.places.put(at.clone(), &kind.name.span, words.clone());
        let cells = [
            ("mass", &kind.mass, "Mass"),
            ("diameter", &kind.diameter, "Diam"),
            ("drag_normal", &kind.drag_normal, "Cd"),
            ("drag_tangential", &kind.drag_tangential, "CdAx"),
            ("added_mass_normal", &kind.added_mass_normal, "Ca"),
            ("added_mass_tangential", &kind.added_mass_tangential, "CaAx"),
        ];
        for (key, cell, column) in cells {
            self.places
                .put(format!("{at}.{key}"), &cell.span, format!("{words}, {column}"));
        }
        let properties = [
            ("axial_stiffness", Some(&kind.stiffness), "EA"),
            ("tension_strain", Some(&kind.stiffness), "EA"),
            ("static_stiffness", Some(&kind.stiffness), "EA"),
            ("dynamic_stiffness", Some(&kind.stiffness), "EA"),
            ("static_damping", Some(&kind.damping), "BA/-zeta"),
            ("dynamic_damping", Some(&kind.damping), "BA/-zeta"),
            ("axial_damping", Some(&kind.damping), "BA/-zeta"),
            ("damping_ratio", Some(&kind.damping), "BA/-zeta"),
            ("bending_stiffness", kind.bending.as_ref(), "EI"),
        ];
        for (key, cell, column) in properties {
            if let Some(cell) = cell {
                self.places
                    .put(format!("{at}.{key}"), &cell.span, format!("{words}, {column}"));
            }
        }
    }

    fn points(&mut self) {
        for point in &self.deck.points {
            let at = format!("points[{}]", self.scene.points.len());
            let words = format!("point {}", point.id.value);
            self.places.put(at.clone(), &point.id.span, words.clone());
            self.places
                .put(format!("{at}.on"), &point.attachment.span, words.clone());
            place_position(self.places, &at, &words, &point.position);
            for (key, cell, column) in [
                ("mass", &point.mass, "Mass"),
                ("volume", &point.volume, "Volume"),
                ("drag_area", &point.drag_area, "CdA"),
                ("added_mass", &point.added_mass, "Ca"),
            ] {
                self.places
                    .put(format!("{at}.{key}"), &cell.span, format!("{words}, {column}"));
            }
            let position = [0, 1, 2].map(|axis| point.position[axis].value);
            let mut made = self.attached(format!("point{}", point.id.value), &point.attachment, position);
            if made.kind != PointKind::Fixed {
                made.mass = given(point.mass.value);
                made.volume = given(point.volume.value);
                made.drag_area = given(point.drag_area.value);
                made.added_mass = given(point.added_mass.value);
            }
            made.force = point_force(point);
            self.scene.points.push(made);
        }
    }

    /// A point at what its deck attaches it to; the position [m] is in the frame of a vessel where it rides on one.
    fn attached(
        &mut self,
        name: String,
        attachment: &Placed<Attachment>,
        position: [f64; 3],
    ) -> scene::Point {
        let free = scene::Point::at(name, position, PointKind::Fixed);
        let origin = [0.0; 3];
        match attachment.value {
            Attachment::Free => scene::Point {
                kind: PointKind::Free,
                ..free
            },
            Attachment::Coupled if self.vessels.of_all().is_none() => scene::Point {
                kind: PointKind::Coupled,
                ..free
            },
            Attachment::Coupled | Attachment::Vessel => {
                let name = self.vessels.of_the_deck().to_string();
                self.aboard(free, &name, origin, origin)
            }
            Attachment::Turbine(number) => {
                self.needs_position(number, attachment);
                self.aboard(free, &format!("turbine{number}"), origin, origin)
            }
            Attachment::Body(id) => {
                let mut bodies = self.deck.bodies.iter();
                match bodies.find(|body| body.id.value == id) {
                    Some(body) => self.on_body(free, body),
                    None => free,
                }
            }
            Attachment::Fixed | Attachment::Pinned(_) | Attachment::CoupledPinned => free,
        }
    }

    fn aboard(
        &mut self,
        point: scene::Point,
        vessel: &str,
        position: [f64; 3],
        attitude: [f64; 3],
    ) -> scene::Point {
        let name = self.vessels.board(&mut self.scene, vessel, position, attitude);
        scene::Point {
            kind: PointKind::Coupled,
            on: Some(name),
            ..point
        }
    }

    /// A farm's host knows where its turbines stand.
    fn needs_position(&mut self, number: usize, attachment: &Placed<Attachment>) {
        let mut numbers = self
            .deck
            .points
            .iter()
            .filter_map(|point| match point.attachment.value {
                Attachment::Turbine(number) => Some(number),
                _ => None,
            });
        let several = numbers.any(|other| other != number);
        let name = format!("turbine{number}");
        let placed = self.vessels.supplement.positions.contains_key(&name);
        let told = self.scene.vessels.iter().any(|vessel| vessel.name == name);
        if several && !placed && !told {
            self.findings.mistake(
                format!("Turbine{number}"),
                attachment.span.clone(),
                format!(
                    "the deck of a farm leaves to its host where the turbines stand: say it with `moorline convert DECK \
                     --at {name}=X,Y,Z -o scene.toml`, once for every turbine"
                ),
            );
        }
    }

    fn on_body(&mut self, point: scene::Point, body: &Body) -> scene::Point {
        let place = [0, 1, 2].map(|axis| body.position[axis].value);
        let turn = turn_of(body);
        if body.attachment.value == Attachment::Fixed {
            let turned = applied(&turn, point.position);
            return scene::Point {
                position: [0, 1, 2].map(|axis| place[axis] + turned[axis]),
                ..point
            };
        }
        let name = format!("body{}", body.id.value);
        let index = self.scene.vessels.len();
        let known = self.scene.vessels.iter().any(|vessel| vessel.name == name);
        if !known {
            let words = format!("body {}", body.id.value);
            self.places.put(format!("vessels[{index}]"), &body.id.span, words);
        }
        self.aboard(point, &name, place, attitude(&turn))
    }

    /// Ends of rods that lines hang on; refusals have left only rods that hold them.
    fn rods(&mut self) {
        for rod in &self.deck.rods {
            let mut used = false;
            for (index, letter) in ["a", "b"].into_iter().enumerate() {
                let end = LineEnd::Rod(rod.id.value, index == 1);
                let mut ends = self.deck.lines.iter().flat_map(|line| &line.ends);
                if !ends.any(|placed| placed.value == end) {
                    continue;
                }
                used = true;
                // The two ends of a rod of no length are the same place, its end A.
                let coordinates = &rod.ends[if rod.segments.value == 0 { 0 } else { index }];
                let name = format!("rod{}{letter}", rod.id.value);
                let at = format!("points[{}]", self.scene.points.len());
                let words = format!("rod {}", rod.id.value);
                self.places.put(at.clone(), &rod.id.span, words.clone());
                place_position(self.places, &at, &words, coordinates);
                let position = [0, 1, 2].map(|axis| coordinates[axis].value);
                let point = self.attached(name, &rod.attachment, position);
                self.scene.points.push(point);
            }
            let text = if used {
                "only holds the end of a line, in its own direction where the line has EI"
            } else {
                "holds no line and is left out"
            };
            self.findings
                .remark(rod.id.span.start, format!("rod {} {text}", rod.id.value));
        }
    }

    fn surroundings(&mut self, supplement: &Supplement) {
        let options = &self.deck.options;
        if let Some(gravity) = &options.gravity {
            self.scene.gravity = gravity.value;
            self.places.put("gravity", &gravity.span, "OPTIONS, g");
        }
        let density = options
            .density
            .as_ref()
            .map_or(SEA_WATER, |density| density.value);
        let mut water = Water::still(density);
        self.moving_water(&mut water);
        self.scene.water = Some(water);
        if let Some(density) = &options.density {
            self.places.put("water.density", &density.span, "OPTIONS, rho");
        }
        let given = options.depth.as_ref().and_then(|depth| match depth.value {
            Property::Named(_) => None,
            _ => Some(plain(&depth.value)),
        });
        let given = given.map(|depth| self.down_to_the_anchors(depth));
        let Some(depth) = from_deck::depth(given, supplement, &self.scene.points, self.findings) else {
            return;
        };
        let mut seabed = Seabed::level(depth);
        if let Some(depth) = &options.depth {
            self.places.put("seabed.depth", &depth.span, "OPTIONS, WtrDpth");
        }
        if let Some(stiffness) = &options.bed_stiffness {
            seabed.stiffness = stiffness.value;
            self.places
                .put("seabed.stiffness", &stiffness.span, "OPTIONS, kBot");
        }
        if let Some(damping) = &options.bed_damping {
            seabed.damping = damping.value;
            self.places.put("seabed.damping", &damping.span, "OPTIONS, cBot");
        }
        seabed.friction = self.friction();
        seabed.file = self.soundings();
        self.scene.seabed = Some(seabed);
    }

    /// The water of a deck [m] reaches down to its deepest anchor, whatever WtrDpth says.
    fn down_to_the_anchors(&mut self, depth: f64) -> f64 {
        let points = self.scene.points.iter().enumerate();
        let anchors = points.filter(|(_, point)| point.kind == PointKind::Fixed);
        let deepest = anchors.min_by(|(_, a), (_, b)| a.position[2].total_cmp(&b.position[2]));
        let Some((_, anchor)) = deepest else {
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
        let given = self.deck.options.depth.as_ref();
        match given {
            Some(given) => self.findings.remark(given.span.start, text),
            None => self.findings.remark_on_all(text),
        }
        anchored
    }

    /// Waves and current in files beside the deck.
    fn moving_water(&mut self, water: &mut Water) {
        for (key, value) in &self.deck.options.surroundings {
            let words = format!("OPTIONS, {key}");
            let Some(file) = water_file(key, &value.value) else {
                continue;
            };
            let text = format!("{key} {}: read from {file} beside this file", value.value);
            self.findings.remark(value.span.start, text);
            if file == WAVES_FILE {
                self.places.put("water.waves.file", &value.span, words);
                let sea = Sea {
                    file: Some(file.to_string()),
                    ..Sea::default()
                };
                water.waves = Some(Waves { seas: vec![sea] });
            } else {
                self.places.put("water.current.file", &value.span, words);
                water.current = Some(Current {
                    file: Some(file.to_string()),
                    ..Current::default()
                });
            }
        }
    }

    /// The file of the bed's depths, named in the place of the depth or by itself.
    fn soundings(&mut self) -> Option<String> {
        let options = &self.deck.options;
        let named = match &options.depth {
            Some(depth) => match &depth.value {
                Property::Named(name) => Some((name.clone(), &depth.span)),
                _ => None,
            },
            None => None,
        };
        let given = options.soundings.as_ref();
        let (name, span) = named.or(given.map(|file| (file.value.clone(), &file.span)))?;
        self.places.put("seabed.file", span, "OPTIONS, bathymetry");
        Some(name.trim_matches('"').to_string())
    }

    /// Friction of the bed: the coefficient for all directions, or those across and along the line.
    fn friction(&mut self) -> Friction {
        let coefficient = |key: &str| {
            let mut all = self.deck.options.friction.iter();
            all.find(|(other, _)| other.eq_ignore_ascii_case(key))
        };
        let whole = coefficient("FrictionCoefficient");
        let across = coefficient("mu_kT").or(whole);
        let along = coefficient("mu_kA").or(whole);
        for (key, at) in [("transverse", across), ("axial", along), ("", along.or(across))] {
            if let Some((option, coefficient)) = at {
                let at = match key {
                    "" => "seabed.friction".to_string(),
                    key => format!("seabed.friction.{key}"),
                };
                let words = format!("OPTIONS, {option}");
                self.places.put(&at, &coefficient.span, words);
            }
        }
        let value = |at: Option<&(String, Placed<f64>)>| at.map_or(0.0, |(_, c)| c.value);
        Friction {
            transverse: value(across),
            axial: value(along),
        }
    }

    fn lines(&mut self) {
        for line in &self.deck.lines {
            let index = self.scene.lines.len();
            let at = format!("lines[{index}]");
            let words = format!("line {}", line.id.value);
            for (key, span, column) in [
                ("", &line.id.span, ""),
                (".from", &line.ends[0].span, ", AttachA"),
                (".to", &line.ends[1].span, ", AttachB"),
                (".sections[0].type", &line.line_type.span, ", LineType"),
                (".sections[0].length", &line.length.span, ", UnstrLen"),
                (".sections[0].elements", &line.segments.span, ", NumSegs"),
            ] {
                self.places
                    .put(format!("{at}{key}"), span, format!("{words}{column}"));
            }
            let made = self.line(line);
            self.scene.lines.push(made);
        }
    }

    fn line(&mut self, line: &Line) -> scene::Line {
        let name = &self.types[line.line_type.value.as_str()];
        let ratio = self.scene.line_types[name].damping_ratio.is_some();
        let section = Section {
            line_type: self.types[line.line_type.value.as_str()].clone(),
            length: line.length.value,
            elements: Some(line.segments.value),
            damping_elements: ratio.then_some(line.segments.value),
        };
        let bends = self.scene.line_types[&section.line_type]
            .bending_stiffness
            .is_some();
        let clamp = |builder: &mut Self, index: usize| {
            bends.then(|| builder.clamp(&line.ends[index], index)).flatten()
        };
        let (clamped_a, clamped_b) = (clamp(self, 0), clamp(self, 1));
        let [from, to] = [0, 1].map(|index| match line.ends[index].value {
            LineEnd::Point(id) => format!("point{id}"),
            LineEnd::Rod(id, b) => format!("rod{id}{}", if b { "b" } else { "a" }),
        });
        let mut made = scene::Line::between(format!("line{}", line.id.value), from, to, vec![section]);
        if self.deck.options.starts_at_once.is_some() {
            made.initial = InitialShape::Catenary;
        }
        made.clamped_a = clamped_a;
        made.clamped_b = clamped_b;
        made
    }

    /// Direction of a line from A to B at its end on a rod: the line goes on where the rod ends.
    fn clamp(&mut self, end: &Placed<LineEnd>, index: usize) -> Option<[f64; 3]> {
        let LineEnd::Rod(id, at_b) = end.value else {
            return None;
        };
        let rod = self.deck.rods.iter().find(|rod| rod.id.value == id)?;
        let along = axis(rod);
        if along == [0.0; 3] {
            let problem = "the two ends of the rod are the same point, so it has no direction to hold the line in: \
                           write an Xb Yb Zb that differs from Xa Ya Za";
            self.findings
                .mistake(format!("rod {id}"), rod.ends[1][0].span.clone(), problem);
            return None;
        }
        // Leaving at B or arriving at A is along the rod, leaving at A or arriving at B is against it.
        let leaves = index == 0;
        let sign = if leaves == at_b { 1.0 } else { -1.0 };
        let along = self.turned(&rod.attachment.value, along);
        Some(along.map(|part| sign * part))
    }

    /// A direction in the frame of what carries it, in global axes.
    fn turned(&self, attachment: &Attachment, direction: [f64; 3]) -> [f64; 3] {
        let Attachment::Body(id) = attachment else {
            return direction;
        };
        let mut bodies = self.deck.bodies.iter();
        match bodies.find(|body| body.id.value == *id) {
            Some(body) => applied(&turn_of(body), direction),
            None => direction,
        }
    }

    fn output(&mut self) {
        for placed in &self.deck.outputs {
            // MoorDyn says that it does not know these and goes on.
            if ["FX", "FY", "FZ"].contains(&placed.value.to_uppercase().as_str()) {
                let text = format!(
                    "the output {:?} names no object, and MoorDyn writes none for it: left out",
                    placed.value
                );
                self.findings.remark(placed.span.start, text);
                continue;
            }
            let known = Channel::parse(&placed.value).and_then(|it| it.check(&self.scene));
            let twice = self.scene.output.channels.contains(&placed.value);
            let problem = match known {
                Err(problem) => Some(problem),
                Ok(()) => twice.then(|| "it stands there already".to_string()),
            };
            if let Some(problem) = problem {
                let text = format!("the output {:?} is left out: {problem}", placed.value);
                self.findings.remark(placed.span.start, text);
                continue;
            }
            let at = format!("output.channels[{}]", self.scene.output.channels.len());
            self.places
                .put(at, &placed.span, format!("OUTPUTS, {}", placed.value));
            self.scene.output.channels.push(placed.value.clone());
        }
        if let Some(interval) = &self.deck.options.output_interval
            && interval.value != 0.0
        {
            self.places
                .put("output.interval", &interval.span, "OPTIONS, dtOut");
            self.scene.output.interval = interval.value;
            self.scene.output.duration = Output::default().duration.max(interval.value);
        }
    }
}

/// What resists the stretch of a line.
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
            let fast = if both { damping } else { 0.0 }; // MoorDyn's reading of one BA
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
            .and_then(|bending| given(plain(&bending.value))),
        drag_normal: given(kind.drag_normal.value),
        drag_tangential: given(kind.drag_tangential.value),
        added_mass_normal: given(kind.added_mass_normal.value),
        added_mass_tangential: given(kind.added_mass_tangential.value),
        ..stretch(kind)
    }
}

fn point_force(point: &Point) -> Option<PointForce> {
    let force = point.force.as_ref()?;
    let [x, y, z] = [0, 1, 2].map(|axis| given(force[axis].value).map(TimeFunction::Constant));
    let some = x.is_some() || y.is_some() || z.is_some();
    some.then_some(PointForce { x, y, z })
}

/// Direction of a rod from A to B, of length one; zero where the ends are one point.
fn axis(rod: &Rod) -> [f64; 3] {
    let along = [0, 1, 2].map(|axis| rod.ends[1][axis].value - rod.ends[0][axis].value);
    let length = along.iter().map(|part| part * part).sum::<f64>().sqrt();
    if length > 0.0 && length.is_finite() {
        along.map(|part| part / length)
    } else {
        [0.0; 3]
    }
}

/// The turn of a body's axes.
fn turn_of(body: &Body) -> [[f64; 3]; 3] {
    rotation([0, 1, 2].map(|axis| body.attitude[axis].value.to_radians()))
}

/// A vector turned by a matrix of rows, in the unit of the vector.
fn applied(turn: &[[f64; 3]; 3], vector: [f64; 3]) -> [f64; 3] {
    turn.map(|row| (0..3).map(|axis| row[axis] * vector[axis]).sum::<f64>())
}

/// Rows of the matrix that turns a body's axes into the global ones, R = Rx·Ry·Rz of the angles [rad], as in MoorDyn.
fn rotation([roll, pitch, yaw]: [f64; 3]) -> [[f64; 3]; 3] {
    let ((s1, c1), (s2, c2), (s3, c3)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
    [
        [c2 * c3, -c2 * s3, s2],
        [c1 * s3 + c3 * s1 * s2, c1 * c3 - s1 * s2 * s3, -c2 * s1],
        [s1 * s3 - c1 * c3 * s2, c3 * s1 + c1 * s2 * s3, c1 * c2],
    ]
}

/// Roll, pitch and yaw [rad] of the same turn by R = Rz·Ry·Rx, as scenes have it.
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
