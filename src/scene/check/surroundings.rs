//! Title, gravity, water, seabed.

use super::{Bounds, Findings};
use crate::scene::Scene;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    if scene.title.chars().any(char::is_control) {
        findings.say(
            "title",
            "the title holds a line break or another control character: write one line",
        );
    }
    findings.number(
        "gravity",
        scene.gravity,
        Bounds::NotNegative(1e3),
        "m/s² (downwards is positive)",
    );
    if let Some(water) = &scene.water {
        findings.number(
            "water.density",
            water.density,
            Bounds::Positive(1e5),
            "kg/m³",
        );
    }
    if let Some(seabed) = &scene.seabed {
        if seabed.depth < 0.0 {
            let problem = format!(
                "{} m is negative: the depth counts downwards from z = 0",
                seabed.depth
            );
            findings.say("seabed.depth", problem);
        } else {
            findings.number("seabed.depth", seabed.depth, Bounds::NotNegative(1e5), "m");
        }
        let stiff = Bounds::Positive(1e12);
        findings.number("seabed.stiffness", seabed.stiffness, stiff, "Pa/m");
        let damping = Bounds::NotNegative(1e12);
        findings.number("seabed.damping", seabed.damping, damping, "Pa s/m");
        let friction = Bounds::NotNegative(10.0);
        findings.number("seabed.friction", seabed.friction, friction, "-");
    }
}
