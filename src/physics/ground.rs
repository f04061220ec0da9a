//! Surface of a seabed that is not level: a plane, or heights through a grid of soundings.
//!
//! ```text
//! z = h(x, y),   n = (−h_x, −h_y, 1)/√(1 + h_x² + h_y²),   p = (h − z) n_z
//! ```
//!
//! n is the unit normal and p the distance below the surface along it, exact on a plane. On a grid, h is the bicubic Hermite interpolant of the
//! soundings. Its slopes at the grid points along x and along y are those of [`crate::math::shape_preserving`], at the edges those of the chord. Its
//! twist is the mean of the slope of h_x along y and that of h_y along x. At every point the two slopes, and then the twist, are reduced until the
//! control points of all cells around it lie within the soundings of their cell, or exceed them by at most a twentieth of their range. A bicubic is a
//! convex combination of its control points, so the surface lies within these bounds too. It is continuously differentiable, since cells share the
//! reduced derivatives, and reproduces planes. A bilinear surface would need a normal that is not its gradient to be smooth, and a node that slides
//! without friction would gain or lose energy at every crossing of a cell. Here the normal is that of the gradient, and the force k p n is
//! conservative except for p times the curvature of the surface. Outside the grid the surface continues with the values at its edge.
//!
//! Source: bicubic interpolation as in Press et al. (2007), Numerical Recipes, 3rd ed., section 3.6.3; convex hull of a Bézier net as in Farin
//! (2002), Curves and Surfaces for CAGD, 5th ed., chapter 14. Valid where penetrations are small compared with the
//! radius of curvature. A summit between soundings of nearly equal height is cut off.

use nalgebra::{Matrix3, Vector2, Vector3};

use crate::math::lanes::{LANES, Lanes, Vectors};
use crate::math::real::{Real, RealVector};
use crate::math::shape_preserving::{End, slopes, smooth_slopes};

/// Function that returns slopes at the rows of a table.
type Law = fn(&[f64], &[f64], [End; 2]) -> Vec<f64>;

/// Maximum excursion of the surface beyond the soundings of a cell, relative to their range [-].
const EXCURSION_MAX: f64 = 0.05;

/// Surface of a seabed.
#[derive(Debug, Clone, PartialEq)]
pub enum Ground {
    /// z = height + slope·(x, y).
    Plane {
        /// z above the origin [m].
        height: f64,
        /// dz/dx and dz/dy [-].
        slope: [f64; 2],
    },
    /// Heights through soundings.
    Grid(Grid),
}

/// Heights through soundings on a grid of lines along x and y. The cells include those between the edges and infinity.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Spans of the cells along x.
    x: Vec<Span<f64>>,
    /// Spans of the cells along y.
    y: Vec<Span<f64>>,
    /// Per cell, row by row along y: coefficients of the powers of the cell fractions along x (columns) and along y (rows) [m].
    cells: Vec<[[f64; 4]; 4]>,
    /// Upper bound of the surface height [m].
    highest: f64,
}

/// Extent of a cell along x or y. Every number is in exactly one span of a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Span<R> {
    /// Minimum and maximum coordinate in the cell [m]; infinite outside the grid.
    bounds: [R; 2],
    /// Coordinate at which the cell fraction is 0 [m].
    origin: R,
    /// 1 over the width of the cell [1/m]; 0 outside the grid, where the surface is constant along this axis.
    per_width: R,
}

/// Surface in a cell of a grid, or in one cell per lane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell<R> {
    /// Extent along x and y.
    spans: [Span<R>; 2],
    /// Coefficients of the powers of the cell fractions along x (columns) and along y (rows) [m].
    powers: [[R; 4]; 4],
}

/// Height of a surface at a point, and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Relief {
    /// h [m].
    height: f64,
    /// h_x and h_y [-].
    slope: [f64; 2],
    /// h_xx, h_xy and h_yy [1/m].
    curvature: [f64; 3],
}

/// Position of a node relative to the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Distance p below the surface, along its normal [m].
    pub penetration: f64,
    /// Unit normal n of the surface, upwards [-].
    pub normal: Vector3<f64>,
    /// ∂p/∂r [-].
    pub slope: Vector3<f64>,
    /// ∂n/∂r [1/m].
    pub turning: Matrix3<f64>,
}

