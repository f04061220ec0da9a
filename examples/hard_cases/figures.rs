//! A figure for every hard case.

use moorline::math::low_pass::low_pass;
use moorline::output::figures::compared::{Look, Panel, Series};
use moorline::scene::{ContactLaw, Integrator, Reconstruction, Scene};
use moorline::simulation::Simulation;

use super::Page;
use super::run::Run;
use super::scenes::*;

/// All cases, in the order of the page.
pub const ALL: [fn() -> Page; 14] = [
    snap, stiffness, seabed, damping, short, clump, massless, fall, whip, dragged, jump, resonance, hours,
    steps,
];

/// Maximum number of points of a curve.
const POINTS: usize = 600;

fn series(name: &str, look: Look, points: Vec<[f64; 2]>) -> Series {
    let stride = points.len().div_ceil(POINTS).max(1);
    Series {
        name: name.to_string(),
        points: points.into_iter().step_by(stride).collect(),
        look,
    }
}

fn panel(title: &str, axes: [&str; 2], series: Vec<Series>) -> Panel {
    Panel {
        title: title.to_string(),
        axes: axes.map(str::to_string),
        to_scale: false,
        series,
    }
}

/// Tension at end B against time, between two times [s], in multiples of a unit [N].
fn tension(run: &Run, [from, to]: [f64; 2], unit: f64) -> Vec<[f64; 2]> {
    let samples = run.time.iter().zip(&run.tension);
    let inside = samples.filter(|(t, _)| (from..=to).contains(*t));
    inside.map(|(t, tension)| [*t, tension / unit]).collect()
}

/// The same, low-passed at 0.5 Hz.
fn slow_tension(run: &Run, span: [f64; 2], unit: f64) -> Vec<[f64; 2]> {
    let slow = low_pass(&run.tension, run.time[1] - run.time[0], 0.5);
    let run = Run {
        tension: slow,
        ..run.clone()
    };
    tension(&run, span, unit)
}

/// Error of the energy balance relative to the energy that flowed [%], against time.
fn ledger(run: &Run, time_unit: f64) -> Vec<[f64; 2]> {
    let samples = run.time.iter().zip(&run.error);
    samples
        .map(|(t, error)| [t / time_unit, 100.0 * error / run.flowed])
        .collect()
}

fn named<const N: usize>(runs: [(&str, &Run); N]) -> Vec<(String, Run)> {
    runs.map(|(name, run)| (name.to_string(), run.clone())).into()
}

const KN: f64 = 1e3;
const MN: f64 = 1e6;
const TENSION_KN: [&str; 2] = ["time [s]", "tension [kN]"];
const TENSION_MN: [&str; 2] = ["time [s]", "tension [MN]"];
const TENSION_N: [&str; 2] = ["time [s]", "tension [N]"];

fn lindahl(elements: usize, integrator: Integrator, damping: f64) -> Run {
    let scene = with_elements(shipped("lindahl_fast"), elements);
    Run::of(&more_damped(by(scene, integrator, 0.002), damping), 15.0, 0.005)
}

fn snap() -> Page {
    let converged = lindahl(160, Integrator::Leapfrog, 1.0);
    let explicit = lindahl(40, Integrator::Leapfrog, 1.0);
    let auto = lindahl(40, Integrator::Auto, 1.0);
    let span = [10.0, 12.5];
    Page {
        stem: "hard_01_snap",
        panels: vec![panel(
            "Snap after slack: Lindahl's chain, one turn in 1.25 s",
            TENSION_N,
            vec![
                series("leapfrog, 40 elements", Look::Line, tension(&explicit, span, 1.0)),
                series(
                    "axial-implicit, 40 elements",
                    Look::Line,
                    tension(&auto, span, 1.0),
                ),
                series(
                    "leapfrog, 160 elements",
                    Look::Reference,
                    tension(&converged, span, 1.0),
                ),
            ],
        )],
        runs: named([
            ("40, leapfrog", &explicit),
            ("40, auto", &auto),
            ("160", &converged),
        ]),
    }
}

