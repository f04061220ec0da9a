//! The elastic catenary in closed form: a line held at two ends, with or without a seabed.
//!
//! ```text
//!  z ↑          ● B (span, rise)        H    horizontal tension, constant in flight
//!    │        ╱                         V    vertical tension, V' = w; up going from A to B
//!    ● A    ╱                           T    √(H² + V²)
//!     ╲___╱        seabed, z = height      s    unstretched arc length from A
//! ```
//!
//! dx/ds = H/T + H/EA,   dz/ds = V/T + V/EA,   dV/ds = w in flight;   V = 0, dH/ds = μw (or H = 0) on the seabed
//!
//! # One stretch
//! Over a uniform stretch ℓ with V from Vₐ to V_b = Vₐ + W, W = wℓ, tensions Tₐ and T_b, mean Vₘ and mean σ = (Tₐ + T_b)/2:
//! T_b² − Tₐ² = 2WVₘ, so T_b − Tₐ = WVₘ/σ, and the textbook's z = (T_b − Tₐ)/w + Vₘℓ/EA is
//!
//! z = Vₘℓ (1/σ + 1/EA).
//!
//! With V = H sinh of μₘ ± λ at the ends, W = 2H cosh μₘ sinh λ and 2σ = 2H cosh μₘ cosh λ, so ε = W/2σ = tanh λ and the
//! textbook's x = (H/w)(asinh V_b/H − asinh Vₐ/H) + Hℓ/EA = 2Hλ/w + Hℓ/EA is
//!
//! x = Hℓ (α/σ + 1/EA),   α = atanh(ε)/ε.
//!
//! No differences of large numbers remain, and w = 0 (α = 1, σ = T) needs no special case.
//!
//! # One equation
//! From the same identities H² = (σ² − Vₘ²)(1 − ε²). A line held at ends X, Z apart has H = X/(L(α/σ + 1/EA)) and Vₘ = Z/(L(1/σ + 1/EA)), both
//! functions of σ = W/(2 tanh λ) alone. Inserted into that identity, they give one equation in λ,
//!
//! X²/(λ/sinh λ + (σ/EA)/cosh λ)² + Z²/(1 + σ/EA)² = L²,
//!
//! whose left side increases with λ, so there is exactly one root. Without stretch it is the classical X sinh λ/λ = √(L² − Z²). The module `uniform`
//! balances it so that no digits are lost.
//!
//! # The seabed
//! A flight from the seabed rises by D where T − H + V²/2EA = wD, a quadratic in V². Two flights and the part between them must span X. With the
//! excess of a flight's length over its span, (H/w)(sinh β − β) with sinh β = V/H, this is one balance in H (`touchdown`). Without tension the
//! flights hang vertically and the rest of the line is slack: H = 0, the layout is not unique, and the returned one spreads the slack evenly.
//! Friction acts towards A, as on a line laid from A and hauled at B; it acts towards B if B lies on the seabed and A does not ([`is_laid_from_b`]).
//!
//! # Several sections
//! The line is laid out from A under a trial tension, which is searched so that the line ends at B (`sections`). Buoyant sections rise off the seabed
//! without an upper limit.
//!
//! # Source and validity
//! The elastic catenary: H. M. Irvine, Cable Structures, MIT Press, 1981. Touchdown with friction as a model: J. M. Jonkman, Dynamics Modeling and
//! Loads Analysis of an Offshore Floating Wind Turbine, NREL/TP-500-41958, 2007. The forms solved here are derived above. Linear stretch (tension EA
//! times engineering strain), weight per unstretched length, no bending stiffness, a flat rigid seabed.
//!
//! ```
//! use moorline::physics::catenary::{FlatSeabed, Section, solve};
//!
//! let chain = Section { length: 902.2, weight: 698.094, axial_stiffness: 384.243e6 };
//! let seabed = FlatSeabed { height: 0.0, friction: 0.0 };
//! let line = solve(&[chain], 848.67, 250.0, Some(seabed))?;
//! assert!((line.tension_b() - 911_088.36).abs() < 0.01);
//! assert!((line.laid_length() - 134.7855).abs() < 1e-4);
//! # Ok::<(), moorline::physics::catenary::CatenaryError>(())
//! ```

