//! Airy waves: velocity and acceleration of the water under a sum of small waves.
//!
//! Component j of amplitude a, circular frequency ω, direction θ and phase φ over a depth h (or deep water) has
//!
//!   η = a cos ψ,   ψ = k (x cos θ + y sin θ) − ωt + φ,   ω² = g k tanh kh,
//!   u = a ω C(z) cos ψ,   w = a ω S(z) sin ψ,   C = cosh k(z + h)/sinh kh,   S = sinh k(z + h)/sinh kh,
//!
//! u along θ, w upwards; the accelerations are ∂/∂t of these, as the theory is linear. The argument is stretched after Wheeler, above and below z =
//! 0: z' = h (z − η)/(h + η) with the elevation η of all components (deep water: z − η). The water at the surface therefore moves as the linear
//! theory predicts at z = 0. A point above η moves as the water at η does. The ramp ½(1 − cos πt/t_r) multiplies the amplitudes up to the time t_r;
//! its rate contributes to the accelerations.
//!
//! The motion at a position is the sum over the components that reach it. With A = a ω² e^{kz}, the acceleration of a component there in deep water,
//! and R = √Σ(aω²)², the components of highest frequency that all have A < 10⁻⁴ R/√N are left out. Together they contribute less than 10⁻⁴ of the
//! acceleration at the surface. This test takes z three standard deviations of the elevation too high, to allow for the troughs. The elevation that
//! stretches z excludes the components of highest frequency whose √Σa² times √Σ(k aω² e^{kz})² is below 10⁻⁴ R; near the surface it includes all
//! components.
//!
//! Between two instants no further apart than [`Waves::interval_below`], velocity, acceleration and elevation are cubics in time with the slopes at
//! both instants, [`Orbit::between`]. The error of such a cubic is h⁴f⁗/384. The interval h = (384·10⁻³ √Σ(aω²)²/√Σ(aω⁶)²)^¼ keeps it below 10⁻³ of
//! the acceleration. The stretching adds an error of the slopes, of the order of (ka)². Positions are extrapolated over an interval. h is therefore also at most half of √Σ(aω)²/√Σ(aω²)², a twelfth of the period of a single wave, and at most 2 s. Here a is the
//! amplitude at the highest position, a e^{kz} with z again three standard deviations too high: short waves, which change fastest, do not reach lines
//! that hang from a deep fairlead.
//!
//! Source: Airy (1845) as in Dean & Dalrymple (1991), Water Wave Mechanics for Engineers and Scientists, chapter 3; Wheeler (1970), J. Petroleum
//! Technology 22(3), 359-367. Valid for ka ≪ 1. The dispersion relation is solved by Newton's method from the guess k = ω²/g · (1 −
//! exp(−(ω²h/g)^(5/4)))^(−2/5) (Guo, 2002, Coastal Engineering 45, 71-74), which is accurate to 0.75 %.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::math::elementary::{exp, sin_cos};
use crate::math::hermite::Hermite;
use crate::math::lanes::{LANES, Lanes, Vectors};

/// Maximum number of Newton steps for the dispersion relation [-]; three suffice from a guess accurate to 1 %.
const NEWTON_STEPS_MAX: usize = 20;
/// Maximum acceleration of all omitted components together, relative to that at the surface [-].
const REACH: f64 = 1e-4;
/// Depth of the troughs that the omission of components allows for, in standard deviations of the elevation [-].
const TROUGH: f64 = 3.0;
/// Maximum error of the cubics between two instants, relative to the acceleration [-].
const BETWEEN: f64 = 1e-3;
/// Maximum time between two instants [s].
const INTERVAL_MAX: f64 = 2.0;
/// Maximum depth of a trough relative to the water depth [-]: the seabed does not fall dry.
const TROUGH_MAX: f64 = 0.9;

/// One wave train.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component {
    /// Amplitude, half the height [m].
    pub amplitude: f64,
    /// Circular frequency ω [rad/s].
    pub frequency: f64,
    /// Direction of travel, from x towards y [rad].
    pub direction: f64,
    /// Phase φ [rad].
    pub phase: f64,
}

