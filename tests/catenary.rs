//! The elastic catenary against 60-digit references and, on random lines of every class, against the equations of the cable.
//!
//! ```text
//!                        ● B        judged: the end forces the solver gives are integrated from A to B along the line by
//!                      ╱            Gauss quadrature of dx/ds = H/T + H/EA, dz/ds = V/T + V/EA, dV/ds = w; the walk must
//!  A ●══════════════╱               arrive at B, with B's forces, never under the bed, and on it obey Coulomb's law
//! ```
//!
//! `tests/reference/catenary.csv` is made by `python_tests/make_catenary_reference.py`. Source of the published figures: SeaFEM
//! validation case 11; the MAP++ summary of the OC3 Hywind line in the OpenFAST regression tests.

use moorline::statics::catenary::{Bed, Catenary, CatenaryError, Section, solve};

/// A line to solve.
#[derive(Debug, Clone)]
struct Line {
    sections: Vec<Section>,
    span: f64,
    rise: f64,
    bed: Option<Bed>,
}

impl Line {
    fn uniform(
        length: f64,
        weight: f64,
        axial_stiffness: f64,
        span: f64,
        rise: f64,
        bed: Option<Bed>,
    ) -> Self {
        Line {
            sections: vec![Section {
                length,
                weight,
                axial_stiffness,
            }],
            span,
            rise,
            bed,
        }
    }

    fn solve(&self) -> Catenary {
        solve(&self.sections, self.span, self.rise, self.bed)
            .unwrap_or_else(|e| panic!("{e}: {self:?}"))
    }

    fn length(&self) -> f64 {
        self.sections.iter().map(|section| section.length).sum()
    }

    fn weights(&self) -> f64 {
        self.sections
            .iter()
            .map(|section| section.length * section.weight.abs())
            .sum()
    }
}

// ---------------------------------------------------------------------------------------------------------------- the judge

/// Abscissae and weights of ten-point Gauss-Legendre quadrature on (-1, 1), the positive half.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_22, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_36),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

fn quadrature(from: f64, to: f64, mut integrand: impl FnMut(f64) -> [f64; 3]) -> [f64; 3] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut sum = [0.0; 3];
    for (at, weight) in GAUSS {
        let (left, right) = (integrand(middle - half * at), integrand(middle + half * at));
        for i in 0..3 {
            sum[i] += half * weight * (left[i] + right[i]);
        }
    }
    sum
}

/// x, z and elongation [m] over `length` metres of section that start under (h, v) and do not pass V = 0 inside.
fn integrate(section: &Section, length: f64, h: f64, v: f64) -> [f64; 3] {
    let (w, ea) = (section.weight, section.axial_stiffness);
    let (start, end) = (h.hypot(v), h.hypot(v + w * length));
    if h == 0.0 || (w * length).abs() <= 0.5 * start.min(end) {
        return quadrature(0.0, length, |s| {
            let v = v + w * s;
            let t = h.hypot(v);
            let rate = if t > 0.0 {
                1.0 / t + 1.0 / ea
            } else {
                1.0 / ea
            };
            [h * rate, v * rate, t / ea]
        });
    }
    // V = H sinh β spreads out the bend where V is small
    let (from, to) = ((v / h).asinh(), ((v + w * length) / h).asinh());
    let cells = (to - from).abs().ceil().max(1.0);
    let mut sum = [0.0; 3];
    for cell in 0..cells as usize {
        let at = |k: usize| from + (to - from) * k as f64 / cells;
        let part = quadrature(at(cell), at(cell + 1), |beta| {
            let t = h * beta.cosh();
            let ds = t / w;
            let rate = ds * (1.0 / t + 1.0 / ea);
            [h * rate, h * beta.sinh() * rate, ds * t / ea]
        });
        for i in 0..3 {
            sum[i] += part[i];
        }
    }
    sum
}

/// The walk from A to B along a solved line.
struct Walk<'a> {
    line: &'a Line,
    solved: &'a Catenary,
    s: f64,
    x: f64,
    z: f64,
    h: f64,
    v: f64,
    elongation: f64,
    /// Greatest miss of anything so far, over length or force [-].
    worst: f64,
}