impl Ground {
    /// Position of a node at `place` [m] relative to the surface.
    pub fn touch(&self, place: Vector3<f64>) -> Touch {
        let Relief {
            height,
            slope: [hx, hy],
            curvature: [hxx, hxy, hyy],
        } = self.relief(place.x, place.y);
        let upright = 1.0 / (1.0 + hx * hx + hy * hy).sqrt(); // n_z
        let normal = upright * Vector3::new(-hx, -hy, 1.0);
        let below = height - place.z;
        let bend = Matrix3::new(-hxx, -hxy, 0.0, -hxy, -hyy, 0.0, 0.0, 0.0, 0.0);
        let turning = upright * (bend - normal * (normal.transpose() * bend));
        Touch {
            penetration: below * upright,
            normal,
            slope: below * turning.row(2).transpose() - normal,
            turning,
        }
    }

    /// Penetration [m] and unit normal only, as from [`Self::touch`].
    #[inline]
    pub fn stand(&self, place: Vector3<f64>) -> (f64, Vector3<f64>) {
        match self {
            Ground::Plane { height, slope } => stand_on_plane(*height, *slope, place),
            Ground::Grid(grid) => grid.cell_at(place.x, place.y).stand(place),
        }
    }

    /// Height of the surface [m] at x, y [m].
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.relief(x, y).height
    }

    /// Curvature of the surface along a horizontal step [m], from the heights at a place and one step before and after it [1/m]; positive on crests, and 0
    /// for a step of zero length.
    pub fn curvature(&self, place: Vector3<f64>, step: Vector2<f64>) -> f64 {
        let height = |count: f64| self.height(place.x + count * step.x, place.y + count * step.y);
        let [before, here, after] = [-1.0, 0.0, 1.0].map(height);
        let square = step.norm_squared();
        if square == 0.0 {
            return 0.0;
        }
        let slope = 0.5 * (after - before) / square.sqrt();
        (2.0 * here - before - after) / (square * (1.0 + slope * slope).powf(1.5))
    }

    /// Upward unit normal [-] at x, y [m].
    pub fn normal(&self, x: f64, y: f64) -> Vector3<f64> {
        let [hx, hy] = self.relief(x, y).slope;
        Vector3::new(-hx, -hy, 1.0).normalize()
    }

    fn relief(&self, x: f64, y: f64) -> Relief {
        match self {
            Ground::Plane { height, slope } => Relief {
                height: height + slope[0] * x + slope[1] * y,
                slope: *slope,
                curvature: [0.0; 3],
            },
            Ground::Grid(grid) => grid.relief(x, y),
        }
    }
}

impl Grid {
    /// Grid of heights [m] at the coordinates `x` and `y` [m]: one row per y, with one height per x. `None` unless both increase and every row is
    /// complete.
    pub fn new(x: &[f64], y: &[f64], heights: &[Vec<f64>]) -> Option<Grid> {
        let increasing = |line: &[f64]| line.windows(2).all(|pair| pair[0] < pair[1]);
        let complete = heights.len() == y.len() && heights.iter().all(|row| row.len() == x.len());
        if x.is_empty() || y.is_empty() || !increasing(x) || !increasing(y) || !complete {
            return None;
        }
        let column = |rows: &[Vec<f64>], i: usize| -> Vec<f64> { rows.iter().map(|row| row[i]).collect() };
        let along_x = |rows: &[Vec<f64>], law: Law| -> Vec<Vec<f64>> {
            rows.iter().map(|row| law(x, row, [End::Chord; 2])).collect()
        };
        let along_y = |rows: &[Vec<f64>], law: Law| -> Vec<Vec<f64>> {
            (0..x.len())
                .map(|i| law(y, &column(rows, i), [End::Chord; 2]))
                .collect()
        };
        let hx = along_x(heights, slopes);
        let hy = along_y(heights, slopes); // a row for every x
        let (xy, yx) = (
            along_y(&hx, smooth_slopes),
            along_x(
                &(0..y.len()).map(|j| column(&hy, j)).collect::<Vec<_>>(),
                smooth_slopes,
            ),
        );
        let mut nodes = Vec::with_capacity(x.len() * y.len()); // h [m], h_x [-], h_y [-], h_xy [1/m]
        for j in 0..y.len() {
            for i in 0..x.len() {
                let twist = 0.5 * (xy[i][j] + yx[j][i]);
                let corners = corners([x, y], heights, [i, j]);
                let [hx, hy, hxy] = limit(&corners, [hx[j][i], hy[i][j], twist]);
                nodes.push([heights[j][i], hx, hy, hxy]);
            }
        }
        let cells = ends(y).flat_map(|rows| ends(x).map(move |columns| [columns, rows]));
        Some(Grid {
            cells: cells.map(|ends| powers([x, y], &nodes, ends)).collect(),
            x: spans(x),
            y: spans(y),
            highest: highest(heights),
        })
    }

