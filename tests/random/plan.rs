//! Plan of a scene: choices that all its parts share.

use moorline::scene::{AXIAL_RADIUS_MIN, Bossak, Integrator, Reconstruction, Solver, Threads, ToleranceOf};

use crate::dice::{Dice, Tape};
use crate::surroundings;

/// Parts of the tape, named by the objects drawn from them.
pub mod part {
    pub const PLAN: usize = 0;
    pub const SOLVER: usize = 1;
    pub const WATER: usize = 2;
    pub const SEABED: usize = 3;
    pub const TOPS: usize = 4;
    pub const DRIVE: usize = 5;
    pub const TYPES: usize = 8;
    pub const MOTIONS: usize = 12;
    pub const JUNCTIONS: usize = 20;
    pub const LINES: usize = 30;
}

/// Deformations that lines resist.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resists {
    Stretch,
    Bending,
    Torsion,
}

/// Axial law of lines whose tension is proportional to strain.
const PROPORTIONAL: usize = 0;

/// Choices that all parts of a scene share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// Share of numbers drawn from the whole legal range [-].
    pub wild: f64,
    /// Approximate extent and depth of the scene [m].
    pub size: f64,
    /// Gravity [m/s²].
    pub gravity: f64,
    pub integrator: Integrator,
    pub resists: Resists,
    pub wet: bool,
    pub seabed: bool,
    /// Number of the axial law shared by all line types; `None` if each has its own. Viscoelastic ropes and explicitly integrated lines
    /// share one.
    pub law: Option<usize>,
    /// Poisson's ratio of logarithmic strain [-].
    pub poisson: f64,
    /// True if lines are on winches.
    pub winch: bool,
    /// True if there are free points.
    pub junctions: bool,
    /// True if lines break or are released.
    pub parts: bool,
}

impl Plan {
    /// Returns the plan of a tape.
    pub fn of(tape: &Tape) -> Plan {
        let mut dice = tape.part(part::PLAN, 0.0);
        let wild = dice.pick(&[0.0, 0.0, 0.02, 0.1]);
        let gravity = surroundings::gravity(&mut tape.part(part::WATER, wild));
        let mut integrator = dice.pick(&[
            Integrator::Auto,
            Integrator::Auto,
            Integrator::Auto,
            Integrator::Leapfrog,
            Integrator::AxialImplicit,
            Integrator::GeneralisedAlpha,
            Integrator::Bossak,
            Integrator::QuasiStatic,
        ]);
        let implicit = !matches!(integrator, Integrator::Leapfrog | Integrator::AxialImplicit);
        let resists = match dice.whole(0, 9) {
            8 => Resists::Bending,
            9 => {
                integrator = dice.pick(&[Integrator::Beam, Integrator::Auto]);
                Resists::Torsion
            }
            _ => Resists::Stretch,
        };
        let plain = resists == Resists::Stretch;
        let winch =
            dice.chance(0.12) && plain && matches!(integrator, Integrator::Auto | Integrator::Leapfrog);
        let alike = resists == Resists::Torsion || !implicit || dice.chance(0.7);
        let law = dice.whole(0, 9);
        Plan {
            wild,
            law: match resists {
                Resists::Bending if !implicit => Some(PROPORTIONAL),
                _ => (alike || law == 9).then_some(law),
            },
            poisson: dice.between(0.0, 0.5),
            size: dice.log(5.0, 2000.0),
            gravity,
            integrator,
            resists,
            wet: dice.chance(0.75),
            seabed: dice.chance(0.7),
            winch,
            junctions: dice.chance(0.4),
            parts: plain && integrator != Integrator::QuasiStatic && dice.chance(0.2),
        }
    }

    /// Returns the dice of a part of a tape.
    pub fn dice<'t>(&self, tape: &'t Tape, part: usize) -> Dice<'t> {
        tape.part(part, self.wild)
    }

    /// Returns whether the scene specifies a leapfrog.
    pub fn is_leapfrog(&self) -> bool {
        matches!(self.integrator, Integrator::Leapfrog | Integrator::AxialImplicit)
    }

    /// Returns the settings of the solver.
    pub fn solver(&self, dice: &mut Dice) -> Solver {
        let radius = match self.integrator {
            Integrator::AxialImplicit => Some(AXIAL_RADIUS_MIN),
            Integrator::GeneralisedAlpha => Some(0.0),
            _ => None,
        };
        let bossak = self.integrator == Integrator::Bossak;
        Solver {
            tolerance: dice.size([0.02, 0.3], [1e-3, 0.5]),
            integrator: self.integrator,
            negative_tension: dice.chance(0.15),
            elements: dice.maybe(0.9, |dice| dice.whole(4, 40)), // otherwise selected by convergence trials
            time_step_max: dice.size([0.05, 0.05], [2e-3, 10.0]),
            spectral_radius: dice
                .maybe(0.4, |dice| dice.between(radius.unwrap_or(0.0), 1.0))
                .filter(|_| radius.is_some()),
            bossak: dice.maybe(0.7, self::bossak).filter(|_| bossak),
            input_reconstruction: match dice.chance(0.2) {
                true => Reconstruction::Jump,
                false => Reconstruction::Smooth,
            },
            threads: match dice.chance(0.2) {
                true => Threads::Number(2),
                false => Threads::Auto,
            },
            tolerance_of: dice.pick(&[
                ToleranceOf::Tension,
                ToleranceOf::Tension,
                ToleranceOf::LowPassedTension,
                ToleranceOf::Position,
            ]),
        }
    }
}

fn bossak(dice: &mut Dice) -> Bossak {
    Bossak {
        alpha: -dice.between(0.0, 1.0 / 3.0),
        gamma: dice.maybe(0.2, |dice| dice.between(0.5, 1.5)),
    }
}
