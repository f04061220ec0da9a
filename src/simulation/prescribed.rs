//! Prescribed motion in time of all points except free ones.
//!
//! The motion is evaluated at both ends of a communication step, where it is read most often. Between them the path of a host is a cubic. Motions of
//! the scene and of points on vessels need sines: a quintic through position, velocity and acceleration at the ends bridges the step, in as many
//! pieces as are needed to keep its error below [`ERROR_MAX`]. The motion is evaluated at every internal step if it needs too many pieces for the
//! internal steps of the networks at the point, if it has a kink within the step, or if clamped lines need the rotation of the point. Bridges save a
//! quarter of the instructions of a step of `bridle`, whose fairleads move with a vessel.
//!
//! The error of a quintic over a piece τ is at most max|r⁽⁶⁾| τ⁶/46080. For a sine, r⁽⁶⁾ ≤ A ω⁶. The rotation of an arm a by angles whose
//! derivatives are bounded by x₁ … x₆ has r⁽⁶⁾ ≤ |a| B₆(x₁ … x₆), with the complete Bell polynomial B₆, since every derivative of it by an
//! angle is a rotation or a projection of one.
//!
//! Source: [`crate::math::hermite`]; Faà di Bruno's formula, e.g. Comtet (1974), Advanced Combinatorics, section 3.3.

use crate::dynamics::Choice;
use crate::dynamics::motion::HostPath;
use crate::math::hermite::{QUINTIC_ERROR, Quintic};
use crate::math::lanes::Lanes;
use crate::model::{Body, Derivatives, Frame, Kinematics, Model, Motion, Point, Pose, Role};
use crate::scene::Integrator;

use super::inputs::Inputs;
use super::paths::{Paths, is_coupled};

/// Greatest error of a bridge [m].
const ERROR_MAX: f64 = 1e-12;
/// Greatest number of pieces of a bridge [-].
const PIECES_MAX: usize = 16;
/// Tolerance for rounding of the requested times, relative to a piece [-].
const ROUNDING: f64 = 1e-6;

/// Source of prescribed motions: the model, and the paths of a communication step.
#[derive(Clone, Copy)]
pub(super) struct MotionSource<'a> {
    model: &'a Model,
    paths: &'a Paths,
    follows_scene: bool,
}

