//! A network advanced by a leapfrog: its lines, and the free points that join them.

use nalgebra::Vector3;

use super::ENDS;
use super::joints::Clamp;
use super::point;
use super::step::Step;
use super::{EndMotion, Kernel, LeapfrogLine};
use crate::dynamics::energy_balance::Flow;
use crate::dynamics::motion::AxisPath;
use crate::model::{End, Kinematics, Model, Network, PointState, Role, State, WaveSpan};

/// Workspace of a network: its lines in striped layout, and its free points.
#[derive(Debug, Clone)]
pub struct LeapfrogNetwork<K: Kernel> {
    /// Lines, in the order of the network.
    pub(super) lines: Vec<LeapfrogLine<K>>,
    /// Indices of the lines in the model.
    line_numbers: Vec<usize>,
    ends: Vec<[LineEnd; 2]>,
    /// Free points, in the order of the network.
    pub(super) points: Vec<PointState>,
    /// Indices of the free points in the model.
    pub(super) point_numbers: Vec<usize>,
    /// Lines, by index in the network, and their ends at each free point.
    pub(super) attached: Vec<Vec<(usize, End)>>,
    /// Wave kinematics at the free points; empty without waves.
    pub(super) waves: Vec<WaveSpan>,
    pub(super) scratch: K::Points,
    /// Energy flow of the free points since the state was loaded [J].
    pub(super) point_flow: Flow,
}

#[derive(Debug, Clone, Copy)]
struct LineEnd {
    tie: Tie,
    motion: EndMotion,
}

/// Point to which an end of a line is tied.
#[derive(Debug, Clone, Copy)]
enum Tie {
    /// A point that never moves.
    Fixed,
    /// A point with prescribed motion, by index in the model.
    Prescribed(usize),
    /// A free point, by index in the network.
    Free(usize),
}

impl LineEnd {
    fn new(model: &Model, network: &Network, point: usize) -> LineEnd {
        let free = network.free_points.iter().position(|&free| free == point);
        let tie = match (free, &model.points[point].role) {
            (Some(free), _) => Tie::Free(free),
            (None, Role::Fixed) => Tie::Fixed,
            (None, _) => Tie::Prescribed(point),
        };
        let motion = EndMotion {
            position: model.points[point].reference,
            velocity: Vector3::zeros(),
        };
        LineEnd { tie, motion }
    }

    /// Sets the motion to the position of the point at `t` [s] and its velocity half a step of `length` [s] earlier.
    #[inline]
    fn find(&mut self, points: &[PointState], t: f64, length: f64, held: &impl Fn(usize, f64) -> Kinematics) {
        self.motion = match self.tie {
            Tie::Fixed => return,
            Tie::Prescribed(point) => {
                let k = held(point, t);
                EndMotion {
                    position: k.position,
                    velocity: k.velocity - 0.5 * length * k.acceleration,
                }
            }
            Tie::Free(free) => EndMotion {
                position: points[free].position,
                velocity: points[free].half_step[0],
            },
        };
    }
}

impl<K: Kernel> LeapfrogNetwork<K> {
    /// Allocates the workspace of a network; `None` if a line mixes strain measures.
    pub fn new(model: &Model, network: &Network) -> Option<LeapfrogNetwork<K>> {
        let ends_of = |line: usize| model.lines[line].ends;
        let line = |&line: &usize| {
            let tied = ends_of(line).map(|point| model.points[point].free().is_none());
            LeapfrogLine::new(model, &model.lines[line], tied)
        };
        let ends = |&line: &usize| ends_of(line).map(|point| LineEnd::new(model, network, point));
        let free_points = &network.free_points;
        let attached = free_points
            .iter()
            .map(|&point| point::attached(model, network, point));
        let attached: Vec<Vec<(usize, End)>> = attached.collect();
        Some(LeapfrogNetwork {
            lines: network.lines.iter().map(line).collect::<Option<_>>()?,
            line_numbers: network.lines.clone(),
            ends: network.lines.iter().map(ends).collect(),
            points: vec![PointState::at_rest(Vector3::zeros()); free_points.len()],
            point_numbers: free_points.clone(),
            waves: vec![
                WaveSpan::default();
                if model.water_accelerates() {
                    free_points.len()
                } else {
                    0
                }
            ],
            scratch: K::points(model, network),
            attached,
            point_flow: Flow::default(),
        })
    }

