//! Reference results of an FMU: the beginning of the scene's motion and the outputs that follow from it.
//!
//! Source: FMI-LS-REF 1.0.0-alpha.1 (layered standard "References"), schemas `fmi3LayeredStandardReferenceManifest.xsd` and
//! `…Experiments.xsd`: a manifest that gives each file a role, and an experiment with stimuli and references as tables. A host sets the
//! inputs of the row at t before the step from t.

use csv::Writer;

use crate::interface::{Binding, Causality, Interface, Variable};
use crate::output::recorder::{input_of, recorded};
use crate::output::times::Times;
use crate::output::xml::{document, empty, number, within};
use crate::scene::Scene;
use crate::simulation::{Error, Simulation};

/// Folder in an FMU.
pub(super) const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref/";
/// Path of the experiment in an FMU.
pub const EXPERIMENTS_FILE: &str = "extra/org.fmi-standard.fmi-ls-ref/experiments.xml";

const MANIFEST: &str = "fmi-ls-manifest.xml";
const EXPERIMENTS: &str = "experiments.xml";
const STIMULI: &str = "reference_inputs.csv";
const REFERENCES: &str = "reference_results.csv";

/// Greatest number of steps of the experiment [-].
const STEPS_MAX: usize = 100;
/// Greatest deviation of a variable from its reference, over the greatest magnitude of the reference [-].
const TOLERANCE: f64 = 1e-6;

/// Files of the reference results, by name in their folder; empty if the first step of the scene fails.
///
/// # Errors
/// No static equilibrium is found.
pub(super) fn files(
    scene: &Scene,
    simulation: &Simulation,
    interface: &Interface,
) -> Result<Vec<(&'static str, Vec<u8>)>, Error> {
    let of = |kept: fn(&Variable) -> bool| recorded(interface).filter(move |variable| kept(variable));
    let inputs: Vec<&Variable> = of(|variable| {
        matches!(
            variable.binding,
            Binding::Displacement { .. } | Binding::LengthChange { .. }
        )
    })
    .collect();
    let outputs: Vec<&Variable> = of(|variable| variable.causality == Causality::Output).collect();
    let mut run = Run {
        simulation: simulation.clone(),
        inputs: Table::new(inputs),
        outputs: Table::new(outputs),
    };
    let end = run.run(scene)?;
    let Some(end) = end else {
        return Ok(Vec::new());
    };
    Ok(vec![
        (MANIFEST, manifest().into_bytes()),
        (EXPERIMENTS, experiments(end, scene.output.interval).into_bytes()),
        (STIMULI, run.inputs.bytes()),
        (REFERENCES, run.outputs.bytes()),
    ])
}

/// Rows of some variables in time.
struct Table<'i> {
    variables: Vec<&'i Variable>,
    rows: Vec<Vec<f64>>,
}

impl<'i> Table<'i> {
    fn new(variables: Vec<&'i Variable>) -> Self {
        let rows = Vec::new();
        Table { variables, rows }
    }

    /// Text of the table, with the names of the variables above it.
    fn bytes(&self) -> Vec<u8> {
        let mut writer = Writer::from_writer(Vec::new());
        let names = self.variables.iter().map(|variable| variable.name.as_str());
        let write = |writer: &mut Writer<Vec<u8>>| -> csv::Result<()> {
            writer.write_record(std::iter::once("time").chain(names))?;
            for row in &self.rows {
                writer.write_record(row.iter().map(|value| number(*value)))?;
            }
            Ok(())
        };
        write(&mut writer).expect("writing to memory does not fail");
        writer.into_inner().expect("writing to memory does not fail")
    }
}

/// Experiment as run by a host.
struct Run<'i> {
    simulation: Simulation,
    inputs: Table<'i>,
    outputs: Table<'i>,
}

