//! Wave kinematics at the nodes: evaluated once for every time span, at the extrapolated positions of the nodes at
//! its end.
//!
//! Every line and every point has a separate span. Its length is the longest time that a cubic may interpolate at the
//! highest node ([`Waves::interval_below`]), rounded down to whole communication steps. Lines therefore do not affect each
//! other's waves. A communication step that is longer than the shortest such time is divided into parts.
//!
//! The position of a node is extrapolated by the parabola through its positions at the start of the previous span and of this one, with its velocity at
//! the latter. For a node that follows a wave over a twelfth of its period the error is 5 % of the amplitude. On a body the load of the waves is not small
//! compared with the other forces, and a body may vibrate on taut lines faster than the wave: the spans of points are a quarter as long, but at least one step.
//! The values at the end of a span are those at the start of the next, so that velocity and acceleration of the water have no jump and no kink in time.

use nalgebra::Vector3;
use pulp::NullaryFnOnce;

use super::threads::ThreadPool;
use crate::math::lanes::LANES;
use crate::math::unit::VectorUnit;
use crate::model::{Model, State, WaveSpan, WaveSpans};
use crate::physics::airy::{Instant, Orbit, Waves};

/// Tolerance for rounding of times, relative to a step [-].
const ROUNDING: f64 = 1e-9;
/// Length of the span of a point, relative to that of a line at the same height [-].
const POINT: f64 = 0.25;
/// Greatest ratio of a span to the previous one over which the parabola is extrapolated [-]; beyond, the velocity alone.
const RATIO_MAX: f64 = 4.0;

#[derive(Debug)]
pub(super) struct SeaWork {
    /// Best vector unit of this machine; results do not depend on it.
    unit: VectorUnit,
    /// Wave phases at one time, per thread.
    instants: Vec<Instant>,
    /// Spans that began last.
    due: Vec<Due>,
    /// Samples at the start of the previous span, or storage for those of the next, for all lines and then all points.
    spare: Vec<Samples>,
}

/// Wave kinematics at the nodes of a line or point, and positions [m].
#[derive(Debug, Default)]
struct Samples {
    orbits: Vec<Orbit>,
    places: Vec<Vector3<f64>>,
}

#[derive(Debug)]
struct Due {
    place: Place,
    /// Length of the span [s].
    length: f64,
    /// Wave kinematics at the end of the span, and positions at its start.
    samples: Samples,
    /// Start and end of the previous span [s].
    before: [f64; 2],
}

/// Line or point on which waves act, by its number.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    Line(usize),
    Point(usize),
}

impl Place {
    /// Lines and points of a model on which waves act.
    fn of(model: &Model) -> impl Iterator<Item = Place> {
        let lines = model.lines.iter().enumerate();
        let lines = lines.filter(|(_, line)| line.heaves(model));
        let points = model.points.iter().enumerate();
        let points = points.filter(|(_, point)| point.heaves());
        lines
            .map(|(line, _)| Place::Line(line))
            .chain(points.map(|(point, _)| Place::Point(point)))
    }

    /// Index among all lines, followed by all points.
    fn slot(self, model: &Model) -> usize {
        match self {
            Place::Line(line) => line,
            Place::Point(point) => model.lines.len() + point,
        }
    }

    fn span(self, spans: &WaveSpans) -> &WaveSpan {
        match self {
            Place::Line(line) => &spans.lines[line],
            Place::Point(point) => &spans.points[point],
        }
    }

    fn span_mut(self, spans: &mut WaveSpans) -> &mut WaveSpan {
        match self {
            Place::Line(line) => &mut spans.lines[line],
            Place::Point(point) => &mut spans.points[point],
        }
    }

    /// Positions [m] and velocities [m/s] of the nodes.
    fn nodes(self, state: &State) -> (&[Vector3<f64>], &[Vector3<f64>]) {
        match self {
            Place::Line(line) => (&state.lines[line].position, &state.lines[line].velocity),
            Place::Point(point) => {
                let at = &state.points[point];
                (
                    std::slice::from_ref(&at.position),
                    std::slice::from_ref(&at.velocity),
                )
            }
        }
    }

    /// Longest time between samples [s].
    fn interval(self, waves: &Waves, state: &State) -> f64 {
        let heights = self.nodes(state).0.iter().map(|position| position.z);
        let share = match self {
            Place::Line(_) => 1.0,
            Place::Point(_) => POINT,
        };
        share * waves.interval_below(heights.fold(f64::NEG_INFINITY, f64::max))
    }
}

