//! The settings that a scene is tried with.

use crate::scene::{Integrator, Scene};

/// Elements of the longest line where a run costs next to nothing [-]. Close together: an explicit step must divide the communication
/// step, so that a mesh a little finer may take one step more, and one a little coarser waste none.
const ELEMENTS: [usize; 28] = [
    4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 16, 18, 20, 22, 24, 26, 28, 30, 32, 36, 40, 44, 48, 52,
    56, 60, 64,
];
/// Elements of the longest line in dearer explicit runs [-].
const ELEMENTS_FINE: [usize; 7] = [72, 80, 96, 112, 160, 226, 320];
/// Elements of the longest line, tensions implicit [-].
const ELEMENTS_AXIAL: [usize; 16] = [
    6, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 80, 112, 160,
];
/// Elements of the longest line, fully implicit [-].
const ELEMENTS_IMPLICIT: [usize; 4] = [10, 20, 40, 80];
/// Steps of the implicit integrators to the shortest period [-].
const STEPS_PER_PERIOD: [f64; 6] = [20.0, 40.0, 80.0, 160.0, 320.0, 640.0];
/// Communication steps over the interval of the output that explicit runs are tried with [-].
const COMMUNICATIONS: [usize; 3] = [1, 2, 4];
/// Communication steps to the shortest period, at least [-]: the motion in between is a cubic.
const COMMUNICATIONS_PER_PERIOD: f64 = 20.0;
/// Target errors of the tool's own choice [-].
pub const TOLERANCES: [f64; 4] = [0.05, 0.02, 0.01, 0.005];
/// Elements of the longest line in the converged solution [-]; half as many tell how far it has converged.
const CONVERGED_ELEMENTS: usize = 640;
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
    /// Intervals of the output from one communication point to the next [-].
    pub communication: usize,
}

impl Setting {
    /// A mesh and an integrator; the longest internal step [s] is the scene's where absent.
    pub fn new(elements: usize, integrator: Integrator, time_step_max: Option<f64>) -> Setting {
        Setting {
            elements: Some(elements),
            integrator,
            time_step_max,
            tolerance: None,
            communication: 1,
        }
    }

    /// What the tool chooses for a target error [-].
    pub fn chosen(tolerance: f64) -> Setting {
        Setting {
            elements: None,
            integrator: Integrator::Auto,
            time_step_max: None,
            tolerance: Some(tolerance),
            communication: 1,
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

    /// The same with communication points so far apart [intervals of the output].
    fn communicating(self, communication: usize) -> Setting {
        Setting {
            communication,
            ..self
        }
    }
}

/// The ladder of a scene whose motion has this shortest period [s] and whose output this interval [s].
pub fn ladder(period: f64, interval: f64) -> Vec<Setting> {
    let mut settings: Vec<Setting> = TOLERANCES.map(Setting::chosen).into();
    settings.extend(explicit(period, interval));
    let implicit = [
        (Integrator::AxialImplicit, ELEMENTS_AXIAL.as_slice()),
        (Integrator::GeneralisedAlpha, &ELEMENTS_IMPLICIT),
    ];
    for (integrator, meshes) in implicit {
        for elements in meshes {
            let mut of_mesh: Vec<Setting> = Vec::new();
            for steps in STEPS_PER_PERIOD {
                let (communication, step) = stepping(period / steps, interval);
                let setting = Setting::new(*elements, integrator, Some(step));
                let setting = setting.communicating(communication);
                if !of_mesh.contains(&setting) {
                    of_mesh.push(setting);
                }
            }
            settings.append(&mut of_mesh);
        }
    }
    let static_lines = |n: usize| Setting::new(n, Integrator::QuasiStatic, None);
    settings.extend([10, 40].map(static_lines));
    settings
}

fn explicit(period: f64, interval: f64) -> impl Iterator<Item = Setting> {
    let longest = period / COMMUNICATIONS_PER_PERIOD;
    let leapfrog = move |elements: usize, communication: usize| {
        let step = communication as f64 * interval;
        let setting = Setting::new(elements, Integrator::Leapfrog, Some(step));
        setting.communicating(communication)
    };
    let seldom = move |communication: &usize| {
        *communication == 1 || *communication as f64 * interval <= longest
    };
    let coarse = ELEMENTS.into_iter().flat_map(move |elements| {
        let communications = COMMUNICATIONS.into_iter().filter(seldom);
        communications.map(move |communication| leapfrog(elements, communication))
    });
    coarse.chain(
        ELEMENTS_FINE
            .into_iter()
            .map(move |elements| leapfrog(elements, 1)),
    )
}

/// Communication step [intervals] and internal step [s] that come nearest to a wanted internal step [s] from below, one a multiple of
/// the other.
fn stepping(wanted: f64, interval: f64) -> (usize, f64) {
    const ROUNDING: f64 = 1e-9;
    if wanted >= interval {
        let intervals = (wanted / interval + ROUNDING).floor();
        (intervals as usize, intervals * interval)
    } else {
        (1, interval / (interval / wanted - ROUNDING).ceil())
    }
}

/// Settings of a converged solution, in the order they are tried: the first that serves the scene is taken. Each with the
/// coarser one that tells how far it has converged.
pub fn converged(period: f64) -> [[Setting; 2]; 2] {
    let explicit = |n: usize| Setting::new(n, Integrator::Leapfrog, None);
    let implicit = |n: usize, steps: f64| {
        let step = Some(period / steps);
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

    #[test]
    fn internal_and_communication_steps_divide_each_other() {
        assert_eq!(stepping(0.05, 0.05), (1, 0.05));
        assert_eq!(stepping(0.23, 0.05), (4, 0.2));
        assert_eq!(stepping(0.02, 0.05), (1, 0.05 / 3.0));
        for setting in ladder(9.0, 0.05) {
            let communication = 0.05 * setting.communication as f64;
            assert!(communication <= 9.0 / COMMUNICATIONS_PER_PERIOD + 1e-9);
            if let Some(step) = setting.time_step_max {
                let steps = communication / step;
                assert!((steps - steps.round()).abs() < 1e-9, "{setting:?}");
            }
        }
    }
}
