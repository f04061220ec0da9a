//! Motions of a run that are given on the command line: a motion file, regular motions, a ramp, a duration.

use std::path::PathBuf;
use std::str::FromStr;

use super::motion_file::{Moves, axis_number, read_moves};
use super::{HarmonicMotion, MotionPath, MotionRow, Point, PointKind, Scene};

/// Motions of a run, in addition to those of its scene. They replace the scene's motion of the same body.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Drive {
    /// CSV file. Columns time [s], x, y, z [m] and optionally roll, pitch, yaw [rad] move the only vessel of the scene, or all coupled points of
    /// a scene without vessels; columns such as `platform.x` move the body that they name.
    pub file: Option<PathBuf>,
    /// Regular motions.
    pub regular: Vec<RegularMotion>,
    /// Duration of the cosine ramp of the regular motions [s]; no ramp if absent.
    pub ramp: Option<f64>,
    /// Duration of the run [s]; by default that of the motion file, otherwise that of the scene.
    pub duration: Option<f64>,
}

/// amplitude·sin(2π t/period + phase) along or about an axis of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct RegularMotion {
    /// Name of a vessel or coupled point.
    pub body: String,
    /// Axis [-], 0 to 5: x, y, z, roll, pitch, yaw.
    pub axis: usize,
    /// Amplitude [m] or [rad].
    pub amplitude: f64,
    /// Period [s].
    pub period: f64,
    /// Phase [rad].
    pub phase: f64,
}

impl FromStr for RegularMotion {
    type Err = String;

    /// Reads `BODY.AXIS=AMPLITUDE,PERIOD` or `BODY.AXIS=AMPLITUDE,PERIOD,PHASE`.
    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = "must be BODY.AXIS=AMPLITUDE,PERIOD[,PHASE] in m, rad and s, such as platform.x=2.5,12";
        let (variable, numbers) = text.split_once('=').ok_or(wanted)?;
        let (body, axis) = variable.trim().rsplit_once('.').ok_or(wanted)?;
        let numbers: Vec<f64> = numbers
            .split(',')
            .map(|number| number.trim().parse::<f64>().map_err(|_| wanted))
            .collect::<Result<_, _>>()?;
        let (amplitude, period, phase) = match numbers[..] {
            [amplitude, period] => (amplitude, period, 0.0),
            [amplitude, period, phase] => (amplitude, period, phase),
            _ => return Err(wanted.into()),
        };
        if !(amplitude.is_finite() && phase.is_finite() && period > 0.0 && period.is_finite()) {
            return Err(format!("{wanted}; the period is positive and all are finite"));
        }
        Ok(RegularMotion {
            body: body.to_string(),
            axis: axis_number(axis).ok_or(wanted)?,
            amplitude,
            period,
            phase,
        })
    }
}

impl Drive {
    /// Returns whether the drive is empty.
    pub fn is_empty(&self) -> bool {
        *self == Drive::default()
    }
}

impl Scene {
    /// Takes motions and the duration from a drive. Returns a description of its motion file as it was read.
    ///
    /// # Errors
    /// The file and line of the mistake, or the body, and the correction.
    pub fn drive(&mut self, drive: &Drive) -> Result<Option<String>, String> {
        let (mut end, mut words) = (None, None);
        let mut taken: Vec<String> = Vec::new();
        if let Some(file) = &drive.file {
            let name = file.display().to_string();
            let moves = read_moves(file, "")?;
            words = Some(format!("motion from {name}, {}", moves.columns));
            for (body, rows) in self.bodies_of(moves, &name)? {
                end = rows.last().map(|row| row[0]);
                self.motion.insert(body.clone(), MotionPath::Table(rows));
                taken.push(body);
            }
        }
        for body in drive.regular.iter().map(|regular| &regular.body) {
            self.must_move(body)?;
            let mut regular = drive.regular.iter();
            let turns = regular.any(|other| other.body == *body && other.axis > 2);
            self.must_turn(body, turns)?;
            if taken.contains(body) {
                return Err(format!(
                    "`{body}` moves by the file already: it cannot move regularly too"
                ));
            }
            let motion = harmonic(&drive.regular, body, drive.ramp);
            self.motion.insert(body.clone(), MotionPath::Harmonic(motion));
        }
        if let Some(duration) = drive.duration.or(end.filter(|end| *end > 0.0)) {
            self.output.duration = duration;
        }
        match self.mistakes().into_iter().next() {
            Some(mistake) => Err(format!("{}: {}", mistake.at, mistake.problem)),
            None => Ok(words),
        }
    }

