//! Tests of the paths of coupled points.

use super::*;
use approx::assert_relative_eq;

/// Sample from the host for one axis at one time.
struct Sample {
    time: f64,
    position: f64,
    velocity: Option<f64>,
}

struct Guided(Clock, AxisPath, Extrapolation);

impl Guided {
    fn at_rest(time: f64, position: f64) -> Guided {
        Guided(
            Clock::new(time),
            AxisPath::at_rest(position),
            Extrapolation::none(),
        )
    }

    fn extend(&mut self, sample: Sample, step: f64, reconstruction: Reconstruction) {
        let extrapolation = &mut self.2;
        self.0
            .add_sample(sample.time, step, reconstruction, extrapolation);
        self.1.extend(extrapolation, sample.position, sample.velocity);
    }

    fn at(&self, t: f64) -> hermite::Sample {
        self.1.at(t)
    }
}

fn position(t: f64) -> f64 {
    5.0 * (0.5 * t).sin() + 2.0 * (0.7 * t).cos()
}

fn velocity(t: f64) -> f64 {
    2.5 * (0.5 * t).cos() - 1.4 * (0.7 * t).sin()
}

fn sample(time: f64, position: f64) -> Sample {
    Sample {
        time,
        position,
        velocity: None,
    }
}

#[test]
fn an_extrapolation_does_not_depend_on_those_before() {
    let (mut clock, mut kept, mut time) = (Clock::new(0.0), Extrapolation::none(), 0.0);
    for k in 0..200 {
        // equal steps with short ones between them, a repeated time, and a step back
        let step = if k % 31 == 30 { 0.007 } else { 0.05 };
        let mut fresh = Extrapolation::none();
        clock
            .clone()
            .add_sample(time, step, Reconstruction::Smooth, &mut fresh);
        clock.add_sample(time, step, Reconstruction::Smooth, &mut kept);
        assert_eq!(format!("{kept:?}"), format!("{fresh:?}"), "at {time} s");
        time += match k {
            70 => 0.0,
            140 => -0.1,
            _ => step,
        };
    }
}

#[test]
fn steps_that_are_equal_but_for_rounding_are_extrapolated_as_equal_ones() {
    for with_velocity in [false, true] {
        let ends = [0.0, 1e-12, 1e-8].map(|noise| {
            let mut path = Guided::at_rest(0.0, position(0.0));
            let told = |k: usize| {
                let time = 0.25 * k as f64;
                Sample {
                    time: time * (1.0 + noise * (k % 3) as f64),
                    position: position(time),
                    velocity: with_velocity.then(|| velocity(time)),
                }
            };
            (0..40).for_each(|k| path.extend(told(k), 0.25, Reconstruction::Smooth));
            assert_eq!(path.2.even, noise < 1e-9);
            path.at(10.0).value
        });
        // the last path is extrapolated with its actual times
        assert_relative_eq!(ends[1], ends[0], epsilon = 1e-9);
        assert_relative_eq!(ends[2], ends[0], epsilon = 1e-4);
    }
}

#[test]
fn axes_are_extrapolated_as_each_would_be_alone() {
    let (mut clock, mut extrapolation) = (Clock::new(0.0), Extrapolation::none());
    let mut together = AxesPath::at_rest([0.0; 3]);
    let mut alone = [0.0; 3].map(AxisPath::at_rest);
    for k in 0..300 {
        // the second axis has no velocity; steps of 0.1 s except for single jumps in time
        let time = 0.1 * f64::from(k) + if k % 50 > 25 { 0.03 } else { 0.0 };
        let places = [position(time), position(0.4 * time), position(2.0 * time)];
        let rates = [Some(velocity(time)), None, Some(2.0 * velocity(2.0 * time))];
        clock.add_sample(time, 0.1, Reconstruction::Smooth, &mut extrapolation);
        let before = together;
        together.extend(&before, &extrapolation, &InputSample::new(places, rates));
        for axis in 0..3 {
            alone[axis].extend(&extrapolation, places[axis], rates[axis]);
        }
        for axis in 0..3 {
            let [value, slope, _] = together.at(time + 0.1).map(|lanes| lanes[axis]);
            let own = alone[axis].at(time + 0.1);
            assert_eq!([value, slope], [own.value, own.slope], "axis {axis}, {time} s");
        }
    }
}

