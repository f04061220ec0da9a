//! Closed forms of cable dynamics.

use std::f64::consts::PI;

use crate::common::*;
use approx::assert_relative_eq;
use moorline::model::End;
use moorline::scene::{InitialShape, Integrator, Scene};
use nalgebra::Vector3;

/// A string of `n` elements stretched from its unstretched length to 100 m by 50 kN, without gravity.
///
///   EA = 10 MN, m = 5 kg per unstretched metre
fn taut_string(n: usize) -> Scene {
    draft("gravity = 0.0\nline_types.string = { mass = 5.0, axial_stiffness = 1e7, axial_damping = 0.0 }")
        .fixed("left", [0.0; 3])
        .fixed("right", [STRING_SPAN, 0.0, 0.0])
        .line("string", ["left", "right"], "string", STRING_LENGTH, n)
        .scene()
}

const STRING_EA: f64 = 1e7; // [N]
const STRING_MASS: f64 = 5.0; // [kg/m]
const STRING_SPAN: f64 = 100.0; // [m]
const STRING_TENSION: f64 = 5e4; // [N]
/// L/(1 + T/EA) [m].
const STRING_LENGTH: f64 = STRING_SPAN / (1.0 + STRING_TENSION / STRING_EA);

/// Circular frequency of mode k of the lumped taut string: 2 √(T/(l m h)) sin(kπ/2n), with stretched segment l and unstretched segment h [rad/s].
fn lumped_transverse(n: usize, k: usize) -> f64 {
    let (l, h) = (STRING_SPAN / n as f64, STRING_LENGTH / n as f64);
    2.0 * (STRING_TENSION / (l * STRING_MASS * h)).sqrt() * (k as f64 * PI / (2 * n) as f64).sin()
}

/// Circular frequency of axial mode k: 2 √(EA/m)/h sin(kπ/2n) [rad/s].
fn lumped_axial(n: usize, k: usize) -> f64 {
    let h = STRING_LENGTH / n as f64;
    2.0 * (STRING_EA / STRING_MASS).sqrt() / h * (k as f64 * PI / (2 * n) as f64).sin()
}

#[test]
fn a_taut_string_has_the_frequencies_of_its_lumped_masses() {
    for n in [10, 20, 50] {
        let modes = modes(&start(&taut_string(n)));
        let of_mode = |k| {
            [
                lumped_transverse(n, k),
                lumped_transverse(n, k),
                lumped_axial(n, k),
            ]
        };
        let mut exact: Vec<f64> = (1..n).flat_map(of_mode).collect();
        exact.sort_by(f64::total_cmp);
        assert_eq!(modes.frequencies.len(), exact.len());
        for (found, exact) in modes.frequencies.iter().zip(&exact) {
            assert_relative_eq!(found, exact, max_relative = 1e-9);
        }
    }
}

/// Shape sin(kπs/L) with amplitude vector `a` [m] on the straight taut string.
fn string_mode(n: usize, k: usize, a: Vector3<f64>) -> Vec<Vector3<f64>> {
    let node = |i: usize| {
        let u = i as f64 / n as f64;
        STRING_SPAN * u * Vector3::x() + (k as f64 * PI * u).sin() * a
    };
    (0..=n).map(node).collect()
}

/// Circular frequency [rad/s] of mode k after release with amplitude `a` [m], in steps of `step` [s].
fn released_frequency(integrator: Integrator, n: usize, k: usize, a: Vector3<f64>, step: f64) -> f64 {
    let scene = with_integrator(taut_string(n), integrator, step);
    let mut scene = released_from(scene, &string_mode(n, k, a));
    if integrator != Integrator::Leapfrog {
        scene.solver.spectral_radius = Some(1.0);
    }
    let mut simulation = start(&scene);
    let at = n / (2 * k); // an antinode
    let rest = string_mode(n, k, Vector3::zeros())[at];
    let sample = |_| {
        simulation.advance(step).unwrap();
        assert_eq!(simulation.substeps(), 1);
        (nodes(&simulation)[at] - rest).dot(&a)
    };
    sampled_frequency(&(0..400).map(sample).collect::<Vec<f64>>(), step)
}

