//! Line ends that a host moves, and their impedance at the communication frequency.
//!
//! The acceleration of the path jumps at communication points and changes linearly between them. Its velocity errors are periodic with the
//! communication step h; at the frequencies 2πk/h their amplitudes are proportional to 1/k². With the impedance Z(ω) of the line and that of a long
//! line, Z₀ = √(EA m_t), the tension error is amplified by
//!
//! √(Σ |Z(2πk/h)/Z₀|²/k⁴ / Σ 1/k⁴),   k = 1 … 4,
//!
//! which is about 1 between the axial modes of the line and 10 or more at one of them ([`crate::physics::axial_wave`]). The line is taken in its
//! shape at rest. Its modes shift by some per cent as it moves, and drag damps them: a loss factor of the stiffness represents both effects and gives
//! the modes a width. At a free point, the other lines are taken as long lines, which carry the waves away.

use std::f64::consts::TAU;

use nalgebra::{Complex, Vector3};

use super::paths::Paths;
use crate::dynamics::reaction;
use crate::model::{End, Line, Model, Point, Role, State};
use crate::physics::axial_wave::{self, TensionRow};
use crate::physics::slender::Slender;
use crate::scene::Integrator;

/// Loss factor of the stiffness [-].
const LOSS: f64 = 0.05;
/// Number of harmonics of the communication frequency that are included [-].
const HARMONICS: i32 = 4;
/// Number of trailing bits of a communication step that are ignored: steps within 1.6 % of each other share an amplification.
const BITS: u32 = f64::MANTISSA_DIGITS - 1 - 6;

/// Line with one end or both ends moved by a host.
#[derive(Debug, Clone)]
pub(super) struct MovedLine {
    line: usize,
    /// Moved ends, end B first.
    ends: Vec<MovedEnd>,
}

/// Line end moved by a host.
#[derive(Debug, Clone)]
struct MovedEnd {
    end: End,
    mover: Mover,
    /// Impedance of axial waves, √(EA m_t) [N s/m].
    impedance: f64,
    /// Tension equations, from the other end to this one.
    rows: Vec<TensionRow>,
    /// Mass of the half segment [kg].
    mass: f64,
    /// Mass [kg] of the other end and impedance of the other lines there [N s/m], if it is a free point.
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

impl MovedLine {
    /// Returns the lines with axial waves that a host moves, from a model and its state at rest.
    pub(super) fn all(model: &Model, at_rest: &State) -> Vec<MovedLine> {
        if model.solver.integrator == Integrator::QuasiStatic {
            return Vec::new();
        }
        let movers = movers(model);
        let lines = model.lines.iter().enumerate();
        let lines = lines.filter(|(_, line)| line.beam.is_none());
        let lines = lines.map(|(line, data)| MovedLine {
            line,
            ends: [End::B, End::A]
                .into_iter()
                .filter_map(|end| {
                    let mover = movers[data.ends[end as usize]]?;
                    Some(MovedEnd::new(model, at_rest, (line, end), mover))
                })
                .collect(),
        });
        lines.filter(|line| !line.ends.is_empty()).collect()
    }

    /// Tension of the segment at the first moved end [N].
    pub(super) fn tension(&self, model: &Model, state: &State) -> f64 {
        let (line, state) = (&model.lines[self.line], &state.lines[self.line]);
        let segment = at(line, self.ends[0].end).1;
        reaction::tension(line, state, segment, model.solver.negative_tension)
    }

    /// Excitation of axial waves at the moved ends, Σ A Z |J| between two paths [N/s], for a communication step of a given length [s].
    pub(super) fn excitation(&mut self, paths: [&Paths; 2], step: f64) -> f64 {
        let ends = self.ends.iter_mut();
        ends.map(|end| end.impedance * end.mover.jump(paths) * end.amplification(step))
            .sum()
    }
}

/// Returns the source of motion of every point; `None` if no host moves it.
fn movers(model: &Model) -> Vec<Option<Mover>> {
    let mut coupled = 0..;
    let mover = |point: &Point| match &point.role {
        Role::Coupled { .. } => coupled.next().map(Mover::Point),
        Role::Carried { vessel, arm } => Some(Mover::Vessel(*vessel, arm.norm())),
        _ => None,
    };
    model.points.iter().map(mover).collect()
}

impl Mover {
    /// Jump of the acceleration between two paths [m/s²].
    fn jump(self, [before, after]: [&Paths; 2]) -> f64 {
        match self {
            Mover::Point(index) => before.points[index].0.jump(&after.points[index].0),
            Mover::Vessel(index, lever) => {
                let [before, after] = [before, after].map(|paths| &paths.vessels[index].0);
                let [place, turn] = [0, 1].map(|part| before[part].jump(&after[part]));
                place.hypot(lever * turn)
            }
        }
    }
}

impl MovedEnd {
    fn new(model: &Model, at_rest: &State, (line, end): (usize, End), mover: Mover) -> MovedEnd {
        let (rows, mass) = rows(model, at_rest, line, end);
        MovedEnd {
            end,
            mover,
            impedance: impedance(&model.lines[line], end),
            rows,
            mass,
            beyond: beyond(model, line, end),
            latest: (0, 1.0),
        }
    }

    /// Amplification of the tension error by the axial modes of the line for a communication step [s], at least 1 [-].
    fn amplification(&mut self, step: f64) -> f64 {
        let leading = step.to_bits() >> BITS;
        if self.latest.0 != leading {
            let middle = f64::from_bits((2 * leading + 1) << (BITS - 1));
            self.latest = (leading, self.amplification_at(TAU / middle));
        }
        self.latest.1
    }

    /// Amplification of the tension error at a communication frequency [rad/s], at least 1 [-].
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

/// Node and segment at an end of a line.
fn at(line: &Line, end: End) -> (usize, usize) {
    let node = line.end_node(end);
    (node, node.min(line.segment_count() - 1))
}

/// Impedance of axial waves at the end of a line, √(EA m_t) [N s/m].
fn impedance(line: &Line, end: End) -> f64 {
    let (node, segment) = at(line, end);
    let mass = line.nodes.mass_tangent[node] / line.nodes.length[node]; // m_t [kg/m]
    (line.segments.in_motion(segment).0 * mass).sqrt()
}

/// Tension equations of a line at rest, from the other end to this one, and the tangential mass of the half segment at this end [kg].
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

/// Mass at the other end of a line, including the half segment there [kg], and impedance of the other lines [N s/m], if that end is a free point.
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