/// Maximum distance between path and exact motion after the start-up, for a communication step h.
fn path_error(h: f64, with_velocity: bool, reconstruction: Reconstruction) -> f64 {
    let mut path = Guided::at_rest(0.0, position(0.0));
    let mut worst: f64 = 0.0;
    for k in 0..(20.0 / h) as usize {
        let time = k as f64 * h;
        let told = match reconstruction {
            Reconstruction::Interpolate => time + h,
            _ => time,
        };
        let given = Sample {
            velocity: with_velocity.then(|| velocity(told)),
            ..sample(time, position(told))
        };
        path.extend(given, h, reconstruction);
        if time > 5.0 {
            let middle = time + 0.5 * h;
            worst = worst.max((path.at(middle).value - position(middle)).abs());
        }
    }
    worst
}

#[test]
fn a_short_step_after_a_long_one_does_not_leap_back_to_the_host() {
    let mut path = Guided::at_rest(0.0, 0.0);
    let mut time = 0.0;
    for step in [10.0, 1e-3, 1e-3, 2.0, 1e-3, 4.0, 4.0, 4.0, 4.0, 4.0] {
        // the first step of 10 s starts at rest, and the path ends it a metre off
        let there = if time > 0.0 { 1.0 } else { 0.0 };
        path.extend(sample(time, there), step, Reconstruction::Smooth);
        let fastest = (0..=100)
            .map(|k| path.at(time + 0.01 * step * f64::from(k)).slope.abs())
            .fold(0.0, f64::max);
        assert!(fastest < 0.6, "{fastest} m/s in a step of {step} s at {time} s");
        time += step;
    }
    assert_relative_eq!(path.at(time).value, 1.0, epsilon = 1e-6);
}

#[test]
fn the_path_converges_at_third_order_or_better() {
    for with_velocity in [false, true] {
        for reconstruction in [Reconstruction::Smooth, Reconstruction::Interpolate] {
            let error = |h| path_error(h, with_velocity, reconstruction);
            let errors = [0.4, 0.2, 0.1, 0.05].map(error);
            for pair in errors.windows(2) {
                assert!((pair[0] / pair[1]).log2() > 2.9, "{errors:?}");
            }
        }
    }
}

#[test]
fn a_host_that_knows_what_comes_is_followed_a_tenth_as_far_off() {
    for with_velocity in [false, true] {
        let [blind, seeing] = [Reconstruction::Smooth, Reconstruction::Interpolate]
            .map(|reconstruction| path_error(0.4, with_velocity, reconstruction));
        assert!(seeing < 0.1 * blind, "{seeing}, {blind}");
    }
}

#[test]
fn a_path_goes_through_what_a_host_says_of_the_ends_of_irregular_steps() {
    let mut path = Guided::at_rest(0.0, position(0.0));
    let mut time = 0.0;
    for step in [0.3, 0.1, 1e-3, 2.0, 0.3, 0.3] {
        let end = time + step;
        let given = Sample {
            velocity: Some(velocity(end)),
            ..sample(time, position(end))
        };
        let before = path.at(time);
        path.extend(given, step, Reconstruction::Interpolate);
        assert_relative_eq!(path.at(time).value, before.value, epsilon = 1e-12);
        assert_relative_eq!(path.at(end).value, position(end), epsilon = 1e-12);
        assert_relative_eq!(path.at(end).slope, velocity(end), epsilon = 1e-9);
        time = end;
    }
}

#[test]
fn position_and_velocity_are_continuous_at_communication_points() {
    let mut path = Guided::at_rest(0.0, 0.0);
    let mut before = path.at(0.0);
    for (k, x) in [0.0, 0.0, 1.0, 1.0, 1.0, -0.3, 0.2].into_iter().enumerate() {
        let time = 0.1 * k as f64;
        path.extend(sample(time, x), 0.1, Reconstruction::Smooth);
        assert_relative_eq!(path.at(time).value, before.value, epsilon = 1e-12);
        assert_relative_eq!(path.at(time).slope, before.slope, epsilon = 1e-11);
        before = path.at(time + 0.1);
    }
}

