//! The surface of a seabed that is not level: a plane, or heights through a grid of soundings.
//!
//! ```text
//! z = h(x, y),   n = (−h_x, −h_y, 1)/√(1 + h_x² + h_y²),   p = (h − z) n_z
//! ```
//!
//! n is the unit normal and p the distance below the surface along it, exact on a plane. On a grid h is the bicubic Hermite interpolant: it takes the
//! soundings at the grid's points; its slopes there are those of the parabola through the neighbouring soundings, at the edges of
//! the chord. So h is continuously differentiable, runs straight through soundings in a straight line, and reproduces planes.
//! A bilinear surface would need a normal that is not its gradient to be smooth, and a node that slides
//! without friction would gain or lose energy with every crossing of a cell; here the normal is the gradient's, and the force k p n is conservative but for p
//! times the curvature of the surface. Outside the grid the surface goes on as at its edge.
//!
//! Source: bicubic interpolation as in Press et al. (2007), Numerical Recipes, 3rd ed., section 3.6.3; slopes by the three-point formula on
//! uneven points. Like every cubic through given slopes it may overshoot beside a step, by a part of that step.
//! Valid where penetrations are small beside the radius of curvature.

use nalgebra::{Matrix3, Vector3};

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

/// Heights through soundings on a grid of lines along x and y.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// x of the grid's lines [m], increasing.
    x: Vec<f64>,
    /// y of the grid's lines [m], increasing.
    y: Vec<f64>,
    /// Per point, row by row of equal y: h [m], h_x [-], h_y [-], h_xy [1/m].
    nodes: Vec<[f64; 4]>,
}

/// Height of a surface at a place, and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Relief {
    /// h [m].
    height: f64,
    /// h_x and h_y [-].
    slope: [f64; 2],
    /// h_xx, h_xy and h_yy [1/m].
    curvature: [f64; 3],
}

/// How a node stands to the surface.
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
    /// How a node at a place [m] stands to the surface.
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

    /// Penetration [m] and normal of [`Self::touch`] alone.
    #[inline]
    pub fn stand(&self, place: Vector3<f64>) -> (f64, Vector3<f64>) {
        let (height, [hx, hy]) = match self {
            Ground::Plane { height, slope } => {
                (height + slope[0] * place.x + slope[1] * place.y, *slope)
            }
            Ground::Grid(grid) => {
                let relief = grid.relief(place.x, place.y);
                (relief.height, relief.slope)
            }
        };
        let upright = 1.0 / (1.0 + hx * hx + hy * hy).sqrt(); // n_z
        (
            (height - place.z) * upright,
            upright * Vector3::new(-hx, -hy, 1.0),
        )
    }

    /// Height of the surface at a place [m].
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.relief(x, y).height
    }

    /// Unit normal at a place, upwards [-].
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
    /// Heights [m] over lines at `x` and `y` [m]: one row per y, with one height per x. `None` unless both increase and every row is
    /// complete.
    pub fn new(x: &[f64], y: &[f64], heights: &[Vec<f64>]) -> Option<Grid> {
        let increasing = |line: &[f64]| line.windows(2).all(|pair| pair[0] < pair[1]);
        let complete = heights.len() == y.len() && heights.iter().all(|row| row.len() == x.len());
        if x.is_empty() || y.is_empty() || !increasing(x) || !increasing(y) || !complete {
            return None;
        }
        let along_x = |rows: &[Vec<f64>]| -> Vec<Vec<f64>> {
            rows.iter().map(|row| slopes(x, row)).collect()
        };
        let column =
            |rows: &[Vec<f64>], i: usize| -> Vec<f64> { rows.iter().map(|row| row[i]).collect() };
        let hx = along_x(heights);
        let hy: Vec<Vec<f64>> = (0..x.len())
            .map(|i| slopes(y, &column(heights, i)))
            .collect();
        let hxy: Vec<Vec<f64>> = (0..x.len()).map(|i| slopes(y, &column(&hx, i))).collect();
        let node = |j: usize, i: usize| [heights[j][i], hx[j][i], hy[i][j], hxy[i][j]];
        let nodes = (0..y.len())
            .flat_map(|j| (0..x.len()).map(move |i| (j, i)))
            .map(|(j, i)| node(j, i))
            .collect();
        Some(Grid {
            x: x.to_vec(),
            y: y.to_vec(),
            nodes,
        })
    }

    fn relief(&self, x: f64, y: f64) -> Relief {
        let (along, across) = (Cell::new(&self.x, x), Cell::new(&self.y, y));
        let mut sums = [[0.0; 3]; 3]; // by the orders of derivatives with x and y
        for (j, by_y) in [across.at, across.next].into_iter().zip(across.weights) {
            for (i, by_x) in [along.at, along.next].into_iter().zip(along.weights) {
                let [h, hx, hy, hxy] = self.nodes[j * self.x.len() + i];
                for (p, x) in by_x.iter().enumerate() {
                    for (q, y) in by_y.iter().enumerate().take(3 - p) {
                        sums[p][q] +=
                            y[0] * (x[0] * h + x[1] * hx) + y[1] * (x[0] * hy + x[1] * hxy);
                    }
                }
            }
        }
        Relief {
            height: sums[0][0],
            slope: [sums[1][0], sums[0][1]],
            curvature: [sums[2][0], sums[1][1], sums[0][2]],
        }
    }
}

