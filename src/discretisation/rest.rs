//! Number of elements that a line needs at rest, by comparison with the tension of its closed-form catenary.

use super::{AIM, ELEMENTS_MAX, Mesh, Networks, Rest};
use crate::scene::{InitialShape, Scene};
use crate::simulation::Simulation;

/// Fraction of an error at rest that additional elements must remove to be adopted if the tolerance is still exceeded [-].
const GAIN: f64 = 0.5;

/// Adds elements to the meshes whose tension at rest exceeds the tolerance, unless more elements do not help. `given` is a simulation on these
/// meshes. Returns a simulation on the finer meshes if one was started.
pub(super) fn refine(
    scene: &Scene,
    networks: &Networks,
    meshes: &mut [Mesh],
    given: &Simulation,
    start: impl Fn(&Scene) -> Option<Simulation>,
) -> Option<Simulation> {
    let aim = AIM * scene.solver.tolerance;
    let mut elements: Vec<usize> = meshes.iter().map(|mesh| mesh.elements).collect();
    let first = errors(scene, networks, given)?;
    let mut now = first.clone();
    let mut finest = None;
    let lacks = |elements: usize, error: f64| error > aim && (elements as f64) < ELEMENTS_MAX;
    while let wanting = elements.iter().zip(&now).zip(&networks.open)
        && wanting
            .into_iter()
            .any(|((&n, &error), open)| *open && lacks(n, error))
    {
        for ((n, error), open) in elements.iter_mut().zip(&now).zip(&networks.open) {
            if *open && lacks(*n, *error) {
                *n = (2.0 * *n as f64).min(ELEMENTS_MAX) as usize;
            }
        }
        let finer = start(&networks.with_elements(scene, &elements))?;
        now = errors(scene, networks, &finer)?;
        finest = Some(finer);
    }
    for (i, mesh) in meshes.iter_mut().enumerate() {
        let helps = now[i] <= aim || now[i] <= (1.0 - GAIN) * first[i];
        if elements[i] > mesh.elements && helps {
            mesh.rest = Some(Rest {
                fewer: mesh.elements,
                errors: [first[i], now[i]],
            });
            mesh.elements = elements[i];
        }
    }
    let same = meshes.iter().zip(&elements).all(|(mesh, &n)| mesh.elements == n);
    finest.filter(|_| same)
}

/// Greatest error of the tension at the driven ends of the lines of every network at rest against their closed-form catenaries [-]; 0 for a network
/// without a closed form, `None` if no line has one.
fn errors(scene: &Scene, networks: &Networks, simulation: &Simulation) -> Option<Vec<f64>> {
    let model = simulation.model();
    let of_line = |line: usize| {
        let (built, exact) = (&model.lines[line], simulation.catenary(line)?);
        if built.bends() || built.drifts(model) || scene.lines[line].initial != InitialShape::Static {
            return None;
        }
        let end = model.driven_end(line);
        let (found, exact) = (
            simulation.tension_at(line, end),
            [exact.tension_a(), exact.tension_b()][end as usize],
        );
        Some((found - exact).abs() / exact)
    };
    let errors: Vec<Option<f64>> = networks
        .lines
        .iter()
        .map(|lines| lines.iter().filter_map(|&line| of_line(line)).reduce(f64::max))
        .collect();
    errors.iter().find_map(|error| *error)?;
    let known = |error: Option<f64>| error.filter(|error| error.is_finite()).unwrap_or(0.0);
    Some(errors.into_iter().map(known).collect())
}
