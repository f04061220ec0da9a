//! Cost of an internal step of the kernels alone, with the best vectors of the machine and in the portable build, compared with the time of the
//! square roots and divisions of the explicit kernel; and cost of whole communication steps by both leapfrogs.
//!
//! `-- PART`, one of divider, explicit, axial, compared and whole, measures only that part; `-- --write` measures all parts and writes the table of
//! this machine, `benches/tables/<processor>.step.csv`.

mod common;

use std::env;
use std::fmt::Write;
use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use moorline::dynamics::leapfrog::step::Step;
use moorline::dynamics::leapfrog::{AxialImplicit, Explicit, Kernel, LeapfrogNetwork};
use moorline::math::lanes::{LANES, Lanes};
use moorline::math::unit::VectorUnit;
use moorline::model::{Kinematics, Model, State};
use moorline::scene::{Integrator, Scene};
use moorline::simulation::Simulation;
use nalgebra::Vector3;
use pulp::NullaryFnOnce;

const SCENES: [&str; 4] = ["oc3_catenary", "oc4_chain", "taut_polyester", "lindahl_fast"];
const ELEMENTS: [usize; 6] = [10, 20, 28, 40, 80, 160];
/// Elements of the axial-implicit kernel alone, and its steps per advance.
const ELEMENTS_AXIAL: [usize; 7] = [5, 10, 20, 40, 48, 80, 160];
const STEPS_AXIAL: [usize; 2] = [1, 10];
/// Axial-implicit runs, without an energy balance, that compare the public scenes with other codes: scene, elements, step and communication step [s].
const COMPARED: [(&str, usize, f64, f64); 4] = [
    ("lindahl_fast", 47, 0.05 / 7.0, 0.05),
    ("taut_polyester", 5, 0.5, 0.5),
    ("taut_polyester", 10, 0.25, 0.5),
    ("taut_polyester", 8, 0.25, 0.5),
];
/// Lines of a system, which are stepped in turn.
const LINES: usize = 12;
/// Steps of a line in its turn.
const TURN: usize = 8;
/// Turns that are timed together, and the number of repetitions; the fastest counts.
const TURNS: usize = 200;
const REPETITIONS: usize = 60;

/// Function that measures a part and writes the result into the table.
type Part = fn(&mut String);

fn main() -> ExitCode {
    let mut table = String::from(
        "what,scene,n,lines,ns per step,ns per node and step,portable ns per step,portable ns per node and step\n",
    );
    let parts: [(&str, Part); 5] = [
        ("divider", divider),
        ("explicit", kernels),
        ("axial", axial_kernels),
        ("compared", compared),
        ("whole", communication),
    ];
    let words: Vec<String> = env::args().skip(1).collect();
    let named = |name: &str| words.iter().any(|word| word == name);
    let all = !parts.iter().any(|(name, _)| named(name));
    for (name, part) in parts {
        if all || named(name) {
            part(&mut table);
        }
    }
    if all && named("--write") && !common::write_table("step", &table) {
        println!("the processor's name is not known: no table can be made");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

/// Three square roots and three divisions per four numbers, as in the explicit kernel for four nodes on the seabed.
struct Divide<'a> {
    of: &'a [[Lanes; 3]],
    into: &'a mut [Lanes],
}

impl NullaryFnOnce for Divide<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        for row in 0..self.of.len() {
            let [a, b, c] = self.of[row];
            let roots = a.sqrt() + b.sqrt() + c.sqrt();
            self.into[row] = roots + a.recip() + b.recip() + c.recip();
        }
    }
}

/// Measures a lower bound of the time of the kernel.
fn divider(table: &mut String) {
    let numbers: Vec<[Lanes; 3]> = (1..=64)
        .map(|k| [1.0, 2.0, 3.0].map(|a| Lanes::splat(a + f64::from(k))))
        .collect();
    let mut found = vec![Lanes::splat(0.0); numbers.len()];
    let [wide, portable] = [VectorUnit::best(), VectorUnit::portable()].map(|unit| {
        let mut best = f64::INFINITY;
        for _ in 0..TURNS * REPETITIONS {
            let clock = Instant::now();
            let (of, into) = (black_box(&numbers[..]), black_box(&mut found[..]));
            unit.dispatch(Divide { of, into });
            best = best.min(clock.elapsed().as_secs_f64());
        }
        1e9 * best / (LANES * numbers.len()) as f64
    });
    println!("roots and quotients alone: {wide:.2} ns/node/step, portable {portable:.2}\n");
    writeln!(table, "roots and quotients,,,,,{wide:.2},,{portable:.2}").expect("a String takes all");
}

