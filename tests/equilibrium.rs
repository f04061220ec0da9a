//! Static equilibrium of assembled lines.
use moorline::model::{Model, State};
use moorline::scene::Scene;
use moorline::statics::assembly::Workspace;
use moorline::statics::equilibrium::solve;
use nalgebra::Vector3;

fn model(text: &str) -> Model {
    Model::new(&Scene::from_toml(text).unwrap()).unwrap()
}

fn at_reference(model: &Model) -> Vec<Vector3<f64>> {
    model.points.iter().map(|point| point.reference).collect()
}

#[test]
fn scratch() {
    for (strain, loads) in [
        (
            "\"green\"",
            [
                0.625, 5.0, 40.0, 135., 320., 625., 1080., 1715., 5000., 16875., 40000.0,
            ],
        ),
        (
            "\"engineering\"",
            [
                0.625, 5.0, 40.0, 135., 320., 625., 1080., 1715., 5000., 16875., 40000.0,
            ],
        ),
        (
            "{logarithmic=0.5}",
            [
                0.625, 5.0, 40.0, 135., 320., 625., 1080., 3400., 3454.0, 3454.579, 3454.58,
            ],
        ),
        (
            "{logarithmic=0.3}",
            [
                0.625, 5.0, 40.0, 135., 320., 625., 1080., 1715., 5000., 6000., 40000.0,
            ],
        ),
        (
            "{logarithmic=0.0}",
            [
                0.625, 5.0, 40.0, 135., 320., 625., 1080., 1715., 5000., 16875., 40000.0,
            ],
        ),
    ] {
        for load in loads {
            let m = model(&format!(
                r#"
[line_types.cable]
mass = 0.0
axial_stiffness = 5000.0
strain = {strain}
[[points]]
name = "a"
position = [0,0,0]
kind = "fixed"
[[points]]
name = "m"
position = [0.5,0,0]
kind = "free"
force = {{ z = {} }}
[[points]]
name = "b"
position = [1,0,0]
kind = "fixed"
[[lines]]
name = "l1"
from = "a"
to = "m"
sections = [{{ type = "cable", length = 0.5, elements = 1 }}]
[[lines]]
name = "l2"
from = "m"
to = "b"
sections = [{{ type = "cable", length = 0.5, elements = 1 }}]
"#,
                -load
            ));
            let mut work = Workspace::new(&m);
            match solve(&m, &at_reference(&m), 0.0, &mut work) {
                Ok(s) => {
                    let u = -s.points[1].position.z;
                    println!(
                        "{strain} {load} u={u} W={} {:?}",
                        8.0 * 5000.0 * u * u * u,
                        work.take_counters()
                    );
                }
                Err(e) => println!("{strain} {load} {e}"),
            }
        }
    }
    for n in [10, 22, 50, 100, 200] {
        let m = model(&format!(
            r#"
[line_types.cable]
weight = 0.49
axial_stiffness = 2505.0
[[points]]
name = "a"
position = [0,0,0]
kind = "fixed"
[[points]]
name = "b"
position = [14.1421,0,0]
kind = "fixed"
[[lines]]
name = "l1"
from = "a"
to = "b"
sections = [{{ type = "cable", length = 14.1421, elements = {n} }}]
"#
        ));
        let mut work = Workspace::new(&m);
        let t0 = std::time::Instant::now();
        match solve(&m, &at_reference(&m), 0.0, &mut work) {
            Ok(s) => {
                println!(
                    "{n} sag={} {:?} {:?}",
                    -s.lines[0].position[n / 2].z,
                    work.take_counters(),
                    t0.elapsed()
                );
            }
            Err(e) => println!("{e}"),
        }
    }
}

