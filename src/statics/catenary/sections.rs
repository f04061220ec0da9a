//! A line of several sections, with or without a bed under it: a march from A to B, nested in one scalar search.
//!
//! Given the horizontal tension at A the line is laid out piece by piece. From A (or from the bed) it flies on; the one free number
//! of a flight, its vertical tension at A or the weight left on the bed before it lifts off, is the greatest for which
//! it runs nowhere below the bed and ends nowhere below B: a monotone function, one root. The first
//! constraint that holds with equality says where the flight ends: at B, or touching down (V = 0) in the section concerned,
//! from which it lies until it lifts off again. This is gift wrapping, so any number of sections may float or sink and any number
//! of stretches may lie on the bed.
//!
//! The span that results grows with the tension at A, which is found on a logarithmic scale. With friction and no
//! tension left at A, the number searched is instead the material point s₀ up to which the bed holds all tension.
//! If the line is longer than its span even without any tension, it is slack: H = 0.
//!
//! Derived here. Without friction the result is the unique minimum of a convex energy; with friction the bed pulls towards A, as
//! on a line that was laid from A and hauled at B.

use super::flight::Flight;
use super::root;
use super::shape::Shape;
use super::uniform::Held;
use super::{Bed, Section};

/// Horizontal tension that stands for the limit of none, over the weights of the sections [-].
const LIMP_SHARE: f64 = 1e-40;

/// Tension that counts as none, over the weights of the sections [-].
const NOTHING_SHARE: f64 = 1e-30;

/// Position error that counts as none, over the unstretched length [-].
const CLOSURE: f64 = 1e-16;

/// Where the vertical tension at a section's end is below this share of the unknown one, it becomes the unknown [-].
const REFERENCE_SHARE: f64 = 1e-3;

/// A line of sections between two held ends.
pub(super) struct Sections<'a> {
    sections: &'a [Section],
    /// Weight before each section, and of all [N].
    before: Vec<f64>,
    span: f64,
    rise: f64,
    bed: Option<Bed>,
    length: f64,
    /// Σ |w| L [N].
    weights: f64,
}

/// The place and force with which a flight starts.
#[derive(Debug, Clone, Copy)]
struct Departure {
    section: usize,
    /// Distance from the start of that section [m].
    offset: f64,
    /// Height relative to A [m].
    z: f64,
    horizontal: f64,
    /// Vertical tension at the start of section `reference` [N], the end of the line being the last.
    vertical: f64,
    /// Chosen where the vertical tension is small, so that it is known there to all its digits.
    reference: usize,
    /// Whether it leaves the bed: there V = 0.
    from_bed: bool,
}

/// The tightest constraint of a flight.
#[derive(Debug, Clone, Copy)]
struct Flown {
    /// Height to spare over it [m].
    gap: f64,
    /// ∂gap/∂V [m/N].
    by_vertical: f64,
    /// ∂gap/∂H [m/N].
    by_horizontal: f64,
    /// None: end B; else the section touching down and the distance from its start [m].
    touch: Option<(usize, f64)>,
}

/// What the outer search changes.
#[derive(Debug, Clone, Copy)]
struct Hold {
    /// Horizontal tension at A [N].
    horizontal_a: f64,
    /// Arc length before which nothing on the bed carries tension, where none is left at A [m].
    tight_from: f64,
}

/// Root and reference of each flight, from which its next search starts.
type Memory = Vec<Option<(f64, usize)>>;

impl<'a> Sections<'a> {
    pub fn new(sections: &'a [Section], span: f64, rise: f64, bed: Option<Bed>) -> Self {
        let mut before = vec![0.0];
        for section in sections {
            before.push(before[before.len() - 1] + section.weight * section.length);
        }
        Sections {
            sections,
            before,
            span,
            rise,
            bed,
            length: sections.iter().map(|s| s.length).sum(),
            weights: sections.iter().map(|s| s.weight.abs() * s.length).sum(),
        }
    }

    /// Solves the line, from a guess of H and V at A [N]; leaves its pieces in `shape`.
    pub fn solve(&self, guess: (f64, f64), shape: &mut Shape) -> Held {
        let tolerance = CLOSURE * self.length;
        let lowest = self.limp();
        let mut memory: Memory = vec![Some((guess.1, 0))];
        let mut miss = |horizontal_a: f64, tight_from: f64| {
            self.lay_out(Hold { horizontal_a, tight_from }, &mut memory, shape) - self.span
        };
        let mut steps = 1;
        let limp_miss = miss(lowest, 0.0);
        if limp_miss < 0.0 {
            let start = guess.0.max(1e-3 * self.weights);
            let root = root::increasing_by_ratio(|h| miss(h, 0.0), start, lowest, tolerance);
            steps += root.steps;
            miss(root.at, 0.0);
        } else {
            let slack_miss = miss(lowest, self.length);
            if slack_miss < 0.0 {
                let ends = ((0.0, limp_miss), (self.length, slack_miss));
                let root = root::between(|s| miss(lowest, s), ends.0, ends.1, tolerance);
                steps += root.steps;
                miss(lowest, root.at);
            }
        }
        shape.relax(NOTHING_SHARE * self.weights);
        shape.close(self.span);
        let (a, b) = (shape.at(0.0), shape.at(self.length));
        Held {
            horizontal_a: a.horizontal,
            horizontal_b: b.horizontal,
            vertical_a: a.vertical,
            vertical_b: b.vertical,
            steps,
        }
    }

