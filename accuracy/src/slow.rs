//! The quasi-static mode in increasingly slow motions of a scene: equilibria against dynamics on the same mesh.

use moorline::scene::{Integrator, MotionPath, Scene};

use crate::errors::{Errors, Histories, Judge, Metric};
use crate::judge;
use crate::ladder::Setting;
use crate::timed::Trial;

/// Factors on all periods, tried until the error of the quasi-static mode is small enough [-].
const FACTORS: [f64; 7] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];
/// Error of RMS tension at which the trials end [-].
const GOOD: f64 = 0.01;
/// Elements of the longest line [-]; the same in both runs, so that the mesh has no effect.
const ELEMENTS: usize = 80;
/// Least number of internal steps per shortest period [-].
const STEPS_PER_PERIOD: f64 = 160.0;

/// Errors of the quasi-static mode in a slower motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slow {
    /// Ratio of the periods to those of the scene [-].
    pub factor: f64,
    /// Shortest period of the motion [s].
    pub period: f64,
    /// Errors against dynamics on the same mesh.
    pub errors: Errors,
}

/// Errors of the quasi-static mode, from the scene's own motion to slower ones; empty if the motion is not a sum of sines. The list ends before the
/// first run that fails.
pub(crate) fn slow(scene: &Scene) -> Vec<Slow> {
    let mut all = Vec::new();
    for factor in FACTORS {
        let Some(one) = slowed(scene, factor).and_then(|scene| compared(&scene, factor)) else {
            break;
        };
        all.push(one);
        if one.errors.of(Metric::Rms) <= GOOD {
            break;
        }
    }
    all
}

fn compared(scene: &Scene, factor: f64) -> Option<Slow> {
    let period = scene.shortest_period();
    let step = Some(period / STEPS_PER_PERIOD);
    let with = |integrator| {
        let setting = Setting::new(ELEMENTS, integrator, step).on_seabed_as_given();
        histories(scene, &setting)
    };
    let dynamic = with(Integrator::AxialImplicit).or_else(|| with(Integrator::Auto))?;
    let quasi_static = with(Integrator::QuasiStatic)?;
    let judge: Judge = judge(scene, &dynamic);
    Some(Slow {
        factor,
        period,
        errors: judge.errors(&quasi_static, &dynamic),
    })
}

fn histories(scene: &Scene, setting: &Setting) -> Option<Histories> {
    let (timed, _) = Trial::exact(scene, setting).ok()?.recorded().ok()?;
    Some(timed.histories)
}

/// Returns the scene with all periods, duration and output interval multiplied by a factor; `None` if the motion is not a sum of sines.
fn slowed(scene: &Scene, factor: f64) -> Option<Scene> {
    let mut scene = scene.clone();
    let own = scene.points.iter_mut();
    let own = own.filter_map(|point| point.motion.as_mut());
    for path in scene.motion.values_mut().chain(own) {
        let MotionPath::Harmonic(motion) = path else {
            return None;
        };
        let translation = [&mut motion.x, &mut motion.y, &mut motion.z];
        let rotation = [&mut motion.roll, &mut motion.pitch, &mut motion.yaw];
        for sine in translation.into_iter().chain(rotation).flatten() {
            sine[1] *= factor;
        }
        motion.ramp = motion.ramp.map(|ramp| factor * ramp);
    }
    scene.output.duration *= factor;
    scene.output.interval *= factor;
    Some(scene)
}
