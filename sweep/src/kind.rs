//! Kinds of systems: cases that share a discretisation.
//!
//! Trials select elements, integrator and step ([`moorline::discretisation`]). They take about a second, as long as the runs of many cases. Cases are of
//! one kind if their scenes differ only in seas, current, motions (of the same bodies) and title: lines, types, depth, solver, duration and interval
//! are the same. The error of a mesh also depends on the motion, so the discretisation of a kind is selected for its extreme cases, those with the greatest
//! displacement, speed and acceleration of supports and water: at most three and often one. For each network the greatest number of elements is taken
//! ([`finest`]). Cases that differ only in seeds are equally severe, and the first one represents all.

use std::sync::OnceLock;

use moorline::discretisation::{self, finest};
use moorline::scene::{
    Integrator, MotionPath, MotionRow, Scene, Threads, TimeFunction, WaveComponents, Waves,
};

use crate::case::Input;

/// Maximum displacement [m], speed [m/s] and acceleration [m/s²] of supports and water, by which cases are compared.
pub(crate) type Severity = [f64; 3];

/// A kind of system.
#[derive(Debug, Default)]
pub(crate) struct Kind {
    /// Cases on which the trials are run.
    extremes: Vec<Input>,
    choice: OnceLock<Choice>,
}

/// Discretisation of a kind, with remarks; without a discretisation, scenes remain as they are.
#[derive(Debug, Clone, Default, PartialEq)]
struct Choice {
    found: Option<Found>,
    notes: Vec<String>,
}

/// Keys of a scene that are set by a discretisation.
#[derive(Debug, Clone, PartialEq)]
struct Found {
    elements: Option<usize>,
    of_lines: Vec<Option<usize>>,
    integrator: Integrator,
    time_step_max: f64,
}

impl Kind {
    pub(crate) fn of(cases: &[(Severity, &Input)]) -> Kind {
        let mut places: Vec<usize> = (0..3).filter_map(|measure| extreme(cases, measure)).collect();
        places.sort_unstable();
        places.dedup();
        Kind {
            extremes: places.into_iter().map(|place| cases[place].1.clone()).collect(),
            choice: OnceLock::new(),
        }
    }

    /// Sets the discretisation of a scene of this kind, which is selected at the first call.
    pub(crate) fn discretise(&self, scene: &mut Scene) {
        let Some(found) = &self.choice().found else {
            return;
        };
        scene.solver.elements = found.elements;
        scene.solver.integrator = found.integrator;
        scene.solver.time_step_max = found.time_step_max;
        for (line, elements) in scene.lines.iter_mut().zip(&found.of_lines) {
            line.elements = *elements;
        }
    }

    /// Remarks on the discretisation after its selection: errors that are expected to exceed the tolerance.
    pub(crate) fn notes(&self) -> &[String] {
        self.choice.get().map_or(&[], |choice| &choice.notes)
    }

    fn choice(&self) -> &Choice {
        self.choice.get_or_init(|| {
            let scenes = self.extremes.iter().filter_map(|input| input.load().ok());
            let scenes: Vec<Scene> = scenes.map(|loaded| on_one_thread(loaded.scene)).collect();
            let found: Vec<_> = scenes.iter().filter_map(discretisation::select).collect();
            let notes = found.iter().flat_map(|found| found.shortfalls());
            let mut notes: Vec<String> = notes.map(|note| note.text).collect();
            notes.sort();
            notes.dedup();
            let finest = scenes.first().and_then(|scene| finest(scene, &found));
            let found = finest.map(|scene| Found {
                elements: scene.solver.elements,
                of_lines: scene.lines.iter().map(|line| line.elements).collect(),
                integrator: scene.solver.integrator,
                time_step_max: scene.solver.time_step_max,
            });
            Choice { found, notes }
        })
    }
}

/// Scene whose lines are computed on one thread, since the cases run in parallel.
pub(crate) fn on_one_thread(mut scene: Scene) -> Scene {
    scene.solver.threads = Threads::Number(1);
    scene
}

/// Index of the case with the greatest value of a measure; among equal ones, that with the greatest next measure, then the first.
fn extreme(cases: &[(Severity, &Input)], measure: usize) -> Option<usize> {
    let order = |place: &usize| [0, 1, 2].map(|i| cases[*place].0[(measure + i) % 3]);
    let later = |a: &usize, b: &usize| {
        order(a)
            .partial_cmp(&order(b))
            .unwrap_or(std::cmp::Ordering::Equal)
            .then(b.cmp(a))
    };
    (0..cases.len()).max_by(later)
}

