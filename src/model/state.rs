//! Changing state: positions, velocities and the memory of the integrators. A clone of it saves a simulation.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use super::{BeamState, Kinematics, Line, WaveSpans};

/// State of a whole model at one time.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time [s].
    pub time: f64,
    /// Points, in the order of the model.
    pub points: Vec<PointState>,
    /// Lines, in the order of the model.
    pub lines: Vec<LineState>,
    /// Motion of the water at the nodes around this time, if there are waves or a host gives the flow.
    pub waves: Option<WaveSpans>,
}

/// State of a point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct PointState {
    /// Position [m].
    pub position: Vector3<f64>,
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Acceleration [m/s²].
    pub acceleration: Vector3<f64>,
    /// Rotation from the reference attitude of the point's support, which its clamped lines follow [-].
    pub orientation: UnitQuaternion<f64>,
    /// Angular velocity of the point's support [rad/s].
    pub spin: Vector3<f64>,
    /// Velocities half a step and one and a half steps before the time of the position [m/s], for the leapfrog.
    pub half_step: [Vector3<f64>; 2],
    /// Position at which friction on the point would vanish [m], if there is friction.
    pub anchor: Option<Vector3<f64>>,
}

/// State of a line: its nodes from end A to end B, ends included.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct LineState {
    /// Positions [m].
    pub position: Vec<Vector3<f64>>,
    /// Velocities [m/s] at the time of the positions.
    pub velocity: Vec<Vector3<f64>>,
    /// Accelerations [m/s²]; kept by the implicit integrators only.
    pub acceleration: Vec<Vector3<f64>>,
    /// Memory of the leapfrogs from previous steps.
    pub half_step: HalfStep,
    /// Data of the closed-form catenary in addition to its nodes; kept by quasi-static networks only.
    pub closed_form: Option<ClosedForm>,
    /// Strain of the slow part of every segment [-]; empty unless the line is viscoelastic and in motion.
    pub viscoelastic: Vec<f64>,
    /// True if ends A and B are released from their points.
    pub released: [bool; 2],
    /// Frames and rates of the nodes of a beam.
    pub beam: Option<BeamState>,
    /// Positions of the nodes at which the friction of the seabed would vanish [m]; empty without friction.
    pub anchor: Vec<Vector3<f64>>,
    /// State of the line's winch, if it is on one.
    pub winch_state: Option<WinchState>,
}

/// State of the winch of a line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WinchState {
    /// Length change [m], positive for line paid out.
    pub change: f64,
    /// Rate of the length change [m/s].
    pub rate: f64,
    /// Second derivative of the length change [m/s²].
    pub acceleration: f64,
    /// Length change [m] and rate [m/s] half a step before, for the leapfrog.
    pub half_step: [f64; 2],
}

impl WinchState {
    /// Winch at rest at a length change [m].
    pub fn at_rest(change: f64) -> WinchState {
        WinchState {
            change,
            rate: 0.0,
            acceleration: 0.0,
            half_step: [change, 0.0],
        }
    }
}

/// Data of a closed-form catenary that do not follow from its nodes: the chords between nodes are shorter than the arcs, which can hide
/// the whole strain of a stiff line.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ClosedForm {
    /// Effective tension at every node [N].
    pub tension: Vec<f64>,
    /// Horizontal part of the tension [N], which grows towards end B on a seabed with friction and is constant elsewhere.
    pub horizontal: Vec<f64>,
    /// Forces of the line on the points at ends A and B [N].
    pub end_force: [Vector3<f64>; 2],
    /// Unstretched length on the seabed [m].
    pub laid_length: f64,
    /// Stretched length [m].
    pub stretched_length: f64,
    /// Maximum vertical distance below the chord between the ends [m].
    pub sag: f64,
    /// Strain energy of the whole line, prescribed ends included [J].
    pub axial_energy: f64,
    /// Potential energy of its weight above z = 0, prescribed ends included [J].
    pub gravitational_energy: f64,
}

/// Memory of the leapfrogs. Empty with other integrators.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HalfStep {
    /// Velocities at t − Δt/2 [m/s].
    pub velocity: Vec<Vector3<f64>>,
    /// Velocities one step before those [m/s].
    pub velocity_before: Vec<Vector3<f64>>,
    /// Lengths of the last step and the one before [s]; 0 before the first step, when `velocity` is at t.
    pub steps: [f64; 2],
    /// Tensions of the segments' springs at t − Δt and t − 2Δt, negative in compression [N]; kept by the
    /// axial-implicit leapfrog only.
    pub tension: [Vec<f64>; 2],
    /// Slow strains of viscoelastic segments at t − Δt/2 [-]; empty before the first step.
    pub viscoelastic: Vec<f64>,
}