impl Clone for SeaWork {
    fn clone(&self) -> SeaWork {
        SeaWork::new()
    }
}

impl SeaWork {
    pub(super) fn new() -> SeaWork {
        SeaWork {
            unit: VectorUnit::best(),
            instants: vec![Instant::default()],
            due: Vec::new(),
            spare: Vec::new(),
        }
    }

    /// Samples the waves at the time of a state; leaves the state unchanged if the model has no waves.
    pub(super) fn start(&mut self, model: &Model, state: &mut State) {
        let Some(waves) = &model.waves else {
            return;
        };
        let mut spans = WaveSpans::default();
        spans.lines.resize_with(model.lines.len(), WaveSpan::default);
        spans.points.resize_with(model.points.len(), WaveSpan::default);
        for place in Place::of(model) {
            let span = place.span_mut(&mut spans);
            self.begin(waves, state, place, span);
        }
        state.waves = Some(spans);
    }

    /// Begins a span of zero length at the time of the state.
    fn begin(&mut self, waves: &Waves, state: &State, place: Place, span: &mut WaveSpan) {
        let nodes = Nodes {
            now: place.nodes(state),
            before: None,
        };
        let mut first = Samples {
            orbits: std::mem::take(&mut span.ends[0]),
            places: std::mem::take(&mut span.places),
        };
        sample(
            waves,
            (state.time, 0.0),
            nodes,
            &mut first,
            (self.unit, &mut self.instants[0]),
        );
        span.ends[1].clone_from(&first.orbits);
        (span.ends[0], span.places) = (first.orbits, first.places);
        span.times = [state.time; 2];
    }

    /// Length of the next part [s] of a step of `length` [s]: the part does not extend beyond the end of a span, except by
    /// rounding.
    pub(super) fn reach(&self, model: &Model, waves: &Waves, state: &State, length: f64) -> f64 {
        let parts = length / waves.interval_below(f64::INFINITY) - ROUNDING;
        let part = length / parts.ceil().max(1.0);
        let left = Place::of(model).map(|place| left(place, state, length));
        let shorter = left.filter(|left| *left > 0.0 && *left < (1.0 - ROUNDING) * part);
        shorter.fold(part, f64::min)
    }

    /// Begins new spans where old ones have ended, for steps of `step` [s], on `threads` threads of a pool; returns whether
    /// there were any.
    pub(super) fn renew(
        &mut self,
        (model, waves): (&Model, &Waves),
        state: &mut State,
        step: f64,
        (pool, threads): (&mut ThreadPool, usize),
    ) -> bool {
        self.due.clear();
        self.spare
            .resize_with(model.lines.len() + model.points.len(), Samples::default);
        for place in Place::of(model) {
            if left(place, state, step) > 0.0 {
                continue;
            }
            let steps = (place.interval(waves, state) / step + ROUNDING).floor().max(1.0);
            self.due.push(Due {
                place,
                length: steps * step,
                samples: std::mem::take(&mut self.spare[place.slot(model)]),
                before: [0.0; 2],
            });
        }
        self.sample_due(waves, state, (pool, threads));
        let Some(mut spans) = state.waves.take() else {
            return false;
        };
        for k in 0..self.due.len() {
            let place = self.due[k].place;
            let span = place.span_mut(&mut spans);
            if (span.times[1] - state.time).abs() > ROUNDING * step {
                self.begin(waves, state, place, span);
            }
            let due = &mut self.due[k];
            due.before = span.times;
            span.times = [state.time, state.time + due.length];
            span.ends.swap(0, 1);
            std::mem::swap(&mut span.ends[1], &mut due.samples.orbits);
            std::mem::swap(&mut span.places, &mut due.samples.places);
            self.spare[place.slot(model)] = std::mem::take(&mut due.samples);
        }
        state.waves = Some(spans);
        !self.due.is_empty()
    }

    /// Undoes the last [`Self::renew`]: restores the previous spans.
    pub(super) fn undo(&mut self, model: &Model, state: &mut State) {
        let Some(spans) = &mut state.waves else {
            return;
        };
        for due in self.due.drain(..) {
            let span = due.place.span_mut(spans);
            let spare = &mut self.spare[due.place.slot(model)];
            std::mem::swap(&mut span.ends[1], &mut spare.orbits);
            std::mem::swap(&mut span.places, &mut spare.places);
            span.ends.swap(0, 1);
            span.times = due.before;
        }
    }