#[test]
fn the_leapfrog_oscillates_at_its_own_frequency() {
    // v' = −ω² q by the leapfrog: sin(ω̃Δt/2) = ωΔt/2
    let leapfrog = |omega: f64, step: f64| 2.0 / step * (0.5 * omega * step).asin();
    for k in [1, 2, 5] {
        for (integrator, a, omega) in [
            (
                Integrator::Leapfrog,
                1e-4 * Vector3::z(),
                lumped_transverse(20, k),
            ),
            (
                Integrator::AxialImplicit,
                1e-4 * Vector3::y(),
                lumped_transverse(20, k),
            ),
            (Integrator::Leapfrog, 1e-3 * Vector3::x(), lumped_axial(20, k)),
        ] {
            let found = released_frequency(integrator, 20, k, a, 1e-3);
            assert_relative_eq!(found, leapfrog(omega, 1e-3), max_relative = 1e-7);
        }
    }
}

#[test]
fn the_axial_implicit_leapfrog_keeps_axial_waves_by_the_share_of_tension_that_it_averages() {
    // with ρ = 1 a share σ of the tension is averaged over three times with ¼, ½, ¼: 4 sin²(ω̃Δt/2) = (ωΔt)²(1 − σ sin²(ω̃Δt/2)), for any step
    let shortest = lumped_axial(20, 19);
    for (k, step) in [(1, 5e-4), (1, 2e-3), (2, 5e-3), (5, 5e-3)] {
        let found = released_frequency(Integrator::AxialImplicit, 20, k, 1e-3 * Vector3::x(), step);
        let share = (1.0 - 3.2 / (shortest * step).powi(2)).max(1.0 / 3.0);
        let square = (lumped_axial(20, k) * step).powi(2);
        let exact = 2.0 / step * (square / (4.0 + share * square)).sqrt().asin();
        assert_relative_eq!(found, exact, max_relative = 1e-6);
    }
}

#[test]
fn generalised_alpha_without_dissipation_keeps_all_waves_by_the_trapezoidal_rule() {
    for (a, k, omega) in [
        (1e-4 * Vector3::z(), 2, lumped_transverse(20, 2)),
        (1e-3 * Vector3::x(), 1, lumped_axial(20, 1)),
        (1e-3 * Vector3::x(), 5, lumped_axial(20, 5)),
    ] {
        let step = 5e-3;
        let found = released_frequency(Integrator::GeneralisedAlpha, 20, k, a, step);
        let exact = 2.0 / step * (0.5 * omega * step).atan();
        assert_relative_eq!(found, exact, max_relative = 1e-6);
    }
}

#[test]
fn frequencies_converge_at_second_order_in_the_time_step_and_axial_implicit_ones_at_fourth() {
    let steps = [2e-3, 1e-3, 5e-4, 2.5e-4];
    for (integrator, axial_order) in [
        (Integrator::Leapfrog, 2.0),
        (Integrator::AxialImplicit, 4.0),
        (Integrator::GeneralisedAlpha, 2.0),
    ] {
        let transverse = (1e-4 * Vector3::z(), 5, lumped_transverse(10, 5), 2.0);
        let axial = (1e-3 * Vector3::x(), 3, lumped_axial(10, 3), axial_order);
        for (a, k, exact, order) in [transverse, axial] {
            let errors = steps.map(|step| released_frequency(integrator, 10, k, a, step) - exact);
            assert_order(order, &steps, &errors);
        }
    }
}

/// A bar fixed at one end under a sudden force, in discrete modes and leapfrog steps.
///
///   ┃━━━━━━━━━━━━━●→ P      E A = 21 MN, 0.785 kg/m, 10 m, P = 1 kN on 2.5 kN that keep it taut
fn loaded_bar(n: usize) -> Scene {
    let nodes: Vec<Vector3<f64>> = (0..=n)
        .map(|i| 10.0 * (i as f64 / n as f64) * (1.0 + BAR_TENSION / BAR_EA) * Vector3::x())
        .collect();
    let tip = nodes[n].x;
    let total = BAR_TENSION + BAR_LOAD;
    let bar = format!("{{ mass = {BAR_MASS}, axial_stiffness = {BAR_EA}, axial_damping = 0.0 }}");
    let bar = draft(format!("gravity = 0.0\nline_types.bar = {bar}"))
        .fixed("wall", [0.0; 3])
        .free("tip", [tip, 0.0, 0.0])
        .with(&format!("free = ['x'], force = {{ x = {total} }}"))
        .line("bar", ["wall", "tip"], "bar", 10.0, n);
    released_from(bar.scene(), &nodes)
}

