//! Elements of a line whose number the scene leaves open.
//!
//! The lumped two-node line has a relative error of about 0.8/n in the RMS of a fairlead tension (4 % at n = 20, 1.8
//! % at n = 40 on a 900 m catenary), so n = 0.8/tolerance if the scene gives no motion; otherwise
//! [`crate::discretisation`] selects n. The longest of the lines that meet at free points has n elements, the others a
//! number in proportion to their length, at least one.
//!
//! Sections share a line's elements in proportion to length. Where this would put a long element next to one that is more than
//! [`RATIO_MAX`] times shorter, the elements of the section with the long ones grow from the border, with lengths
//! h(s) such that |dh/ds| ≤ [`GROWTH`]:
//!
//! h(s) = min(h_section, h_other + G·distance to it, h_fine + G·distance to its place).
//!
//! A cable with bending stiffness adapts to a clamp, and lifts off the seabed, over the length √(EI/T): h_fine is half of that at the touchdown.
//! At a clamp it follows from the tolerance: with elements of length h, the curvature there has an error of 0.02 h²T/EI where the tension varies.
//!
//! Sections with a given number of elements have elements of equal length, regardless of their neighbours; a neighbour without a given
//! number adapts if its elements are longer.
//!
//! Alternatives that were measured and rejected, on the public scenes and ten variants with n = 14 to 40:
//! * elements of three times the length on the part that always lies on the seabed: 12 % less work on average, 26 % at most, and 8 % more
//!   RMS error, 24 to 36 % on the lines with the longest part on the seabed: worse than fewer elements along the whole line;
//! * unstretched lengths shortened by (hκ)²/24 for the static curvature κ, chords instead of arcs: with 14 elements the error of the position at
//!   mid-length falls to 0.45 of its value on oc3_catenary and 0.64 on oc4_chain, that of the tension to 0.94 on average, with no gain where the line
//!   slackens. The discrete equilibrium moves, which is compared with published values. If the stiffness includes the compliance of that sag too,
//!   1/EA' = 1/EA + (qh)²/(12T³) as given by Ernst (1965) for a whole cable, q being the transverse weight and T the tension at rest, the error of the
//!   tension is 1.3 to 1.4 times as great on both (14 to 28 elements): a weight is too slow to follow waves along the line. On taut_polyester neither
//!   has an effect, since (hκ)²/24 is 5e-8 with 10 elements: the curvature of that rope comes from drag. The error of its tension was at the end, see
//!   `dynamics/reaction.rs`.
//!
//! Elements of half the length at the touchdown of a line without bending stiffness were measured with the same total
//! number of elements (oc3 and oc4 scenes, n = 20 to 120, regularised contact): the error of the tension did not
//! fall, and the explicit step halved. They are not used.

/// RMS tension error times the number of elements of a line [-].
const ERROR_TIMES_ELEMENTS: f64 = 0.8;
const LINE_ELEMENTS_MIN: f64 = 10.0;
const LINE_ELEMENTS_MAX: f64 = 400.0;
/// Ratio of the length of an element to that of a shorter neighbour above which lengths are graded [-].
pub(crate) const RATIO_MAX: f64 = 1.5;
/// Growth of the element length along the line [-]: a factor of e^0.25 from one element to the next.
const GROWTH: f64 = 0.25;
/// Maximum number of elements of a section that is too short to be graded well [-].
const FEW: usize = 3;
/// Number of quadrature points of 1/h in every element [-].
const QUADRATURE: f64 = 40.0;
/// Factor by which fine elements are lengthened, repeatedly, until the line has no more than the maximum number of elements [-].
const COARSENING: f64 = 1.25;

/// Section as used by the mesher.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Piece {
    /// Unstretched length [m].
    pub length: f64,
    /// Number of elements, if the scene gives one.
    pub elements: Option<usize>,
}

/// Place with short elements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Refinement {
    /// Arc length at the start [m].
    pub from: f64,
    /// Arc length at the end [m].
    pub to: f64,
    /// Length of elements there [m].
    pub size: f64,
    /// Length √(EI/T) over which the line bends there [m].
    pub bend: f64,
    /// Reason for the refinement.
    pub place: Place,
}

/// Places that need short elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// The clamp at end A.
    ClampA,
    /// The clamp at end B.
    ClampB,
    /// Lift-off of the line from the seabed.
    Touchdown,
}

/// Number of elements of a single line for a target error of fairlead tension [-].
pub(crate) fn line_elements(tolerance: f64) -> f64 {
    (ERROR_TIMES_ELEMENTS / tolerance).clamp(LINE_ELEMENTS_MIN, LINE_ELEMENTS_MAX)
}

