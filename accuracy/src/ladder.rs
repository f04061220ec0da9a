//! Settings with which a scene is run.

use moorline::discretisation;
use moorline::scene::{ContactLaw, Integrator, Reconstruction, Scene, Threads};

/// Elements of the longest line in cheap explicit runs [-]. They are close together: an explicit step must divide the communication step, so that a
/// slightly finer mesh may need one more step, and a slightly coarser one may make full use of its steps. The leapfrogs process four nodes at a time,
/// so finer meshes have odd numbers of elements, and every other one has a number of nodes divisible by four.
const ELEMENTS: [usize; 29] = [
    3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31, 33, 35, 39, 43, 47, 51, 55, 59,
    63,
];
/// Elements of the longest line in costlier explicit runs [-].
const ELEMENTS_FINE: [usize; 7] = [71, 79, 95, 111, 159, 227, 319];
/// Elements of the longest line in axial-implicit runs [-]: as close together as those of the peers.
const ELEMENTS_AXIAL: [usize; 28] = [
    3, 4, 5, 6, 7, 8, 9, 11, 13, 15, 19, 23, 27, 31, 35, 39, 43, 47, 55, 63, 71, 79, 87, 95, 103, 111, 135,
    159,
];
/// Elements of the longest line in fully implicit runs [-].
const ELEMENTS_IMPLICIT: [usize; 3] = [10, 20, 40];
/// Elements of the longest line in quasi-static runs [-].
const ELEMENTS_STATIC: [usize; 4] = [10, 20, 40, 80];
/// Elements of the longest line in converged quasi-static solutions [-].
const CONVERGED_ELEMENTS_STATIC: [usize; 3] = [80, 160, 320];
/// Axial-implicit steps per shortest period [-].
const STEPS_AXIAL: [f64; 20] = [
    5.0, 5.7, 6.1, 6.6, 7.3, 8.0, 10.0, 11.5, 13.0, 14.5, 16.0, 18.0, 20.0, 23.0, 28.0, 40.0, 80.0, 160.0,
    320.0, 640.0,
];
/// Fully implicit steps per shortest period [-].
const STEPS_IMPLICIT: [f64; 3] = [20.0, 80.0, 320.0];
/// Communication steps of explicit runs, in intervals of the output [-].
const COMMUNICATIONS: [usize; 10] = [1, 2, 3, 4, 8, 10, 13, 16, 20, 28];
/// Greatest number of elements with which explicit runs use more than the first of the communication steps [-]: the cost of a communication step is
/// negligible on finer meshes.
const COMMUNICATING_ELEMENTS: usize = 32;
/// Least number of communication steps per shortest period [-]: between them the motion is a cubic, and histories are interpolated by cubics.
const COMMUNICATIONS_PER_PERIOD: f64 = 5.0;
/// Target errors of default settings [-].
pub const TOLERANCES: [f64; 4] = [0.05, 0.02, 0.01, 0.005];
/// Communication steps of the hosts [s].
pub const HOST_STEPS: [f64; 2] = [0.05, 0.01];
/// Elements of the longest line in converged solutions [-]; the coarser ones measure the convergence of the finer ones.
const CONVERGED_ELEMENTS: [usize; 3] = [320, 640, 1280];
/// Elements of the longest line in converged solutions under the peers' law [-], in which the short waves of a slack line grow, faster on finer
/// meshes.
const CONVERGED_ELEMENTS_PEERS: [usize; 3] = [160, 320, 640];
/// Axial-implicit steps per shortest period in the converged solution [-].
const CONVERGED_STEPS_AXIAL: f64 = 8000.0;
/// Steps per shortest period in a converged solution that needs a fully implicit integrator [-].
const CONVERGED_STEPS: f64 = 4000.0;
/// Elements of the longest line of a converged solution that needs a fully implicit integrator [-].
const CONVERGED_ELEMENTS_IMPLICIT: usize = 320;

/// One way to solve a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Elements of the longest line, others in proportion; `None` if the tool selects them.
    pub elements: Option<usize>,
    /// Integrator.
    pub integrator: Integrator,
    /// Longest internal step [s].
    pub time_step_max: Option<f64>,
    /// Target error of default settings [-]; elements and step are then absent.
    pub tolerance: Option<f64>,
    /// Communication step, in intervals of the output [-].
    pub communication: usize,
    /// Contact law of the seabed; that of the scene if absent.
    pub contact: Option<ContactLaw>,
}

