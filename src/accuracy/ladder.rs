//! The settings that a scene is tried with.

use crate::scene::{Integrator, Scene};

/// Elements of the longest line [-].
const ELEMENTS: [usize; 14] = [4, 6, 8, 10, 14, 20, 28, 40, 56, 80, 112, 160, 226, 320];
/// Elements of the longest line where steps are dear [-].
const ELEMENTS_IMPLICIT: [usize; 5] = [10, 20, 40, 80, 160];
/// Steps of the implicit integrators to the shortest period [-].
const STEPS_PER_PERIOD: [f64; 5] = [40.0, 80.0, 160.0, 320.0, 640.0];
/// Target errors of the tool's own choice [-].
pub const TOLERANCES: [f64; 4] = [0.05, 0.02, 0.01, 0.005];
/// Elements of the longest line in the converged solution [-]; half as many tell how far it has converged.
pub const CONVERGED_ELEMENTS: usize = 640;
/// Steps to the shortest period in the converged solution, where it needs an implicit integrator [-].
const CONVERGED_STEPS_PER_PERIOD: f64 = 4000.0;
/// Elements of the longest line of a converged solution that needs an implicit integrator [-].
const CONVERGED_ELEMENTS_IMPLICIT: usize = 320;

/// One way to solve a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Elements of the longest line, others in proportion; chosen by the tool where absent.
    pub elements: Option<usize>,
    /// Integrator.
    pub integrator: Integrator,
    /// Longest internal step [s].
    pub time_step_max: Option<f64>,
    /// Target error [-] that the tool chooses by.
    pub tolerance: Option<f64>,
}

impl Setting {
    fn new(elements: usize, integrator: Integrator, time_step_max: Option<f64>) -> Setting {
        Setting {
            elements: Some(elements),
            integrator,
            time_step_max,
            tolerance: None,
        }
    }

    /// What the tool chooses for a target error [-].
    pub fn chosen(tolerance: f64) -> Setting {
        Setting {
            elements: None,
            integrator: Integrator::Auto,
            time_step_max: None,
            tolerance: Some(tolerance),
        }
    }

    /// The scene with this setting, its own mesh, integrator and step put aside.
    pub fn apply(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        let length = |line: &crate::scene::Line| -> f64 {
            line.sections.iter().map(|section| section.length).sum()
        };
        let longest = scene.lines.iter().map(length).fold(0.0, f64::max);
        for section in scene.lines.iter_mut().flat_map(|line| &mut line.sections) {
            section.elements = self.elements.map(|elements| {
                let share = elements as f64 * section.length / longest;
                (share.round() as usize).max(1)
            });
        }
        scene.solver.integrator = self.integrator;
        // A step that is not asked for is limited by the integrator's own rules only.
        scene.solver.time_step_max = self.time_step_max.unwrap_or(scene.solver.time_step_max);
        scene.solver.tolerance = self.tolerance.unwrap_or(scene.solver.tolerance);
        scene
    }
}

/// The ladder of a scene whose motion has this shortest period [s].
pub fn ladder(shortest_period: f64) -> Vec<Setting> {
    let mut settings: Vec<Setting> = TOLERANCES.map(Setting::chosen).into();
    let leapfrog = |n: &usize| Setting::new(*n, Integrator::Leapfrog, None);
    settings.extend(ELEMENTS.iter().map(leapfrog));
    for integrator in [Integrator::AxialImplicit, Integrator::GeneralisedAlpha] {
        for elements in ELEMENTS_IMPLICIT {
            let step = |steps: f64| Some(shortest_period / steps);
            let with = |steps| Setting::new(elements, integrator, step(steps));
            settings.extend(STEPS_PER_PERIOD.map(with));
        }
    }
    let static_lines = |n: usize| Setting::new(n, Integrator::QuasiStatic, None);
    settings.extend([10, 40].map(static_lines));
    settings
}

/// Settings of a converged solution, in the order they are tried: the first that serves the scene is taken. Each with the
/// coarser one that tells how far it has converged.
pub fn converged(shortest_period: f64) -> [[Setting; 2]; 2] {
    let explicit = |n: usize| Setting::new(n, Integrator::Leapfrog, None);
    let implicit = |n: usize, steps: f64| {
        let step = Some(shortest_period / steps);
        Setting::new(n, Integrator::Auto, step)
    };
    [
        [
            explicit(CONVERGED_ELEMENTS),
            explicit(CONVERGED_ELEMENTS / 2),
        ],
        [
            implicit(CONVERGED_ELEMENTS_IMPLICIT, CONVERGED_STEPS_PER_PERIOD),
            implicit(
                CONVERGED_ELEMENTS_IMPLICIT / 2,
                CONVERGED_STEPS_PER_PERIOD / 2.0,
            ),
        ],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Line, Section};

    #[test]
    fn elements_follow_the_length_of_section_and_line() {
        let section = |length: f64| Section {
            line_type: "chain".into(),
            length,
            elements: Some(3),
        };
        let scene = Scene {
            lines: vec![
                Line::between("long", "a", "b", vec![section(300.0), section(100.0)]),
                Line::between("short", "a", "b", vec![section(1.0)]),
            ],
            ..Scene::default()
        };
        let meshed = Setting::new(40, Integrator::Leapfrog, None).apply(&scene);
        let elements: Vec<_> = meshed
            .lines
            .iter()
            .flat_map(|line| &line.sections)
            .collect();
        let elements: Vec<_> = elements.iter().map(|section| section.elements).collect();
        assert_eq!(elements, [Some(30), Some(10), Some(1)]);
        let own = Setting::chosen(0.01).apply(&scene);
        assert_eq!(own.lines[0].sections[0].elements, None);
        assert_eq!(own.solver.tolerance, 0.01);
    }
}