    /// Horizontal tension that stands for the limit of none [N].
    fn limp(&self) -> f64 {
        LIMP_SHARE * self.weights
    }

    /// Lays the line out under `hold`; returns the x of its end [m].
    fn lay_out(&self, hold: Hold, memory: &mut Memory, shape: &mut Shape) -> f64 {
        shape.clear();
        let mut departure = Departure {
            section: 0,
            offset: 0.0,
            z: 0.0,
            horizontal: hold.horizontal_a,
            vertical: 0.0,
            reference: 0,
            from_bed: self.bed.is_some_and(|bed| bed.height >= 0.0) && self.sections[0].weight >= 0.0,
        };
        departure.from_bed = departure.from_bed && self.fly(&departure).gap >= 0.0;
        // every touchdown lies beyond the lift-off before it, in a section of its own
        for flight in 0..=self.sections.len() {
            if memory.len() <= flight {
                memory.push(None);
            }
            departure = if departure.from_bed {
                self.lift_off(&departure, hold.tight_from, &mut memory[flight], shape)
            } else {
                self.take_off(&departure, &mut memory[flight])
            };
            let Some((section, offset)) = self.follow(&departure, shape) else {
                break;
            };
            let z = self.bed.map_or(shape.end.2, |bed| bed.height);
            departure = Departure { section, offset, z, from_bed: true, ..departure };
        }
        shape.end.1
    }

    /// The flight from the point `from` that clears every constraint by the least: its vertical tension is found.
    fn take_off(&self, from: &Departure, memory: &mut Option<(f64, usize)>) -> Departure {
        let reach = |vertical: f64| 2.0 * (vertical.abs() + from.horizontal + self.weights);
        let (mut start, mut reference) = memory.unwrap_or((0.0, from.section));
        // a second pass is enough: it only moves the reference to where V is small
        loop {
            let root = root::increasing(
                |vertical| {
                    let flown = self.fly(&Departure { vertical, reference, ..*from });
                    (flown.gap, flown.by_vertical)
                },
                start,
                (f64::NEG_INFINITY, f64::INFINITY),
                (from.horizontal, reach),
                CLOSURE * self.length,
            );
            let departure = Departure { vertical: root.at, reference, ..*from };
            let better = self.better_reference(&departure, from);
            if better.is_none() || start == root.at {
                *memory = Some((root.at, reference));
                return departure;
            }
            (start, reference) = better.unwrap_or_default();
        }
    }

    /// The flight that leaves the bed after the touchdown `from`; what stays on the bed is appended to `shape`.
    fn lift_off(
        &self,
        from: &Departure,
        tight_from: f64,
        memory: &mut Option<(f64, usize)>,
        shape: &mut Shape,
    ) -> Departure {
        let friction = self.bed.map_or(0.0, |bed| bed.friction);
        let heavy = self.sections[from.section..].iter().take_while(|section| section.weight >= 0.0);
        let run_end = from.section + heavy.count();
        // places on the bed are told by the weight before them
        let first = self.before[from.section] + self.sections[from.section].weight * from.offset;
        let last = self.before[run_end].max(first);
        let limp = if from.horizontal > self.limp() { first } else { self.weight_before(tight_from).max(first) };
        let leave = |vertical: f64, reference: usize| {
            let place = (self.before[reference] - vertical).clamp(first, last);
            let (section, offset) = self.locate(from, run_end, vertical, reference);
            let horizontal = from.horizontal + friction * (place - limp).max(0.0);
            Departure { section, offset, horizontal, vertical, reference, ..*from }
        };
        let (mut start, mut reference) = memory.unwrap_or((0.5 * (last - first), run_end));
        let departure = loop {
            let (lower, upper) = (self.before[reference] - last, self.before[reference] - first);
            if self.fly(&leave(upper, reference)).gap <= 0.0 || upper <= lower {
                break leave(upper, reference);
            }
            let root = root::increasing(
                |vertical| {
                    let departure = leave(vertical, reference);
                    let flown = self.fly(&departure);
                    let drag = if departure.horizontal > from.horizontal { friction } else { 0.0 };
                    (flown.gap, flown.by_vertical - drag * flown.by_horizontal)
                },
                start,
                (lower, upper),
                (from.horizontal, |_| upper - lower),
                CLOSURE * self.length,
            );
            let departure = leave(root.at, reference);
            let better = self.better_reference(&departure, from);
            if better.is_none() || start == root.at {
                break departure;
            }
            (start, reference) = better.unwrap_or_default();
        };
        *memory = Some((departure.vertical, departure.reference));
        self.lay(from, &departure, tight_from, friction, shape);
        departure
    }

