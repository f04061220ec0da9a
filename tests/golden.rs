//! Reference values of the public scenes, with their work. `tests/reference/golden.csv` states their origin.
//!
//! A change of these numbers is a change of results or of cost: write the file again with `cargo test --test golden
//! -- --ignored write_the_reference_values` and give the reason in the commit.

mod common;

use std::path::PathBuf;

use common::*;
use moorline::model::End;
use moorline::scene::Integrator;

/// Greatest relative difference of tensions between machines in a smooth run [-].
const TOLERANCE: f64 = 1e-6;
/// Durations of the runs at full and at model scale [s]: before the first slackening, so that rounding errors do not grow.
const DURATIONS: [f64; 2] = [6.0, 2.0];

const INTEGRATORS: [(&str, Integrator); 4] = [
    ("auto", Integrator::Auto),
    ("leapfrog", Integrator::Leapfrog),
    ("axial_implicit", Integrator::AxialImplicit),
    ("generalised_alpha", Integrator::GeneralisedAlpha),
];

/// A name and its numbers.
type Row = (String, Vec<f64>);

const HEADER: &str = "scene,integrator,tension_b_static,tension_a_static,sag,laid_length,tension_b,middle_x,middle_z,substeps,solves";

/// Static tensions [N], sag and laid length [m]; tension [N] and middle [m] after the run; internal steps and solves.
fn row(name: &str, integrator: (&str, Integrator)) -> Row {
    let mut scene = shipped(name);
    scene.solver.integrator = integrator.1;
    let mut simulation = following(&scene);
    let at_rest = [
        simulation.tension_b(0),
        simulation.line_end_force(0, End::A).norm(),
        simulation.sag(0),
        simulation.laid_length(0),
    ];
    let duration = DURATIONS[usize::from(name.starts_with("lindahl"))];
    let history = History::record(&mut simulation, 0.05, (duration / 0.05).round() as usize);
    let (tension, middle) = (last(&history.tension, 1)[0], last(&history.middle, 1)[0]);
    let moved = [
        tension,
        middle.x,
        middle.z,
        history.substeps as f64,
        history.solves as f64,
    ];
    (
        format!("{name},{}", integrator.0),
        [&at_rest[..], &moved[..]].concat(),
    )
}

fn rows() -> Vec<Row> {
    let scenes = PUBLIC_SCENES.iter().map(|(name, _)| *name);
    scenes
        .flat_map(|name| INTEGRATORS.map(|integrator| row(name, integrator)))
        .collect()
}

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference/golden.csv")
}

fn read() -> Vec<Row> {
    let text = std::fs::read_to_string(path()).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let row = |line: &str| {
        let mut cells = line.split(',');
        let name = format!("{},{}", cells.next().unwrap(), cells.next().unwrap());
        (name, cells.map(|cell| cell.parse().unwrap()).collect())
    };
    lines.map(row).collect()
}

#[test]
fn the_public_scenes_give_the_values_they_gave_before_for_the_same_work() {
    let (found, reference) = (rows(), read());
    assert_eq!(found.len(), reference.len());
    for ((name, found), (reference_name, reference)) in found.iter().zip(&reference) {
        assert_eq!(name, reference_name);
        let (solves, reference_solves) = (found[8], reference[8]);
        assert_eq!(found[7], reference[7], "{name}: internal steps");
        // one iteration more or less is rounding; one in a hundred is a change
        assert!(
            (solves - reference_solves).abs() <= 0.01 * reference_solves,
            "{name}: {solves} solves, {reference_solves} before"
        );
        for (column, (found, reference)) in HEADER.split(',').skip(2).zip(found.iter().zip(reference)).take(7)
        {
            let scale = reference.abs().max(1e-3);
            assert!(
                (found - reference).abs() <= TOLERANCE * scale,
                "{name}, {column}: {found}, {reference} before"
            );
        }
    }
}

#[test]
#[ignore = "writes tests/reference/golden.csv"]
fn write_the_reference_values() {
    let mut text = format!(
        "# moorline {}: cargo test --test golden -- --ignored write_the_reference_values\n\
         # the first {} s (model scale: {} s) of every public scene at a communication step of 0.05 s, by integrator; N, m, counts\n{HEADER}\n",
        env!("CARGO_PKG_VERSION"),
        DURATIONS[0],
        DURATIONS[1]
    );
    for (name, numbers) in rows() {
        let cells: Vec<String> = numbers.iter().map(f64::to_string).collect();
        text += &format!("{name},{}\n", cells.join(","));
    }
    std::fs::create_dir_all(path().parent().unwrap()).unwrap();
    std::fs::write(path(), text).unwrap();
}
