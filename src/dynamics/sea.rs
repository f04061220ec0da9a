//! What waves do at the nodes: asked of the waves once for every span of time, at the places where the nodes will be at its end.
//!
//! A span is as long as cubics bridge it at the highest place that waves act on ([`Waves::interval_below`]), rounded down to whole communication steps; a longer communication step is cut
//! into spans. Where a node will be is foretold from its velocity at the start of the span, r + τ v. What was found for the end of a span is
//! the start of the next, so that velocity and acceleration of the water have no jump and no kink in time.

use std::sync::Mutex;

use pulp::{Arch, NullaryFnOnce};

use super::crew::{Hands, Queue};
use crate::model::{Line, LineState, Model, Point, State, WaveSpan, WavesAt};
use crate::physics::airy::{Instant, Orbit, Waves};

/// Rounding of times, over a step [-].
const ROUNDING: f64 = 1e-9;

/// Scratch of the spans.
#[derive(Debug)]
pub struct SeaWork {
    /// The widest vectors of this machine; results do not depend on it.
    unit: Arch,
    instant: Instant,
    /// The same for the other threads.
    instants: Vec<Mutex<Instant>>,
    /// The span before, or room for the next one.
    spare: WaveSpan,
}

impl Clone for SeaWork {
    fn clone(&self) -> SeaWork {
        SeaWork::new()
    }
}

impl SeaWork {
    /// Scratch.
    pub fn new() -> SeaWork {
        SeaWork {
            unit: Arch::new(),
            instant: Instant::default(),
            instants: Vec::new(),
            spare: WaveSpan::default(),
        }
    }

    /// Gives a state the waves of its time, or none.
    pub fn start(&mut self, model: &Model, state: &mut State, hands: &mut Hands) {
        state.waves = model.waves.as_ref().map(|waves| {
            let mut now = WavesAt::default();
            self.sample((model, waves, &*state), 0.0, &mut now, hands);
            WaveSpan {
                times: [state.time; 2],
                ends: [now.clone(), now],
            }
        });
    }

    /// How far the next step goes [s] on the way over `length` [s]: not beyond the end of a span.
    pub fn reach(&self, model: &Model, waves: &Waves, state: &State, length: f64) -> f64 {
        let left = left(state, length);
        if left > 0.0 {
            return if left > (1.0 - ROUNDING) * length {
                length
            } else {
                left
            };
        }
        let interval = waves.interval_below(highest(model, state));
        length / (length / interval - ROUNDING).ceil().max(1.0)
    }

    /// Begins a new span where the old one is over, for steps of `step` [s]; whether it did.
    pub fn renew(
        &mut self,
        model: &Model,
        waves: &Waves,
        state: &mut State,
        step: f64,
        hands: &mut Hands,
    ) -> bool {
        if left(state, step) > 0.0 {
            return false;
        }
        let mut next = std::mem::take(&mut self.spare);
        let interval = waves.interval_below(highest(model, state));
        let steps = (interval / step + ROUNDING).floor().max(1.0);
        let span = steps * step;
        next.times = [state.time, state.time + span];
        let [first, last] = &mut next.ends;
        match &state.waves {
            Some(old) if (old.times[1] - state.time).abs() <= ROUNDING * step => {
                first.clone_from(&old.ends[1]);
            }
            _ => self.sample((model, waves, &*state), 0.0, first, hands),
        }
        self.sample((model, waves, &*state), span, last, hands);
        self.spare = state.waves.replace(next).unwrap_or_default();
        true
    }

    /// Puts back the span before.
    pub fn undo(&mut self, state: &mut State) {
        if let Some(waves) = &mut state.waves {
            std::mem::swap(waves, &mut self.spare);
        }
    }

    /// Motion of the water where nodes and points will be after `ahead` [s].
    fn sample(
        &mut self,
        (model, waves, state): (&Model, &Waves, &State),
        ahead: f64,
        found: &mut WavesAt,
        hands: &mut Hands,
    ) {
        let (unit, time) = (self.unit, state.time + ahead);
        waves.turn_to(time, &mut self.instant);
        let instant = &mut self.instant;
        found.points.clear();
        for (point, at) in model.points.iter().zip(&state.points) {
            let place = heaves(point).then_some(at.position + ahead * at.velocity);
            let orbit = place.map(|place| waves.orbit(place, instant));
            found.points.push(orbit.unwrap_or_default());
        }
        found.lines.resize_with(model.lines.len(), Vec::new);
        let ask =
            |instant: &mut Instant, line: &Line, shape: &LineState, nodes: &mut Vec<Orbit>| {
                nodes.clear();
                if line.heaves(model) {
                    nodes.resize(shape.position.len(), Orbit::default());
                    unit.dispatch(Sampling {
                        waves,
                        shape,
                        ahead,
                        nodes,
                        instant,
                    });
                }
            };
        let lines = model.lines.iter().zip(&state.lines);
        if hands.threads == 1 {
            let all = lines.zip(&mut found.lines);
            all.for_each(|((line, shape), nodes)| ask(instant, line, shape, nodes));
            return;
        }
        let size = model.lines.len().div_ceil(hands.threads);
        let parts = found.lines.chunks_mut(size).enumerate();
        let queue = Queue::new(parts.map(|(part, nodes)| {
            let lines = part * size..(part * size + nodes.len());
            lines.zip(nodes)
        }));
        let work = |own: usize, instant: &mut Instant| {
            while let Some((line, nodes)) = queue.take(own) {
                ask(instant, &model.lines[line], &state.lines[line], nodes);
            }
        };
        while self.instants.len() + 1 < hands.threads {
            self.instants.push(Mutex::default());
        }
        let help = |number: usize, instant: &mut Instant| {
            waves.turn_to(time, instant);
            work(number + 1, instant);
        };
        let helpers = &self.instants[..hands.threads - 1];
        hands.crew.run(helpers, help, || work(0, instant));
    }
}

/// Time to the end of the span that a state is in [s]; 0 where it is over, or has not begun.
fn left(state: &State, step: f64) -> f64 {
    let rounding = ROUNDING * step;
    match &state.waves {
        Some(span) if state.time >= span.times[0] - rounding => {
            let left = span.times[1] - state.time;
            if left > rounding { left } else { 0.0 }
        }
        _ => 0.0,
    }
}

/// Whether waves act on a point.
fn heaves(point: &Point) -> bool {
    point.body().is_some_and(|body| body.sphere.is_some())
}

/// Height of the highest place that waves act on [m].
fn highest(model: &Model, state: &State) -> f64 {
    let lines = model.lines.iter().zip(&state.lines);
    let nodes = lines
        .filter(|(line, _)| line.heaves(model))
        .flat_map(|(_, shape)| &shape.position);
    let points = model.points.iter().zip(&state.points);
    let points = points
        .filter(|(point, _)| heaves(point))
        .map(|(_, at)| &at.position);
    let heights = nodes.chain(points).map(|place| place.z);
    heights.fold(f64::NEG_INFINITY, f64::max)
}

/// What waves do along a line, for the vector unit of the machine.
struct Sampling<'a> {
    waves: &'a Waves,
    shape: &'a LineState,
    /// [s]
    ahead: f64,
    nodes: &'a mut [Orbit],
    instant: &'a mut Instant,
}

impl NullaryFnOnce for Sampling<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        // a closure would not be compiled for the vector unit
        for (i, orbit) in self.nodes.iter_mut().enumerate() {
            let place = self.shape.position[i] + self.ahead * self.shape.velocity[i];
            *orbit = self.waves.orbit(place, self.instant);
        }
    }
}