/// Slopes of the parabolas through three neighbouring values, at the edges those of the chord.
fn slopes(line: &[f64], values: &[f64]) -> Vec<f64> {
    let chord = |i: usize| (values[i + 1] - values[i]) / (line[i + 1] - line[i]);
    let last = line.len() - 1;
    let slope = |i: usize| match i {
        _ if last == 0 => 0.0,
        0 => chord(0),
        i if i == last => chord(last - 1),
        i => {
            let (before, after) = (line[i] - line[i - 1], line[i + 1] - line[i]);
            (after * chord(i - 1) + before * chord(i)) / (before + after)
        }
    };
    (0..=last).map(slope).collect()
}

/// Weights of value and slope.
type Pair = [f64; 2];

/// Where a coordinate lies among a grid's lines, and the Hermite cubics there.
struct Cell {
    at: usize,
    next: usize,
    /// Of value and slope at both lines: the cubics, their first and their second derivatives.
    weights: [[Pair; 3]; 2],
}

impl Cell {
    fn new(line: &[f64], place: f64) -> Cell {
        let (first, last) = (line[0], line[line.len() - 1]);
        let none = [0.0; 2];
        // Outside, and across a single line, nothing changes.
        let still = |at: usize| Cell {
            at,
            next: at,
            weights: [[[1.0, 0.0], none, none], [none; 3]],
        };
        if place.is_nan() || place < first || line.len() == 1 {
            return still(0);
        }
        if place > last {
            return still(line.len() - 1);
        }
        let next = line
            .partition_point(|known| *known <= place)
            .min(line.len() - 1);
        let width = line[next] - line[next - 1];
        let t = (place - line[next - 1]) / width;
        let (square, cube) = (t * t, t * t * t);
        let bend = (6.0 - 12.0 * t) / (width * width);
        let rise = 3.0 * square - 2.0 * cube;
        let grade = 6.0 * (t - square) / width;
        Cell {
            at: next - 1,
            next,
            weights: [
                [
                    [1.0 - rise, width * (t - 2.0 * square + cube)],
                    [-grade, 1.0 - 4.0 * t + 3.0 * square],
                    [-bend, (6.0 * t - 4.0) / width],
                ],
                [
                    [rise, width * (cube - square)],
                    [grade, 3.0 * square - 2.0 * t],
                    [bend, (6.0 * t - 2.0) / width],
                ],
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const X: [f64; 4] = [-10.0, 0.0, 15.0, 40.0];
    const Y: [f64; 3] = [-5.0, 5.0, 30.0];

    fn hilly() -> Ground {
        let height = |x: f64, y: f64| -50.0 + 3.0 * (0.1 * x).sin() - 2.0 * (0.07 * y).cos();
        let rows: Vec<Vec<f64>> = Y
            .iter()
            .map(|&y| X.iter().map(|&x| height(x, y)).collect())
            .collect();
        Ground::Grid(Grid::new(&X, &Y, &rows).unwrap())
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
        for (j, &y) in Y.iter().enumerate() {
            for (i, &x) in X.iter().enumerate() {
                let sounding = grid.nodes[j * X.len() + i][0];
                assert_relative_eq!(grid.relief(x, y).height, sounding, max_relative = 1e-15);
            }
        }
        assert_eq!(
            grid.relief(-100.0, 7.0).height,
            grid.relief(-10.0, 7.0).height
        );
        assert_eq!(grid.relief(-100.0, 7.0).slope[0], 0.0);
        assert_eq!(grid.relief(3.0, 99.0).height, grid.relief(3.0, 30.0).height);
    }

    #[test]
    fn a_grid_that_samples_a_plane_is_that_plane() {
        let plane = plane();
        let rows: Vec<Vec<f64>> = Y
            .iter()
            .map(|&y| X.iter().map(|&x| plane.height(x, y)).collect())
            .collect();
        let grid = Ground::Grid(Grid::new(&X, &Y, &rows).unwrap());
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
                    let step = 1e-5 * Vector3::from_fn(|i, _| f64::from(u8::from(i == axis)));
                    let (low, high) = (ground.touch(place - step), ground.touch(place + step));
                    let sinking = (high.penetration - low.penetration) / 2e-5;
                    assert_relative_eq!(touch.slope[axis], sinking, epsilon = 1e-9);
                    let turned = (high.normal - low.normal) / 2e-5;
                    let turning = touch.turning.column(axis).into_owned();
                    assert_relative_eq!(turning, turned, epsilon = 1e-9);
                }
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
    fn rows_that_do_not_fit_are_no_grid() {
        assert_eq!(Grid::new(&[0.0, 0.0], &[0.0], &[vec![1.0, 1.0]]), None);
        assert_eq!(Grid::new(&[0.0, 1.0], &[0.0], &[vec![1.0]]), None);
    }
}