/// Motion of the water at a position due to the waves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Orbit {
    /// Velocity [m/s].
    pub velocity: Vector3<f64>,
    /// Acceleration ∂u/∂t [m/s²].
    pub acceleration: Vector3<f64>,
    /// Rate of the acceleration ∂²u/∂t² [m/s³].
    pub jerk: Vector3<f64>,
    /// Elevation of the surface at x and y of the position [m], by the components that stretch its height; near the surface these are all.
    pub elevation: f64,
    /// Rate of the elevation [m/s], by the components that reach the position; near the surface these are all.
    pub rise: f64,
}

impl Orbit {
    /// Motion at time `t` [s] between two instants `t0` and `t1` [s], by cubics with the slopes at both; `before` if the instants coincide.
    pub fn between(before: &Orbit, after: &Orbit, [t0, t1]: [f64; 2], t: f64) -> Orbit {
        if t1 <= t0 {
            return *before;
        }
        let cubic = |p0, m0, p1, m1| Hermite::new((t0, p0, m0), (t1, p1, m1)).at(t);
        let mut orbit = Orbit::default();
        for i in 0..3 {
            let [a0, a1] = [before.acceleration[i], after.acceleration[i]];
            orbit.velocity[i] = cubic(before.velocity[i], a0, after.velocity[i], a1).value;
            let acceleration = cubic(a0, before.jerk[i], a1, after.jerk[i]);
            (orbit.acceleration[i], orbit.jerk[i]) = (acceleration.value, acceleration.slope);
        }
        let surface = cubic(before.elevation, before.rise, after.elevation, after.rise);
        (orbit.elevation, orbit.rise) = (surface.value, surface.slope);
        orbit
    }
}

/// Coefficients of the powers of u = (t − t₀)/(t₁ − t₀) in the velocity [m/s] and the acceleration [m/s²] between two instants.
pub fn cubics(before: &Orbit, after: &Orbit, [t0, t1]: [f64; 2]) -> [[Vector3<f64>; 4]; 2] {
    let cubic = |[p0, m0]: [Vector3<f64>; 2], [p1, m1]: [Vector3<f64>; 2]| {
        let (m0, m1, rise) = ((t1 - t0) * m0, (t1 - t0) * m1, p1 - p0);
        [p0, m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise]
    };
    [
        cubic(
            [before.velocity, before.acceleration],
            [after.velocity, after.acceleration],
        ),
        cubic(
            [before.acceleration, before.jerk],
            [after.acceleration, after.jerk],
        ),
    ]
}

/// Sum of wave trains.
#[derive(Debug, Clone, PartialEq)]
pub struct Waves {
    /// Components in ascending order of frequency.
    components: Vec<Component>,
    /// Constants of the components at the water depth.
    trains: Vec<Train>,
    depth: Option<f64>,
    ramp: Option<f64>,
    /// Heights [m], from 0 downwards, and the maximum time between two instants for positions below each [s].
    intervals: Vec<[f64; 2]>,
}

/// Constants of a component at the water depth.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Train {
    /// Amplitude a [m].
    amplitude: f64,
    /// ω [rad/s].
    frequency: f64,
    /// k [1/m].
    number: f64,
    /// cos θ and sin θ [-].
    heading: [f64; 2],
    /// q = e^{−2kh} [-], 0 in deep water.
    seabed: f64,
    /// 1/(1 − q) [-].
    whole: f64,
    /// Height below which this component and those after it are left out of the motion [m].
    reach: f64,
    /// Height below which this component and those after it are left out of the elevation that stretches z [m].
    stretch: f64,
}

impl Train {
    fn new(component: &Component, number: f64, depth: Option<f64>, [reach, stretch]: [f64; 2]) -> Train {
        Train {
            amplitude: component.amplitude,
            frequency: component.frequency,
            number,
            heading: [component.direction.cos(), component.direction.sin()],
            seabed: depth.map_or(0.0, |h| (-2.0 * number * h).exp()),
            whole: depth.map_or(1.0, |h| -1.0 / (-2.0 * number * h).exp_m1()),
            reach,
            stretch: stretch.min(reach),
        }
    }

    /// k cos θ and k sin θ [1/m].
    #[inline(always)]
    fn vector(&self) -> [f64; 2] {
        self.heading.map(|part| self.number * part)
    }

    /// cosh k(z + h)/sinh kh and sinh k(z + h)/sinh kh [-] at four heights: (E ± q/E)/(1 − q) with E = e^{kz}, q = e^{−2kh}.
    #[inline(always)]
    fn decay(&self, z: Lanes) -> [Lanes; 2] {
        let grown = exp(Lanes::splat(self.number) * z);
        if self.seabed == 0.0 {
            return [grown; 2];
        }
        let mirrored = Lanes::splat(self.seabed) * grown.recip();
        let whole = Lanes::splat(self.whole);
        [(grown + mirrored) * whole, (grown - mirrored) * whole]
    }
}

