//! Line that pierces the water surface: its emerged part, and the energy of the buoyancy it loses.
//!
//! A straight piece of line of radius R has the height ζ(u) = (1 − u) ζ₀ + u ζ₁ above the water, 0 ≤ u ≤ 1. With the
//! dry part a(ζ/R) of its cross-section, the dry parts of the halves that are lumped to its two ends are
//!
//!   p₀ = 2 ∫ (1 − u) a du,   p₁ = 2 ∫ u a du,   ∂p/∂ζ = 2 ∫ [(1 − u)², u(1 − u); u(1 − u), u²] a' du,
//!
//! which reduce the buoyancy B of each half by B p₀ and B p₁, the gradient of the potential
//!
//!   C = 2B ∫ χ du,   χ(ζ) = ∫ a dζ from far below: 0 deep under water, ζ in the air.
//!
//! C is convex, so that the surface never makes an equilibrium unstable, and the p are continuous with their slopes. Drag and added mass
//! are taken in proportion to 1 − p. The dry part of the cross-section,
//!
//!   a(x) = ½ + (2/π) x + (5/4 − 4/π) x³ + (2/π − 3/4) x⁵,   −1 ≤ x ≤ 1,
//!
//! is 0 and 1 beyond with slope 0, has the slope of a disc at half draught, so that a line afloat has the stiffness ρ g d of its waterplane, and is
//! within 0.013 of the disc's dry part, ½ + (x √(1 − x²) + arcsin x)/π, everywhere. The same a applies to a steep line, which moves no buoyancy along
//! it. All integrals are exact: the wet, crossing and dry ranges of u are integrated separately, the crossing one by the four-point Gauss rule.
//!
//! Where p changes, the equation of motion is M a = f without the impulse Ṁ v, as for [`super::point`]. Slamming is not modelled.
//!
//! Source: Archimedes' principle on the unstretched volume; lumping by the linear shape functions of a two-node element, e.g. Cook, Malkus & Plesha
//! (1989), Concepts and Applications of Finite Element Analysis, section 2.6; the polynomial is fitted here. Valid for slopes of the water surface
//! that are small over a piece, and for lines thin compared with their length.

use std::f64::consts::FRAC_2_PI;

/// Coefficients of x, x³ and x⁵ in the dry part of a cross-section [-].
const DISC: [f64; 3] = [FRAC_2_PI, 1.25 - 2.0 * FRAC_2_PI, FRAC_2_PI - 0.75];
/// Points in 0 … 1 and weights of the four-point Gauss rule [-].
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Emerged part of a piece of line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Emerged {
    /// Dry parts p₀, p₁ of the halves that are lumped to its ends [-].
    pub parts: [f64; 2],
    /// ∂p₀/∂ζ₀, ∂p₀/∂ζ₁ = ∂p₁/∂ζ₀ and ∂p₁/∂ζ₁ [1/m], none negative.
    pub slopes: [f64; 3],
}

/// Emerged part of a piece of line of `radius` R [m], positive, whose ends are at `heights` [m] above the water; `None` if it is entirely under
/// water.
#[inline]
pub fn emerged(radius: f64, heights: [f64; 2]) -> Option<Emerged> {
    let piece = Piece::new(radius, heights)?;
    let (mut parts, mut slopes) = ([0.0; 2], [0.0; 3]);
    for (u, weight, x) in piece.crossing() {
        let [lower, upper] = [1.0 - u, u];
        let (dry, slope) = (2.0 * weight * dry_part(x), 2.0 * weight * dry_slope(x));
        parts = [parts[0] + lower * dry, parts[1] + upper * dry];
        slopes[0] += lower * lower * slope;
        slopes[1] += lower * upper * slope;
        slopes[2] += upper * upper * slope;
    }
    let rest = 1.0 - piece.end; // all dry
    parts = [parts[0] + rest * rest, parts[1] + rest * (1.0 + piece.end)];
    let mut slopes = slopes.map(|slope| slope / radius);
    if piece.falls {
        parts.reverse();
        slopes.reverse();
    }
    Some(Emerged { parts, slopes })
}

/// ∫ χ du [m] of the same piece: energy of the lost buoyancy, divided by the buoyancy.
pub fn energy(radius: f64, heights: [f64; 2]) -> f64 {
    let Some(piece) = Piece::new(radius, heights) else {
        return 0.0;
    };
    let crossing: f64 = piece
        .crossing()
        .map(|(_, weight, x)| weight * radius * lifted(x))
        .sum();
    let leaves = piece.low + piece.end * piece.rise; // height above which all is dry
    crossing + 0.5 * (1.0 - piece.end) * (leaves + piece.low + piece.rise)
}

/// Maximum slope of p with respect to the height of a level line, 2/πR [1/m].
pub fn slope_max(radius: f64) -> f64 {
    FRAC_2_PI / radius
}

/// Piece that is not fully submerged, from its lower to its higher end.
struct Piece {
    radius: f64,
    /// Height of the lower end above the water [m].
    low: f64,
    /// Height of the higher end above the lower [m].
    rise: f64,
    /// True if the first end is the higher one.
    falls: bool,
    /// u where the section begins to emerge, and where it is fully emerged [-].
    start: f64,
    end: f64,
}

