//! Equilibrium of a geometrically exact beam.
//!
//! The system of [`crate::elements::beam`] is solved by Newton's method; spins are applied by the Cayley transform, and steps are shortened to a
//! fraction of a turn. Where the
//! beam starts free of stress the loads are raised in parts, the fewer the better. Elsewhere, and where that fails, the search goes down
//! in energy: J + λ D with D the nodes' own stiffness, λ lowered where the energy falls and raised where it does not, on a beam that is soft
//! in stretch and shear at first. So it ends at a minimum. Clamps begin along the beam and are turned to where they are held.

use nalgebra::{Matrix3, Rotation3};

use crate::elements::beam::{BeamCase, BeamEnd, end_hold, folded};
use crate::math::pivoted_chain::PivotedChain;
use crate::math::rotation::{cayley, turned_to};
use crate::model::{Beam, BeamElement, Model, PointState, State};
use crate::physics::section::{Section, join, split};
use crate::statics::StaticsError;

/// Change of position over the beam's length, and spin [rad], that end the search [-].
const TOLERANCE: f64 = 1e-11;
/// A step below this [-] that no longer shrinks has met rounding.
const ROUNDING: f64 = 1e-6;
/// Longest step: change of position over the beam's length, and spin [rad].
const STEP_MAX: [f64; 2] = [0.1, 0.3];
/// Solves in a part of the load [-].
const NEWTON_SOLVES_MAX: usize = 60;
/// Parts that the load is raised in: each of these is tried [-].
const LOAD_PARTS: [usize; 4] = [1, 5, 25, 125];
/// Solves of the search by falling energy, for each stiffness on the way [-].
const DESCENT_SOLVES_MAX: usize = 400;
/// Steps of that search below this [-] leave the rest to Newton's method.
const SETTLED: f64 = 1e-4;
/// Least λ [-].
const ANCHORING_MIN: f64 = 1e-12;
/// From each axial and shear stiffness to the next on the way [-].
const STIFFENING: f64 = 30.0;
/// Least axial and shear stiffness on the way, over weight, loads and EI/l² [-].
const SOFTNESS: f64 = 100.0;
/// Turn of a clamp from one equilibrium to the next on the way to where it is held [rad].
const CLAMP_TURN: f64 = 0.25;

/// Brings the beam `index` of `state` to rest under the loads of time `t` [s], from where its nodes and frames are.
///
/// # Errors
/// No equilibrium was found; the state is then as it was.
pub fn rest(model: &Model, index: usize, state: &mut State, t: f64) -> Result<(), StaticsError> {
    let line = &model.lines[index];
    let (Some(beam), Some(shape)) = (&line.beam, &state.lines[index].beam) else {
        return Ok(());
    };
    let position = &state.lines[index].position;
    let mut sections: Vec<Section> = position
        .iter()
        .zip(&shape.frames)
        .map(|(position, frame)| Section {
            position: *position,
            frame: *frame,
        })
        .collect();
    let end = |end: usize| {
        let point = &model.points[line.ends[end]];
        BeamEnd {
            load: join(point.load_at(t), point.moment_at(t)),
            ..end_hold(point, beam.clamped[end].is_some())
        }
    };
    let case = BeamCase {
        beam,
        nodes: &line.nodes,
        rest: &shape.rest,
        ends: [end(0), end(1)],
        bodies: line.ends.map(|point| model.points[point].free()),
    };
    turn_clamps_in(&case, &mut sections).map_err(|restless| refusal(&line.name, &case, restless))?;
    let line_state = &mut state.lines[index];
    for (i, section) in sections.iter().enumerate() {
        line_state.position[i] = section.position;
        if let Some(shape) = &mut line_state.beam {
            shape.frames[i] = section.frame;
        }
    }
    for (point, node) in line.ends.into_iter().zip([0, line.segment_count()]) {
        if model.points[point].free().is_some() {
            state.points[point] = PointState::at_rest(sections[node].position);
        }
    }
    Ok(())
}

/// Finds the equilibrium with the clamped ends along their neighbours, then turns them step by step to where they are held.
fn turn_clamps_in(case: &BeamCase, sections: &mut Vec<Section>) -> Result<usize, Restless> {
    let last = sections.len() - 1;
    let mut work = BeamStatics::new(last + 1);
    let held = [(0, 1), (last, last - 1)].map(|(node, next)| {
        let target = sections[node].frame;
        let along = sections[next].frame.column(2).into_owned();
        let start = match case.ends[node / last].held[3] && last > 1 {
            true => turned_to(&target, along),
            false => target,
        };
        let turn = Rotation3::from_matrix_unchecked(target * start.transpose());
        (node, start, turn.scaled_axis(), target)
    });
    let angle = held[0].2.norm().max(held[1].2.norm());
    let parts = (angle / CLAMP_TURN).ceil() as usize;
    let mut solves = 0;
    for part in 0..parts {
        for (node, start, turn, _) in &held {
            if case.ends[node / last].held[3] {
                let share = part as f64 / parts as f64;
                sections[*node].frame = Rotation3::new(share * turn).matrix() * start;
            }
        }
        // an equilibrium on the way that is not found is passed over
        solves += work.solve(case, sections).unwrap_or(0);
    }
    for (node, _, _, target) in &held {
        sections[*node].frame = *target;
    }
    Ok(solves + work.solve(case, sections)?)
}