/// Degrees chosen for a harmonic motion with a period [s] whose amplitude grows to 1 m over 20 s, sampled every `step` [s]
/// at times with a relative error of `noise` [-].
fn degrees(period: f64, step: f64, noise: f64) -> Vec<usize> {
    let motion = |t: f64| {
        let grown = 0.5 * (1.0 - (std::f64::consts::PI * t.min(20.0) / 20.0).cos());
        grown * (std::f64::consts::TAU * t / period).sin()
    };
    let mut path = Guided::at_rest(0.0, 0.0);
    let degree = |k: usize| {
        let rounding = noise * ((k * 7919) % 101) as f64 / 50.0 - noise;
        let time = k as f64 * step;
        let given = sample(time * (1.0 + rounding), motion(time));
        path.extend(given, step, Reconstruction::Smooth);
        path.1.0.degree[0] as usize
    };
    (0..(120.0 / step) as usize).map(degree).collect()
}

#[test]
fn rounding_of_the_times_does_not_change_the_degree() {
    for period in [12.0, 9.0, 10.0, 8.0, 1.25] {
        for step in [0.4, 0.2, 0.1, 0.05] {
            let exact = degrees(period, step, 0.0);
            assert!(exact.contains(&DEGREE_MAX) || period < 2.0);
            for noise in [1e-15, 1e-13, 1e-12] {
                let rounded = degrees(period, step, noise);
                assert_eq!(exact, rounded, "{period} s every {step} s, {noise}");
            }
        }
    }
}

#[test]
fn a_motion_that_comes_to_rest_forgets_its_degree() {
    let mut path = Guided::at_rest(0.0, position(0.0));
    for k in 0..200 {
        let time = 0.1 * f64::from(k);
        let moved = if k < 100 {
            position(time)
        } else if k < 150 {
            3.0
        } else {
            4.0
        };
        path.extend(sample(time, moved), 0.1, Reconstruction::Smooth);
        if k >= 106 {
            assert!(path.at(time + 0.1).value <= 4.0 + 1e-12, "{time} s");
        }
    }
    assert_eq!(path.1.0.degree[0], 0.0);
}

#[test]
fn a_jump_is_not_overshot() {
    let mut path = Guided::at_rest(0.0, 0.0);
    for k in 0..20 {
        let time = 0.1 * k as f64;
        path.extend(
            sample(time, if k < 6 { 0.0 } else { 1.0 }),
            0.1,
            Reconstruction::Smooth,
        );
        assert!(path.at(time + 0.1).value <= 1.0 + 1e-12);
    }
    assert_relative_eq!(path.at(2.0).value, 1.0, epsilon = 1e-12);
}

/// Maximum errors of position, velocity and acceleration after the start-up, for a repeated sequence of steps.
fn path_errors(steps: &[f64], with_velocity: bool) -> [f64; 3] {
    let mut path = Guided::at_rest(0.0, position(0.0));
    let (mut time, mut worst) = (0.0, [0.0_f64; 3]);
    for step in steps.iter().cycle() {
        let given = Sample {
            velocity: with_velocity.then(|| velocity(time)),
            ..sample(time, position(time))
        };
        path.extend(given, *step, Reconstruction::Smooth);
        for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
            let t = time + part * step;
            let is = path.at(t);
            let acceleration = -1.25 * (0.5 * t).sin() - 0.98 * (0.7 * t).cos();
            let misses = [
                is.value - position(t),
                is.slope - velocity(t),
                is.curvature - acceleration,
            ];
            for (worst, miss) in worst.iter_mut().zip(misses) {
                *worst = worst.max(f64::from(time > 8.0) * miss.abs());
            }
        }
        time += step;
        if time > 30.0 {
            break;
        }
    }
    worst
}

#[test]
fn irregular_steps_converge_at_the_order_of_equal_ones() {
    for steps in [&[1.0, 0.4, 1.3, 0.15, 0.7][..], &[1.0, 0.05], &[1.0, 0.001]] {
        for with_velocity in [false, true] {
            let errors = |h: f64| {
                let scaled: Vec<f64> = steps.iter().map(|step| h * step).collect();
                path_errors(&scaled, with_velocity)
            };
            let errors = [0.4, 0.2, 0.1, 0.05].map(errors);
            for pair in errors.windows(2) {
                for (quantity, order) in [2.9, 2.5, 1.5].into_iter().enumerate() {
                    let fall = (pair[0][quantity] / pair[1][quantity]).log2();
                    assert!(fall > order, "{steps:?} {with_velocity} {quantity}: {errors:?}");
                }
            }
        }
    }
}

