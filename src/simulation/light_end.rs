//! The end whose tension is most sensitive to errors of a host's motion, and its impedance at the frequency of the communication points.
//!
//! The acceleration of the path jumps at communication points and changes linearly between them. Its velocity errors are periodic with the communication step
//! h, with amplitudes as 1/k² at the frequencies 2πk/h. With the impedance Z(ω) of the line and that of a long line, Z₀ = √(EA m_t), the
//! tension error is amplified by
//!
//! √(Σ |Z(2πk/h)/Z₀|²/k⁴ / Σ 1/k⁴),   k = 1 … 4,
//!
//! which is about 1 between the axial modes of the line and 10 or more at one of them ([`crate::physics::axial_wave`]). The line has its shape at rest. Its modes
//! shift by some per cent as it moves, and drag damps them: both are represented by a loss factor of the stiffness, which gives the modes a width. At a free
//! point the other lines carry waves away as long lines would.

use std::f64::consts::TAU;

use nalgebra::{Complex, Vector3};

use super::paths::Paths;
use crate::dynamics::reaction;
use crate::model::{End, Line, Model, Role, State};
use crate::physics::axial_wave::{self, TensionRow};
use crate::physics::slender::Slender;
use crate::scene::Integrator;

/// Loss factor of the stiffness [-].
const LOSS: f64 = 0.05;
/// Multiples of the frequency of the communication points that count [-].
const HARMONICS: i32 = 4;
/// Trailing bits of a communication step that its amplification does not depend on: steps within 1.6 % of each other share one.
const BITS: u32 = f64::MANTISSA_DIGITS - 1 - 6;

/// End with the greatest ratio of impedance to tension at rest among the ends that a host moves.
#[derive(Debug, Clone)]
pub(super) struct LightEnd {
    line: usize,
    end: End,
    /// Impedance of axial waves, √(EA m_t) [N s/m].
    pub impedance: f64,
    mover: Mover,
    /// Equations of the tensions, from the other end to this one.
    rows: Vec<TensionRow>,
    /// Mass of the half node [kg].
    mass: f64,
    /// Mass [kg] and impedance of other lines [N s/m] at the other end, if it is a free point.
    beyond: Option<[f64; 2]>,
    /// Leading bits of the latest communication step, and its amplification [-].
    latest: (u64, f64),
}

/// Source of the motion of a line end.
#[derive(Debug, Clone, Copy)]
enum Mover {
    /// Coupled point, by its index among the coupled points.
    Point(usize),
    /// Vessel by its index, with the distance of the end from its origin [m].
    Vessel(usize, f64),
}

impl LightEnd {
    /// Returns the light end of a model at rest; `None` if a host moves no line with axial waves.
    pub(super) fn new(model: &Model, at_rest: &State) -> Option<LightEnd> {
        if model.solver.integrator == Integrator::QuasiStatic {
            return None;
        }
        let (mut coupled, mut ends) = (0, Vec::new());
        for point in &model.points {
            let mover = match &point.role {
                Role::Coupled { .. } => Mover::Point(coupled),
                Role::Carried { vessel, arm } => Mover::Vessel(*vessel, arm.norm()),
                _ => continue,
            };
            coupled += usize::from(matches!(mover, Mover::Point(_)));
            let attached = point.attached.iter();
            let attached = attached.filter(|(line, _)| model.lines[*line].beam.is_none());
            ends.extend(attached.map(|&(line, end)| (line, end, mover)));
        }
        let ratio = |&(line, end, _): &(usize, End, Mover)| {
            impedance(&model.lines[line], end) / tension(model, at_rest, line, end).max(f64::MIN_POSITIVE)
        };
        let (line, end, mover) = ends.into_iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)))?;
        let (rows, mass) = rows(model, at_rest, line, end);
        Some(LightEnd {
            line,
            end,
            impedance: impedance(&model.lines[line], end),
            mover,
            rows,
            mass,
            beyond: beyond(model, line, end),
            latest: (0, 1.0),
        })
    }

    /// Tension of its segment [N].
    pub(super) fn tension(&self, model: &Model, state: &State) -> f64 {
        tension(model, state, self.line, self.end)
    }

    /// Jump of its acceleration between two paths [m/s²].
    pub(super) fn jump(&self, [before, after]: [&Paths; 2]) -> f64 {
        match self.mover {
            Mover::Point(index) => before.points[index].0.jump(&after.points[index].0),
            Mover::Vessel(index, lever) => {
                let [before, after] = [before, after].map(|paths| &paths.vessels[index].0);
                let [place, turn] = [0, 1].map(|part| before[part].jump(&after[part]));
                place.hypot(lever * turn)
            }
        }
    }

    /// Amplification of the tension error by the axial modes of the line with communication steps of a length [s], at least 1 [-].
    pub(super) fn amplification(&mut self, step: f64) -> f64 {
        let leading = step.to_bits() >> BITS;
        if self.latest.0 != leading {
            let middle = f64::from_bits((2 * leading + 1) << (BITS - 1));
            self.latest = (leading, self.amplification_at(TAU / middle));
        }
        self.latest.1
    }

    /// The same at a circular frequency of the communication points [rad/s].
    fn amplification_at(&self, frequency: f64) -> f64 {
        let mut sums = [0.0; 2];
        for k in (1..=HARMONICS).map(f64::from) {
            let weight = k.powi(-4);
            sums[0] += weight * self.relative_impedance(k * frequency).powi(2);
            sums[1] += weight;
        }
        (sums[0] / sums[1]).sqrt().max(1.0)
    }

    /// |Z/Z₀| at a circular frequency [rad/s].
    fn relative_impedance(&self, frequency: f64) -> f64 {
        let Some((first, others)) = self.rows.split_first() else {
            return 1.0;
        };
        let mut diagonal = first.eliminated(None, frequency, LOSS);
        if let Some([mass, impedance]) = self.beyond {
            diagonal += Complex::new(mass, -impedance / frequency).inv();
        }
        for row in others {
            diagonal = row.eliminated(Some(diagonal), frequency, LOSS);
        }
        axial_wave::impedance(diagonal, self.mass, frequency) / self.impedance
    }
}