/// State of the waves at one time, common to all positions, with workspace for four positions.
#[derive(Debug, Clone, Default)]
pub struct Instant {
    /// Time [s]; `None` until it is set.
    time: Option<f64>,
    /// −ωt + φ of the components, between 0 and 2π [rad].
    turn: Vec<f64>,
    /// Factor of the ramp [-], with its first [1/s] and second derivative [1/s²].
    growth: [f64; 3],
    /// sin ψ and cos ψ of the components at four positions.
    phase: Vec<[Lanes; 2]>,
}

/// Wave number k [1/m] at a circular frequency ω > 0 [rad/s] in water of a depth [m], deep water if `None`, under gravity [m/s²].
pub fn wave_number(frequency: f64, depth: Option<f64>, gravity: f64) -> f64 {
    let deep = frequency * frequency / gravity;
    let Some(depth) = depth else { return deep };
    let mu = deep * depth; // ω²h/g = κ tanh κ
    let mut kappa = mu * (-(-mu.powf(1.25)).exp_m1()).powf(-0.4);
    for _ in 0..NEWTON_STEPS_MAX {
        let tanh = kappa.tanh();
        let step = (kappa * tanh - mu) / (tanh + kappa * (1.0 - tanh * tanh));
        kappa -= step;
        if step.abs() <= 4.0 * f64::EPSILON * kappa {
            break;
        }
    }
    kappa / depth
}

impl Waves {
    /// Wave trains in water of a depth [m], deep water if `None`, under gravity [m/s²], whose amplitudes grow over a ramp [s].
    pub fn new(components: &[Component], depth: Option<f64>, ramp: Option<f64>, gravity: f64) -> Waves {
        let mut components = components.to_vec();
        components.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        let number = |c: &Component| wave_number(c.frequency, depth, gravity);
        let numbers: Vec<f64> = components.iter().map(number).collect();
        let heights = reach(&components, &numbers)
            .into_iter()
            .zip(stretch(&components, &numbers));
        let constants = components.iter().zip(&numbers).zip(heights);
        let train = |((c, k), (reach, stretch)): ((&Component, &f64), (f64, f64))| {
            Train::new(c, *k, depth, [reach, stretch])
        };
        Waves {
            trains: constants.map(train).collect(),
            intervals: intervals(&components, &numbers),
            components,
            depth,
            ramp,
        }
    }

    /// Components in ascending order of frequency.
    pub fn components(&self) -> &[Component] {
        &self.components
    }

    /// Maximum time between two instants that cubics may bridge [s], for positions at a height [m] and below.
    pub fn interval_below(&self, z: f64) -> f64 {
        let above = self.intervals.partition_point(|[height, _]| *height >= z);
        self.intervals[above.saturating_sub(1)][1]
    }

    /// Standard deviation of the elevation once the ramp has passed [m].
    pub fn deviation(&self) -> f64 {
        deviation(&self.components)
    }

    /// Number of components [-], from the lowest frequency, that move the water at a height [m].
    pub fn reaching(&self, z: f64) -> usize {
        self.trains.partition_point(|train| train.reach <= z)
    }

    /// Moves the instant to a time [s].
    pub fn turn_to(&self, t: f64, instant: &mut Instant) {
        if instant.time.replace(t) == Some(t) {
            return;
        }
        let turn = |c: &Component| (c.phase - c.frequency * t).rem_euclid(TAU);
        instant.turn.clear();
        instant.turn.extend(self.components.iter().map(turn));
        instant.growth = self.growth(t);
    }

    /// Elevation of the surface [m] at x, y [m] and time t [s].
    pub fn elevation(&self, x: f64, y: f64, t: f64) -> f64 {
        let train = |(train, c): (&Train, &Component)| {
            let [along, across] = train.vector();
            c.amplitude * (along * x + across * y - c.frequency * t + c.phase).cos()
        };
        let trains = self.trains.iter().zip(&self.components);
        self.growth(t)[0] * trains.map(train).sum::<f64>()
    }