const BAR_EA: f64 = 2.1e7; // [N]
const BAR_MASS: f64 = 0.785; // [kg/m]
const BAR_LENGTH: f64 = 10.0; // [m]
const BAR_LOAD: f64 = 1000.0; // [N]
const BAR_TENSION: f64 = 2500.0; // [N], keeps the bar taut

/// Circular frequency of mode k = 1 … n of the lumped bar: 2c/h sin((2k−1)π/4n) [rad/s].
fn lumped_bar(n: usize, k: usize) -> f64 {
    let h = BAR_LENGTH / n as f64;
    2.0 * (BAR_EA / BAR_MASS).sqrt() / h * ((2 * k - 1) as f64 * PI / (4 * n) as f64).sin()
}

#[test]
fn a_bar_held_at_one_end_has_the_frequencies_of_its_lumped_masses() {
    for n in [10, 20, 50] {
        let modes = modes(&start(&loaded_bar(n)));
        let is_axial = |mode: &usize| modes.shape(*mode, 0).iter().map(|u| u.x * u.x).sum::<f64>() > 1e-6;
        let axial = (0..modes.frequencies.len()).filter(is_axial);
        let axial: Vec<f64> = axial.map(|mode| modes.frequencies[mode]).collect();
        assert_eq!(axial.len(), n);
        for (k, found) in axial.iter().enumerate() {
            assert_relative_eq!(*found, lumped_bar(n, k + 1), max_relative = 1e-9);
        }
    }
}

#[test]
fn a_mass_on_a_viscoelastic_rope_has_the_frequency_of_its_dynamic_stiffness() {
    let (mass, length, fast) = (2000.0, 20.0, 1.6e6);
    let rope = format!(
        "line_types.nylon = {{ mass = 0.01, static_stiffness = 4e5, dynamic_stiffness = {fast:e}, static_damping = 5e6 }}"
    );
    let hung = draft(rope)
        .fixed("top", [0.0; 3])
        .free("clump", [0.0, 0.0, -20.5])
        .with(&format!("mass = {mass:e}"))
        .line("rope", ["top", "clump"], "nylon", length, 4)
        .start();
    let modes = modes(&hung);
    let axial = (fast / (mass * length)).sqrt();
    let nearest = modes.frequencies.iter().map(|found| (found / axial - 1.0).abs());
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-3, "{axial} {:?}", &modes.frequencies[..3]);
}

/// A line as long as the parabola on which it starts is not strained there.
#[test]
fn a_parabola_of_the_length_of_its_line_is_without_strain() {
    for elements in [20, 80] {
        let simulation = draft("line_types.rope = { mass = 100.0, axial_stiffness = 5e8 }")
            .fixed("left", [-50.0, 0.0, 0.0])
            .fixed("right", [50.0, 0.0, 0.0])
            .line("rope", ["left", "right"], "rope", 100.6627227216039, elements)
            .with("initial = { parabola = 5.0 }")
            .start();
        let [least, most] = strains(nodes(&simulation), 100.6627227216039);
        let chord = (0.5 * 0.004 * 100.0 / elements as f64).powi(2) / 6.0; // chords are shorter than arcs
        assert!(
            most < 1e-6 && least > -1.2 * chord - 1e-6,
            "{elements}: {least:e} {most:e}"
        );
    }
}

/// Least and greatest strain of segments of equal unstretched length, of a line of a length [m].
fn strains(nodes: &[Vector3<f64>], length: f64) -> [f64; 2] {
    let unstretched = length / (nodes.len() - 1) as f64;
    let strain = nodes
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).norm() / unstretched - 1.0);
    strain.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], strain| {
        [least.min(strain), most.max(strain)]
    })
}

