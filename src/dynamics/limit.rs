//! Largest stable time step of the explicit leapfrog, in closed form.
//!
//! With axial segment stiffness k = EA/l and lumped masses M, Gershgorin's bound on the highest frequency of the chain is
//! ω² = max_i 2(k_{i−1} + k_i)/M_i. Axial damping of ratio ζ = BA·ω/(2EA), evaluated at the lagged velocity, lowers the
//! limit 2/ω of the undamped leapfrog to
//!
//! Δt_max = (2/ω)(√(1 + ζ²) − ζ),
//!
//! of which 0.9 is used. This limit holds for springs that pull and push. The springs of a line only pull, and the
//! amplification matrix of a step changes when the line goes slack. With θ from ωΔt = 2 sin(θ/2), the trace of k taut
//! steps and a slack one is 2 cos((k + ½)θ)/cos(θ/2), whose magnitude exceeds 2 near (k + ½)θ = π, for θ between π/(k + 1)
//! and π/k. Taut and slack steps in alternation are unstable above ωΔt = √2, two taut steps and a slack one from 1 to √2,
//! three and one from 0.77 to 1, and longer sequences, progressively more weakly, below: a slack line without damping
//! accumulates energy in its shortest waves. Lines with little damping use 0.38 of the limit, ωΔt ≤ 0.76: the energy
//! balance of the leapfrog closes within 2 % in 97 % of random scenes with equal steps and in 99 % with irregular ones,
//! compared with 95 and 96 % at 0.5 of the limit. A line that may be released needs more damping to use more of the
//! limit: a loose end cracks like a whip, alternately slack and taut.
//!
//! Transverse waves of speed c = √(T/m) limit every variant, including the axial-implicit one: Δt < 0.6 h/c, or 1.2/ω with k = T/l.
//! For lines that may emerge from the water, these limits use the mass in air, and include the waterplane stiffness.
//!
//! Quadratic drag is explicit, evaluated at v* = 1.5 v_{n−½} − 0.5 v_{n−3/2}. A velocity that changes sign in every
//! step has v* = 2v and drag 4K|v|v, which turns it into −v for K|v|Δt/M = ½. A steady velocity is stable against
//! disturbances, whose drag is 2K|v|v*, up to the same limit. Beyond it, velocities grow in every step, at a rate that
//! increases with the velocity: a communication step that ends beyond the limit is repeated in shorter steps.
//!
//! In the shortest wave, velocities change sign in every step for springs, dampers, mass damping (α) and drag alike.
//! Their terms therefore add up:
//!
//! ω²Δt²/4 + (ζω + ½α + 2K|v|/M)Δt ≤ 1,
//!
//! which reduces to the first limit without α and drag, and to the last without springs and dampers
//! ([`ExplicitLimit`]).
//!
//! Source: Belytschko, Liu & Moran (2000), Nonlinear Finite Elements for Continua and Structures, section 6.2.6 (damped
//! central differences with lagged velocity). Contact is implicit and sets no limit.

use std::ops::{Range, RangeInclusive};

use crate::model::{End, Line, Model, SHORTEST, Segments};
use crate::physics::stretch::StretchLaw;

