//! Selection of mesh, integrator and time step for a stated error, by convergence trials with the scene's motion.
//!
//! The error of a line that slackens and lands does not follow from lengths, speeds and periods: n times the RMS error of the fairlead's tension lies
//! between 0.45 and 2 for chains of similar shape and motion, and the error falls with n² if nothing slackens. A scene with a motion is therefore run
//! on increasingly fine mesh levels, n_j = 5, 7, 10, 14 …, over a few periods. With the relative RMS distance d(j, k) of two runs, the error of the
//! mesh n_j is estimated as
//!
//!   e_j = max(c d(j, j+2), d(j+1, j+2)),     c = 2 − min(1, d(j, j+1)/d(j, j+2)),
//!
//! where n_{j+2} has twice the elements. If the errors of the meshes are uncorrelated, d(j, j+2) ≈ e_j and c ≈ 1; if they fall with n², d(j, j+2) = ¾
//! e_j, d(j, j+1) = ½ e_j and c = 4/3. On 21 scenes, e_j was 0.66 to 1.4 times the error of meshes with errors of 0.5 to 6 %, and less than 0.8 times
//! on one in twelve: nodes that land cause errors that fall with n and are correlated between meshes. The mesh selected is the coarsest whose e_j is
//! below 0.7 of the tolerance, interpolated between mesh levels and tried once more there. Meshes whose elements are too long to carry waves across
//! the line at the shortest period of the motion agree with one another without these waves: if all runs are of this kind, the mesh found is compared
//! with one that resolves the waves, and rejected if it differs by more.
//!
//! Every network of lines has a separate mesh: its error is that of the line with the greatest error, over the
//! standard deviation of that line's tension. All networks run together, at the elements of the mesh level until
//! their error is small enough.
//!
//! The runs of the mesh levels take axial-implicit steps if these cost less than explicit ones. Their length is the longest whose error, 4/3 of the
//! distance to a run with half the step, is a quarter of the tolerance on a coarse mesh. The same is required on the mesh found; otherwise, if the
//! work allows, the runs are repeated from the level below it, with the step halved as often as an error of second order requires. Of networks that
//! are displaced copies of one another and move in the same way, only one is tried. Networks with beams are not tried, and no network is tried twice
//! with the same elements and steps.
//!
//! The axial-implicit leapfrog costs two to three times as much per step as the explicit one. It is tried with steps of ½, ¼, … of the longest
//! allowed, on the mesh found and on finer ones, in order of cost. The first option that keeps the error against the finest mesh is selected; if
//! there is none, steps are explicit.
//!
//! If a line bends, or needs fully implicit steps for another reason, all networks are run with the integrators that the rules choose, and lines that
//! bend take the longest stable steps. The step of the trials and of the run is found in the same way, or extrapolated at first order from the last
//! one tried. Short elements at clamps and touchdowns are the same on several levels, so that runs on these contain little information on the error:
//! levels with the same mesh count once, and a mesh whose e_j is small enough is compared with one more level, with e_j at least d(j, j+3).
//!
//! The work of the trials is limited to about a second of processor time, or a few seconds if steps are fully implicit; the limit is the same on
//! every machine. Beyond it, the number of elements n is extrapolated from the last one tried, with an error that falls as 1/n. For a tension that
//! jumps at instants that are off by the time of an element, the RMS error falls only as n^-½, and this error is stated for such a mesh. If the
//! motion is unknown, the elements are given or another integrator is needed, as for beams, the elements follow from the tolerance alone. In
//! addition, elements are added until the tension at rest is within the tolerance of the closed-form catenary, if there is one.

mod expense;
mod history;
mod kinds;
mod ladder;
mod later;
mod rest;
mod search;
mod short_sections;
mod times;
mod trials;

use std::borrow::Cow;

use crate::model::mesh::line_elements;
use crate::model::{Model, line_shares};
use crate::scene::{Integrator, Line, Note, Scene, ToleranceOf, few, percent};
use crate::simulation::{self, Simulation};
use kinds::Kinds;
use search::Search;

pub use expense::expense;

/// Fraction of the tolerance that the estimated error must keep [-].
const AIM: f64 = 0.7;
/// Greatest number of elements to which trials are extrapolated [-].
const ELEMENTS_MAX: f64 = 400.0;

/// Mesh that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Elements of an isolated line [-].
    pub elements: usize,
    /// Estimated RMS error of the tension at the driven end, for the line of the network where it is greatest, over the standard deviation of that
    /// tension or a hundredth of its mean [-].
    pub error: f64,
}