    /// Upper bound of the surface height [m].
    pub fn highest(&self) -> f64 {
        self.highest
    }

    /// Surface in the cell around x, y [m].
    #[inline]
    fn cell_at(&self, x: f64, y: f64) -> Cell<f64> {
        let (i, j) = (place(&self.x, x), place(&self.y, y));
        Cell {
            spans: [self.x[i], self.y[j]],
            powers: self.cells[j * self.x.len() + i],
        }
    }

    /// Updates `cells` to those of four nodes at `place` [m]. The result depends on the positions only.
    #[inline(always)]
    pub fn find_cells(&self, place: Vectors, cells: &mut Cell<Lanes>) {
        if cells.excess(place).any_positive() {
            self.renew_cells(place, cells);
        }
    }

    #[cold]
    #[inline(never)]
    fn renew_cells(&self, place: Vectors, cells: &mut Cell<Lanes>) {
        let excess = cells.excess(place);
        for lane in (0..LANES).filter(|&lane| excess[lane] > 0.0) {
            cells.set(lane, &self.cell_at(place.x[lane], place.y[lane]));
        }
    }

    fn relief(&self, x: f64, y: f64) -> Relief {
        let cell = self.cell_at(x, y);
        let [by_x, by_y] = [cell.spans[0].powers(x), cell.spans[1].powers(y)];
        let sum = |p: usize, q: usize| dot(&cell.powers.map(|row| dot(&row, &by_x[p])), &by_y[q]);
        Relief {
            height: sum(0, 0),
            slope: [sum(1, 0), sum(0, 1)],
            curvature: [sum(2, 0), sum(1, 1), sum(0, 2)],
        }
    }
}

impl<R: Real> Cell<R> {
    /// Penetration [m] and unit normal of a node at `place` [m] in the cell.
    #[inline(always)]
    pub fn stand<V: RealVector<Real = R>>(&self, place: V) -> (R, V) {
        let ([x, y, _], [along, across]) = (place.components(), &self.spans);
        let (u, v) = (along.part(x), across.part(y));
        let [a, b, c, d] = &self.powers;
        let rows = [horner(a, u), horner(b, u), horner(c, u), horner(d, u)];
        let [height, by_y] = horner(&[rows[0][0], rows[1][0], rows[2][0], rows[3][0]], v);
        let by_x = ((rows[3][1] * v + rows[2][1]) * v + rows[1][1]) * v + rows[0][1];
        stand(height, [by_x * along.per_width, by_y * across.per_width], place)
    }
}

impl Cell<Lanes> {
    /// Cells that contain no point.
    pub fn nowhere() -> Cell<Lanes> {
        let [zero, least, most] = [0.0, f64::NEG_INFINITY, f64::INFINITY].map(Lanes::splat);
        let span = Span {
            bounds: [most, least],
            origin: zero,
            per_width: zero,
        };
        Cell {
            spans: [span; 2],
            powers: [[zero; 4]; 4],
        }
    }

    /// Positive where a position [m] is outside the cell.
    #[inline(always)]
    fn excess(&self, place: Vectors) -> Lanes {
        let [x, y] = &self.spans;
        let along = (x.bounds[0] - place.x).max(place.x - x.bounds[1]);
        let across = (y.bounds[0] - place.y).max(place.y - y.bounds[1]);
        along.max(across)
    }

