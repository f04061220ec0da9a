//! Hosts of scenes: the scene's own motion, or step by step, at regular or irregular communication points, with jumps.

use moorline::model::{Body, Motion};
use moorline::scene::{PointKind, Scene};
use moorline::simulation::Simulation;

use crate::dice::{Dice, Tape};
use crate::plan::{Plan, part};

/// Simulated span [s].
pub const SPAN: f64 = 60.0;

/// Inputs of a host.
#[derive(Debug, Clone)]
pub struct Drive {
    /// True if the scene's own motion moves everything.
    pub follows: bool,
    /// Communication steps [s]; their sum is [`SPAN`].
    pub steps: Vec<f64>,
    /// True if the host sets velocities.
    gives_velocity: bool,
    /// Moved bodies and their motions.
    bodies: Vec<(Body, Motion)>,
    /// Time [s] from which all bodies are displaced along x, and the displacement [m].
    jump: Option<[f64; 2]>,
    /// Released lines and their release times [s].
    releases: Vec<(usize, f64)>,
    /// Lines on winches and their final length changes [m].
    winches: Vec<(usize, f64)>,
}

impl Drive {
    /// Returns the host of a tape and its scene.
    pub fn of(tape: &Tape, plan: &Plan, scene: &Scene) -> Drive {
        let mut dice = plan.dice(tape, part::DRIVE);
        let follows = !dice.chance(0.5);
        let points = scene.points.iter().enumerate();
        let coupled = points.filter(|(_, point)| point.kind == PointKind::Coupled && point.on.is_none());
        let points = coupled.map(|(index, point)| (Body::Point(index), &point.name));
        let vessels = scene.vessels.iter().enumerate();
        let vessels = vessels.map(|(index, vessel)| (Body::Vessel(index), &vessel.name));
        let moved = |(body, name): (Body, &String)| Some((body, Motion::new(scene.motion.get(name)?)));
        let winch = |(index, line): (usize, &moorline::scene::Line)| {
            let winch = line.winch.as_ref()?;
            Some((index, 0.9 * winch.length_max))
        };
        let mut drive = Drive {
            follows,
            steps: steps(&mut dice),
            gives_velocity: dice.chance(0.4),
            bodies: points.chain(vessels).filter_map(moved).collect(),
            jump: dice.maybe(0.25, |dice| {
                [dice.between(1.0, SPAN), dice.within(1e-2 * plan.size)]
            }),
            releases: Vec::new(),
            winches: scene.lines.iter().enumerate().filter_map(winch).collect(),
        };
        for (index, line) in scene.lines.iter().enumerate() {
            if line.release.is_some() && dice.chance(0.8) {
                drive.releases.push((index, dice.between(0.0, SPAN)));
            }
        }
        drive
    }

    /// Returns whether communication steps differ.
    pub fn is_irregular(&self) -> bool {
        let inner = &self.steps[..self.steps.len() - 1];
        inner.windows(2).any(|pair| pair[0] != pair[1])
    }

    /// Returns whether a body jumps.
    pub fn jumps(&self) -> bool {
        !self.follows && self.jump.is_some()
    }

    /// Sets the inputs of a simulation at its current time.
    pub fn set_inputs(&self, simulation: &mut Simulation) {
        let time = simulation.time();
        for &(line, at) in &self.releases {
            simulation.set_release(line, time >= at);
        }
        if self.follows {
            return;
        }
        for (body, motion) in &self.bodies {
            let pose = motion.pose(time);
            let mut value: [f64; 6] = pose.value.into();
            if let Some([at, away]) = self.jump
                && time >= at
            {
                value[0] += away;
            }
            let mut rate = [None; 6];
            if self.gives_velocity {
                // angular velocities of a vessel are not the rates of its angles, so they are left to be derived
                (0..3).for_each(|axis| rate[axis] = Some(pose.rate[axis]));
            }
            simulation.set_body(*body, value, rate);
        }
        for &(line, most) in &self.winches {
            simulation.set_length_change(line, most * (time / SPAN).min(1.0));
        }
    }
}

/// Communication steps [s]: equal, or each different.
fn steps(dice: &mut Dice) -> Vec<f64> {
    let usual = dice.log(0.05, 0.5);
    let spread = dice.pick(&[1.0, 1.0, 5.0, 20.0]);
    let (mut steps, mut left) = (Vec::new(), SPAN);
    while left > 0.0 {
        let step = usual * dice.log(1.0 / spread, spread);
        let step = if step > 0.999 * left { left } else { step };
        steps.push(step);
        left -= step;
    }
    steps
}
