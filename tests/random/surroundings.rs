//! Gravity, water and seabed.

use std::f64::consts::PI;

use moorline::scene::{
    ContactLaw, Current, DepthGrid, Friction, RegularWave, STANDARD_GRAVITY, Sea, Seabed, SpectrumKind,
    TimeFunction, Water, WaveComponents, Waves,
};

use crate::dice::Dice;

/// Gravity [m/s²]: the earth's, the moon's, zero, or any legal value.
pub fn gravity(dice: &mut Dice) -> f64 {
    if dice.chance(0.05) {
        return dice.pick(&[1.62, 0.0, 9.81]);
    }
    dice.size([STANDARD_GRAVITY; 2], [1e-3, 1e3])
}

/// Water. A current is drawn only if `moves`, and waves only if `waves`.
pub fn water(dice: &mut Dice, size: f64, gravity: f64, moves: bool, waves: bool) -> Water {
    let density = dice.size([1025.0, 1025.0], [1e-15, 1e5]);
    Water {
        density,
        current: (moves && dice.chance(0.4)).then(|| current(dice, size)),
        waves: (waves && gravity > 0.0 && dice.chance(0.35)).then(|| self::waves(dice, size)),
        flow: None,
        surface: dice.pick(&[None, None, None, Some(true), Some(false)]),
    }
}

fn current(dice: &mut Dice, size: f64) -> Current {
    let speed = dice.size([0.1, 3.0], [1e-6, 100.0]);
    let factor = dice.maybe(0.4, |dice| {
        let [t0, f0, f1] = [0.0, -0.5, 0.0].map(|from| dice.between(from, 20.0 * from + 1.5));
        let span = dice.log(0.1, 40.0);
        match dice.whole(0, 3) {
            0 => TimeFunction::Constant(f1),
            1 => TimeFunction::Step([t0, f0, t0 + span, f1]),
            2 => TimeFunction::Ramp([t0, f0, t0 + span, f1]),
            _ => TimeFunction::Table(vec![[0.0, f0], [span, f0], [span, f1]]),
        }
    });
    if dice.chance(0.5) {
        let count = dice.whole(1, 4);
        let row = |k: usize| {
            let z = -size * (k as f64 + dice.between(-0.4, 0.4)) / count as f64;
            [z, dice.within(speed), dice.within(speed)]
        };
        return Current {
            profile: Some((0..count).map(row).collect()),
            factor,
            ..Current::default()
        };
    }
    let vertical = if dice.chance(0.2) { 0.2 * speed } else { 0.0 };
    let velocity = [dice.within(speed), dice.within(speed), vertical];
    Current {
        velocity: Some(velocity),
        factor,
        ..Current::default()
    }
}

fn waves(dice: &mut Dice, size: f64) -> Waves {
    let ramp = dice.maybe(0.5, |dice| dice.log(0.1, 100.0));
    let count = dice.pick(&[1, 1, 1, 2]);
    let seas = (0..count).map(|_| sea(dice, size, ramp)).collect();
    Waves { seas }
}

fn sea(dice: &mut Dice, size: f64, ramp: Option<f64>) -> Sea {
    // height: at most a tenth of the wavelength in deep water, g T²/2π, and 0.3 of the size of the scene
    let period = dice.size([2.0, 20.0], [0.05, 1e5]);
    let steepness = dice.log(1e-3, 0.1);
    let height = (steepness * 1.56 * period * period).clamp(1e-6, (0.3 * size).min(30.0));
    let direction = dice.within(PI);
    let row = |dice: &mut Dice| {
        let share = dice.between(0.05, 0.5);
        let period = period * dice.log(0.3, 3.0).clamp(0.06 / period, 9e4 / period);
        [share * height, period, dice.within(PI), dice.within(PI)]
    };
    let mut sea = Sea {
        ramp,
        ..Sea::default()
    };
    match dice.whole(0, 2) {
        0 => {
            sea.regular = Some(RegularWave {
                height: Some(height),
                period,
                direction,
                phase: dice.within(PI),
                ..RegularWave::default()
            });
        }
        1 => {
            let count = dice.whole(1, 5);
            let rows = (0..count).map(|_| row(dice)).collect();
            sea.components = Some(WaveComponents::Rows(rows));
        }
        _ => {
            let jonswap = dice.chance(0.6);
            sea.spectrum = Some(match jonswap {
                true => SpectrumKind::Jonswap,
                false => SpectrumKind::PiersonMoskowitz,
            });
            sea.significant_height = Some(height);
            sea.peak_period = Some(period);
            sea.peakedness = dice
                .maybe(0.5, |dice| dice.between(1.0, 10.0))
                .filter(|_| jonswap);
            sea.direction = Some(direction);
            sea.spreading = dice.maybe(0.4, |dice| dice.log(1.0, 1000.0));
            sea.seed = Some(dice.seed());
            sea.components = Some(WaveComponents::Number(dice.whole(1, 24) as u64));
        }
    }
    sea
}

/// A seabed about `depth` [m] deep, level if `level`; fixed points may be anywhere within `size` [m].
pub fn seabed(dice: &mut Dice, depth: f64, size: f64, level: bool) -> Seabed {
    let mut seabed = Seabed::level(depth);
    if dice.chance(0.6) {
        seabed.stiffness = dice.size([1e3, 1e8], [1e-15, 1e12]);
        seabed.damping = match dice.whole(0, 2) {
            0 => 0.0,
            _ => seabed.stiffness * dice.log(1e-3, 10.0),
        }
        .min(1e12);
    }
    if dice.chance(0.3) {
        seabed.contact = ContactLaw::AsGiven;
    }
    if !level {
        seabed.friction = match dice.whole(0, 3) {
            0 | 1 => Friction::default(),
            2 => Friction::isotropic(dice.size([0.05, 1.0], [1e-6, 10.0])),
            _ => Friction {
                transverse: dice.between(0.0, 1.0),
                axial: dice.between(0.0, 1.0),
            },
        };
        match dice.whole(0, 4) {
            0..=2 => {}
            3 => seabed.slope = Some([dice.within(0.2), dice.within(0.2)]),
            _ => seabed.grid = Some(grid(dice, depth, size)),
        }
    }
    seabed
}

fn grid(dice: &mut Dice, depth: f64, size: f64) -> DepthGrid {
    let [wide, high] = [dice.whole(2, 4), dice.whole(2, 4)];
    let along = |count: usize| {
        let place = |i: usize| size * (2.0 * i as f64 / (count - 1) as f64 - 1.0);
        (0..count).map(place).collect::<Vec<f64>>()
    };
    let mut depths = || depth * (1.0 + dice.within(0.15));
    let rows = (0..high).map(|_| (0..wide).map(|_| depths()).collect());
    DepthGrid {
        x: along(wide),
        y: along(high),
        depth: rows.collect(),
    }
}

/// A height [m] at or above the seabed at a horizontal position [m].
pub fn seabed_height(seabed: &Seabed, [x, y]: [f64; 2]) -> f64 {
    if let Some(grid) = &seabed.grid {
        let depths = grid.depth.iter().flatten();
        return -depths.fold(f64::INFINITY, |least: f64, depth| least.min(*depth));
    }
    let [along_x, along_y] = seabed.slope.unwrap_or_default();
    along_x * x + along_y * y - seabed.depth
}