/// Fraction of the closed-form limit that is used [-]. With 0.95, the scene lindahl_fast diverges with five times the
/// drag and 20 elements.
const SAFETY: f64 = 0.9;
/// The same for a line without damping [-].
const SAFETY_UNDAMPED: f64 = 0.38;
/// Damping ratio of the shortest waves above which slackening adds no energy at the full safety factor [-].
const DAMPING_RATIO_ENOUGH: f64 = 0.016;
/// The same for a line that may be released [-]. Measured on a folded chain of 40 to 160 elements with 2 % damping,
/// released at an end: with 0.9, 0.72, 0.63 and 0.54 of the limit, the whip crack gains up to 3.2, 1.1, 0.5 and 0 % of
/// its energy.
const DAMPING_RATIO_WHIP: f64 = 0.1;
/// Steps per first axial period that leave an error of 1 % in a tension with snaps [-]: half of a tolerance of 2 %; the
/// other half is left to the mesh. Measured on oc3_catenary: 2 % with 65, 0.7 % with 130.
const STEPS_PER_AXIAL_PERIOD: f64 = 92.0;
/// Strain up to which the limits cover a stiffening strain measure [-]; beyond it the steps shorten as it stiffens.
const STRAIN_EXPECTED: f64 = 0.05;
/// Largest K|v|Δt/M at which explicit drag damps [-].
const DRAG_COURANT: f64 = 0.5;
/// Fraction of the drag limit used at the start of a communication step, during which nodes may accelerate [-].
const DRAG_MARGIN: f64 = 0.8;
/// Number of bisections for the square of a frequency [-].
const HALVINGS: usize = 30;
/// Axial Courant number at which a position that jumps by ½aΔt² at every communication point leaves an error of [`JUMP_ERROR`] in the tension at the
/// next one [-]. Errors on a cable of 30 elements in communication steps of 10, 20 and 50 ms: 0.01, 0.00 and 0.2 % with a Courant number of 1.5; 0.3,
/// 0.1 and 0.9 % with 2.2 to 3; 2, 6 and 4 % with 4.4.
const JUMP_COURANT: f64 = 1.5;
/// Step over the time in which axial damping carries the strain of a jump through a segment, m l²/BA, at which the error is [`JUMP_ERROR`] of the
/// deviation of the tension [-]. Errors on a chain of 24 segments with BA/EA = 0.02 s in communication steps of 5, 10 and 20 ms: 0.6, 0.3 and 0.3 %
/// with 2.6; 2.9, 2.1 and 0.4 % with 5.2; 9, 11 and 9 % with 11.
const JUMP_DIFFUSION: f64 = 2.5;
/// Relative error in the tension at [`JUMP_COURANT`] [-].
const JUMP_ERROR: f64 = 0.005;
/// Transverse Courant number of the axial-implicit leapfrog [-].
const TRANSVERSE_COURANT: f64 = 0.6;

/// Limit on explicit steps, set by the node whose shortest wave has the highest frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExplicitLimit {
    /// Longest step without drag, with safety [s].
    pub step: f64,
    /// ω²/4 [1/s²].
    springs: f64,
    /// ζω + ½α [1/s].
    dampers: f64,
}

impl ExplicitLimit {
    /// Limit that admits any step.
    pub fn none() -> ExplicitLimit {
        ExplicitLimit {
            step: f64::INFINITY,
            springs: 0.0,
            dampers: 0.0,
        }
    }

    /// Limit for a circular frequency ω [rad/s], BA/EA [s] and α [1/s]. It uses the full safety factor from a damping ratio
    /// of `enough` [-].
    fn new(omega: f64, lag: f64, alpha: f64, enough: f64) -> ExplicitLimit {
        let dampers = 0.5 * (omega * omega * lag + alpha);
        let damped = match omega > 0.0 {
            true => (dampers / omega / enough).min(1.0),
            false => 1.0,
        };
        let safety = SAFETY_UNDAMPED + damped * (SAFETY - SAFETY_UNDAMPED);
        let mut limit = ExplicitLimit {
            step: f64::INFINITY,
            springs: 0.25 * omega * omega,
            dampers,
        };
        limit.step = safety * limit.stable(0.0);
        limit
    }

    /// Returns the stricter limit.
    pub fn or(self, other: ExplicitLimit) -> ExplicitLimit {
        if other.step < self.step { other } else { self }
    }

    /// Limit with springs stiffer than expected by the factor `times` [-].
    pub fn stiffened(self, times: f64) -> ExplicitLimit {
        ExplicitLimit {
            step: self.step / times.sqrt(),
            springs: times * self.springs,
            ..self
        }
    }

    /// Step [s] for a communication step at whose start the largest K|v|/M of all nodes is `rate` [1/s].
    pub fn with_drag(&self, rate: f64) -> f64 {
        self.step.min(self.stable(rate / DRAG_MARGIN))
    }

