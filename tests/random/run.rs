//! Runs a random scene and checks the claims.

use std::panic::{AssertUnwindSafe, catch_unwind};

use moorline::discretisation::discretised;
use moorline::dynamics::{Choice, StepError};
use moorline::interface::{Causality, Interface, Layout};
use moorline::model::Network;
use moorline::scene::{Integrator, Profile, Scene};
use moorline::simulation::{Error, Simulation, Snapshot};

use crate::dice::Tape;
use crate::drive::Drive;
use crate::plan::Plan;
use crate::{energy, layout};

/// Maximum work of a scene, in node steps of the explicit leapfrog [-]; a run that would need more stops and counts as too
/// expensive.
const BUDGET: f64 = 2e7;
/// Work that one communication step must never exceed [-].
const STEP_MAX: f64 = 1e9;
/// Number of communication steps of the replay [-].
const REPLAY: usize = 5;

/// A random scene and its host.
#[derive(Debug, Clone)]
pub struct Case {
    pub scene: Scene,
    pub drive: Drive,
}

impl Case {
    /// Returns the case of a tape.
    pub fn of(tape: &Tape) -> Case {
        let plan = Plan::of(tape);
        let scene = layout::scene(tape, &plan);
        let drive = Drive::of(tape, &plan, &scene);
        Case { scene, drive }
    }

    /// Returns the scene as the command line reads it, with its host as a comment.
    pub fn as_toml(&self) -> String {
        format!("# host: {:?}\n{}", self.drive, self.scene.to_toml())
    }
}

/// Outcome of a scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Fate {
    /// Ran for the whole span.
    #[default]
    Ran,
    /// Refused as a scene, with a reason.
    Refused(String),
    /// Has no equilibrium, with a reason.
    Unsolved(String),
    /// A step failed, with a reason.
    Stopped(String),
    /// Exceeded the cost limit of a test.
    Costly,
}

/// Record of a run.
#[derive(Debug, Clone, Default)]
pub struct Account {
    pub fate: Fate,
    /// Integrators used, by name.
    pub integrators: Vec<String>,
    /// Error of the energy balance, relative to the energy that it counts [-].
    pub imbalance: f64,
    /// Net energy added by algorithmic dissipation, relative to the same energy [-].
    pub created: f64,
    /// Work of all steps [-].
    pub work: f64,
    /// Work of the most expensive communication step [-].
    pub dearest: f64,
    /// Time reached [s].
    pub time: f64,
}

/// Runs a case; the error is the claim that is broken.
pub fn run(case: &Case) -> Result<Account, String> {
    catch_unwind(AssertUnwindSafe(|| watched(case))).unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str);
        let said = said.or_else(|| panic.downcast_ref::<&str>().copied());
        Err(format!("it panicked: {}", said.unwrap_or("")))
    })
}

fn watched(case: &Case) -> Result<Account, String> {
    let mut account = Account::default();
    let begun = Simulation::new(&discretised(&case.scene)).and_then(|mut simulation| {
        if case.drive.follows {
            simulation.follow_scene()?;
        }
        Ok(simulation)
    });
    match begun {
        Ok(mut simulation) => steps(case, &mut simulation, &mut account)?,
        Err(Error::Scene(mistake)) if mistake.at.is_empty() || mistake.problem.len() < 10 => {
            return Err(format!("{mistake:?} says nothing"));
        }
        Err(Error::Scene(mistake)) => account.fate = Fate::Refused(mistake.to_string()),
        Err(Error::Statics(error)) if error.to_string().len() < 20 => {
            return Err(format!("{error:?} says nothing"));
        }
        Err(Error::Statics(error)) => account.fate = Fate::Unsolved(error.to_string()),
    }
    Ok(account)
}

/// Makes all communication steps, until one fails or the budget is spent.
fn steps(case: &Case, simulation: &mut Simulation, account: &mut Account) -> Result<(), String> {
    let outputs = Outputs::new(&case.scene, simulation)?;
    outputs
        .read(simulation)
        .map_err(|problem| format!("at rest, {problem}"))?;
    let choices = simulation.choices();
    account.integrators = choices.map(|choice| format!("{:?}", choice.integrator)).collect();
    let load = Load::of(simulation);
    let replayed = case.drive.steps.len() / 2;
    let mut memory: Option<Snapshot> = None;
    let mut balance = energy::Balance::new(simulation);
    for (number, &step) in case.drive.steps.iter().enumerate() {
        if account.work + load.expected(step) > BUDGET {
            account.fate = Fate::Costly;
            break;
        }
        if number == replayed {
            memory = Some(simulation.snapshot().clone());
        }
        case.drive.set_inputs(simulation);
        let before = simulation.snapshot().clone();
        let time = simulation.time();
        if let Err(error) = simulation.advance(step) {
            said_clearly(&error, &before, simulation)?;
            account.fate = Fate::Stopped(error.to_string());
            break;
        }
        let cost = load.weight * simulation.counters().solves as f64;
        (account.work, account.dearest) = (account.work + cost, account.dearest.max(cost));
        if cost > STEP_MAX {
            return Err(format!("{step} s at {time} s cost {cost:.1e} node steps"));
        }
        let at = |problem| format!("{time} s + {step} s, {problem}");
        outputs.read(simulation).map_err(at)?;
        balance.count(simulation);
        if number + 1 == replayed + REPLAY {
            replay(case, simulation, memory.take(), replayed).map_err(at)?;
        }
    }
    account.time = simulation.time();
    account.imbalance = balance.imbalance(simulation);
    account.created = balance.created();
    Ok(())
}

