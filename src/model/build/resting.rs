//! How deep a line rests in a bed whose contact is softened to the mesh.
//!
//! A line of weight w under the horizontal tension H on springs that give way by δ under its weight leaves the bed smoothly, over the length
//! λ = √(Hδ/w). With u counted from where the springs let go, their level at z = δ above the line at rest, the free part is
//!
//!   z = δ + (δ/λ)u + (w/2H)u² = (w/2H)(u + λ)² + δ/2:
//!
//! the catenary over a rigid bed that lies δ/2 above the line at rest. So a line rests δ/2 deep, and what hangs from the bed is right to
//! the next order in the mesh; a line that rests on the bed hangs δ/2 too high, which costs 0.2 % of tension with 40 elements.
//! Towards an end that is held on the bed the line comes up to it, over a length R of a few elements, so that the end is not pulled
//! down: the line follows a smooth step as long as R > √3 λ, and λ is an element or less of the meshes in use. Three elements: with five
//! the step reaches the touchdown of a line that lies on the bed for little of its length, and the error of tension is 1.4 times as great on
//! oc3_catenary moved slowly (n = 14 to 40); with two it is hardly smaller.
//!
//! Source: beam without bending stiffness on Winkler's foundation, here solved for the level; the tests below and
//! `tests/equilibrium.rs` hold the gain against the elastic catenary.

use crate::model::{Contact, Line, Point, Role};
use crate::physics::seabed::REGULARISED_PENETRATION;

/// Static compression that the line rests in the bed by [-].
const SUNK: f64 = 0.5;
/// Elements over which the line comes up to a held end [-].
const RISE: f64 = 3.0;
/// The same where the line bends: its curvature follows the second derivative of the step.
const RISE_BENT: f64 = 5.0;

/// Lowers the level from which softened contact pushes, from where a line would rest on the bed to where what hangs is right.
pub(super) fn sink(line: &mut Line, points: &[Point]) {
    if let Some(winch) = &mut line.winch {
        sink(winch.reel_mut(), points);
    }
    let (length, bends) = (line.unstretched_length(), line.bends());
    let Some(contact) = &mut line.nodes.contact else {
        return;
    };
    let elements = if bends { RISE_BENT } else { RISE };
    let spacing = line.nodes.length[0];
    let lies = line.ends.map(|end| lies_on(contact, &points[end], spacing));
    for (arc, level) in line.nodes.arc.iter().zip(&mut contact.level) {
        let compression = *level - contact.bed; // δ
        let rise = elements * compression / REGULARISED_PENETRATION; // R
        let near = |distance: f64| {
            if rise > 0.0 {
                step(1.0 - distance / rise)
            } else {
                0.0
            }
        };
        let from_ends = [*arc, length - arc].into_iter().zip(lies);
        let near = from_ends
            .filter(|(_, lies)| *lies)
            .map(|(distance, _)| near(distance));
        *level -= SUNK * compression * (1.0 - near.fold(0.0, f64::max));
    }
}

/// Whether a held point lies on the bed, as far as an element of `length` [m] tells.
fn lies_on(contact: &Contact, point: &Point, length: f64) -> bool {
    let held = !matches!(point.role, Role::Free(_));
    let height = point.reference.z - contact.height_under(point.reference);
    held && height <= REGULARISED_PENETRATION * length
}

/// Smooth step from 0 to 1 [-].
fn step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