    /// Returns whether steps of `step` [s] were short enough, given the largest K|v|/M at their end, `rate` [1/s].
    pub fn holds(&self, rate: f64, step: f64) -> bool {
        step <= self.stable(rate)
    }

    /// Longest stable step [s], without the safety factor.
    fn stable(&self, rate: f64) -> f64 {
        let linear = self.dampers + rate / DRAG_COURANT;
        2.0 / (linear + (linear * linear + 4.0 * self.springs).sqrt())
    }
}

/// Explicit step limit of a line; [`ExplicitLimit::none`] for a line without nodes that may move.
pub fn explicit_limit(line: &Line) -> ExplicitLimit {
    if let Some(winch) = &line.winch {
        return explicit_limit(winch.longest()).or(winch_limit(winch.longest()));
    }
    let (segments, enough) = (&line.segments, damping_enough(line));
    let mut limit = ExplicitLimit::none();
    for i in loose_nodes(line) {
        let spring: f64 = adjacent(line, i).map(|segment| stiffness(line, segment)).sum();
        let lags = adjacent(line, i).map(|segment| lag(segments, segment));
        let omega = ((2.0 * spring + heave(line, i)) / line.least_mass(i)).sqrt();
        let lag = lags.fold(0.0, f64::max);
        limit = limit.or(ExplicitLimit::new(omega, lag, fading(line, i), enough));
    }
    limit
}

/// Mass damping coefficient α of a node [1/s].
fn fading(line: &Line, node: usize) -> f64 {
    let damping = line.nodes.mass_damping.as_ref();
    damping.map_or(0.0, |damping| damping[node] / line.least_mass(node))
}

/// Masses of the free points at ends A and B of a line, each shared by its lines [kg]; `None` at prescribed points.
pub type EndShares = [Option<f64>; 2];

/// Returns the shares at the ends of a line.
pub fn end_shares(model: &Model, line: &Line) -> EndShares {
    line.ends.map(|index| {
        let point = &model.points[index];
        let free = point.free()?;
        Some(free.mass / point.attached.len() as f64)
    })
}

/// Nodes between the ends of a line, and those at ends that may be released.
fn loose_nodes(line: &Line) -> RangeInclusive<usize> {
    let parts = |end: End| {
        line.release
            .is_some_and(|sides| sides[end as usize].may_release())
    };
    nodes_between(line, [End::A, End::B].map(parts))
}

/// Nodes between the ends of a line, and those at ends that are included.
fn nodes_between(line: &Line, includes: [bool; 2]) -> RangeInclusive<usize> {
    let [first, last] = includes.map(usize::from);
    1 - first..=line.segment_count() - 1 + last
}

/// Share of the mass of the point at a node [kg]; zero between the ends.
fn share_at(line: &Line, node: usize, shares: EndShares) -> f64 {
    match node {
        0 => shares[0].unwrap_or(0.0),
        node if node == line.segment_count() => shares[1].unwrap_or(0.0),
        _ => 0.0,
    }
}

/// Indices of the segments adjacent to a node; an end node has one.
fn adjacent(line: &Line, node: usize) -> Range<usize> {
    node.saturating_sub(1)..(node + 1).min(line.segment_count())
}

/// Explicit step limit of the node before the end segment of a line on a winch, for the shortest end segment at any node.
fn winch_limit(winch_state: &Line) -> ExplicitLimit {
    let limit = |i: usize| {
        let (left, right) = (
            stiffness(winch_state, i - 1),
            stiffness(winch_state, i) / SHORTEST,
        );
        let mass = 0.5 * (1.0 + SHORTEST) * winch_state.least_mass(i);
        let lag = lag(&winch_state.segments, i - 1).max(lag(&winch_state.segments, i));
        let omega = (2.0 * (left + right) / mass).sqrt();
        ExplicitLimit::new(omega, lag, fading(winch_state, i), DAMPING_RATIO_ENOUGH)
    };
    let nodes = 1..winch_state.segment_count();
    nodes.map(limit).fold(ExplicitLimit::none(), ExplicitLimit::or)
}