/// Mesh of a network of lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// Lines of the network.
    pub lines: Vec<usize>,
    /// Meshes whose error could be estimated.
    pub trials: Vec<Trial>,
    /// Elements of an isolated line [-].
    pub elements: usize,
    /// Estimated error with these elements [-]; an upper estimate if they were extrapolated.
    pub error: f64,
    /// True if a trial was run on this mesh, or none is needed; false if it was extrapolated, or no trial could be run.
    pub tried: bool,
    /// True if a line varies so little in the trials that its errors are relative to the least deviation, not to its own.
    pub still: bool,
    /// True if no trial carries waves across the line with the shortest period of the motion: without them, coarse meshes agree with one another.
    pub lacks_waves: bool,
    /// Elements of sections that are one element on all levels [-]; `None` if their error could not be tried.
    pub short_sections: Option<usize>,
    /// Static error that requires more elements than the motion or the rule, if there is one.
    pub rest: Option<Rest>,
}

/// Static error that requires more elements than the motion or the rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Elements that the motion or the rule requires [-].
    pub fewer: usize,
    /// Relative error of the tension at the driven end against the catenary, with these elements and with the selected ones [-].
    pub errors: [f64; 2],
}

impl Mesh {
    /// Returns the mesh that follows from the tolerance alone [-].
    fn by_rule(lines: Vec<usize>, tolerance: f64) -> Mesh {
        Mesh {
            lines,
            trials: Vec::new(),
            elements: line_elements(tolerance).round() as usize,
            error: 0.0,
            tried: true,
            still: false,
            lacks_waves: false,
            short_sections: Some(1),
            rest: None,
        }
    }

    /// Returns whether no trial of the mesh could be run.
    fn is_unknown(&self) -> bool {
        !self.tried && self.trials.is_empty()
    }
}

/// Result of the trials of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Discretisation {
    /// The scene with its elements and, if they are cheaper, axial-implicit steps.
    pub scene: Scene,
    /// Mesh of every network whose elements are left open.
    pub meshes: Vec<Mesh>,
    /// Duration of the trials in the scene's time [s].
    pub duration: f64,
    /// True if the error of the time steps on meshes that were extrapolated could not be tried.
    pub untried_steps: bool,
}

impl Discretisation {
    /// Describes the result in sentences.
    pub fn in_words(&self) -> Vec<String> {
        let mut kinds: Vec<Vec<&Mesh>> = Vec::new();
        for mesh in &self.meshes {
            let key = |mesh: &Mesh| {
                let fewer = mesh.rest.map(|rest| rest.fewer);
                (mesh.elements, mesh.tried, mesh.still, mesh.short_sections, fewer)
            };
            match kinds.iter_mut().find(|kind| key(kind[0]) == key(mesh)) {
                Some(kind) => kind.push(mesh),
                None => kinds.push(vec![mesh]),
            }
        }
        let mut said = Vec::new();
        for kind in &kinds {
            let of = match kinds.len() {
                1 => String::new(),
                _ => format!("{}: ", self.names(kind)),
            };
            let worst = kind.iter().max_by(|a, b| a.error.total_cmp(&b.error));
            let sentences = worst.map(|mesh| self.mesh_in_words(mesh));
            said.extend(sentences.into_iter().flatten().map(|words| of.clone() + &words));
        }
        let solver = &self.scene.solver;
        if solver.integrator == Integrator::AxialImplicit {
            said.push(format!(
                "axial-implicit steps up to {} s cost less than explicit ones at the same error; their limits are below",
                solver.time_step_max
            ));
        }
        said
    }