/// Text that is equal for scenes of one kind.
pub(crate) fn system(scene: &Scene) -> String {
    let mut scene = scene.clone();
    scene.title.clear();
    let mut beside: Vec<String> = scene.motion.keys().cloned().collect();
    scene.motion.clear();
    for point in &mut scene.points {
        beside.extend(point.motion.take().map(|_| point.name.clone()));
    }
    if let Some(water) = &mut scene.water {
        beside.extend(water.waves.take().map(|_| "waves".to_string()));
        beside.extend(water.current.take().map(|_| "current".to_string()));
    }
    format!("{}{beside:?}", scene.to_toml())
}

/// End of the ramps of motions and waves [s]; 0 without ramps.
pub(crate) fn ramp(scene: &Scene) -> f64 {
    let of_waves = waves(scene).and_then(Waves::ramp);
    let of_motions = motions(scene).filter_map(|(path, _)| match path {
        MotionPath::Harmonic(motion) => motion.ramp,
        _ => None,
    });
    of_motions.chain(of_waves).fold(0.0, f64::max)
}

/// Motions of a scene, each with the lever arm of its rotations [m].
fn motions(scene: &Scene) -> impl Iterator<Item = (&MotionPath, f64)> {
    let lever = |body: &str| {
        let points = scene
            .points
            .iter()
            .filter(move |point| point.on.as_deref() == Some(body));
        let sizes = points.map(|point| point.position.iter().map(|x| x * x).sum::<f64>().sqrt());
        sizes.fold(0.0, f64::max)
    };
    let of_run = scene.motion.iter().map(move |(body, path)| (path, lever(body)));
    let own = scene.points.iter().filter_map(|point| point.motion.as_ref());
    of_run.chain(own.map(|path| (path, 0.0)))
}

fn waves(scene: &Scene) -> Option<&Waves> {
    scene.water.as_ref()?.waves.as_ref()
}

/// Severity of a scene's motions and water.
pub(crate) fn severity(scene: &Scene) -> Severity {
    let mut sum = [0.0; 3];
    let mut add = |[x, v, a]: Severity| sum = [sum[0] + x, sum[1] + v, sum[2] + a];
    for (path, lever) in motions(scene) {
        add(of_motion(path, lever));
    }
    for sea in waves(scene).iter().flat_map(|waves| &waves.seas) {
        let regular = sea.regular.as_ref().map(|regular| regular.period);
        let deviation = sea.variance().sqrt();
        match &sea.components {
            Some(WaveComponents::Rows(rows)) => {
                let sines = rows
                    .iter()
                    .map(|[amplitude, period, ..]| of_sine(*amplitude, *period));
                let squares = sines.fold([0.0; 3], |sum, sine| {
                    std::array::from_fn(|i| sum[i] + 0.5 * sine[i] * sine[i])
                });
                add(squares.map(f64::sqrt));
            }
            _ => add(of_sine(
                deviation,
                regular.or(sea.peak_period).unwrap_or(f64::INFINITY),
            )),
        }
    }
    let current = scene.water.as_ref().and_then(|water| water.current.as_ref());
    if let Some(current) = current {
        let rows = current.profile.iter().flatten().map(|row| row[1].hypot(row[2]));
        let speeds = rows.chain(current.velocity.map(|[x, y, z]| x.hypot(y).hypot(z)));
        let factors = current.factor.as_ref().map_or(vec![1.0], TimeFunction::corners);
        let factor = factors.into_iter().map(f64::abs).fold(0.0, f64::max);
        add([0.0, factor * speeds.fold(0.0, f64::max), 0.0]);
    }
    sum
}

fn of_sine(amplitude: f64, period: f64) -> Severity {
    let rate = std::f64::consts::TAU / period;
    [amplitude, amplitude * rate, amplitude * rate * rate].map(f64::abs)
}

