//! Estimated time of a run, from the cost of its steps.

use crate::dynamics::node_time;
use crate::scene::{Integrator, Note, Scene};
use crate::simulation::Simulation;

/// Run time above which a note is given [s]: an hour.
const LONG: f64 = 3600.0;

/// Returns a note on a scene whose run, in communication steps of a given length [s], is expected to take longer than an hour on one thread. The
/// estimate uses the step costs from which integrators are chosen and excludes waves. The note is on the network that takes longest.
pub fn expense(scene: &Scene, simulation: &Simulation, interval: f64) -> Option<Note> {
    let (model, duration) = (simulation.model(), scene.output.duration);
    let (mut time, mut longest, mut note) = (0.0, 0.0, None);
    for (network, choice) in model.networks.iter().zip(simulation.choices()) {
        let internal = match choice.integrator {
            Integrator::QuasiStatic => 1.0,
            _ => (interval / choice.longest).ceil(),
        };
        let steps = internal * (duration / interval).ceil();
        let lines = network.lines.iter();
        let elements: usize = lines.map(|&line| model.lines[line].segment_count()).sum();
        let own = 1e-9 * node_time(model, network, choice.integrator) * elements as f64 * steps;
        time += own;
        if own > longest {
            longest = own;
            let at = format!("lines[{}]", network.lines[0]);
            let step = interval / internal;
            note = Some((
                at,
                format!("{elements} elements, {steps:.1e} steps of {step:.1e} s"),
            ));
        }
    }
    let (at, work) = note.filter(|_| time > LONG)?;
    let text = format!(
        "a run of {duration} s takes about {:.0} hours on one thread: {work}; fewer `elements`, which also allow longer steps, or a shorter \
         `output.duration` take less",
        time / LONG
    );
    Some(Note::new(at, text))
}
