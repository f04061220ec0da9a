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
use super::shape::{Kind, Shape};
use super::uniform::Held;
use super::{Bed, Section};

/// Horizontal tension taken for zero, over the weights of the sections [-].
const HORIZONTAL_SHARE_MIN: f64 = 1e-40;

/// Position error that counts as none, over the unstretched length [-].
const CLOSURE: f64 = 1e-16;

/// A line of sections between two held ends.
pub(super) struct Sections<'a> {
    sections: &'a [Section],
    span: f64,
    rise: f64,
    bed: Option<Bed>,
    length: f64,
    /// Σ |w| L [N].
    weights: f64,
    /// Σ L/EA [m/N].
    flexibility: f64,
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
    vertical: f64,
}

/// The tightest constraint of a flight.
#[derive(Debug, Clone, Copy)]
struct Flown {
    /// Height to spare over it [m].
    gap: f64,
    by_vertical: f64,
    by_horizontal: f64,
    /// None: end B; else the section touching down and the distance from its start [m].
    touch: Option<(usize, f64)>,
}

/// What a search changes.
#[derive(Debug, Clone, Copy)]
struct Hold {
    /// Horizontal tension at A [N].
    horizontal_a: f64,
    /// Arc length before which nothing on the bed carries tension [m].
    tight_from: f64,
}

/// What the march remembers to start its next searches near their roots.
#[derive(Debug, Default, Clone)]
struct Memory {
    roots: Vec<f64>,
}

impl<'a> Sections<'a> {
    pub fn new(sections: &'a [Section], span: f64, rise: f64, bed: Option<Bed>) -> Self {
        Sections {
            sections,
            span,
            rise,
            bed,
            length: sections.iter().map(|s| s.length).sum(),
            weights: sections.iter().map(|s| s.weight.abs() * s.length).sum(),
            flexibility: sections.iter().map(|s| s.length / s.axial_stiffness).sum(),
        }
    }

    /// Solves the line, from a guess of H and V at A [N]; leaves its pieces in `shape`.
    pub fn solve(&self, guess: (f64, f64), shape: &mut Shape) -> Held {
        let tolerance = CLOSURE * self.length;
        let mut memory = Memory {
            roots: vec![guess.1],
        };
        let mut steps = 1;
        let limp = Hold {
            horizontal_a: 0.0,
            tight_from: 0.0,
        };
        let mut limp_memory = Memory {
            roots: vec![guess.1],
        };
        let limp_miss = self.lay_out(limp, &mut limp_memory, shape) - self.span;
        if limp_miss < 0.0 {
            let lowest =
                HORIZONTAL_SHARE_MIN * self.weights.max(f64::MIN_POSITIVE / HORIZONTAL_SHARE_MIN);
            let start = guess.0.max(1e-3 * self.weights).max(lowest);
            let miss = |h: f64| {
                let hold = Hold {
                    horizontal_a: h,
                    tight_from: 0.0,
                };
                self.lay_out(hold, &mut memory, shape) - self.span
            };
            let root = root::increasing_by_ratio(miss, start, lowest, tolerance);
            steps += root.steps;
            self.lay_out(
                Hold {
                    horizontal_a: root.at,
                    tight_from: 0.0,
                },
                &mut memory,
                shape,
            );
        } else if limp_miss > 0.0 {
            memory = limp_memory;
            let mut miss = |s: f64| {
                let hold = Hold {
                    horizontal_a: 0.0,
                    tight_from: s,
                };
                self.lay_out(hold, &mut memory, shape) - self.span
            };
            let slack_miss = miss(self.length);
            if slack_miss < 0.0 {
                let root = root::between(
                    &mut miss,
                    (0.0, limp_miss),
                    (self.length, slack_miss),
                    tolerance,
                );
                steps += root.steps;
                miss(root.at);
            }
        }
        shape.close(self.span, self.rise);
        self.held(shape, steps)
    }

    fn held(&self, shape: &Shape, steps: usize) -> Held {
        let (a, b) = (shape.at(0.0), shape.at(self.length));
        Held {
            horizontal_a: a.horizontal,
            horizontal_b: b.horizontal,
            vertical_a: a.vertical,
            vertical_b: b.vertical,
            steps,
        }
    }

