//! Water flow at the nodes of the lines, given by a host instead of waves.
//!
//! The host gives velocity u and acceleration a of the water at the positions of the nodes, once for every communication step. With
//! `input_reconstruction = "interpolate"` these hold for the end t + h of the coming step and for the positions r + h v that the nodes will reach if
//! they keep their velocities. Over the step the velocity follows the cubic between both ends with the slopes a, and the acceleration the parabola
//! through its last three values, with errors h⁴u⁗/384 and h³a‴/16. Built-in waves differ only in the acceleration: its cubic has the exact slopes.
//!
//! Otherwise they hold for the start t of the step and for the present positions. With the previous values, given h₀ earlier, the flow at the end is
//! predicted as
//!
//! û = u + h (u − u₋)/h₀ + ½h (h + h₀) j,   â = a + h j,   j = (a − a₋)/h₀,
//!
//! with errors h³u‴/2 and h²a″ on equal steps. Over the step velocity and acceleration follow cubics from their last predictions to these, with the slopes
//! â and j, so that neither jumps. The difference of the velocities, rather than a, is extrapolated, since it includes the change of u due to the motion of
//! the node through the water. Without previous values, at the start or where the step has more than doubled, û = u + h a and â = a.
//!
//! The flow at a point is that at the first line end attached to it. Source: derived here.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::Simulation;
use crate::dynamics::{StepError, StepFailure};
use crate::model::{End, Model, Point, State, WaveSpan, WaveSpans};
use crate::physics::airy::Orbit;
use crate::scene::{Reconstruction, SceneError};

/// Components of the flow at a node: velocity along x, y, z [m/s], then acceleration [m/s²].
pub const FLOW_COMPONENTS: [&str; 6] = ["vx", "vy", "vz", "ax", "ay", "az"];
/// Message for a line that takes no flow from a host.
pub const NO_FLOW: &str = "it takes no flow of the water: that needs `flow = \"host\"` in [water], and a `diameter` of its line type";
/// Limits of velocity [m/s], as for a current in a scene, and of acceleration [m/s²], a thousand times that of gravity.
const LIMITS: [f64; 2] = [100.0, 1e4];
/// Greatest ratio of a step to the previous one for which rates are extrapolated [-].
const GROWTH_MAX: f64 = 2.0;

/// Water flow at the nodes of the lines.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WaterFlow {
    /// Components at the nodes of each line, from end A to end B: empty for a line that takes no flow; no lines if the host gives none.
    lines: Vec<[Vec<f64>; 6]>,
}