    /// Returns a note for each mesh whose error is expected to exceed the tolerance, because it was extrapolated or has the greatest number of
    /// elements that is selected, for each mesh whose error, or that of its short sections, could not be tried, and on what the trials do not cover.
    pub fn shortfalls(&self) -> Vec<Note> {
        let tolerance = self.scene.solver.tolerance;
        let besides = match self.untried_steps {
            true => ", besides that of the time steps, which was not tried,",
            false => "",
        };
        let of_mesh = |mesh: &Mesh| {
            let coarse = (!mesh.tried && mesh.error > tolerance).then(|| {
                let cure = match self.scene.solver.tolerance_of {
                    ToleranceOf::Tension => ", or solver.tolerance_of = \"low_passed_tension\" if slaps of single nodes do not matter",
                    ToleranceOf::LowPassedTension | ToleranceOf::Position => "",
                };
                format!(
                    "an error of up to about {:.2} %{besides} is expected with {} elements, above solver.tolerance = {tolerance}; set `elements` for a finer \
                     mesh{cure}",
                    100.0 * mesh.error,
                    mesh.elements
                )
            });
            let is_extrapolated = !mesh.tried && !mesh.is_unknown() && mesh.error <= tolerance;
            let untried = (is_extrapolated && self.untried_steps).then(|| {
                format!(
                    "{}: the mesh was extrapolated from coarser ones, and the error of its time steps was not tried; compare with a run with \
                     `integrator = \"leapfrog\"`",
                    self.names(&[mesh])
                )
            });
            let unknown = match mesh.short_sections {
                _ if mesh.is_unknown() => Some("this mesh"),
                None => Some("short sections with one element"),
                Some(_) => None,
            };
            let unknown = unknown.map(|mesh_or_part| {
                format!(
                    "{}: the error of {mesh_or_part} is unknown, since no trial could be run; compare with a run with more `elements`",
                    self.names(&[mesh])
                )
            });
            let lacks_waves = mesh.lacks_waves.then(|| {
                format!(
                    "{}: no trial has elements short enough for waves across the line with the shortest period of the motion, so the error may be \
                     larger; compare with a run with more `elements`",
                    self.names(&[mesh])
                )
            });
            [coarse, untried, unknown, lacks_waves].into_iter().flatten()
        };
        let sentences = self.meshes.iter().flat_map(of_mesh);
        let notes = sentences.map(|text| Note::new("solver.tolerance", text));
        notes.chain(later::note(&self.scene, self.duration)).collect()
    }

    fn needs_more_at_rest(&self) -> bool {
        self.meshes.iter().any(|mesh| mesh.rest.is_some())
    }

    /// Names of the lines of networks with equal meshes.
    fn names(&self, kind: &[&Mesh]) -> String {
        let lines = kind.iter().flat_map(|mesh| &mesh.lines);
        let names: Vec<&str> = lines.map(|&line| &self.scene.lines[line].name[..]).collect();
        few(&names)
    }

    fn mesh_in_words(&self, mesh: &Mesh) -> Vec<String> {
        let rounded = |part: f64| format!("{:.2} %", 100.0 * part);
        let tried = mesh.trials.iter().rev().take(4).rev();
        let tried: Vec<String> = tried
            .map(|trial| format!("{} with {}", rounded(trial.error), trial.elements))
            .collect();
        let target = format!("for a target error of {}", percent(self.scene.solver.tolerance));
        let on = match mesh.lines.len() {
            1 => "",
            _ => " on the longest line",
        };
        let mut said = Vec::new();
        if !tried.is_empty() {
            said.push(format!(
                "{} elements{on} {target}, by trials over {:.0} s of the scene's motion: errors of {}",
                mesh.rest.map_or(mesh.elements, |rest| rest.fewer),
                self.duration,
                tried.join(", ")
            ));
        }
        if mesh.still {
            let of_line = if mesh.lines.len() > 1 { " of a line" } else { "" };
            let (quantity, least) = match self.scene.solver.tolerance_of {
                ToleranceOf::Position => ("position", "0.1 % of the length of the line"),
                ToleranceOf::Tension | ToleranceOf::LowPassedTension => ("tension", "1 % of its mean"),
            };
            said.push(format!(
                "the {quantity}{of_line} varies by less than {least}: these errors are relative to that, and greater relative to its variation"
            ));
        }
        match mesh.short_sections {
            Some(1) => {}
            Some(elements) => said.push(format!(
                "{elements} elements in short sections, which have one element on all meshes that were tried, so that their error is unknown"
            )),
            None => said.push(
                "the error of short sections is unknown: they have one element on all meshes that were tried, and no further trial could be run"
                    .to_string(),
            ),
        }
        if let Some(rest) = mesh.rest {
            let [before, after] = rest.errors.map(rounded);
            said.push(format!(
                "{} elements{on} {target}: the tension at rest differs from that of the catenary by {after}, with {} elements by {before}",
                mesh.elements, rest.fewer
            ));
        }
        if mesh.is_unknown() {
            said.push("the error of this mesh is unknown, since no trial could be run".to_string());
        } else if !mesh.tried {
            said.push(format!(
                "extrapolated, since trials are limited in cost: an error of up to about {} is expected",
                rounded(mesh.error)
            ));
        }
        said
    }
}