impl Walk<'_> {
    fn miss(&mut self, error: f64, scale: f64) {
        let miss = error.abs() / scale;
        self.worst = if miss.is_nan() {
            f64::INFINITY
        } else {
            self.worst.max(miss)
        };
    }

    fn length_scale(&self) -> f64 {
        self.solved.stretched_length().max(self.line.length())
    }

    fn force_scale(&self) -> f64 {
        let weights = self.line.weights();
        (self.solved.tension_a().max(self.solved.tension_b()) + weights).max(f64::MIN_POSITIVE)
    }

    fn fly(&mut self, section: &Section, length: f64) {
        let end = self.v + section.weight * length;
        let passes = self.v * end < 0.0;
        let first = if passes {
            (-self.v / section.weight).min(length)
        } else {
            length
        };
        let mut start = self.v;
        for part in [first, length - first] {
            if part <= 0.0 {
                continue;
            }
            let [x, z, elongation] = integrate(section, part, self.h, start);
            self.x += x;
            self.z += z;
            self.elongation += elongation;
            start = if passes { 0.0 } else { start };
            self.stay_above_bed();
        }
        self.v = end;
    }

    fn stay_above_bed(&mut self) {
        if let Some(bed) = self.line.bed {
            let below = (bed.height - self.z).max(0.0);
            self.miss(below, self.length_scale());
        }
    }

    fn lie(&mut self, section: &Section, to: f64) {
        let bed = self.line.bed.expect("only a bed carries");
        let length = to - self.s;
        assert!(
            section.weight >= 0.0,
            "what floats does not lie: {:?}",
            self.line
        );
        self.miss(self.v, self.force_scale());
        self.miss(self.z - bed.height, self.length_scale());
        let (before, after) = (self.h, self.solved.at(to).horizontal);
        let friction = self.solved.friction();
        assert!(friction <= bed.friction, "Coulomb's law: {:?}", self.line);
        let gain = friction * section.weight * length;
        let elongation = if before > 0.0 || gain == 0.0 {
            self.miss(after - before - gain, self.force_scale());
            length * 0.5 * (before + after)
        } else {
            self.miss((after - gain).max(0.0), self.force_scale());
            0.5 * after * after / (friction * section.weight)
        } / section.axial_stiffness;
        if before == 0.0 && after == 0.0 {
            // nothing pulls it straight: it may lie anywhere its length allows
            let x = self.solved.at(to).x;
            self.miss(((x - self.x).abs() - length).max(0.0), self.length_scale());
            self.x = x;
        } else {
            self.x += length + elongation;
        }
        self.elongation += elongation;
        (self.h, self.v, self.z) = (after, 0.0, bed.height);
    }

    fn is_slack_in_flight(&self, section: &Section) -> bool {
        let nothing = 1e-12 * self.force_scale();
        section.weight == 0.0 && self.h <= nothing && self.v.abs() <= nothing
    }

    fn hang_slack(&mut self, to: f64) {
        let point = self.solved.at(to);
        let length = to - self.s;
        let distance = (point.x - self.x).hypot(point.z - self.z);
        self.miss((distance - length).max(0.0), self.length_scale());
        (self.x, self.z) = (point.x, point.z);
    }

    fn compare_point(&mut self) {
        let point = self.solved.at(self.s);
        self.miss(
            (point.x - self.x).hypot(point.z - self.z),
            self.length_scale(),
        );
        let force = (point.horizontal - self.h).hypot(point.vertical - self.v);
        self.miss(force, self.force_scale());
        // what is within the tolerance is taken over: far from A, or beyond a heavy section, a part may carry less than the
        // rounding of V at A or of s times w
        if force < 1e-12 * self.force_scale() {
            self.v = point.vertical;
        }
    }
}

/// Greatest violation of the cable equations by the solved line, over its length or its greatest force [-].
fn judge(line: &Line, solved: &Catenary) -> f64 {
    let (h, v) = (solved.horizontal_a(), solved.vertical_a());
    let mut walk = Walk {
        line,
        solved,
        s: 0.0,
        x: 0.0,
        z: 0.0,
        h,
        v,
        elongation: 0.0,
        worst: 0.0,
    };
    let laid: Vec<(f64, f64)> = solved.laid().collect();
    let mut section_end = 0.0;
    for section in &line.sections {
        section_end += section.length;
        let mut cuts: Vec<f64> = laid
            .iter()
            .flat_map(|&(from, to)| [from, 0.5 * (from + to), to])
            .collect();
        cuts.extend([section_end - 0.37 * section.length, section_end]);
        cuts.retain(|&cut| cut > walk.s && cut <= section_end);
        cuts.sort_by(f64::total_cmp);
        for to in cuts {
            let middle = 0.5 * (walk.s + to);
            if laid.iter().any(|&(from, to)| from < middle && middle < to) {
                walk.lie(section, to);
            } else if walk.is_slack_in_flight(section) {
                walk.hang_slack(to);
            } else {
                walk.fly(section, to - walk.s);
            }
            walk.s = to;
            walk.compare_point();
        }
    }
    walk.miss(walk.x - line.span, walk.length_scale());
    walk.miss(walk.z - line.rise, walk.length_scale());
    walk.miss(walk.h - solved.horizontal(), walk.force_scale());
    walk.miss(walk.v - solved.vertical_b(), walk.force_scale());
    walk.miss(
        walk.elongation + line.length() - solved.stretched_length(),
        walk.length_scale(),
    );
    for eighth in 0..=8 {
        let point = solved.at(line.length() * f64::from(eighth) / 8.0);
        if line.span > 1e-9 * line.length() {
            let below = line.rise * (point.x / line.span) - point.z;
            let steep = 1.0 + line.rise.abs() / line.span;
            walk.miss((below - solved.sag()).max(0.0), walk.length_scale() * steep);
        }
    }
    walk.worst
}

