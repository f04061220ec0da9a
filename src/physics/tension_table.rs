//! Tension of a line tabulated over strain: a monotone curve through the rows of the table.
//!
//! Between two rows the tension is the cubic Hermite polynomial with the slopes of [`rising_slopes`]. The minimum slope at the first row ensures that
//! a line at rest resists the first pull. The curve is continuous with its slope, rises wherever the table rises, and continues beyond the last row
//! with the last slope (MoorDyn keeps the last tension there). Below zero strain it continues with the first slope, which does not affect a line that
//! cannot push. Its energy is the exact integral.
//!
//! Source: [`crate::math::shape_preserving`]. Valid for rows that begin at (0, 0) and rise in strain and in tension.

use std::sync::Arc;

use super::stretch::Stretch;
use crate::math::hermite::Hermite;
use crate::math::shape_preserving::rising_slopes;

/// Curve through a table, divided by its steepest slope EA.
#[derive(Debug, Clone, PartialEq)]
pub struct TensionTable {
    pieces: Arc<[Piece]>,
}

/// Curve from one row to the next; all values are divided by EA.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    /// Strain at the start of the piece [-].
    start: f64,
    /// Length of the piece in strain [-]; infinite beyond the last row.
    span: f64,
    /// Energy per unstretched length at the start of the piece [-].
    energy: f64,
    /// Coefficients of powers of the strain from its start.
    powers: [f64; 4],
}

impl TensionTable {
    /// Curve through rows of strain [-] and tension [N], with its steepest slope EA [N], by which its values are
    /// divided.
    pub fn through(rows: &[[f64; 2]]) -> (TensionTable, f64) {
        assert!(rows.len() > 1, "a curve goes through two rows at least");
        let (strains, tensions): (Vec<f64>, Vec<f64>) = rows.iter().map(|row| (row[0], row[1])).unzip();
        let slopes = rising_slopes(&strains, &tensions);
        let mut pieces: Vec<Piece> = rows
            .windows(2)
            .zip(slopes.windows(2))
            .map(|(pair, slopes)| Piece::between([pair[0], pair[1]], [slopes[0], slopes[1]]))
            .collect();
        let ([strain, tension], slope) = (rows[rows.len() - 1], slopes[slopes.len() - 1]);
        pieces.push(Piece {
            start: strain,
            span: f64::INFINITY,
            energy: 0.0,
            powers: [tension, slope, 0.0, 0.0],
        });
        let steepest = pieces.iter().map(Piece::steepest).fold(0.0, f64::max);
        let mut energy = 0.0;
        for piece in &mut pieces {
            piece.powers = piece.powers.map(|power| power / steepest);
            piece.energy = energy;
            if piece.span.is_finite() {
                energy = piece.at(piece.start + piece.span).energy;
            }
        }
        let pieces = pieces.into();
        (TensionTable { pieces }, steepest)
    }

    /// Value, slope and energy at a strain [-], divided by EA.
    #[inline]
    pub fn at(&self, strain: f64) -> Stretch {
        let (first, later) = (&self.pieces[0], &self.pieces[1..]);
        if strain < first.start {
            let slope = first.powers[1];
            return Stretch {
                force: slope * strain,
                slope,
                energy: 0.5 * slope * strain * strain,
            };
        }
        let piece = later.iter().take_while(|piece| strain >= piece.start);
        piece.last().unwrap_or(first).at(strain)
    }
}

impl Piece {
    /// Cubic through two rows with the slopes there.
    fn between([low, high]: [[f64; 2]; 2], [start, end]: [f64; 2]) -> Piece {
        let span = high[0] - low[0];
        let cubic = Hermite::new((low[0], low[1], start), (high[0], high[1], end));
        let [a, b, c, d] = cubic.powers();
        Piece {
            start: low[0],
            span,
            energy: 0.0,
            powers: [a, b / span, c / (span * span), d / (span * span * span)],
        }
    }

    fn at(&self, strain: f64) -> Stretch {
        let [a, b, c, d] = self.powers;
        let u = strain - self.start;
        Stretch {
            force: a + u * (b + u * (c + u * d)),
            slope: b + u * (2.0 * c + 3.0 * u * d),
            energy: self.energy + u * (a + u * (b / 2.0 + u * (c / 3.0 + u * d / 4.0))),
        }
    }

    /// Maximum slope of the piece: at one of its ends, or where the second derivative is zero.
    fn steepest(&self) -> f64 {
        let [_, b, c, d] = self.powers;
        if !self.span.is_finite() {
            return b;
        }
        let slope = |u: f64| b + u * (2.0 * c + 3.0 * u * d);
        let vertex = -c / (3.0 * d);
        let within = (0.0..=self.span).contains(&vertex);
        let ends = slope(0.0).max(slope(self.span));
        if within { ends.max(slope(vertex)) } else { ends }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::tests::central;
    use approx::assert_relative_eq;

    /// Strain [-] and tension [N] of a rope that stiffens, yields and stiffens.
    const ROPE: [[f64; 2]; 6] = [
        [0.0, 0.0],
        [0.01, 2.0e4],
        [0.03, 3.0e5],
        [0.05, 3.6e5],
        [0.1, 4.0e5],
        [0.12, 1.5e6],
    ];

    #[test]
    fn the_curve_goes_through_its_rows() {
        let (table, ea) = TensionTable::through(&ROPE);
        for [strain, tension] in ROPE {
            assert_relative_eq!(ea * table.at(strain).force, tension, max_relative = 1e-13);
        }
    }

    #[test]
    fn tension_is_the_slope_of_the_energy_and_slope_that_of_the_tension() {
        let (table, _) = TensionTable::through(&ROPE);
        for i in -20..300 {
            let strain = 0.0005 * f64::from(i) + 0.00021;
            let (at, by) = (table.at(strain), |h| table.at(strain + h));
            let (force, slope) = (central(1e-6, |h| by(h).energy), central(1e-6, |h| by(h).force));
            assert_relative_eq!(force, at.force, max_relative = 1e-6, epsilon = 1e-9);
            assert_relative_eq!(slope, at.slope, max_relative = 1e-5, epsilon = 1e-6);
        }
    }

    #[test]
    fn the_curve_rises_wherever_its_table_does_and_nowhere_faster_than_its_greatest_slope() {
        let (table, _) = TensionTable::through(&ROPE);
        let slopes = (0..20_000).map(|i| table.at(1e-5 * f64::from(i)).slope);
        let (least, greatest) = slopes.fold((f64::INFINITY, 0.0_f64), |(least, most), slope| {
            (least.min(slope), most.max(slope))
        });
        assert!(least > 0.0, "{least}");
        assert_relative_eq!(greatest, 1.0, max_relative = 1e-5);
    }

    #[test]
    fn the_curve_goes_on_straight_beyond_its_rows() {
        let (table, _) = TensionTable::through(&ROPE);
        let (first, last) = (table.at(0.0).slope, table.at(0.12).slope);
        for beyond in [0.01, 0.5] {
            assert_relative_eq!(table.at(0.12 + beyond).slope, last);
            assert_relative_eq!(table.at(-beyond).slope, first);
        }
    }

    #[test]
    fn two_rows_are_a_straight_line() {
        let (table, ea) = TensionTable::through(&[[0.0, 0.0], [0.02, 5.0e5]]);
        assert_relative_eq!(ea, 2.5e7, max_relative = 1e-14);
        for strain in [1e-3, 0.02, 0.3] {
            assert_relative_eq!(table.at(strain).force, strain, max_relative = 1e-14);
        }
    }
}