    fn set(&mut self, lane: usize, cell: &Cell<f64>) {
        for (span, of) in self.spans.iter_mut().zip(&cell.spans) {
            (span.bounds[0][lane], span.bounds[1][lane]) = (of.bounds[0], of.bounds[1]);
            (span.origin[lane], span.per_width[lane]) = (of.origin, of.per_width);
        }
        let powers = self.powers.as_flattened_mut().iter_mut();
        powers
            .zip(cell.powers.as_flattened())
            .for_each(|(power, of)| power[lane] = *of);
    }
}

impl<R: Real> Span<R> {
    /// Cell fraction at a coordinate [-].
    #[inline(always)]
    fn part(&self, place: R) -> R {
        (place - self.origin) * self.per_width
    }
}

impl Span<f64> {
    /// Powers of the cell fraction at a coordinate, and their first and second derivatives [1/m, 1/m²].
    fn powers(&self, place: f64) -> [[f64; 4]; 3] {
        let (t, d) = (self.part(place), self.per_width);
        [
            [1.0, t, t * t, t * t * t],
            [0.0, d, 2.0 * t * d, 3.0 * t * t * d],
            [0.0, 0.0, 2.0 * d * d, 6.0 * t * d * d],
        ]
    }
}

/// Value of a cubic with these coefficients of the powers of `t`, and its slope.
#[inline(always)]
fn horner<R: Real>(&[a, b, c, d]: &[R; 4], t: R) -> [R; 2] {
    let top = d * t;
    let upper = top + c;
    let lower = upper * t + b;
    [lower * t + a, (top + upper) * t + lower]
}

/// Indices of the grid lines on both sides of every cell; the same one twice outside the edges of the grid.
fn ends(line: &[f64]) -> impl Iterator<Item = [usize; 2]> + Clone {
    let last = line.len() - 1;
    (0..=line.len()).map(move |i| [i.saturating_sub(1), i.min(last)])
}

/// Spans of the cells along a line of coordinates.
fn spans(line: &[f64]) -> Vec<Span<f64>> {
    let last = line.len() - 1;
    let span = |[low, high]: [usize; 2]| Span {
        bounds: [
            line[low],
            if high == last {
                line[high]
            } else {
                line[high].next_down()
            },
        ],
        origin: line[low],
        per_width: if low == high {
            0.0
        } else {
            1.0 / (line[high] - line[low])
        },
    };
    let mut spans: Vec<Span<f64>> = ends(line).map(span).collect();
    spans[0].bounds = [f64::NEG_INFINITY, line[0].next_down()];
    spans[last + 1].bounds = [line[last].next_up(), f64::INFINITY];
    if last == 0 {
        spans[0].bounds[1] = line[0];
    }
    spans
}

/// Index of the span that contains a coordinate [m]; 0 for NaN.
fn place(spans: &[Span<f64>], coordinate: f64) -> usize {
    spans.partition_point(|span| span.bounds[1] < coordinate)
}

/// Cells around a node.
fn corners([x, y]: [&[f64]; 2], heights: &[Vec<f64>], [i, j]: [usize; 2]) -> Vec<Corner> {
    let adjacent = |line: &[f64], at: usize| -> Vec<(usize, f64)> {
        let known = [at.checked_sub(1), Some(at + 1)].into_iter().flatten();
        let known = known.filter(|other| *other < line.len());
        let found: Vec<_> = known
            .map(|other| (other, (line[other] - line[at]) / 3.0))
            .collect();
        if found.is_empty() { vec![(at, 0.0)] } else { found }
    };
    let mut corners = Vec::with_capacity(4);
    for (other_i, reach_x) in adjacent(x, i) {
        for (other_j, reach_y) in adjacent(y, j) {
            let soundings = [(i, j), (other_i, j), (i, other_j), (other_i, other_j)];
            let change = soundings.map(|(i, j)| heights[j][i]).map(|z| z - heights[j][i]);
            let (low, high) = change
                .into_iter()
                .fold((0.0_f64, 0.0_f64), |(low, high), z| (low.min(z), high.max(z)));
            let margin = EXCURSION_MAX * (high - low);
            corners.push(Corner {
                reach: [reach_x, reach_y],
                bounds: [low - margin, high + margin],
            });
        }
    }
    corners
}