/// Explicit step limit of a free point with its lines; [`ExplicitLimit::none`] for other points.
pub fn free_point_limit(model: &Model, point: usize) -> ExplicitLimit {
    let Some(free) = model.points[point].free() else {
        return ExplicitLimit::none();
    };
    let own = free.sphere.map_or(0.0, |sphere| sphere.stiffness_max());
    let mut alone = 0.0_f64; // largest k/M of a half node if all other lines are released [1/s²]
    let (mut enough, mut alpha) = (DAMPING_RATIO_ENOUGH, 0.0_f64);
    let (mut mass, mut sum, mut longest) = (free.mass, 0.5 * own, 0.0_f64);
    for &(index, end) in &model.points[point].attached {
        let line = &model.lines[index];
        let node = line.end_node(end);
        let segment = match end {
            End::A => 0,
            End::B => node - 1,
        };
        mass += line.least_mass(node);
        sum += stiffness(line, segment) + 0.5 * heave(line, node);
        if line.release.is_some() {
            alone = lone_rates(model, point);
        }
        longest = longest.max(lag(&line.segments, segment));
        alpha = alpha.max(fading(line, node));
        enough = enough.max(damping_enough(line));
    }
    let omega = (2.0 * (sum / mass).max(alone)).sqrt();
    ExplicitLimit::new(omega, longest, alpha, enough)
}

/// Largest ratio of end-segment stiffness to half-node mass [1/s²] among the lines at a point.
fn lone_rates(model: &Model, point: usize) -> f64 {
    let attached = model.points[point].attached.iter();
    let rate = |&(index, end): &(usize, End)| {
        let line = &model.lines[index];
        let node = line.end_node(end);
        let spring = stiffness(line, if end == End::A { 0 } else { node - 1 });
        (spring + 0.5 * heave(line, node)) / line.least_mass(node)
    };
    attached.map(rate).fold(0.0, f64::max)
}

/// k = EA/l of a segment [N/m], at the largest expected slope of its strain measure; (EA + P)/l with joints as stiff as a tension P.
fn stiffness(line: &Line, i: usize) -> f64 {
    let segments = &line.segments;
    let slope = expected_slope(&segments.law[i]);
    (segments.in_motion(i).0 * slope + line.compression_max(i)) / segments.length[i]
}

/// Slope of a strain measure that the step limits assume [-].
pub(super) fn expected_slope(law: &StretchLaw) -> f64 {
    law.at(STRAIN_EXPECTED).slope.max(1.0)
}

/// BA/EA of a segment [s].
fn lag(segments: &Segments, i: usize) -> f64 {
    let (stiffness, damping) = segments.in_motion(i);
    damping / stiffness
}

/// Damping ratio above which a line uses the full safety factor [-].
fn damping_enough(line: &Line) -> f64 {
    match &line.release {
        None => DAMPING_RATIO_ENOUGH,
        Some(_) => DAMPING_RATIO_WHIP,
    }
}

/// Square of the highest circular frequency of axial waves in a line [1/s²]. Its ends are at prescribed points, or carry
/// shares of free points. The nodes have their masses in air and move along the line only. Infinite if the springs may
/// become stiffer than the axial stiffness. Computed by bisection with Sturm's theorem (Golub & Van Loan 2013, Matrix
/// Computations, section 8.4).
pub fn axial_frequency_squared(line: &Line, shares: EndShares) -> f64 {
    if line.segments.viscoelastic.is_some() || line.segments.law.iter().any(StretchLaw::may_stiffen) {
        return f64::INFINITY;
    }
    let nodes = nodes_between(line, shares.map(|share| share.is_some()));
    let first = *nodes.start();
    let mass = |i: usize| line.nodes.mass[i] + share_at(line, i, shares);
    let own = |i: usize| {
        let springs = adjacent(line, i).map(|segment| stiffness(line, segment));
        springs.sum::<f64>() / mass(i)
    };
    let shared = |i: usize| match i == first {
        true => 0.0,
        false => stiffness(line, i - 1).powi(2) / (mass(i - 1) * mass(i)),
    };
    // λ exceeds all eigenvalues of A if all pivots of λ − A are positive
    let is_beyond = |square: f64| {
        let mut pivot = f64::INFINITY;
        nodes.clone().all(|i| {
            pivot = square - own(i) - shared(i) / pivot;
            pivot > 0.0
        })
    };
    let gershgorin = 2.0 * nodes.clone().map(own).fold(0.0, f64::max);
    let (mut low, mut high) = (0.0, gershgorin);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match is_beyond(middle) {
            true => high = middle,
            false => low = middle,
        }
    }
    high
}