    /// Selects the kernels compiled for every machine of the target, instead of those for the best vector unit of this machine.
    /// Results do not depend on this choice.
    pub fn set_portable(&mut self, portable: bool) {
        self.lines
            .iter_mut()
            .for_each(|line| line.layout.set_portable(portable));
    }

    /// Lines and their indices in the model.
    fn numbered_lines(&mut self) -> impl Iterator<Item = (&mut LeapfrogLine<K>, usize)> {
        self.lines.iter_mut().zip(self.line_numbers.iter().copied())
    }

    /// Loads the state.
    pub fn load(&mut self, state: &State) {
        self.numbered_lines()
            .for_each(|(work, line)| work.load(&state.lines[line]));
        if let Some(waves) = &state.waves {
            // states with different histories may have different wave kinematics over the same time span
            self.numbered_lines()
                .for_each(|(work, line)| work.layout.load_waves(&waves.lines[line]));
        }
        self.load_surroundings(state);
    }

    /// Continues from the state that [`Self::store`] stored last.
    pub fn resume(&mut self, state: &State) {
        self.numbered_lines()
            .for_each(|(work, line)| K::resume(work, &state.lines[line]));
        self.load_surroundings(state);
    }

    fn load_surroundings(&mut self, state: &State) {
        if let Some(waves) = &state.waves {
            self.numbered_lines()
                .for_each(|(work, line)| work.load_waves(&waves.lines[line]));
            for (own, &point) in self.waves.iter_mut().zip(&self.point_numbers) {
                own.clone_from(&waves.points[point]);
            }
        }
        self.point_flow = Flow::default();
        for (point, &number) in self.points.iter_mut().zip(&self.point_numbers) {
            *point = state.points[number];
            let first = self.line_numbers.first();
            if first.is_none_or(|&line| state.lines[line].half_step.is_unset()) {
                point.half_step = [point.velocity; 2];
            }
        }
    }

    /// Stores the state after a step of `steps[0]` [s], preceded by one of `steps[1]` [s]. Returns whether all nodes have finite positions and
    /// physically possible speeds.
    pub fn store(&mut self, state: &mut State, steps: [f64; 2]) -> bool {
        let mut is_sound = true;
        for (work, line) in self.numbered_lines() {
            is_sound &= K::store(work, &mut state.lines[line], steps);
        }
        let extrapolation = Step::after(steps, steps[0]).extrapolation;
        for (point, &number) in self.points.iter().zip(&self.point_numbers) {
            let [last, before] = point.half_step;
            state.points[number] = PointState {
                velocity: last + extrapolation * (last - before),
                ..*point
            };
        }
        is_sound
    }

    /// First line, by index in the network, and node whose position is not finite or whose speed is physically impossible. If there is none,
    /// the fastest node of the first line whose energy flow is not finite.
    pub fn broken_node(&self) -> (usize, usize) {
        let mut lines = self.lines.iter().enumerate();
        let broken = lines.find_map(|(line, work)| Some((line, work.layout.broken_node()?)));
        broken.unwrap_or_else(|| {
            let mut lines = self.lines.iter();
            let grown = lines.position(|work| !work.flow().is_finite()).unwrap_or(0);
            (grown, self.lines[grown].layout.fastest_node())
        })
    }

    /// Moves the ends of the lines to their points at the start of a communication step, `t` [s], with velocities half a step of `last` [s]
    /// earlier, like those of the nodes. Omits lines for which [`Kernel::starts`] is false, unless `jump` is true.
    pub fn set_out(&mut self, t: f64, last: f64, jump: bool, held: &impl Fn(usize, f64) -> Kinematics) {
        for (work, ends) in self.lines.iter_mut().zip(&mut self.ends) {
            if jump || K::starts(work) {
                ends.iter_mut()
                    .for_each(|end| end.find(&self.points, t, last, held));
                work.put_ends([&ends[0].motion, &ends[1].motion]);
            }
        }
    }

    /// Restarts the viscoelastic segments and the work of the ends of all lines from the current motion of the ends, half the `last` step [s] ago.
    pub fn set_out_anew(&mut self, last: f64) {
        self.lines.iter_mut().for_each(|line| line.set_out_anew(last));
    }