/// Coefficients of the powers of the cell fractions [m], for a cell between lines along x and along y, from h [m], h_x [-], h_y [-] and h_xy [1/m] of
/// the points.
fn powers([x, y]: [&[f64]; 2], nodes: &[[f64; 4]], [[i, i1], [j, j1]]: [[usize; 2]; 2]) -> [[f64; 4]; 4] {
    let (width, depth) = (x[i1] - x[i], y[j1] - y[j]);
    // Hermite data along y of the values and of the slopes along x, each as a cubic
    let along_y = |i: usize, [value, slope]: [usize; 2]| {
        let [low, high] = [j, j1].map(|j| nodes[j * x.len() + i]);
        cubic([low[value], depth * low[slope], high[value], depth * high[slope]])
    };
    let [v0, v1] = [i, i1].map(|i| along_y(i, [0, 2]));
    let [s0, s1] = [i, i1].map(|i| along_y(i, [1, 3]));
    [0, 1, 2, 3].map(|q| cubic([v0[q], width * s0[q], v1[q], width * s1[q]]))
}

/// Coefficients of the powers of the cell fraction t, from value and slope at both ends.
fn cubic([v0, s0, v1, s1]: [f64; 4]) -> [f64; 4] {
    let (rise, bend) = (v1 - v0, s0 + s1);
    [v0, s0, 3.0 * rise - bend - s0, bend - 2.0 * rise]
}

#[inline(always)]
fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

/// Upper bound of the height of a surface through these soundings [m].
fn highest(heights: &[Vec<f64>]) -> f64 {
    let soundings = || heights.iter().flatten().copied();
    let [low, high] = [
        soundings().fold(f64::INFINITY, f64::min),
        soundings().fold(f64::NEG_INFINITY, f64::max),
    ];
    high + EXCURSION_MAX * (high - low)
}

/// Penetration [m] and unit normal of a node at `place` [m], for a plane with this height above the origin [m] and slope [-].
#[inline(always)]
pub fn stand_on_plane<V: RealVector>(height: f64, slope: [f64; 2], place: V) -> (V::Real, V) {
    let ([x, y, _], slope) = (place.components(), slope.map(V::Real::splat));
    stand(V::Real::splat(height) + slope[0] * x + slope[1] * y, slope, place)
}

/// Penetration [m] and unit normal of a node at `place` [m], for a surface with this height [m] and slope [-].
#[inline(always)]
fn stand<V: RealVector>(height: V::Real, [hx, hy]: [V::Real; 2], place: V) -> (V::Real, V) {
    let [zero, one] = [0.0, 1.0].map(V::Real::splat);
    let upright = (one + hx * hx + hy * hy).sqrt().recip(); // n_z
    let normal = V::of([zero - hx, zero - hy, one]).scaled(upright);
    ((height - place.components()[2]) * upright, normal)
}

/// Limits on the slopes of a grid node from one cell, as bounds on the control points of the cell's Bézier net.
///
/// A bicubic is a convex combination of its net and stays within bounds that hold for the points z + a, z + b and z + a + b + c of
/// each of its corners, with a = h_x Δx/3, b = h_y Δy/3 and c = h_xy Δx Δy/9, signed into the cell.
struct Corner {
    /// Δx/3 and Δy/3, signed into the cell [m].
    reach: [f64; 2],
    /// Bounds of the height relative to that of the corner [m].
    bounds: [f64; 2],
}

impl Corner {
    /// Largest fraction, up to 1, of a change [m] that stays within the bounds.
    fn part(&self, change: f64) -> f64 {
        let [low, high] = self.bounds;
        let bound = if change > 0.0 { high } else { low };
        if change.abs() > bound.abs() {
            bound / change
        } else {
            1.0
        }
    }
}