/// Step [s] that resolves the first axial period 4L/c, for a tolerance of the tension [-].
pub fn axial_accuracy_step(line: &Line, tolerance: f64) -> f64 {
    let segments = &line.segments;
    let travel = travel_time(line, &line.nodes.mass_tangent, |i| segments.in_motion(i).0);
    resolved(4.0 * travel, tolerance)
}

/// Step [s] in which the strain from a jump of a line's end leaves the end segment, as an axial wave and by axial damping, for a tolerance of the
/// tension [-].
pub fn jump_accuracy_step(line: &Line, tolerance: f64) -> f64 {
    let in_motion = |i: usize| line.segments.in_motion(i);
    let count = line.segment_count();
    let travel = travel_time(line, &line.nodes.mass_tangent, |i| in_motion(i).0) / count as f64;
    let lag = (0..count)
        .map(|i| in_motion(i).1 / in_motion(i).0)
        .fold(0.0, f64::max);
    let step = (JUMP_COURANT * travel).min(JUMP_DIFFUSION * travel * travel / lag);
    step * (tolerance / JUMP_ERROR).sqrt()
}

/// Step [s] that resolves the elastic oscillation of a free point on its lines, each taken as one spring with half of its mass, for a tolerance of
/// the tension [-]. Infinite for points that are not free.
pub fn point_accuracy_step(model: &Model, point: usize, tolerance: f64) -> f64 {
    let Some(free) = model.points[point].free() else {
        return f64::INFINITY;
    };
    let (mut mass, mut spring) = (free.mass, 0.0);
    for &(index, _) in &model.points[point].attached {
        let line = &model.lines[index];
        let yields = |i: usize| 1.0 / stiffness(line, i);
        spring += 1.0 / (0..line.segment_count()).map(yields).sum::<f64>();
        mass += 0.5 * line.nodes.mass_tangent.iter().sum::<f64>();
    }
    resolved(std::f64::consts::TAU * (mass / spring).sqrt(), tolerance)
}

/// Step [s] that resolves an axial period [s], for a tolerance of the tension [-].
fn resolved(period: f64, tolerance: f64) -> f64 {
    period / STEPS_PER_AXIAL_PERIOD * (tolerance / 0.02).sqrt()
}

/// Longest period of a line's transverse waves between fixed ends [s], under a tension [N].
pub fn transverse_period(line: &Line, tension: f64) -> f64 {
    let mass = match &line.surface {
        None => &line.nodes.mass_normal,
        Some(_) => &line.nodes.mass, // in air
    };
    2.0 * travel_time(line, mass, |_| tension.max(0.0))
}

/// Travel time of a wave along a line [s], from the masses of its nodes [kg] and the restoring force of its segments [N].
fn travel_time(line: &Line, masses: &[f64], force: impl Fn(usize) -> f64) -> f64 {
    let (nodes, lengths) = (&line.nodes, &line.segments.length);
    let time = |i: usize| {
        let mass = masses[i] + masses[i + 1];
        let length = nodes.length[i] + nodes.length[i + 1];
        lengths[i] * (mass / length / force(i)).sqrt()
    };
    (0..line.segment_count()).map(time).sum()
}

/// Maximum waterplane stiffness at a node [N/m].
fn heave(line: &Line, node: usize) -> f64 {
    let surface = line.surface.as_ref();
    surface.map_or(0.0, |surface| surface.stiffness_max(node))
}

