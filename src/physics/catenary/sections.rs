//! Line of several sections, with or without a seabed: it is laid out from A to B, inside one scalar search.
//!
//! Given the horizontal tension at A the line is laid out piece by piece, starting with a flight from A (or from the seabed). The only unknown of a
//! flight is its vertical tension at A or the weight left on the seabed before it lifts off. It takes the value at which the flight just clears the
//! seabed and B: the root of a monotone function. The first constraint that holds with equality determines the end of the flight: at B, or touching
//! down (V = 0) in the section concerned, from where the line lies on the seabed until it lifts off again. This is gift wrapping, so any number of
//! sections may float or sink and any number of parts may lie on the seabed.
//!
//! The resulting span grows with the tension at A, which is searched on a logarithmic scale. With friction and no tension left at A, the unknown is
//! instead the material point s₀ up to which the seabed holds all tension. If the line is longer than its span even without any tension, it is slack:
//! H = 0.
//!
//! Derived here. Without friction the result is the unique minimum of a convex energy; with friction the seabed pulls towards A, as
//! on a line that was laid from A and hauled at B.

use super::flight::Flight;
use super::root;
use super::shape::Shape;
use super::uniform::EndForces;
use super::{FlatSeabed, Section};

/// Horizontal tension that represents the limit of zero, relative to the weights of the sections [-].
const LIMP_SHARE: f64 = 1e-40;

/// Tension that counts as zero, relative to the weights of the sections [-].
const NOTHING_SHARE: f64 = 1e-30;

/// Weight of a section below which it is treated as weightless, relative to the weights of all [-].
const UNFELT_SHARE: f64 = 1e-22;

/// Position error that counts as zero, relative to the unstretched length [-].
const CLOSURE: f64 = 3e-16;

/// Position error that rounding cannot explain, relative to the unstretched length [-].
const JUMP: f64 = 1e-9;

/// Maximum number of halvings of the friction; the last is below rounding.
const FRICTION_HALVINGS_MAX: usize = 60;

/// Ratio of the vertical tension at a section's end to the unknown one below which the former becomes the unknown
/// [-].
const REFERENCE_SHARE: f64 = 1e-3;

/// Maximum number of unknowns that a flight is solved for in turn.
const PASSES_MAX: usize = 8;

/// Line of sections between two held ends.
pub(super) struct Sections {
    sections: Vec<Section>,
    /// Weight of all sections before each section, and total weight [N].
    before: Vec<f64>,
    /// Arc length at the start of each section [m].
    starts: Vec<f64>,
    span: f64,
    rise: f64,
    seabed: Option<FlatSeabed>,
    length: f64,
    /// Σ |w| L [N].
    weights: f64,
}

/// Position and tension at the start of a flight.
#[derive(Debug, Clone, Copy)]
struct Departure {
    section: usize,
    /// Distance from the start of that section [m].
    offset: f64,
    /// Height relative to A [m].
    z: f64,
    horizontal: f64,
    /// Vertical tension at the start of section `reference` [N]; after the last section, at the end of the line.
    vertical: f64,
    /// Section at whose start the vertical tension is small, so that it is resolved there to all its digits.
    reference: usize,
    /// True if the flight leaves the seabed, where V = 0.
    from_seabed: bool,
}

/// End of a flight: `None` at B, else the section of the touchdown and the distance from its start [m].
type Touch = Option<(usize, f64)>;

/// Tightest constraint of a flight.
#[derive(Debug, Clone, Copy)]
struct Flown {
    /// Clearance of the constraint [m].
    gap: f64,
    /// ∂gap/∂V [m/N].
    by_vertical: f64,
    /// ∂gap/∂H [m/N].
    by_horizontal: f64,
    touch: Touch,
}

/// Sections that do not float, after a touchdown in the first of them.
#[derive(Debug, Clone, Copy)]
struct Run {
    /// First section beyond these.
    end: usize,
    /// Weight before the touchdown, which identifies its position [N].
    first: f64,
    /// Weight before the end [N].
    last: f64,
    /// First section with tension.
    tight: usize,
    /// Length from the start of tension to the end of that section [m].
    rest: f64,
}