/// Unstretched lengths of the elements of every section of a line with about `elements` elements [-], more where it
/// is refined.
pub(crate) fn lengths(pieces: &[Piece], elements: f64, refinements: &[Refinement]) -> Vec<Vec<f64>> {
    let total: f64 = pieces.iter().map(|piece| piece.length).sum();
    let share = |piece: &Piece| (elements * piece.length / total).round().max(1.0) as usize;
    let counts = || pieces.iter().map(|piece| piece.elements.unwrap_or(share(piece)));
    let mut fine = refinements.to_vec();
    for refinement in &mut fine {
        let least = (refinement.to - refinement.from) / LINE_ELEMENTS_MAX;
        refinement.size = refinement.size.max(least);
    }
    loop {
        let mut field = Field::new(pieces, counts(), &fine);
        let given = |index: usize| pieces[index].elements.is_some();
        let longest = field.pieces.iter().map(|piece| piece.size);
        let longest = longest.fold(0.0, f64::max);
        let first: Vec<Vec<f64>> = (0..pieces.len())
            .map(|index| field.piece(index, given(index)))
            .collect();
        // sections of few elements stay as they are, and the others adapt to them
        for (piece, lengths) in field.pieces.iter_mut().zip(&first) {
            if lengths.len() <= FEW {
                piece.size = (piece.to - piece.from) / lengths.len() as f64;
                piece.count = lengths.len();
            }
        }
        let meshed: Vec<Vec<f64>> = first
            .iter()
            .enumerate()
            .map(|(index, lengths)| match lengths.len() {
                0..=FEW => lengths.clone(),
                _ => field.piece(index, given(index)),
            })
            .collect();
        let count: usize = meshed.iter().map(Vec::len).sum();
        fine.retain(|refinement| refinement.size < longest);
        if count as f64 <= LINE_ELEMENTS_MAX || fine.is_empty() {
            return meshed;
        }
        fine.iter_mut()
            .for_each(|refinement| refinement.size *= COARSENING);
    }
}

/// Element length h(s) along a line.
struct Field<'a> {
    pieces: Vec<Uniform>,
    refinements: &'a [Refinement],
}

/// A section with elements of equal length.
struct Uniform {
    from: f64, // [m]
    to: f64,   // [m]
    size: f64, // [m]
    count: usize,
}

impl Field<'_> {
    fn new<'a>(
        pieces: &[Piece],
        counts: impl Iterator<Item = usize>,
        refinements: &'a [Refinement],
    ) -> Field<'a> {
        let mut from = 0.0;
        let pieces = pieces.iter().zip(counts).map(|(piece, count)| {
            let piece = Uniform {
                from,
                to: from + piece.length,
                size: piece.length / count as f64,
                count,
            };
            from = piece.to;
            piece
        });
        Field {
            pieces: pieces.collect(),
            refinements,
        }
    }

    /// Lengths of the elements of a section: equal if their number is given or no shorter ones are needed.
    fn piece(&self, index: usize, given: bool) -> Vec<f64> {
        let piece = &self.pieces[index];
        let length = piece.to - piece.from;
        let plain = vec![length / piece.count as f64; piece.count];
        if given || !self.disturbed(index) {
            return plain;
        }
        let arc = self.counted(index);
        let whole = arc[arc.len() - 1].1;
        // at √2, one element is too long by the same factor as two are too short
        let count = if whole <= std::f64::consts::SQRT_2 {
            1
        } else {
            whole.round().max(2.0) as usize
        };
        let mut ends = vec![0.0];
        ends.extend((1..count).map(|k| inverse(&arc, whole * k as f64 / count as f64)));
        ends.push(length);
        ends.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    /// Returns whether a section needs elements that are shorter than its regular ones by more than [`RATIO_MAX`].
    fn disturbed(&self, index: usize) -> bool {
        let piece = &self.pieces[index];
        let bound = piece.size / RATIO_MAX;
        self.least_near(piece.from, index) < bound
            || self.least_near(piece.to, index) < bound
            || self.refinements.iter().any(|refinement| {
                refinement.from < piece.to && refinement.to > piece.from && refinement.size < piece.size
            })
    }

    /// h at an arc length [m], without the bound of section `index` itself.
    fn least_near(&self, s: f64, index: usize) -> f64 {
        let away = |from: f64, to: f64| (from - s).max(s - to).max(0.0);
        let pieces = self.pieces.iter().enumerate();
        let others = pieces
            .filter(|(other, _)| *other != index)
            .map(|(_, piece)| piece.size + GROWTH * away(piece.from, piece.to));
        let fine = self
            .refinements
            .iter()
            .map(|wanted| wanted.size + GROWTH * away(wanted.from, wanted.to));
        others.chain(fine).fold(f64::INFINITY, f64::min)
    }

    /// Arc lengths from the start of a section [m], and the number of elements before them, ∫ ds/h.
    fn counted(&self, index: usize) -> Vec<(f64, f64)> {
        let piece = &self.pieces[index];
        let h = |s: f64| piece.size.min(self.least_near(s, index));
        let (mut s, mut count) = (piece.from, 0.0);
        let mut arc = vec![(0.0, 0.0)];
        while s < piece.to {
            let step = (h(s) / QUADRATURE).min(piece.to - s).max(f64::EPSILON * piece.to);
            count += step / h(s + 0.5 * step);
            s += step;
            arc.push((s - piece.from, count));
        }
        arc
    }
}