    /// Lays the line out under `hold`; returns the x of its end [m].
    fn lay_out(&self, hold: Hold, memory: &mut Memory, shape: &mut Shape) -> f64 {
        shape.clear();
        let (section, horizontal) = (0, hold.horizontal_a);
        let mut departure = Departure {
            section,
            offset: 0.0,
            z: 0.0,
            horizontal,
            vertical: 0.0,
        };
        let mut on_bed = self.bed.is_some_and(|bed| bed.height >= 0.0)
            && self.sections[0].weight >= 0.0
            && self.fly(&departure).gap >= 0.0;
        // every touchdown is in a later section than the lift-off before it
        for flight in 0..=self.sections.len() {
            if memory.roots.len() <= flight {
                memory.roots.push(0.0);
            }
            let guess = &mut memory.roots[flight];
            let lifted = if on_bed {
                let hold = self.lift_off(&departure, hold.tight_from, guess, shape);
                Departure { ..hold }
            } else {
                self.take_off(&departure, guess)
            };
            let Some((section, offset)) = self.follow(&lifted, shape) else {
                break;
            };
            let z = self.bed.map_or(shape.end.2, |bed| bed.height);
            departure = Departure {
                section,
                offset,
                z,
                vertical: 0.0,
                horizontal: lifted.horizontal,
            };
            on_bed = true;
        }
        shape.end.1
    }

    /// The flight from the point `from` that clears every constraint by the least: its vertical tension is found.
    fn take_off(&self, from: &Departure, guess: &mut f64) -> Departure {
        let scale = from.horizontal + self.weights;
        let root = root::increasing(
            |vertical| {
                let flown = self.fly(&Departure { vertical, ..*from });
                (flown.gap, flown.by_vertical)
            },
            *guess,
            (f64::NEG_INFINITY, f64::INFINITY),
            |vertical| 2.0 * (vertical.abs() + scale) + f64::MIN_POSITIVE,
            CLOSURE * self.length,
        );
        *guess = root.at;
        Departure {
            vertical: root.at,
            ..*from
        }
    }

    /// The flight that leaves the bed after the touchdown `from`; what stays on the bed is appended to `shape`.
    fn lift_off(
        &self,
        from: &Departure,
        tight_from: f64,
        guess: &mut f64,
        shape: &mut Shape,
    ) -> Departure {
        let friction = self.bed.map_or(0.0, |bed| bed.friction);
        let limp = self.weight_until(
            from,
            if from.horizontal > 0.0 {
                0.0
            } else {
                tight_from
            },
            shape.end.0,
        );
        let mut weight_max = -self.sections[from.section].weight * from.offset;
        for section in self.sections[from.section..]
            .iter()
            .take_while(|section| section.weight >= 0.0)
        {
            weight_max += section.weight * section.length;
        }
        let leave = |laid: f64| {
            let (section, offset) = self.locate(from, laid);
            let horizontal = from.horizontal + friction * (laid - limp).max(0.0);
            Departure {
                section,
                offset,
                horizontal,
                vertical: 0.0,
                z: from.z,
            }
        };
        let lost = |laid: f64| {
            let departure = leave(laid);
            let flown = self.fly(&departure);
            let drag = if laid > limp { friction } else { 0.0 };
            (-flown.gap, flown.by_vertical - drag * flown.by_horizontal)
        };
        let tolerance = CLOSURE * self.length;
        let laid = if weight_max <= 0.0 || lost(0.0).0 >= 0.0 {
            if weight_max > 0.0 {
                0.0
            } else {
                weight_max.max(0.0)
            }
        } else {
            root::increasing(lost, *guess, (0.0, weight_max), |_| weight_max, tolerance).at
        };
        *guess = laid;
        let departure = leave(laid);
        self.lay(from, &departure, tight_from, friction, shape);
        departure
    }

