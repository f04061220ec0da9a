//! The water around lines and points at a time: the current by its profile, the waves by their kinematics at the
//! nodes.
//!
//! Wave kinematics at the nodes are evaluated at both ends of a time span, at the extrapolated positions of the
//! nodes, and interpolated by cubics ([`Orbit::between`]). Every line and every point has a separate span. The
//! spans are part of the state: a restored state continues identically to the last bit. If a host gives the flow of the
//! water, the spans hold that flow instead of waves, without an elevation.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Model, State};
use crate::physics::airy::Orbit;
use crate::physics::flow::Stream;

/// Motion of the water due to waves, or as a host gives it.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WaveSpans {
    /// At the nodes of every line, in the order of the model.
    pub lines: Vec<WaveSpan>,
    /// At every point, in the order of the model.
    pub points: Vec<WaveSpan>,
}

/// Motion of the water over a time span.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WaveSpan {
    /// Start and end [s].
    pub times: [f64; 2],
    /// Kinematics at both times, by node; empty if no waves act.
    pub ends: [Vec<Orbit>; 2],
    /// Positions of the nodes at its start [m]; empty if a host gives the flow.
    pub places: Vec<Vector3<f64>>,
}

impl Clone for WaveSpans {
    fn clone(&self) -> Self {
        WaveSpans {
            lines: self.lines.clone(),
            points: self.points.clone(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.lines.clone_from(&source.lines);
        self.points.clone_from(&source.points);
    }
}

impl Clone for WaveSpan {
    fn clone(&self) -> Self {
        WaveSpan {
            times: self.times,
            ends: self.ends.clone(),
            places: self.places.clone(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.times = source.times;
        self.ends.clone_from(&source.ends);
        self.places.clone_from(&source.places);
    }
}

impl WaveSpan {
    /// Span of zero length at a time [s], with the given motion at the nodes.
    pub fn begun(time: f64, nodes: Vec<Orbit>) -> WaveSpan {
        WaveSpan {
            times: [time; 2],
            ends: [nodes.clone(), nodes],
            places: Vec::new(),
        }
    }

    /// Length [s]; 0 if it ends at its start.
    pub fn length(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    /// Motion at the nodes at time `t` [s]; `None` if no waves act.
    pub fn at(&self, t: f64) -> Option<WavesAlong<'_>> {
        let [before, after] = &self.ends;
        (!before.is_empty()).then_some(WavesAlong {
            ends: [before, after],
            times: self.times,
            time: t,
        })
    }

    /// Motion at a point, whose span has one node, at time `t` [s].
    pub fn at_point(&self, t: f64) -> Orbit {
        let waves = self.at(t);
        waves.map_or_else(Orbit::default, |waves| waves.at(0))
    }
}

/// Wave kinematics along a line at one time.
#[derive(Debug, Clone, Copy)]
pub struct WavesAlong<'a> {
    ends: [&'a [Orbit]; 2],
    times: [f64; 2],
    /// Time [s].
    time: f64,
}

impl WavesAlong<'_> {
    /// Motion at a node.
    pub fn at(&self, node: usize) -> Orbit {
        let [before, after] = self.ends;
        Orbit::between(&before[node], &after[node], self.times, self.time)
    }
}

/// The water along a line at one time.
#[derive(Debug, Clone, Copy, Default)]
pub struct WaterAlong<'a> {
    /// Current, if there is one.
    pub stream: Option<Stream<'a>>,
    /// Waves along the line, if they act on it.
    pub waves: Option<WavesAlong<'a>>,
}

impl WaterAlong<'_> {
    /// Returns whether the water is at rest.
    pub fn is_still(&self) -> bool {
        self.stream.is_none() && self.waves.is_none()
    }

    /// Elevation of the surface over a node [m].
    #[inline]
    pub fn elevation(&self, node: usize) -> f64 {
        self.waves.as_ref().map_or(0.0, |waves| waves.at(node).elevation)
    }

    /// Vertical velocity of the surface over a node [m/s].
    #[inline]
    pub fn rise(&self, node: usize) -> f64 {
        self.waves.as_ref().map_or(0.0, |waves| waves.at(node).rise)
    }

    /// Velocity of the water at a node that is at the height z [m], in [m/s].
    #[inline]
    pub fn velocity(&self, node: usize, z: f64) -> Vector3<f64> {
        let flow = self.stream.map_or(Vector3::zeros(), |stream| stream.velocity(z));
        match &self.waves {
            None => flow,
            Some(waves) => flow + waves.at(node).velocity,
        }
    }
}

impl Model {
    /// Returns whether the water accelerates: in waves, or as a host gives it.
    pub fn water_accelerates(&self) -> bool {
        self.waves.is_some() || self.host_flow
    }

    /// The water along a line at time `t` [s].
    pub fn water_along<'a>(&'a self, state: &'a State, line: usize, t: f64) -> WaterAlong<'a> {
        WaterAlong {
            stream: self.stream(t),
            waves: state.waves.as_ref().and_then(|waves| waves.lines[line].at(t)),
        }
    }
}

impl State {
    /// Motion of the water at a point at time `t` [s], if there are waves or a host gives the flow.
    pub fn waves_at_point(&self, point: usize, t: f64) -> Option<Orbit> {
        let waves = self.waves.as_ref();
        waves.map(|waves| waves.points[point].at_point(t))
    }
}
