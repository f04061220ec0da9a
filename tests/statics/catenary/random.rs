//! Random lines of every class.

use moorline::statics::catenary::Section;

use super::judge::judge;
use super::{Line, seabed};

/// SplitMix64 (Steele, Lea & Flood 2014): deterministic, one word of state.
pub struct Dice(pub u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((word ^ (word >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * self.unit()
    }

    fn decades(&mut self, lower: f64, upper: f64) -> f64 {
        10.0_f64.powf(self.between(lower, upper))
    }

    fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    /// A steel-like section: EA from 10² to 10⁸ times its weight.
    fn section(&mut self) -> Section {
        let (length, weight) = (self.decades(-0.5, 3.5), self.decades(-1.0, 4.0));
        Section {
            length,
            weight,
            axial_stiffness: length * weight * self.decades(2.0, 8.0),
        }
    }

    /// Up to `most` sections of similar magnitude; `weight` maps a positive weight to the desired one.
    fn sections(&mut self, most: f64, mut weight: impl FnMut(&mut Dice, f64) -> f64) -> Vec<Section> {
        let base = self.section();
        let count = self.between(2.0, most + 1.0) as usize;
        (0..count)
            .map(|_| Section {
                length: base.length * self.decades(-1.0, 0.5),
                weight: {
                    let w = base.weight * self.decades(-1.5, 0.5);
                    weight(self, w)
                },
                axial_stiffness: base.axial_stiffness * self.decades(-1.0, 1.0),
            })
            .collect()
    }

    /// A line whose chord is `share` times its length, at any angle.
    fn chord(&mut self, sections: Vec<Section>, share: f64) -> Line {
        let length: f64 = sections.iter().map(|s| s.length).sum();
        let angle = self.between(-1.0, 1.0) * std::f64::consts::FRAC_PI_2;
        Line::of(
            sections,
            share * length * angle.cos(),
            share * length * angle.sin(),
            None,
        )
    }

    /// A line over a seabed through A, with a length between the chord and span + rise.
    fn over_seabed(&mut self, sections: Vec<Section>, friction: f64) -> Line {
        let length: f64 = sections.iter().map(|s| s.length).sum();
        let slope: f64 = self.decades(-2.0, 0.5);
        let (shortest, longest) = (1.0_f64.hypot(slope), 1.0 + slope);
        let share = self.unit();
        let span = length / (shortest + (longest - shortest) * share * share * 1.02);
        Line::of(sections, span, slope * span, seabed(0.0, friction))
    }

    /// Puts the seabed below the lower end, by `lower` to `upper` decades of the length.
    fn lower_seabed(&mut self, mut line: Line, lower: f64, upper: f64) -> Line {
        let depth = line.length() * self.decades(lower, upper);
        line.seabed = seabed(
            line.rise.min(0.0) - depth,
            line.seabed.map_or(0.0, |seabed| seabed.friction),
        );
        line
    }

    /// Does the same for a fraction of the lines [-]; the others are unchanged.
    fn some_lower_seabed(&mut self, part: f64, line: Line, [lower, upper]: [f64; 2]) -> Line {
        match self.chance(part) {
            true => self.lower_seabed(line, lower, upper),
            false => line,
        }
    }

    /// One or its negative.
    fn sign(&mut self, part: f64) -> f64 {
        if self.chance(part) { -1.0 } else { 1.0 }
    }

    /// Returns a friction coefficient [-], 0 for three lines out of ten.
    fn friction(&mut self) -> f64 {
        if self.chance(0.3) {
            0.0
        } else {
            self.decades(-3.0, 0.2)
        }
    }
}

pub type Make = fn(&mut Dice) -> Line;

/// Every class of line, with its generator.
pub const CLASSES: [(&str, Make); 26] = [
    ("suspended", |d| {
        let (section, share) = (d.section(), d.between(0.05, 0.9999));
        d.chord(vec![section], share)
    }),
    ("touching down", |d| {
        let section = d.section();
        d.over_seabed(vec![section], 0.0)
    }),
    ("touching down with friction", |d| {
        let (section, friction) = (d.section(), d.decades(-3.0, 0.3));
        d.over_seabed(vec![section], friction)
    }),
    ("touching down between two ends above the seabed", |d| {
        let (section, share) = (d.section(), d.between(0.1, 0.999));
        let line = d.chord(vec![section], share);
        d.lower_seabed(line, -3.0, -0.5)
    }),
    ("touching down between two ends with friction", |d| {
        let (section, share) = (d.section(), d.between(0.1, 0.999));
        let mut line = d.chord(vec![section], share);
        line.seabed = seabed(0.0, d.decades(-3.0, 0.3));
        d.lower_seabed(line, -3.0, -0.5)
    }),
    ("slack on the seabed", |d| {
        let (section, friction) = (d.section(), d.friction());
        let share = d.between(0.0, 0.99);
        let (span, rise) = (share * section.length * d.unit(), share * section.length);
        let rise = (rise - span) * d.unit();
        Line::of(vec![section], span, rise, seabed(0.0, friction))
    }),
    ("vertical", |d| {
        let section = d.section();
        let rise = section.length * d.between(-1.05, 1.05);
        let mut line = Line::of(vec![section], 0.0, rise, None);
        if d.chance(0.1) {
            line.rise = 0.0;
        }
        d.some_lower_seabed(0.5, line, [-3.0, 0.0])
    }),
    ("of tiny span", |d| {
        let section = d.section();
        let span = section.length * d.decades(-300.0, -3.0);
        let rise = section.length * d.between(-1.1, 1.1);
        d.some_lower_seabed(0.5, Line::of(vec![section], span, rise, None), [-3.0, 0.0])
    }),
    ("over-stretched", |d| {
        let (section, share) = (d.section(), 1.0 + d.decades(-8.0, 0.3));
        let line = d.chord(vec![section], share);
        d.some_lower_seabed(0.5, line, [-5.0, 0.0])
    }),
    ("soft", |d| {
        let (mut section, share) = (d.section(), d.between(0.01, 2.0));
        section.axial_stiffness = section.length * section.weight * d.decades(-3.0, 1.5);
        let line = d.chord(vec![section], share);
        let rough = Line {
            seabed: seabed(0.0, d.friction()),
            ..line.clone()
        };
        if d.chance(0.5) {
            d.lower_seabed(rough, -3.0, 0.0)
        } else {
            line
        }
    }),
    ("stiff", |d| {
        let (mut section, share) = (d.section(), 1.0 - d.decades(-9.0, -0.2));
        section.axial_stiffness = d.decades(10.0, 13.0);
        let line = d.chord(vec![section], share);
        d.some_lower_seabed(0.3, line, [-3.0, 0.0])
    }),
    ("light", |d| {
        let (mut section, share) = (d.section(), 1.0 + d.decades(-9.0, -0.2) * d.sign(0.7));
        section.weight = d.decades(-11.0, -3.0);
        section.axial_stiffness = d.decades(2.0, 13.0);
        let line = d.chord(vec![section], share);
        d.some_lower_seabed(0.3, line, [-3.0, 0.0])
    }),
    ("weightless", |d| {
        let share = d.between(0.2, 1.3);
        let sections = match d.chance(0.5) {
            true => d.sections(4.0, |_, _| 0.0),
            false => vec![Section {
                weight: 0.0,
                ..d.section()
            }],
        };
        let line = d.chord(sections, share);
        d.some_lower_seabed(0.3, line, [-3.0, 0.0])
    }),
    ("buoyant", |d| {
        let (mut section, share) = (d.section(), d.between(0.05, 1.1));
        section.weight = -section.weight;
        let line = d.chord(vec![section], share);
        d.some_lower_seabed(0.5, line, [-3.0, 0.0])
    }),
    ("of several sections, suspended", |d| {
        let (sections, share) = (d.sections(6.0, |_, w| w), d.between(0.05, 0.9999));
        d.chord(sections, share)
    }),
    ("of several sections, touching down", |d| {
        let (sections, friction) = (d.sections(6.0, |_, w| w), d.friction());
        d.over_seabed(sections, friction)
    }),
    ("of several sections, between two ends above the seabed", |d| {
        let (sections, share) = (d.sections(6.0, |_, w| w), d.between(0.05, 1.05));
        let mut line = d.chord(sections, share);
        line.seabed = seabed(0.0, d.friction());
        d.lower_seabed(line, -4.0, -0.3)
    }),
    ("of sections that sink and float, suspended", |d| {
        let sections = d.sections(6.0, |d, w| w * -d.sign(0.5));
        let share = d.between(0.05, 1.05);
        d.chord(sections, share)
    }),
    ("of sections that sink and float, over a seabed", |d| {
        let sections = d.sections(7.0, |d, w| w * -d.sign(0.6));
        let share = d.between(0.05, 1.02);
        let line = d.chord(sections, share);
        if d.chance(0.3) {
            return Line {
                rise: line.rise.abs(),
                seabed: seabed(0.0, 0.0),
                ..line
            };
        }
        d.lower_seabed(line, -4.0, -0.5)
    }),
    ("of sections some of which are weightless", |d| {
        let sections = d.sections(5.0, |d, w| if d.chance(0.5) { w } else { 0.0 });
        let share = d.between(0.05, 1.02);
        let line = d.chord(sections, share);
        d.some_lower_seabed(0.5, line, [-4.0, -0.5])
    }),
    (
        "of sections that sink, float or weigh nothing, over a seabed with friction",
        |d| {
            let weight = |d: &mut Dice, w: f64| if d.chance(0.25) { 0.0 } else { w * -d.sign(0.6) };
            let (sections, share) = (d.sections(7.0, weight), d.between(0.05, 1.02));
            let mut line = d.chord(sections, share);
            line.seabed = seabed(0.0, d.decades(-3.0, 0.2));
            d.lower_seabed(line, -4.0, -0.5)
        },
    ),
    ("of sections unlike each other by many decades", |d| {
        let (mut sections, share) = (d.sections(5.0, |_, w| w), d.between(0.05, 1.02));
        for section in &mut sections {
            section.length *= d.decades(-4.0, 0.0);
            section.weight *= d.decades(-8.0, 0.0);
            section.axial_stiffness *= d.decades(-2.0, 2.0);
        }
        let line = d.chord(sections, share);
        d.some_lower_seabed(0.5, line, [-4.0, -0.5])
    }),
    ("of several sections, slack or vertical", |d| {
        let (sections, share) = (d.sections(4.0, |_, w| w), d.between(0.0, 1.01));
        let mut line = d.chord(sections, share);
        line.span = if d.chance(0.5) {
            0.0
        } else {
            0.1 * line.span * d.unit()
        };
        d.some_lower_seabed(0.7, line, [-4.0, -0.5])
    }),
    ("with both ends on the seabed", |d| {
        let section = d.section();
        let span = section.length * (1.0 + d.decades(-9.0, -0.3) * d.sign(0.5));
        Line::of(vec![section], span, 0.0, seabed(0.0, d.friction()))
    }),
    ("with one end on or just above the seabed", |d| {
        let section = d.section();
        let share = 1.0 - d.decades(-7.0, -0.2);
        let mut line = d.chord(vec![section], share);
        let friction = d.friction();
        line.seabed = seabed(line.rise.min(0.0), friction);
        if d.chance(0.5) {
            line
        } else {
            d.lower_seabed(line, -15.0, -5.0)
        }
    }),
    ("whose chord is its length, nearly or exactly", |d| {
        let section = d.section();
        let off = if d.chance(0.2) {
            0.0
        } else {
            d.decades(-16.0, -6.0) * d.sign(0.5)
        };
        let line = d.chord(vec![section], 1.0 + off);
        d.some_lower_seabed(0.5, line, [-9.0, 0.0])
    }),
];

/// Judges `count` random lines of every class; reports the greatest violation and its location by class.
fn judge_classes(count: usize, tolerance: f64) {
    let mut failures = 0;
    for (index, (name, make)) in CLASSES.iter().enumerate() {
        let mut dice = Dice(0x6d6f_6f72 + index as u64);
        let (mut worst, mut steps, mut steps_max, mut reduced) = (0.0_f64, 0, 0, 0);
        for _ in 0..count {
            let line = make(&mut dice);
            let solved = line.solve();
            let violation = judge(&line, &solved);
            worst = worst.max(violation);
            let in_full = line.seabed.map_or(0.0, |seabed| seabed.friction);
            reduced += usize::from(solved.laid_length() > 0.0 && solved.friction() < in_full);
            steps += solved.iterations();
            steps_max = steps_max.max(solved.iterations());
            if violation > tolerance {
                failures += 1;
                if failures <= 20 {
                    println!("{violation:.1e} by a line {name}: {line:?}");
                }
            }
        }
        let mean = steps as f64 / count as f64;
        let few = reduced == 0 || name.contains("float") && reduced <= 1 + count / 10_000;
        assert!(few, "friction reduced on {reduced} lines {name}");
        println!("{count} lines {name}: worst {worst:.1e}, evaluations {mean:.1}, {steps_max} at most");
    }
    assert_eq!(
        failures, 0,
        "lines violate the cable equations by more than {tolerance:e}"
    );
}

#[test]
fn random_lines_of_every_class_obey_the_cable_equations() {
    judge_classes(100_000usize.div_ceil(CLASSES.len()), 1e-9);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_hundred_thousand_lines_of_each_class_obey_the_cable_equations() {
    judge_classes(100_000, 1e-9);
}