    /// Sets the paths of the winches, by line of the model, from the time of `state` on. Requires [`Self::set_out`] before.
    pub fn start_winches(&mut self, state: &State, paths: &[AxisPath], step: Step) {
        for (work, line) in self.numbered_lines() {
            if let Some(path) = paths.get(line) {
                let fresh = state.lines[line].half_step.is_unset();
                K::start_winch(work, path, (state.time, fresh), step);
            }
        }
    }

    /// Sets current and waves to those at `t` [s].
    #[inline]
    pub fn set_water(&mut self, model: &Model, t: f64) {
        if model.water_accelerates() {
            self.lines.iter_mut().for_each(|line| line.layout.set_time(t));
        }
        if let Some(stream) = model.stream(t) {
            let lines = self.lines.iter_mut();
            lines.for_each(|line| line.layout.set_current(stream.factor));
        }
    }

    /// Sets the directions of the clamps of lines that bend from the rotation of their supports at `t` [s], and the moments on the ends of these lines.
    fn turn_clamps(&mut self, model: &Model, t: f64, held: &impl Fn(usize, f64) -> Kinematics) {
        for (number, work) in self.lines.iter_mut().enumerate() {
            let Some(joints) = &mut work.layout.joints else {
                continue;
            };
            let line = &model.lines[self.line_numbers[number]];
            joints.clamps = ENDS.map(|end| {
                let support = match self.ends[number][end as usize].tie {
                    Tie::Prescribed(point) => held(point, t),
                    _ => Kinematics::default(),
                };
                let along = line.clamp(end, &PointState::held(&support));
                Clamp {
                    along: along.unwrap_or_else(Vector3::zeros),
                    spin: support.spin,
                }
            });
            joints.moments = model.end_moments(line, t);
        }
    }

    /// Finds the nodes at the water surface before the first step.
    pub fn meet_surface(&mut self) {
        self.lines.iter_mut().for_each(LeapfrogLine::meet_surface);
    }

    /// Takes a step between two times [s]; `held` returns the kinematics of prescribed points. Returns the number of solves.
    pub fn step(
        &mut self,
        model: &Model,
        [t, after]: [f64; 2],
        step: Step,
        held: &impl Fn(usize, f64) -> Kinematics,
    ) -> usize {
        self.set_water(model, t);
        self.turn_clamps(model, t, held);
        for (work, line) in self.numbered_lines() {
            if let Some(releases) = &model.lines[line].release {
                work.release_ends(releases, t, step);
            }
        }
        K::step(self, model, [t, after], step, held)
    }

    /// Sets the motion of the ends of all lines to the positions of their points at `t` [s] and the velocities half a step of `length` [s] earlier.
    #[inline]
    pub(super) fn find_ends(&mut self, t: f64, length: f64, held: &impl Fn(usize, f64) -> Kinematics) {
        let ends = self.ends.iter_mut().flatten();
        ends.for_each(|end| end.find(&self.points, t, length, held));
    }

    /// Sets the motion of the ends at free points to that of the points.
    pub(super) fn find_free_ends(&mut self) {
        let ends = self.ends.iter_mut().flatten();
        let free = ends.filter(|end| matches!(end.tie, Tie::Free(_)));
        free.for_each(|end| end.find(&self.points, 0.0, 0.0, &|_, _| Kinematics::default()));
    }

    #[inline]
    pub(super) fn lines_and_ends(&mut self) -> impl Iterator<Item = (&mut LeapfrogLine<K>, [&EndMotion; 2])> {
        let ends = self.ends.iter().map(|[a, b]| [&a.motion, &b.motion]);
        self.lines.iter_mut().zip(ends)
    }

    /// Free points at the ends of a line; line and points by index in the network.
    pub(super) fn free_ends(&self, line: usize) -> [Option<usize>; 2] {
        self.ends[line].map(|end| match end.tie {
            Tie::Free(free) => Some(free),
            _ => None,
        })
    }

    /// Energy flow since the state was loaded [J]. The dissipation includes the kinetic energy. Zero without an energy balance.
    pub fn flow(&self) -> Flow {
        let mut flow = self.point_flow;
        self.lines.iter().for_each(|line| flow.add(line.flow()));
        flow
    }
}
