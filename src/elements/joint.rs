//! Bending in the assembled system: joints that couple three nodes, and the chain that they form.
//!
//! A joint at node i has the slopes g₁ and g₂ of its energy with respect to the vectors e₁ and e₂ of its two segments, so that R_{i−1} −= g₁, R_i +=
//! g₁ − g₂, R_{i+1} += g₂; J follows likewise from the second derivatives. A clamp acts as a segment that turns with its support: the damper of its
//! joint resists the rate of the segment's vector e as seen from there, ė − ω × e. A moment on an end is a
//! couple of forces ± f on the nodes of its segment, and its slope is part of the block of that segment.

use nalgebra::{Matrix3, Vector3};

use super::{LineWork, Weights};
use crate::math::block_banded::{Blocks, Chain, Ends, Pivots};
use crate::model::{Bending, End, Line, LineState, PointState, joint, joint_of_segments};
use crate::physics::bending::{Couple, Hessian};

/// Workspace of a line with bending stiffness.
#[derive(Debug, Clone)]
pub(crate) struct BendingWork {
    /// True if the last assembly included bending.
    pub active: bool,
    /// J of the joints in the rows of nodes and the columns of the next ones; the opposite blocks are the transposes.
    pub near: Vec<Matrix3<f64>>,
    /// J in the rows of nodes and the columns of the nodes after next.
    pub far: Vec<Matrix3<f64>>,
    /// Largest force of a joint on a node at the last assembly [N].
    pub greatest: f64,
    /// `near` plus the coupling of the segments, above and below the diagonal.
    above: Vec<Matrix3<f64>>,
    below: Vec<Matrix3<f64>>,
    chain: Chain<true>,
}

/// Parts of residual and tangent to add.
#[derive(Debug, Clone, Copy)]
pub(super) struct Parts {
    /// Weight of the forces of the joints in R [-].
    pub force: f64,
    /// c_k: weight of ∂R/∂r [-].
    pub position: f64,
    /// c_c: weight of ∂R/∂v [1/s].
    pub velocity: f64,
    /// True if the tangent is required.
    pub tangent: bool,
    /// True if the tangent must be positive semi-definite, rather than exact.
    pub convex: bool,
}

impl Parts {
    pub(super) const AT_REST: Parts = Parts {
        force: 1.0,
        position: 1.0,
        velocity: 0.0,
        tangent: true,
        convex: false,
    };

    pub(super) fn of_step(weights: &Weights, tangent: bool) -> Parts {
        Parts {
            force: weights.force,
            position: weights.position,
            velocity: weights.velocity,
            tangent,
            convex: weights.convex,
        }
    }
}

impl BendingWork {
    /// Workspace for a line of `nodes` nodes.
    pub(super) fn new(nodes: usize) -> BendingWork {
        let zeros = |count: usize| vec![Matrix3::zeros(); count];
        BendingWork {
            active: false,
            near: zeros(nodes - 1),
            far: zeros(nodes.saturating_sub(2)),
            greatest: 0.0,
            above: zeros(nodes - 1),
            below: zeros(nodes - 1),
            chain: Chain::new(nodes),
        }
    }
}

impl LineWork {
    /// Adds the joints of a line to residual and tangent, after its segments; without damping if no velocities are given. The clamps turn at `spins`
    /// [rad/s].
    pub(super) fn add_bending(
        &mut self,
        bending: &Bending,
        (clamps, spins): ([Option<Vector3<f64>>; 2], [Vector3<f64>; 2]),
        velocity: &[Vector3<f64>],
        parts: &Parts,
    ) {
        let Some(work) = &mut self.bending else {
            return;
        };
        if parts.tangent {
            work.near.fill(Matrix3::zeros());
            work.far.fill(Matrix3::zeros());
        }
        let (last, mut greatest) = (self.direction.len(), 0.0_f64);
        for i in (0..=last).filter(|&i| bending.joint[i] > 0.0) {
            let Some(turn) = joint_of_segments(clamps, [i, last], |segment| self.direction[segment]) else {
                continue;
            };
            let (stiffness, rest) = (bending.joint[i], bending.rest[i]);
            let [mut first, mut second] = turn.energy(stiffness, rest).slope;
            greatest = greatest.max(first.norm_squared()).max(second.norm_squared());
            let mut tangent = parts.tangent.then(|| match parts.convex {
                true => turn.convex_hessian(parts.position * stiffness),
                false => turn.hessian(parts.position * stiffness, rest),
            });
            if let Some(damping) = moving(bending, velocity) {
                let damper = turn.damper(damping[i]);
                let chord =
                    |segment: usize| self.direction[segment].along / self.direction[segment].per_length;
                let rates = rates_from_clamps([i, last], chord, |node| velocity[node], spins);
                let drag = damper.product(rates);
                (first, second) = (first + drag[0], second + drag[1]);
                tangent = tangent.map(|stiff| stiff.plus(&damper.times(parts.velocity)));
            }
            if i > 0 {
                self.residual[i - 1] -= parts.force * first;
            }
            self.residual[i] += parts.force * (first - second);
            if i < last {
                self.residual[i + 1] += parts.force * second;
            }
            if let Some(tangent) = tangent {
                work.add_tangent(&mut self.diagonal, i, &tangent);
            }
        }
        work.greatest = greatest.sqrt();
    }

