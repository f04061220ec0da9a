//! Title, gravity, water, seabed.

use super::{Bounds, Findings, quantity};
use crate::scene::Scene;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    if scene.title.chars().any(char::is_control) {
        findings.say(
            "title",
            "the title holds a line break or another control character: write one line",
        );
    }
    if scene.gravity < 0.0 {
        let problem = format!(
            "{} is negative: gravity is a magnitude, downwards along z",
            quantity(scene.gravity, "m/s²")
        );
        findings.say("gravity", problem);
    } else {
        let gravity = Bounds::NotNegative(1e3);
        findings.number("gravity", scene.gravity, gravity, "m/s²");
    }
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
                "{} is negative: the depth counts downwards from z = 0",
                quantity(seabed.depth, "m")
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