// ------------------------------------------------------------------------------------------------------------ random lines

/// SplitMix64 (Steele, Lea & Flood 2014): deterministic, one word of state.
struct Dice(u64);

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

    /// Up to `most` sections of one order of magnitude; `weight` maps a positive weight to the wanted one.
    fn sections(
        &mut self,
        most: f64,
        mut weight: impl FnMut(&mut Dice, f64) -> f64,
    ) -> Vec<Section> {
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

    /// A chord of `share` times the length at any angle.
    fn chord(&mut self, sections: Vec<Section>, share: f64) -> Line {
        let length: f64 = sections.iter().map(|s| s.length).sum();
        let angle = self.between(-1.0, 1.0) * std::f64::consts::FRAC_PI_2;
        Line {
            sections,
            span: share * length * angle.cos(),
            rise: share * length * angle.sin(),
            bed: None,
        }
    }

    /// A line over a bed through A, of a length between the chord and span + rise.
    fn over_bed(&mut self, sections: Vec<Section>, friction: f64) -> Line {
        let length: f64 = sections.iter().map(|s| s.length).sum();
        let slope: f64 = self.decades(-2.0, 0.5);
        let (shortest, longest) = (1.0_f64.hypot(slope), 1.0 + slope);
        let share = self.unit();
        let span = length / (shortest + (longest - shortest) * share * share * 1.02);
        Line {
            sections,
            span,
            rise: slope * span,
            bed: Some(Bed {
                height: 0.0,
                friction,
            }),
        }
    }

    /// Puts the bed a little below the lower end.
    fn lower_bed(&mut self, mut line: Line, lower: f64, upper: f64) -> Line {
        let depth = line.length() * self.decades(lower, upper);
        line.bed = Some(Bed {
            height: line.rise.min(0.0) - depth,
            friction: line.bed.map_or(0.0, |bed| bed.friction),
        });
        line
    }
}

type Make = fn(&mut Dice) -> Line;

fn friction(dice: &mut Dice) -> f64 {
    if dice.chance(0.3) {
        0.0
    } else {
        dice.decades(-3.0, 0.2)
    }
}