mod energy;
mod flight;
mod root;
mod sections;
mod shape;
mod stiffness;
mod touchdown;
mod uniform;

pub use energy::CatenaryEnergy;
use sections::Sections;
use shape::{Kind, Piece, Shape};
pub use stiffness::in_flight;
use touchdown::Touchdown;
use uniform::{EndForces, Uniform};

/// Height above the seabed, relative to the line length, up to which an end counts as lying on it for friction [-].
const ON_SEABED: f64 = 0.02;
/// Depth below the seabed, relative to the line length, up to which an end counts as lying on it, for rounding of positions [-].
const SEABED_TOLERANCE: f64 = 1e-12;

/// Uniform part of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Unstretched length [m].
    pub length: f64,
    /// Weight in the surrounding fluid per unstretched length [N/m]; negative if buoyant.
    pub weight: f64,
    /// Axial stiffness EA [N].
    pub axial_stiffness: f64,
}

/// Section of a length [m], a weight [N/m] and a stiffness EA [N].
#[cfg(test)]
fn section(length: f64, weight: f64, axial_stiffness: f64) -> Section {
    Section {
        length,
        weight,
        axial_stiffness,
    }
}

/// Flat seabed on which the line may lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatSeabed {
    /// z of the seabed relative to end A [m]: 0 where A lies on it, negative below.
    pub height: f64,
    /// Coulomb friction coefficient along the line [-]: on the seabed, tension falls towards A by friction × weight per metre, not below 0; towards B
    /// if the line is laid from B.
    pub friction: f64,
}

/// Reason why the input does not describe a line.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CatenaryError {
    /// The list of sections is empty.
    #[error("sections: a line needs at least one section, there is none")]
    NoSections,
    /// A property of a section is out of range.
    #[error("sections[{index}].{key}: {value} {unit} is not {wanted}")]
    Section {
        /// Position in the list, from 0 [-].
        index: usize,
        /// Name of the property.
        key: &'static str,
        /// Value given, in `unit`.
        value: f64,
        /// Unit of the value.
        unit: &'static str,
        /// Valid range.
        wanted: &'static str,
    },
    /// Span, rise, or a property of the seabed is out of range.
    #[error("{key}: {value} {unit} is not {wanted}")]
    Input {
        /// Name of the input.
        key: &'static str,
        /// Value given, in `unit`.
        value: f64,
        /// Unit of the value.
        unit: &'static str,
        /// Valid range.
        wanted: &'static str,
    },
    /// An end lies below the seabed.
    #[error(
        "seabed.height: the seabed at z = {seabed} m is above end {end} at z = {z} m; it must be at or below both ends"
    )]
    EndBelowSeabed {
        /// Name of the end, A or B.
        end: char,
        /// Height of that end relative to A [m].
        z: f64,
        /// Height of the seabed relative to A [m].
        seabed: f64,
    },
}

/// A material point of a solved line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Horizontal distance from end A [m].
    pub x: f64,
    /// Height above end A [m].
    pub z: f64,
    /// Horizontal tension [N].
    pub horizontal: f64,
    /// Vertical tension [N]: positive where the tension vector points up going from A to B.
    pub vertical: f64,
    /// Tension [N].
    pub tension: f64,
}

/// Solved line.
#[derive(Debug, Clone)]
pub struct Catenary {
    shape: Shape,
    held: EndForces,
    span: f64,
    rise: f64,
}

