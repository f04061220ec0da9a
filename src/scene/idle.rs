//! Keys that are given but have no effect, because of the rest of the scene.

use super::check::rules;
use super::notes::Note;
use super::path::quoted;
use super::table::{Acts, Table};
use super::{
    ForceOutput, InitialShape, Integrator, Line, LineType, Point, PointKind, Reconstruction, Scene, Seabed,
    Section, Solver,
};

impl Scene {
    /// Returns a note for every object with keys that have no effect.
    pub(super) fn idle(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        let used = |name: &str| self.sections().any(|section| section.line_type == name);
        let types = self.line_types.iter();
        for (name, line_type) in types.filter(|(name, _)| used(name)) {
            let at = format!("line_types.{}", quoted(name));
            self.idle_by_rule(&at, line_type, &mut notes);
            self.idle_of_line_type(&at, line_type, &mut notes);
        }
        let moves = self.water.is_some() && !self.is_quasi_static();
        for (i, point) in self.points.iter().enumerate() {
            let at = format!("points[{i}]");
            self.idle_by_rule(&at, point, &mut notes);
            rules! { &mut notes, &at;
                "" if moves && point.volume.is_none() && point.added_mass.is_some() =>
                    "it is a fraction of the displaced mass: without `volume` `added_mass` changes nothing";
            }
        }
        for (i, line) in self.lines.iter().enumerate() {
            rules! { &mut notes, &format!("lines[{i}]");
                "" if self.is_quasi_static() && line.initial != InitialShape::Static =>
                    "quasi-static: `initial` changes nothing";
            }
        }
        for (i, vessel) in self.vessels.iter().enumerate() {
            let carries = |point: &Point| point.on.as_ref() == Some(&vessel.name);
            let mut keys = vec![];
            keys.extend((vessel.position != [0.0; 3]).then_some("position"));
            keys.extend((vessel.attitude != [0.0; 3]).then_some("attitude"));
            keys.extend((!vessel.motion_angles.is_zyx()).then_some("motion_angles"));
            rules! { &mut notes, "vessels";
                "[{i}]" if !keys.is_empty() && !self.points.iter().any(carries) =>
                    "no point is `on` this vessel: {}", nothing(&keys);
            }
        }
        self.idle_of_solver(&mut notes);
        let surface = self.water.as_ref().and_then(|water| water.surface);
        let pushed = self
            .lines
            .iter()
            .any(|line| self.types_of(line).any(|kind| kind.diameter.is_some()));
        let wet = |point: &Point| point.volume.is_some() || point.drag_area.is_some();
        let damped = |seabed: &Seabed| seabed.damping != Seabed::level(seabed.depth).damping;
        rules! { &mut notes, "";
            "water" if surface.is_some() && self.all_beams() =>
                "beams are always submerged: `surface` changes nothing";
            "water" if self.has_host_flow() && !pushed && !self.points.iter().any(wet) =>
                "no line has a `diameter` and no point a `volume` or `drag_area`: `flow` changes nothing";
            "seabed" if self.is_quasi_static() && self.seabed.as_ref().is_some_and(damped) =>
                "quasi-static: `damping` changes nothing";
        }
        notes
    }

    /// Returns notes on the keys of the solver that have no effect with the integrators that were chosen.
    pub fn idle_with(&self, mut chosen: impl Iterator<Item = Integrator>) -> Vec<Note> {
        let mut notes = Vec::new();
        let radius = [Integrator::AxialImplicit, Integrator::GeneralisedAlpha];
        rules! { &mut notes, "solver";
            "" if self.solver.spectral_radius.is_some() && !chosen.any(|integrator| radius.contains(&integrator)) =>
                "with the integrator chosen here, `spectral_radius` changes nothing";
        }
        notes
    }

    /// Returns notes on keys that are required but have no effect.
    pub(super) fn idle_by_need(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        rules! { &mut notes, "seabed";
            "" if self.has_idle_depth() => "with soundings and no waves, `depth` changes nothing";
        }
        notes
    }

    /// Returns whether the depth of the seabed has no effect: soundings give that under the lines, and there are no waves.
    pub(crate) fn has_idle_depth(&self) -> bool {
        let sounded = self.seabed.as_ref().is_some_and(|seabed| seabed.grid.is_some());
        sounded && self.waves().is_none()
    }

    fn is_quasi_static(&self) -> bool {
        self.solver.integrator == Integrator::QuasiStatic
    }