fn noise(seed: &mut u64) -> f64 {
    *seed = seed
        .wrapping_mul(6364136223846793005)
        .wrapping_add(1442695040888963407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

#[test]
fn random_lines() {
    let mut seed = 1;
    let mut worst = 0;
    let mut total = 0;
    let mut fails = 0;
    let t0 = std::time::Instant::now();
    let mut hist = [0usize; 12];
    for case in 0..2000 {
        let mut u = || noise(&mut seed);
        let length = 10f64.powf(1.0 + 2.0 * u());
        let chord = length
            * match case % 4 {
                0 => 0.2 * u(),
                1 => u(),
                2 => 0.95 + 0.1 * u(),
                _ => 1.0 + u(),
            };
        let angle = std::f64::consts::FRAC_PI_2 * (2.0 * u() - 1.0);
        let (x, z) = (chord * angle.cos(), chord * angle.sin());
        let ea = 10f64.powf(4.0 + 9.0 * u());
        let w = 10f64.powf(-1.0 + 5.0 * u())
            * if u() < 0.15 { -1.0 } else { 1.0 }
            * if u() < 0.05 { 0.0 } else { 1.0 };
        let bed = case % 3 == 0;
        let n = (2.0 + 60.0 * u()) as usize;
        let depth = -(z.min(0.0)) + if u() < 0.5 { 0.0 } else { 0.2 * length * u() };
        let contact = if u() < 0.5 { "regularised" } else { "as_given" };
        let text = format!(
            r#"
{}
[line_types.cable]
weight = {w:e}
mass = 1.0
diameter = 0.1
axial_stiffness = {ea:e}
[[points]]
name = "a"
position = [0,0,0]
kind = "fixed"
[[points]]
name = "b"
position = [{x:e},0,{z:e}]
kind = "fixed"
[[lines]]
name = "l1"
from = "a"
to = "b"
sections = [{{ type = "cable", length = {length:e}, elements = {n} }}]
"#,
            if bed {
                format!("[seabed]\ndepth = {depth:e}\ncontact=\"{contact}\"")
            } else {
                String::new()
            }
        );
        let m = model(&text);
        let mut work = Workspace::new(&m);
        let r = solve(&m, &at_reference(&m), 0.0, &mut work);
        let c = work.take_counters().solves;
        total += c;
        worst = worst.max(c);
        hist[(c / 10).min(11)] += 1;
        if let Err(e) = r {
            fails += 1;
            if fails < 10 {
                println!(
                    "{case} L {length:.3} chord {:.3} ang {angle:.3} ea {ea:.2e} w {w:.3e} n {n} bed {bed} {contact} depth {depth}: {e}",
                    chord / length
                );
            }
        } else if c > 60 && c % 7 == 0 {
            println!(
                "slow {c}: {case} L {length:.3} chord {:.3} ang {angle:.3} ea {ea:.2e} w {w:.3e} n {n} bed {bed} {contact} depth {depth}",
                chord / length
            );
        }
    }
    println!(
        "fails {fails} worst {worst} mean {} time {:?} hist {hist:?}",
        total as f64 / 2000.0,
        t0.elapsed()
    );
}

#[test]
fn random_networks() {
    let mut seed = 5;
    let (mut worst, mut total, mut fails) = (0, 0, 0);
    let t0 = std::time::Instant::now();
    let mut hist = [0usize; 12];
    for case in 0..1000 {
        let mut u = || noise(&mut seed);
        let scale = 10f64.powf(1.0 + 1.5 * u());
        let ea = 10f64.powf(4.0 + 8.0 * u());
        let w = 10f64.powf(0.0 + 3.0 * u());
        let count = 2 + case % 3;
        let bed = u() < 0.5;
        let mut text = format!(
            "{}[line_types.cable]\nweight = {w:e}\nmass = 1.0\ndiameter = 0.1\naxial_stiffness = {ea:e}\n",
            if bed {
                format!("[seabed]\ndepth = {:e}\n", 1.2 * scale)
            } else {
                String::new()
            }
        );
        let mut points = vec![];
        for i in 0..count {
            let p = Vector3::new(
                scale * (2.0 * u() - 1.0),
                scale * (2.0 * u() - 1.0),
                scale * (2.0 * u() - 1.0),
            );
            points.push(p);
            text += &format!(
                "[[points]]\nname = \"p{i}\"\nposition = [{:e},{:e},{:e}]\nkind = \"fixed\"\n",
                p.x, p.y, p.z
            );
        }
        let mean: Vector3<f64> = points.iter().sum::<Vector3<f64>>() / count as f64;
        let guess = mean + 0.3 * scale * Vector3::new(u() - 0.5, u() - 0.5, u() - 0.5);
        let slide = case % 7 == 0;
        text += &format!(
            "[[points]]\nname = \"f\"\nposition = [{:e},{:e},{:e}]\nkind = \"free\"\nmass = {:e}\nforce = {{ x = {:e} }}\n{}",
            guess.x,
            guess.y,
            guess.z,
            if u() < 0.5 {
                0.0
            } else {
                w * scale * u() / 10.0
            },
            if u() < 0.5 { 0.0 } else { w * scale * u() },
            if slide { "free = [\"x\", \"y\"]\n" } else { "" }
        );
        for i in 0..count {
            let chord = (guess - points[i]).norm();
            let length = chord * (0.8 + 0.8 * u());
            let n = (1.0 + 30.0 * u()) as usize;
            text += &format!(
                "[[lines]]\nname = \"l{i}\"\nfrom = \"{}\"\nto = \"{}\"\nsections = [{{ type = \"cable\", length = {length:e}, elements = {n} }}]\n",
                if i % 2 == 0 {
                    format!("p{i}")
                } else {
                    "f".into()
                },
                if i % 2 == 0 {
                    "f".into()
                } else {
                    format!("p{i}")
                }
            );
        }
        let m = model(&text);
        let mut work = Workspace::new(&m);
        let r = solve(&m, &at_reference(&m), 0.0, &mut work);
        let c = work.take_counters().solves;
        total += c;
        worst = worst.max(c);
        hist[(c / 10).min(11)] += 1;
        if let Err(e) = r {
            fails += 1;
            if fails < 10 {
                println!(
                    "{case} scale {scale:.3} ea {ea:.2e} w {w:.3e} bed {bed} slide {slide} {e}"
                );
                if fails < 3 {
                    println!("{text}");
                }
            }
        }
    }
    println!(
        "fails {fails} worst {worst} mean {} time {:?} hist {hist:?}",
        total as f64 / 1000.0,
        t0.elapsed()
    );
}
