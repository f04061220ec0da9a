//! What a step of the axial-implicit leapfrog knows before its system is solved: segments, nodes, and how the nodes meet a level bed.

use nalgebra::Vector3;

use super::AxialWork;
use super::bed::Bed;
use super::rows::{NodeRow, SegmentRow};
use crate::dynamics::layout::Layout;
use crate::dynamics::leapfrog::Step;
use crate::math::lanes::{Lanes, Vectors};
use crate::physics::stretch::StretchLaw;

/// Weight of the new strain rate over the old one in the axial damping, at most [-].
const DAMPING_SHIFT: f64 = 0.2; // θ
/// Hardness of the dampers over a step from which on it is that [-].
const DAMPING_HARD: f64 = 4.0;

/// Elastic forces of segments [N]: now, and b₁ times what they come to without further strain; b₁ times their slope with the strain.
pub(super) struct Elastic {
    pub now: Lanes,
    ahead: Lanes,
    slope: Lanes,
}

impl AxialWork {
    /// Elastic forces of segments of length `l` [m] that do not creep.
    #[inline(always)]
    pub(super) fn elastic(&self, at: usize, l: Lanes) -> Elastic {
        let one = Lanes::splat(1.0);
        let row = &self.rows.segments[at - 1];
        let strain = l * row.inverse_length - one;
        let (force, slope) = match &self.layout.law {
            StretchLaw::Engineering => (strain, one),
            law => (
                strain.map(|e| law.at(e).force),
                strain.map(|e| law.at(e).slope),
            ),
        };
        let ea = row.axial_stiffness;
        let share = Lanes::splat(self.weights.0[0]) * ea;
        Elastic {
            now: ea * force.positive(),
            ahead: share * force,
            slope: share * slope,
        }
    }

    /// Elastic forces of viscoelastic segments; books what is lost in the step.
    #[inline(always)]
    fn creeping(&mut self, at: usize, direction: Vectors, step: Step) -> Elastic {
        let strain = self.layout.strain(at);
        let rate = self.layout.strain_rate(at, direction, step);
        let creep = self.layout.creep.as_mut().expect("this line creeps");
        creep.strain.store(strain, at);
        let now = creep.elastic(at, strain);
        let loss = creep.loss(at, strain, rate, now.positive());
        let length = self.layout.inverse_length.load(at).recip();
        self.lost = self.lost + loss * length * Lanes::splat(step.kick);
        let (coming, stiffness) = creep.ahead(at, strain, step.drift);
        let b1 = Lanes::splat(self.weights.0[0]);
        Elastic {
            now: now.positive(),
            ahead: b1 * coming,
            slope: b1 * stiffness,
        }
    }

    /// Directions of segments and tangents of nodes.
    #[inline(always)]
    pub(super) fn prepare_geometry(&mut self) {
        let line = &self.layout;
        let rows = self.rows.segments.iter_mut().zip(&mut self.rows.nodes);
        for (at, (segment, node)) in line.rows().zip(rows) {
            let (chord, inverse) = line.chord(at);
            segment.direction = chord.scale(inverse);
            segment.length = chord.dot(chord) * inverse;
            segment.inverse = inverse;
            node.tangent = line.tangent(at);
        }
    }

    /// The part of the system that needs no node, from geometry and velocities at t_{n−½}.
    #[inline(always)]
    pub(super) fn prepare_segments<const CREEPS: bool>(&mut self, step: Step) {
        let hardness = self.damping_rate * step.kick;
        let shift = DAMPING_SHIFT * (hardness / DAMPING_HARD).min(1.0);
        for at in self.layout.rows() {
            let SegmentRow {
                direction, length, ..
            } = self.rows.segments[at - 1];
            let elastic = if CREEPS {
                self.creeping(at, direction, step)
            } else {
                self.elastic(at, length)
            };
            let row = &mut self.rows.segments[at - 1];
            row.prepare(&self.layout, at, elastic, self.weights.0, shift, step);
        }
    }

    /// Drag over the velocity relative to the water, by the velocities extrapolated to t_n.
    #[inline(always)]
    pub(super) fn prepare_drag<const CURRENT: bool>(&mut self, step: Step) {
        let line = &self.layout;
        let Some(drag) = &line.drag else {
            return;
        };
        for (at, node) in line.rows().zip(&mut self.rows.nodes) {
            let mut now = line.velocity_now(at, step);
            if CURRENT && let Some(current) = &mut self.rows.current {
                let flow = line.water_velocity(at);
                current[at - 1].flow = flow;
                now = now - flow;
            }
            let speed = now.dot(node.tangent);
            let across = now - node.tangent.scale(speed);
            let normal = drag.normal.load(at) * across.dot(across).sqrt();
            node.drag = [normal, drag.tangent.load(at) * speed.abs()];
        }
    }