/// A load that lasts for a part of a step acts with its whole impulse, wherever in the step it begins.
#[test]
fn a_short_pulse_gives_its_impulse_to_a_point() {
    let (mass, load) = (100.0, 1e4);
    for integrator in [
        Integrator::Leapfrog,
        Integrator::AxialImplicit,
        Integrator::GeneralisedAlpha,
        Integrator::Bossak,
    ] {
        for [from, to] in [[1.01, 1.04], [1.04, 1.06], [1.02, 1.28]] {
            let scene = draft("gravity = 0.0\nline_types.thread = { mass = 1e-3, weight = 0.0, axial_stiffness = 1e4 }")
                .fixed("end", [0.0; 3])
                .free("block", [5.0, 0.0, 0.0])
                .with(&format!(
                    "mass = {mass:e}, force = {{ x = {{ table = [[0.0, 0.0], [{from}, 0.0], [{from}, {load}], [{to}, {load}], [{to}, 0.0]] }} }}"
                ))
                .line("thread", ["end", "block"], "thread", 100.0, 2)
                .with("initial = 'straight'")
                .scene();
            let mut simulation = start(&with_integrator(scene, integrator, 0.05));
            run(&mut simulation, 0.05, 40);
            let before = place(&simulation, "block").x;
            run(&mut simulation, 0.05, 20);
            let speed = place(&simulation, "block").x - before;
            let expected = load * (to - from) / mass;
            assert_relative_eq!(speed, expected, max_relative = 1e-3);
        }
    }
}

/// Displacement of the bar's tip from its initial position, every `step` [s].
fn tip_history(n: usize, step: f64, count: usize) -> Vec<f64> {
    let scene = with_integrator(loaded_bar(n), Integrator::Leapfrog, step);
    let mut simulation = start(&scene);
    let first = place(&simulation, "tip").x;
    let mut tip = vec![0.0];
    for _ in 0..count {
        simulation.advance(step).unwrap();
        assert_eq!(simulation.substeps(), 1);
        tip.push(place(&simulation, "tip").x - first);
    }
    tip
}

#[test]
fn a_bar_under_a_sudden_load_moves_as_the_sum_of_its_modes() {
    // u_tip = Σ φ_k² P/ω_k² (1 − cos ω̃_k t), φ_k² = 2/(mL) at the tip, ω̃ the frequency of the leapfrog
    let (n, step) = (20, 3e-5);
    let tip = tip_history(n, step, 800);
    for (j, found) in tip.iter().enumerate() {
        let mode = |k: usize| {
            let omega = lumped_bar(n, k);
            let stepped = 2.0 * (0.5 * omega * step).asin();
            2.0 / (BAR_MASS * BAR_LENGTH) * BAR_LOAD / (omega * omega) * (1.0 - (stepped * j as f64).cos())
        };
        let exact: f64 = (1..=n).map(mode).sum();
        assert_relative_eq!(*found, exact, epsilon = 1e-10);
    }
}

#[test]
fn a_sudden_load_stretches_a_bar_twice_as_far_as_a_slow_one() {
    // a triangular wave between 0 and 2PL/EA with period 4L/c; at its corners the mesh causes a ripple
    let u_static = BAR_LOAD * BAR_LENGTH / BAR_EA;
    let period = 4.0 * BAR_LENGTH * (BAR_MASS / BAR_EA).sqrt();
    let (n, count) = (200, 2400);
    let step = period / count as f64;
    let tip = tip_history(n, step, 2 * count);
    assert_relative_eq!(greatest(tip.iter().copied()), 2.0 * u_static, max_relative = 5e-3);
    for (j, found) in tip.iter().enumerate() {
        let phase = (j % count) as f64 / count as f64;
        let triangle = 2.0 * u_static * (1.0 - (1.0 - 2.0 * phase).abs());
        assert_relative_eq!(*found, triangle, epsilon = 0.02 * u_static);
    }
}

/// J0 from its power series [-], for arguments up to about 15.
fn bessel_j0(x: f64) -> f64 {
    let mut term = 1.0;
    let mut sum = 1.0;
    for k in 1..60 {
        term *= -0.25 * x * x / (k * k) as f64;
        sum += term;
    }
    sum
}

/// The k-th zero of J0, by bisection about (k − ¼)π [-].
fn bessel_zero(k: usize) -> f64 {
    let guess = (k as f64 - 0.25) * PI;
    let sign = bessel_j0(guess + 0.3).signum();
    bisect([guess - 0.3, guess + 0.3], |x| sign * bessel_j0(x))
}

/// A 10 m chain that hangs from a wall, with a mass [kg] at its lower end.
fn hanging_chain(n: usize, tip_mass: f64) -> Scene {
    draft("line_types.chain = { mass = 2.0, axial_stiffness = 1e9, axial_damping = 0.0 }")
        .fixed("top", [0.0; 3])
        .free("tip", [0.0, 0.0, -10.0])
        .with(&format!("mass = {tip_mass}"))
        .line("chain", ["top", "tip"], "chain", 10.0, n)
        .scene()
}