/// Severity of a motion whose rotations act on a lever arm [m].
fn of_motion(path: &MotionPath, lever: f64) -> Severity {
    let scale = |axis: usize| if axis < 3 { 1.0 } else { lever };
    let mut sum = [0.0; 3];
    if let MotionPath::Harmonic(motion) = path {
        for (axis, (_, sines)) in motion.axes().iter().enumerate() {
            for sine in sines.iter() {
                let own = of_sine(sine[0] * scale(axis), sine[1]);
                sum = std::array::from_fn(|i| sum[i] + own[i]);
            }
        }
        return sum;
    }
    let rows = path.rows().unwrap_or_default();
    let size = |row: &MotionRow| {
        (0..6)
            .map(|axis| (row[1 + axis] * scale(axis)).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    let mut before: Option<MotionRow> = None;
    sum[0] = rows.first().map_or(0.0, size);
    for pair in rows.windows(2) {
        let step = pair[1][0] - pair[0][0];
        let rate: MotionRow = std::array::from_fn(|i| (pair[1][i] - pair[0][i]) / step);
        let change: MotionRow = before.map_or([0.0; 7], |before| {
            std::array::from_fn(|i| (rate[i] - before[i]) / step)
        });
        sum = [
            sum[0].max(size(&pair[1])),
            sum[1].max(size(&rate)),
            sum[2].max(size(&change)),
        ];
        before = Some(rate);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use moorline::scene::Drive;

    const SCENE: &str = include_str!("../../tests/scenes/platform.toml");

    fn scene(change: impl FnOnce(&mut Scene)) -> Scene {
        let mut scene = Scene::from_toml(SCENE).unwrap();
        change(&mut scene);
        scene
    }

    #[test]
    fn seas_and_motions_do_not_change_the_kind_of_a_system_and_all_else_does() {
        let kind = |change: fn(&mut Scene)| system(&scene(change));
        let base = kind(|_| {});
        assert_eq!(base, kind(|scene| scene.title = "another".into()));
        assert_eq!(
            base,
            kind(|scene| scene.water.as_mut().unwrap().waves.as_mut().unwrap().seas[0].ramp = None)
        );
        assert_eq!(
            base,
            kind(|scene| scene
                .motion
                .values_mut()
                .for_each(|path| *path = MotionPath::Table(vec![[0.0; 7]])))
        );
        assert_ne!(base, kind(|scene| scene.water.as_mut().unwrap().waves = None));
        assert_ne!(base, kind(|scene| scene.motion.clear()));
        assert_ne!(base, kind(|scene| scene.lines[0].sections[0].length = 351.0));
        assert_ne!(base, kind(|scene| scene.output.interval = 0.05));
    }

    #[test]
    fn the_ramp_is_the_longest_of_waves_and_motions() {
        assert_eq!(ramp(&scene(|_| {})), 20.0);
        let longer = |scene: &mut Scene| {
            if let Some(MotionPath::Harmonic(motion)) = scene.motion.get_mut("platform") {
                motion.ramp = Some(30.0);
            }
        };
        assert_eq!(ramp(&scene(longer)), 30.0);
    }

    #[test]
    fn higher_and_shorter_motions_are_more_severe_and_a_table_is_as_severe_as_its_sine() {
        let sine = of_sine(2.0, 10.0);
        assert!(
            of_sine(3.0, 10.0)
                .iter()
                .zip(sine)
                .all(|(more, less)| *more > less)
        );
        assert!(of_sine(2.0, 9.0)[1] > sine[1]);
        let rows = (0..200).map(|i| {
            let t = 0.1 * f64::from(i);
            [
                t,
                2.0 * (std::f64::consts::TAU * t / 10.0).sin(),
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
            ]
        });
        let table = of_motion(&MotionPath::Table(rows.collect()), 0.0);
        assert!(
            table.iter().zip(sine).all(|(a, b)| (a / b - 1.0).abs() < 0.01),
            "{table:?} {sine:?}"
        );
    }

    #[test]
    fn the_extremes_of_a_kind_are_one_case_each_and_the_first_of_equals() {
        let input = |name: &str| Input {
            base: std::sync::Arc::new("base.toml".into()),
            document: name.into(),
            drive: Drive::default(),
        };
        let inputs = ["far", "fast", "fast again", "mild"].map(input);
        let severities = [[9.0, 1.0, 0.1], [2.0, 3.0, 4.0], [2.0, 3.0, 4.0], [1.0, 1.0, 1.0]];
        let cases: Vec<_> = severities.into_iter().zip(&inputs).collect();
        let kind = Kind::of(&cases);
        assert_eq!(kind.extremes, inputs[..2]);
    }

    #[test]
    fn rows_of_components_and_a_current_with_a_factor_are_as_severe_as_what_they_stand_for() {
        let of = |water: &str| {
            severity(&scene(|scene| {
                let water: moorline::scene::Water = moorline::scene::part(water).unwrap();
                (scene.water, scene.seabed) = (Some(water), None);
            }))
        };
        let same = |one: Severity, other: Severity| {
            one.iter()
                .zip(other)
                .all(|(a, b)| (a - b).abs() < 1e-12 * b.abs())
        };
        let rows = of("density = 1025.0\nwaves.components = [[2.0, 6.0, 0.0, 0.0]]");
        let regular = of("density = 1025.0\nwaves.regular = { amplitude = 2.0, period = 6.0 }");
        assert!(
            same(rows, regular) && rows[2] > of("density = 1025.0")[2],
            "{rows:?} {regular:?}"
        );
        let factor = of(
            "density = 1025.0\ncurrent = { velocity = [0.5, 0.0, 0.0], factor = { ramp = [0.0, 0.0, 9.0, 3.0] } }",
        );
        let faster = of("density = 1025.0\ncurrent = { velocity = [1.5, 0.0, 0.0] }");
        assert!(same(factor, faster), "{factor:?} {faster:?}");
    }
}
