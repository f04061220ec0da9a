//! Area and second moment of area of a circle.

use std::f64::consts::PI;

/// Area πd²/4 [m²] of a circle of diameter d [m].
pub fn area(diameter: f64) -> f64 {
    0.25 * PI * diameter * diameter
}

/// Second moment of area πd⁴/64 [m⁴] about a diameter, of a circle of diameter d [m].
pub fn second_moment(diameter: f64) -> f64 {
    PI * diameter.powi(4) / 64.0
}
