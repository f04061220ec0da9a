//! Points, vessels and lines: anchors below, upper supports of the lines above, free points between.

use std::f64::consts::{PI, TAU};

use moorline::scene::channel::LineEnd;
use moorline::scene::{
    AngleOrder, Axis, Break, InitialShape, Integrator, InterfaceOutput, Line, LineType, Point, PointForce,
    PointKind, PointMoment, RestShape, Scene, Section, TimeFunction, Vessel, Winch,
};
use nalgebra::{Rotation3, Vector3};

use crate::dice::{Dice, Tape};
use crate::features::bends as bends_by_itself;
use crate::motions;
use crate::plan::{Plan, Resists, part};
use crate::{surroundings, types};

/// Returns the scene of a tape.
pub fn scene(tape: &Tape, plan: &Plan) -> Scene {
    let mut scene = Scene {
        title: "a random scene".to_string(),
        gravity: plan.gravity,
        solver: plan.solver(&mut plan.dice(tape, part::SOLVER)),
        ..Scene::default()
    };
    scene.output.energy_balance = true;
    scene.output.interface = Some(InterfaceOutput::Mass);
    let cable = plan.resists != Resists::Torsion;
    let moving = plan.integrator != Integrator::QuasiStatic;
    if plan.wet {
        let dice = &mut plan.dice(tape, part::WATER);
        let waves = cable && moving && !plan.winch;
        let mut water = surroundings::water(dice, plan.size, plan.gravity, cable, waves);
        if plan.winch {
            water.surface = Some(false);
        }
        scene.water = Some(water);
    }
    let mut dice = plan.dice(tape, part::SEABED);
    let depth = plan.size * dice.between(0.2, 1.0);
    if plan.seabed {
        scene.seabed = Some(surroundings::seabed(&mut dice, depth, plan.size, !cable));
    }
    let types = dice.whole(1, 3);
    for number in 0..types {
        let kind = types::line_type(&mut plan.dice(tape, part::TYPES + number), plan);
        scene.line_types.insert(format!("type{number}"), kind);
    }
    let mut layout = Layout {
        tape,
        plan,
        depth,
        scene,
        places: Vec::new(),
    };
    layout.tops();
    layout.lines();
    layout.scene
}

/// Scene under construction.
struct Layout<'t> {
    tape: &'t Tape,
    plan: &'t Plan,
    /// Depth [m].
    depth: f64,
    scene: Scene,
    /// Positions of the points [m].
    places: Vec<Vector3<f64>>,
}