    /// Adds the moments [N m] on the ends of a line that bends; without their slope if the tangent must be positive semi-definite.
    pub(super) fn add_end_moments(
        &mut self,
        position: &[Vector3<f64>],
        moments: [Vector3<f64>; 2],
        parts: &Parts,
    ) {
        for (couple, i) in couples(position, moments) {
            self.residual[i] += parts.force * couple.force;
            self.residual[i + 1] -= parts.force * couple.force;
            if parts.tangent && !parts.convex {
                let slope = parts.position * couple.slope;
                self.diagonal[i] -= slope;
                self.diagonal[i + 1] -= slope;
                self.coupling[i] += slope;
            }
        }
    }

    /// Eliminates the nodes between the ends from the system; `None` if a pivot is not accepted.
    pub(crate) fn eliminate(&mut self, first_free: bool, pivots: Pivots) -> Option<Ends> {
        let Some(work) = self.bending.as_mut().filter(|work| work.active) else {
            let blocks = Blocks {
                diagonal: &self.diagonal,
                above: &self.coupling,
                below: &self.coupling,
                far: &[],
            };
            return self.chain.eliminate(blocks, &self.residual, first_free, pivots);
        };
        for (i, coupling) in self.coupling.iter().enumerate() {
            work.above[i] = coupling + work.near[i];
            work.below[i] = coupling + work.near[i].transpose();
        }
        let blocks = Blocks {
            diagonal: &self.diagonal,
            above: &work.above,
            below: &work.below,
            far: &work.far,
        };
        work.chain.eliminate(blocks, &self.residual, first_free, pivots)
    }

    /// Right-hand sides of the condensed system for the present residual, after [`Self::eliminate`] with the present tangent.
    pub(crate) fn eliminate_right(&mut self) -> [Vector3<f64>; 2] {
        match self.bending.as_mut().filter(|work| work.active) {
            Some(work) => {
                let BendingWork { chain, far, .. } = work;
                chain.eliminate_right(far, &self.residual)
            }
            None => self.chain.eliminate_right(&[], &self.residual),
        }
    }

    /// Computes the full solution from the solution at the ends.
    pub(crate) fn substitute(&mut self, a: Vector3<f64>, b: Vector3<f64>) {
        match self.bending.as_mut().filter(|work| work.active) {
            Some(work) => work.chain.substitute(a, b),
            None => self.chain.substitute(a, b),
        }
    }

    /// Solution, one vector per node.
    pub(crate) fn solution(&self) -> &[Vector3<f64>] {
        match self.bending.as_ref().filter(|work| work.active) {
            Some(work) => work.chain.solution(),
            None => self.chain.solution(),
        }
    }
}

impl BendingWork {
    #[inline(always)]
    fn add_tangent(&mut self, diagonal: &mut [Matrix3<f64>], i: usize, h: &Hessian) {
        let back = h.mixed.transpose();
        diagonal[i] += h.first - h.mixed - back + h.second;
        if i > 0 {
            diagonal[i - 1] += h.first;
            self.near[i - 1] += h.mixed - h.first;
        }
        if i + 1 < diagonal.len() {
            diagonal[i + 1] += h.second;
            self.near[i] += h.mixed - h.second;
        }
        if i > 0 && i + 1 < diagonal.len() {
            self.far[i - 1] -= h.mixed;
        }
    }
}

/// Dampers of the joints [N m s], if velocities are given.
fn moving<'a>(bending: &'a Bending, velocity: &[Vector3<f64>]) -> Option<&'a [f64]> {
    let damping = bending.damping.as_deref();
    damping.filter(|_| !velocity.is_empty())
}

/// Couples of moments [N m] on the ends of a line, with the indices of their segments.
fn couples(position: &[Vector3<f64>], moments: [Vector3<f64>; 2]) -> impl Iterator<Item = (Couple, usize)> {
    let segments = [0, position.len() - 2];
    let acting = moments.into_iter().zip(segments);
    acting
        .filter(|(moment, _)| *moment != Vector3::zeros())
        .map(|(moment, i)| (Couple::new(moment, position[i + 1] - position[i]), i))
}

/// Power [W], or work [J], of moments [N m] on the ends of a line whose nodes move at velocities [m/s], or by displacements [m].
pub fn end_moment_power(
    position: &[Vector3<f64>],
    moments: [Vector3<f64>; 2],
    motion: impl Fn(usize) -> Vector3<f64>,
) -> f64 {
    couples(position, moments)
        .map(|(couple, i)| couple.force.dot(&(motion(i + 1) - motion(i))))
        .sum()
}

/// Rates [m/s] of the two segment vectors at a node of a line whose nodes up to `last` move at `velocity`; zero where the line ends.
pub(crate) fn rates(node: usize, last: usize, velocity: impl Fn(usize) -> Vector3<f64>) -> [Vector3<f64>; 2] {
    let rate = |from: usize| velocity(from + 1) - velocity(from);
    [
        if node > 0 {
            rate(node - 1)
        } else {
            Vector3::zeros()
        },
        if node < last { rate(node) } else { Vector3::zeros() },
    ]
}

