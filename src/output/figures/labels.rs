//! Placement of labels at points, so that none covers another label or a mark.
//!
//! The positions to the right and left of the point are tried first, then those above and below it, at increasing distance. A label takes the first
//! position that is free and inside the frame. If there is none, it takes the one that covers least. Labels that are already placed do not move.

/// A rectangle: its least and its greatest x and y [px].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Patch {
    /// Upper left corner.
    pub low: [i32; 2],
    /// Lower right corner.
    pub high: [i32; 2],
}

impl Patch {
    /// Patch around a point, extending by `half` to either side.
    pub(super) fn around(point: [i32; 2], half: [i32; 2]) -> Patch {
        Patch {
            low: [point[0] - half[0], point[1] - half[1]],
            high: [point[0] + half[0], point[1] + half[1]],
        }
    }

    /// Area that two patches have in common [px²].
    fn common(&self, other: &Patch) -> i64 {
        let side = |axis: usize| {
            let (low, high) = (
                self.low[axis].max(other.low[axis]),
                self.high[axis].min(other.high[axis]),
            );
            i64::from((high - low).max(0))
        };
        side(0) * side(1)
    }

    fn area(&self) -> i64 {
        self.common(self)
    }
}

/// Text size and point of a label.
#[derive(Debug, Clone, Copy)]
pub(super) struct Label {
    /// The point [px].
    pub point: [i32; 2],
    /// Width and height of the text [px].
    pub size: [i32; 2],
}

/// Patches that cover a curve through points [px], within this distance on either side of it.
pub(super) fn along(points: &[[i32; 2]], half: i32) -> impl Iterator<Item = Patch> {
    points.windows(2).flat_map(move |ends| {
        let [from, to] = [ends[0], ends[1]];
        let longest = (to[0] - from[0]).abs().max((to[1] - from[1]).abs());
        let count = (longest / (2 * half)).max(1);
        (0..=count).map(move |k| {
            let at = |axis: usize| from[axis] + (to[axis] - from[axis]) * k / count;
            Patch::around([at(0), at(1)], [half; 2])
        })
    })
}

/// Greatest number of rows by which a label may move away from its point.
const ROWS: i32 = 6;

/// Places labels in a frame, `gap` [px] from their points and clear of `marks`.
pub(super) fn placed(frame: &Patch, marks: &[Patch], labels: &[Label], gap: i32) -> Vec<Patch> {
    let mut taken = marks.to_vec();
    for label in labels {
        let cover = |place: &Patch| {
            let covered: i64 = taken.iter().map(|other| place.common(other)).sum();
            covered + place.area() - place.common(frame)
        };
        // the first of equally good positions
        let best = places(label, gap).min_by_key(cover);
        taken.extend(best);
    }
    taken.split_off(marks.len())
}

/// Candidate positions of a label, best first.
fn places(label: &Label, gap: i32) -> impl Iterator<Item = Patch> {
    let Label {
        point: [x, y],
        size: [width, height],
    } = *label;
    let half = [width / 2, height / 2];
    let rows = (0..=ROWS).flat_map(|row| [-row, row]);
    rows.flat_map(move |row| {
        let sides = [gap + half[0], -gap - half[0], 0];
        // in the row of the point, only to its sides
        let sides = sides.into_iter().filter(move |side| *side != 0 || row.abs() > 0);
        sides.map(move |side| Patch::around([x + side, y + row * height], half))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Patch = Patch {
        low: [0, 0],
        high: [300, 200],
    };
    const GAP: i32 = 7;

    fn label(point: [i32; 2]) -> Label {
        let size = [40, 14];
        Label { point, size }
    }

    /// Marks at the points of labels, and positions of these labels.
    fn stand(points: &[[i32; 2]]) -> (Vec<Patch>, Vec<Patch>) {
        let marks: Vec<Patch> = points.iter().map(|p| Patch::around(*p, [4, 4])).collect();
        let labels: Vec<Label> = points.iter().map(|p| label(*p)).collect();
        let stand = placed(&FRAME, &marks, &labels, GAP);
        (marks, stand)
    }

    #[test]
    fn a_lonely_label_stands_right_of_its_point_and_left_of_it_at_the_right_edge() {
        for (x, side) in [(100, 1), (290, -1)] {
            let (_, stand) = stand(&[[x, 50]]);
            let middle = [x + side * (GAP + 20), 50];
            assert_eq!(stand, [Patch::around(middle, [20, 7])]);
        }
    }

    #[test]
    fn a_label_keeps_clear_of_a_curve_through_its_point() {
        let curve = [[0, 120], [120, 60], [120, 20], [290, 20]];
        let marks: Vec<Patch> = along(&curve, 2).collect();
        for point in [[60, 90], [120, 40], [200, 20]] {
            let stand = placed(&FRAME, &marks, &[label(point)], GAP);
            let covered: i64 = marks.iter().map(|mark| stand[0].common(mark)).sum();
            assert_eq!(covered, 0, "{point:?}: {stand:?}");
        }
    }

    #[test]
    fn labels_of_crowded_points_cover_neither_each_other_nor_a_mark() {
        let on_a_line = [[100, 50], [103, 52], [100, 60], [120, 50], [125, 51]];
        let in_a_corner = [[290, 5], [295, 5], [292, 12], [280, 8]];
        for points in [&on_a_line[..], &in_a_corner] {
            let (marks, stand) = stand(points);
            for (i, one) in stand.iter().enumerate() {
                assert_eq!(one.common(&FRAME), one.area(), "{one:?} leaves the frame");
                for other in stand[..i].iter().chain(&marks) {
                    assert_eq!(one.common(other), 0, "{one:?} on {other:?}");
                }
            }
        }
    }
}