/// Selects the discretisation that a scene leaves open, by trials; `None` if nothing is left open or the rules apply.
pub fn select(scene: &Scene) -> Option<Discretisation> {
    if !is_open(scene) {
        return None;
    }
    let networks = Networks::of(scene)?;
    match Kinds::of(scene, &networks).filter(|kinds| is_open(&kinds.scene)) {
        None => tried(scene, &networks),
        Some(kinds) => {
            let found = tried(&kinds.scene, &Networks::of(&kinds.scene)?)?;
            Some(kinds.expanded(&found, scene, &networks))
        }
    }
}

fn tried(scene: &Scene, networks: &Networks) -> Option<Discretisation> {
    let mut search = Search::new(scene, &Model::new(scene).ok()?, networks);
    let in_motion = |search| tried_in_motion(scene, networks, search);
    search.as_mut().and_then(in_motion).or_else(|| {
        let (mut found, _) = without_trials(scene, networks, &Simulation::new(scene).ok()?, Simulation::new)?;
        let moves = search.is_some();
        found.meshes.iter_mut().for_each(|mesh| mesh.tried = !moves);
        (moves || found.needs_more_at_rest()).then_some(found)
    })
}

/// Solves the equilibrium of a scene ([`Simulation::at_rest`]) on a mesh selected without trials of a motion. Also returns the discretisation if its
/// mesh differs from that of the rule.
///
/// # Errors
/// As [`Simulation::at_rest`].
pub fn at_rest(scene: &Scene) -> Result<(Option<Discretisation>, Simulation), simulation::Error> {
    let simulation = Simulation::at_rest(scene)?;
    if !is_open(scene) || scene.solver.integrator == Integrator::QuasiStatic {
        return Ok((None, simulation));
    }
    let networks = Networks::new(scene, simulation.model());
    let found = without_trials(scene, &networks, &simulation, Simulation::at_rest);
    match found.filter(|(found, _)| found.needs_more_at_rest()) {
        None => Ok((None, simulation)),
        Some((found, Some(refined))) => Ok((Some(found), refined)),
        Some((found, None)) => {
            let simulation = Simulation::at_rest(&found.scene)?;
            Ok((Some(found), simulation))
        }
    }
}

fn tried_in_motion(scene: &Scene, networks: &Networks, search: &mut Search) -> Option<Discretisation> {
    let mut meshes = search.meshes()?;
    search.refine_short_sections(&mut meshes);
    let start = |scene: &Scene| Simulation::new(scene).ok();
    if let Some(simulation) = start(&networks.with_elements(scene, &elements_of(&meshes))) {
        rest::refine(scene, networks, &mut meshes, &simulation, start);
    }
    let tried = networks.open(&meshes).all(|mesh| mesh.tried);
    let settled = search.settled(&mut meshes, tried);
    Some(Discretisation {
        duration: search.scene().output.duration,
        untried_steps: search.untried_steps,
        scene: Scene {
            output: scene.output.clone(),
            ..settled
        },
        meshes: networks.open(&meshes).cloned().collect(),
    })
}

/// Elements of an isolated line in every network [-].
fn elements_of(meshes: &[Mesh]) -> Vec<usize> {
    meshes.iter().map(|mesh| mesh.elements).collect()
}

/// Returns the scene with the mesh of the rule, or with more elements if it needs them at rest, and its simulation if one was started; `given` is a
/// simulation on the mesh of the rule.
fn without_trials(
    scene: &Scene,
    networks: &Networks,
    given: &Simulation,
    start: fn(&Scene) -> Result<Simulation, simulation::Error>,
) -> Option<(Discretisation, Option<Simulation>)> {
    if scene.solver.integrator == Integrator::QuasiStatic {
        return None;
    }
    let mesh = |lines: &Vec<usize>| Mesh::by_rule(lines.clone(), scene.solver.tolerance);
    let mut meshes: Vec<Mesh> = networks.lines.iter().map(mesh).collect();
    let refined = rest::refine(scene, networks, &mut meshes, given, |scene| start(scene).ok());
    let found = Discretisation {
        scene: networks.with_elements(scene, &elements_of(&meshes)),
        meshes: networks.open(&meshes).cloned().collect(),
        duration: 0.0,
        untried_steps: false,
    };
    Some((found, refined))
}

/// Returns the scene with its discretisation: as [`select`] finds it, or unchanged if nothing is left open.
pub fn discretised(scene: &Scene) -> Cow<'_, Scene> {
    match select(scene) {
        Some(found) => Cow::Owned(found.scene),
        None => Cow::Borrowed(scene),
    }
}

