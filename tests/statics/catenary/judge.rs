//! The judge: integration of a solved line from its end forces.

use moorline::statics::catenary::{Catenary, Section, is_laid_from_b};

use super::Line;

/// Abscissae and weights of ten-point Gauss-Legendre quadrature on (-1, 1), positive half.
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

/// x, z and elongation [m] over `length` metres of section that start with forces (h, v), without V = 0 inside.
fn integrate(section: &Section, length: f64, h: f64, v: f64) -> [f64; 3] {
    let (w, ea) = (section.weight, section.axial_stiffness);
    let (start, end) = (h.hypot(v), h.hypot(v + w * length));
    if h == 0.0 || (w * length).abs() <= 0.5 * start.min(end) {
        return quadrature(0.0, length, |s| {
            let v = v + w * s;
            let t = h.hypot(v);
            let rate = if t > 0.0 { 1.0 / t + 1.0 / ea } else { 1.0 / ea };
            [h * rate, v * rate, t / ea]
        });
    }
    // V = H sinh β resolves the bend where V is small
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
    /// Greatest deviation so far, relative to length or force [-].
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
            self.stay_above_seabed();
        }
        self.v = end;
    }

    fn stay_above_seabed(&mut self) {
        if let Some(seabed) = self.line.seabed {
            let below = (seabed.height - self.z).max(0.0);
            self.miss(below, self.length_scale());
        }
    }

    fn lie(&mut self, section: &Section, to: f64) {
        let seabed = self.line.seabed.expect("only a seabed carries");
        let length = to - self.s;
        assert!(section.weight >= 0.0, "what floats does not lie: {:?}", self.line);
        self.miss(self.v, self.force_scale());
        self.miss(self.z - seabed.height, self.length_scale());
        let (before, after) = (self.h, self.solved.at(to).horizontal);
        let friction = self.solved.friction();
        assert!(friction <= seabed.friction, "Coulomb's law: {:?}", self.line);
        let gain = friction * section.weight * length;
        let heights = [-seabed.height, self.line.rise - seabed.height];
        let [laid_first, hauled] = match is_laid_from_b(heights, self.line.length()) {
            true => [after, before],
            false => [before, after],
        };
        let elongation = if laid_first > 0.0 || gain == 0.0 {
            self.miss(hauled - laid_first - gain, self.force_scale());
            length * 0.5 * (before + after)
        } else {
            self.miss((hauled - gain).max(0.0), self.force_scale());
            0.5 * hauled * hauled / (friction * section.weight)
        } / section.axial_stiffness;
        if before == 0.0 && after == 0.0 {
            // without tension it may lie anywhere that its length allows
            let x = self.solved.at(to).x;
            self.miss(((x - self.x).abs() - length).max(0.0), self.length_scale());
            self.x = x;
        } else {
            self.x += length + elongation;
        }
        self.elongation += elongation;
        (self.h, self.v, self.z) = (after, 0.0, seabed.height);
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
        self.miss((point.x - self.x).hypot(point.z - self.z), self.length_scale());
        let force = (point.horizontal - self.h).hypot(point.vertical - self.v);
        self.miss(force, self.force_scale());
        // residuals within the tolerance are ignored: far from A, or beyond a heavy section, a part may carry less
        // than the rounding error of V at A or of s times w
        if force < 1e-12 * self.force_scale() {
            self.v = point.vertical;
        }
    }
}

/// Greatest violation of the cable equations by the solved line, relative to its length or its greatest force [-].
pub fn judge(line: &Line, solved: &Catenary) -> f64 {
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
        let thirds = |&(from, to): &(f64, f64)| [from, 0.5 * (from + to), to];
        let mut cuts: Vec<f64> = laid.iter().flat_map(thirds).collect();
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
    let stretched = walk.elongation + line.length();
    walk.miss(stretched - solved.stretched_length(), walk.length_scale());
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