const RESOLUTIONS: [usize; 4] = [10, 20, 40, 80];

fn sizes() -> [f64; 4] {
    RESOLUTIONS.map(|n| 1.0 / n as f64)
}

/// Asserts that frequencies of in-plane modes k of a hanging chain with a mass [kg] at its end converge to exact ones [rad/s] at second order.
fn assert_hanging(elements: usize, tip_mass: f64, exact: &[(usize, f64)]) {
    let found = RESOLUTIONS.map(|n| modes(&start(&hanging_chain(elements * n, tip_mass))).frequencies);
    for (k, exact) in exact {
        let errors: Vec<f64> = found
            .iter()
            .map(|modes| modes[2 * (k - 1)] / exact - 1.0)
            .collect();
        assert_order(2.0, &sizes(), &errors);
    }
}

#[test]
fn a_hanging_chain_has_frequencies_by_the_zeros_of_j0() {
    // ω = ½ j0k √(g/L)
    assert_hanging(
        2,
        0.0,
        &[1, 2, 3].map(|k| (k, 0.5 * bessel_zero(k) * (G / 10.0).sqrt())),
    );
}

#[test]
fn a_hanging_chain_with_a_mass_at_its_end_has_frequencies_by_j0_and_y0() {
    // y = A J0(2ω√((x + μL)/g)) + B Y0(…), fixed at the top, −ω²y = g y' at the mass; L = 10 m, g = 9.80665 m/s²
    for (ratio, exact) in [
        (
            0.1,
            &[
                (1, 1.146150037094254),
                (2, 2.78868946522576),
                (3, 4.668706211786554),
            ][..],
        ),
        (
            1.0,
            &[
                (1, 1.046159665649992),
                (2, 4.042034452091138),
                (3, 7.662335711202125),
            ],
        ),
        (10.0, &[(2, 10.176594029987361), (3, 20.205911672196763)]),
    ] {
        assert_hanging(1, ratio * 2.0 * 10.0, exact);
    }
}

/// A sagging cable between two ends at the same height, and its frequencies [rad/s].
struct SaggedCable {
    /// Span [m], length [m], axial stiffness [N], weight [N/m] and mass [kg/m].
    cable: [f64; 5],
    in_plane: [f64; 4],
    out_of_plane: [f64; 3],
}

/// Linear vibration about the exact elastic catenary, converged to 1e-8 or better by an independent solution of the differential
/// equations.
const SAGGED_CABLES: [SaggedCable; 4] = [
    SaggedCable {
        cable: [14.1421, 14.1421, 2505.0, 0.49, 0.049966094435918484],
        in_plane: [6.97026615852, 8.11614073132, 12.4482509076, 16.35322742],
        out_of_plane: [4.10703828659, 8.20141599393, 12.2986497082],
    },
    SaggedCable {
        cable: [17.694912029102543, 20.0, 5350318.0, 1.96133, 0.2],
        in_plane: [2.91753952337, 4.68535443265, 6.49917286375, 8.16666025411],
        out_of_plane: [1.73214584261, 3.36931070842, 5.03314363316],
    },
    SaggedCable {
        cable: [100.0, 100.1667, 1e9, 50.0, 5.0],
        in_plane: [4.41230397404, 6.30845553313, 8.8407362624, 10.8446143961],
        out_of_plane: [2.21265834368, 4.42361168217, 6.63494531652],
    },
    SaggedCable {
        cable: [100.0, 102.6, 1e7, 50.0, 5.0],
        in_plane: [2.11963571809, 3.11675400644, 4.35691732788, 5.3692492472],
        out_of_plane: [1.10722303023, 2.20121932418, 3.29832421082],
    },
];