fn stiffness() -> Page {
    let run = |integrator, factor| {
        let scene = stiffer(shipped("oc3_catenary"), factor);
        Run::of(&by(scene, integrator, 0.02), 40.0, 0.05)
    };
    let [one, hundred, most] = [1.0, 100.0, 1e4].map(|factor| run(Integrator::Auto, factor));
    let implicit = run(Integrator::GeneralisedAlpha, 1e4);
    let span = [10.0, 40.0];
    let curves = vec![
        series("EA", Look::Line, slow_tension(&one, span, MN)),
        series("EA × 100", Look::Line, slow_tension(&hundred, span, MN)),
        series("EA × 10 000", Look::Line, slow_tension(&most, span, MN)),
        series(
            "EA × 10 000, generalised-α",
            Look::Reference,
            slow_tension(&implicit, span, MN),
        ),
    ];
    Page {
        stem: "hard_02_stiffness",
        panels: vec![panel("OC3 line, tension below 0.5 Hz", TENSION_MN, curves)],
        runs: named([
            ("EA", &one),
            ("EA × 100", &hundred),
            ("EA × 10 000", &most),
            ("EA × 10 000, generalised-α", &implicit),
        ]),
    }
}

fn seabed() -> Page {
    let run = |factor| {
        let mut scene = harder_seabed(shipped("oc3_catenary"), factor);
        if let Some(seabed) = &mut scene.seabed {
            seabed.contact = ContactLaw::AsGiven;
        }
        Run::of(&scene, 40.0, 0.05)
    };
    let (given, harder) = (run(1.0), run(100.0));
    let apart = given.time.iter().zip(given.tension.iter().zip(&harder.tension));
    let apart = apart.map(|(t, (a, b))| [*t, (b - a) / KN]).collect();
    let span = [0.0, 40.0];
    Page {
        stem: "hard_03_bed",
        panels: vec![
            panel(
                "OC3 line on a seabed as given and 100 times as hard",
                TENSION_MN,
                vec![
                    series("3 MPa/m", Look::Line, tension(&given, span, MN)),
                    series("300 MPa/m", Look::Reference, tension(&harder, span, MN)),
                ],
            ),
            panel(
                "Difference",
                ["time [s]", "tension [kN]"],
                vec![series("", Look::Line, apart)],
            ),
        ],
        runs: named([("as given", &given), ("seabed × 100", &harder)]),
    }
}

fn damping() -> Page {
    let [none, one, ten] = [0.0, 1.0, 10.0].map(|factor| lindahl(40, Integrator::Leapfrog, factor));
    let span = [11.25, 12.5];
    let swing = |integrator| Run::of(&by(undamped_swing(80), integrator, 0.005), 60.0, 0.1);
    let [leapfrog, axial, implicit] = [
        Integrator::Leapfrog,
        Integrator::AxialImplicit,
        Integrator::GeneralisedAlpha,
    ]
    .map(swing);
    Page {
        stem: "hard_04_damping",
        panels: vec![
            panel(
                "Lindahl's chain, one turn, leapfrog",
                TENSION_N,
                vec![
                    series("BA = 0", Look::Line, tension(&none, span, 1.0)),
                    series("BA = 20 N s", Look::Line, tension(&one, span, 1.0)),
                    series("BA = 200 N s", Look::Line, tension(&ten, span, 1.0)),
                ],
            ),
            panel(
                "Undamped rope that swings and slackens, 80 elements: energy made or lost by the integration",
                ["time [s]", "of the energy in motion [%]"],
                vec![
                    series("leapfrog", Look::Line, ledger(&leapfrog, 1.0)),
                    series("axial-implicit", Look::Line, ledger(&axial, 1.0)),
                    series("generalised-α, 5 ms", Look::Line, ledger(&implicit, 1.0)),
                ],
            ),
        ],
        runs: named([
            ("BA = 0", &none),
            ("BA × 10", &ten),
            ("swing", &leapfrog),
            ("swing, axial-implicit", &axial),
            ("swing, generalised-α", &implicit),
        ]),
    }
}

fn short() -> Page {
    let plain = Run::of(&short_segment(0.0), 30.0, 0.05);
    let explicit = Run::of(&by(short_segment(1000.0), Integrator::Leapfrog, 0.01), 30.0, 0.05);
    let auto = Run::of(&short_segment(1000.0), 30.0, 0.05);
    let span = [10.0, 30.0];
    Page {
        stem: "hard_05_short_segment",
        panels: vec![panel(
            "Chain of 5 m elements, one of 5 mm in its middle, tension below 0.5 Hz",
            TENSION_KN,
            vec![
                series("with, auto", Look::Line, slow_tension(&auto, span, KN)),
                series("without", Look::Reference, slow_tension(&plain, span, KN)),
            ],
        )],
        runs: named([
            ("without", &plain),
            ("with, leapfrog", &explicit),
            ("with, auto", &auto),
        ]),
    }
}