    /// Vertical tension at the start of section `index` of a flight [N].
    fn vertical_at(&self, flight: &Departure, index: usize) -> f64 {
        flight.vertical + (self.before[index] - self.before[flight.reference])
    }

    /// A section's end, beyond where `from` the search began, where the vertical tension of the flight is so much smaller than at its reference that it is better
    /// found there: the vertical tension and the section.
    fn better_reference(&self, flight: &Departure, from: &Departure) -> Option<(f64, usize)> {
        let touch = self.fly(flight).touch.map_or(self.sections.len(), |(index, _)| index + 1);
        let first = from.section + usize::from(from.from_bed);
        let candidates = (first..=touch).map(|index| (self.vertical_at(flight, index), index));
        let best = candidates.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
        (best.1 != flight.reference && best.0.abs() < REFERENCE_SHARE * flight.vertical.abs()).then_some(best)
    }

    /// Weight of the line before arc length `s` [N].
    fn weight_before(&self, s: f64) -> f64 {
        let (mut weight, mut left) = (0.0, s);
        for section in self.sections {
            let length = left.min(section.length);
            weight += section.weight * length;
            left -= length;
        }
        weight
    }

    /// Section and offset of the lift-off after which the vertical tension at `reference` is `vertical`.
    fn locate(&self, from: &Departure, run_end: usize, vertical: f64, reference: usize) -> (usize, f64) {
        for index in from.section..run_end {
            let section = &self.sections[index];
            // weight in flight of this section
            let flown = vertical + (self.before[index + 1] - self.before[reference]);
            if flown > 0.0 && section.weight > 0.0 {
                let least = if index == from.section { from.offset } else { 0.0 };
                return (index, (section.length - flown / section.weight).clamp(least, section.length));
            }
        }
        (run_end - 1, self.sections[run_end - 1].length)
    }

    /// Appends what lies between a touchdown and the lift-off after it.
    fn lay(&self, from: &Departure, to: &Departure, tight_from: f64, friction: f64, shape: &mut Shape) {
        let (mut tension, mut offset) = (from.horizontal, from.offset);
        for index in from.section..=to.section {
            let section = &self.sections[index];
            let end = if index == to.section { to.offset } else { section.length };
            let length = end - offset;
            let slack = if tension > self.limp() { 0.0 } else { (tight_from - shape.end.0).clamp(0.0, length.max(0.0)) };
            let growth = friction * section.weight;
            shape.lay(section, slack, tension, 0.0);
            shape.lay(section, length - slack, tension, growth);
            tension += growth * (length - slack);
            offset = 0.0;
        }
    }

    /// Height to spare over the tightest constraint of the flight that starts at `from`.
    fn fly(&self, from: &Departure) -> Flown {
        let height = self.bed.map_or(f64::NEG_INFINITY, |bed| bed.height);
        let mut tightest = Flown { gap: f64::INFINITY, by_vertical: 0.0, by_horizontal: 0.0, touch: None };
        let (mut z, mut by_vertical, mut by_horizontal) = (from.z, 0.0, 0.0);
        let (mut vertical, mut offset) = (self.vertical_start(from), from.offset);
        for (index, section) in self.sections.iter().enumerate().skip(from.section) {
            let flight = Flight::of(section, section.length - offset, from.horizontal, vertical);
            let vertical_end = self.vertical_at(from, index + 1);
            if vertical < 0.0 && vertical_end >= 0.0 && height > f64::NEG_INFINITY {
                let length = (-vertical / section.weight).min(flight.length);
                let rise = flight.first(length).rise();
                let gap = z + rise.z - height;
                if gap < tightest.gap {
                    tightest = Flown {
                        gap,
                        by_vertical: by_vertical + rise.by_vertical,
                        by_horizontal: by_horizontal + rise.by_horizontal,
                        touch: Some((index, offset + length)),
                    };
                }
            }
            let rise = flight.rise();
            z += rise.z;
            by_vertical += rise.by_vertical;
            by_horizontal += rise.by_horizontal;
            (vertical, offset) = (vertical_end, 0.0);
        }
        let gap = z - self.rise;
        if gap <= tightest.gap { Flown { gap, by_vertical, by_horizontal, touch: None } } else { tightest }
    }

    /// Vertical tension at the very start of a flight [N].
    fn vertical_start(&self, from: &Departure) -> f64 {
        if from.from_bed { 0.0 } else { self.vertical_at(from, from.section) }
    }

    /// Appends the flight that starts at `from` up to where it ends; the section and offset of its touchdown, None at B.
    fn follow(&self, from: &Departure, shape: &mut Shape) -> Option<(usize, f64)> {
        let touch = self.fly(from).touch;
        let last = touch.map_or(self.sections.len() - 1, |(index, _)| index);
        let (mut vertical, mut offset) = (self.vertical_start(from), from.offset);
        for index in from.section..=last {
            let section = &self.sections[index];
            let end = touch.filter(|_| index == last).map_or(section.length, |(_, offset)| offset);
            shape.fly(section, end - offset, from.horizontal, vertical);
            (vertical, offset) = (self.vertical_at(from, index + 1), 0.0);
        }
        touch
    }
}