/// Variables of the outer search.
#[derive(Debug, Clone, Copy)]
struct Hold {
    /// Horizontal tension at A [N].
    horizontal_a: f64,
    /// Arc length before which the line on the seabed carries no tension, if none is left at A [m].
    tight_from: f64,
}

/// Root and reference of each flight, from which its next search starts.
type Memory = Vec<Option<(f64, usize)>>;

impl Sections {
    pub(super) fn new(sections: &[Section], span: f64, rise: f64, seabed: Option<FlatSeabed>) -> Self {
        let weights: f64 = sections.iter().map(|s| s.weight.abs() * s.length).sum();
        let felt = |s: &Section| s.weight.abs() * s.length > UNFELT_SHARE * weights;
        let unweighted = |s: &Section| Section { weight: 0.0, ..*s };
        let sections: Vec<Section> = sections
            .iter()
            .map(|s| if felt(s) { *s } else { unweighted(s) })
            .collect();
        let (mut before, mut starts) = (vec![0.0], vec![0.0]);
        for (index, section) in sections.iter().enumerate() {
            before.push(before[index] + section.weight * section.length);
            starts.push(starts[index] + section.length);
        }
        let length = starts[sections.len()];
        Sections {
            sections,
            before,
            starts,
            span,
            rise,
            seabed,
            length,
            weights,
        }
    }

    /// Solves the line, from a guess of H and V at A [N]; leaves its pieces in `shape`.
    ///
    /// With sections that float, strong friction can leave a span without a state that mobilises friction in full. Coulomb's law is an inequality:
    /// friction is then halved until the ends meet.
    pub(super) fn solve(&mut self, guess: (f64, f64), shape: &mut Shape) -> EndForces {
        let mut steps = 0;
        for _ in 0..FRICTION_HALVINGS_MAX {
            steps += self.search(guess, shape);
            if (shape.end.1 - self.span).abs() <= JUMP * self.length || self.friction() == 0.0 {
                break;
            }
            self.seabed = self.seabed.map(|seabed| FlatSeabed {
                friction: 0.5 * seabed.friction,
                ..seabed
            });
        }
        let (a, b) = (shape.at(0.0), shape.at(self.length));
        EndForces {
            horizontal_a: a.horizontal,
            horizontal_b: b.horizontal,
            vertical_a: a.vertical,
            vertical_b: b.vertical,
            friction: self.friction(),
            steps,
        }
    }

    /// Searches the tension at A, or else the point where tension begins, for which the line ends at B; returns the number of steps.
    fn search(&self, guess: (f64, f64), shape: &mut Shape) -> usize {
        let tolerance = CLOSURE * self.length;
        let lowest = self.limp();
        let mut memory: Memory = vec![Some((guess.1, 0))];
        let mut miss = |horizontal_a: f64, tight_from: f64| {
            self.lay_out(
                Hold {
                    horizontal_a,
                    tight_from,
                },
                &mut memory,
                shape,
            ) - self.span
        };
        let start = if guess.0 > 0.0 {
            guess.0
        } else {
            1e-3 * self.weights
        };
        let root = root::increasing_by_ratio(|h| miss(h, 0.0), start, lowest, tolerance);
        let mut steps = root.steps;
        let limp_miss = miss(root.at, 0.0);
        if root.at == lowest && limp_miss > 0.0 {
            let slack_miss = miss(lowest, self.length);
            if slack_miss < 0.0 {
                let ends = ((0.0, limp_miss), (self.length, slack_miss));
                let root = root::between(|s| miss(lowest, s), ends.0, ends.1, (tolerance, self.length));
                steps += root.steps;
                miss(lowest, root.at);
            }
        }
        shape.relax(NOTHING_SHARE * self.weights);
        shape.close(self.span);
        steps
    }

