//! Quantities of a step of the axial-implicit leapfrog that do not depend on T̄: segments, nodes, and contact with a level seabed.
//!
//! Loops address the rows by index: with iterators the compiler would combine four rows and process them lane by lane.

use nalgebra::Vector3;

use super::AxialLine;
use super::rows::{NodeRow, Sizes, pulled, springs};
use crate::dynamics::leapfrog::layout::inverse_norm;
use crate::dynamics::leapfrog::step::Step;
use crate::math::lanes::{Lanes, Vectors};

/// Maximum difference between the weights of the new and the old strain rate in the axial damping [-].
const DAMPING_SHIFT: f64 = 0.2; // θ
/// Stiffness r of the dampers over a step above which θ has this value [-].
const DAMPING_HARD: f64 = 4.0;

/// Springs of a row of segments: tension at t_n as if they also pushed [N], b₁ times the tension after the step without further strain [N], and b₁ times
/// its slope with the length [N/m].
struct Springs {
    now: Lanes,
    ahead: Lanes,
    slope: Lanes,
}

impl AxialLine {
    #[inline(always)]
    pub(super) fn sizes(&self, step: Step) -> Sizes {
        let hardness = self.kernel.damping_rate * step.kick;
        let shift = DAMPING_SHIFT * (hardness / DAMPING_HARD).min(1.0);
        let push = f64::from(u8::from(self.layout.negative_tension));
        Sizes {
            kick: Lanes::splat(step.kick),
            drift: Lanes::splat(step.drift),
            damping: [0.5 * (1.0 + shift), 0.5 * (1.0 - shift)].map(Lanes::splat),
            push: Lanes::splat(push),
            turning: Lanes::splat(0.5 * shift * step.kick),
            weights: self.kernel.weights.0.map(Lanes::splat),
        }
    }

    #[inline(always)]
    fn springs<const SPRINGS: u8>(&mut self, at: usize) -> Springs {
        if SPRINGS == springs::VISCOELASTIC {
            return self.viscoelastic_springs(at);
        }
        let row = &self.kernel.rows.segments[at - 1];
        let (stiffness, longer) = (row.axial_stiffness, row.length - row.unstretched_length);
        let share = Lanes::splat(self.kernel.weights.0[0]) * stiffness;
        if SPRINGS == springs::LINEAR {
            return Springs {
                now: stiffness * longer,
                ahead: share * longer,
                slope: share,
            };
        }
        let law = &self.layout.law;
        // a segment beyond an end has no stiffness and may have zero length: the logarithm of its stretch would be infinite
        let strain = (longer * self.layout.inverse_length.load(at)).where_positive(stiffness);
        let [force, slope] = pulled(law, strain);
        let stretched = row.unstretched_length * force;
        Springs {
            now: stiffness * stretched,
            ahead: share * stretched,
            slope: share * slope,
        }
    }

    #[inline(always)]
    fn viscoelastic_springs(&mut self, at: usize) -> Springs {
        let strain = self.layout.strain(at);
        let viscoelastic = self
            .layout
            .viscoelastic
            .as_mut()
            .expect("this line is viscoelastic");
        viscoelastic.strain.store(strain, at);
        let now = viscoelastic.elastic(at, strain);
        let inverse = self.layout.inverse_length.load(at);
        let (coming, stiffness) = viscoelastic.ahead(at, strain);
        let b1 = Lanes::splat(self.kernel.weights.0[0]);
        Springs {
            now,
            ahead: b1 * coming,
            slope: b1 * stiffness * inverse,
        }
    }

