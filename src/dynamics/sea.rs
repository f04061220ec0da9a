//! What waves do at the nodes: asked of the waves once for every span of time, at the places where the nodes will be at its end.
//!
//! A span is as long as cubics bridge it ([`Waves::interval`]), rounded down to whole communication steps; a longer communication step is cut
//! into spans. Where a node will be is foretold from its velocity at the start of the span, r + τ v. What was found for the end of a span is
//! the start of the next, so that velocity and acceleration of the water have no jump and no kink in time.

use pulp::{Arch, NullaryFnOnce};

use crate::model::{Model, State, WaveSpan, WavesAt};
use crate::physics::airy::{Instant, Orbit, Waves};

/// Rounding of times, over a step [-].
const ROUNDING: f64 = 1e-9;

/// Scratch of the spans.
#[derive(Debug, Clone)]
pub struct SeaWork {
    /// The widest vectors of this machine; results do not depend on it.
    unit: Arch,
    instant: Instant,
    /// The span before, or room for the next one.
    spare: WaveSpan,
}

impl SeaWork {
    /// Scratch.
    pub fn new() -> SeaWork {
        SeaWork {
            unit: Arch::new(),
            instant: Instant::default(),
            spare: WaveSpan::default(),
        }
    }

    /// Gives a state the waves of its time, or none.
    pub fn start(&mut self, model: &Model, state: &mut State) {
        state.waves = model.waves.as_ref().map(|waves| {
            let mut now = WavesAt::default();
            self.sample(model, waves, state, 0.0, &mut now);
            WaveSpan {
                times: [state.time; 2],
                ends: [now.clone(), now],
            }
        });
    }

    /// How far the next step goes [s] on the way over `length` [s]: not beyond the end of a span.
    pub fn reach(&self, waves: &Waves, state: &State, length: f64) -> f64 {
        let left = left(state, length);
        if left > 0.0 {
            return if left > (1.0 - ROUNDING) * length {
                length
            } else {
                left
            };
        }
        length / (length / waves.interval() - ROUNDING).ceil().max(1.0)
    }

    /// Begins a new span where the old one is over, for steps of `step` [s]; whether it did.
    pub fn renew(&mut self, model: &Model, waves: &Waves, state: &mut State, step: f64) -> bool {
        if left(state, step) > 0.0 {
            return false;
        }
        let mut next = std::mem::take(&mut self.spare);
        let steps = (waves.interval() / step + ROUNDING).floor().max(1.0);
        let span = steps * step;
        next.times = [state.time, state.time + span];
        let [first, last] = &mut next.ends;
        match &state.waves {
            Some(old) if (old.times[1] - state.time).abs() <= ROUNDING * step => {
                first.clone_from(&old.ends[1]);
            }
            _ => self.sample(model, waves, state, 0.0, first),
        }
        self.sample(model, waves, state, span, last);
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
        model: &Model,
        waves: &Waves,
        state: &State,
        ahead: f64,
        found: &mut WavesAt,
    ) {
        waves.turn_to(state.time + ahead, &mut self.instant);
        self.unit.dispatch(Sampling {
            model,
            waves,
            state,
            ahead,
            found,
            instant: &mut self.instant,
        });
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

/// [`SeaWork::sample`] for the vector unit of the machine.
struct Sampling<'a> {
    model: &'a Model,
    waves: &'a Waves,
    state: &'a State,
    /// [s]
    ahead: f64,
    found: &'a mut WavesAt,
    instant: &'a mut Instant,
}

impl NullaryFnOnce for Sampling<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (model, state, found) = (self.model, self.state, self.found);
        found.lines.resize_with(model.lines.len(), Vec::new);
        for (index, line) in model.lines.iter().enumerate() {
            let (shape, nodes) = (&state.lines[index], &mut found.lines[index]);
            nodes.clear();
            if line.heaves(model) {
                nodes.resize(shape.position.len(), Orbit::default());
                // a closure would not be compiled for the vector unit
                for (i, orbit) in nodes.iter_mut().enumerate() {
                    let place = shape.position[i] + self.ahead * shape.velocity[i];
                    *orbit = self.waves.orbit(place, self.instant);
                }
            }
        }
        found.points.clear();
        found.points.resize(model.points.len(), Orbit::default());
        for (index, orbit) in found.points.iter_mut().enumerate() {
            let at = &state.points[index];
            let place = at.position + self.ahead * at.velocity;
            if model.points[index]
                .free()
                .is_some_and(|free| free.sphere.is_some())
            {
                *orbit = self.waves.orbit(place, self.instant);
            }
        }
    }
}