impl<'a> MotionSource<'a> {
    /// Returns the source for the scene's own motion or the paths of a host.
    pub(super) fn new(model: &'a Model, paths: &'a Paths, follows_scene: bool) -> MotionSource<'a> {
        MotionSource {
            model,
            paths,
            follows_scene,
        }
    }

    /// Kinematics of a point at time `t` [s].
    pub(super) fn point(&self, point: usize, t: f64) -> Kinematics {
        let reference = self.model.points[point].reference;
        let moved = |k: Kinematics| Kinematics {
            position: reference + k.position,
            ..k
        };
        match &self.model.points[point].role {
            Role::Carried { vessel, arm } => self.model.vessels[*vessel].carry(&self.frame(*vessel, t), *arm),
            Role::Coupled { .. } if self.own_motion(point).is_none() => {
                let coupled = |point: &&Point| is_coupled(point);
                let before = self.model.points[..point].iter().filter(coupled);
                self.paths.points[before.count()].at(t)
            }
            _ => moved(
                self.own_motion(point)
                    .map_or_else(Kinematics::default, |motion| motion.at(t)),
            ),
        }
    }

    /// Motion of the scene that a point follows.
    fn own_motion(&self, point: usize) -> Option<&'a Motion> {
        match &self.model.points[point].role {
            Role::Prescribed(motion) => Some(motion),
            Role::Coupled { motion } => motion.as_ref().filter(|_| self.follows_scene),
            _ => None,
        }
    }

    /// Motion of the scene that a vessel follows.
    fn vessel_motion(&self, vessel: usize) -> Option<&'a Motion> {
        let motion = self.model.vessels[vessel].motion();
        motion.filter(|_| self.follows_scene)
    }

    /// Frame of a vessel at time `t` [s].
    pub(super) fn frame(&self, vessel: usize, t: f64) -> Frame {
        self.frame_at(vessel, &self.pose(vessel, t))
    }

    /// Frame of a vessel at a pose of its motion.
    fn frame_at(&self, vessel: usize, pose: &Pose) -> Frame {
        let data = &self.model.vessels[vessel];
        match self.vessel_motion(vessel) {
            Some(_) => data.frame_of_motion(pose),
            None => data.frame(pose),
        }
    }

    /// Gives the displacements of all bodies at time `t` [s] as a host does.
    pub(super) fn give(&self, t: f64, inputs: &mut Inputs) {
        for (index, point) in self
            .model
            .points
            .iter()
            .enumerate()
            .filter(|(_, point)| is_coupled(point))
        {
            let [x, y, z] = (self.point(index, t).position - point.reference).into();
            inputs.body_mut(Body::Point(index)).displacement = [x, y, z, 0.0, 0.0, 0.0];
        }
        for (index, vessel) in self.model.vessels.iter().enumerate() {
            let pose = self.pose(index, t);
            inputs.body_mut(Body::Vessel(index)).displacement = match self.vessel_motion(index) {
                Some(_) => vessel.pose_for_host(&pose, &self.frame(index, t)),
                None => pose.value.into(),
            };
        }
    }

    /// Pose of the motion of a vessel at time `t` [s].
    pub(super) fn pose(&self, vessel: usize, t: f64) -> Pose {
        match self.vessel_motion(vessel) {
            Some(motion) => motion.pose(t),
            None => self.paths.vessels[vessel].at(t),
        }
    }
}

/// Method by which the motion of a point is evaluated.
#[derive(Debug, Clone)]
enum Evaluation {
    /// No motion, or motion by forces.
    Fixed,
    /// Path of the host, by its index among the coupled points.
    Host(usize),
    /// Bridge over the step.
    Bridged(Box<Bridge>),
    /// Motion of the model, evaluated at every requested time.
    Direct,
}

/// Piecewise quintic over a communication step.
#[derive(Debug, Clone)]
struct Bridge {
    /// Start of the step [s].
    start: f64,
    /// Pieces per second [1/s].
    rate: f64,
    /// Empty if the motion must be evaluated at every internal step.
    pieces: Vec<Quintic>,
    /// Derivative bounds of a bridged motion of the scene; `None` for a cubic and for points on vessels.
    derivatives: Option<Derivatives>,
}

impl Bridge {
    fn new(derivatives: Option<Derivatives>) -> Bridge {
        Bridge {
            start: f64::NAN,
            rate: 0.0,
            pieces: Vec::with_capacity(PIECES_MAX),
            derivatives,
        }
    }

    /// Number of pieces that a motion of the scene needs over a length of time [s]; `None` if it exceeds `most`.
    fn pieces_over(&self, length: f64, most: usize) -> Option<usize> {
        if most == 0 {
            return None;
        }
        let bounds = self.derivatives.as_ref();
        pieces(bounds.map_or(0.0, |bounds| bounds.shift(length)), most)
    }

    /// Builds a bridge of `count` pieces over a span of time [s] between the kinematics `ends`; `at` returns the kinematics at the knots between
    /// pieces.
    fn build(
        &mut self,
        [start, end]: [f64; 2],
        count: usize,
        ends: &[Kinematics; 2],
        at: impl Fn(usize) -> Kinematics,
    ) {
        self.pieces.clear();
        self.start = start;
        if count == 0 {
            return;
        }
        let piece = (end - start) / count as f64;
        self.rate = 1.0 / piece;
        let motion = |k: &Kinematics| [k.position, k.velocity, k.acceleration];
        let mut before = motion(&ends[0]);
        for knot in 1..=count {
            let after = match knot == count {
                true => motion(&ends[1]),
                false => motion(&at(knot)),
            };
            self.pieces.push(Quintic::new(before, after, piece));
            before = after;
        }
    }