    /// Motion of the water at a position [m] and time t [s]; above the surface, that of the surface.
    pub fn orbit(&self, place: Vector3<f64>, t: f64) -> Orbit {
        let mut instant = Instant::default();
        self.turn_to(t, &mut instant);
        let [orbit, ..] = self.orbits([place; LANES], &mut instant);
        orbit
    }

    /// Motion of the water at four positions [m] and an instant; above the surface, that of the surface. No result depends on the other positions.
    #[inline(always)]
    pub fn orbits(&self, places: [Vector3<f64>; LANES], instant: &mut Instant) -> [Orbit; LANES] {
        let heights = places.iter().map(|place| place.z);
        let highest = heights.fold(f64::NEG_INFINITY, f64::max);
        let count = self.reaching(highest);
        let stretched = self.trains.partition_point(|train| train.stretch <= highest);
        let places = Vectors::new(places);
        let raised = self.raised(&places, stretched, instant);
        let [growth, rate, bend] = instant.growth.map(Lanes::splat);
        let elevation = growth * raised;
        let sums = self.sums([places.z, self.stretched(places.z, elevation)], count, instant);
        let [velocity, acceleration, jerk] = sums.rates;
        let grown = [
            velocity.scale(growth),
            acceleration.scale(growth) + velocity.scale(rate),
            jerk.scale(growth) + acceleration.scale(rate + rate) + velocity.scale(bend),
        ];
        let rise = growth * sums.rise + rate * raised;
        apart(&grown, &[elevation, rise])
    }

    /// Heights stretched after Wheeler under an elevation [m], between the seabed and 0.
    #[inline(always)]
    fn stretched(&self, z: Lanes, elevation: Lanes) -> Lanes {
        let still = Lanes::splat(0.0);
        let Some(depth) = self.depth else {
            return (z - elevation).min(still);
        };
        let depth = Lanes::splat(depth);
        let seabed = still - depth;
        let surface = elevation.max(seabed * Lanes::splat(TROUGH_MAX));
        let stretched = depth * (z - surface) * (depth + surface).recip();
        stretched.max(seabed).min(still)
    }

    /// Elevation [m] at four positions by the first `stretched` components, without the ramp; stores their sines and cosines in the instant.
    #[inline(always)]
    fn raised(&self, places: &Vectors, stretched: usize, instant: &mut Instant) -> Lanes {
        instant.phase.clear();
        let mut sum = Lanes::splat(0.0);
        for (train, turn) in self.trains[..stretched].iter().zip(&instant.turn) {
            let [east, north] = train.vector().map(Lanes::splat);
            let (sine, cosine) = sin_cos(places.x * east + places.y * north + Lanes::splat(*turn));
            sum = sum + above(places.z, train.stretch, train.amplitude) * cosine;
            instant.phase.push([sine, cosine]);
        }
        sum
    }

    /// Sums over the first `count` components at four heights [m], given unstretched and stretched, without the ramp.
    #[inline(always)]
    fn sums(&self, [height, z]: [Lanes; 2], count: usize, instant: &Instant) -> Sums {
        let mut sums = Sums {
            rates: [Vectors::zero(); 3],
            rise: Lanes::splat(0.0),
        };
        for (train, [sine, cosine]) in self.trains[..count].iter().zip(&instant.phase) {
            let speed = above(height, train.reach, train.amplitude * train.frequency);
            let [level, upward] = train.decay(z).map(|decay| speed * decay);
            let [east, north] = train.heading.map(|part| level * Lanes::splat(part));
            // u ~ cos ψ and w ~ sin ψ, with their first two derivatives
            let [omega, back] = [train.frequency, -train.frequency].map(Lanes::splat);
            let once = [omega * *sine, back * *cosine];
            let twice = [omega * once[1], back * once[0]];
            for (sum, [along, across]) in sums.rates.iter_mut().zip([[*cosine, *sine], once, twice]) {
                sum.x = sum.x + east * along;
                sum.y = sum.y + north * along;
                sum.z = sum.z + upward * across;
            }
            sums.rise = sums.rise + speed * *sine;
        }
        sums
    }

    /// ½(1 − cos πt/t_r), with its first two derivatives.
    fn growth(&self, t: f64) -> [f64; 3] {
        match self.ramp {
            Some(ramp) if t < ramp => {
                let speed = PI / ramp;
                let (sin, cos) = (speed * t.max(0.0)).sin_cos();
                [0.5 * (1.0 - cos), 0.5 * speed * sin, 0.5 * speed * speed * cos]
            }
            _ => [1.0, 0.0, 0.0],
        }
    }
}