impl Run<'_> {
    /// Runs up to the last step that succeeds, and returns its end [s].
    fn run(&mut self, scene: &Scene) -> Result<Option<f64>, Error> {
        let planned = scene
            .output
            .duration
            .min(scene.output.interval * STEPS_MAX as f64);
        let times = Times::new(planned, scene.output.interval);
        self.set_inputs(0.0);
        self.simulation.restart(0.0)?;
        let mut end = None;
        for index in 0..=times.count {
            let now = times.at(index);
            let steps = index == 0 || {
                self.set_inputs(times.at(index - 1));
                self.simulation.advance(times.step(index - 1)).is_ok()
            };
            let Some(row) = steps.then(|| self.row(now)).flatten() else {
                break;
            };
            let inputs = self.input_row(now);
            self.inputs.rows.push(inputs);
            self.outputs.rows.push(row);
            end = (index > 0).then_some(now);
        }
        Ok(end)
    }

    fn input_row(&self, time: f64) -> Vec<f64> {
        let model = self.simulation.model();
        let moving = model.moving(time);
        let value = |variable: &&Variable| input_of(variable, model, &moving, time).unwrap_or(0.0);
        std::iter::once(time)
            .chain(self.inputs.variables.iter().map(value))
            .collect()
    }

    /// Sets the displacements and length changes at a time [s], without velocities.
    fn set_inputs(&mut self, time: f64) {
        let row = self.input_row(time);
        for (variable, value) in self.inputs.variables.iter().zip(&row[1..]) {
            variable.set_input(self.simulation.inputs_mut(), std::slice::from_ref(value));
        }
    }

    /// Present outputs; `None` if one of them is not finite.
    fn row(&self, time: f64) -> Option<Vec<f64>> {
        let mut row = vec![time];
        for variable in &self.outputs.variables {
            let mut value = [f64::NAN];
            Interface::read(variable, &self.simulation, &mut value).ok()?;
            row.push(value[0]);
        }
        Some(row)
    }
}

/// Text of the manifest.
fn manifest() -> String {
    let root = [
        ("xmlns:fmi-ls", "http://fmi-standard.org/fmi-ls-manifest"),
        ("fmi-ls:fmi-ls-name", "org.fmi-standard.fmi-ls-ref"),
        ("fmi-ls:fmi-ls-version", "1.0.0-alpha.1"),
        (
            "fmi-ls:fmi-ls-description",
            "Layered Standard providing information on related files included in an FMU.",
        ),
    ];
    let related = [
        (
            "text/xml",
            EXPERIMENTS,
            "experiment/smoke-test",
            "the beginning of the scene's motion",
        ),
        ("text/csv", STIMULI, "testcase", "inputs of the experiment"),
        ("text/csv", REFERENCES, "result", "outputs of the experiment"),
        (
            "application/toml",
            "../../resources/scene.toml",
            "model",
            "the scene that the FMU was made from",
        ),
    ];
    document(|xml| {
        within(xml, "fmiReferences", &root, |xml| {
            related.iter().try_for_each(|(kind, source, role, description)| {
                let attributes = [
                    ("type", *kind),
                    ("source", source),
                    ("role", role),
                    ("description", description),
                ];
                empty(xml, "Related", &attributes)
            })
        })
    })
}

/// Text of the experiment, which ends at `end` [s] and has steps of `step` [s].
fn experiments(end: f64, step: f64) -> String {
    let [end, step, tolerance] = [end, step, TOLERANCE].map(number);
    let attributes = [
        ("name", "reference"),
        (
            "description",
            "displacements by the scene's motion, set before each step; no velocities",
        ),
        ("startTime", "0.0"),
        ("stopTime", end.as_str()),
        ("tolerance", tolerance.as_str()),
        ("stepSize", step.as_str()),
    ];
    document(|xml| {
        within(xml, "Experiments", &[], |xml| {
            within(xml, "Experiment", &attributes, |xml| {
                empty(xml, "Stimuli", &[("source", STIMULI), ("type", "text/csv")])?;
                empty(xml, "References", &[("source", REFERENCES), ("type", "text/csv")])
            })
        })
    })
}