    /// Kinematics of the point at time `t` [s], without its rotation.
    #[inline]
    fn at(&self, t: f64) -> Option<Kinematics> {
        let count = self.pieces.len();
        let passed = (t - self.start) * self.rate;
        if count == 0 || !(-ROUNDING..count as f64 + ROUNDING).contains(&passed) {
            return None;
        }
        let piece = (passed as usize).min(count - 1);
        let [position, velocity, acceleration] = self.pieces[piece].at(passed - piece as f64, self.rate);
        Some(Kinematics {
            position,
            velocity,
            acceleration,
            ..Kinematics::default()
        })
    }
}

/// Position [m], velocity [m/s] and acceleration [m/s²] of a point that a host moves, along x, y and z, at both ends of a step.
pub(super) type HostEnds = [[Lanes; 3]; 2];

/// Prescribed motions over a communication step.
#[derive(Debug, Clone)]
pub(super) struct PrescribedMotion {
    /// Start and end of the step [s].
    span: [f64; 2],
    /// Kinematics of the points at both ends, except those that a host moves.
    ends: Vec<[Kinematics; 2]>,
    /// Ends of the points that a host moves, set from their paths.
    hosted: Vec<HostEnds>,
    evaluations: Vec<Evaluation>,
    /// True if any point follows a motion of the scene or a vessel.
    moves: bool,
    /// Derivative bounds of the vessel motions; `None` for a path of a host and for a cubic motion of the scene.
    vessels: Vec<Option<Derivatives>>,
    /// Longest internal step of the networks at every point [s]; infinite if no network there makes internal steps.
    step_max: Vec<f64>,
}