/// Solves the line of `sections`, from end A to end B, whose ends are `span` apart horizontally, with B `rise` above A [m].
///
/// # Errors
/// Fails if a value is not finite, or not positive where it must be, if there is no section, or if an end lies below the seabed. Every valid line has
/// a solution.
pub fn solve(
    sections: &[Section],
    span: f64,
    rise: f64,
    seabed: Option<FlatSeabed>,
) -> Result<Catenary, CatenaryError> {
    let seabed = check(sections, span, rise, seabed)?;
    let length: f64 = sections.iter().map(|section| section.length).sum();
    let has_friction = |seabed: &FlatSeabed| seabed.friction > 0.0;
    let (shape, held) = match seabed.filter(has_friction) {
        Some(seabed) if is_laid_from_b([-seabed.height, rise - seabed.height], length) => {
            let reversed: Vec<Section> = sections.iter().rev().copied().collect();
            let seabed = FlatSeabed {
                height: seabed.height - rise,
                ..seabed
            };
            let (shape, held) = solve_from_a(&reversed, span, -rise, Some(seabed));
            (shape.reversed(), held.reversed())
        }
        _ => solve_from_a(sections, span, rise, seabed),
    };
    let forces = held.horizontal_a + held.horizontal_b + held.vertical_a + held.vertical_b;
    assert!(
        forces.is_finite(),
        "a valid line has finite end forces: {sections:?}, span {span}, rise {rise}, {seabed:?}, {held:?}"
    );
    Ok(Catenary {
        shape,
        held,
        span,
        rise,
    })
}

/// Returns whether friction acts as on a line laid from end B and hauled at end A: B lies on the seabed and A does not. The heights of both ends
/// above the seabed and the line `length` are in [m].
pub fn is_laid_from_b([a, b]: [f64; 2], length: f64) -> bool {
    b <= ON_SEABED * length && a > ON_SEABED * length
}

/// Solves a line that is laid from end A.
fn solve_from_a(
    sections: &[Section],
    span: f64,
    rise: f64,
    seabed: Option<FlatSeabed>,
) -> (Shape, EndForces) {
    match uniform(sections) {
        Some(section) => solve_uniform(&section, span, rise, seabed),
        None => solve_sections(sections, span, rise, seabed),
    }
}

/// Single section equivalent to `sections`, if they all have the same properties.
fn uniform(sections: &[Section]) -> Option<Section> {
    let first = sections[0];
    let alike = |s: &Section| s.weight == first.weight && s.axial_stiffness == first.axial_stiffness;
    let length = sections.iter().map(|section| section.length).sum();
    sections.iter().all(alike).then_some(Section { length, ..first })
}

fn solve_uniform(section: &Section, span: f64, rise: f64, seabed: Option<FlatSeabed>) -> (Shape, EndForces) {
    let line = Uniform {
        length: section.length,
        weight: section.weight,
        axial_stiffness: section.axial_stiffness,
    };
    let held = line.suspend(span, rise);
    match seabed {
        Some(seabed) if lowest(section, &held) < seabed.height => {
            if seabed.friction > 0.0 && seabed.height < 0.0 {
                let mut shape = Shape::default();
                let frictionless = Touchdown {
                    span,
                    height_a: -seabed.height,
                    height_b: rise - seabed.height,
                    friction: 0.0,
                };
                let guess = line.touch_down(&frictionless);
                let laid = section.length - (guess.vertical_b - guess.vertical_a) / section.weight;
                // the frictionless H is about the mean along the seabed
                let horizontal_a = guess.horizontal_a - 0.5 * seabed.friction * section.weight * laid;
                let mut line = Sections::new(std::slice::from_ref(section), span, rise, Some(seabed));
                let held = line.solve((horizontal_a, guess.vertical_a), &mut shape);
                return (shape, held);
            }
            let height_b = rise - seabed.height;
            let at = Touchdown {
                span,
                height_a: -seabed.height,
                height_b,
                friction: seabed.friction,
            };
            let held = line.touch_down(&at);
            (touchdown_shape(section, &held, seabed, span), held)
        }
        _ => (suspended_shape(section, &held, span, rise), held),
    }
}

/// Height of the lowest point between the ends of a suspended uniform line, relative to A [m].
fn lowest(section: &Section, held: &EndForces) -> f64 {
    let (h, v) = (held.horizontal_a, held.vertical_a);
    if section.weight <= 0.0 || v >= 0.0 || held.vertical_b <= 0.0 {
        return 0.0;
    }
    -v * v / section.weight * (1.0 / (h.hypot(v) + h) + 0.5 / section.axial_stiffness)
}