    /// Computes the directions and lengths of the segments, and the tangents of the nodes.
    #[inline(always)]
    pub(super) fn prepare_geometry(&mut self) {
        let (line, last) = (&self.layout, self.layout.striping.rows());
        let position = line.position.rows(last);
        let (segments, nodes) = (
            &mut self.kernel.rows.segments[..last],
            &mut self.kernel.rows.nodes[..last],
        );
        for at in line.rows() {
            let (before, here, after) = (position[at - 1], position[at], position[at + 1]);
            let segment = &mut segments[at - 1];
            let chord = after - here;
            let inverse = inverse_norm(chord.dot(chord));
            segment.inverse = inverse.min(line.inverse_length.load(at));
            segment.direction = chord.scale(inverse);
            segment.length = chord.dot(chord) * inverse;
            let chord = after - before;
            nodes[at - 1].tangent = chord.scale(inverse_norm(chord.dot(chord)));
        }
    }

    /// Prepares the segments, from their geometry and the velocities at t_{n−½}.
    #[inline(always)]
    pub(super) fn prepare_segments<const SPRINGS: u8>(&mut self, sizes: &Sizes) {
        let half = Lanes::splat(0.5);
        let [b1, ..] = sizes.weights;
        let mut least = Lanes::splat(f64::INFINITY);
        for at in self.layout.rows() {
            let found = self.springs::<SPRINGS>(at);
            let velocity = &self.layout.velocity;
            let relative = velocity.load(at + 1) - velocity.load(at);
            let row = &mut self.kernel.rows.segments[at - 1];
            let along = row.direction.dot(relative);
            let [last, before, _] = row.history;
            row.along = along;
            row.history = [found.now, last, before];
            row.margins[0] = found.now.min(last).min(before);
            row.margins[1] = Lanes::splat(f64::INFINITY);
            let memory = row.all_remembered(sizes);
            row.elastic = found.ahead + memory;
            if SPRINGS == springs::CURVED {
                row.memory = memory;
            }
            row.stiffness = found.slope * sizes.drift;
            let bend = (relative.dot(relative) - along * along) * row.inverse;
            row.curvature = half * row.stiffness * sizes.drift * bend;
            row.earlier_rate = sizes.damping[1] * along + sizes.turning * bend;
            // linearised at the strain reached with the current stretching velocity
            if SPRINGS == springs::CURVED {
                let inverse = self.layout.inverse_length.load(at);
                row.follow(&self.layout.law, along, inverse, [b1, sizes.drift]);
            }
            let pull = (Lanes::splat(1.0) - sizes.push) * row.axial_damping * along;
            least = least.min(row.margins[0] + pull);
            let total = row.spring(along) + pull;
            row.taut = total.choose(Lanes::splat(1.0), Lanes::splat(-1.0));
        }
        let forgot = std::mem::replace(
            &mut self.kernel.forgets,
            (Lanes::splat(0.0) - least).any_positive(),
        );
        if forgot || self.kernel.forgets {
            self.remember_segments(sizes);
        }
    }

    /// Includes the earlier tensions, where springs are in compression in this step or were in the last one.
    #[inline(always)]
    fn remember_segments(&mut self, sizes: &Sizes) {
        for row in &mut self.kernel.rows.segments {
            (row.memory, row.damping) = (row.all_remembered(sizes), row.axial_damping);
            let pull = row.pull(row.along, sizes);
            if (Lanes::splat(0.0) - row.margins[0] - pull).any_positive() {
                row.remember(row.along, sizes);
                let total = row.spring(row.along) + row.pull(row.along, sizes);
                row.taut = total.choose(Lanes::splat(1.0), Lanes::splat(-1.0));
            }
        }
    }