fn refusal(line: &str, case: &BeamCase, restless: Restless) -> StaticsError {
    let line = line.to_string();
    let flies = case.ends.iter().all(|end| end.held == [false; 6]);
    match restless {
        Restless::Imbalance { residual, .. } if flies => StaticsError::BeamFlies { line, residual },
        Restless::Imbalance {
            node,
            residual,
            solves,
        } => StaticsError::BeamNotConverged {
            line,
            node,
            residual,
            iterations: solves,
        },
        Restless::Folded { node } => StaticsError::BeamFolded { line, node },
    }
}

/// Why no equilibrium was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Restless {
    /// The search ended without one.
    Imbalance {
        /// Node where the forces and moments are farthest from balance.
        node: usize,
        /// Force out of balance there, moments over the element length included [N].
        residual: f64,
        /// Linear solves spent [-].
        solves: usize,
    },
    /// It was found with an element bent or twisted beyond what two sections can tell.
    Folded {
        /// Node at the lower end of the element.
        node: usize,
    },
}

/// Axial and shear stiffness that the search begins with [N].
fn softest(case: &BeamCase) -> f64 {
    let weight: f64 = case.nodes.weight.iter().map(|w| w.abs()).sum();
    let bodies: f64 = case.bodies.iter().flatten().map(|b| b.weight_max()).sum();
    let loads = case.ends.iter().map(|end| split(&end.load).0.norm());
    let bending =
        |element: &BeamElement| element.law.bending.max(element.law.torsion) / element.length.powi(2);
    let bending = case.beam.elements.iter().map(bending).fold(0.0, f64::max);
    SOFTNESS * (weight + bodies + loads.sum::<f64>()).max(bending)
}

/// Force out of balance that the rounding of positions alone may leave [N].
fn rounding(case: &BeamCase, sections: &[Section]) -> f64 {
    let reach = sections.iter().map(|s| s.position.norm()).fold(0.0, f64::max);
    let noise =
        |element: &BeamElement| element.law.axial.max(element.law.shear) * (reach / element.length + 1.0);
    f64::EPSILON * case.beam.elements.iter().map(noise).fold(0.0, f64::max)
}

/// Scratch of the search for an equilibrium.
#[derive(Debug, Clone)]
pub struct BeamStatics {
    chain: PivotedChain,
    unit: Vec<Matrix3<f64>>,
    start: Vec<Section>,
    trial: Vec<Section>,
    solves: usize,
}

impl BeamStatics {
    /// Scratch for a beam of so many nodes.
    pub fn new(nodes: usize) -> BeamStatics {
        BeamStatics {
            chain: PivotedChain::new(nodes),
            unit: vec![Matrix3::identity(); nodes],
            start: Vec::with_capacity(nodes),
            trial: Vec::with_capacity(nodes),
            solves: 0,
        }
    }

    /// Moves `sections` to equilibrium; held unknowns stay as they are. Gives the number of linear solves.
    ///
    /// # Errors
    /// None was found; the sections are then where they were.
    pub fn solve(&mut self, case: &BeamCase, sections: &mut Vec<Section>) -> Result<usize, Restless> {
        self.start.clone_from(sections);
        self.solves = 0;
        self.assemble(case, sections, 0.0, 0.0);
        let unloaded = self.imbalance(case);
        self.assemble(case, sections, 1.0, 0.0);
        let from_rest = unloaded.1 <= 1e-9 * self.imbalance(case).1;
        let found = [from_rest, !from_rest].into_iter().any(|raise| match raise {
            true => self.raise_load(case, sections),
            false => self.settle(case, sections),
        });
        self.assemble(case, sections, 1.0, 0.0);
        let (node, residual) = self.imbalance(case);
        let restless = match (found, folded(sections)) {
            (true, None) => return Ok(self.solves),
            (true, Some(node)) => Restless::Folded { node },
            (false, _) => Restless::Imbalance {
                node,
                residual,
                solves: self.solves,
            },
        };
        sections.clone_from(&self.start);
        Err(restless)
    }

    fn raise_load(&mut self, case: &BeamCase, sections: &mut Vec<Section>) -> bool {
        LOAD_PARTS.into_iter().any(|parts| {
            sections.clone_from(&self.start);
            (1..=parts).all(|part| self.newton(case, sections, part as f64 / parts as f64))
        })
    }