impl SaggedCable {
    /// Frequencies [rad/s] of the lowest in-plane and out-of-plane modes of the cable.
    fn frequencies(&self, n: usize) -> [Vec<f64>; 2] {
        let [span, length, stiffness, weight, mass] = self.cable;
        let cable = format!("{{ mass = {mass}, weight = {weight}, axial_stiffness = {stiffness} }}");
        let cable = draft(format!("line_types.cable = {cable}"))
            .fixed("left", [0.0; 3])
            .fixed("right", [span, 0.0, 0.0])
            .line("cable", ["left", "right"], "cable", length, n);
        let modes = modes(&cable.start());
        let sideways = |mode: usize| {
            let shape = modes.shape(mode, 0);
            let all = shape.iter().map(|u| u.norm_squared()).sum::<f64>();
            shape.iter().map(|u| u.y * u.y).sum::<f64>() > 0.5 * all
        };
        let pick = |out: bool| {
            let picked = (0..12).filter(|&mode| sideways(mode) == out);
            picked.map(|mode| modes.frequencies[mode]).collect()
        };
        [pick(false), pick(true)]
    }
}

#[test]
fn a_sagged_cable_has_the_frequencies_of_its_elastic_catenary() {
    for cable in &SAGGED_CABLES {
        let found = RESOLUTIONS.map(|n| cable.frequencies(n));
        let exact = [&cable.in_plane[..], &cable.out_of_plane[..]];
        for (plane, exact) in exact.into_iter().enumerate() {
            for (k, exact) in exact.iter().enumerate() {
                let errors: Vec<f64> = found.iter().map(|modes| modes[plane][k] / exact - 1.0).collect();
                assert_order(2.0, &sizes(), &errors);
            }
        }
    }
}

#[test]
fn a_line_sinks_by_the_hyperbolic_tangent() {
    // m_eff v' = w − ½ρdC v²: v = v_t tanh(t/τ), depth v_t τ ln cosh(t/τ), v_t = √(2w/(ρdC)), τ = m_eff v_t/w
    let (rho, d, m, g, drag) = (1025.0, 0.1, 20.0, 9.80665, 1.2);
    let displaced = rho * PI / 4.0 * d * d; // [kg/m], equal to the added mass
    let weight = (m - displaced) * g;
    let terminal = (2.0 * weight / (rho * d * drag)).sqrt();
    let tau = (m + displaced) * terminal / weight;
    let steps = [5e-3, 2.5e-3, 1.25e-3, 6.25e-4];
    let errors = steps.map(|step| {
        let mut simulation = draft(format!(
            "gravity = {g}
            water = {{ density = {rho} }}
            line_types.rope = {{ mass = {m}, diameter = {d}, axial_stiffness = 1e4, drag_normal = {drag}, drag_tangential = 0.1,
              added_mass_normal = 1.0 }}
            line_types.thread = {{ mass = 1e-12, weight = 0.0, axial_stiffness = 1.0 }} # slack, for no line may float unheld
            solver = {{ time_step_max = {step} }}"
        ))
        .free("left", [0.0, 0.0, -1.0])
        .free("right", [20.0, 0.0, -1.0])
        .fixed("buoy", [-1.0, 0.0, 0.0])
        .line("rope", ["left", "right"], "rope", 20.0, 5)
        .with("initial = 'straight'")
        .line("thread", ["buoy", "left"], "thread", 100.0, 1)
        .with("initial = 'straight'")
        .start();
        simulation.advance(0.8).unwrap();
        let depth = -1.0 - nodes(&simulation)[3].z;
        for node in nodes(&simulation) {
            assert_relative_eq!(node.z, nodes(&simulation)[3].z, epsilon = 1e-12);
        }
        let error = depth - terminal * tau * (0.8_f64 / tau).cosh().ln();
        simulation.advance(10.0).unwrap();
        assert_relative_eq!(-simulation.state().lines[0].velocity[2].z, terminal, max_relative = 1e-9);
        error
    });
    assert_order(2.0, &steps, &errors);
}

/// A mass of 1 kg on a light 10 m line of one element, released from rest at an angle [rad].
fn pendulum(angle: f64) -> Scene {
    let tension = 9.80665 * angle.cos().max(0.0);
    let radius = 10.0 * (1.0 + tension / PENDULUM_EA);
    let bob = radius * Vector3::new(angle.sin(), 0.0, -angle.cos());
    let wire = draft(format!(
        "line_types.wire = {{ mass = 1e-6, axial_stiffness = {PENDULUM_EA} }}
        solver = {{ time_step_max = 5e-4 }}"
    ))
    .fixed("pivot", [0.0; 3])
    .free("bob", bob.into())
    .with("mass = 1.0")
    .line("wire", ["pivot", "bob"], "wire", 10.0, 1);
    released_from(wire.scene(), &[Vector3::zeros(), bob])
}