impl PrescribedMotion {
    /// Prescribed motions of a model whose points follow the scene or a host; `choices` are the integrators of its networks.
    pub(super) fn new<'a>(
        model: &Model,
        follows_scene: bool,
        choices: impl Iterator<Item = &'a Choice>,
    ) -> PrescribedMotion {
        let mut step_max = vec![f64::INFINITY; model.points.len()];
        let networks = model.networks.iter().zip(choices);
        for (network, choice) in networks.filter(|(_, choice)| choice.integrator != Integrator::QuasiStatic) {
            for point in network.lines.iter().flat_map(|&line| model.lines[line].ends) {
                step_max[point] = choice.longest.min(step_max[point]);
            }
        }
        let mut coupled = 0..;
        let evaluations = model.points.iter().map(|point| {
            let place = if is_coupled(point) { coupled.next() } else { None };
            let mut clamps = point.attached.iter();
            let turns = clamps.any(|&(line, _)| model.lines[line].bends());
            match &point.role {
                Role::Fixed | Role::Free(_) => Evaluation::Fixed,
                Role::Prescribed(motion) => Evaluation::Bridged(Box::new(Bridge::new(motion.derivatives()))),
                Role::Coupled { motion: Some(motion) } if follows_scene => {
                    Evaluation::Bridged(Box::new(Bridge::new(motion.derivatives())))
                }
                Role::Coupled { .. } => place.map_or(Evaluation::Direct, Evaluation::Host),
                Role::Carried { .. } if turns => Evaluation::Direct,
                Role::Carried { .. } => Evaluation::Bridged(Box::new(Bridge::new(None))),
            }
        });
        let evaluations: Vec<Evaluation> = evaluations.collect();
        let motions = model.vessels.iter().map(|vessel| vessel.motion());
        let references = model.points.iter().map(|point| Kinematics {
            position: point.reference,
            ..Kinematics::default()
        });
        PrescribedMotion {
            span: [f64::NAN; 2],
            ends: references.map(|k| [k; 2]).collect(),
            hosted: vec![[[Lanes::splat(0.0); 3]; 2]; coupled.start],
            moves: evaluations
                .iter()
                .any(|evaluation| !matches!(evaluation, Evaluation::Fixed | Evaluation::Host(_))),
            evaluations,
            vessels: motions
                .map(|motion| motion.filter(|_| follows_scene)?.derivatives())
                .collect(),
            step_max,
        }
    }

    /// Ends of the points that a host moves over the next span, to be set from their paths.
    pub(super) fn hosted(&mut self) -> &mut [HostEnds] {
        &mut self.hosted
    }

    /// Prepares for a span of time [s].
    pub(super) fn prepare(&mut self, at: &MotionSource, span: [f64; 2]) {
        let goes_on = self.span[1] == span[0];
        self.span = span;
        if at.follows_scene {
            // without a host, points that the scene does not move are at rest
            let paths = self.hosted.iter_mut().zip(&at.paths.points);
            paths.for_each(|(ends, path)| *ends = path.0.ends());
        }
        if !self.moves {
            return;
        }
        for (point, (evaluation, ends)) in self.evaluations.iter_mut().zip(&mut self.ends).enumerate() {
            match evaluation {
                Evaluation::Fixed | Evaluation::Host(_) => (),
                Evaluation::Direct => *ends = span.map(|t| at.point(point, t)),
                Evaluation::Bridged(bridge) => {
                    let Some(motion) = at.own_motion(point) else {
                        continue; // on a vessel
                    };
                    let [start, end] = span;
                    let first = if goes_on { ends[1] } else { at.point(point, start) };
                    *ends = [first, at.point(point, end)];
                    let most = internal_steps(span, self.step_max[point]) / 2;
                    let count = bridge.pieces_over(end - start, most);
                    let count = count.filter(|_| motion.is_smooth(span));
                    let knot = |k: usize| at.point(point, knot_time(span, k, count));
                    bridge.build(span, count.unwrap_or(0), ends, knot);
                }
            }
        }
        for vessel in 0..self.vessels.len() {
            self.prepare_vessel(at, vessel, span);
        }
    }

    fn prepare_vessel(&mut self, at: &MotionSource, vessel: usize, span: [f64; 2]) {
        let model = at.model;
        let poses = span.map(|t| at.pose(vessel, t));
        let frames = poses.each_ref().map(|pose| at.frame_at(vessel, pose));
        let length = span[1] - span[0];
        let smooth = at
            .vessel_motion(vessel)
            .is_none_or(|motion| motion.is_smooth(span));
        let bounds = self.vessels[vessel];
        let turned = match bounds {
            Some(bounds) => bounds.turn(length),
            None => cubic_turn(&poses, length),
        };
        let (shift, spread) = (bounds.map_or(0.0, |bounds| bounds.shift(length)), bell(turned));
        let evaluations = self
            .evaluations
            .iter_mut()
            .zip(&mut self.ends)
            .zip(&self.step_max);
        for (point, ((evaluation, ends), step_max)) in model.points.iter().zip(evaluations) {
            let (Evaluation::Bridged(bridge), Role::Carried { vessel: carrier, arm }) =
                (evaluation, &point.role)
            else {
                continue;
            };
            if *carrier != vessel {
                continue;
            }
            let carry = |frame: &Frame| model.vessels[vessel].carry(frame, *arm);
            let most = internal_steps(span, *step_max).saturating_sub(1);
            let count = pieces(shift + arm.norm() * spread, most).filter(|_| smooth);
            *ends = frames.each_ref().map(carry);
            bridge.build(span, count.unwrap_or(0), ends, |knot| {
                carry(&at.frame(vessel, knot_time(span, knot, count)))
            });
        }
    }

    /// Kinematics of a point at time `t` [s] of the span; the rotation is included at the ends and, if lines are clamped to the point, at all times.
    #[inline(always)]
    pub(super) fn point(&self, at: &MotionSource, point: usize, t: f64) -> Kinematics {
        let [start, end] = self.span;
        match &self.evaluations[point] {
            Evaluation::Host(path) if t == start || t == end => {
                HostPath::kinematics(&self.hosted[*path][usize::from(t == end)])
            }
            _ => self.other(at, point, t),
        }
    }

    /// Evaluates [`PrescribedMotion::point`] at other times than the ends of a host's path.
    #[inline(never)]
    fn other(&self, at: &MotionSource, point: usize, t: f64) -> Kinematics {
        if let Evaluation::Host(path) = &self.evaluations[point] {
            return at.paths.points[*path].at(t);
        }
        let ([first, last], [start, end]) = (&self.ends[point], self.span);
        if t == end {
            return *last;
        }
        if t == start {
            return *first;
        }
        match &self.evaluations[point] {
            Evaluation::Fixed => *first,
            Evaluation::Bridged(bridge) => bridge.at(t).unwrap_or_else(|| at.point(point, t)),
            Evaluation::Host(_) | Evaluation::Direct => at.point(point, t),
        }
    }
}