/// Returns the scene with a discretisation as fine as each of those found for its lines in other motions and seas: the greatest number of elements
/// for every network; integrator and shortest step if all agree on the integrator, else those of the scene. `None` if nothing was found.
pub fn finest(scene: &Scene, found: &[Discretisation]) -> Option<Scene> {
    let networks = Networks::of(scene)?;
    let open: Vec<usize> = (0..networks.lines.len()).filter(|&i| networks.open[i]).collect();
    let fits = |other: &&Discretisation| other.meshes.len() == open.len();
    let found: Vec<&Discretisation> = found.iter().filter(fits).collect();
    let first = &found.first()?.scene.solver;
    let mut elements = vec![1; networks.lines.len()];
    for (place, &network) in open.iter().enumerate() {
        let of_network = found.iter().map(|other| other.meshes[place].elements);
        elements[network] = of_network.max().unwrap_or(1);
    }
    let mut finest = networks.with_elements(scene, &elements);
    for line in 0..scene.lines.len() {
        let others = found.iter();
        others.for_each(|other| short_sections::take_over(&mut finest, line, &other.scene, line));
    }
    let solvers = || found.iter().map(|other| &other.scene.solver);
    if solvers().all(|solver| solver.integrator == first.integrator) {
        finest.solver.integrator = first.integrator;
        let steps = solvers().map(|solver| solver.time_step_max);
        finest.solver.time_step_max = steps.fold(f64::INFINITY, f64::min);
    }
    Some(finest)
}

/// Returns the scene with its present mesh fixed, regardless of later settings: as [`select`] finds it, or by rule. `None` if all elements are given.
pub fn frozen(scene: &Scene) -> Option<Scene> {
    let selected = select(scene).map(|found| found.scene);
    selected.or_else(|| by_rule(scene))
}

/// Returns the scene with the mesh that follows from its tolerance alone. `None` if all elements are given.
pub fn by_rule(scene: &Scene) -> Option<Scene> {
    let mut held = is_open(scene).then(|| scene.clone())?;
    held.solver.elements = Some(line_elements(scene.solver.tolerance).round() as usize);
    Some(held)
}

/// Returns whether the number of elements of any line is left open.
fn is_open(scene: &Scene) -> bool {
    scene.solver.elements.is_none() && scene.lines.iter().any(Line::is_open)
}

/// Lines of a scene, by network.
struct Networks {
    lines: Vec<Vec<usize>>,
    /// True if the elements of any line of a network are left open.
    open: Vec<bool>,
    /// True if a line of a network is a beam, whose integrator is not tried.
    beams: Vec<bool>,
    /// Elements of every line relative to those of an isolated line [-].
    shares: Vec<f64>,
}

impl Networks {
    fn of(scene: &Scene) -> Option<Networks> {
        Some(Networks::new(scene, &Model::new(scene).ok()?))
    }

    /// Returns the networks of a model of the scene.
    fn new(scene: &Scene, model: &Model) -> Networks {
        let networks = model.networks.iter();
        let lines: Vec<Vec<usize>> = networks.map(|network| network.lines.clone()).collect();
        let is_open = |lines: &Vec<usize>| lines.iter().any(|&line| scene.lines[line].is_open());
        let has_beam = |lines: &Vec<usize>| lines.iter().any(|&line| model.lines[line].beam.is_some());
        Networks {
            open: lines.iter().map(is_open).collect(),
            beams: lines.iter().map(has_beam).collect(),
            shares: line_shares(scene),
            lines,
        }
    }

    /// Returns the values of the networks whose elements are open, from one value per network.
    fn open<'a, T>(&'a self, values: &'a [T]) -> impl Iterator<Item = &'a T> {
        values
            .iter()
            .zip(&self.open)
            .filter(|(_, open)| **open)
            .map(|(value, _)| value)
    }

    /// Returns the scene with these elements of an isolated line in every network [-].
    fn with_elements(&self, scene: &Scene, elements: &[usize]) -> Scene {
        let mut scene = scene.clone();
        let first = self.open(elements).next().copied();
        if self.open(elements).all(|&elements| Some(elements) == first) {
            scene.solver.elements = first;
            return scene;
        }
        for (lines, &elements) in self.lines.iter().zip(elements) {
            for &line in lines {
                let own = self.shares[line] * elements as f64;
                let line = &mut scene.lines[line];
                if line.is_open() {
                    line.elements = Some(own.round().max(1.0) as usize);
                }
            }
        }
        scene
    }
}