fn suspended_shape(section: &Section, held: &EndForces, span: f64, rise: f64) -> Shape {
    let mut shape = Shape::default();
    if held.horizontal_a == 0.0 && held.vertical_a == 0.0 && held.vertical_b == 0.0 {
        let (x, z) = (span / section.length, rise / section.length);
        shape.push(
            section.length,
            Kind::Slack {
                x,
                z,
                weight: section.weight,
                on_seabed: false,
            },
        );
    } else {
        shape.fly(section, section.length, held.horizontal_a, held.vertical_a);
    }
    shape
}

fn touchdown_shape(section: &Section, held: &EndForces, seabed: FlatSeabed, span: f64) -> Shape {
    let mut shape = Shape::default();
    let (a, b) = (
        -held.vertical_a / section.weight,
        held.vertical_b / section.weight,
    );
    let growth = seabed.friction * section.weight;
    shape.fly(section, a, held.horizontal_a, held.vertical_a);
    let laid = (section.length - a - b).max(0.0);
    let slack = held.horizontal_a == 0.0 && held.horizontal_b == 0.0;
    let tight = match held.horizontal_a {
        0.0 if slack => 0.0,
        0.0 => (held.horizontal_b / growth).min(laid),
        _ => laid,
    };
    shape.lay(section, laid - tight, 0.0, 0.0);
    shape.lay(section, tight, held.horizontal_a, growth);
    shape.fly(section, b, held.horizontal_b, 0.0);
    if slack {
        shape.close(span);
    }
    shape
}

fn solve_sections(
    sections: &[Section],
    span: f64,
    rise: f64,
    seabed: Option<FlatSeabed>,
) -> (Shape, EndForces) {
    let length: f64 = sections.iter().map(|s| s.length).sum();
    let flexibility: f64 = sections.iter().map(|s| s.length / s.axial_stiffness).sum();
    let mut shape = Shape::default();
    if sections.iter().all(|section| section.weight == 0.0) {
        let held = suspend_weightless(sections, span, rise, &mut shape);
        return (shape, held);
    }
    let weight: f64 = sections.iter().map(|s| s.weight * s.length).sum();
    let alike = Uniform {
        length,
        weight: weight / length,
        axial_stiffness: length / flexibility,
    };
    let suspended = alike.suspend(span, rise);
    let guess = match seabed {
        Some(seabed) if alike.weight > 0.0 && suspended.vertical_a < 0.0 => {
            let (height_a, height_b) = (-seabed.height, rise - seabed.height);
            let friction = if height_a == 0.0 { seabed.friction } else { 0.0 };
            alike.touch_down(&Touchdown {
                span,
                height_a,
                height_b,
                friction,
            })
        }
        _ => suspended,
    };
    let mut line = Sections::new(sections, span, rise, seabed);
    let held = line.solve((guess.horizontal_a, guess.vertical_a), &mut shape);
    (shape, held)
}

fn suspend_weightless(sections: &[Section], span: f64, rise: f64, shape: &mut Shape) -> EndForces {
    let length: f64 = sections.iter().map(|s| s.length).sum();
    let flexibility: f64 = sections.iter().map(|s| s.length / s.axial_stiffness).sum();
    let alike = Uniform {
        length,
        weight: 0.0,
        axial_stiffness: length / flexibility,
    };
    let held = alike.suspend(span, rise);
    for section in sections {
        if held.horizontal_a == 0.0 && held.vertical_a == 0.0 {
            shape.push(
                section.length,
                Kind::Slack {
                    x: span / length,
                    z: rise / length,
                    weight: section.weight,
                    on_seabed: false,
                },
            );
        } else {
            shape.fly(section, section.length, held.horizontal_a, held.vertical_a);
        }
    }
    held
}