    /// Weight on the bed between the touchdown `from`, at arc length `s`, and arc length `until` [N].
    fn weight_until(&self, from: &Departure, until: f64, s: f64) -> f64 {
        let (mut weight, mut left, mut offset) = (0.0, until - s, from.offset);
        for section in &self.sections[from.section..] {
            if left <= 0.0 || section.weight < 0.0 {
                break;
            }
            let length = left.min(section.length - offset);
            weight += section.weight * length;
            left -= length;
            offset = 0.0;
        }
        weight
    }

    /// Section and offset at which the weight `laid` lies between the touchdown and there.
    fn locate(&self, from: &Departure, laid: f64) -> (usize, f64) {
        let (mut left, mut offset) = (laid, from.offset);
        for (index, section) in self.sections.iter().enumerate().skip(from.section) {
            let here = section.weight * (section.length - offset);
            let last = self
                .sections
                .get(index + 1)
                .is_none_or(|next| next.weight < 0.0);
            if left < here || last {
                let length = if section.weight > 0.0 {
                    left / section.weight
                } else {
                    section.length
                };
                return (index, (offset + length).min(section.length));
            }
            left -= here;
            offset = 0.0;
        }
        (
            self.sections.len() - 1,
            self.sections[self.sections.len() - 1].length,
        )
    }

    /// Appends what lies between a touchdown and the lift-off after it.
    fn lay(
        &self,
        from: &Departure,
        to: &Departure,
        tight_from: f64,
        friction: f64,
        shape: &mut Shape,
    ) {
        let (mut tension, mut offset) = (from.horizontal, from.offset);
        for index in from.section..=to.section {
            let section = &self.sections[index];
            let end = if index == to.section {
                to.offset
            } else {
                section.length
            };
            let length = end - offset;
            let limp = if tension > 0.0 {
                0.0
            } else {
                (tight_from - shape.end.0).clamp(0.0, length.max(0.0))
            };
            shape.lay(section, limp, 0.0, 0.0);
            let growth = friction * section.weight;
            shape.lay(section, length - limp, tension, growth);
            tension += growth * (length - limp);
            offset = 0.0;
        }
    }

    /// Height to spare over the tightest constraint of the flight that starts at `from`.
    fn fly(&self, from: &Departure) -> Flown {
        let height = self.bed.map_or(f64::NEG_INFINITY, |bed| bed.height);
        let (mut z, mut vertical, mut offset) = (from.z, from.vertical, from.offset);
        let (mut by_vertical, mut by_horizontal) = (0.0, 0.0);
        let mut tightest = Flown {
            gap: f64::INFINITY,
            by_vertical,
            by_horizontal,
            touch: None,
        };
        for (index, section) in self.sections.iter().enumerate().skip(from.section) {
            let flight = Flight::of(section, section.length - offset, from.horizontal, vertical);
            let vertical_end = flight.vertical_end();
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
            vertical = vertical_end;
            offset = 0.0;
        }
        let gap = z - self.rise;
        if gap <= tightest.gap {
            tightest = Flown {
                gap,
                by_vertical,
                by_horizontal,
                touch: None,
            };
        }
        tightest
    }

    /// Appends the flight that starts at `from` up to where it ends; the section and offset of its touchdown, None at B.
    fn follow(&self, from: &Departure, shape: &mut Shape) -> Option<(usize, f64)> {
        let touch = self.fly(from).touch;
        let last = touch.map_or(self.sections.len() - 1, |(index, _)| index);
        let (mut vertical, mut offset) = (from.vertical, from.offset);
        // a weightless section without tension has no shape of its own
        let nothing = 1e-13 * self.weights;
        for index in from.section..=last {
            let section = &self.sections[index];
            let end = touch
                .filter(|_| index == last)
                .map_or(section.length, |(_, offset)| offset);
            let length = end - offset;
            if section.weight == 0.0 && from.horizontal <= nothing && vertical.abs() <= nothing {
                shape.push(
                    length,
                    Kind::Slack {
                        x: 0.0,
                        z: 0.0,
                        on_bed: false,
                    },
                );
            } else {
                shape.fly(section, length, from.horizontal, vertical);
            }
            vertical += section.weight * length;
            offset = 0.0;
        }
        touch
    }
}