fn clump() -> Page {
    use super::scenes::clump;
    let drop = |integrator| Run::of(&by(clump(10, 1.0, 0.0), integrator, 0.001), 4.0, 0.01);
    let (explicit, implicit) = (drop(Integrator::Leapfrog), drop(Integrator::GeneralisedAlpha));
    let swing = Run::of(&by(clump(10, 0.0, 1.0), Integrator::Leapfrog, 0.001), 20.0, 0.01);
    let pulls = swing_pulls(1.0, 0.01, 2000).into_iter().enumerate();
    let pendulum = pulls.map(|(k, pull)| [0.01 * k as f64, pull / KN]).collect();
    let level = |pull: f64, to: f64| vec![[0.0, pull / KN], [to, pull / KN]];
    Page {
        stem: "hard_06_clump",
        panels: vec![
            panel(
                "1 t dropped by 1 m into 20 m of rope of 2 kg",
                TENSION_KN,
                vec![
                    series("leapfrog", Look::Line, tension(&explicit, [0.0, 4.0], KN)),
                    series(
                        "generalised-α, 1 ms",
                        Look::Line,
                        tension(&implicit, [0.0, 4.0], KN),
                    ),
                    series(
                        "m g (h + δ) = EA δ²/2L",
                        Look::Reference,
                        level(caught_pull(1.0), 4.0),
                    ),
                ],
            ),
            panel(
                "1 t let go at 1 rad",
                TENSION_KN,
                vec![
                    series("leapfrog", Look::Line, tension(&swing, [0.0, 20.0], KN)),
                    series("elastic pendulum", Look::Reference, pendulum),
                ],
            ),
        ],
        runs: named([
            ("dropped", &explicit),
            ("dropped, 1 ms", &implicit),
            ("swing", &swing),
        ]),
    }
}

fn massless() -> Page {
    let run = |mass, integrator| Run::of(&by(nearly_massless(mass, true), integrator, 0.01), 12.0, 0.05);
    let span = [0.0, 12.0];
    let truth = run(1e-5, Integrator::GeneralisedAlpha);
    let explicit = run(1e-5, Integrator::Leapfrog);
    let auto = run(1e-5, Integrator::Auto);
    let heavier = run(1.0, Integrator::Auto);
    Page {
        stem: "hard_07_massless",
        panels: vec![panel(
            "Taut line of 1e-5 kg/m in water, driven along and across itself",
            TENSION_KN,
            vec![
                series("leapfrog", Look::Line, tension(&explicit, span, KN)),
                series("auto", Look::Line, tension(&auto, span, KN)),
                series("1 kg/m", Look::Line, tension(&heavier, span, KN)),
                series("generalised-α, 10 ms", Look::Reference, tension(&truth, span, KN)),
            ],
        )],
        runs: named([
            ("leapfrog", &explicit),
            ("auto", &auto),
            ("generalised-α", &truth),
            ("1 kg/m, auto", &heavier),
        ]),
    }
}

fn fall() -> Page {
    let theory = |value: &dyn Fn(f64) -> f64| -> Vec<[f64; 2]> {
        let parts = (1..=120).map(|k| 0.93 * f64::from(k) / 120.0);
        parts.map(|part| [fall_time(part), value(part)]).collect()
    };
    let duration = fall_time(0.9);
    let scene = |elements: usize| {
        by(
            folded_chain(elements, 2),
            Integrator::GeneralisedAlpha,
            0.01 / elements as f64,
        )
    };
    let path = |elements: usize| -> Vec<[f64; 2]> {
        let times: Vec<f64> = (1..=40).map(|k| duration * f64::from(k) / 40.0).collect();
        let see = |now: &Simulation| -now.state().lines[0].position[0].z / CHAIN;
        let (_, fallen) = Run::watched(&scene(elements), &times, see);
        times.into_iter().zip(fallen).map(|(t, x)| [t, x]).collect()
    };
    let fine = Run::of(&scene(160), duration, duration / 200.0);
    let explicit = Run::of(
        &by(folded_chain(160, 2), Integrator::Leapfrog, 1.0),
        duration,
        duration / 200.0,
    );
    let weight = CHAIN * G;
    let free = (0..=40).map(|k| duration * f64::from(k) / 40.0);
    let free = free.map(|t| [t, 0.5 * G * t * t / CHAIN]).collect();
    Page {
        stem: "hard_08_falling_chain",
        panels: vec![
            panel(
                "Folded chain of 10 m: fall of its free end over its length",
                ["time [s]", "fallen [-]"],
                vec![
                    series("40 elements", Look::Discs, path(40)),
                    series("160 elements", Look::Discs, path(160)),
                    series(
                        "energy kept, Calkin & March",
                        Look::Reference,
                        theory(&|part| part),
                    ),
                    series("free fall", Look::Line, free),
                ],
            ),
            panel(
                "Pull on the hook over the chain's weight",
                ["time [s]", "pull [-]"],
                vec![
                    series("160 elements", Look::Line, tension(&fine, [0.0, 2.0], weight)),
                    series("energy kept", Look::Reference, theory(&fall_pull)),
                ],
            ),
        ],
        runs: named([("160, generalised-α", &fine), ("160, leapfrog", &explicit)]),
    }
}

