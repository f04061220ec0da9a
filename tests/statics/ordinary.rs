//! Equilibrium of random ordinary lines on elements: chains, wires and ropes from a rough or smooth seabed to a fairlead near the surface,
//! with the elements of the rule or with 8 to 300.
//!
//! ```text
//!                          ● B, 0.05 of the depth under water      chains and wires sink and lie on a seabed with friction;
//!                        ╱                                         ropes that float hang upwards between their ends
//!   anchor A ●═════════╱    seabed
//! ```
//!
//! Every line has a number and is reproducible. A part of the long run, or a single line:
//!
//! ```text
//! LINES=120..121 cargo test --release --test statics -- --ignored --nocapture ordinary::ten_thousand
//! ```

use std::ops::Range;

use crate::common::{at_reference, draft, greatest, resting};
use moorline::elements::{Workspace, end_force};
use moorline::math::random::Random;
use moorline::model::{End, Model};
use moorline::scene::Scene;
use moorline::statics::catenary::{self, FlatSeabed, Section};
use moorline::statics::equilibrium::solve;

/// Density of water [kg/m³].
const WATER: f64 = 1025.0;
/// Gravity [m/s²].
const GRAVITY: f64 = 9.80665;

/// A material: mass divided by the square of the diameter [kg/m³], volume-equivalent diameter divided by the diameter [-], EA divided by the square of
/// the diameter [N/m²].
type Material = [f64; 3];

/// Studless chain, six-strand wire and a polyester rope.
const SINKING: [Material; 3] = [
    [19_900.0, 1.8, 8.54e10],
    [5_293.0, 1.18, 9.7e10],
    [679.0, 0.86, 1.4e10],
];
/// Polypropylene rope.
const FLOATING: Material = [560.0, 1.0, 1.542e10];

/// A line whose equilibrium is computed.
#[derive(Debug, Clone)]
struct Line {
    depth: f64,
    stiffness: f64,
    friction: f64,
    mass: f64,
    diameter: f64,
    axial_stiffness: f64,
    span: f64,
    length: f64,
    elements: Option<usize>,
}

/// Random number generator.
struct Dice(Random);

impl Dice {
    fn between(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * self.0.unit()
    }

    fn decades(&mut self, lower: f64, upper: f64) -> f64 {
        lower * (upper / lower).powf(self.0.unit())
    }
}

impl Line {
    /// Line with a number, over a rough seabed.
    fn rough(number: u64) -> Line {
        let mut dice = Dice(Random::new(number));
        let material = SINKING[dice.between(0.0, 3.0) as usize];
        let friction = dice.between(0.1, 1.2);
        let slack = dice.between(0.01, 1.05);
        Line::of(dice, material, friction, slack)
    }

    /// Floating slack rope with a number.
    fn floating(number: u64) -> Line {
        let mut dice = Dice(Random::new(number));
        let slack = dice.between(0.3, 1.2);
        Line::of(dice, FLOATING, 0.0, slack)
    }

    /// Line whose length exceeds the chord by `slack` [-] times the difference between the path along the seabed and straight
    /// up and the chord.
    fn of(mut dice: Dice, material: Material, friction: f64, slack: f64) -> Line {
        let depth = dice.decades(10.0, 1000.0);
        let thickness = dice.decades(0.02, 0.16); // diameter of bar or rope [m]
        let square = thickness * thickness;
        let span = depth * dice.between(0.5, 4.0);
        let rise = 0.95 * depth;
        let chord = span.hypot(rise);
        Line {
            depth,
            stiffness: dice.decades(2e3, 5e6),
            friction,
            mass: material[0] * square,
            diameter: material[1] * thickness,
            axial_stiffness: material[2] * square,
            span,
            length: chord + slack * (span + rise - chord),
            elements: (dice.between(0.0, 1.0) < 0.7).then(|| dice.between(8.0, 301.0) as usize),
        }
    }

    fn scene(&self) -> Scene {
        draft(format!(
            "water.density = {WATER:e}
            seabed = {{ depth = {:e}, stiffness = {:e}, damping = {:e}, friction = {:e} }}
            line_types.t = {{ mass = {:e}, diameter = {:e}, axial_stiffness = {:e}, damping_ratio = 0.05, drag_normal = 1.2,
              added_mass_normal = 1.0 }}",
            self.depth,
            self.stiffness,
            0.1 * self.stiffness,
            self.friction,
            self.mass,
            self.diameter,
            self.axial_stiffness,
        ))
        .fixed("a", [0.0, 0.0, -self.depth])
        .coupled("b", [self.span, 0.0, -0.05 * self.depth])
        .line("l", ["a", "b"], "t", self.length, self.elements)
        .scene()
    }