/// Number of internal steps of at most `step_max` [s] in a span of time [s].
fn internal_steps([start, end]: [f64; 2], step_max: f64) -> usize {
    ((end - start) / step_max).ceil() as usize
}

/// Time of a knot between pieces [s].
fn knot_time([start, end]: [f64; 2], knot: usize, count: Option<usize>) -> f64 {
    let count = count.unwrap_or(1);
    start + (end - start) * (knot as f64 / count as f64)
}

/// Number of pieces of a span, of which `sixth` bounds the sixth derivative times the sixth power of the length [m]; `None` if it exceeds `most`.
fn pieces(sixth: f64, most: usize) -> Option<usize> {
    let excess = sixth * QUINTIC_ERROR / ERROR_MAX;
    (1..=most.min(PIECES_MAX)).find(|&count| (count as f64).powi(6) >= excess)
}

/// Bounds of the derivatives of angles that are cubics over a span [s], multiplied by powers of the span [rad].
fn cubic_turn([before, after]: &[Pose; 2], span: f64) -> [f64; 6] {
    let mut bounds = [0.0; 6];
    for axis in 3..6 {
        let [a0, a1] = [before, after].map(|pose| span * span * pose.acceleration[axis]);
        let bend = a0.abs().max(a1.abs());
        bounds[0] += span * before.rate[axis].abs() + bend;
        bounds[1] += bend;
        bounds[2] += (a1 - a0).abs();
    }
    bounds
}

/// Complete Bell polynomial B₆.
fn bell([a, b, c, d, e, f]: [f64; 6]) -> f64 {
    let a2 = a * a;
    a2 * a2 * (a2 + 15.0 * b)
        + a2 * (20.0 * a * c + 45.0 * b * b + 15.0 * d)
        + b * (15.0 * b * b + 60.0 * a * c + 15.0 * d)
        + 10.0 * c * c
        + 6.0 * a * e
        + f
}

#[cfg(test)]
mod tests {
    use super::super::start;
    use super::*;
    use crate::draft::draft;
    use crate::simulation::inputs::Inputs;
    use approx::assert_relative_eq;

    /// Two lines, one to a point that a motion drives and one to a point on a vessel.
    fn model() -> Model {
        draft(
            "line_types.rope = { mass = 2.0, diameter = 0.05, axial_stiffness = 1.0e6 }
            vessels = [{ name = 'buoy', attitude = [0.0, 0.1, 0.8] }]
            motion.left = { x = [[-6.0, 10.0], [-0.3, 1.6]], z = [[2.0, 8.0, 0.3]], ramp = 20.0 }
            motion.buoy = { x = [[4.0, 11.0]], roll = [[0.1, 9.0]], pitch = [[0.2, 7.0, 1.0], [0.02, 2.0]], ramp = 20.0 }
            solver.time_step_max = 0.002",
        )
        .fixed("anchor", [0.0; 3])
        .coupled("left", [16.0, 0.0, 0.0])
        .coupled("right", [10.0, 5.0, -4.0])
        .with("on = 'buoy'")
        .line("one", ["anchor", "left"], "rope", 17.0, 4)
        .line("two", ["anchor", "right"], "rope", 15.0, 4)
        .model()
    }