impl Layout<'_> {
    fn add(&mut self, point: Point, place: Vector3<f64>) -> usize {
        self.scene.points.push(point);
        self.places.push(place);
        self.places.len() - 1
    }

    /// Adds one to three upper supports of lines, with vessels and motions.
    fn tops(&mut self) {
        let mut dice = self.plan.dice(self.tape, part::TOPS);
        let size = self.plan.size;
        let count = dice.pick(&[1, 1, 2, 3]);
        for number in 0..count {
            let above = dice.chance(0.3);
            let z = if above { 0.1 * size } else { -0.3 * self.depth } * dice.between(0.0, 1.0);
            let place = Vector3::new(dice.within(0.2 * size), dice.within(0.2 * size), z);
            let name = format!("top{number}");
            let motion = &mut self.plan.dice(self.tape, part::MOTIONS + number);
            let point = match dice.whole(0, 7) {
                0..=2 => {
                    let path = motions::motion(motion, self.plan, false);
                    self.scene.motion.insert(name.clone(), path);
                    Point::at(name, place.into(), PointKind::Coupled)
                }
                3..=5 => self.carried(&mut dice, motion, name, place),
                6 => Point {
                    motion: Some(motions::motion(motion, self.plan, false)),
                    ..Point::at(name, place.into(), PointKind::Prescribed)
                },
                _ => Point::at(name, place.into(), PointKind::Fixed),
            };
            self.add(point, place);
        }
    }

    /// Returns a point on a vessel, the last one or a new one.
    fn carried(&mut self, dice: &mut Dice, motion: &mut Dice, name: String, place: Vector3<f64>) -> Point {
        if self.scene.vessels.is_empty() || dice.chance(0.4) {
            let number = self.scene.vessels.len();
            let reach = 0.1 * self.plan.size;
            let offset = [0.0; 3].map(|_| dice.within(reach));
            let vessel = Vessel {
                motion_angles: AngleOrder::Zyx,
                name: format!("vessel{number}"),
                position: (place + Vector3::from(offset)).into(),
                attitude: [0.0; 3].map(|_: f64| if dice.chance(0.5) { dice.within(PI) } else { 0.0 }),
            };
            let path = motions::motion(motion, self.plan, true);
            self.scene.motion.insert(vessel.name.clone(), path);
            self.scene.vessels.push(vessel);
        }
        let vessel = &self.scene.vessels[self.scene.vessels.len() - 1];
        let [roll, pitch, yaw] = vessel.attitude;
        let turn = Rotation3::from_euler_angles(roll, pitch, yaw);
        let arm = turn.inverse() * (place - Vector3::from(vessel.position));
        Point {
            on: Some(vessel.name.clone()),
            ..Point::at(name, arm.into(), PointKind::Coupled)
        }
    }

    /// Adds a fixed point on the seabed, or on a wall.
    fn anchor(&mut self, dice: &mut Dice, number: usize) -> usize {
        let size = self.plan.size;
        let radius = size * dice.pick(&[1.0, 1.0, 0.1]) * dice.between(0.3, 1.0);
        let bearing = dice.between(0.0, TAU);
        let (x, y) = (radius * bearing.cos(), radius * bearing.sin());
        let seabed = self.scene.seabed.as_ref();
        let floor = seabed.map_or(-self.depth, |seabed| surroundings::seabed_height(seabed, [x, y]));
        let lift = if dice.chance(0.25) {
            dice.between(0.0, self.depth)
        } else {
            0.0
        };
        let place = Vector3::new(x, y, floor + lift);
        self.add(
            Point::at(format!("anchor{number}"), place.into(), PointKind::Fixed),
            place,
        )
    }

    /// Adds a free point: a clump, a buoy, a knot, or a point on a rail.
    fn free(&mut self, number: usize, place: Vector3<f64>) -> usize {
        let mut dice = self.plan.dice(self.tape, part::JUNCTIONS + number);
        let mut point = Point::at(format!("free{number}"), place.into(), PointKind::Free);
        if dice.chance(0.8) {
            let mass = dice.size([0.1, 1e5], [1e-15, 1e12]);
            point.mass = Some(mass);
            if dice.chance(0.6) {
                let water = self.scene.water.as_ref().map_or(1e3, |water| water.density);
                point.volume = Some((mass / water * dice.log(0.1, 4.0)).min(1e9));
                point.drag_area = dice.maybe(0.6, |dice| dice.size([1e-3, 10.0], [1e-15, 1e9]));
                point.added_mass = dice.maybe(0.6, |dice| dice.size([0.1, 1.0], [1e-6, 1e3]));
            }
        }
        if dice.chance(0.15) {
            point.free = Some(dice.pick(&[vec![Axis::X, Axis::Z], vec![Axis::X], vec![Axis::Z]]));
        }
        if dice.chance(0.25) {
            let weight = point.mass.unwrap_or(100.0) * 10.0;
            point.force = Some(PointForce {
                x: Some(load(&mut dice, weight)),
                z: dice.maybe(0.3, |dice| load(dice, weight)),
                ..PointForce::default()
            });
        }
        if self.plan.resists == Resists::Torsion && dice.chance(0.3) {
            let size = 1e-3 * self.plan.size * point.mass.unwrap_or(1.0);
            point.moment = Some(PointMoment {
                y: Some(load(&mut dice, size)),
                ..PointMoment::default()
            });
        }
        self.add(point, place)
    }

    /// Adds one to six lines.
    fn lines(&mut self) {
        let count = self
            .plan
            .dice(self.tape, part::LINES)
            .pick(&[1, 1, 1, 2, 2, 3, 4, 5, 6]);
        let tops = self.places.len();
        let mut junctions: Vec<usize> = Vec::new();
        for number in 0..count {
            let mut dice = self.plan.dice(self.tape, part::LINES + number);
            let top = dice.whole(0, tops - 1);
            let shared = self.plan.resists != Resists::Torsion;
            let [from, to] = match dice.whole(0, 5) {
                5 if tops > 1 => [top, (top + 1) % tops],
                4 if self.plan.junctions => {
                    let reach = self.plan.size * dice.between(0.1, 0.5);
                    let bearing = dice.between(0.0, TAU);
                    let away = Vector3::new(bearing.cos(), bearing.sin(), -2.0) * (0.4 * reach);
                    let place = self.lifted(self.places[top] + away);
                    [self.free(number, place), top]
                }
                2 | 3 if self.plan.junctions && shared => match junctions.pop() {
                    Some(junction) => [self.anchor(&mut dice, number), junction],
                    None => {
                        let middle = Vector3::new(dice.within(0.3), dice.within(0.3), -0.5);
                        let place = self.lifted(self.places[top] + self.depth * middle);
                        let junction = self.free(number, place);
                        junctions.push(junction);
                        [junction, top]
                    }
                },
                _ => [self.anchor(&mut dice, number), top],
            };
            let line = self.line(&mut dice, number, [from, to]);
            self.scene.lines.push(line);
        }
    }

    /// Returns whether a strain of 1 % requires far more than a line's weight, so that a motion would snap a taut line.
    fn is_stiff(&self) -> bool {
        let weight = self.plan.gravity.max(1.0) * self.plan.size;
        let stiff = |kind: &LineType| {
            let stiffness = kind.axial_stiffness.or(kind.dynamic_stiffness).unwrap_or(0.0);
            stiffness > 1e4 * kind.mass.unwrap_or(1.0) * weight
        };
        self.scene.line_types.values().any(stiff)
    }

    /// Moves a position [m] to the seabed if it is below.
    fn lifted(&self, place: Vector3<f64>) -> Vector3<f64> {
        let seabed = self.scene.seabed.as_ref();
        let floor = seabed.map_or(f64::NEG_INFINITY, |seabed| {
            surroundings::seabed_height(seabed, [place.x, place.y])
        });
        Vector3::new(place.x, place.y, place.z.max(floor))
    }

    /// Returns a line between two points: taut, slack or in between, with one to four sections.
    fn line(&self, dice: &mut Dice, number: usize, ends: [usize; 2]) -> Line {
        let [a, b] = ends.map(|end| self.places[end]);
        let chord = (b - a).norm().max(0.02 * self.plan.size);
        let beam = self.plan.resists == Resists::Torsion;
        let slack = match dice.whole(0, 9) {
            _ if beam => 1.0 + dice.log(1e-4, 0.1),
            0..=6 if self.is_stiff() => 1.0 + dice.log(0.05, 0.4),
            0..=6 => 1.0 + dice.log(1e-3, 0.4),
            7 | 8 => dice.between(1.4, 3.0),
            _ if self.is_stiff() => 1.0 - dice.log(1e-9, 1e-5),
            _ => 1.0 - dice.log(1e-6, 0.02),
        };
        let count = dice.pick(&[1, 1, 1, 2, 3, 4]);
        let types = self.scene.line_types.len();
        let chosen = !beam && dice.chance(0.08);
        let explicit = self.plan.integrator == Integrator::Leapfrog || self.plan.winch;
        let least = if explicit { 0.5 } else { 0.05 };
        let shares: Vec<f64> = (0..count).map(|_| dice.log(least, 1.0)).collect();
        let total: f64 = shares.iter().sum();
        let section = |share: &f64| {
            let kind = dice.whole(0, types - 1);
            let elements = match beam {
                true => dice.whole(8, 12),
                false => dice.whole(if count == 1 { 4 } else { 1 }, 8),
            };
            Section {
                line_type: format!("type{kind}"),
                length: (slack * chord * share / total).clamp(1e-15, 1e6),
                elements: (!chosen).then_some(elements),
                damping_elements: None,
            }
        };
        let sections: Vec<Section> = shares.iter().map(section).collect();
        let names = ends.map(|end| self.scene.points[end].name.clone());
        let [from, to] = names;
        let mut line = Line::between(format!("line{number}"), from, to, sections);
        self.start(dice, &mut line, [a, b], slack);
        self.controls(dice, &mut line, ends);
        line
    }

    /// Sets the initial shape, the rest shape and the clamps of a line.
    fn start(&self, dice: &mut Dice, line: &mut Line, [a, b]: [Vector3<f64>; 2], slack: f64) {
        let chord = b - a;
        let beam = self.plan.resists == Resists::Torsion;
        let still = self.plan.integrator == Integrator::QuasiStatic;
        line.initial = match dice.whole(0, 11) {
            _ if still => InitialShape::Static,
            11 if beam => InitialShape::Static,
            10 if chord.norm() > 0.0 => InitialShape::Straight,
            11 => InitialShape::Parabola(chord.norm().max(1e-3) * (0.375 * (slack - 1.0).max(1e-4)).sqrt()),
            _ => InitialShape::Static,
        };
        if self.plan.resists == Resists::Stretch {
            return;
        }
        let lies = dice.chance(0.2);
        let bends = |section: Option<&Section>| {
            let kind = section.and_then(|section| self.scene.line_types.get(&section.line_type));
            kind.is_some_and(bends_by_itself)
        };
        let lies = lies && line.initial != InitialShape::Static;
        if lies && line.sections.iter().any(|section| bends(Some(section))) {
            line.rest_shape = RestShape::Initial;
        }
        let mut clamp = |section: Option<&Section>| {
            let towards = chord.normalize() + Vector3::from([0.0; 3].map(|_| dice.within(0.3)));
            (bends(section) && dice.chance(0.4)).then(|| towards.into())
        };
        line.clamped_a = clamp(line.sections.first());
        line.clamped_b = clamp(line.sections.last());
        let turned = |name: &str| {
            let mut points = self.scene.points.iter();
            points.any(|point| point.name == name && point.moment.is_some())
        };
        line.clamped_a = line.clamped_a.filter(|_| !turned(&line.from));
        line.clamped_b = line.clamped_b.filter(|_| !turned(&line.to));
    }

    /// Sets the releases, breaks and winches of a line.
    fn controls(&self, dice: &mut Dice, line: &mut Line, ends: [usize; 2]) {
        let held = self.scene.points[ends[1]].kind != PointKind::Free;
        if self.plan.winch && held && dice.chance(0.6) {
            line.initial = InitialShape::Static;
            let last = line.sections.last().map_or(1.0, |section| section.length);
            let elements = line.sections.last().and_then(|section| section.elements);
            let reach = last * dice.between(0.05, 0.5);
            let [start, span] = [dice.between(1.0, 20.0), dice.log(2.0, 60.0)];
            let to = if dice.chance(0.4) && elements > Some(1) {
                -0.4 * last
            } else {
                reach
            };
            line.winch = Some(Winch {
                end: LineEnd::B,
                length_max: reach,
                speed_max: dice.maybe(0.5, |_| 2.0 * reach.max(last) / span),
                path: Some(TimeFunction::Ramp([start, 0.0, start + span, to])),
            });
        } else if self.plan.parts {
            let end = dice.pick(&[LineEnd::B, LineEnd::A]);
            match dice.whole(0, 3) {
                0 => line.release = Some(end),
                kind @ (1 | 2) => {
                    let time = (kind == 1).then(|| dice.between(0.0, 60.0));
                    let tension = (kind == 2).then(|| dice.log(1e2, 1e7));
                    line.failure = Some(Break {
                        at: end,
                        tension,
                        time,
                    });
                }
                _ => {}
            }
        }
    }
}

/// Returns a time-dependent load up to about `size` [N].
fn load(dice: &mut Dice, size: f64) -> TimeFunction {
    let [f0, f1] = [dice.within(0.2 * size), dice.within(size)];
    let [t0, span] = [dice.between(0.0, 20.0), dice.log(0.1, 30.0)];
    match dice.whole(0, 3) {
        0 => TimeFunction::Constant(f1),
        1 => TimeFunction::Step([t0, f0, t0 + span, f1]),
        2 => TimeFunction::Ramp([t0, f0, t0 + span, f1]),
        _ => TimeFunction::Table(vec![[t0, f0], [t0 + span, f0], [t0 + span, f1]]),
    }
}