    /// Weight in water per metre [N/m].
    fn weight(&self) -> f64 {
        let area = std::f64::consts::FRAC_PI_4 * self.diameter * self.diameter;
        (self.mass - WATER * area) * GRAVITY
    }

    /// Tension at end B in closed form [N], and tension along the seabed at the touchdown, for a line that is longer and has a rise that is greater by
    /// these differences [m].
    fn closed_form(&self, [longer, higher]: [f64; 2]) -> [f64; 2] {
        let (length, axial_stiffness) = (self.length + longer, self.axial_stiffness);
        let section = Section {
            length,
            weight: self.weight(),
            axial_stiffness,
        };
        let seabed = FlatSeabed {
            height: 0.0,
            friction: self.friction,
        };
        let rise = 0.95 * self.depth + higher;
        let solved = catenary::solve(&[section], self.span, rise, Some(seabed)).unwrap();
        [solved.tension_b(), solved.horizontal()]
    }

    /// Least and greatest tension at end B [N] of a sinking line, on elements of a length l and a seabed with a
    /// deflection of a depth [m].
    ///
    /// The suspended segments k have one horizontal force H and vertical forces V_k = V_1 + (k − 1) w l, where the seabed still carries a part of the weight of
    /// the node before the first, 0 ≤ V_1 ≤ w l; at end B, half an element farther, V = V_m + w l/2. The rise and the excess of length over span are therefore
    /// sums of l f(V_k) instead of the integrals of f dV/w from 0 to V, where f is V/T for the rise and 1 − H/T for the excess. The
    /// sums are midpoint rules from V_1 − w l/2 to V. For both f, whose slopes are at most 1/H, they differ from the integrals by
    ///
    ///   (w l)²/(8 H) for the part between V_1 − w l/2 and 0, and (w l)²/(24 H) for the rule, divided by w,
    ///
    /// and, since 0 ≤ f ≤ 1, by no more than l/2. The line on elements is therefore a closed-form line whose length
    /// and rise differ by no more than δ = min(l/2, w l²/(6 H)) from those of the line. A soft seabed adds its
    /// deflection under a resting node. Both effects are linear in these changes, and the tension decreases with the length and
    /// increases with the rise.
    fn bounds(&self, [element, depth]: [f64; 2]) -> [f64; 2] {
        let [_, horizontal] = self.closed_form([0.0; 2]);
        let by_slope = self.weight() * element * element / (6.0 * horizontal);
        let most = by_slope.min(0.5 * element) + depth;
        let corners = [[most, -most], [most, most], [-most, -most], [-most, most]]
            .map(|corner| self.closed_form(corner)[0]);
        [
            corners.into_iter().fold(f64::INFINITY, f64::min),
            corners.into_iter().fold(0.0, f64::max),
        ]
    }

    /// Length of the longest element and greatest deflection of the seabed under a resting node [m], number of solves, and tension at
    /// end B [N].
    fn solved(&self) -> Result<([f64; 2], usize, f64), String> {
        let model = Model::new(&self.scene()).map_err(|error| error.to_string())?;
        let mut work = Workspace::new(&model);
        let state = solve(&model, &resting(&at_reference(&model)), 0.0, &mut work)
            .map_err(|error| error.to_string())?;
        let solves = work.take_counters().solves;
        let force = end_force(&model, &state, 0, End::B, &mut work).norm();
        let line = &model.lines[0];
        let stiffness = line.nodes.contact.iter().flat_map(|seabed| &seabed.stiffness);
        let depths = line.nodes.weight.iter().zip(stiffness);
        let mesh = [
            greatest(line.segments.length.iter().copied()),
            greatest(depths.map(|(weight, stiffness)| weight / stiffness)),
        ];
        Ok((mesh, solves, force))
    }
}