    /// Greatest errors of position [m] and velocity [m/s] of a bridged point, over steps of a given length [s].
    fn misses(point: &str, step: f64) -> [f64; 2] {
        let model = model();
        let inputs = Inputs::new(&model);
        let (snapshot, work) = start::begin(&model, 0.0, inputs, true, start::Shapes::AsGiven).unwrap();
        let at = MotionSource::new(&model, &snapshot.paths, true);
        let mut held = PrescribedMotion::new(&model, true, work.choices());
        let point = model.point_index(point).unwrap();
        let mut worst = [0.0_f64; 2];
        for k in 0..(30.0 / step) as usize {
            let start = k as f64 * step;
            held.prepare(&at, [start, start + step]);
            for part in [0.0, 0.21, 0.5, 0.83, 1.0] {
                let t = start + part * step;
                let (is, should) = (held.point(&at, point, t), at.point(point, t));
                worst[0] = worst[0].max((is.position - should.position).norm());
                worst[1] = worst[1].max((is.velocity - should.velocity).norm());
            }
        }
        worst
    }

    #[test]
    fn bridges_stay_within_a_picometre_of_the_motion() {
        for point in ["left", "right"] {
            for step in [0.01, 0.05, 0.1, 0.4, 2.0] {
                let [place, speed] = misses(point, step);
                assert!(place < ERROR_MAX + 1e-13, "{point}, {step} s: {place:e} m");
                assert!(speed < 1e-9, "{point}, {step} s: {speed:e} m/s");
            }
        }
    }

    #[test]
    fn a_carried_point_is_bridged_along_the_path_of_a_host_too() {
        let model = model();
        let (snapshot, work) =
            start::begin(&model, 0.0, Inputs::new(&model), false, start::Shapes::AsGiven).unwrap();
        let mut paths = snapshot.paths.clone();
        let [place, angles] = &mut paths.vessels[0].0;
        for (path, first) in [(place, 0.0), (angles, 3e-4)] {
            let end = Lanes::new([0.0, 1e-4, 2e-4, 3e-4]) + Lanes::splat(first);
            path.follow([0.0, 0.1], [end, Lanes::splat(2e-3)]);
        }
        let at = MotionSource::new(&model, &paths, false);
        let mut held = PrescribedMotion::new(&model, false, work.choices());
        held.prepare(&at, [0.0, 0.1]);
        let point = model.point_index("right").unwrap();
        let Evaluation::Bridged(bridge) = &held.evaluations[point] else {
            panic!("a point on a vessel without clamps is bridged");
        };
        assert!(!bridge.pieces.is_empty());
        for part in 0..=10 {
            let t = 0.01 * f64::from(part);
            let (is, should) = (held.point(&at, point, t), at.point(point, t));
            assert_relative_eq!(is.position, should.position, epsilon = 1.1e-12);
            assert_relative_eq!(is.acceleration, should.acceleration, epsilon = 1e-6);
        }
    }

    #[test]
    fn the_bell_polynomial_is_the_sixth_derivative_of_an_exponential() {
        // exp(sin t) at t = 0: derivatives 1, 0, −1, 0, 1, 0 of the sine, sixth derivative −3 of the whole
        assert_eq!(bell([1.0, 0.0, -1.0, 0.0, 1.0, 0.0]), -3.0);
        assert_eq!(bell([1.0; 6]), 203.0); // number of partitions of a set of six
    }
}