const PENDULUM_EA: f64 = 1e7; // [N]

#[test]
fn a_pendulum_swings_with_the_period_of_the_elliptic_integral() {
    // T = 4√(l/g) K(sin ½θ) = 2π√(l/g)/agm(1, cos ½θ); T_max = mg(3 − 2 cos θ)
    for degrees in [10.0_f64, 45.0, 90.0] {
        let angle = degrees.to_radians();
        let mut simulation = start(&pendulum(angle));
        let (mut sway, mut tension) = (vec![place(&simulation, "bob").x], 0.0_f64);
        for _ in 0..4000 {
            simulation.advance(2e-3).unwrap();
            sway.push(place(&simulation, "bob").x);
            tension = tension.max(simulation.tension_a(0));
        }
        let crossings = zero_crossings(&sway, 2e-3);
        let period = 2.0 * PI * (10.0_f64 / 9.80665).sqrt() / agm(1.0, (0.5 * angle).cos());
        assert_relative_eq!(2.0 * (crossings[1] - crossings[0]), period, max_relative = 5e-6);
        assert_relative_eq!(4.0 * crossings[0], period, max_relative = 1e-5);
        assert_relative_eq!(tension, 9.80665 * (3.0 - 2.0 * angle.cos()), max_relative = 1e-4);
    }
}

/// Tension at the root [N] and radius of the tip [m] of an elastic string in steady rotation at `omega` [rad/s], after one revolution.
fn whirl(omega: f64, n: usize) -> [f64; 2] {
    let (ea, h) = (1e4_f64, 1.0 / n as f64);
    let kappa = 2.0 * (0.5 * omega * h / ea.sqrt()).asin();
    // r_i = A sin(κi); A from the half mass at the tip: EA((r_n − r_{n−1})/h − 1) = ½ h ω² r_n
    let sin = |i: usize| (kappa * i as f64).sin();
    let scale = ea / (ea * (sin(n) - sin(n - 1)) / h - 0.5 * h * omega * omega * sin(n));
    let radii: Vec<Vector3<f64>> = (0..=n).map(|i| scale * sin(i) * Vector3::x()).collect();
    let string = draft(
        "gravity = 0.0
        line_types.string = { mass = 1.0, axial_stiffness = 1e4, axial_damping = 0.0 }
        solver = { integrator = 'leapfrog', time_step_max = 1e-5 }",
    )
    .fixed("hub", [0.0; 3])
    .free("tip", radii[n].into())
    .line("string", ["hub", "tip"], "string", 1.0, n);
    let mut simulation = start(&released_from(string.scene(), &radii));
    let velocities: Vec<Vector3<f64>> = radii.iter().map(|r| omega * r.x * Vector3::y()).collect();
    set_node_velocities(&mut simulation, &velocities);
    simulation.advance(2.0 * PI / omega).unwrap();
    [simulation.tension_a(0), place(&simulation, "tip").norm()]
}

#[test]
fn a_whirling_elastic_string_is_pulled_by_the_tangent_law() {
    // r = sin(ks)/(k cos kL), T(0) = EA(1/cos kL − 1), k = ω√(m/EA)
    for omega in [20.0, 50.0, 100.0] {
        let k: f64 = omega / 1e4_f64.sqrt();
        let (tension, radius) = (1e4 * (1.0 / k.cos() - 1.0), k.tan() / k);
        let found = RESOLUTIONS.map(|n| whirl(omega, n / 2));
        assert_order(2.0, &sizes(), &found.map(|f| f[0] - tension));
        assert_order(2.0, &sizes(), &found.map(|f| f[1] - radius));
    }
}