/// Every class of line with how to make one.
const CLASSES: [(&str, Make); 26] = [
    ("suspended", |d| {
        let (section, share) = (d.section(), d.between(0.05, 0.9999));
        d.chord(vec![section], share)
    }),
    ("touching down", |d| {
        let section = d.section();
        d.over_bed(vec![section], 0.0)
    }),
    ("touching down with friction", |d| {
        let (section, friction) = (d.section(), d.decades(-3.0, 0.3));
        d.over_bed(vec![section], friction)
    }),
    ("touching down between two ends above the bed", |d| {
        let (section, share) = (d.section(), d.between(0.1, 0.999));
        let line = d.chord(vec![section], share);
        d.lower_bed(line, -3.0, -0.5)
    }),
    ("touching down between two ends with friction", |d| {
        let (section, share) = (d.section(), d.between(0.1, 0.999));
        let mut line = d.chord(vec![section], share);
        line.bed = Some(Bed {
            height: 0.0,
            friction: d.decades(-3.0, 0.3),
        });
        d.lower_bed(line, -3.0, -0.5)
    }),
    ("slack on the bed", |d| {
        let (section, friction) = (d.section(), friction(d));
        let share = d.between(0.0, 0.99);
        let (span, rise) = (share * section.length * d.unit(), share * section.length);
        let rise = (rise - span) * d.unit();
        Line {
            sections: vec![section],
            span,
            rise,
            bed: Some(Bed {
                height: 0.0,
                friction,
            }),
        }
    }),
    ("vertical", |d| {
        let section = d.section();
        let rise = section.length * d.between(-1.05, 1.05);
        let mut line = Line {
            sections: vec![section],
            span: 0.0,
            rise,
            bed: None,
        };
        if d.chance(0.1) {
            line.rise = 0.0;
        }
        if d.chance(0.5) {
            d.lower_bed(line, -3.0, 0.0)
        } else {
            line
        }
    }),
    ("of tiny span", |d| {
        let section = d.section();
        let (span, rise) = (
            section.length * d.decades(-300.0, -3.0),
            section.length * d.between(-1.1, 1.1),
        );
        let line = Line {
            sections: vec![section],
            span,
            rise,
            bed: None,
        };
        if d.chance(0.5) {
            d.lower_bed(line, -3.0, 0.0)
        } else {
            line
        }
    }),
    ("over-stretched", |d| {
        let (section, share) = (d.section(), 1.0 + d.decades(-8.0, 0.3));
        let line = d.chord(vec![section], share);
        if d.chance(0.5) {
            d.lower_bed(line, -5.0, 0.0)
        } else {
            line
        }
    }),
    ("soft", |d| {
        let (mut section, share) = (d.section(), d.between(0.01, 2.0));
        section.axial_stiffness = section.length * section.weight * d.decades(-3.0, 1.5);
        let mut line = d.chord(vec![section], share);
        line.bed = Some(Bed {
            height: 0.0,
            friction: friction(d),
        });
        if d.chance(0.5) {
            d.lower_bed(line, -3.0, 0.0)
        } else {
            Line { bed: None, ..line }
        }
    }),
    ("stiff", |d| {
        let (mut section, share) = (d.section(), 1.0 - d.decades(-9.0, -0.2));
        section.axial_stiffness = d.decades(10.0, 13.0);
        let line = d.chord(vec![section], share);
        if d.chance(0.3) {
            d.lower_bed(line, -3.0, 0.0)
        } else {
            line
        }
    }),
    ("light", |d| {
        let (mut section, share) = (
            d.section(),
            1.0 + d.decades(-9.0, -0.2) * if d.chance(0.7) { -1.0 } else { 1.0 },
        );
        section.weight = d.decades(-11.0, -3.0);
        section.axial_stiffness = d.decades(2.0, 13.0);
        let line = d.chord(vec![section], share);
        if d.chance(0.3) {
            d.lower_bed(line, -3.0, 0.0)
        } else {
            line
        }
    }),
    ("weightless", |d| {
        let share = d.between(0.2, 1.3);
        let sections = if d.chance(0.5) {
            d.sections(4.0, |_, _| 0.0)
        } else {
            vec![Section {
                weight: 0.0,
                ..d.section()
            }]
        };
        let line = d.chord(sections, share);
        if d.chance(0.3) {
            d.lower_bed(line, -3.0, 0.0)
        } else {
            line
        }
    }),
    ("buoyant", |d| {
        let (mut section, share) = (d.section(), d.between(0.05, 1.1));
        section.weight = -section.weight;
        let line = d.chord(vec![section], share);
        if d.chance(0.5) {
            d.lower_bed(line, -3.0, 0.0)
        } else {
            line
        }
    }),
    ("of several sections, suspended", |d| {
        let (sections, share) = (d.sections(6.0, |_, w| w), d.between(0.05, 0.9999));
        d.chord(sections, share)
    }),
    ("of several sections, touching down", |d| {
        let (sections, friction) = (d.sections(6.0, |_, w| w), friction(d));
        d.over_bed(sections, friction)
    }),
    ("of several sections, between two ends above the bed", |d| {
        let (sections, share) = (d.sections(6.0, |_, w| w), d.between(0.05, 1.05));
        let mut line = d.chord(sections, share);
        line.bed = Some(Bed {
            height: 0.0,
            friction: friction(d),
        });
        d.lower_bed(line, -4.0, -0.3)
    }),
    ("of sections that sink and float, suspended", |d| {
        let sections = d.sections(6.0, |d, w| if d.chance(0.5) { w } else { -w });
        let share = d.between(0.05, 1.05);
        d.chord(sections, share)
    }),
    ("of sections that sink and float, over a bed", |d| {
        let sections = d.sections(7.0, |d, w| if d.chance(0.6) { w } else { -w });
        let share = d.between(0.05, 1.02);
        let line = d.chord(sections, share);
        if d.chance(0.3) {
            return Line {
                rise: line.rise.abs(),
                bed: Some(Bed {
                    height: 0.0,
                    friction: 0.0,
                }),
                ..line
            };
        }
        d.lower_bed(line, -4.0, -0.5)
    }),
    ("of sections some of which are weightless", |d| {
        let sections = d.sections(5.0, |d, w| if d.chance(0.5) { w } else { 0.0 });
        let share = d.between(0.05, 1.02);
        let line = d.chord(sections, share);
        if d.chance(0.5) {
            d.lower_bed(line, -4.0, -0.5)
        } else {
            line
        }
    }),
    (
        "of sections that sink, float or weigh nothing, over a bed with friction",
        |d| {
            let weight = |d: &mut Dice, w: f64| {
                if d.chance(0.25) {
                    0.0
                } else if d.chance(0.6) {
                    w
                } else {
                    -w
                }
            };
            let (sections, share) = (d.sections(7.0, weight), d.between(0.05, 1.02));
            let mut line = d.chord(sections, share);
            line.bed = Some(Bed {
                height: 0.0,
                friction: d.decades(-3.0, 0.2),
            });
            d.lower_bed(line, -4.0, -0.5)
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
        if d.chance(0.5) {
            d.lower_bed(line, -4.0, -0.5)
        } else {
            line
        }
    }),
    ("of several sections, slack or vertical", |d| {
        let (sections, share) = (d.sections(4.0, |_, w| w), d.between(0.0, 1.01));
        let line = d.chord(sections, share);
        let line = Line {
            span: if d.chance(0.5) {
                0.0
            } else {
                0.1 * line.span * d.unit()
            },
            ..line
        };
        if d.chance(0.7) {
            d.lower_bed(line, -4.0, -0.5)
        } else {
            line
        }
    }),
    ("with both ends on the bed", |d| {
        let section = d.section();
        let span =
            section.length * (1.0 + d.decades(-9.0, -0.3) * if d.chance(0.5) { -1.0 } else { 1.0 });
        let bed = Some(Bed {
            height: 0.0,
            friction: friction(d),
        });
        Line {
            sections: vec![section],
            span,
            rise: 0.0,
            bed,
        }
    }),
    ("with one end on or just above the bed", |d| {
        let section = d.section();
        let share = 1.0 - d.decades(-7.0, -0.2);
        let mut line = d.chord(vec![section], share);
        line.bed = Some(Bed {
            height: 0.0,
            friction: friction(d),
        });
        if d.chance(0.5) {
            line.bed = Some(Bed {
                height: line.rise.min(0.0),
                ..line.bed.unwrap()
            });
            return line;
        }
        d.lower_bed(line, -15.0, -5.0)
    }),
    ("whose chord is its length, nearly or exactly", |d| {
        let section = d.section();
        let off = if d.chance(0.2) {
            0.0
        } else {
            d.decades(-16.0, -6.0) * if d.chance(0.5) { -1.0 } else { 1.0 }
        };
        let line = d.chord(vec![section], 1.0 + off);
        if d.chance(0.5) {
            d.lower_bed(line, -9.0, 0.0)
        } else {
            line
        }
    }),
];