impl Piece {
    fn new(radius: f64, [first, last]: [f64; 2]) -> Option<Piece> {
        let (low, high) = (first.min(last), first.max(last));
        if high <= -radius {
            return None;
        }
        let rise = high - low;
        let reached = |height: f64| {
            let u = (height - low) / rise.max(f64::MIN_POSITIVE);
            u.clamp(0.0, 1.0)
        };
        Some(Piece {
            radius,
            low,
            rise,
            falls: first > last,
            start: reached(-radius),
            end: reached(radius),
        })
    }

    /// Points of the quadrature over the part that crosses the surface: u, weight and ζ/R [-].
    fn crossing(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let width = self.end - self.start;
        let points = if width > 0.0 { &GAUSS[..] } else { &[] };
        points.iter().map(move |&(at, weight)| {
            let u = self.start + width * at;
            let x = (self.low + u * self.rise) / self.radius;
            (u, width * weight, x.clamp(-1.0, 1.0))
        })
    }
}

/// a(x) [-].
fn dry_part(x: f64) -> f64 {
    let [p, q, r] = DISC;
    let square = x * x;
    0.5 + x * (p + square * (q + square * r))
}

/// da/dx [-].
fn dry_slope(x: f64) -> f64 {
    let [p, q, r] = DISC;
    let square = x * x;
    p + square * (3.0 * q + square * 5.0 * r)
}

/// χ/R [-].
fn lifted(x: f64) -> f64 {
    let [p, q, r] = DISC;
    let primitive = |x: f64| {
        let square = x * x;
        0.5 * x + square * (0.5 * p + square * (0.25 * q + square * r / 6.0))
    };
    primitive(x) - primitive(-1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const RADIUS: f64 = 0.05; // [m]

    /// Pieces of every kind: level, nearly level, steep, either end up, crossing, dry and nearly wet.
    const PIECES: [[f64; 2]; 11] = [
        [0.0, 0.0],
        [0.02, 0.02],
        [0.01, 0.01 + 1e-13],
        [-0.03, 0.04],
        [0.06, -0.02],
        [-3.0, 7.0],
        [7.0, -3.0],
        [-0.2, -0.049],
        [-0.06, 0.049],
        [0.3, 0.8],
        [0.01, 4.0],
    ];

    #[test]
    fn a_vertical_line_is_dry_by_what_is_over_the_surface() {
        for [low, high] in [[-3.0, 7.0], [-1.0, 1.0], [-9.0, 0.5]] {
            let at = emerged(RADIUS, [low, high]).unwrap();
            let over = high / (high - low);
            // the curved part at the surface is of the order of the radius squared
            assert_relative_eq!(0.5 * (at.parts[0] + at.parts[1]), over, max_relative = 1e-12);
            assert_relative_eq!(at.parts[0], over * over, epsilon = 1e-3);
            let turned = emerged(RADIUS, [high, low]).unwrap();
            assert_eq!(turned.parts, [at.parts[1], at.parts[0]]);
        }
    }

    #[test]
    fn a_level_line_is_dry_by_the_segment_of_its_disc() {
        for part in -20..=20 {
            let x = f64::from(part) / 20.0;
            let disc = 0.5 + (x * (1.0 - x * x).sqrt() + x.asin()) / std::f64::consts::PI;
            let at = emerged(RADIUS, [x * RADIUS; 2]);
            let dry = at.map_or(0.0, |at| at.parts[0]);
            assert!((dry - disc).abs() < 0.013, "{x}: {dry}, {disc}");
        }
        let half = emerged(RADIUS, [0.0; 2]).unwrap();
        assert_relative_eq!(half.parts[0], 0.5, max_relative = 1e-15);
        let slope = half.slopes[0] + half.slopes[1];
        assert_relative_eq!(slope, slope_max(RADIUS), max_relative = 1e-14);
    }

    #[test]
    fn all_is_wet_below_and_dry_above() {
        assert_eq!(emerged(RADIUS, [-0.05, -2.0]), None);
        assert_eq!(energy(RADIUS, [-0.05, -2.0]), 0.0);
        let above = emerged(RADIUS, [0.05, 2.0]).unwrap();
        assert_eq!((above.parts, above.slopes), ([1.0; 2], [0.0; 3]));
        assert_relative_eq!(energy(RADIUS, [0.05, 2.0]), 1.025, max_relative = 1e-15);
    }

    #[test]
    fn the_parts_are_the_slopes_of_the_energy_and_have_the_slopes_they_say() {
        for heights in PIECES {
            let at = emerged(RADIUS, heights).unwrap();
            for end in 0..2 {
                let step = 1e-5 * RADIUS;
                let moved = |by: f64| {
                    let mut heights = heights;
                    heights[end] += by;
                    heights
                };
                let [low, high] = [moved(-step), moved(step)];
                let slope = (energy(RADIUS, high) - energy(RADIUS, low)) / (2.0 * step);
                assert_relative_eq!(0.5 * at.parts[end], slope, epsilon = 1e-8);
                let [low, high] = [low, high].map(|heights| emerged(RADIUS, heights).unwrap());
                for other in 0..2 {
                    let slope = (high.parts[other] - low.parts[other]) / (2.0 * step);
                    assert_relative_eq!(at.slopes[end + other], slope, epsilon = 3e-4);
                }
            }
        }
    }
}