#[test]
fn a_towed_cable_streams_straight_at_the_angle_of_balance() {
    for (w, d, cdn, cdt, speed) in [(10.0, 0.05, 1.2, 0.02, 2.0), (50.0, 0.1, 1.0, 0.05, 1.0)] {
        let rho = RHO;
        let [cos, sin, pull] = streaming_cable([w, d, cdn, cdt], speed);
        let (length, until) = (20.0, 120.0);
        let (x, z) = (length * cos, -length * sin);
        let late = until + 10.0;
        let towed = draft(format!(
            "water = {{ density = {rho} }}
            line_types.rope = {{ mass = 12.0, weight = {w}, diameter = {d}, axial_stiffness = 1e6, axial_damping = 1e4,
              drag_normal = {cdn}, drag_tangential = {cdt}, added_mass_normal = 1.0 }}
            motion.ship.table = [[0.0, 0.0, 0.0, 0.0], [5.0, {}, 0.0, 0.0], [10.0, {}, 0.0, 0.0], [{until}, {}, 0.0, 0.0],
              [{late}, {}, 0.0, 0.0]]",
            5.0 * speed,
            10.0 * speed,
            until * speed,
            late * speed,
        ))
        .free("end", [-x, 0.0, z])
        .coupled("ship", [0.0; 3])
        .line("rope", ["end", "ship"], "rope", length, 10)
        .with("initial = 'straight'");
        let mut simulation = following(&towed.scene());
        while simulation.time() < until - 1.0 {
            simulation.advance(1.0).unwrap();
        }
        let nodes = nodes(&simulation);
        for pair in nodes.windows(2) {
            let q = (pair[1] - pair[0]).normalize();
            assert_relative_eq!(q.x, cos, epsilon = 1e-6);
            assert_relative_eq!(q.z, sin, epsilon = 1e-6);
        }
        assert_relative_eq!(simulation.tension_b(0), length * pull, max_relative = 1e-6);
    }
}

#[test]
fn a_bump_on_a_taut_string_splits_and_travels_as_dalembert_says() {
    // w(x, t) = ½f(x − ct) + ½f(x + ct), c² = TL/(m L₀) for stretched lengths
    let speed = (STRING_TENSION * STRING_SPAN / (STRING_MASS * STRING_LENGTH)).sqrt();
    let bump = |x: f64| 1e-3 * (-((x - 50.0) / 6.0_f64).powi(2)).exp();
    let time = 25.0 / speed;
    let resolutions = [50, 100, 200, 400];
    for integrator in [Integrator::Leapfrog, Integrator::AxialImplicit] {
        let errors = resolutions.map(|n| {
            let spread = (0..=n).map(|i| STRING_SPAN * i as f64 / n as f64);
            let bumped: Vec<Vector3<f64>> = spread.map(|x| Vector3::new(x, 0.0, bump(x))).collect();
            let scene = with_integrator(taut_string(n), integrator, 0.3 * STRING_SPAN / n as f64 / speed);
            let mut simulation = start(&released_from(scene, &bumped));
            simulation.advance(time).unwrap();
            let exact = |x: f64| 0.5 * (bump(x - speed * time) + bump(x + speed * time));
            assert!(exact(75.0) > 0.49e-3);
            let square: f64 = nodes(&simulation)
                .iter()
                .map(|r| (r.z - exact(r.x)).powi(2))
                .sum();
            (square / n as f64).sqrt()
        });
        assert_order(2.0, &resolutions.map(|n| 1.0 / n as f64), &errors);
    }
}

#[test]
fn a_cable_released_from_a_parabola_or_without_tension_settles_into_its_discrete_catenary() {
    // SeaFEM validation case 11 with 22 elements; on any mesh each end carries half the weight
    for integrator in [Integrator::Auto, Integrator::Leapfrog, Integrator::AxialImplicit] {
        for initial in [InitialShape::Parabola(0.72), InitialShape::Straight] {
            let mut scene = shipped("seafem11");
            (scene.solver.integrator, scene.lines[0].initial) = (integrator, initial);
            let mut simulation = start(&scene);
            run(&mut simulation, 0.05, 400);
            assert_relative_eq!(simulation.sag(0), 0.7182741621, epsilon = 1e-9);
            assert_relative_eq!(-simulation.end_force(1)[2], 3.4648145, epsilon = 1e-8);
            let half = 0.5 * 0.49 * 14.1421;
            assert_relative_eq!(-simulation.line_end_force(0, End::A).z, half, epsilon = 1e-8);
        }
    }
}

#[test]
fn the_settled_sag_converges_to_the_elastic_catenary_at_second_order() {
    let resolutions = [10, 22, 50, 100];
    let errors = resolutions.map(|n| {
        let mut simulation = start(&with_elements(shipped("seafem11"), n));
        run(&mut simulation, 0.05, 240);
        simulation.sag(0) - 0.7177774653884867
    });
    assert_order(2.0, &resolutions.map(|n| 1.0 / n as f64), &errors);
    assert!(errors[3].abs() < 3e-5);
}