/// Judges `count` random lines of every class; the greatest violation, and where, is reported by class.
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
            let in_full = line.bed.map_or(0.0, |bed| bed.friction);
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
        assert!(
            reduced == 0 || name.contains("float"),
            "friction reduced on {reduced} lines {name}"
        );
        assert!(
            reduced <= 1 + count / 10_000,
            "friction reduced on {reduced} lines {name}"
        );
        println!(
            "{count} lines {name}: worst {worst:.1e}, evaluations {mean:.1} on average, {steps_max} at most"
        );
    }
    assert_eq!(
        failures, 0,
        "lines that violate the cable equations by more than {tolerance:e}"
    );
}

#[test]
fn random_lines_of_every_class_obey_the_cable_equations() {
    judge_classes(100_000usize.div_ceil(CLASSES.len()), 1e-9);
}

#[test]
#[ignore = "half a minute: 100 000 lines of each class"]
fn a_hundred_thousand_lines_of_each_class_obey_the_cable_equations() {
    judge_classes(100_000, 1e-9);
}

// -------------------------------------------------------------------------------------------------------------- references

/// Greatest difference of a solved line from a row of reference values: of forces over T at the fairlead (at least the anchor's where
/// that one is zero), and of positions and lengths over the length [-].
fn compare_row(row: &std::collections::HashMap<String, String>, bed: Option<Bed>) -> (f64, f64) {
    let number = |name: &str| -> f64 {
        row[name]
            .parse()
            .unwrap_or_else(|_| panic!("{name} of {row:?}"))
    };
    let section = |i: usize| Section {
        length: number(&format!("L{i}")),
        weight: number(&format!("w{i}")),
        axial_stiffness: number(&format!("EA{i}")),
    };
    let sections = (1..=number("nseg") as usize).map(section).collect();
    let line = Line {
        sections,
        span: number("XF"),
        rise: number("ZF"),
        bed,
    };
    let solved = line.solve();
    let scale = if number("T_fair") > 0.0 {
        number("T_fair")
    } else {
        number("T_anch").max(f64::MIN_POSITIVE)
    };
    let vertical = (solved.vertical_b() - number("V_fair")).abs() / scale;
    if row["cls"].starts_with("degenerate") {
        return (vertical, 0.0);
    }
    let forces = [
        (solved.horizontal(), "H_fair"),
        (solved.tension_b(), "T_fair"),
        (solved.horizontal_a(), "H_anch"),
        (solved.vertical_a(), "V_anch"),
        (solved.tension_a(), "T_anch"),
    ];
    let middle = solved.at(0.5 * line.length());
    let lengths = [
        (middle.x, "mid_x"),
        (middle.z, "mid_z"),
        (solved.laid_length(), "laid_unstretched"),
        (solved.stretched_length(), "stretched_length"),
    ];
    let greatest = |pairs: &[(f64, &str)], scale: f64| {
        pairs
            .iter()
            .map(|(value, name)| (value - number(name)).abs() / scale)
            .fold(0.0, f64::max)
    };
    (
        greatest(&forces, scale).max(vertical),
        greatest(&lengths, line.length()),
    )
}

