//! Equilibrium of a geometrically exact beam.
//!
//! The system of [`crate::elements::beam`] is solved by Newton's method; spins are applied by the Cayley transform, and steps are limited to a
//! fraction of a turn. A beam with many elements starts from the equilibrium of the same beam with half as many (`coarse`). Only the coarsest mesh
//! then starts far from equilibrium, and where there are several equilibria, fine meshes follow the coarse ones.
//!
//! The search on the coarsest mesh, and on a mesh for which the coarser one fails, starts from the present sections. If these are free of stress, the
//! loads are raised in as few parts as possible. Otherwise, or if that fails, the energy is reduced without the end moments, which have no potential.
//! Its steps use J + λ D, with D the stiffness of the nodes by themselves; λ is lowered when the energy falls and raised when it does not, and the
//! beam is soft in stretch and shear at first. This search ends at a minimum, from which the moments are raised in parts. Clamps begin along the beam
//! and are turned to their prescribed attitudes. If all this fails and an end can move, the search starts from the unstressed beam.

mod coarse;

use nalgebra::{Rotation3, Vector3};

use crate::elements::beam::{BeamCase, BeamEnd, ElementSpring, FourElements, LoadShare, end_hold, folded};
use crate::math::pivoted_chain::PivotedChain;
use crate::math::rotation::{cayley, turned_to};
use crate::model::{BeamElement, Model, PointState, State};
use crate::physics::section::{Section, join, split};
use crate::statics::StaticsError;

/// Convergence tolerance of a step [-]: change of position relative to the beam length, and spin [rad].
const TOLERANCE: f64 = 1e-11;
/// Step [-] below which a step that no longer shrinks counts as rounding.
const ROUNDING: f64 = 1e-6;
/// Maximum step: change of position relative to the beam length, and spin [rad].
const STEP_MAX: [f64; 2] = [0.1, 0.3];
/// Maximum number of solves for one part of the load [-].
const NEWTON_SOLVES_MAX: usize = 60;
/// Numbers of parts in which the load is raised, tried in turn [-].
const LOAD_PARTS: [usize; 4] = [1, 5, 25, 125];
/// Maximum number of solves of the energy descent for each intermediate stiffness [-].
const DESCENT_SOLVES_MAX: usize = 400;
/// Step of the energy descent [-] below which Newton's method takes over.
const SETTLED: f64 = 1e-4;
/// Minimum λ [-].
const ANCHORING_MIN: f64 = 1e-12;
/// Ratio of successive intermediate axial and shear stiffnesses [-].
const STIFFENING: f64 = 30.0;
/// Minimum intermediate axial and shear stiffness, relative to weight, loads and EI/l² [-].
const SOFTNESS: f64 = 100.0;
/// Maximum number of elements of a beam whose search does not start from a coarser one [-].
const COARSE_ELEMENTS_MAX: usize = 12;
/// Maximum number of linear solves times nodes in a search [-], about five seconds.
const WORK_MAX: usize = 4_000_000;
/// No weight, no forces and no moments.
const UNLOADED: LoadShare = LoadShare {
    force: 0.0,
    moment: 0.0,
};
/// Weight and forces without the moments on the ends.
const MOMENT_FREE: LoadShare = LoadShare {
    force: 1.0,
    moment: 0.0,
};
/// Axial part of a moment that counts as rounding [-].
const TORQUE_MIN: f64 = 1e-6;
/// Turn of a clamp between successive equilibria on the way to its prescribed attitude [rad].
const CLAMP_TURN: f64 = 0.25;