/// Step limit [s] for the heave of a free point, with the safety factor; infinite if the point does not pierce the surface.
pub fn point_heave_step(model: &Model, point: usize) -> f64 {
    let sphere = model.points[point].free().and_then(|free| free.sphere);
    let stiffness = sphere.map_or(0.0, |sphere| sphere.stiffness_max());
    SAFETY * 2.0 / (stiffness / least_mass(model, point)).sqrt()
}

/// Minimum mass of a free point and of the half nodes tied to it [kg].
pub fn least_mass(model: &Model, point: usize) -> f64 {
    let point = &model.points[point];
    let tied = point.attached.iter().map(|&(line, end)| {
        let line = &model.lines[line];
        line.least_mass(line.end_node(end))
    });
    point.free().map_or(0.0, |free| free.mass) + tied.sum::<f64>()
}

/// Step limit [s] for the heave of a line, with the safety factor; infinite if the line does not pierce the surface.
pub fn heave_step(line: &Line) -> f64 {
    let limit = |i: usize| SAFETY * 2.0 / (heave(line, i) / line.least_mass(i)).sqrt();
    let nodes = line.surface.as_ref().map(|_| loose_nodes(line));
    nodes
        .into_iter()
        .flatten()
        .map(limit)
        .fold(f64::INFINITY, f64::min)
}