/// Compares every row of a table; prints the greatest difference of every class; returns the number of rows.
fn compare_table(path: &std::path::Path, tolerance: f64) -> usize {
    let mut reader =
        csv::Reader::from_path(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut worst = std::collections::BTreeMap::<String, (usize, f64, f64)>::new();
    let mut rows = 0;
    for row in reader.deserialize() {
        let row: std::collections::HashMap<String, String> = row.expect("a row of the table");
        let height = row.get("bed_height").map_or(0.0, |height| {
            height.parse().expect("bed_height is a number")
        });
        let friction = row["CB"].parse().expect("CB is a number");
        let bed = (row["seabed"] == "1").then_some(Bed { height, friction });
        let (force, length) = compare_row(&row, bed);
        let entry = worst.entry(row["cls"].clone()).or_default();
        *entry = (entry.0 + 1, entry.1.max(force), entry.2.max(length));
        let met = force <= tolerance && length <= tolerance;
        assert!(
            met,
            "row {} ({}): forces {force:e}, lengths {length:e}",
            row["id"], row["cls"]
        );
        rows += 1;
    }
    for (class, (count, force, length)) in worst {
        println!("{count:3} rows {class}: forces {force:.1e}, lengths {length:.1e}");
    }
    rows
}

#[test]
fn every_row_of_the_reference_bank_is_met_to_nine_digits() {
    let path =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/catenary.csv");
    assert!(compare_table(&path, 1e-9) >= 60);
}

#[test]
fn every_row_of_the_external_bank_is_met_to_nine_digits() {
    let Some(folder) = std::env::var_os("MOORLINE_REFERENCE") else {
        println!(
            "skipped: MOORLINE_REFERENCE does not name the folder that holds catenary_bank.csv"
        );
        return;
    };
    let rows = compare_table(
        &std::path::Path::new(&folder).join("catenary_bank.csv"),
        1e-9,
    );
    assert_eq!(rows, 182);
}

// ------------------------------------------------------------------------------------------------------------------ claims

fn assert_near(value: f64, wanted: f64, tolerance: f64) {
    assert!(
        (value - wanted).abs() <= tolerance,
        "{value} is not {wanted} within {tolerance:e}"
    );
}

#[test]
fn seafem_case_11_has_the_exact_sag_and_reactions() {
    let line = Line::uniform(14.1421, 0.49, 2505.0, 14.1421, 0.0, None).solve();
    assert_near(line.horizontal(), 17.00889855, 5e-9);
    assert_near(line.vertical_b(), 3.4648145, 1e-12);
    assert_near(line.vertical_a(), -3.4648145, 1e-12);
    assert_near(line.sag(), 0.717_777_465_4, 5e-11);
}

fn oc3(friction: f64) -> Line {
    let bed = Some(Bed {
        height: 0.0,
        friction,
    });
    // MAP++ prints 698.094 N/m and computes with all digits: 77.7066 kg/m, 0.09 m, in 1025 kg/m³
    let weight = 9.80665 * (77.7066 - 1025.0 * std::f64::consts::PI * 0.09 * 0.09 / 4.0);
    Line::uniform(902.2, weight, 384.243e6, 848.67, 250.0, bed)
}

#[test]
fn the_oc3_line_has_the_tension_map_prints_with_its_friction_and_less_without() {
    let line = oc3(0.001).solve();
    assert_near(line.tension_b(), 911_089.46, 5e-3);
    assert_near(line.horizontal(), 736_939.29, 5e-3);
    assert_near(line.vertical_b(), 535_727.99, 5e-3);
    let frictionless =
        Line::uniform(902.2, 698.094, 384.243e6, 848.67, 250.0, oc3(0.0).bed).solve();
    assert_near(frictionless.tension_b(), 911_088.356_868_612_6, 1e-6);
    assert_eq!(frictionless.horizontal_a(), frictionless.horizontal());
}

#[test]
fn friction_takes_its_share_of_the_laid_weight_and_no_more_than_all() {
    let line = oc3(0.5).solve();
    assert_near(
        line.horizontal() - line.horizontal_a(),
        0.5 * oc3(0.5).weights() / 902.2 * line.laid_length(),
        1e-6,
    );
    assert_eq!(line.friction(), 0.5);
    let long = Line {
        span: 800.0,
        ..oc3(0.9)
    }
    .solve();
    assert_eq!(long.tension_a(), 0.0);
    assert!(long.horizontal() > 0.0);
}

#[test]
fn swapping_the_ends_mirrors_the_line() {
    let mut dice = Dice(11);
    let frictionless = CLASSES
        .iter()
        .filter(|(name, _)| !name.contains("friction"));
    for (name, make) in frictionless {
        for _ in 0..200 {
            let mut line = make(&mut dice);
            line.bed = line.bed.map(|bed| Bed {
                friction: 0.0,
                ..bed
            });
            let sections = line.sections.iter().rev().copied().collect();
            let bed = line.bed.map(|bed| Bed {
                height: bed.height - line.rise,
                ..bed
            });
            let swapped = Line {
                sections,
                span: line.span,
                rise: -line.rise,
                bed,
            };
            let (there, back) = (line.solve(), swapped.solve());
            // what a change of L by one rounding would do to the force is beyond any solver: Δ = EA ε/strain at most
            let flexibility: f64 = line
                .sections
                .iter()
                .map(|s| s.length / s.axial_stiffness)
                .sum();
            let scale = there.tension_a().max(there.tension_b()) + line.weights();
            let tolerance = 1e-9 * scale + 1e-14 * line.length() / flexibility;
            assert!(
                (there.horizontal() - back.horizontal()).abs() <= tolerance,
                "{name}: {line:?}"
            );
            assert!(
                (there.vertical_a() + back.vertical_b()).abs() <= tolerance,
                "{name}: {line:?}"
            );
        }
    }
}

#[test]
fn cutting_a_line_into_like_sections_changes_nothing() {
    let mut dice = Dice(12);
    for (name, make) in &CLASSES {
        for _ in 0..50 {
            let line = make(&mut dice);
            let halves = line
                .sections
                .iter()
                .flat_map(|s| {
                    [Section {
                        length: 0.5 * s.length,
                        ..*s
                    }; 2]
                })
                .collect();
            let (whole, cut) = (
                line.solve(),
                Line {
                    sections: halves,
                    ..line.clone()
                }
                .solve(),
            );
            let flexibility: f64 = line
                .sections
                .iter()
                .map(|s| s.length / s.axial_stiffness)
                .sum();
            let scale = whole.tension_a().max(whole.tension_b()) + line.weights();
            let tolerance = 1e-9 * scale + 1e-14 * line.length() / flexibility;
            assert!(
                (whole.tension_b() - cut.tension_b()).abs() <= tolerance,
                "{name}: {line:?}"
            );
            assert!(
                (whole.laid_length() - cut.laid_length()).abs() <= 1e-8 * line.length(),
                "{name}: {line:?}"
            );
        }
    }
}

#[test]
fn a_taut_line_tends_to_its_stiffness_times_its_strain() {
    let strain = 0.02;
    let errors: Vec<f64> = [1.0, 0.1, 0.01, 0.001]
        .map(|weight| {
            let line = Line::uniform(100.0, weight, 1e5, 61.2, 81.6, None).solve();
            0.5 * (line.tension_a() + line.tension_b()) - 1e5 * strain
        })
        .to_vec();
    // the sag's share is quadratic in weight over tension
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log10();
        assert!((order - 2.0).abs() < 0.1, "order {order} of {errors:?}");
    }
}