/// Checks the input; returns the seabed, lowered to any end that is below it only by rounding.
fn check(
    sections: &[Section],
    span: f64,
    rise: f64,
    seabed: Option<FlatSeabed>,
) -> Result<Option<FlatSeabed>, CatenaryError> {
    if sections.is_empty() {
        return Err(CatenaryError::NoSections);
    }
    for (index, section) in sections.iter().enumerate() {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let complain = |key, value, unit, wanted| {
            Err(CatenaryError::Section {
                index,
                key,
                value,
                unit,
                wanted,
            })
        };
        if !positive(section.length) {
            return complain("length", section.length, "m", "positive and finite");
        }
        if !positive(section.axial_stiffness) {
            return complain(
                "axial_stiffness",
                section.axial_stiffness,
                "N",
                "positive and finite",
            );
        }
        if !section.weight.is_finite() {
            return complain("weight", section.weight, "N/m", "finite");
        }
    }
    let complain = |key, value, unit, wanted| {
        Err(CatenaryError::Input {
            key,
            value,
            unit,
            wanted,
        })
    };
    if !(span >= 0.0 && span.is_finite()) {
        return complain("span", span, "m", "at least 0 and finite");
    }
    if !rise.is_finite() {
        return complain("rise", rise, "m", "finite");
    }
    let Some(seabed) = seabed else { return Ok(None) };
    if !(seabed.friction >= 0.0 && seabed.friction.is_finite()) {
        return complain("seabed.friction", seabed.friction, "[-]", "at least 0 and finite");
    }
    if !seabed.height.is_finite() {
        return complain("seabed.height", seabed.height, "m", "finite");
    }
    let (end, z) = if rise < 0.0 { ('B', rise) } else { ('A', 0.0) };
    let length: f64 = sections.iter().map(|section| section.length).sum();
    if seabed.height > z + SEABED_TOLERANCE * length {
        return Err(CatenaryError::EndBelowSeabed {
            end,
            z,
            seabed: seabed.height,
        });
    }
    Ok(Some(FlatSeabed {
        height: seabed.height.min(z),
        ..seabed
    }))
}

impl Catenary {
    /// Horizontal tension at end B [N].
    pub fn horizontal(&self) -> f64 {
        self.held.horizontal_b
    }

    /// Horizontal tension at end A [N]: the tension at B less the friction of the seabed.
    pub fn horizontal_a(&self) -> f64 {
        self.held.horizontal_a
    }

    /// Vertical tension at end A [N]: positive where the tension vector points up going from A to B, so negative where the line sags below A.
    pub fn vertical_a(&self) -> f64 {
        self.held.vertical_a
    }

    /// Vertical tension at end B [N]: positive where the tension vector points up going from A to B.
    pub fn vertical_b(&self) -> f64 {
        self.held.vertical_b
    }

    /// Tension at end A [N].
    pub fn tension_a(&self) -> f64 {
        self.held.horizontal_a.hypot(self.held.vertical_a)
    }

    /// Tension at end B [N].
    pub fn tension_b(&self) -> f64 {
        self.held.horizontal_b.hypot(self.held.vertical_b)
    }

    /// Mobilised Coulomb friction coefficient of the tensioned part on the seabed [-]: that of the seabed, or less if sections float and no state
    /// mobilises all of it; 0 if nothing lies on the seabed.
    pub fn friction(&self) -> f64 {
        if self.laid().next().is_some() {
            self.held.friction
        } else {
            0.0
        }
    }

    /// Unstretched length on the seabed [m].
    pub fn laid_length(&self) -> f64 {
        self.laid().map(|(from, to)| to - from).sum()
    }

    /// Parts on the seabed, as unstretched arc lengths (from, to) from end A [m].
    pub fn laid(&self) -> impl Iterator<Item = (f64, f64)> {
        let on_seabed = self.shape.pieces.iter().filter(|piece| piece.on_seabed());
        on_seabed.map(|piece| (piece.s, piece.s + piece.length))
    }

    /// Length of the line under its tension [m].
    pub fn stretched_length(&self) -> f64 {
        self.shape
            .pieces
            .iter()
            .map(|piece| piece.length + piece.elongation())
            .sum()
    }

    /// Maximum vertical distance below the chord between the ends [m]; below the lower end where the span is 0.
    pub fn sag(&self) -> f64 {
        self.shape.sag(self.span, self.rise)
    }

    /// Material point at the unstretched arc length `s` from end A [m]; beyond an end, that end.
    pub fn at(&self, s: f64) -> Point {
        self.shape.at(s)
    }

    /// Energy of the line, with heights measured upwards from end A.
    pub fn energy(&self) -> CatenaryEnergy {
        self.shape.pieces.iter().map(Piece::energy).sum()
    }

    /// Number of evaluations of the solved equation [-].
    pub fn iterations(&self) -> usize {
        self.held.steps
    }
}