/// Brings the beam `index` of `state` to rest under the loads of time `t` [s], from its present nodes and frames.
///
/// # Errors
/// Fails if no equilibrium is found; the state is then unchanged.
pub fn rest(model: &Model, index: usize, state: &mut State, t: f64) -> Result<(), StaticsError> {
    let line = &model.lines[index];
    let (Some(beam), Some(shape)) = (&line.beam, &state.lines[index].beam) else {
        return Ok(());
    };
    let position = &state.lines[index].position;
    let sections: Vec<Section> = position
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
    let springs = line.nodes.contact.iter().flat_map(|contact| {
        let springs = contact.stiffness.iter().zip(contact.level.windows(2));
        springs.map(|(&stiffness, levels)| ElementSpring {
            levels: [levels[0], levels[1]],
            stiffness,
        })
    });
    let case = BeamCase {
        elements: beam.elements.clone(),
        rest: shape.rest.clone(),
        weight: line.nodes.weight.clone(),
        seabed: springs.collect(),
        ends: [end(0), end(1)],
        bodies: line.ends.map(|point| model.points[point].free()),
    };
    let found = BeamStatics::of(&line.name).solve_from_coarser(&case, &sections);
    let sections = found.map_err(|error| match BeamStatics::torque(&case, &sections) {
        Some(torque) => StaticsError::BeamSpins {
            line: line.name.clone(),
            torque,
        },
        None => error,
    })?;
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

/// Initial axial and shear stiffness of the search [N].
fn softest(case: &BeamCase) -> f64 {
    let weight: f64 = case.weight.iter().map(|w| w.abs()).sum();
    let bodies: f64 = case.bodies.iter().flatten().map(|b| b.weight_max()).sum();
    let loads = case.ends.iter().map(|end| split(&end.load).0.norm());
    let bending =
        |element: &BeamElement| element.law.bending.max(element.law.torsion) / element.length.powi(2);
    let bending = case.elements.iter().map(bending).fold(0.0, f64::max);
    SOFTNESS * (weight + bodies + loads.sum::<f64>()).max(bending)
}

/// Out-of-balance force that the rounding of positions alone may leave [N].
fn rounding(case: &BeamCase, sections: &[Section]) -> f64 {
    let reach = sections.iter().map(|s| s.position.norm()).fold(0.0, f64::max);
    let noise =
        |element: &BeamElement| element.law.axial.max(element.law.shear) * (reach / element.length + 1.0);
    f64::EPSILON * case.elements.iter().map(noise).fold(0.0, f64::max)
}

/// Sections of the unstressed beam, laid out from end A if end B can move, else from end B if end A can; `None` if both ends are fixed in place. The
/// end that can move keeps its prescribed unknowns.
fn unstressed(case: &BeamCase, start: &[Section]) -> Option<Vec<Section>> {
    let last = start.len() - 1;
    let end = [1, 0]
        .into_iter()
        .find(|&end| case.ends[end].held[..3].contains(&false))?;
    let mut sections = start.to_vec();
    for k in 0..last {
        let (from, to, sign) = match end {
            1 => (k, k + 1, 1.0),
            _ => (last - k, last - k - 1, -1.0),
        };
        let length = sign * case.elements[from.min(to)].length;
        let (stretch, turn) = split(&case.rest[from.min(to)]);
        let frame = sections[from].frame * cayley(length * turn);
        let position = sections[from].position + 0.5 * length * (sections[from].frame + frame) * stretch;
        sections[to] = Section { position, frame };
    }
    let (node, held) = (end * last, case.ends[end].held);
    for axis in (0..3).filter(|&axis| held[axis]) {
        sections[node].position[axis] = start[node].position[axis];
    }
    if held[3] {
        sections[node].frame = start[node].frame;
    }
    Some(sections)
}

/// Search for an equilibrium: its workspace and the effort so far.
#[derive(Debug, Clone, Default)]
struct BeamStatics {
    line: String,
    chain: PivotedChain,
    four: Vec<FourElements>,
    trial: Vec<Section>,
    /// Linear solves [-].
    solves: usize,
    /// Linear solves times their nodes [-].
    work: usize,
}

impl BeamStatics {
    fn of(line: &str) -> BeamStatics {
        BeamStatics {
            line: line.to_string(),
            ..BeamStatics::default()
        }
    }

    /// Returns the sections in equilibrium, found from the equilibrium with half as many elements, else from the sections `start`.
    fn solve_from_coarser(
        &mut self,
        case: &BeamCase,
        start: &[Section],
    ) -> Result<Vec<Section>, StaticsError> {
        let elements = case.elements.len();
        if elements > COARSE_ELEMENTS_MAX {
            let kept = coarse::kept(elements).into_iter().map(|node| start[node]);
            let found = self.solve_from_coarser(&coarse::coarser(case), &kept.collect::<Vec<_>>());
            let mut sections = found.map_or(vec![], |found| coarse::finer(&found, &case.elements));
            if !sections.is_empty() && self.search(case, &mut sections, Self::newton_or_settle).is_ok() {
                return Ok(sections);
            }
        }
        let mut sections = start.to_vec();
        self.turn_clamps_in(case, &mut sections)?;
        Ok(sections)
    }

    /// Axial part of the end moments [N m], along the beam at rest without them, if no end is clamped and it exceeds rounding. It cannot be balanced:
    /// the torsion of a beam of round section is constant along it, and zero at ends that turn freely.
    fn torque(case: &BeamCase, start: &[Section]) -> Option<f64> {
        let moments = case.ends.each_ref().map(|end| split(&end.load).1);
        let greatest = moments[0].norm().max(moments[1].norm());
        if case.ends.iter().any(|end| end.held[3]) || greatest == 0.0 {
            return None;
        }
        let across = BeamCase {
            ends: case.ends.each_ref().map(|end| BeamEnd {
                load: join(split(&end.load).0, Vector3::zeros()),
                ..*end
            }),
            ..case.clone()
        };
        let sections = BeamStatics::default().solve_from_coarser(&across, start).ok()?;
        let last = sections.len() - 1;
        let along = [(0, 1), (last - 1, last)].map(|(from, to)| {
            let (from, to): (&Section, &Section) = (&sections[from], &sections[to]);
            (to.position - from.position).normalize()
        });
        let torque = (moments[0].dot(&along[0]) + moments[1].dot(&along[1])).abs();
        (torque > TORQUE_MIN * greatest).then_some(torque)
    }

    /// Finds the equilibrium with the clamps aligned with their neighbours, then turns them step by step to their prescribed attitudes.
    fn turn_clamps_in(&mut self, case: &BeamCase, sections: &mut [Section]) -> Result<(), StaticsError> {
        let last = sections.len() - 1;
        let clamps = [(0, 1), (last, last - 1)].map(|(node, next)| {
            let target = sections[node].frame;
            let along = sections[next].frame.column(2).into_owned();
            let start = match case.ends[node / last].held[3] && last > 1 {
                true => turned_to(&target, along),
                false => target,
            };
            let turn = Rotation3::from_matrix_unchecked(target * start.transpose());
            (node, start, turn.scaled_axis(), target)
        });
        let angle = clamps[0].2.norm().max(clamps[1].2.norm());
        let parts = (angle / CLAMP_TURN).ceil() as usize;
        for part in 0..parts {
            for (node, start, turn, _) in &clamps {
                if case.ends[node / last].held[3] {
                    let share = part as f64 / parts as f64;
                    sections[*node].frame = Rotation3::new(share * turn).matrix() * start;
                }
            }
            // an intermediate equilibrium that is not found is skipped
            let _ = self.solve(case, sections);
        }
        for (node, _, _, target) in &clamps {
            sections[*node].frame = *target;
        }
        self.solve(case, sections)
    }

    /// Moves `sections` to equilibrium; prescribed unknowns stay as they are.
    ///
    /// # Errors
    /// Fails if no equilibrium is found; the sections are then unchanged.
    fn solve(&mut self, case: &BeamCase, sections: &mut [Section]) -> Result<(), StaticsError> {
        self.search(case, sections, |search, case, sections| {
            let start = sections.to_vec();
            search.assemble(case, sections, UNLOADED, 0.0);
            let unloaded = search.imbalance(case).1;
            search.assemble(case, sections, LoadShare::WHOLE, 0.0);
            let from_rest = unloaded <= 1e-9 * search.imbalance(case).1;
            let all = |part| LoadShare {
                force: part,
                moment: part,
            };
            let mut bent = None;
            let mut found = |start: &[Section], raise_first: bool| {
                [raise_first, !raise_first].into_iter().any(|raise| {
                    let rests = match raise {
                        true => search.raise(case, sections, start, all),
                        false => search.settle(case, sections, start),
                    };
                    if rests && folded(sections).is_some() {
                        bent = Some(sections.to_vec());
                    }
                    rests && folded(sections).is_none()
                })
            };
            let found = found(&start, from_rest)
                || unstressed(case, &start).is_some_and(|unstressed| found(&unstressed, true));
            if let Some(bent) = bent.filter(|_| !found) {
                sections.copy_from_slice(&bent);
                return true;
            }
            found
        })
    }

    /// Moves `sections` by a method that returns whether it found the equilibrium, and checks the result.
    fn search(
        &mut self,
        case: &BeamCase,
        sections: &mut [Section],
        method: impl Fn(&mut Self, &BeamCase, &mut [Section]) -> bool,
    ) -> Result<(), StaticsError> {
        if self.chain.right.len() != sections.len() {
            self.chain = PivotedChain::new(sections.len());
        }
        let start = sections.to_vec();
        let found = method(self, case, sections);
        self.assemble(case, sections, LoadShare::WHOLE, 0.0);
        let (node, residual) = self.imbalance(case);
        let (line, flies) = (
            self.line.clone(),
            case.ends.iter().all(|end| end.held == [false; 6]),
        );
        let error = match (found, folded(sections)) {
            (true, None) => return Ok(()),
            (true, Some(node)) => StaticsError::BeamFolded { line, node },
            _ if flies => StaticsError::BeamFlies { line, residual },
            _ => StaticsError::BeamNotConverged {
                line,
                node,
                residual,
                iterations: self.solves,
            },
        };
        sections.copy_from_slice(&start);
        Err(error)
    }

    /// Searches from close to the equilibrium by Newton's method, else by energy descent.
    fn newton_or_settle(&mut self, case: &BeamCase, sections: &mut [Section]) -> bool {
        let start = sections.to_vec();
        self.newton(case, sections, LoadShare::WHOLE) || self.settle(case, sections, &start)
    }

    /// Raises the loads in parts from `start`; returns whether the whole load was reached.
    fn raise(
        &mut self,
        case: &BeamCase,
        sections: &mut [Section],
        start: &[Section],
        share: impl Fn(f64) -> LoadShare,
    ) -> bool {
        LOAD_PARTS.into_iter().any(|parts| {
            sections.copy_from_slice(start);
            (1..=parts).all(|part| self.newton(case, sections, share(part as f64 / parts as f64)))
        })
    }

    /// Newton's method under a part of the loads; returns whether it converged.
    fn newton(&mut self, case: &BeamCase, sections: &mut [Section], share: LoadShare) -> bool {
        let (mut last, rounding) = (f64::INFINITY, rounding(case, sections));
        for _ in 0..NEWTON_SOLVES_MAX {
            self.assemble(case, sections, share, 0.0);
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

    /// Searches from `start` by energy descent, on beams stiffened from soft to the actual stiffness. Newton's method completes the search and raises
    /// the moments.
    fn settle(&mut self, case: &BeamCase, sections: &mut [Section], start: &[Section]) -> bool {
        sections.copy_from_slice(start);
        let stiffest = |element: &BeamElement| element.law.axial.max(element.law.shear);
        let full = case.elements.iter().map(stiffest).fold(0.0, f64::max);
        let mut stiffness = softest(case).min(full);
        let mut soft = case.clone();
        let mut anchoring = 1.0;
        loop {
            for (soft, element) in soft.elements.iter_mut().zip(&case.elements) {
                soft.law.axial = element.law.axial.min(stiffness);
                soft.law.shear = element.law.shear.min(stiffness);
            }
            anchoring = self.descend(&soft, sections, anchoring);
            if stiffness >= full {
                break;
            }
            stiffness = (STIFFENING * stiffness).min(full);
        }
        let turned = |part| LoadShare {
            force: 1.0,
            moment: part,
        };
        let found = self.newton(case, sections, turned(0.0));
        let without_moments = sections.to_vec();
        found && self.raise(case, sections, &without_moments, turned)
    }

    /// Reduces the energy until steps are short, by J + λ D with λ lowered when the energy falls and raised when it does not. Returns the last λ [-].
    fn descend(&mut self, case: &BeamCase, sections: &mut [Section], from: f64) -> f64 {
        let (mut anchoring, mut last) = (from.max(1e-6), case.energy(sections));
        for _ in 0..DESCENT_SOLVES_MAX {
            if self.work > WORK_MAX {
                break;
            }
            self.assemble(case, sections, MOMENT_FREE, anchoring);
            self.trial.clear();
            self.trial.extend_from_slice(sections);
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
                    sections.copy_from_slice(&self.trial);
                    anchoring *= 6.0;
                }
            }
        }
        anchoring
    }

    fn assemble(&mut self, case: &BeamCase, sections: &[Section], share: LoadShare, anchoring: f64) {
        case.assemble(&mut self.chain, sections, share, &mut self.four);
        if anchoring > 0.0 {
            self.anchor(case, anchoring);
        }
        case.constrain(&mut self.chain, sections);
    }

    /// Adds λ D, a fraction of the stiffness of the elements, to the diagonal of every node.
    fn anchor(&mut self, case: &BeamCase, anchoring: f64) {
        for (i, element) in case.elements.iter().enumerate() {
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

    /// Node and magnitude of the largest out-of-balance force [N]; moments are divided by the element length.
    fn imbalance(&self, case: &BeamCase) -> (usize, f64) {
        let last = case.elements.len() - 1;
        let size = |i: usize| {
            let (force, moment) = split(&self.chain.right[i]);
            force.norm() + moment.norm() / case.elements[i.min(last)].length
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

    /// Solves for a step and moves the sections by at most STEP_MAX; returns the size of the whole step [-].
    fn step(&mut self, case: &BeamCase, sections: &mut [Section]) -> Option<f64> {
        self.solves += 1;
        self.work += sections.len();
        if self.work > WORK_MAX || !self.chain.solve_refined() {
            return None;
        }
        let length: f64 = case.elements.iter().map(|e| e.length).sum();
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