/// Errors of the third degree on equal steps [s], from its position error: of the position, of the velocity at the ends of the steps, and of
/// the acceleration between them.
fn errors_of_third_degree(position: f64, step: f64, with_velocity: bool) -> [f64; 3] {
    let factor = if with_velocity { 720.0 / 251.0 } else { 25.0 / 12.0 };
    let velocity = factor * position / step;
    [position, velocity, 6.0 * velocity / step]
}

#[test]
fn on_equal_steps_velocity_and_acceleration_are_nearer_than_those_of_the_third_degree() {
    for with_velocity in [false, true] {
        let [position, velocity, acceleration] = path_errors(&[0.2], with_velocity);
        let [_, rate, bend] = errors_of_third_degree(position, 0.2, with_velocity);
        assert!(velocity < 0.2 * rate, "{with_velocity}: {velocity} {rate}");
        assert!(
            acceleration < 0.25 * bend,
            "{with_velocity}: {acceleration} {bend}"
        );
    }
}

#[test]
fn short_steps_between_long_ones_cost_no_accuracy() {
    for with_velocity in [false, true] {
        let [position, ..] = path_errors(&[0.2], with_velocity);
        let alone = errors_of_third_degree(position, 0.2, with_velocity);
        for short in [0.1, 0.02, 0.01, 1e-3, 1e-4, 1e-6] {
            for steps in [&[0.2, short][..], &[0.2, short, short, short], &[0.2, 0.2, short]] {
                let errors = path_errors(steps, with_velocity);
                for (error, alone) in errors.into_iter().zip(alone) {
                    assert!(error < 2.0 * alone, "{steps:?} {with_velocity}: {errors:?}");
                }
            }
        }
    }
}

#[test]
fn after_a_long_step_the_path_arrives_in_seconds_and_hardly_feels_it() {
    let mut path = Guided::at_rest(0.0, 0.0);
    path.extend(sample(0.0, 0.0), 100.0, Reconstruction::Smooth);
    for k in 0..150 {
        let time = 100.0 + 0.1 * f64::from(k);
        path.extend(sample(time, 5.0), 0.1, Reconstruction::Smooth);
        for t in [time, time + 0.1] {
            let is = path.at(t);
            assert!(is.curvature.abs() < 1.01 * EASE, "{is:?} at {t} s");
            assert!(is.value < 5.0 + 1e-9, "{is:?} at {t} s");
        }
    }
    assert_relative_eq!(path.at(115.0).value, 5.0, epsilon = 1e-9);
}

#[test]
fn after_long_steps_a_motion_is_found_again_in_seconds() {
    for long in [10.0, 100.0] {
        for count in [1, 2, 5] {
            let mut path = Guided::at_rest(0.0, position(0.0));
            let mut time = 0.0;
            for k in 0..count + 200 {
                let step = if k < count { long } else { 0.1 };
                path.extend(sample(time, position(time)), step, Reconstruction::Smooth);
                time += step;
            }
            let error = (path.at(time).value - position(time)).abs();
            assert!(error < 1e-3, "{error} m after {count} steps of {long} s");
        }
    }
}

#[test]
fn samples_that_are_kept_are_not_crowded_by_short_steps() {
    let (mut clock, mut extrapolation) = (Clock::new(0.0), Extrapolation::none());
    let mut time = 0.0;
    for k in 0..60 {
        let step = [0.2, 1e-3, 1e-5, 1e-5, 0.13][k % 5];
        clock.add_sample(time, step, Reconstruction::Smooth, &mut extrapolation);
        time += step;
        assert!(k < 15 || extrapolation.count == SAMPLES_MAX, "{clock:?}");
    }
}

#[test]
fn the_jump_option_restarts_where_the_host_says() {
    let mut path = Guided::at_rest(0.0, 0.0);
    path.extend(
        Sample {
            velocity: Some(2.0),
            ..sample(0.0, 1.0)
        },
        0.5,
        Reconstruction::Jump,
    );
    assert_eq!((path.at(0.0).value, path.at(0.5).value), (1.0, 2.0));
}