/// Node at the end of a line, and the segment there.
fn at(line: &Line, end: End) -> (usize, usize) {
    let node = line.end_node(end);
    (node, node.min(line.segment_count() - 1))
}

fn tension(model: &Model, state: &State, index: usize, end: End) -> f64 {
    let (line, state) = (&model.lines[index], &state.lines[index]);
    reaction::tension(line, state, at(line, end).1, model.solver.negative_tension)
}

/// Impedance of axial waves at the end of a line, √(EA m_t) [N s/m].
fn impedance(line: &Line, end: End) -> f64 {
    let (node, segment) = at(line, end);
    let mass = line.nodes.mass_tangent[node] / line.nodes.length[node]; // m_t [kg/m]
    (line.segments.in_motion(segment).0 * mass).sqrt()
}

/// Equations of the tensions of a line at rest, from the other end to this one, and the mass of the half node at this end along the line [kg].
fn rows(model: &Model, at_rest: &State, index: usize, end: End) -> (Vec<TensionRow>, f64) {
    let (line, position) = (&model.lines[index], &at_rest.lines[index].position);
    let (count, nodes) = (line.segment_count(), &line.nodes);
    let numbered = |i: usize| match end {
        End::B => i,
        End::A => count - i,
    };
    let tangents: Vec<Vector3<f64>> = (0..count)
        .map(|i| position[numbered(i + 1)] - position[numbered(i)])
        .map(|chord| chord.try_normalize(0.0).unwrap_or_default())
        .collect();
    let inverse = |i: usize, along: [Vector3<f64>; 2]| {
        let tangent = (tangents[i - 1] + tangents[i]).try_normalize(0.0);
        let node = numbered(i);
        let inverse = Slender::inverse([nodes.mass_normal[node], nodes.mass_tangent[node]]);
        inverse
            .times(along[0], tangent.unwrap_or(tangents[i]))
            .dot(&along[1])
    };
    let row = |i: usize| {
        let (own, segment) = (tangents[i], numbered(i).min(numbered(i + 1)));
        let inner = [i, i + 1].into_iter().filter(|node| (1..count).contains(node));
        let (stiffness, damping) = line.segments.in_motion(segment);
        TensionRow {
            inverse_masses: inner.map(|node| inverse(node, [own, own])).sum(),
            coupling: if i == 0 {
                0.0
            } else {
                inverse(i, [tangents[i - 1], own])
            },
            stiffness: stiffness / line.segments.length[segment],
            damping: damping / line.segments.length[segment],
        }
    };
    ((0..count).map(row).collect(), nodes.mass_tangent[numbered(count)])
}

/// Mass [kg], with that of the half node there, and impedance of other lines [N s/m] at the other end of a line, if it is a free point.
fn beyond(model: &Model, index: usize, end: End) -> Option<[f64; 2]> {
    let line = &model.lines[index];
    let (other, node) = match end {
        End::A => (line.ends[1], line.segment_count()),
        End::B => (line.ends[0], 0),
    };
    let point = &model.points[other];
    let attached = point.attached.iter().filter(|(other, _)| *other != index);
    let impedances = attached.map(|&(line, end)| impedance(&model.lines[line], end));
    Some([
        point.free()?.mass + line.nodes.mass_tangent[node],
        impedances.sum(),
    ])
}
