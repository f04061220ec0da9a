//! Speed against error: results of the study of a short scene.
//!
//! claim: a converged solution has the promised uncertainty, errors fall as the mesh is refined, cost rises along the frontier as the error falls,
//! and a scene at rest gives no result.

use std::path::Path;
use std::sync::LazyLock;

use moorline::scene::{Integrator, Scene};
use moorline_accuracy::frontier;
use moorline_accuracy::tables::{summary, write_runs, write_verdicts};
use moorline_accuracy::{
    Code, LEVELS, Means, Metric, PeerError, Peers, Study, StudyError, study, uncertainty,
};

/// A taut rope of 100 m whose upper end is pulled with a period of 2 s.
const ROPE: &str = include_str!("../../tests/scenes/pulled_rope.toml");

fn studied() -> &'static Study {
    static STUDY: LazyLock<Study> = LazyLock::new(new_study);
    &STUDY
}

fn new_study() -> Study {
    let scene = Scene::from_toml(ROPE).unwrap();
    let mut told = Vec::new();
    let studies = study("rope", &scene, &Means::default(), &mut |done, total| {
        told.push((done, total));
    });
    assert!(told.is_sorted() && told.last().is_some_and(|(done, total)| done == total));
    let [study] = <[Study; 1]>::try_from(studies.unwrap()).unwrap();
    study
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn a_study_of_a_rope_says_what_each_error_costs() {
    let study = studied();
    let rms = |run: &moorline_accuracy::Run| run.errors.of(Metric::Rms);
    let leapfrog = |code: &Code| *code == Code::Own(Integrator::Leapfrog);
    let runs: Vec<_> = study.runs.iter().filter(|run| leapfrog(&run.code)).collect();
    assert!(runs.len() >= 30);
    // The meshes are sorted from coarse to fine: second order over a factor of 80 in the mesh. From 30 elements on, the tension driven by a host at
    // points in time differs by 5.4e-4 from the converged solution, which follows the motion exactly.
    let position = |run: &moorline_accuracy::Run| run.errors.of(Metric::Position);
    assert!(position(runs[runs.len() - 1]) < 0.01 * position(runs[0]));
    assert!(rms(runs[runs.len() - 1]) < 6e-4);
    assert!(study.uncertainty.of(Metric::Rms) < 1e-3 * rms(runs[0]));
    told(study);
    for metric in Metric::ALL {
        let frontier = study.frontier(metric, Code::is_own);
        assert!(frontier.is_sorted_by(|a, b| a.cost <= b.cost));
        assert!(frontier.is_sorted_by(|a, b| a.errors.of(metric) > b.errors.of(metric)));
        let best = study.cheapest(metric, 0.05, Code::is_own).unwrap();
        assert!(best.errors.of(metric) <= 0.05);
        let cheaper = study.runs.iter().filter(|run| run.cost < best.cost);
        assert!(cheaper.map(|run| run.errors.of(metric)).all(|error| error > 0.05));
    }
    assert!(
        study
            .runs
            .iter()
            .all(|run| run.cost > 0.0 && run.cost.is_finite())
    );
}

/// Checks the tables of a study without peers: a row for every run, one for every level reached, and a figure.
fn told(study: &Study) {
    let rows = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap().lines().count() - 1;
    let studies = std::slice::from_ref(study);
    let (mut runs, mut verdicts) = (Vec::new(), Vec::new());
    write_runs("a processor", studies, &mut runs).unwrap();
    write_verdicts("a processor", studies, &mut verdicts).unwrap();
    assert_eq!(rows(runs), study.runs.len());
    let reached = study.verdicts().iter().filter(|v| v.own.is_some()).count();
    assert_eq!(rows(verdicts), reached);
    assert!(reached > 3 * LEVELS.len());
    assert!(study.verdicts().iter().all(|v| v.ratio().is_none()));
    assert!(summary(studies).contains("rope, mid position 1 %"));
    let figure = frontier::figure(study);
    assert!(figure.contains("uncertainty of the converged solution"));
    assert!(frontier::in_host(studies).is_none());
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn slower_motion_brings_the_quasi_static_mode_nearer() {
    let slow = &studied().slow;
    assert!(slow.len() >= 2 && slow[0].factor == 1.0 && slow[0].period == 2.0);
    let errors: Vec<f64> = slow.iter().map(|one| one.errors.of(Metric::Rms)).collect();
    // The error does not fall with every factor: the rope swings with a period of 8 s.
    assert!(errors[0] > 0.1, "{errors:?}");
    assert!(errors[errors.len() - 1] <= 0.01, "{errors:?}");
}

fn converges(name: &str, scene: &str) {
    let scene = Scene::from_toml(scene).unwrap();
    let limit = uncertainty(name, &scene).unwrap();
    let reached = Metric::ALL.map(|metric| limit.of(metric));
    assert!(limit.of(Metric::Rms) <= 0.002, "{reached:?}");
    assert!(limit.of(Metric::Position) <= 0.001, "{reached:?}");
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn oc3_converges_to_a_fifth_of_a_percent_in_tension_and_a_thousandth_in_position() {
    converges("oc3", include_str!("../../scenes/oc3_catenary.toml"));
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn oc4_converges_to_a_fifth_of_a_percent_in_tension_and_a_thousandth_in_position() {
    converges("oc4", include_str!("../../scenes/oc4_chain.toml"));
}

#[test]
fn the_page_shows_the_committed_summary_of_every_processor() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("docs");
    let page = std::fs::read_to_string(docs.join("accuracy.md")).unwrap();
    let shown = page.split("<!-- accuracy: begin -->").nth(1).unwrap();
    let shown = shown.split("<!-- accuracy: end -->").next().unwrap();
    let entries = std::fs::read_dir(docs.join("accuracy")).unwrap();
    let folders: Vec<_> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .collect();
    assert_eq!(shown.matches("Measured on ").count(), folders.len());
    for folder in folders {
        let place = format!("(accuracy/{})", folder.file_name().unwrap().to_str().unwrap());
        let part = shown
            .split("Measured on ")
            .find(|part| part.contains(&place))
            .unwrap();
        let summary = std::fs::read_to_string(folder.join("summary.md")).unwrap();
        assert!(part.trim_end().ends_with(summary.trim_end()), "{part}");
        for name in ["overview.svg", "accuracy.csv", "verdicts.csv"] {
            assert!(folder.join(name).is_file(), "{place}: {name}");
        }
    }
}

#[test]
fn nothing_is_said_of_a_scene_at_rest() {
    let mut scene = Scene::from_toml(ROPE).unwrap();
    scene.motion.clear();
    scene.output.duration = 0.5;
    let error = study("rope", &scene, &Means::default(), &mut |_, _| ()).unwrap_err();
    assert!(matches!(error, StudyError::AtRest { .. }), "{error}");
}

#[test]
fn an_interpreter_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = Path::new("no-such-python");
    let error = Peers::find(missing, folder.path()).unwrap_err();
    assert!(matches!(&error, PeerError::NoPython(named) if named == missing));
}

#[test]
fn a_quasi_static_scene_is_studied_through_equilibria_alone() {
    let mut scene = Scene::from_toml(ROPE).unwrap();
    scene.solver.integrator = Integrator::QuasiStatic;
    let studies = study("rope", &scene, &Means::default(), &mut |_, _| ()).unwrap();
    let study = &studies[0];
    let own = |code: &Code| *code == Code::Own(Integrator::QuasiStatic);
    assert!(!study.runs.is_empty() && study.runs.iter().all(|run| own(&run.code)));
    assert!(study.slow.is_empty() && study.failed.is_empty());
    let rms = study.runs.iter().map(|run| run.errors.of(Metric::Rms));
    assert!(rms.fold(0.0, f64::max) < 1e-9);
}