impl Clone for WaterFlow {
    fn clone(&self) -> Self {
        WaterFlow {
            lines: self.lines.clone(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.lines.clone_from(&source.lines);
    }
}

impl WaterFlow {
    /// Water at rest, allocated for the lines that take a flow.
    pub fn still(model: &Model) -> WaterFlow {
        let lines = model.lines.iter().filter(|_| model.host_flow);
        WaterFlow {
            lines: lines
                .map(|line| std::array::from_fn(|_| vec![0.0; line.flow_count(model)]))
                .collect(),
        }
    }

    /// Number of nodes of a line at which a host gives the flow [-]; 0 if the line takes none.
    pub fn node_count(&self, line: usize) -> usize {
        self.lines.get(line).map_or(0, |[vx, ..]| vx.len())
    }

    /// A component of [`FLOW_COMPONENTS`] at the nodes of a line [m/s, m/s²].
    pub fn component(&self, line: usize, component: usize) -> &[f64] {
        &self.lines[line][component]
    }

    /// Component of [`FLOW_COMPONENTS`] at the nodes of a line, to be set [m/s, m/s²].
    pub fn component_mut(&mut self, line: usize, component: usize) -> &mut [f64] {
        &mut self.lines[line][component]
    }

    /// Sets velocity [m/s] and acceleration [m/s²] at a node.
    pub fn set(&mut self, line: usize, node: usize, velocity: [f64; 3], acceleration: [f64; 3]) {
        let values = velocity.into_iter().chain(acceleration);
        for (column, value) in self.lines[line].iter_mut().zip(values) {
            column[node] = value;
        }
    }

    /// Sets all components to zero.
    pub fn calm(&mut self) {
        self.lines
            .iter_mut()
            .flatten()
            .for_each(|values| values.fill(0.0));
    }

    /// Velocity [m/s] and acceleration [m/s²] at a node.
    #[inline]
    fn at(&self, line: usize, node: usize) -> [Vector3<f64>; 2] {
        let [vx, vy, vz, ax, ay, az] = &self.lines[line];
        [
            Vector3::new(vx[node], vy[node], vz[node]),
            Vector3::new(ax[node], ay[node], az[node]),
        ]
    }

    /// Line, component and node of the first value beyond the limits.
    fn beyond(&self) -> Option<(usize, usize, usize)> {
        let columns = |(line, columns): (usize, &[Vec<f64>; 6])| {
            columns.iter().enumerate().find_map(|(component, values)| {
                let limit = LIMITS[component / 3];
                let is_beyond = |value: &f64| value.is_nan() || value.abs() > limit;
                let node = values.iter().position(is_beyond)?;
                Some((line, component, node))
            })
        };
        self.lines.iter().enumerate().find_map(columns)
    }

    /// Message for a value beyond the limits.
    fn refusal(&self, model: &Model, (line, component, node): (usize, usize, usize)) -> String {
        let (value, limit) = (self.lines[line][component][node], LIMITS[component / 3]);
        let unit = ["m/s", "m/s²"][component / 3];
        format!(
            "{}.flow.{}[{}] = {value:e} {unit} is beyond {limit} {unit}",
            model.lines[line].name,
            FLOW_COMPONENTS[component],
            node + 1
        )
    }

    /// Refuses start values beyond the limits.
    pub(super) fn check_start(&self, model: &Model) -> Result<(), SceneError> {
        let beyond = self.beyond();
        beyond.map_or(Ok(()), |at| Err(SceneError::new("", self.refusal(model, at))))
    }

    /// Refuses values beyond the limits for a step from a time [s].
    pub(super) fn check_step(&self, model: &Model, time: f64) -> Result<(), StepError> {
        let Some(at @ (line, _, node)) = self.beyond() else {
            return Ok(());
        };
        let cause = StepFailure::Input(self.refusal(model, at));
        Err(StepError::new(time, &model.lines[line], node, cause))
    }
}

/// Treatment of the latest flow of a host in the coming step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Course {
    /// The flow holds for the end or the start of the step, as the scene specifies.
    Given,
    /// The flow of the previous step is extrapolated: the host has not given the next one.
    Continued,
}

/// Flow over the coming step.
struct Coming<'a> {
    model: &'a Model,
    course: Course,
    /// Present and previous flow that the host gave.
    given: [&'a WaterFlow; 2],
    /// Start and end [s].
    times: [f64; 2],
}

impl Coming<'_> {
    /// Water motion at both ends of the step at a node of a line; `old` is the motion over the previous step, of length h₀ [s].
    fn ends(&self, (line, node): (usize, usize), old: [&Orbit; 2], h0: f64) -> [Orbit; 2] {
        let [earlier, start] = old;
        let h = self.times[1] - self.times[0];
        let is_known = h0 > 0.0 && h <= GROWTH_MAX * h0;
        let orbit = |velocity, acceleration, jerk| Orbit {
            velocity,
            acceleration,
            jerk,
            ..Orbit::default()
        };
        let [velocity, acceleration] = self.given[0].at(line, node);
        let interpolates = self.model.solver.input_reconstruction == Reconstruction::Interpolate;
        match self.course {
            Course::Continued => {
                let acceleration = start.acceleration + h * start.jerk;
                let mean = start.acceleration + 0.5 * h * start.jerk;
                [*start, orbit(start.velocity + h * mean, acceleration, start.jerk)]
            }
            Course::Given if interpolates => {
                let slope = (acceleration - start.acceleration) / h;
                let bend = match is_known {
                    true => (slope - (start.acceleration - earlier.acceleration) / h0) / (h + h0),
                    false => Vector3::zeros(),
                };
                let before = Orbit {
                    jerk: slope - h * bend,
                    ..*start
                };
                [before, orbit(velocity, acceleration, slope + h * bend)]
            }
            Course::Given if is_known => {
                let [velocity_before, acceleration_before] = self.given[1].at(line, node);
                let jerk = (acceleration - acceleration_before) / h0;
                let rate = (velocity - velocity_before) / h0 + 0.5 * (h + h0) * jerk;
                [*start, orbit(velocity + h * rate, acceleration + h * jerk, jerk)]
            }
            Course::Given => {
                let end = velocity + h * acceleration;
                [*start, orbit(end, acceleration, Vector3::zeros())]
            }
        }
    }