    /// Bodies that a motion file moves, with their rows.
    fn bodies_of(&self, moves: Moves, file: &str) -> Result<Vec<(String, Vec<MotionRow>)>, String> {
        let known = self.moved_by_a_host();
        let on_line = |problem: String| format!("{file}, line 1: {problem}");
        let mut named = Vec::new();
        for (body, rows) in moves.bodies {
            let Some(body) = body else {
                return self.all_alike(rows, moves.turns).map_err(on_line);
            };
            named.push((body, rows));
        }
        if moves.is_recorded {
            let first = named.first().map(|(body, _)| body.clone());
            named.retain(|(body, _)| known.contains(&body.as_str()));
            if let Some(first) = first.filter(|_| named.is_empty()) {
                self.must_move(&first).map_err(on_line)?;
            }
            let in_order = named.into_iter().map(|(body, rows)| {
                let rows = self.in_own_order(&body, rows);
                (body, rows)
            });
            return Ok(in_order.collect());
        }
        for (body, rows) in &named {
            let turns = rows.iter().any(|row| row[4..] != [0.0; 3]);
            let fits = self.must_move(body).and_then(|()| self.must_turn(body, turns));
            fits.map_err(on_line)?;
        }
        Ok(named)
    }

    /// The only vessel of the scene, or all coupled points of a scene without vessels, each with the same rows.
    fn all_alike(&self, rows: Vec<MotionRow>, turns: bool) -> Result<Vec<(String, Vec<MotionRow>)>, String> {
        let known = self.moved_by_a_host();
        let alike = known.len() == 1 || self.vessels.is_empty();
        if !alike || known.is_empty() {
            return Err(format!(
                "{}: the columns must name what moves, such as {}.x",
                self.movable_in_words(),
                known.first().copied().unwrap_or("platform")
            ));
        }
        if turns && self.vessels.is_empty() {
            let joined = self.joined_in_words("NAME");
            return Err(format!(
                "points do not turn: the header must be \"time,x,y,z\"{joined}"
            ));
        }
        let bodies = known.iter().map(|body| (body.to_string(), rows.clone()));
        Ok(bodies.collect())
    }

    /// Vessels, and coupled points that are not on a vessel.
    pub(super) fn moved_by_a_host(&self) -> Vec<&str> {
        let vessels = self.vessels.iter().map(|vessel| vessel.name.as_str());
        let coupled = |point: &&Point| point.kind == PointKind::Coupled && point.on.is_none();
        let points = self.points.iter().filter(coupled);
        vessels.chain(points.map(|point| point.name.as_str())).collect()
    }

    fn must_move(&self, body: &str) -> Result<(), String> {
        if self.moved_by_a_host().contains(&body) {
            return Ok(());
        }
        Err(format!(
            "`{body}` is no vessel or coupled point: {}{}",
            self.movable_in_words(),
            self.joined_in_words(body)
        ))
    }

    /// Refuses rotations of a point.
    fn must_turn(&self, body: &str, turns: bool) -> Result<(), String> {
        if !turns || self.vessel(body).is_some() {
            return Ok(());
        }
        Err(format!(
            "`{body}` is a point, and points do not turn{}",
            self.joined_in_words("NAME")
        ))
    }

    /// Advice on joining coupled points to one vessel, for a scene without vessels.
    fn joined_in_words(&self, vessel: &str) -> String {
        if !self.vessels.is_empty() || self.moved_by_a_host().is_empty() {
            return String::new();
        }
        format!(
            "; to move the coupled points of a deck as one vessel, use --vessel {vessel} (in a scene, [[vessels]] and `on` of the points)"
        )
    }

    fn movable_in_words(&self) -> String {
        match self.moved_by_a_host()[..] {
            [] => "nothing in the scene can be moved by a host".to_string(),
            [one] => format!("what moves is {one}"),
            ref all => format!("what moves are {}", all.join(", ")),
        }
    }
}

/// Regular motions of one body, in the form of a scene.
fn harmonic(all: &[RegularMotion], body: &str, ramp: Option<f64>) -> HarmonicMotion {
    let mut axes: [Vec<Vec<f64>>; 6] = Default::default();
    for regular in all.iter().filter(|regular| regular.body == body) {
        axes[regular.axis].push(vec![regular.amplitude, regular.period, regular.phase]);
    }
    HarmonicMotion::of(axes, ramp)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_regular_motion_is_an_axis_an_amplitude_a_period_and_perhaps_a_phase() {
        let read: RegularMotion = "my.barge.pitch=0.05,10,1.5".parse().unwrap();
        assert_eq!((read.body.as_str(), read.axis), ("my.barge", 4));
        assert_eq!((read.amplitude, read.period, read.phase), (0.05, 10.0, 1.5));
        let plain: RegularMotion = "fairlead.x=2,12".parse().unwrap();
        assert_eq!(plain.phase, 0.0);
        for wrong in [
            "fairlead.x",
            "fairlead=1,2",
            "fairlead.u=1,2",
            "fairlead.x=1",
            "fairlead.x=1,0",
            "fairlead.x=1,-2",
            "fairlead.x=nan,2",
            "fairlead.x=1,2,3,4",
            "",
        ] {
            assert!(wrong.parse::<RegularMotion>().is_err(), "{wrong}");
        }
    }
}