fn meshed(name: &str, integrator: Integrator, elements: usize) -> Scene {
    let mut scene = common::scene(name);
    scene.solver.integrator = integrator;
    scene.lines[0].sections[0].elements = Some(elements);
    scene
}

/// Mesh with and without an energy balance: suffix of its name in the table, and whether it has the balance.
fn with_and_without(elements: usize) -> [(usize, (&'static str, bool)); 2] {
    [("", true), (" without balance", false)].map(|kind| (elements, kind))
}

/// Simulation of a scene, one communication step after its start.
fn stepped(name: &str, integrator: Integrator, elements: usize, balance: bool) -> Simulation {
    let mut scene = meshed(name, integrator, elements);
    scene.output.energy_balance = balance;
    let mut simulation = Simulation::new(&scene).expect("an equilibrium");
    simulation.follow_scene().expect("an equilibrium");
    simulation.advance(0.05).expect("a step");
    simulation
}

fn kernel_heading(kernel: &str, times: &str) {
    println!(
        "\n{kernel:<16} {:>5} {times:>6} {:>9} {:>13} {:>18} {:>22}",
        "n", "ns/step", "ns/node/step", "portable ns/step", "portable ns/node/step"
    );
}

/// Records the cost of a step, [ns] with the best vectors and with portable ones.
fn note_kernel(
    table: &mut String,
    (what, lines): (&str, usize),
    (name, elements, times): (&str, usize, usize),
    [wide, portable]: [f64; 2],
) {
    let nodes = (elements + 1) as f64;
    println!(
        "{name:<16} {elements:>5} {times:>6} {wide:>9.0} {:>13.1} {portable:>18.0} {:>22.1}   {what}",
        wide / nodes,
        portable / nodes
    );
    writeln!(
        table,
        "{what},{name},{elements},{lines},{wide:.0},{:.2},{portable:.0},{:.2}",
        wide / nodes,
        portable / nodes
    )
    .expect("a String takes all");
}

/// Measures the explicit kernel alone.
fn kernels(table: &mut String) {
    kernel_heading("explicit alone", "lines");
    for name in SCENES {
        for (elements, (booked, balance)) in ELEMENTS.into_iter().flat_map(with_and_without) {
            let simulation = stepped(name, Integrator::Leapfrog, elements, balance);
            let step = 0.05 / simulation.substeps() as f64;
            for lines in [1, LINES] {
                let [wide, portable] = [false, true]
                    .map(|portable| step_cost(simulation.model(), simulation.state(), step, lines, portable));
                let what = (&*format!("explicit alone{booked}"), lines);
                note_kernel(table, what, (name, elements, lines), [wide, portable]);
            }
        }
    }
}

/// Measures the axial-implicit kernel alone, with its preparation and hand-over in an advance.
fn axial_kernels(table: &mut String) {
    kernel_heading("axial-implicit", "steps");
    for name in SCENES {
        for (elements, (booked, balance)) in ELEMENTS_AXIAL.into_iter().flat_map(with_and_without) {
            let simulation = stepped(name, Integrator::AxialImplicit, elements, balance);
            let step = 0.05 / simulation.substeps() as f64;
            for count in STEPS_AXIAL {
                let costs = [false, true].map(|portable| {
                    axial_cost(simulation.model(), simulation.state(), step, count, portable)
                });
                let what = format!("axial-implicit alone{booked}; {count} in an advance");
                note_kernel(table, (&what, 1), (name, elements, count), costs);
            }
        }
    }
}

/// Back-and-forth motion by 1 m in 10 s, as cheap as the path between two communication points.
fn sway(state: &State) -> impl Fn(usize, f64) -> Kinematics + '_ {
    |point, t| {
        let u = (0.1 * (t - state.time)).fract();
        let v = u * (1.0 - u);
        Kinematics {
            position: state.points[point].position + 16.0 * v * v * Vector3::x(),
            velocity: 3.2 * v * (1.0 - 2.0 * u) * Vector3::x(),
            acceleration: 0.32 * (1.0 - 6.0 * v) * Vector3::x(),
            ..Kinematics::default()
        }
    }
}

/// Time of a step [ns] of the axial-implicit kernel of a line, with `count` steps per advance and a swaying fairlead.
fn axial_cost(model: &Model, state: &State, size: f64, count: usize, portable: bool) -> f64 {
    let mut work = loaded::<AxialImplicit>(model, state, portable);
    let (mut end, held) = (state.clone(), sway(state));
    let step = Step::after([size; 2], size);
    let (mut t, mut best) = (state.time, f64::INFINITY);
    let advances = TURNS * TURN / 2 / count;
    for _ in 0..REPETITIONS {
        let clock = Instant::now();
        for _ in 0..advances {
            work.resume(&end);
            work.set_out(t, size, true, &held);
            work.meet_surface();
            for _ in 0..count {
                work.step(model, [t, t + size], step, &held);
                t += size;
            }
            black_box(work.flow());
            assert!(work.store(&mut end, [size; 2]), "a stable step");
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    1e9 * best / (advances * count) as f64
}

/// Leapfrog with a loaded state.
fn loaded<K: Kernel>(model: &Model, state: &State, portable: bool) -> LeapfrogNetwork<K> {
    let mut work = LeapfrogNetwork::new(model, &model.networks[0]).expect("one strain measure");
    work.set_portable(portable);
    work.load(state);
    work
}

/// Time of a step of one line [ns] if `lines` equal lines are stepped in turn, with a swaying fairlead.
fn step_cost(model: &Model, state: &State, size: f64, lines: usize, portable: bool) -> f64 {
    let work = |_| loaded::<Explicit>(model, state, portable);
    let mut works: Vec<LeapfrogNetwork<Explicit>> = (0..lines).map(work).collect();
    let held = sway(state);
    let step = Step::after([size; 2], size);
    for work in &mut works {
        work.set_out(state.time, size, false, &held);
    }
    let (mut t, mut best) = (state.time, f64::INFINITY);
    for _ in 0..REPETITIONS {
        let clock = Instant::now();
        for _ in 0..TURNS / lines {
            for work in &mut works {
                for k in 0..TURN {
                    let times = [k, k + 1].map(|k| t + k as f64 * size);
                    work.step(model, times, step, &held);
                }
            }
            t += TURN as f64 * size;
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    let mut end = state.clone();
    let sound = works.iter_mut().all(|work| work.store(&mut end, [size; 2]));
    assert!(sound, "a stable step");
    1e9 * best / (TURNS / lines * lines * TURN) as f64
}

/// Measures whole communication steps of the runs that are compared with other codes.
fn compared(table: &mut String) {
    println!(
        "\n{:<16} {:>5} {:>8} {:>8} {:>14} {:>11} {:>12}",
        "compared", "n", "step", "advance", "ns/node/step", "ns/advance", "s/s"
    );
    for (name, elements, step, interval) in COMPARED {
        let mut scene = meshed(name, Integrator::AxialImplicit, elements);
        (scene.solver.time_step_max, scene.output.interval) = (step, interval);
        let cost = common::measure(&scene);
        let advance = 1e9 * cost.second * interval;
        println!(
            "{name:<16} {elements:>5} {step:>8.4} {interval:>8.2} {:>14.1} {advance:>11.0} {:>12.3e}",
            cost.node_step, cost.second
        );
        writeln!(
            table,
            "advances of {interval} s in steps of {step:.4} s,{name},{elements},1,{:.0},{:.2},,",
            cost.node_step * (elements + 1) as f64,
            cost.node_step
        )
        .expect("a String takes all");
    }
}

/// Measures whole communication steps.
fn communication(table: &mut String) {
    println!(
        "\n{:<16} {:<15} {:>5} {:>10} {:>14} {:>12} {:>10}",
        "whole steps", "integrator", "n", "steps/s", "ns/node/step", "s/s", "real-time"
    );
    for name in SCENES {
        for integrator in [Integrator::Leapfrog, Integrator::AxialImplicit] {
            for elements in ELEMENTS {
                let cost = common::measure(&meshed(name, integrator, elements));
                println!(
                    "{name:<16} {:<15} {elements:>5} {:>10.0} {:>14.1} {:>12.2e} {:>10.0}",
                    format!("{integrator:?}"),
                    cost.steps,
                    cost.node_step,
                    cost.second,
                    1.0 / cost.second
                );
                writeln!(
                    table,
                    "whole steps by {integrator:?},{name},{elements},1,{:.0},{:.2},,",
                    cost.node_step * (elements + 1) as f64,
                    cost.node_step
                )
                .expect("a String takes all");
            }
        }
    }
}