#[test]
fn a_slack_line_hangs_vertically_and_pulls_with_what_hangs() {
    let bed = Some(Bed {
        height: 0.0,
        friction: 0.3,
    });
    let line = Line::uniform(100.0, 20.0, 1e9, 30.0, 40.0, bed).solve();
    assert_eq!((line.horizontal(), line.tension_a()), (0.0, 0.0));
    // T + T²/2EAw·w = w·40, the stretch of what hangs
    assert_near(
        line.vertical_b() + line.vertical_b().powi(2) / 2e9,
        800.0,
        1e-9,
    );
    assert_near(line.at(100.0).x, 30.0, 1e-12);
}

#[test]
fn a_weightless_line_longer_than_its_chord_pulls_nothing() {
    for length in [50.0, 60.0, 1e4] {
        let line = Line::uniform(length, 0.0, 1e6, 30.0, -40.0, None).solve();
        assert_eq!((line.tension_a(), line.tension_b()), (0.0, 0.0));
        assert_near(line.at(length).z, -40.0, 1e-11);
    }
    let taut = Line::uniform(40.0, 0.0, 1e6, 30.0, -40.0, None).solve();
    assert_near(taut.tension_b(), 1e6 * 0.25, 1e-8);
}

#[test]
fn a_buoyant_line_is_a_heavy_one_upside_down_and_leaves_the_bed_alone() {
    let heavy = Line::uniform(120.0, 7.0, 1e6, 90.0, 20.0, None).solve();
    let bed = Some(Bed {
        height: -20.0,
        friction: 0.7,
    });
    let buoyant = Line::uniform(120.0, -7.0, 1e6, 90.0, -20.0, bed).solve();
    assert_eq!(buoyant.horizontal(), heavy.horizontal());
    assert_eq!(buoyant.vertical_b(), -heavy.vertical_b());
    assert_eq!((buoyant.laid_length(), buoyant.sag()), (0.0, 0.0));
}