    fn sample_due(&mut self, waves: &Waves, state: &State, (pool, threads): (&mut ThreadPool, usize)) {
        // spans of equal length are adjacent, so that a thread evaluates the wave phases once for their common end
        let by_length = |a: &Due, b: &Due| a.length.total_cmp(&b.length);
        self.due.sort_unstable_by(by_length);
        let unit = self.unit;
        let work = |_, part: &mut [Due], instant: &mut Instant| {
            for due in part {
                let times = (state.time, due.length);
                let before = before(due.place, state);
                let nodes = Nodes {
                    now: due.place.nodes(state),
                    before: before.filter(|(_, since)| due.length <= RATIO_MAX * since),
                };
                sample(waves, times, nodes, &mut due.samples, (unit, instant));
            }
        };
        self.instants
            .resize_with(threads.max(self.instants.len()), Instant::default);
        pool.share(&mut self.due, &mut self.instants[..threads], work);
    }
}

/// Motion of the nodes of a line or point.
#[derive(Debug, Clone, Copy)]
struct Nodes<'a> {
    /// Positions [m] and velocities [m/s].
    now: (&'a [Vector3<f64>], &'a [Vector3<f64>]),
    /// Positions at an earlier time [m], and the time since then [s].
    before: Option<(&'a [Vector3<f64>], f64)>,
}

impl Nodes<'_> {
    /// Position of a node [m] after `ahead` [s].
    #[inline(always)]
    fn ahead(&self, node: usize, ahead: f64) -> Vector3<f64> {
        let (position, velocity) = (self.now.0[node], self.now.1[node]);
        let straight = position + ahead * velocity;
        match self.before {
            Some((before, since)) => {
                let part = ahead / since;
                straight + part * part * (since * velocity - (position - before[node]))
            }
            None => straight,
        }
    }
}

/// Positions at the start of the span of a line or point [m], and the time since then [s], if the span ends at the time of the state.
fn before(place: Place, state: &State) -> Option<(&[Vector3<f64>], f64)> {
    let span = place.span(state.waves.as_ref()?);
    let length = span.length();
    (length > 0.0 && (span.times[1] - state.time).abs() <= ROUNDING * length)
        .then_some((&span.places, length))
}

/// Evaluates the wave kinematics at `time + ahead` [s], at positions extrapolated from the motion of the nodes at `time`, and keeps their positions
/// then.
fn sample(
    waves: &Waves,
    (time, ahead): (f64, f64),
    nodes: Nodes,
    found: &mut Samples,
    (unit, instant): (VectorUnit, &mut Instant),
) {
    waves.turn_to(time + ahead, instant);
    let (position, _) = nodes.now;
    found.orbits.clear();
    found.orbits.resize(position.len(), Orbit::default());
    found.places.clear();
    found.places.extend_from_slice(position);
    unit.dispatch(Sampling {
        waves,
        nodes,
        ahead,
        orbits: &mut found.orbits,
        instant,
    });
}

/// Time to the end of the span of a line or point [s]; 0 if the span has ended or not begun.
fn left(place: Place, state: &State, step: f64) -> f64 {
    let rounding = ROUNDING * step;
    let span = state.waves.as_ref().map(|spans| place.span(spans));
    match span {
        Some(span) if state.time >= span.times[0] - rounding => {
            let left = span.times[1] - state.time;
            if left > rounding { left } else { 0.0 }
        }
        _ => 0.0,
    }
}

struct Sampling<'a> {
    waves: &'a Waves,
    nodes: Nodes<'a>,
    /// [s]
    ahead: f64,
    orbits: &'a mut [Orbit],
    instant: &'a mut Instant,
}

impl NullaryFnOnce for Sampling<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        // a closure would not be compiled for the vector unit
        for (k, orbits) in self.orbits.chunks_mut(LANES).enumerate() {
            let places = std::array::from_fn(|lane| {
                let node = LANES * k + lane.min(orbits.len() - 1);
                self.nodes.ahead(node, self.ahead)
            });
            let found = self.waves.orbits(places, self.instant);
            orbits.copy_from_slice(&found[..orbits.len()]);
        }
    }
}