impl Setting {
    /// Returns a setting of mesh and integrator; the longest internal step [s] is the scene's if absent.
    pub fn new(elements: usize, integrator: Integrator, time_step_max: Option<f64>) -> Setting {
        Setting {
            elements: Some(elements),
            integrator,
            time_step_max,
            tolerance: None,
            communication: 1,
            contact: None,
        }
    }

    /// Returns default settings for a target error [-].
    pub fn by_default(tolerance: f64) -> Setting {
        Setting {
            elements: None,
            integrator: Integrator::Auto,
            time_step_max: None,
            tolerance: Some(tolerance),
            communication: 1,
            contact: None,
        }
    }

    /// Returns the scene with this setting instead of its mesh, integrator and step. Default settings are found by convergence trials, as in
    /// `moorline run` and `fmu`. With any other setting, a host gives the motion at the end of a step, as it does to the other codes.
    pub fn apply(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        let length = |line: &moorline::scene::Line| -> f64 {
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
        // Without a step, the setting keeps the limit of the scene.
        scene.solver.time_step_max = self.time_step_max.unwrap_or(scene.solver.time_step_max);
        // Processor time is that of one thread, as for the other codes.
        scene.solver.threads = Threads::Number(1);
        if let (Some(seabed), Some(contact)) = (&mut scene.seabed, self.contact) {
            seabed.contact = contact;
        }
        if let Some(tolerance) = self.tolerance {
            scene.solver.tolerance = tolerance;
            return discretisation::discretised(&scene).into_owned();
        }
        scene.solver.input_reconstruction = Reconstruction::Interpolate;
        scene
    }

    /// Returns the setting with a communication step [intervals of the output].
    fn communicating(self, communication: usize) -> Setting {
        Setting {
            communication,
            ..self
        }
    }

    /// Returns the setting on a seabed with exactly the scene's coefficients.
    pub fn on_seabed_as_given(self) -> Setting {
        Setting {
            contact: Some(ContactLaw::AsGiven),
            ..self
        }
    }
}

/// Settings for a scene whose motion has this shortest period [s].
pub(crate) fn ladder(scene: &Scene, period: f64) -> Vec<Setting> {
    if is_quasi_static(scene) {
        return ELEMENTS_STATIC.map(quasi_static).into();
    }
    let interval = scene.output.interval;
    let mut settings: Vec<Setting> = explicit(period, interval).collect();
    let axial = Integrator::AxialImplicit;
    settings.extend(implicit(axial, &ELEMENTS_AXIAL, &STEPS_AXIAL, period, interval));
    let full = Integrator::GeneralisedAlpha;
    settings.extend(implicit(
        full,
        &ELEMENTS_IMPLICIT,
        &STEPS_IMPLICIT,
        period,
        interval,
    ));
    let softened = |seabed: &moorline::scene::Seabed| seabed.contact == ContactLaw::Regularised;
    if scene.seabed.as_ref().is_some_and(softened) {
        let cheap = |setting: &&Setting| match setting.integrator {
            Integrator::Leapfrog => [1, 4].contains(&setting.communication),
            integrator => integrator == Integrator::AxialImplicit,
        };
        let again: Vec<Setting> = settings.iter().filter(cheap).copied().collect();
        settings.extend(again.into_iter().map(Setting::on_seabed_as_given));
    }
    settings.extend([10, 40].map(quasi_static));
    settings
}

/// Returns whether a scene is quasi-static: it is then not compared with dynamics.
pub(crate) fn is_quasi_static(scene: &Scene) -> bool {
    scene.solver.integrator == Integrator::QuasiStatic
}

fn quasi_static(elements: usize) -> Setting {
    Setting::new(elements, Integrator::QuasiStatic, None)
}

fn implicit(
    integrator: Integrator,
    meshes: &[usize],
    steps: &[f64],
    period: f64,
    interval: f64,
) -> Vec<Setting> {
    let mut settings: Vec<Setting> = Vec::new();
    for elements in meshes {
        for steps in steps {
            let (communication, step) = stepping(period / steps, interval);
            let setting = Setting::new(*elements, integrator, Some(step));
            let setting = setting.communicating(communication);
            if !settings.contains(&setting) {
                settings.push(setting);
            }
        }
    }
    settings
}

fn explicit(period: f64, interval: f64) -> impl Iterator<Item = Setting> {
    let longest = period / COMMUNICATIONS_PER_PERIOD;
    let leapfrog = move |elements: usize, communication: usize| {
        let step = communication as f64 * interval;
        let setting = Setting::new(elements, Integrator::Leapfrog, Some(step));
        setting.communicating(communication)
    };
    let seldom =
        move |communication: &usize| *communication == 1 || *communication as f64 * interval <= longest;
    let meshes = ELEMENTS.into_iter().chain(ELEMENTS_FINE);
    meshes.flat_map(move |elements| {
        let admitted = if elements > COMMUNICATING_ELEMENTS {
            1
        } else {
            COMMUNICATIONS.len()
        };
        let communications = COMMUNICATIONS.into_iter().take(admitted).filter(seldom);
        communications.map(move |communication| leapfrog(elements, communication))
    })
}

/// Communication step [intervals] and internal step [s] closest to a wanted internal step [s] from below, one a multiple of the other.
fn stepping(wanted: f64, interval: f64) -> (usize, f64) {
    const ROUNDING: f64 = 1e-9;
    if wanted >= interval {
        let intervals = (wanted / interval + ROUNDING).floor();
        (intervals as usize, intervals * interval)
    } else {
        (1, interval / (interval / wanted - ROUNDING).ceil())
    }
}

/// Families of settings for a converged solution, in the order in which they are tried: the first that applies to the scene is used. Each contains
/// one or more sequences of increasingly fine settings, the best of which is run to its end: a seabed may be softened with the mesh, or have the
/// scene's own coefficients.
pub(crate) fn converged(scene: &Scene, period: f64) -> Vec<Vec<Vec<Setting>>> {
    if is_quasi_static(scene) {
        return vec![vec![CONVERGED_ELEMENTS_STATIC.map(quasi_static).into()]];
    }
    let meshes = if scene.solver.negative_tension {
        CONVERGED_ELEMENTS_PEERS
    } else {
        CONVERGED_ELEMENTS
    };
    let stepped = |steps: f64| Some(stepping(period / steps, scene.output.interval).1);
    let axial_step = stepped(CONVERGED_STEPS_AXIAL);
    let axial: Vec<Setting> = meshes
        .map(|n| Setting::new(n, Integrator::AxialImplicit, axial_step))
        .into();
    let as_given = axial.iter().copied().map(Setting::on_seabed_as_given);
    let mut both = vec![as_given.collect()];
    if scene.seabed.is_some() {
        both.push(axial);
    }
    let explicit = |n: &usize| Setting::new(*n, Integrator::Leapfrog, None).on_seabed_as_given();
    let implicit =
        |n: usize, steps: f64| Setting::new(n, Integrator::Auto, stepped(steps)).on_seabed_as_given();
    let finest = CONVERGED_ELEMENTS_IMPLICIT;
    vec![
        both,
        vec![meshes[..2].iter().map(explicit).collect()],
        vec![vec![
            implicit(finest / 2, CONVERGED_STEPS / 2.0),
            implicit(finest, CONVERGED_STEPS),
        ]],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use moorline::scene::{Line, Section};

    #[test]
    fn elements_follow_the_length_of_section_and_line() {
        let section = |length: f64| Section {
            line_type: "chain".into(),
            length,
            elements: Some(3),
            damping_elements: None,
        };
        let scene = Scene {
            lines: vec![
                Line::between("long", "a", "b", vec![section(300.0), section(100.0)]),
                Line::between("short", "a", "b", vec![section(1.0)]),
            ],
            ..Scene::default()
        };
        let meshed = Setting::new(40, Integrator::Leapfrog, None).apply(&scene);
        let elements: Vec<_> = meshed.lines.iter().flat_map(|line| &line.sections).collect();
        let elements: Vec<_> = elements.iter().map(|section| section.elements).collect();
        assert_eq!(elements, [Some(30), Some(10), Some(1)]);
        assert_eq!(Setting::by_default(0.01).apply(&scene).solver.tolerance, 0.01);
    }

    #[test]
    fn internal_and_communication_steps_divide_each_other() {
        assert_eq!(stepping(0.05, 0.05), (1, 0.05));
        assert_eq!(stepping(0.23, 0.05), (4, 0.2));
        assert_eq!(stepping(0.02, 0.05), (1, 0.05 / 3.0));
        let mut scene = Scene::default();
        scene.output.interval = 0.05;
        for setting in ladder(&scene, 9.0) {
            let communication = 0.05 * setting.communication as f64;
            assert!(communication <= 9.0 / COMMUNICATIONS_PER_PERIOD + 1e-9);
            if let Some(step) = setting.time_step_max {
                let steps = communication / step;
                assert!((steps - steps.round()).abs() < 1e-9, "{setting:?}");
            }
        }
    }
}