    /// Lays out the water motion over the step at some nodes of a line, continuing that over the previous step.
    fn extend(&self, line: usize, nodes: std::ops::Range<usize>, old: &WaveSpan, next: &mut WaveSpan) {
        next.times = self.times;
        let [before, after] = &mut next.ends;
        before.clear();
        after.clear();
        for (node, (earlier, start)) in nodes.zip(old.ends[0].iter().zip(&old.ends[1])) {
            let [start, end] = self.ends((line, node), [earlier, start], old.length());
            before.push(start);
            after.push(end);
        }
    }
}

/// Line and node that give the flow at a point: the first end attached to it that is not released, else the first end.
fn source(model: &Model, state: &State, point: &Point) -> Option<(usize, usize)> {
    let is_joined = |(line, end): &&(usize, End)| !state.lines[*line].released[*end as usize];
    let joined = point.attached.iter().find(is_joined);
    let (line, end) = joined.or(point.attached.first())?;
    Some((*line, model.lines[*line].end_node(*end)))
}

/// Initial flow of a state; `None` if no host gives a flow.
pub(super) fn begin(model: &Model, state: &State, flow: &WaterFlow) -> Option<WaveSpans> {
    if !model.host_flow {
        return None;
    }
    let orbit = |line: usize, node: usize| {
        let [velocity, acceleration] = flow.at(line, node);
        Orbit {
            velocity,
            acceleration,
            ..Orbit::default()
        }
    };
    let lines = model.lines.iter().enumerate().map(|(index, line)| {
        let nodes = match line.heaves(model) {
            true => 0..line.segment_count() + 1,
            false => 0..0,
        };
        WaveSpan::begun(state.time, nodes.map(|node| orbit(index, node)).collect())
    });
    let points = model.points.iter().map(|point| {
        let at = source(model, state, point).filter(|_| point.heaves());
        let orbits = at.map(|(line, node)| orbit(line, node));
        WaveSpan::begun(state.time, orbits.into_iter().collect())
    });
    Some(WaveSpans {
        lines: lines.collect(),
        points: points.collect(),
    })
}

impl Simulation {
    /// Position for which a host must give the next flow at a node of a line [m]: the present position of the node or, if the flow holds for the end
    /// of the coming step, its position then at constant velocity. The coming step is taken as long as the last one, the first as long as the scene's
    /// interval.
    pub fn flow_place(&self, line: usize, node: usize) -> Vector3<f64> {
        let (model, snapshot) = (&*self.model, &self.snapshot);
        let shape = &snapshot.state.lines[line];
        let ahead = match model.solver.input_reconstruction {
            Reconstruction::Interpolate if snapshot.last_step == 0.0 => model.interval,
            Reconstruction::Interpolate => snapshot.last_step,
            _ => 0.0,
        };
        shape.position[node] + ahead * shape.velocity[node]
    }

    /// Lays out the flow over the next communication step [s]; the flow in the snapshot does not change.
    pub(super) fn extend_flow(&mut self, step: f64, course: Course) {
        let (model, state) = (&*self.model, &self.snapshot.state);
        let Some(old) = state.waves.as_ref().filter(|_| model.host_flow) else {
            return;
        };
        let next = self.next_flow.get_or_insert_with(|| old.clone());
        let coming = Coming {
            model,
            course,
            given: [&self.snapshot.inputs.flow, &self.snapshot.flow_before],
            times: [state.time, state.time + step],
        };
        for (line, (old, next)) in old.lines.iter().zip(&mut next.lines).enumerate() {
            coming.extend(line, 0..old.ends[1].len(), old, next);
        }
        let points = old.points.iter().zip(&mut next.points);
        for ((old, next), point) in points.zip(&model.points) {
            if let Some((line, node)) = source(model, state, point) {
                coming.extend(line, node..node + 1, old, next);
            }
        }
    }

    /// Exchanges the flow of the state with the one laid out for the next step.
    pub(super) fn swap_flow(&mut self) {
        if self.model.host_flow {
            std::mem::swap(&mut self.snapshot.state.waves, &mut self.next_flow);
        }
    }

    /// Stores the flow that the host gave, if the next step needs it.
    pub(super) fn keep_flow(&mut self) {
        if self.model.host_flow && self.model.solver.input_reconstruction != Reconstruction::Interpolate {
            let snapshot = &mut self.snapshot;
            snapshot.flow_before.clone_from(&snapshot.inputs.flow);
        }
    }
}
