//! The elastic catenary against 60-digit references and, on random lines of every class, against the equations of the cable.
//!
//! ```text
//!                        ● B        judged: the end forces the solver gives are integrated from A to B along the line by
//!                      ╱            Gauss quadrature of dx/ds = H/T + H/EA, dz/ds = V/T + V/EA, dV/ds = w; the walk must
//!  A ●══════════════╱               arrive at B, with B's forces, never under the seabed, and on it obey Coulomb's law
//! ```
//!
//! `tests/reference/catenary.csv` is made by `python_tests/make_catenary_reference.py`. Source of the published figures: SeaFEM
//! validation case 11; the MAP++ summary of the OC3 Hywind line in the OpenFAST regression tests.

mod claims;
mod judge;
mod random;
mod references;

use moorline::statics::catenary::{Catenary, FlatSeabed, Section, solve};

/// A line to solve.
#[derive(Debug, Clone)]
struct Line {
    sections: Vec<Section>,
    span: f64,
    rise: f64,
    seabed: Option<FlatSeabed>,
}

/// A seabed at a height over end A [m] with a friction [-].
fn seabed(height: f64, friction: f64) -> Option<FlatSeabed> {
    Some(FlatSeabed { height, friction })
}

impl Line {
    fn of(sections: Vec<Section>, span: f64, rise: f64, seabed: Option<FlatSeabed>) -> Line {
        Line {
            sections,
            span,
            rise,
            seabed,
        }
    }

    /// A line of one section, whose length [m], weight [N/m] and axial stiffness [N] these are.
    fn uniform(
        [length, weight, axial_stiffness]: [f64; 3],
        [span, rise]: [f64; 2],
        seabed: Option<FlatSeabed>,
    ) -> Line {
        Line::of(
            vec![Section {
                length,
                weight,
                axial_stiffness,
            }],
            span,
            rise,
            seabed,
        )
    }

    fn solve(&self) -> Catenary {
        solve(&self.sections, self.span, self.rise, self.seabed).unwrap_or_else(|e| panic!("{e}: {self:?}"))
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

    /// Difference of forces that rounding may make [N]: a change of L by one rounding changes the force by Δ = EA ε/strain at most.
    fn rounding(&self, solved: &Catenary) -> f64 {
        let flexibility: f64 = self.sections.iter().map(|s| s.length / s.axial_stiffness).sum();
        let scale = solved.tension_a().max(solved.tension_b()) + self.weights();
        1e-9 * scale + 1e-14 * self.length() / flexibility
    }
}
