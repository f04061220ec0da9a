//! Depth at which a line rests in a seabed whose contact is softened to suit the mesh.
//!
//! A line of weight w under the horizontal tension H, on springs that deflect by δ under its weight, leaves the seabed
//! smoothly over the length λ = √(Hδ/w). With u measured from the point where the springs lose contact, at
//! z = δ above the line at rest, the free part is
//!
//!   z = δ + (δ/λ)u + (w/2H)u² = (w/2H)(u + λ)² + δ/2:
//!
//! the catenary over a rigid seabed δ/2 above the line at rest. A line therefore rests δ/2 below the seabed, and its
//! suspended part is then accurate to the next order in the mesh; for a line at rest on the seabed surface, the suspended
//! part is δ/2 too high, an error of 0.2 % in tension with 40 elements.
//! Towards an end that is fixed on the seabed the line rises to the seabed over a length R of a few elements, so that the
//! end is not pulled down: the line follows a smooth step as long as R > √3 λ, and λ is at most one element of the meshes
//! in use. R is three elements: with five, the step reaches the touchdown of a line with a short part on the seabed, and
//! the tension error is 1.4 times as great on a slowly moved oc3_catenary (n = 14 to 40); with two, it is hardly
//! smaller. A line with bending stiffness follows the step only if the step is longer than the length ℓ = (4EI/k)^¼ over
//! which a beam on springs of stiffness k per length settles; its curvature is then that of the step. R grows up to five
//! elements as ℓ approaches an element.
//!
//! Source: beam without bending stiffness on Winkler's foundation, here solved for the level.

use crate::model::{Contact, Line, Nodes, Point, Role};
use crate::physics::seabed::REGULARISED_PENETRATION;

/// Depth at which the line rests, relative to the static compression of the contact [-].
const SUNK: f64 = 0.5;
/// Number of elements over which the line rises to an end on the seabed [-].
const RISE: f64 = 3.0;
/// Length of the rise relative to ℓ for a line with bending stiffness, where ℓ counts up to an element [-].
const RISE_BENT: f64 = 5.0;

/// Lowers the level below which softened contact acts, from the level at which a line would rest on the seabed to the level
/// that makes its suspended part accurate.
pub(super) fn sink(line: &mut Line, points: &[Point]) {
    if let Some(winch) = &mut line.winch {
        sink(winch.longest_mut(), points);
    }
    let (length, stiffness) = (line.unstretched_length(), greatest_stiffness(line));
    let Nodes {
        arc,
        length: spacing,
        contact: Some(contact),
        ..
    } = &mut line.nodes
    else {
        return;
    };
    let springs: Vec<f64> = (0..arc.len()).map(|i| contact.stiffness_under(i)).collect();
    let lies = line.ends.map(|end| lies_on(contact, &points[end], spacing[0]));
    for (i, level) in contact.level.iter_mut().enumerate() {
        let compression = *level - contact.seabed_level; // δ
        let element = compression / REGULARISED_PENETRATION;
        let settles = (4.0 * stiffness * spacing[i] / springs[i]).powf(0.25); // ℓ
        let bent = RISE_BENT * settles.min(element);
        let rise = bent.max(RISE * element); // R
        let near = |distance: f64| {
            if rise > 0.0 {
                step(1.0 - distance / rise)
            } else {
                0.0
            }
        };
        let from_ends = [arc[i], length - arc[i]].into_iter().zip(lies);
        let near = from_ends
            .filter(|(_, lies)| *lies)
            .map(|(distance, _)| near(distance));
        *level -= SUNK * compression * (1.0 - near.fold(0.0, f64::max));
    }
}

/// Maximum bending stiffness EI of the segments of a line [N m²].
fn greatest_stiffness(line: &Line) -> f64 {
    let cable = line.bending.iter().flat_map(|bending| &bending.stiffness);
    let beam = line.beam.iter().flat_map(|beam| &beam.elements);
    let beam = beam.map(|element| element.law.bending);
    cable.copied().chain(beam).fold(0.0, f64::max)
}

/// Returns whether a point that is not free lies on the seabed, to the resolution of an element of `length` [m].
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