    /// Evaluates the drag at the velocities relative to the water: across the line at those extrapolated to t_n; along the line as the mean of
    /// t_{n−½} and t_{n+½}, with a slope at the extrapolated velocities.
    #[inline(always)]
    fn prepare_drag<const CURRENT: bool>(&mut self, step: Step) {
        let (line, last) = (&self.layout, self.layout.striping.rows());
        let Some(drag) = &line.drag else {
            return;
        };
        let [normals, tangents] = [&drag.normal, &drag.tangent].map(|of| of.rows(last));
        let [velocity, before] = [&line.velocity, &line.velocity_before].map(|of| of.rows(last));
        let nodes = &mut self.kernel.rows.nodes[..last];
        let extrapolation = Lanes::splat(step.extrapolation);
        for at in line.rows() {
            let node = &mut nodes[at - 1];
            let mut past = velocity[at];
            let mut now = past + (past - before[at]).scale(extrapolation);
            if CURRENT && let Some(current) = &mut self.kernel.rows.current {
                let flow = line.water_velocity(at);
                current[at - 1].flow = flow;
                (past, now) = (past - flow, now - flow);
            }
            let speed = now.dot(node.tangent);
            let across = now - node.tangent.scale(speed);
            let normal = normals[at] * across.dot(across).sqrt();
            let old = past.dot(node.tangent);
            let new = speed + speed - old;
            let mean = Lanes::splat(0.5) * (old.abs() * old + new.abs() * new);
            let slope = new.abs().max(old.abs());
            let tangent = tangents[at];
            node.drag = [normal, tangent * slope];
            node.drag_rest = tangent * (mean - slope * new);
        }
    }

    /// Computes the inverse masses, and the velocities that the nodes would reach without tension and seabed, in moving or still water.
    #[inline(always)]
    pub(super) fn prepare_nodes<const CURRENT: bool>(&mut self, step: Step, sizes: &Sizes) {
        self.prepare_drag::<CURRENT>(step);
        let (line, last) = (&self.layout, self.layout.striping.rows());
        let (velocities, weight) = (line.velocity.rows(last), line.weight.rows(last));
        let (nodes, drawn) = (&mut self.kernel.rows.nodes[..last], line.drag.is_some());
        let joints = line.joints.as_ref();
        for at in line.rows() {
            let node = &mut nodes[at - 1];
            let velocity = velocities[at];
            let (mut past, mut froude_krylov) = (velocity, None);
            if CURRENT && let Some(current) = &mut self.kernel.rows.current {
                let current = &mut current[at - 1];
                past = past - current.flow;
                if let Some(waves) = &line.waves {
                    current.froude_krylov = waves.froude_krylov(at, node.tangent);
                    froude_krylov = Some(current.froude_krylov);
                }
            }
            let damping = line.mass_damping.as_ref().map(|d| d.load(at));
            node.invert(drawn, damping, sizes);
            node.fall(weight[at], [velocity, past], drawn, sizes);
            node.press(froude_krylov, velocity, damping, sizes);
            if let Some(joints) = joints {
                node.push(joints.force(at), sizes);
            }
            node.loose = node.fall;
        }
    }

    #[inline(always)]
    pub(super) fn prepare_contact(&mut self, sizes: &Sizes) {
        let (line, last) = (&self.layout, self.layout.striping.rows());
        let Some(contact) = &line.contact else {
            return;
        };
        let (velocity, nodes) = (line.velocity.rows(last), &mut self.kernel.rows.nodes[..last]);
        for at in 1..last + 1 {
            let node = &mut nodes[at - 1];
            node.contact = contact.over_step(at, sizes.kick);
            node.touches = node.pushed(velocity[at].z);
            node.settle();
        }
    }

    /// Sets the velocities of prescribed ends to the secant velocities of their paths.
    #[inline(always)]
    pub(super) fn prepare_ends(&mut self, step: Step, ends: &[Vector3<f64>; 2]) {
        for end in self.prescribed_ends() {
            let at = self.layout.end_slot(end);
            let secant = (ends[end as usize] - self.layout.position.get(at)) / step.drift;
            if !self.layout.has_row(at) {
                self.layout.velocity_before.set(at, secant); // the array that holds the new velocities
                continue;
            }
            let node = &mut self.kernel.rows.nodes[at.row - 1];
            node.fall.set(at.lane, secant);
            node.loose.set(at.lane, secant);
        }
    }
}