fn whip() -> Page {
    let scene = by(folded_chain(80, 2), Integrator::Leapfrog, 1.0);
    let run = |duration: f64| Run::of(&scene, duration, duration / 100.0);
    let end = fall_time(0.99);
    let shapes = [0.85, 0.95, 1.0, 1.03, 1.06, 1.1, 1.15, 1.2].map(|part| {
        let done = run(part * end);
        let nodes = done.end.state().lines[0].position.iter();
        let shape: Vec<[f64; 2]> = nodes.map(|r| [r.z, r.x]).collect();
        series(&format!("{:.2} s", part * end), Look::Line, shape)
    });
    let energies = [
        Integrator::Leapfrog,
        Integrator::AxialImplicit,
        Integrator::GeneralisedAlpha,
    ]
    .map(|integrator| Run::of(&by(folded_chain(80, 2), integrator, 1.25e-4), 5.0, 0.01));
    let held = |run: &Run| -> Vec<[f64; 2]> {
        let samples = run.time.iter().zip(&run.gained);
        samples.map(|(t, gained)| [*t, *gained]).collect()
    };
    let mut balance = vec![];
    for (name, run) in ["leapfrog", "axial-implicit", "generalised-α"]
        .iter()
        .zip(&energies)
    {
        balance.push(series(name, Look::Line, held(run)));
    }
    let mut crack = panel(
        "The whip at the end of the fall, shapes",
        ["z [m]", "x [m]"],
        shapes.into(),
    );
    crack.to_scale = true;
    let [leapfrog, axial, implicit] = &energies;
    Page {
        stem: "hard_09_whip",
        panels: vec![
            crack,
            panel(
                "Energy of the chain less that at the start",
                ["time [s]", "energy [J]"],
                balance,
            ),
        ],
        runs: named([
            ("leapfrog", leapfrog),
            ("axial-implicit", axial),
            ("generalised-α", implicit),
        ]),
    }
}

fn dragged() -> Page {
    let run = |friction, elements| {
        let scene = with_elements(dragged_through_touchdown(friction), elements);
        Run::of(&by(scene, Integrator::Leapfrog, 0.01), 20.0, 0.05)
    };
    let [smooth, fine, rough] =
        [(0.0, 40), (0.0, 160), (0.5, 40)].map(|(friction, elements)| run(friction, elements));
    let span = [0.0, 20.0];
    Page {
        stem: "hard_10_touchdown",
        panels: vec![panel(
            "OC4 chain, its fairlead driven 40 m towards the anchor and back at 10 m/s",
            TENSION_MN,
            vec![
                series("no friction", Look::Line, tension(&smooth, span, MN)),
                series("friction 0.5", Look::Line, tension(&rough, span, MN)),
                series(
                    "no friction, 160 elements",
                    Look::Reference,
                    tension(&fine, span, MN),
                ),
            ],
        )],
        runs: named([
            ("no friction", &smooth),
            ("friction 0.5", &rough),
            ("160 elements", &fine),
        ]),
    }
}

