//! Motions of points and vessels, from gentle to violent.

use moorline::scene::{HarmonicMotion, MotionPath};

use crate::dice::Dice;
use crate::plan::{Plan, Resists};

/// Fastest motion along an axis [m/s], except for wild motions.
const SPEED: f64 = 20.0;

/// A motion: sums of sines, or a table, which may turn a vessel through several revolutions.
pub fn motion(dice: &mut Dice, plan: &Plan, turns: bool) -> MotionPath {
    let violent = dice.chance(0.15);
    if dice.chance(0.2) {
        return table(dice, plan, turns);
    }
    let mut axis = |size: f64, fast: f64| -> Vec<Vec<f64>> {
        let count = dice.pick(&[1, 0, 2, 3]);
        let component = |_| {
            let period = dice.size([2.0, 60.0], [0.05, 1e9]);
            let most = size.min(fast * period / 6.3).max(2e-6);
            let amplitude = dice.log(0.01 * most, most);
            match dice.chance(0.5) {
                true => vec![amplitude, period, dice.within(3.0)],
                false => vec![amplitude, period],
            }
        };
        (0..count).map(component).collect()
    };
    let (reach, angle) = match violent && plan.resists != Resists::Torsion {
        true => (0.15 * plan.size, 1.0),
        false => (0.02 * plan.size, 0.2),
    };
    let mut path = HarmonicMotion {
        x: axis(reach, SPEED),
        y: axis(reach, SPEED),
        z: axis(reach, SPEED),
        ..HarmonicMotion::default()
    };
    if turns {
        let fast = SPEED / plan.size;
        path.roll = axis(angle, fast);
        path.pitch = axis(angle, fast);
        path.yaw = axis(angle, fast);
    }
    path.ramp = dice.maybe(0.5, |dice| dice.log(0.1, 40.0));
    MotionPath::Harmonic(path)
}

/// A table with a row every few seconds; vessels may turn by more than one revolution.
fn table(dice: &mut Dice, plan: &Plan, turns: bool) -> MotionPath {
    let reach = plan.size * dice.log(1e-3, 0.1);
    let turn = if turns { dice.log(0.01, 10.0) } else { 0.0 };
    let mut time = 0.0;
    let mut rows = vec![[0.0; 7]];
    for _ in 0..dice.whole(1, 5) {
        let span = dice.log(1.0, 30.0).max(6.3 * reach / SPEED);
        time += span;
        let mut row = [0.0; 7];
        row[0] = time;
        for (place, value) in row.iter_mut().enumerate().skip(1) {
            *value = match place {
                1..=3 => dice.within(reach),
                _ if turns => dice.within(turn),
                _ => 0.0,
            };
        }
        rows.push(row);
    }
    MotionPath::Table(rows)
}