impl HalfStep {
    /// Returns whether no leapfrog has made a step from this state yet.
    pub fn is_unset(&self) -> bool {
        self.velocity.is_empty()
    }
}

impl PointState {
    /// Point at rest at a position [m].
    pub fn at_rest(position: Vector3<f64>) -> PointState {
        PointState {
            position,
            ..PointState::default()
        }
    }

    /// The point at the same position, without motion.
    pub fn stopped(self) -> PointState {
        let zero = Vector3::zeros();
        PointState {
            velocity: zero,
            acceleration: zero,
            spin: zero,
            ..self
        }
    }

    /// The point with the rotation that its support had `lag` [s] ago.
    pub fn before(self, lag: f64) -> PointState {
        PointState {
            orientation: UnitQuaternion::from_scaled_axis(-lag * self.spin) * self.orientation,
            ..self
        }
    }

    /// The point in its present position and motion, with zero acceleration.
    pub fn without_acceleration(self) -> PointState {
        PointState {
            acceleration: Vector3::zeros(),
            ..self
        }
    }
}

impl PointState {
    /// Point at rest at a prescribed position and orientation.
    pub fn held(kinematics: &Kinematics) -> PointState {
        PointState {
            orientation: kinematics.orientation,
            ..PointState::at_rest(kinematics.position)
        }
    }
}

impl LineState {
    /// Velocities from which a leapfrog continues [m/s], and the time from these to the positions [s].
    pub fn velocities_before(&self) -> (&[Vector3<f64>], f64) {
        let memory = &self.half_step;
        match memory.is_unset() {
            true => (&self.velocity, 0.0),
            false => (&memory.velocity, 0.5 * memory.steps[0]),
        }
    }

    /// Chords of the segments at the time of those velocities [m].
    pub fn chords_before(&self) -> impl Iterator<Item = Vector3<f64>> {
        let (velocity, lag) = self.velocities_before();
        let nodes = self.position.windows(2).zip(velocity.windows(2));
        nodes.map(move |(r, v)| r[1] - r[0] - lag * (v[1] - v[0]))
    }

    /// Adds the state of a beam, at rest at its positions, if the line is a beam; `attitude` [-] is the rotation of
    /// its points.
    pub fn become_beam(&mut self, line: &Line, attitude: [Matrix3<f64>; 2]) {
        self.beam = line
            .beam
            .as_ref()
            .map(|beam| BeamState::at_rest(beam, &self.position, attitude));
    }

    /// Sets the slow strains of a viscoelastic line at rest at its positions.
    pub fn become_viscoelastic(&mut self, line: &Line) {
        self.viscoelastic.clear();
        if let Some(laws) = &line.segments.viscoelastic {
            let chords = self.position.windows(2).map(|pair| (pair[1] - pair[0]).norm());
            let strains = chords.zip(&line.segments.length).map(|(l, l0)| l / l0 - 1.0);
            self.viscoelastic
                .extend(laws.iter().zip(strains).map(|(law, strain)| law.rest(strain)));
        }
    }

    /// Line at rest at the given node positions [m].
    pub fn at_rest(position: Vec<Vector3<f64>>) -> LineState {
        let zeros = vec![Vector3::zeros(); position.len()];
        LineState {
            velocity: zeros.clone(),
            acceleration: zeros,
            position,
            half_step: HalfStep::default(),
            closed_form: None,
            viscoelastic: Vec::new(),
            released: [false; 2],
            beam: None,
            anchor: Vec::new(),
            winch_state: None,
        }
    }
}

/// `Clone` whose `clone_from` keeps the buffers of the target, so that a step allocates nothing.
macro_rules! clone_in_place {
    ($type:ident { $($field:ident),+ }) => {
        impl Clone for $type {
            fn clone(&self) -> Self {
                $type { $($field: self.$field.clone()),+ }
            }

            fn clone_from(&mut self, source: &Self) {
                $(self.$field.clone_from(&source.$field);)+
            }
        }
    };
}

clone_in_place!(State {
    time,
    points,
    lines,
    waves
});
clone_in_place!(LineState {
    position,
    velocity,
    acceleration,
    half_step,
    closed_form,
    viscoelastic,
    released,
    beam,
    anchor,
    winch_state
});
clone_in_place!(ClosedForm {
    tension,
    horizontal,
    end_force,
    laid_length,
    stretched_length,
    sag,
    axial_energy,
    gravitational_energy
});
clone_in_place!(HalfStep {
    velocity,
    velocity_before,
    viscoelastic,
    steps,
    tension
});