#[test]
fn a_line_just_off_the_bed_and_one_just_on_it_pull_alike() {
    let span_of_lift_off = {
        // the span at which V at A passes zero
        let vertical = |span: f64| {
            let free = Line {
                span,
                bed: None,
                ..oc3(0.0)
            };
            free.solve().vertical_a()
        };
        let (mut lower, mut upper) = (850.0, 868.0);
        for _ in 0..60 {
            let middle = 0.5 * (lower + upper);
            if vertical(middle) < 0.0 {
                lower = middle
            } else {
                upper = middle
            }
        }
        lower
    };
    for friction in [0.0, 1.0] {
        let [before, after] = [-1e-9, 1e-9].map(|step| {
            Line {
                span: span_of_lift_off + step,
                ..oc3(friction)
            }
            .solve()
        });
        assert!(before.laid_length() < 1e-3 && after.laid_length() == 0.0);
        assert_near(before.tension_b() / after.tension_b(), 1.0, 1e-8);
    }
}

#[test]
fn what_is_not_a_line_is_refused_with_the_place_and_the_reason() {
    let good = Section {
        length: 10.0,
        weight: 1.0,
        axial_stiffness: 1e5,
    };
    let refuse = |sections: &[Section], span: f64, rise: f64, bed: Option<Bed>| -> String {
        let error: CatenaryError = solve(sections, span, rise, bed).expect_err("it is no line");
        error.to_string()
    };
    assert_eq!(
        refuse(&[], 1.0, 0.0, None),
        "sections: a line needs at least one section, there is none"
    );
    let short = Section {
        length: 0.0,
        ..good
    };
    assert_eq!(
        refuse(&[good, short], 1.0, 0.0, None),
        "sections[1].length: 0 m is not positive and finite"
    );
    let soft = Section {
        axial_stiffness: -5.0,
        ..good
    };
    assert_eq!(
        refuse(&[soft], 1.0, 0.0, None),
        "sections[0].axial_stiffness: -5 N is not positive and finite"
    );
    let odd = Section {
        weight: f64::NAN,
        ..good
    };
    assert_eq!(
        refuse(&[odd], 1.0, 0.0, None),
        "sections[0].weight: NaN N/m is not finite"
    );
    assert_eq!(
        refuse(&[good], -1.0, 0.0, None),
        "span: -1 m is not at least 0 and finite"
    );
    assert_eq!(
        refuse(&[good], 1.0, f64::INFINITY, None),
        "rise: inf m is not finite"
    );
    let rough = Bed {
        height: 0.0,
        friction: -0.1,
    };
    assert_eq!(
        refuse(&[good], 1.0, 0.0, Some(rough)),
        "bed.friction: -0.1 [-] is not at least 0 and finite"
    );
    let high = Bed {
        height: -2.0,
        friction: 0.0,
    };
    let message = "bed.height: the bed at z = -2 m is above end B at z = -3 m; it must be at or below both ends";
    assert_eq!(refuse(&[good], 1.0, -3.0, Some(high)), message);
}