/// Cost of steps.
struct Load {
    /// Work of every network per internal step, without halved or repeated steps [-], and its longest internal step [s].
    networks: Vec<(f64, f64)>,
    /// Work of a solve, averaged over the networks [-].
    weight: f64,
}

impl Load {
    fn of(simulation: &Simulation) -> Load {
        let model = simulation.model();
        let network = |(network, choice): (&Network, &Choice)| {
            let lines = network.lines.iter().map(|&line| &model.lines[line]);
            let nodes: usize = lines.map(|line| line.segment_count() + 1).sum();
            (node_cost(choice.integrator) * nodes as f64, choice.step_max)
        };
        let networks = model.networks.iter().zip(simulation.choices());
        let networks: Vec<(f64, f64)> = networks.map(network).collect();
        let total: f64 = networks.iter().map(|(work, _)| work).sum();
        Load {
            weight: total / networks.len() as f64,
            networks,
        }
    }

    /// Least work of a communication step of `step` [s] [-].
    fn expected(&self, step: f64) -> f64 {
        self.networks
            .iter()
            .map(|(work, longest)| work * (step / longest).ceil())
            .sum()
    }
}

/// Work per node of a step or iteration of an integrator, relative to the explicit leapfrog [-].
fn node_cost(integrator: Integrator) -> f64 {
    match integrator {
        Integrator::Leapfrog => 1.0,
        Integrator::AxialImplicit => 4.0,
        Integrator::Beam => 60.0,
        _ => 30.0,
    }
}

/// Checks that a failed step reports its location and reason and leaves the state unchanged.
fn said_clearly(error: &StepError, before: &Snapshot, simulation: &Simulation) -> Result<(), String> {
    let mut lines = simulation.model().lines.iter();
    let line = lines.find(|line| line.name == error.line);
    let known = line.is_some_and(|line| error.node <= line.segment_count());
    if !known
        || error.cause.to_string().is_empty()
        || error.cause.advice().is_empty()
        || !error.time.is_finite()
    {
        return Err(format!("{error:?} does not say where and why"));
    }
    if bytes(simulation.snapshot()) != bytes(before) {
        return Err(format!("{error} changed the state"));
    }
    Ok(())
}

fn bytes(snapshot: &Snapshot) -> Vec<u8> {
    postcard::to_stdvec(snapshot).expect("a snapshot can be written")
}

/// Repeats the last steps from a snapshot: every bit must be the same as before.
fn replay(
    case: &Case,
    simulation: &mut Simulation,
    memory: Option<Snapshot>,
    from: usize,
) -> Result<(), String> {
    let Some(memory) = memory else { return Ok(()) };
    let first = bytes(simulation.snapshot());
    simulation.restore(memory);
    for &step in &case.drive.steps[from..from + REPLAY] {
        case.drive.set_inputs(simulation);
        let again = simulation.advance(step);
        again.map_err(|error| format!("a step fails when it is made again: {error}"))?;
    }
    match bytes(simulation.snapshot()) == first {
        true => Ok(()),
        false => Err("steps from a snapshot do not come out as they did".to_string()),
    }
}

/// Outputs in the interface table of a scene.
struct Outputs {
    table: Interface,
}

impl Outputs {
    fn new(scene: &Scene, simulation: &Simulation) -> Result<Outputs, String> {
        let mut scene = scene.clone();
        scene.output.profile = Profile::Array;
        let table = Interface::new(&scene, simulation.model(), Layout::Arrays);
        let table = table.map_err(|error| format!("no interface: {error}"))?;
        Ok(Outputs { table })
    }

    /// Reads all of them; the error reports one that is not finite.
    fn read(&self, simulation: &Simulation) -> Result<(), String> {
        for variable in self.table.variables() {
            if ![Causality::Output, Causality::CalculatedParameter].contains(&variable.causality) {
                continue;
            }
            let mut values = vec![0.0; variable.size()];
            Interface::read(variable, simulation, &mut values)?;
        }
        Ok(())
    }
}