    /// Horizontal tension that represents the limit of zero [N].
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
            from_seabed: self.seabed.is_some_and(|seabed| seabed.height >= 0.0)
                && self.sections[0].weight >= 0.0,
        };
        departure.from_seabed = departure.from_seabed && self.fly(&departure).gap >= 0.0;
        // every touchdown lies beyond the lift-off before it, in a separate section
        for flight in 0..=self.sections.len() {
            if memory.len() <= flight {
                memory.push(None);
            }
            let (flying, touch) = if departure.from_seabed {
                let (lifted, touch) = self.lift_off(&departure, hold.tight_from, &mut memory[flight]);
                self.lay(&departure, &lifted, hold.tight_from, shape);
                (lifted, touch)
            } else {
                self.take_off(&departure, &mut memory[flight])
            };
            self.follow(&flying, touch, shape);
            let Some((section, offset)) = touch else {
                break;
            };
            let z = self.seabed.map_or(shape.end.2, |seabed| seabed.height);
            departure = Departure {
                section,
                offset,
                z,
                from_seabed: true,
                ..flying
            };
        }
        shape.end.1
    }

    /// Finds the flight from the point `from` that just clears every constraint, by its vertical tension.
    fn take_off(&self, from: &Departure, memory: &mut Option<(f64, usize)>) -> (Departure, Touch) {
        let reach = |vertical: f64| 2.0 * (vertical.abs() + from.horizontal + self.weights);
        let (mut start, mut reference) = memory.unwrap_or((0.0, from.section));
        let mut passes = 0;
        // a second pass is usually enough: it only moves the reference to where V is small
        loop {
            passes += 1;
            let root = root::increasing(
                |vertical| {
                    let flown = self.fly(&Departure {
                        vertical,
                        reference,
                        ..*from
                    });
                    (flown.gap, flown.by_vertical)
                },
                start,
                (f64::NEG_INFINITY, f64::INFINITY),
                (from.horizontal, reach),
                CLOSURE * self.length,
            );
            let departure = Departure {
                vertical: root.at,
                reference,
                ..*from
            };
            let flown = self.fly(&departure);
            let better = self.better_reference(&departure, from, &flown);
            if better.is_none() || start == root.at || passes == PASSES_MAX {
                *memory = Some((root.at, reference));
                return (departure, flown.touch);
            }
            (start, reference) = better.unwrap_or_default();
        }
    }

    /// Finds the flight that leaves the seabed after the touchdown `from` where it just clears every constraint.
    fn lift_off(
        &self,
        from: &Departure,
        tight_from: f64,
        memory: &mut Option<(f64, usize)>,
    ) -> (Departure, Touch) {
        let run = self.run(from, tight_from);
        // the rise to B is quadratic in V there, so a search would leave an error in V of the square root of its tolerance
        let ends_on_seabed =
            run.end == self.sections.len() && self.seabed.is_some_and(|seabed| self.rise <= seabed.height);
        let (mut start, mut reference) = memory.unwrap_or((0.5 * (run.last - run.first), run.end));
        let mut passes = 0;
        loop {
            passes += 1;
            let lower = self.before[reference] - run.last;
            let upper = self.before[reference] - run.first;
            let all_lifted = self.leave(from, &run, upper, reference);
            let flown = self.fly(&all_lifted);
            if flown.gap <= 0.0 || upper <= lower {
                return (all_lifted, flown.touch);
            }
            if ends_on_seabed {
                return (self.leave(from, &run, lower, reference), None);
            }
            let root = root::increasing(
                |vertical| {
                    let departure = self.leave(from, &run, vertical, reference);
                    let flown = self.fly(&departure);
                    let dragged = departure.horizontal > from.horizontal;
                    let drag = if dragged { self.friction() } else { 0.0 };
                    (flown.gap, flown.by_vertical - drag * flown.by_horizontal)
                },
                start,
                (lower, upper),
                (from.horizontal, |_| upper - lower),
                CLOSURE * self.length,
            );
            let departure = self.leave(from, &run, root.at, reference);
            let flown = self.fly(&departure);
            let better = self.better_reference(&departure, from, &flown);
            if better.is_none() || start == root.at || passes == PASSES_MAX {
                *memory = Some((root.at, reference));
                return (departure, flown.touch);
            }
            (start, reference) = better.unwrap_or_default();
        }
    }

    /// Part that may lie on the seabed from the touchdown `from` on.
    fn run(&self, from: &Departure, tight_from: f64) -> Run {
        let sections = self.sections[from.section..].iter();
        let heavy = sections.take_while(|section| section.weight >= 0.0);
        let end = from.section + heavy.count();
        let first = self.before[from.section] + self.sections[from.section].weight * from.offset;
        let last = self.before[end].max(first);
        let (tight, rest) = self.tight_place(tight_from, from, end);
        Run {
            end,
            first,
            last,
            tight,
            rest,
        }
    }

    /// Flight that leaves the seabed where this makes the vertical tension at `reference` equal to `vertical`.
    fn leave(&self, from: &Departure, run: &Run, vertical: f64, reference: usize) -> Departure {
        let (section, offset) = self.locate(from, run.end, vertical, reference);
        let to_reference = self.before[reference] - self.before[run.tight + 1];
        let beyond = to_reference + self.sections[run.tight].weight * run.rest;
        let horizontal = from.horizontal + self.friction() * (beyond - vertical).max(0.0);
        Departure {
            section,
            offset,
            horizontal,
            vertical,
            reference,
            ..*from
        }
    }

    fn friction(&self) -> f64 {
        self.seabed.map_or(0.0, |seabed| seabed.friction)
    }

    /// Vertical tension at the start of section `index` of a flight [N].
    fn vertical_at(&self, flight: &Departure, index: usize) -> f64 {
        flight.vertical + (self.before[index] - self.before[flight.reference])
    }

    /// Section end after the start `from` at which the vertical tension of the flight is so much smaller than at its reference that it is better
    /// solved for there: that tension [N] and the index of the section.
    fn better_reference(&self, flight: &Departure, from: &Departure, flown: &Flown) -> Option<(f64, usize)> {
        // if the gap jumps over zero, the flight does not end at its apparent touchdown
        let ends = flown.touch.filter(|_| flown.gap.abs() < JUMP * self.length);
        let last = ends.map_or(self.sections.len(), |(index, _)| index + 1);
        let first = from.section + usize::from(from.from_seabed);
        let candidates = (first..=last).map(|index| (self.vertical_at(flight, index), index));
        let best = candidates.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))?;
        (best.1 != flight.reference && best.0.abs() < REFERENCE_SHARE * flight.vertical.abs()).then_some(best)
    }

    /// Start of tension on the seabed after the touchdown `from`: a section and the length between there and its end
    /// [m].
    fn tight_place(&self, tight_from: f64, from: &Departure, run_end: usize) -> (usize, f64) {
        let whole = (from.section, self.sections[from.section].length - from.offset);
        if from.horizontal > self.limp() {
            return whole;
        }
        let ends = from.section + 1..=run_end;
        match ends.into_iter().find(|&end| tight_from < self.starts[end]) {
            None => (run_end - 1, 0.0),
            Some(end) if end - 1 == from.section => (end - 1, whole.1.min(self.starts[end] - tight_from)),
            Some(end) => (
                end - 1,
                self.sections[end - 1].length.min(self.starts[end] - tight_from),
            ),
        }
    }

    /// Section and offset of the lift-off for which the vertical tension at `reference` is `vertical`.
    fn locate(&self, from: &Departure, run_end: usize, vertical: f64, reference: usize) -> (usize, f64) {
        for index in from.section..run_end {
            let section = &self.sections[index];
            // weight of this section in flight
            let flown = vertical + (self.before[index + 1] - self.before[reference]);
            if flown > 0.0 && section.weight > 0.0 {
                let least = if index == from.section { from.offset } else { 0.0 };
                return (
                    index,
                    (section.length - flown / section.weight).clamp(least, section.length),
                );
            }
        }
        (run_end - 1, self.sections[run_end - 1].length)
    }

    /// Appends the pieces between a touchdown and the lift-off after it.
    fn lay(&self, from: &Departure, to: &Departure, tight_from: f64, shape: &mut Shape) {
        let friction = self.friction();
        let (mut tension, mut offset) = (from.horizontal, from.offset);
        for index in from.section..=to.section {
            let section = &self.sections[index];
            let end = if index == to.section {
                to.offset
            } else {
                section.length
            };
            let length = end - offset;
            let slack = if tension > self.limp() {
                0.0
            } else {
                (tight_from - shape.end.0).clamp(0.0, length.max(0.0))
            };
            let growth = friction * section.weight;
            shape.lay(section, slack, tension, 0.0);
            shape.lay(section, length - slack, tension, growth);
            tension += growth * (length - slack);
            offset = 0.0;
        }
    }

    /// Clearance of the tightest constraint of the flight that starts at `from`.
    fn fly(&self, from: &Departure) -> Flown {
        let height = self.seabed.map_or(f64::NEG_INFINITY, |seabed| seabed.height);
        let mut tightest = Flown {
            gap: f64::INFINITY,
            by_vertical: 0.0,
            by_horizontal: 0.0,
            touch: None,
        };
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
        if gap <= tightest.gap {
            Flown {
                gap,
                by_vertical,
                by_horizontal,
                touch: None,
            }
        } else {
            tightest
        }
    }

    /// Vertical tension at the very start of a flight [N].
    fn vertical_start(&self, from: &Departure) -> f64 {
        if from.from_seabed {
            0.0
        } else {
            self.vertical_at(from, from.section)
        }
    }

    /// Appends the flight that starts at `from`, up to its `touch` or to B.
    fn follow(&self, from: &Departure, touch: Touch, shape: &mut Shape) {
        let last = touch.map_or(self.sections.len() - 1, |(index, _)| index);
        let (mut vertical, mut offset) = (self.vertical_start(from), from.offset);
        for index in from.section..=last {
            let section = &self.sections[index];
            let end = touch
                .filter(|_| index == last)
                .map_or(section.length, |(_, offset)| offset);
            shape.fly(section, end - offset, from.horizontal, vertical);
            (vertical, offset) = (self.vertical_at(from, index + 1), 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FlatSeabed, section, solve};
    use super::{Sections, Shape};

    #[test]
    fn the_march_agrees_with_the_uniform_line_on_every_kind_of_it() {
        let seabed = |height, friction| Some(FlatSeabed { height, friction });
        for (weight, ea, span, rise, seabed) in [
            (50.0, 1e7, 80.0, 30.0, None),
            (50.0, 1e3, 130.0, -20.0, None),
            (-50.0, 1e7, 60.0, 30.0, seabed(0.0, 0.4)),
            (50.0, 1e9, 88.0, 30.0, seabed(0.0, 0.0)),
            (50.0, 1e9, 88.0, 30.0, seabed(0.0, 0.8)),
            (50.0, 1e6, 75.0, 10.0, seabed(-12.0, 0.0)),
            (50.0, 1e6, 20.0, 10.0, seabed(-12.0, 0.0)),
            (50.0, 1e6, 0.0, -60.0, None),
        ] {
            let parts = [0.3, 0.2, 0.5].map(|share| section(100.0 * share, weight, ea));
            let uniform = solve(&[section(100.0, weight, ea)], span, rise, seabed).expect("a line");
            let mut shape = Shape::default();
            let held = Sections::new(&parts, span, rise, seabed).solve((0.0, 0.0), &mut shape);
            let tolerance = 1e-12 * (uniform.tension_b() + uniform.tension_a());
            for (found, wanted) in [
                (held.horizontal_b, uniform.horizontal()),
                (held.horizontal_a, uniform.horizontal_a()),
                (held.vertical_a, uniform.vertical_a()),
                (held.vertical_b, uniform.vertical_b()),
            ] {
                assert!((found - wanted).abs() < tolerance, "{held:?} {uniform:?}");
            }
        }
    }

    #[test]
    fn a_lazy_wave_may_lie_on_the_seabed_twice() {
        let heavy = |length| section(length, 30.0, 1e8);
        let sections = [heavy(150.0), section(40.0, -40.0, 1e8), heavy(200.0)];
        let (height, friction) = (0.0, 0.0);
        let line = solve(&sections, 300.0, 60.0, Some(FlatSeabed { height, friction })).expect("a line");
        let lifted = |s: f64| line.at(s).z > 1.0;
        assert!(!lifted(50.0) && lifted(170.0) && !lifted(280.0) && lifted(380.0));
        assert!(line.laid().count() >= 2);
    }
}