impl NodeRow {
    /// Masses across and along the line [kg], with the implicit parts of drag, if there is any, and of mass damping [N s/m] in a step of
    /// `kick` [s].
    #[inline(always)]
    pub(super) fn effective_masses(&self, has_drag: bool, damping: Option<Lanes>, kick: Lanes) -> [Lanes; 2] {
        let half = Lanes::splat(0.5) * kick;
        let [mut across, mut along] = [self.mass_normal, self.mass_tangent];
        if has_drag {
            let [normal, tangent] = self.drag;
            across = across + (half * normal).max(kick * normal - across);
            along = along + kick * tangent;
        }
        if let Some(damping) = damping {
            (across, along) = (across + half * damping, along + half * damping);
        }
        [across, along]
    }

    /// Inverts the effective masses; nodes at prescribed ends get an inverse of zero.
    #[inline(always)]
    fn invert(&mut self, has_drag: bool, damping: Option<Lanes>, sizes: &Sizes) {
        let [across, along] = self.effective_masses(has_drag, damping, sizes.kick);
        let inverse = self.free * (across * along).recip();
        self.across = along * inverse;
        self.excess = across * inverse - self.across;
        self.held = Lanes::splat(0.0);
    }

    /// Sets the velocity after the step that follows from `velocity` [m/s] under the weight [N] and, if `drawn` is true, the drag at velocities `past`
    /// relative to the water [m/s].
    #[inline(always)]
    fn fall(&mut self, weight: Lanes, [velocity, past]: [Vectors; 2], drawn: bool, sizes: &Sizes) {
        let (across, excess) = (self.across * sizes.kick, self.excess * sizes.kick);
        let zero = Lanes::splat(0.0);
        let mut along = zero - excess * (weight * self.tangent.z); // Δt b t·f
        self.fall = velocity;
        if drawn {
            let [normal, tangent] = self.drag;
            // f = −K_n u − (d − K_n u·t) t, and f·t = −d = −K_t u·t − rest
            let speed = past.dot(self.tangent);
            let drawn = tangent * speed + self.drag_rest;
            self.fall = self.fall - past.scale(across * normal);
            along = along - (across + excess) * drawn + across * normal * speed;
        }
        self.fall = self.fall + self.tangent.scale(along);
        self.fall.z = self.fall.z - across * weight;
    }

    /// Adds the Froude-Krylov force [N], and the force of mass damping [N s/m] at `velocity` [m/s].
    #[inline(always)]
    fn press(
        &mut self,
        froude_krylov: Option<Vectors>,
        velocity: Vectors,
        damping: Option<Lanes>,
        sizes: &Sizes,
    ) {
        let mut force = froude_krylov;
        if let Some(damping) = damping {
            let taken = velocity.scale(damping);
            force = Some(force.unwrap_or(Vectors::zero()) - taken);
        }
        if let Some(force) = force {
            self.push(force, sizes);
        }
    }

    /// Adds a force [N].
    #[inline(always)]
    fn push(&mut self, force: Vectors, sizes: &Sizes) {
        let along = self.tangent.scale(self.excess * self.tangent.dot(force));
        self.fall = self.fall + (force.scale(self.across) + along).scale(sizes.kick);
    }

    /// Returns 1 where a level seabed pushes nodes that leave it at `rise` [m/s], else −1.
    #[inline(always)]
    pub(super) fn pushed(&self, rise: Lanes) -> Lanes {
        let pushes = self.contact.push(rise).where_positive(self.free); // the seabed does not act on prescribed ends
        pushes.choose(Lanes::splat(1.0), Lanes::splat(-1.0))
    }

    /// Adds a level seabed to the nodes that it pushes: a rank-one update of the inverse mass, and the impulse.
    #[inline(always)]
    pub(super) fn settle(&mut self) {
        (self.held, self.loose) = (Lanes::splat(0.0), self.fall);
        if !self.touches.any_positive() {
            return;
        }
        let (one, resistance, lift) = (Lanes::splat(1.0), self.contact.resistance, self.lift());
        let share = (one + resistance * (self.across + lift * self.tangent.z))
            .recip()
            .where_positive(self.touches);
        let impulse = self.contact.push(self.fall.z) * share;
        self.held = resistance * share;
        self.loose = self.fall + self.tangent.scale(lift * impulse);
        self.loose.z = self.loose.z + self.across * impulse;
    }
}