/// Transverse step limit [s] of a line with shares of free points under a tension [N]; infinite without tension. Uses Gershgorin's bound with the
/// transverse stiffness T/l of the segments; for equal segments the limit is 0.6 h/c.
pub fn transverse_step(line: &Line, tension: f64, shares: EndShares) -> f64 {
    let lengths = &line.segments.length;
    let mut limit = f64::INFINITY;
    let may_release = loose_nodes(line);
    let includes = [
        *may_release.start() == 0 || shares[0].is_some(),
        *may_release.end() == line.segment_count() || shares[1].is_some(),
    ];
    for i in nodes_between(line, includes) {
        let mass = share_at(line, i, shares)
            + match &line.surface {
                None => line.nodes.mass_normal[i],
                Some(_) => line.nodes.mass[i], // in air
            };
        let inverse: f64 = lengths[adjacent(line, i)].iter().map(|l| 1.0 / l).sum();
        let stiffness = tension.max(0.0) * inverse;
        let omega = (2.0 * stiffness / mass).sqrt();
        limit = limit.min(TRANSVERSE_COURANT * 2.0 / omega);
    }
    limit
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use nalgebra::DMatrix;

    use super::*;
    use crate::draft::draft;
    use crate::dynamics::leapfrog::step::Step;

    /// Line with EA = 1 MN, of sections given as (mass per length [kg/m], length [m], number of elements).
    fn line(sections: &[(f64, f64, usize)], strain: &str) -> Line {
        let names = ["one", "two", "three"];
        let named = || names.into_iter().zip(sections);
        let keys = |(name, (mass, _, _)): (&str, &(f64, f64, usize))| {
            format!(
                "line_types.{name} = {{ mass = {mass}, weight = 0.0, axial_stiffness = 1e6, strain = '{strain}' }}\n"
            )
        };
        let span: f64 = sections.iter().map(|(_, length, _)| length).sum();
        let sections: Vec<_> = named()
            .map(|(name, (_, length, n))| (name, *length, Some(*n)))
            .collect();
        let ends = draft(named().map(keys).collect::<String>())
            .fixed("a", [0.0; 3])
            .coupled("b", [span, 0.0, 0.0]);
        ends.sections("line", ["a", "b"], &sections)
            .model()
            .lines
            .remove(0)
    }

    #[test]
    fn the_greatest_axial_frequency_of_equal_elements_is_that_of_a_lattice() {
        for n in [2, 3, 4, 20] {
            let (mass, length) = (2.0, 30.0 / n as f64);
            let phase = std::f64::consts::FRAC_PI_2 * (n - 1) as f64 / n as f64;
            let exact = 4.0 * 1e6 / (mass * length * length) * phase.sin().powi(2);
            let found = axial_frequency_squared(&line(&[(mass, 30.0, n)], "engineering"), [None; 2]);
            assert_relative_eq!(found, exact, max_relative = 1e-8);
        }
        assert_eq!(
            axial_frequency_squared(&line(&[(2.0, 30.0, 1)], "engineering"), [None; 2]),
            0.0
        );
        assert_eq!(
            axial_frequency_squared(&line(&[(2.0, 30.0, 9)], "green"), [None; 2]),
            f64::INFINITY
        );
    }

    #[test]
    fn the_greatest_axial_frequency_of_several_sections_is_the_greatest_eigenvalue() {
        let line = line(&[(2.0, 10.0, 3), (40.0, 1.0, 2), (0.5, 30.0, 4)], "engineering");
        let (mass, last) = (&line.nodes.mass, line.segment_count() - 1);
        let scaled = DMatrix::from_fn(last, last, |i, k| {
            let (low, high) = (i.min(k), i.max(k));
            let stiffness = match high - low {
                0 => stiffness(&line, i) + stiffness(&line, i + 1),
                1 => -stiffness(&line, high),
                _ => 0.0,
            };
            stiffness / (mass[i + 1] * mass[k + 1]).sqrt()
        });
        let exact = scaled.symmetric_eigenvalues().max();
        assert_relative_eq!(
            axial_frequency_squared(&line, [None; 2]),
            exact,
            max_relative = 1e-8
        );
    }

    /// Ratio of the speed of a node after 200 steps to its initial speed, for an initial K|v|Δt/M of `courant`. The initial
    /// velocity changes sign from one step to the next.
    fn flipping(courant: f64) -> f64 {
        let step = Step::after([1.0; 2], 1.0);
        let mut velocities = [1.0, -1.0];
        for _ in 0..200 {
            let [last, before] = velocities;
            let now = last + step.extrapolation * (last - before);
            velocities = [last - step.kick * courant * f64::abs(now) * now, last];
        }
        velocities[0].abs()
    }

    /// Ratio of the amplitude of the shortest wave after 400 steps to its initial amplitude [-]. The steps are `part` of the
    /// stable step. The wave has springs, dampers, mass damping, and drag of rate K|v|/M linearised about a steady velocity.
    fn shortest_wave([omega, lag, alpha, rate]: [f64; 4], part: f64) -> f64 {
        let limit = ExplicitLimit::new(omega, lag, alpha, DAMPING_RATIO_ENOUGH);
        let size = part * limit.stable(rate);
        let step = Step::after([size; 2], size);
        let (mut place, mut velocities) = (-1.0, [2.0 / size, -2.0 / size]);
        for _ in 0..400 {
            place += size * velocities[0];
            let [last, before] = velocities;
            let now = last + step.extrapolation * (last - before);
            let springs = omega * omega * (place + lag * last);
            velocities = [
                last - step.kick * (springs + alpha * last + 2.0 * rate * now),
                last,
            ];
        }
        place.abs()
    }

    #[test]
    fn springs_dampers_and_drag_share_the_limit_of_the_shortest_wave() {
        let cases = [
            [10.0, 0.0, 0.0, 0.0],
            [10.0, 0.05, 0.0, 0.0],
            [10.0, 0.0, 8.0, 0.0],
            [10.0, 0.0, 0.0, 3.0],
            [10.0, 0.05, 8.0, 3.0],
            [0.1, 0.0, 0.0, 3.0],
        ];
        for case in cases {
            let [below, beyond] = [0.98, 1.02].map(|part| shortest_wave(case, part));
            assert!(
                below < 10.0 && (beyond > 1e3 || beyond.is_nan()),
                "{case:?}: {below}, {beyond}"
            );
        }
    }

    #[test]
    fn explicit_drag_damps_up_to_its_limit_and_no_further() {
        assert!(flipping(0.98 * DRAG_COURANT) < 0.5);
        let beyond = flipping(1.02 * DRAG_COURANT);
        assert!(beyond > 1e3 || beyond.is_nan());
        let alone = ExplicitLimit::none();
        assert!(alone.holds(1.0, alone.with_drag(1.0)));
        assert!(!alone.holds(1.0, 1.01 * DRAG_COURANT));
    }
}
