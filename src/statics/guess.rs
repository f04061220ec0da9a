//! Where a line is expected to hang, before the assembled equilibrium is solved.

use nalgebra::Vector3;

use super::assembly::LineWork;
use crate::model::Line;

/// Puts the nodes of a line between its ends at `a` and `b` [m] on a parabola of about the right length.
pub(crate) fn hang(line: &Line, a: Vector3<f64>, b: Vector3<f64>, position: &mut [Vector3<f64>], work: &mut LineWork) {
    let length = line.unstretched_length();
    let weight: f64 = line.nodes.weight.iter().sum();
    let chord = (b - a).norm();
    let sag = (0.375 * chord.max(0.1 * length) * (length - chord).max(0.0)).sqrt() * weight.signum();
    let bed = line.nodes.contact.as_ref().map_or(f64::NEG_INFINITY, |contact| contact.bed);
    for (r, arc) in position.iter_mut().zip(&line.nodes.arc) {
        let u = arc / length;
        *r = a + u * (b - a) - 4.0 * sag * u * (1.0 - u) * Vector3::z();
        r.z = r.z.max(bed.min(a.z).min(b.z));
    }
    let horizontal = if sag.abs() > 0.0 { (weight * chord / (8.0 * sag)).abs() } else { 0.0 };
    work.tension.fill(horizontal);
}