/// `value` where a height z is at least a limit [m], else 0.
#[inline(always)]
fn above(z: Lanes, limit: f64, value: f64) -> Lanes {
    (Lanes::splat(limit) - z).choose(Lanes::splat(0.0), Lanes::splat(value))
}

/// Motion at each of four positions. Not inlined: the compiler would otherwise vectorise the loops before it at half the width, to suit the unpacking
/// of the lanes.
#[inline(never)]
fn apart(rates: &[Vectors; 3], [elevation, rise]: &[Lanes; 2]) -> [Orbit; LANES] {
    std::array::from_fn(|lane| {
        let [velocity, acceleration, jerk] = rates.each_ref().map(|vectors| vectors.get(lane));
        Orbit {
            velocity,
            acceleration,
            jerk,
            elevation: elevation[lane],
            rise: rise[lane],
        }
    })
}

/// Sums over components at four positions, without the ramp.
struct Sums {
    /// Velocity [m/s] with its first two derivatives.
    rates: [Vectors; 3],
    /// Rate of the elevation [m/s].
    rise: Lanes,
}

/// √Σ(aωⁿ)², √2 times a standard deviation.
fn root(components: &[Component], power: i32) -> f64 {
    let square = |c: &Component| (c.amplitude * c.frequency.powi(power)).powi(2);
    components.iter().map(square).sum::<f64>().sqrt()
}

/// Standard deviation of the elevation [m].
fn deviation(components: &[Component]) -> f64 {
    root(components, 0) / 2.0_f64.sqrt()
}

fn interval(components: &[Component]) -> f64 {
    let acceleration = root(components, 2);
    if acceleration == 0.0 {
        return INTERVAL_MAX;
    }
    let smooth = (384.0 * BETWEEN * acceleration / root(components, 6)).powf(0.25);
    let near = 0.5 * root(components, 1) / acceleration;
    smooth.min(near).min(INTERVAL_MAX)
}

/// Ratio of successive depths at which intervals are evaluated [-]; the first follows from the shortest wave.
const INTERVAL_DEEPER: f64 = 1.5;
/// Number of heights [-].
const INTERVAL_HEIGHTS: i32 = 24;

/// Heights [m], and the maximum times between two instants for positions below each [s].
fn intervals(components: &[Component], numbers: &[f64]) -> Vec<[f64; 2]> {
    let margin = TROUGH * deviation(components);
    let shortest = numbers.last().copied().unwrap_or(1.0);
    let depths = (0..INTERVAL_HEIGHTS).map(|step| INTERVAL_DEEPER.powi(step) / shortest);
    let rows = std::iter::once(0.0).chain(depths.map(|depth| -margin - 0.1 * depth));
    rows.map(|z| {
        let calmer = |(c, k): (&Component, &f64)| Component {
            amplitude: c.amplitude * (k * (z + margin).min(0.0)).exp(),
            ..*c
        };
        let there: Vec<Component> = components.iter().zip(numbers).map(calmer).collect();
        [z, interval(&there)]
    })
    .collect()
}

/// For every component, the height below which it and those after it are left out of the motion [m].
fn reach(components: &[Component], numbers: &[f64]) -> Vec<f64> {
    let least = REACH * root(components, 2) / (components.len() as f64).sqrt();
    let margin = TROUGH * deviation(components);
    let of = |(c, k): (&Component, &f64)| {
        let most = c.amplitude.abs() * c.frequency * c.frequency;
        match most > 0.0 {
            true => ((least / most).ln() / k - margin).min(0.0),
            false => 0.0,
        }
    };
    let mut heights: Vec<f64> = components.iter().zip(numbers).map(of).collect();
    for j in (1..heights.len()).rev() {
        heights[j - 1] = heights[j - 1].min(heights[j]);
    }
    heights
}

/// Ratio of successive depths tried for the elevation that stretches z [-].
const DEEPER: f64 = 1.15;
/// Number of heights [-]; the deepest is 2e5 times as deep as the first.
const HEIGHTS: usize = 88;