/// Solves the equilibrium of the lines with these numbers: none may fail, and the tension of sinking lines equals that of
/// the closed form, which has no water surface, within the discretisation error.
fn claim(numbers: Range<u64>, line: fn(u64) -> Line) {
    let (mut failures, mut far, mut solves, mut most) = (vec![], vec![], 0, (0, 0));
    for number in numbers.clone() {
        let line = line(number);
        match line.solved() {
            Err(error) => failures.push(format!("{number}: {error}")),
            Ok((mesh, count, tension)) => {
                solves += count;
                most = most.max((count, number));
                if line.weight() <= 0.0 {
                    continue;
                }
                let [least, greatest] = line.bounds(mesh);
                if !(least..=greatest).contains(&tension) {
                    far.push(format!(
                        "{number}: {tension} N, not {least} to {greatest} N, {line:?}"
                    ));
                }
            }
        }
    }
    let lines = numbers.end - numbers.start;
    println!(
        "{solves} solves for {lines} lines, at most {} for {}",
        most.0, most.1
    );
    println!("{} fail, {} are far", failures.len(), far.len());
    assert!(failures.is_empty(), "of {lines} lines fail: {failures:#?}");
    assert!(
        far.is_empty(),
        "of {lines} lines are far from the closed form: {far:#?}"
    );
}

/// Lines specified by LINES, or all of the ten thousand.
fn long_run() -> Range<u64> {
    let bound = |number: &str| number.parse().expect("LINES is two numbers, as 500..1000");
    let given = std::env::var("LINES").ok();
    let part = given.as_ref().and_then(|given| given.split_once(".."));
    part.map_or(0..10_000, |(from, to)| bound(from)..bound(to))
}

#[test]
fn a_hundred_random_lines_with_friction_find_their_equilibrium() {
    claim(0..100, Line::rough);
}

/// On these lines, the minimisation stalls if nodes stick with their full stiffness from the start.
#[test]
fn lines_on_which_many_nodes_are_about_to_slide_find_their_equilibrium() {
    for number in [922, 7623, 10_294, 19_983, 39_547] {
        claim(number..number + 1, Line::rough);
    }
}

#[test]
fn a_hundred_random_slack_floating_ropes_find_their_equilibrium() {
    claim(0..100, Line::floating);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn two_thousand_random_lines_with_friction_find_their_equilibrium() {
    claim(0..2_000, Line::rough);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn two_thousand_random_slack_floating_ropes_find_their_equilibrium() {
    claim(0..2_000, Line::floating);
}

#[test]
#[ignore = "takes minutes"]
fn ten_thousand_random_lines_with_friction_find_their_equilibrium() {
    claim(long_run(), Line::rough);
}

#[test]
#[ignore = "takes minutes"]
fn ten_thousand_random_slack_floating_ropes_find_their_equilibrium() {
    claim(long_run(), Line::floating);
}

/// Asserts that a line in air from a fixed to a coupled point, with these keys, has an equilibrium.
fn assert_solved(keys: &str, ends: [[f64; 3]; 2], length: f64, elements: usize) {
    let [a, b] = ends;
    let line = draft(keys).fixed("a", a).coupled("b", b);
    let model = line.line("l", ["a", "b"], "t", length, elements).model();
    let found = solve(
        &model,
        &resting(&at_reference(&model)),
        0.0,
        &mut Workspace::new(&model),
    );
    assert!(found.is_ok(), "{elements} elements: {found:?}");
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_hundred_thousand_elements_have_an_equilibrium_or_are_refused_after_a_bounded_number_of_solves() {
    for line in [Line::rough(0), Line::floating(0)] {
        let line = Line {
            elements: Some(100_000),
            ..line
        };
        match line.solved() {
            Ok((_, solves, _)) => assert!(solves <= 201, "{solves} solves"),
            Err(error) => assert!(error.contains("use fewer elements"), "{error}"),
        }
    }
}

#[test]
fn a_light_chain_on_a_rough_soft_seabed_finds_its_equilibrium_on_every_mesh() {
    let keys = "seabed = { depth = 5.0, stiffness = 5882.0, friction = 0.5 }
        line_types.t = { mass = 0.069, weight = 0.588, diameter = 0.0034, axial_stiffness = 3.4e5 }";
    for elements in (8..=320).step_by(8) {
        assert_solved(keys, [[0.0, 0.0, -5.0], [19.364, 0.0, 0.0]], 21.0, elements);
    }
}

#[test]
fn a_nearly_straight_and_very_stiff_line_on_a_rough_seabed_finds_its_equilibrium() {
    let keys = "seabed = { depth = 40.90767141168425, friction = 1.0 }
        line_types.t = { weight = 0.06577196961695088, diameter = 0.1, axial_stiffness = 80573.7785759385 }";
    let a = [0.0, 0.0, -40.75549226241273];
    let b = [16.97027497375482, -61.84997862719906, -40.38993865392305];
    for elements in [8, 16, 24, 48, 96, 192] {
        assert_solved(keys, [a, b], 64.14993564405434, elements);
    }
}