    /// Inverse masses, and the velocities that nodes would come to without tension and bed.
    #[inline(always)]
    pub(super) fn prepare_nodes<const CURRENT: bool>(&mut self, step: Step) {
        let (kick, zero) = (Lanes::splat(step.kick), Lanes::splat(0.0));
        let half = Lanes::splat(0.5) * kick;
        let line = &self.layout;
        for (at, node) in line.rows().zip(&mut self.rows.nodes) {
            let (velocity, tangent) = (line.velocity.load(at), node.tangent);
            let [normal, along] = node.drag;
            let mut masses = [node.mass_normal, node.mass_tangent];
            let mut last = velocity;
            let mut force = Vectors {
                z: zero - line.weight.load(at),
                ..Vectors::zero()
            };
            if CURRENT && let Some(current) = &mut self.rows.current {
                let current = &mut current[at - 1];
                last = last - current.flow;
                if let Some(waves) = &line.waves {
                    current.press = waves.press(at, tangent);
                    force = force + current.press;
                }
            }
            if line.drag.is_some() {
                masses = [
                    masses[0] + (half * normal).max(kick * normal - masses[0]),
                    masses[1] + (half * along).max(kick * along - masses[1]),
                ];
                force = force
                    - last.scale(normal)
                    - tangent.scale((along - normal) * last.dot(tangent));
            }
            if let Some(damping) = &line.mass_damping {
                let damping = damping.load(at);
                masses = [masses[0] + half * damping, masses[1] + half * damping];
                force = force - velocity.scale(damping);
            }
            node.invert(masses);
            node.fall = velocity + node.inverse_mass_off_bed(force).scale(kick);
        }
    }

    /// Held ends move by the secant of their path and yield to no force.
    #[inline(always)]
    pub(super) fn prepare_ends(&mut self, step: Step, ends: [Vector3<f64>; 2]) {
        for end in self.held_ends() {
            let at = self.layout.end_slot(end);
            let secant = (ends[end as usize] - self.layout.position.get(at)) / step.drift;
            self.rows.nodes[at.row - 1].fall.set(at.lane, secant);
        }
    }

    /// Lets the nodes meet the bed, if there is one.
    #[inline(always)]
    pub(super) fn prepare_contact(&mut self, step: Step) {
        let line = &self.layout;
        let nodes = line.rows().zip(&mut self.rows.nodes);
        match &line.contact {
            Some(contact) if contact.bottom.is_none() => {
                for (at, node) in nodes {
                    let penetration = contact.level.load(at) - line.position.load(at).z;
                    let rise = line.velocity.load(at).z;
                    let yields = node.across + node.lift() * node.tangent.z;
                    let law = contact.law(at);
                    node.bed = Bed::new(law, penetration, rise, yields, step);
                    node.touches = node.pushed(rise);
                    node.settle();
                }
            }
            _ => nodes.for_each(|(_, node)| node.loose = node.fall),
        }
    }
}

impl SegmentRow {
    #[inline(always)]
    fn prepare(
        &mut self,
        line: &Layout,
        at: usize,
        elastic: Elastic,
        [b1, h0, h1, h2]: [f64; 4],
        shift: f64,
        step: Step,
    ) {
        let (half, drift) = (Lanes::splat(0.5), Lanes::splat(step.drift));
        let relative = line.velocity.load(at + 1) - line.velocity.load(at);
        let along = self.direction.dot(relative);
        let [t1, t2] = self.history;
        self.along = along;
        self.history = [elastic.now, t1];
        self.elastic = elastic.ahead
            + Lanes::splat(h0) * elastic.now
            + Lanes::splat(h1) * t1
            + Lanes::splat(h2) * t2;
        self.stiffness = elastic.slope * drift * self.inverse_length;
        let share = Lanes::splat(1.0 / b1);
        self.spring_now = elastic.ahead * share;
        self.spring_slope = elastic.slope * self.inverse_length * share;
        let damping = half * self.axial_damping * self.inverse_length;
        self.damping = damping * Lanes::splat(1.0 + shift);
        self.known = self.elastic + damping * Lanes::splat(1.0 - shift) * along;
        let bend = relative.dot(relative) - along * along;
        self.across = bend;
        self.curvature = half * self.stiffness * drift * bend * self.inverse;
        let push = Lanes::splat(f64::from(u8::from(line.negative_tension)));
        let (_, total) = self.spring(along, push); // as if they went on stretching as they do
        self.taut = total.choose(Lanes::splat(1.0), Lanes::splat(-1.0));
    }
}

impl NodeRow {
    /// Inverts the masses across and along the line, with what adds to them [kg]; what is held yields to no force.
    #[inline(always)]
    fn invert(&mut self, [across, along]: [Lanes; 2]) {
        let inverse = self.free * (across * along).recip();
        self.across = along * inverse;
        self.excess = across * inverse - self.across;
        self.held = Lanes::splat(0.0);
    }

    /// M⁻¹ x off the bed.
    #[inline(always)]
    fn inverse_mass_off_bed(&self, x: Vectors) -> Vectors {
        x.scale(self.across) + self.tangent.scale(self.excess * self.tangent.dot(x))
    }

    /// 1 where the level bed pushes nodes that rise at `rise` [m/s], else −1.
    #[inline(always)]
    pub(super) fn pushed(&self, rise: Lanes) -> Lanes {
        let pushes = self.bed.pushes(rise).where_positive(self.free); // held ends yield to no bed
        pushes.choose(Lanes::splat(1.0), Lanes::splat(-1.0))
    }

    /// Adds the level bed to the nodes it pushes: a rank-one update of the inverse mass, and its impulse.
    #[inline(always)]
    pub(super) fn settle(&mut self) {
        (self.held, self.loose) = (Lanes::splat(0.0), self.fall);
        if !self.touches.any_positive() {
            return;
        }
        let (one, resistance, lift) = (Lanes::splat(1.0), self.bed.resistance, self.lift());
        let share = (one + resistance * (self.across + lift * self.tangent.z))
            .recip()
            .where_positive(self.touches);
        let impulse = self.bed.push(self.fall.z) * share;
        self.held = resistance * share;
        self.loose = self.fall + self.tangent.scale(lift * impulse);
        self.loose.z = self.loose.z + self.across * impulse;
    }
}