/// Arc length [m] at the end of the first `count` elements.
fn inverse(arc: &[(f64, f64)], count: f64) -> f64 {
    let next = arc
        .partition_point(|(_, before)| *before < count)
        .clamp(1, arc.len() - 1);
    let ((s0, n0), (s1, n1)) = (arc[next - 1], arc[next]);
    s0 + (s1 - s0) * (count - n0) / (n1 - n0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn piece(length: f64, elements: Option<usize>) -> Piece {
        Piece { length, elements }
    }

    /// Maximum ratio of neighbouring elements [-].
    fn steepest(mesh: &[Vec<f64>]) -> f64 {
        let all: Vec<f64> = mesh.iter().flatten().copied().collect();
        let ratios = all
            .windows(2)
            .map(|pair| (pair[0] / pair[1]).max(pair[1] / pair[0]));
        ratios.fold(1.0, f64::max)
    }

    #[test]
    fn elements_are_shared_by_length_and_equal_where_nothing_disturbs() {
        let mesh = lengths(
            &[piece(300.0, None), piece(99.0, Some(7)), piece(200.0, None)],
            40.0,
            &[],
        );
        assert_eq!(
            mesh,
            [vec![15.0; 20], vec![99.0 / 7.0; 7], vec![200.0 / 13.0; 13]]
        );
        assert_eq!(
            lengths(&[piece(902.2, None)], line_elements(0.02), &[]),
            [vec![902.2 / 40.0; 40]]
        );
    }

    #[test]
    fn a_section_with_a_number_of_elements_keeps_it_in_any_line() {
        let mesh = lengths(
            &[piece(0.5, Some(1)), piece(400.0, Some(3)), piece(2.0, Some(9))],
            40.0,
            &[],
        );
        assert_eq!(mesh, [vec![0.5], vec![400.0 / 3.0; 3], vec![2.0 / 9.0; 9]]);
    }

    #[test]
    fn lengths_over_three_orders_grow_by_no_more_than_half_from_one_element_to_the_next() {
        let systems: [&[Piece]; 5] = [
            &[piece(300.0, None), piece(1.0, None), piece(99.0, None)],
            &[piece(0.3, None), piece(900.0, None), piece(0.3, None)],
            &[piece(2.0, Some(8)), piece(500.0, None), piece(40.0, Some(40))],
            &[
                piece(1.0, None),
                piece(1.7, None),
                piece(600.0, None),
                piece(9.0, None),
            ],
            &[
                piece(5.0, None),
                piece(6.0, None),
                piece(1.0, None),
                piece(50.0, None),
                piece(3000.0, None),
            ],
        ];
        for pieces in systems {
            for tolerance in [0.05, 0.02, 0.01, 0.004] {
                let mesh = lengths(pieces, line_elements(tolerance), &[]);
                for (piece, mesh) in pieces.iter().zip(&mesh) {
                    assert_relative_eq!(mesh.iter().sum::<f64>(), piece.length, max_relative = 1e-12);
                    assert!(mesh.iter().all(|length| *length > 0.0));
                }
                let count: usize = mesh.iter().map(Vec::len).sum();
                let given: usize = pieces.iter().filter_map(|piece| piece.elements).sum();
                let plain = line_elements(tolerance) as usize + given + pieces.len();
                assert!(count < plain + 60, "{count} elements for {pieces:?}");
                assert!(
                    steepest(&mesh) < RATIO_MAX,
                    "{} {pieces:?} {tolerance}",
                    steepest(&mesh)
                );
            }
        }
    }

    #[test]
    fn a_refinement_has_elements_of_its_length_and_its_neighbours_grow_away_from_it() {
        let wanted = Refinement {
            from: 240.0,
            to: 250.0,
            size: 0.3,
            bend: 1.0,
            place: Place::ClampB,
        };
        let mesh = lengths(&[piece(250.0, None)], 40.0, &[wanted]);
        let near = &mesh[0][mesh[0].len() - 30..];
        assert!(
            near.iter().all(|length| (0.25..0.35).contains(length)),
            "{near:?}"
        );
        assert_relative_eq!(mesh[0][0], 6.25, max_relative = 0.1);
        assert!(steepest(&mesh) < RATIO_MAX);
        assert!(mesh[0].len() < 100);
    }

    #[test]
    fn a_refinement_that_would_take_too_many_elements_is_coarsened_until_it_does_not() {
        let wanted = Refinement {
            from: 0.0,
            to: 250.0,
            size: 1e-3,
            bend: 1.0,
            place: Place::Touchdown,
        };
        let mesh = lengths(&[piece(250.0, None)], 40.0, &[wanted]);
        assert!((100..=400).contains(&mesh[0].len()), "{}", mesh[0].len());
    }
}