/// For every component, the height below which it and those after it are left out of the elevation that stretches z [m].
fn stretch(components: &[Component], numbers: &[f64]) -> Vec<f64> {
    let least = REACH * root(components, 2);
    let margin = TROUGH * deviation(components);
    let Some(longest) = numbers.first() else {
        return Vec::new();
    };
    let first = 1e-4 / longest;
    let mut slopes = Vec::with_capacity(HEIGHTS); // √Σ(k aω² e^{kz})², falling [1/s²]
    for height in 0..HEIGHTS {
        let z = -first * DEEPER.powi(height as i32);
        let square =
            |(c, k): (&Component, &f64)| (k * c.amplitude * c.frequency.powi(2) * (k * z).exp()).powi(2);
        let squares = components.iter().zip(numbers).map(square);
        slopes.push((z - margin, squares.sum::<f64>().sqrt()));
    }
    let mut heights = vec![0.0; components.len()];
    let mut tail = 0.0;
    for (height, component) in heights.iter_mut().zip(components).rev() {
        tail += component.amplitude.powi(2);
        let deep = slopes.partition_point(|(_, slope)| slope * f64::sqrt(tail) > least);
        *height = slopes.get(deep).map_or(f64::NEG_INFINITY, |(z, _)| *z);
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const GRAVITY: f64 = 9.80665;

    fn sea(depth: Option<f64>) -> Waves {
        let component = |amplitude, frequency, direction, phase| Component {
            amplitude,
            frequency,
            direction,
            phase,
        };
        let components = [
            component(1e-4, 0.6, 0.3, 0.2),
            component(5e-5, 1.1, -0.9, 2.0),
            component(8e-5, 0.35, 2.0, -1.0),
        ];
        Waves::new(&components, depth, None, GRAVITY)
    }

    #[test]
    fn the_wave_number_satisfies_the_dispersion_relation_from_shallow_to_deep() {
        for depth in [0.1, 1.0, 20.0, 200.0, 5000.0] {
            for frequency in [1e-4, 0.01, 0.1, 0.5, 1.0, 3.0, 20.0] {
                let k = wave_number(frequency, Some(depth), GRAVITY);
                let found = GRAVITY * k * (k * depth).tanh();
                assert_relative_eq!(found, frequency * frequency, max_relative = 1e-13);
            }
        }
        let shallow = wave_number(1e-3, Some(2.0), GRAVITY);
        assert_relative_eq!(shallow, 1e-3 / (GRAVITY * 2.0).sqrt(), max_relative = 1e-6);
        assert_relative_eq!(wave_number(2.0, None, GRAVITY), 4.0 / GRAVITY);
    }

    /// Velocity by the equations as written, component by component.
    fn written_out(waves: &Waves, place: Vector3<f64>, t: f64) -> Vector3<f64> {
        let angle = |c: &Component, k: f64| {
            let way = place.x * c.direction.cos() + place.y * c.direction.sin();
            k * way - c.frequency * t + c.phase
        };
        let trains: Vec<(Component, f64)> = waves
            .components
            .iter()
            .map(|c| (*c, wave_number(c.frequency, waves.depth, GRAVITY)))
            .collect();
        let elevation: f64 = trains.iter().map(|(c, k)| c.amplitude * angle(c, *k).cos()).sum();
        let h = waves.depth.unwrap_or(1e4);
        let z = h * (place.z - elevation) / (h + elevation);
        let velocity = |(c, k): &(Component, f64)| {
            let decay = |f: fn(f64) -> f64| f(k * (z + h)) / (k * h).sinh();
            let [level, upward] = match k * h < 20.0 {
                true => [decay(f64::cosh), decay(f64::sinh)],
                false => [(k * z).exp(); 2],
            };
            let along = Vector3::new(c.direction.cos(), c.direction.sin(), 0.0);
            let (sin, cos) = angle(c, *k).sin_cos();
            c.amplitude * c.frequency * (level * cos * along + upward * sin * Vector3::z())
        };
        trains.iter().map(velocity).sum()
    }

    /// Sea of many components with a significant height.
    fn storm(depth: Option<f64>) -> Waves {
        let component = |i: u32| Component {
            amplitude: 0.4,
            frequency: 0.3 + 0.05 * f64::from(i),
            direction: 0.1 * f64::from(i),
            phase: f64::from(i * i),
        };
        let components: Vec<Component> = (0..30).map(component).collect();
        Waves::new(&components, depth, None, GRAVITY)
    }

    #[test]
    fn the_water_moves_as_the_sum_of_the_components_says() {
        for depth in [Some(12.0), Some(60.0), None] {
            let waves = storm(depth);
            for (x, z, t) in [(0.0, -1.0, 0.0), (40.0, -5.0, 13.0), (-300.0, -11.9, 777.0)] {
                let place = Vector3::new(x, 0.7 * x, z);
                let expected = written_out(&waves, place, t);
                let found = waves.orbit(place, t).velocity;
                let error = (found - expected).norm();
                assert!(error < 1e-4 * expected.norm(), "{depth:?}, z = {z} m: {error:e}");
            }
        }
    }

    #[test]
    fn small_waves_keep_the_volume_of_the_water_and_do_not_turn_it() {
        for depth in [Some(30.0), None] {
            let (waves, place, t, d) = (sea(depth), Vector3::new(3.0, -7.0, -8.0), 4.0, 1e-2);
            let slope = |axis: usize| {
                let mut step = Vector3::zeros();
                step[axis] = d;
                let at = |r| waves.orbit(r, t).velocity;
                (at(place + step) - at(place - step)) / (2.0 * d)
            };
            let [x, y, z] = [slope(0), slope(1), slope(2)];
            // the contribution of stretching is of second order in the amplitude
            assert!((x.x + y.y + z.z).abs() < 1e-3 * x.norm());
            assert!((z.x - x.z).abs() < 1e-3 * x.norm() && (x.y - y.x).abs() < 1e-3 * x.norm());
        }
    }

    #[test]
    fn the_surface_rises_as_fast_as_the_water_and_nothing_crosses_the_seabed() {
        let waves = sea(Some(30.0));
        let (x, y, t, d) = (5.0, 2.0, 7.0, 1e-3);
        let surface = waves.elevation(x, y, t);
        let rise = (waves.elevation(x, y, t + d) - waves.elevation(x, y, t - d)) / (2.0 * d);
        let water = waves.orbit(Vector3::new(x, y, surface), t);
        assert_relative_eq!(water.velocity.z, rise, max_relative = 1e-6);
        assert_relative_eq!(water.rise, rise, max_relative = 1e-6);
        assert_relative_eq!(water.elevation, surface, max_relative = 1e-12);
        let seabed = waves.orbit(Vector3::new(x, y, -30.0), t);
        assert!(seabed.velocity.z.abs() < 1e-11 * seabed.velocity.x.abs());
        let above = waves.orbit(Vector3::new(x, y, surface + 9.0), t);
        assert_eq!(above, water);
    }

    #[test]
    fn the_acceleration_is_the_rate_of_the_velocity_and_the_jerk_that_of_the_acceleration() {
        for ramp in [None, Some(9.0)] {
            let (mut waves, d) = (sea(None), 1e-3);
            waves.ramp = ramp;
            let at = |t| waves.orbit(Vector3::new(3.0, -7.0, -8.0), t);
            let (before, now, after) = (at(4.0 - d), at(4.0), at(4.0 + d));
            let rate = (after.velocity - before.velocity) / (2.0 * d);
            assert!((rate - now.acceleration).norm() < 1e-4 * rate.norm());
            let rate = (after.acceleration - before.acceleration) / (2.0 * d);
            assert!((rate - now.jerk).norm() < 1e-4 * rate.norm());
            let rise = (after.elevation - before.elevation) / (2.0 * d);
            assert_relative_eq!(rise, now.rise, max_relative = 1e-4);
        }
    }

    #[test]
    fn cubics_bridge_the_interval_to_a_thousandth_of_the_acceleration() {
        let waves = sea(None);
        let place = Vector3::new(3.0, -7.0, -12.0);
        let (mut worst, mut square) = (0.0_f64, 0.0);
        let steps = 400;
        for step in 0..steps {
            let [t0, t1] = [0, 1].map(|k| f64::from(step + k) * waves.interval_below(place.z));
            let (before, after) = (waves.orbit(place, t0), waves.orbit(place, t1));
            let middle = 0.5 * (t0 + t1);
            let exact = waves.orbit(place, middle);
            let found = Orbit::between(&before, &after, [t0, t1], middle);
            worst = worst.max((found.acceleration - exact.acceleration).norm_squared());
            square += exact.acceleration.norm_squared();
            let start = Orbit::between(&before, &after, [t0, t1], t0);
            assert_eq!(start.velocity, before.velocity);
            assert_eq!(start.acceleration, before.acceleration);
        }
        assert!(worst.sqrt() < 4e-3 * (square / f64::from(steps)).sqrt());
    }

    #[test]
    fn deeper_places_are_bridged_for_longer_with_no_more_error() {
        let mut components = storm(None).components;
        let small = |c: &mut Component| c.amplitude *= 1e-4; // stretching is of second order
        components.iter_mut().for_each(small);
        let waves = Waves::new(&components, None, None, GRAVITY);
        let heights = [-0.0, -1.0, -4.0, -12.0, -50.0, -2000.0];
        let intervals = heights.map(|z| waves.interval_below(z));
        assert!(intervals.is_sorted());
        assert_relative_eq!(intervals[5], 0.5 / 0.3, max_relative = 1e-2); // the longest wave alone
        assert!(intervals[3] > 1.3 * intervals[0], "{intervals:?}");
        for (z, interval) in heights.into_iter().zip(intervals).take(5) {
            let at = |t: f64| waves.orbit(Vector3::new(4.0, 9.0, z), t);
            let (mut error, mut square) = (0.0, 0.0);
            for step in 0..4000 {
                let times = [0.7, 1.7].map(|k| 7.3 * f64::from(step) + k * interval);
                let middle = 0.5 * (times[0] + times[1]);
                let (found, exact) = (
                    Orbit::between(&at(times[0]), &at(times[1]), times, middle),
                    at(middle),
                );
                error += (found.acceleration - exact.acceleration).norm_squared();
                square += exact.acceleration.norm_squared();
            }
            let error = f64::sqrt(error / square);
            assert!(error < 1.2 * BETWEEN, "z = {z} m: {error:e}");
        }
    }

    #[test]
    fn components_left_out_at_a_depth_would_move_it_by_a_ten_thousandth() {
        let waves = storm(None);
        let surface = root(&waves.components, 2);
        for z in [-2.0, -10.0, -40.0, -150.0] {
            let rest = &waves.components[waves.reaching(z)..];
            let left_out = rest.iter().map(|c| {
                let k = wave_number(c.frequency, None, GRAVITY);
                (c.amplitude * c.frequency.powi(2) * (k * z).exp()).powi(2)
            });
            assert!(left_out.sum::<f64>().sqrt() < 1e-4 * surface, "z = {z} m");
        }
        assert_eq!(waves.reaching(0.0), 30);
        assert!((1..15).contains(&waves.reaching(-150.0)));
        let still = waves.orbit(Vector3::new(0.0, 0.0, -5000.0), 3.0);
        assert_eq!(still.acceleration, Vector3::zeros());
    }

    #[test]
    fn the_motion_at_a_place_does_not_depend_on_the_places_beside_it() {
        for depth in [Some(60.0), None] {
            let waves = storm(depth);
            let places = [-1.0, -59.0, -12.0, -31.0].map(|z| Vector3::new(3.0 * z, -z, z));
            let mut instant = Instant::default();
            waves.turn_to(9.0, &mut instant);
            let together = waves.orbits(places, &mut instant);
            assert_eq!(together, places.map(|place| waves.orbit(place, 9.0)));
        }
    }

    #[test]
    fn elevations_left_out_of_the_stretching_move_a_place_by_a_ten_thousandth() {
        let mut waves = storm(None);
        let surface = root(&waves.components, 2);
        let places = [-1.0, -5.0, -20.0, -60.0, -140.0].map(|z| Vector3::new(12.0, 5.0, z));
        let found = places.map(|place| waves.orbit(place, 8.0).acceleration);
        let felt = |z: f64| waves.trains.partition_point(|train| train.stretch <= z);
        assert!((1..400).any(|depth| (1..30).contains(&felt(f64::from(-depth)))));
        assert!(waves.trains.iter().all(|train| train.stretch < -1.0));
        for train in &mut waves.trains {
            train.stretch = f64::NEG_INFINITY;
        }
        for (place, found) in places.into_iter().zip(found) {
            let all = waves.orbit(place, 8.0).acceleration;
            assert!((all - found).norm() < 1e-4 * surface, "z = {} m", place.z);
        }
    }

    #[test]
    fn a_ramp_grows_from_rest_to_the_full_sea() {
        let mut waves = sea(Some(30.0));
        let full = waves.elevation(1.0, 2.0, 50.0);
        waves.ramp = Some(20.0);
        assert_eq!(waves.elevation(1.0, 2.0, 0.0), 0.0);
        assert_eq!(waves.elevation(1.0, 2.0, 50.0), full);
        assert_relative_eq!(waves.growth(10.0)[0], 0.5);
    }
}