/// [`rates`] as seen from a clamp at that node, which turns at one of the `spins` [rad/s].
fn rates_from_clamps(
    [node, last]: [usize; 2],
    chord: impl Fn(usize) -> Vector3<f64>,
    velocity: impl Fn(usize) -> Vector3<f64>,
    spins: [Vector3<f64>; 2],
) -> [Vector3<f64>; 2] {
    let [mut first, mut second] = rates(node, last, velocity);
    if node == 0 {
        second -= spins[0].cross(&chord(0));
    } else if node == last {
        first -= spins[1].cross(&chord(last - 1));
    }
    [first, second]
}

/// Power dissipated by the joint dampers of a line [W] at velocities `motion` [m/s] of its nodes and angular velocities `turning` [rad/s] of its clamps;
/// the dampers resist the velocities of `state` and the angular velocities of the `points`.
pub fn joint_damping_power(
    line: &Line,
    state: &LineState,
    points: &[PointState],
    motion: impl Fn(usize) -> Vector3<f64>,
    turning: [Vector3<f64>; 2],
) -> f64 {
    let Some(damping) = line.bending.as_ref().and_then(|bending| bending.damping.as_ref()) else {
        return 0.0;
    };
    let (last, clamps) = (line.segment_count(), line.clamps(points));
    let spins = line.ends.map(|point| points[point].spin);
    let chord = |segment: usize| state.position[segment + 1] - state.position[segment];
    let power = |(i, damping): (usize, &f64)| {
        let Some(turn) = joint(clamps, &state.position, i) else {
            return 0.0;
        };
        let resisted = rates_from_clamps([i, last], chord, |node| state.velocity[node], spins);
        let drag = turn.damper(*damping).product(resisted);
        let rates = rates_from_clamps([i, last], chord, &motion, turning);
        drag[0].dot(&rates[0]) + drag[1].dot(&rates[1])
    };
    damping.iter().enumerate().map(power).sum()
}

/// Shear [N] of segment `i` of a line: the force of the joints at both of its nodes, and of the moments [N m] on the ends of the line, on the node
/// towards `end`. The line may be clamped there at the orientation of the `point`; the other end is treated as pinned. Without velocities there is no
/// damping.
pub fn shear(
    line: &Line,
    [position, velocity]: [&[Vector3<f64>]; 2],
    i: usize,
    (end, point): (End, &PointState),
    moments: [Vector3<f64>; 2],
) -> Vector3<f64> {
    let Some(bending) = &line.bending else {
        return Vector3::zeros();
    };
    let clamp = line.clamp(end, point);
    let last = position.len() - 1;
    let clamps = match end {
        End::A => [clamp, None],
        End::B => [None, clamp],
    };
    let mut force = Vector3::zeros();
    for (couple, segment) in couples(position, moments) {
        if segment == i {
            force -= couple.force;
        }
    }
    for (node, side) in [(i, 1), (i + 1, 0)] {
        let open = node == 0 && clamps[0].is_none() || node == last && clamps[1].is_none();
        if open || bending.joint[node] == 0.0 {
            continue;
        }
        let Some(turn) = joint(clamps, position, node) else {
            continue;
        };
        let mut slope = turn.energy(bending.joint[node], bending.rest[node]).slope;
        if let Some(damping) = moving(bending, velocity) {
            let chord = |segment: usize| position[segment + 1] - position[segment];
            let rates = rates_from_clamps([node, last], chord, |i| velocity[i], [point.spin; 2]);
            let drag = turn.damper(damping[node]).product(rates);
            slope = [slope[0] + drag[0], slope[1] + drag[1]];
        }
        force += slope[side];
    }
    match end {
        End::A => force,
        End::B => -force,
    }
}

/// Moment [N m] of a line on its clamp at an end. Without velocities there is no damping.
pub fn end_moment(
    line: &Line,
    [position, velocity]: [&[Vector3<f64>]; 2],
    end: End,
    point: &PointState,
) -> Vector3<f64> {
    let (Some(bending), Some(clamp)) = (&line.bending, line.clamp(end, point)) else {
        return Vector3::zeros();
    };
    let (node, last) = (line.end_node(end), line.segment_count());
    let (clamps, segment, side, sign) = match end {
        End::A => ([Some(clamp), None], 0, 1, 1.0),
        End::B => ([None, Some(clamp)], last - 1, 0, -1.0),
    };
    let Some(turn) = joint(clamps, position, node) else {
        return Vector3::zeros();
    };
    let elastic = sign * turn.moment_on_first(bending.joint[node], bending.rest[node]);
    moving(bending, velocity).map_or(elastic, |damping| {
        let chord = |segment: usize| position[segment + 1] - position[segment];
        let rates = rates_from_clamps([node, last], chord, |i| velocity[i], [point.spin; 2]);
        elastic + chord(segment).cross(&turn.damper(damping[node]).product(rates)[side])
    })
}