    /// Adds notes on given properties that have no effect without water, or in quasi-static runs.
    fn idle_by_rule<T: Table>(&self, at: &str, table: &T, notes: &mut Vec<Note>) {
        let still = self.water.as_ref().is_some_and(|water| water.current.is_none());
        let rests = |acts: Acts| match acts {
            Acts::Always | Acts::InWater => false,
            Acts::InMotion => true,
            Acts::InFlow => still,
            Acts::InAccelerations => self.water.is_some(),
        };
        let idle = |condition: &dyn Fn(Acts) -> bool| -> Vec<&str> {
            let given = table.entries().filter(|(_, value)| !value.is_absent());
            let idle = given.filter(|(key, _)| condition(key.rule.acts));
            idle.map(|(key, _)| key.name()).collect()
        };
        let dry = idle(&|acts| self.water.is_none() && acts.in_water());
        let slow = idle(&|acts| self.is_quasi_static() && rests(acts));
        rules! { notes, at;
            "" if !dry.is_empty() => "without [water], {}", nothing(&dry);
            "" if !slow.is_empty() => "quasi-static: {}", nothing(&slow);
        }
    }

    fn idle_of_line_type(&self, at: &str, line_type: &LineType, notes: &mut Vec<Note>) {
        let beam = self.makes_beams(line_type);
        // the rotary inertia of a beam may be computed from the diameter
        let spun = beam && line_type.rotary_inertia.is_none() && line_type.solid_section.is_none();
        let sheared = [line_type.shear_stiffness, line_type.torsional_stiffness];
        let sheared = beam && sheared.iter().any(Option::is_none);
        let bent = line_type.bending_stiffness.is_none() || beam && line_type.rotary_inertia.is_none();
        let section = line_type.solid_section.as_ref();
        let ratio = section.is_some_and(|section| section.poisson != super::line_type::STEEL_POISSON);
        let bare = self.water.is_none() && self.seabed.is_none();
        rules! { notes, at;
            "" if bare && line_type.diameter.is_some() && !spun =>
                "without [water] and [seabed], `diameter` changes nothing";
            "" if section.is_some() && !sheared && !bent =>
                "`solid_section` changes nothing, since its properties are given or not modelled";
            "solid_section" if ratio && !sheared =>
                "`poisson` changes nothing, since its properties are given or not modelled";
        }
    }

    fn idle_of_solver(&self, notes: &mut Vec<Note>) {
        let (solver, usual) = (&self.solver, Solver::default());
        let mut points = self.points.iter();
        let alone = self.vessels.is_empty() && points.all(|point| point.kind != PointKind::Coupled);
        let bends = |section: &Section| self.type_of(section).is_some_and(LineType::bends);
        let (rests, meshed) = (self.is_quasi_static(), !self.lines.iter().any(Line::is_open));
        let still = self.motion.is_empty() && self.points.iter().all(|point| point.motion.is_none());
        let chosen = solver.integrator != Integrator::Auto || self.sections().all(bends);
        rules! { notes, "solver";
            "" if alone && solver.input_reconstruction != Reconstruction::Smooth =>
                "nothing is coupled to a host: `input_reconstruction` changes nothing";
            "" if rests && solver.negative_tension && !self.sections().any(bends) =>
                "quasi-static, without damping and bending: `negative_tension` changes nothing";
            "" if rests && solver.time_step_max != usual.time_step_max =>
                "quasi-static: `time_step_max` changes nothing";
            "" if self.all_beams() && solver.negative_tension =>
                "beams push as they pull: `negative_tension` changes nothing";
            "" if meshed && solver.elements.is_some() =>
                "all lines or their sections have `elements`, and here `elements` changes nothing";
            "" if (meshed || solver.elements.is_some()) && chosen && solver.tolerance != usual.tolerance =>
                "elements and integrator are given, so that `tolerance` changes nothing";
            "" if (rests || meshed || solver.elements.is_some() || still) && solver.tolerance_of != usual.tolerance_of =>
                "elements are not selected by trials with the scene's motion: `tolerance_of` changes nothing";
        }
        let output = &self.output;
        rules! { notes, "output";
            "" if alone && output.interface.is_some() => "nothing is coupled to a host: `interface` changes nothing";
            "" if alone && output.force != ForceOutput::Total => "nothing is coupled to a host: `force` changes nothing";
            "" if rests && !alone && output.force != ForceOutput::Total =>
                "quasi-static runs have no inertia: `force` changes nothing";
            "" if self.vessels.is_empty() && output.stiffness => "there is no vessel: `stiffness` changes nothing";
        }
    }
}

/// "`mass` changes nothing", "`mass`, `volume` change nothing".
fn nothing(keys: &[&str]) -> String {
    let verb = if keys.len() == 1 { "changes" } else { "change" };
    format!("`{}` {verb} nothing", keys.join("`, `"))
}