fn jump() -> Page {
    let run = |integrator, reconstruction| {
        let mut scene: Scene = by(shipped("taut_polyester"), integrator, 0.01);
        scene.solver.input_reconstruction = reconstruction;
        Run::hosted(&scene, std::iter::repeat_n(JUMP[1], 400), jumped)
    };
    let smooth = run(Integrator::Leapfrog, Reconstruction::Smooth);
    let axial = run(Integrator::AxialImplicit, Reconstruction::Smooth);
    let leap = run(Integrator::Leapfrog, Reconstruction::Jump);
    let span = [0.5, 6.0];
    Page {
        stem: "hard_11_jump",
        panels: vec![panel(
            "Taut polyester, its fairlead 1 m further from one communication point to the next",
            TENSION_MN,
            vec![
                series("smooth path, leapfrog", Look::Line, tension(&smooth, span, MN)),
                series(
                    "smooth path, axial-implicit",
                    Look::Line,
                    tension(&axial, span, MN),
                ),
                series("jump, leapfrog", Look::Line, tension(&leap, span, MN)),
            ],
        )],
        runs: named([
            ("smooth", &smooth),
            ("smooth, axial-implicit", &axial),
            ("jump", &leap),
        ]),
    }
}

fn resonance() -> Page {
    let first = rod_frequency();
    let at = |integrator, ratio: f64| {
        let mut scene = by(resonant_rod(40, ratio * first), integrator, 0.001);
        if integrator == Integrator::AxialImplicit {
            scene.solver.time_step_max = 0.0025;
        }
        Run::of(&scene, 40.0, 0.005)
    };
    let ratios = [0.8, 0.9, 0.95, 0.98, 1.0, 1.02, 1.05, 1.1, 1.2];
    let computed = |integrator| {
        ratios
            .map(|ratio| [ratio, at(integrator, ratio).last_amplitude() / KN])
            .to_vec()
    };
    let exact = (0..=200).map(|k| 0.8 + 0.4 * f64::from(k) / 200.0);
    let exact = exact
        .map(|ratio| [ratio, rod_amplitude(ratio * first) / KN])
        .collect();
    let peak = at(Integrator::Leapfrog, 1.0);
    let axial = at(Integrator::AxialImplicit, 1.0);
    Page {
        stem: "hard_12_resonance",
        panels: vec![panel(
            "Taut rod driven along itself by 1 mm near its first axial frequency",
            [
                "frequency over the first axial one [-]",
                "amplitude of tension [kN]",
            ],
            vec![
                series("leapfrog", Look::Discs, computed(Integrator::Leapfrog)),
                series(
                    "axial-implicit, 2.5 ms",
                    Look::Discs,
                    computed(Integrator::AxialImplicit),
                ),
                series("damped rod", Look::Reference, exact),
            ],
        )],
        runs: named([("leapfrog", &peak), ("axial-implicit", &axial)]),
    }
}

fn hours() -> Page {
    let run = |integrator| {
        Run::of(
            &by(irregular(shipped("oc4_chain"), 6.0, 12.0), integrator, 0.05),
            36000.0,
            0.5,
        )
    };
    let (auto, axial) = (run(Integrator::Auto), run(Integrator::AxialImplicit));
    Page {
        stem: "hard_13_hours",
        panels: vec![panel(
            "OC4 chain, 10 h of irregular motion: error of the energy ledger over the energy that flowed",
            ["time [h]", "error [%]"],
            vec![
                series("auto: leapfrog", Look::Line, ledger(&auto, 3600.0)),
                series("axial-implicit", Look::Line, ledger(&axial, 3600.0)),
            ],
        )],
        runs: named([("auto", &auto), ("axial-implicit", &axial)]),
    }
}

fn steps() -> Page {
    let scene = slowly_moved();
    let hosted = |steps: Vec<f64>| Run::hosted(&scene, steps.into_iter(), say_slow);
    let exact = Run::of(&scene, 200.0, 0.5);
    let (long, irregular) = (hosted(vec![10.0; 20]), hosted(irregular_steps(200.0)));
    let span = [0.0, 200.0];
    Page {
        stem: "hard_14_communication_steps",
        panels: vec![panel(
            "OC3 line, moved slowly by a host",
            TENSION_KN,
            vec![
                series("steps of 10 s", Look::Discs, tension(&long, span, KN)),
                series(
                    "irregular, 1 ms to 10 s",
                    Look::Line,
                    tension(&irregular, span, KN),
                ),
                series("exact motion", Look::Reference, tension(&exact, span, KN)),
            ],
        )],
        runs: named([("exact", &exact), ("10 s", &long), ("irregular", &irregular)]),
    }
}