    /// Newton's method at a part of the load [-].
    fn newton(&mut self, case: &BeamCase, sections: &mut [Section], load: f64) -> bool {
        let (mut last, rounding) = (f64::INFINITY, rounding(case, sections));
        for _ in 0..NEWTON_SOLVES_MAX {
            self.assemble(case, sections, load, 0.0);
            if self.imbalance(case).1 <= rounding {
                return true;
            }
            let Some(step) = self.step(case, sections) else {
                return false;
            };
            if step <= TOLERANCE || (step <= ROUNDING && step >= 0.5 * last) {
                return true;
            }
            last = step;
        }
        false
    }

    /// The search at full load by falling energy, on beams that are stiffened from soft to as they are; Newton's method ends it.
    fn settle(&mut self, case: &BeamCase, sections: &mut Vec<Section>) -> bool {
        sections.clone_from(&self.start);
        let stiffest = |element: &BeamElement| element.law.axial.max(element.law.shear);
        let full = case.beam.elements.iter().map(stiffest).fold(0.0, f64::max);
        let mut stiffness = softest(case).min(full);
        let mut soft = case.beam.clone();
        let mut anchoring = 1.0;
        loop {
            for (soft, element) in soft.elements.iter_mut().zip(&case.beam.elements) {
                soft.law.axial = element.law.axial.min(stiffness);
                soft.law.shear = element.law.shear.min(stiffness);
            }
            let softened = BeamCase { beam: &soft, ..*case };
            anchoring = self.descend(&softened, sections, anchoring);
            if stiffness >= full {
                return self.newton(case, sections, 1.0);
            }
            stiffness = (STIFFENING * stiffness).min(full);
        }
    }

    /// Goes down in energy until steps are short: J + λ D, λ lowered where the energy fell and raised where it did not. Gives the λ it ended
    /// with [-].
    fn descend(&mut self, case: &BeamCase, sections: &mut Vec<Section>, from: f64) -> f64 {
        let (mut anchoring, mut last) = (from.max(1e-6), case.energy(sections));
        for _ in 0..DESCENT_SOLVES_MAX {
            self.assemble(case, sections, 1.0, anchoring);
            self.trial.clone_from(sections);
            let step = self.step(case, sections);
            let now = case.energy(sections);
            let rounding = 1e-12 * (now.size + last.size);
            match step {
                Some(step) if now.value <= last.value + rounding => {
                    if step < SETTLED && anchoring <= ANCHORING_MIN {
                        break;
                    }
                    anchoring = (0.2 * anchoring).max(ANCHORING_MIN);
                    last = now;
                }
                _ => {
                    sections.clone_from(&self.trial);
                    anchoring *= 6.0;
                }
            }
        }
        anchoring
    }

    fn assemble(&mut self, case: &BeamCase, sections: &[Section], load: f64, anchoring: f64) {
        case.assemble(&mut self.chain, sections, load, &self.unit);
        if anchoring > 0.0 {
            self.anchor(case.beam, anchoring);
        }
        case.constrain(&mut self.chain, sections);
    }

    /// λ D: every node resists to be moved by a part of what its elements do.
    fn anchor(&mut self, beam: &Beam, anchoring: f64) {
        for (i, element) in beam.elements.iter().enumerate() {
            let (law, l) = (&element.law, element.length);
            let push = anchoring * law.axial.max(law.shear) / l;
            let turn = 0.25 * push * l * l + anchoring * law.bending.max(law.torsion) / l;
            for node in [i, i + 1] {
                for axis in 0..3 {
                    self.chain.diagonal[node][(axis, axis)] += push;
                    self.chain.diagonal[node][(axis + 3, axis + 3)] += turn;
                }
            }
        }
    }

    /// Node and size of the greatest force out of balance [N]; moments count over an element's length.
    fn imbalance(&self, case: &BeamCase) -> (usize, f64) {
        let last = case.beam.elements.len() - 1;
        let size = |i: usize| {
            let (force, moment) = split(&self.chain.right[i]);
            force.norm() + moment.norm() / case.beam.elements[i.min(last)].length
        };
        (0..self.chain.right.len())
            .map(|i| (i, size(i)))
            .fold(
                (0, 0.0),
                |worst, next| {
                    if next.1 > worst.1 { next } else { worst }
                },
            )
    }

    /// Solves and moves the sections, by no more than a step may; the size of the whole step [-].
    fn step(&mut self, case: &BeamCase, sections: &mut [Section]) -> Option<f64> {
        self.solves += 1;
        if !self.chain.solve() {
            return None;
        }
        let length: f64 = case.beam.elements.iter().map(|e| e.length).sum();
        let (mut moved, mut turned) = (0.0_f64, 0.0_f64);
        for change in &self.chain.right {
            let (position, spin) = split(change);
            moved = moved.max(position.norm() / length);
            turned = turned.max(spin.norm());
        }
        let [moved_max, turned_max] = STEP_MAX;
        let part = (moved_max / moved).min(turned_max / turned).min(1.0);
        for (section, change) in sections.iter_mut().zip(&self.chain.right) {
            let (position, spin) = split(change);
            section.position += part * position;
            section.frame = cayley(part * spin) * section.frame;
        }
        Some(moved.max(turned))
    }
}

#[cfg(test)]
mod tests;