/// Limits h_x and h_y [-] and h_xy [1/m] of a node so that every cell around it stays within its bounds.
fn limit(corners: &[Corner], [hx, hy, hxy]: [f64; 3]) -> [f64; 3] {
    let least = |part: &dyn Fn(&Corner) -> f64| corners.iter().map(part).fold(1.0, f64::min);
    let hx = hx * least(&|at| at.part(hx * at.reach[0]));
    let hy = hy * least(&|at| at.part(hy * at.reach[1]));
    let both = least(&|at| at.part(hx * at.reach[0] + hy * at.reach[1]));
    let (hx, hy) = (both * hx, both * hy);
    let twist = least(&|at| {
        let sum = hx * at.reach[0] + hy * at.reach[1];
        let rest = Corner {
            reach: at.reach,
            bounds: at.bounds.map(|bound| bound - sum),
        };
        rest.part(hxy * at.reach[0] * at.reach[1])
    });
    [hx, hy, twist * hxy]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;
    use crate::math::tests::{along, assert_columns};
    use approx::assert_relative_eq;

    const X: [f64; 4] = [-10.0, 0.0, 15.0, 40.0];
    const Y: [f64; 3] = [-5.0, 5.0, 30.0];

    /// Grid of the heights at these coordinates.
    fn sampled(x: &[f64], y: &[f64], height: impl Fn(f64, f64) -> f64) -> Grid {
        let row = |y: &f64| x.iter().map(|x| height(*x, *y)).collect::<Vec<f64>>();
        Grid::new(x, y, &y.iter().map(row).collect::<Vec<_>>()).unwrap()
    }

    fn hilly() -> Ground {
        let height = |x: f64, y: f64| -50.0 + 3.0 * (0.1 * x).sin() - 2.0 * (0.07 * y).cos();
        Ground::Grid(sampled(&X, &Y, height))
    }

    fn plane() -> Ground {
        Ground::Plane {
            height: -40.0,
            slope: [0.2, -0.1],
        }
    }

    #[test]
    fn a_grid_takes_its_soundings_at_its_points_and_goes_on_outside_as_at_its_edge() {
        let Ground::Grid(grid) = hilly() else {
            unreachable!()
        };
        for y in Y {
            for x in X {
                let sounding = -50.0 + 3.0 * (0.1 * x).sin() - 2.0 * (0.07 * y).cos();
                assert_relative_eq!(grid.relief(x, y).height, sounding, max_relative = 1e-15);
            }
        }
        assert_eq!(grid.relief(-100.0, 7.0).height, grid.relief(-10.0, 7.0).height);
        assert_eq!(grid.relief(-100.0, 7.0).slope[0], 0.0);
        assert_eq!(grid.relief(3.0, 99.0).height, grid.relief(3.0, 30.0).height);
    }

    #[test]
    fn a_grid_that_samples_a_plane_is_that_plane() {
        let plane = plane();
        let grid = Ground::Grid(sampled(&X, &Y, |x, y| plane.height(x, y)));
        for place in [[-3.0, 0.0, -41.0], [17.0, 29.0, -39.0], [39.0, -5.0, -40.0]] {
            let place = Vector3::from(place);
            let (of_plane, of_grid) = (plane.touch(place), grid.touch(place));
            assert_relative_eq!(of_plane.penetration, of_grid.penetration, epsilon = 1e-12);
            assert_relative_eq!(of_plane.normal, of_grid.normal, epsilon = 1e-14);
            assert_relative_eq!(of_grid.turning, Matrix3::zeros(), epsilon = 1e-14);
        }
    }

    #[test]
    fn the_slopes_of_penetration_and_normal_equal_central_differences() {
        for ground in [hilly(), plane()] {
            for place in [[-3.0, 0.0, -51.0], [17.0, 21.0, -49.5], [33.0, -2.0, -50.0]] {
                let place = Vector3::from(place);
                let touch = ground.touch(place);
                for axis in 0..3 {
                    let sinking = along(axis, 1e-5, |by| ground.touch(place + by).penetration);
                    assert_relative_eq!(touch.slope[axis], sinking, epsilon = 1e-9);
                }
                assert_columns(&touch.turning, 1e-5, 1e-9, |by| ground.touch(place + by).normal);
            }
        }
    }

    #[test]
    fn the_normal_is_continuous_from_cell_to_cell() {
        let ground = hilly();
        for x in &X[1..3] {
            let (low, high) = (ground.normal(x - 1e-9, 12.0), ground.normal(x + 1e-9, 12.0));
            assert_relative_eq!(low, high, epsilon = 1e-8);
        }
    }

    #[test]
    fn a_surface_stays_within_a_twentieth_of_the_soundings_of_its_cell() {
        let mut random = Random::new(5);
        for round in 0..3000 {
            let mut line = |count: usize| -> Vec<f64> {
                let mut at = 0.0;
                let mut next = || {
                    at += if round % 3 == 0 {
                        1.0
                    } else {
                        10_f64.powf(3.0 * random.unit() - 1.0)
                    };
                    at
                };
                (0..count).map(|_| next()).collect()
            };
            let (x, y) = (line(2 + round % 6), line(2 + round / 6 % 6));
            let mut level = 0.0;
            let mut sounding = || {
                if round % 2 == 0 || random.unit() < 0.4 {
                    level = -100.0 * random.unit();
                }
                level
            };
            let rows: Vec<Vec<f64>> = y.iter().map(|_| x.iter().map(|_| sounding()).collect()).collect();
            let grid = Grid::new(&x, &y, &rows).unwrap();
            for (j, i) in (0..y.len() - 1).flat_map(|j| (0..x.len() - 1).map(move |i| (j, i))) {
                let corners = [rows[j][i], rows[j][i + 1], rows[j + 1][i], rows[j + 1][i + 1]];
                let low = corners.into_iter().fold(f64::INFINITY, f64::min);
                let high = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
                let margin = 0.05 * (high - low) + 1e-10;
                for (u, v) in (0..=12).flat_map(|u| (0..=12).map(move |v| (u, v))) {
                    let part = |line: &[f64], at: usize, part: i32| {
                        line[at] + (line[at + 1] - line[at]) * f64::from(part) / 12.0
                    };
                    let h = grid.relief(part(&x, i, u), part(&y, j, v)).height;
                    let inside = h >= low - margin && h <= high + margin;
                    assert!(inside, "round {round}: {h} m between {low} and {high} m");
                }
            }
        }
    }

    #[test]
    fn four_nodes_that_wander_over_kept_cells_stand_as_each_alone() {
        let ground = hilly();
        let Ground::Grid(grid) = &ground else {
            unreachable!()
        };
        let mut random = Random::new(8);
        let mut cells = Cell::nowhere();
        let mut places = [Vector3::zeros(); LANES];
        for round in 0..4000 {
            for place in &mut places {
                *place += Vector3::from_fn(|_, _| 4.0 * random.unit() - 2.0);
                place.x = place.x.clamp(-20.0, 50.0);
                place.y = place.y.clamp(-15.0, 40.0);
            }
            places[round % LANES].x = X[round / 3 % X.len()]; // on a line between cells
            let four = Vectors::new(places);
            grid.find_cells(four, &mut cells);
            let (below, normal) = cells.stand(four);
            for (lane, place) in places.into_iter().enumerate() {
                assert_eq!((below[lane], normal.get(lane)), ground.stand(place), "{place}");
            }
        }
    }

    #[test]
    fn a_step_between_soundings_stays_between_them() {
        let step = |x: f64, _| if x > 305.0 { -90.0 } else { -100.0 };
        let ground = Ground::Grid(sampled(&[0.0, 300.0, 310.0, 600.0], &[-100.0, 100.0], step));
        for i in 0..6000 {
            let h = ground.height(0.1 * f64::from(i), 33.0);
            assert!((-100.5..=-89.5).contains(&h), "{h} m");
        }
    }

    #[test]
    fn a_smooth_slope_is_met_with_an_error_that_falls_with_its_order() {
        let height = |x: f64, y: f64| -100.0 + 0.3 * x + 0.2 * y + 2.0 * (0.05 * x).sin() * (0.04 * y).cos();
        let error = |count: usize| {
            let line: Vec<f64> = (0..=count).map(|i| 100.0 * i as f64 / count as f64).collect();
            let grid = sampled(&line, &line, height);
            let places = (0..400).map(|i| (30.0 + 0.1 * f64::from(i), 65.0 - 0.09 * f64::from(i)));
            let errors = places.map(|(x, y)| (grid.relief(x, y).height - height(x, y)).abs());
            errors.fold(0.0, f64::max)
        };
        let errors = [10, 20, 40, 80].map(error);
        for pair in errors.windows(2) {
            assert!(pair[0] > 8.0 * pair[1], "{errors:?}");
        }
    }

    #[test]
    fn rows_that_do_not_fit_are_no_grid() {
        assert_eq!(Grid::new(&[0.0, 0.0], &[0.0], &[vec![1.0, 1.0]]), None);
        assert_eq!(Grid::new(&[0.0, 1.0], &[0.0], &[vec![1.0]]), None);
    }
}
