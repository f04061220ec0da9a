//! Keys that are given and change nothing, for what else the scene is.

use super::notes::Note;
use super::path::quoted;
use super::table::{Acts, Table};
use super::{
    Integrator, Line, LineModel, LineType, Point, PointKind, Reconstruction, Scene, Seabed, Section, Solver,
};

/// A key, and whether it is given and changes nothing.
type Key = (&'static str, bool);

impl Scene {
    /// Returns a note for every object with keys that change nothing.
    pub(super) fn idle(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        let used = |name: &str| self.sections().any(|section| section.line_type == name);
        let types = self.line_types.iter();
        for (name, line_type) in types.filter(|(name, _)| used(name)) {
            let at = format!("line_types.{}", quoted(name));
            self.idle_by_rule(&at, line_type, &mut notes);
            self.idle_of_line_type(&at, line_type, &mut notes);
        }
        for (i, point) in self.points.iter().enumerate() {
            let at = format!("points[{i}]");
            self.idle_by_rule(&at, point, &mut notes);
            let moves = self.water.is_some() && !self.is_quasi_static();
            let why = "it is a part of the mass of displaced water, and without `volume`";
            let idle = moves && point.volume.is_none() && point.added_mass.is_some();
            say(&mut notes, &at, why, &[("added_mass", idle)]);
        }
        for (i, vessel) in self.vessels.iter().enumerate() {
            let carries = |point: &Point| point.on.as_ref() == Some(&vessel.name);
            let bare = !self.points.iter().any(carries);
            let keys = [
                ("position", bare && vessel.position != [0.0; 3]),
                ("attitude", bare && vessel.attitude != [0.0; 3]),
                ("motion_angles", bare && !vessel.motion_angles.is_zyx()),
            ];
            let at = format!("vessels[{i}]");
            say(&mut notes, &at, "no point is `on` this vessel:", &keys);
        }
        self.idle_of_solver(&mut notes);
        let water = self.water.as_ref();
        let surfaced = self.all_beams() && water.is_some_and(|water| water.surface.is_some());
        let why = "beams are under water throughout:";
        say(&mut notes, "water", why, &[("surface", surfaced)]);
        let seabed = self.seabed.as_ref().filter(|_| self.is_quasi_static());
        let damped = seabed.is_some_and(|bed| bed.damping != Seabed::level(bed.depth).damping);
        say(&mut notes, "seabed", "quasi-static:", &[("damping", damped)]);
        notes
    }

    /// Returns notes on the keys of the solver that change nothing with the integrators that were chosen.
    pub fn idle_with(&self, mut chosen: impl Iterator<Item = Integrator>) -> Vec<Note> {
        let mut notes = Vec::new();
        let radius = [Integrator::AxialImplicit, Integrator::GeneralisedAlpha];
        let given = self.solver.spectral_radius.is_some();
        let idle = given && !chosen.any(|integrator| radius.contains(&integrator));
        let why = "with the integrator that is chosen here,";
        say(&mut notes, "solver", why, &[("spectral_radius", idle)]);
        notes
    }

    /// Returns notes on keys without which a scene cannot be written, and which change nothing.
    pub(super) fn idle_by_need(&self) -> Vec<Note> {
        let mut notes = Vec::new();
        let waves = self.waves().is_some();
        let seabed = self.seabed.as_ref();
        let sounded = seabed.is_some_and(|seabed| seabed.grid.is_some()) && !waves;
        let why = "with soundings and without waves,";
        say(&mut notes, "seabed", why, &[("depth", sounded)]);
        notes
    }

    fn is_quasi_static(&self) -> bool {
        self.solver.integrator == Integrator::QuasiStatic
    }

    /// Adds the given properties that have no effect without water, or at rest.
    fn idle_by_rule<T: Table>(&self, at: &str, table: &T, notes: &mut Vec<Note>) {
        let still = self.water.as_ref().is_some_and(|water| water.current.is_none());
        let rests = |acts: Acts| match acts {
            Acts::Always | Acts::InWater => false,
            Acts::InMotion => true,
            Acts::InFlow => still,
            Acts::InAccelerations => self.water.is_some(),
        };
        let idle = |condition: &dyn Fn(Acts) -> bool| -> Vec<Key> {
            let given = table.entries().filter(|(_, value)| !value.is_absent());
            given
                .map(|(key, _)| (key.name(), condition(key.rule.acts)))
                .collect()
        };
        let dry = self.water.is_none();
        say(
            notes,
            at,
            "without [water],",
            &idle(&|acts| dry && acts.in_water()),
        );
        say(
            notes,
            at,
            "quasi-static:",
            &idle(&|acts| self.is_quasi_static() && rests(acts)),
        );
    }

    fn idle_of_line_type(&self, at: &str, line_type: &LineType, notes: &mut Vec<Note>) {
        let dry = self.water.is_none();
        let beam = line_type.model == LineModel::Beam || self.solver.integrator == Integrator::Beam;
        // a beam may have its rotary inertia from the diameter
        let spun = beam && line_type.rotary_inertia.is_none() && line_type.solid_section.is_none();
        let bare = dry && self.seabed.is_none() && line_type.diameter.is_some() && !spun;
        say(notes, at, "without [water] and [seabed],", &[("diameter", bare)]);
        let Some(section) = &line_type.solid_section else {
            return;
        };
        let sheared = [line_type.shear_stiffness, line_type.torsional_stiffness];
        let sheared = beam && sheared.iter().any(Option::is_none);
        let bent = line_type.bending_stiffness.is_none() || beam && line_type.rotary_inertia.is_none();
        let (whole, ratio) = (
            !sheared && !bent,
            section.poisson != super::line_type::STEEL_POISSON,
        );
        let why = "what follows from it is given or not modelled, so that";
        say(notes, at, why, &[("solid_section", whole)]);
        say(
            notes,
            &format!("{at}.solid_section"),
            why,
            &[("poisson", ratio && !sheared)],
        );
    }

    fn idle_of_solver(&self, notes: &mut Vec<Note>) {
        let (solver, usual) = (&self.solver, Solver::default());
        let mut say = |why: &str, key: &'static str, idle: bool| {
            say(notes, "solver", why, &[(key, idle)]);
        };
        let mut points = self.points.iter();
        let alone = self.vessels.is_empty() && points.all(|point| point.kind != PointKind::Coupled);
        let rebuilt = solver.input_reconstruction != Reconstruction::Smooth;
        say(
            "nothing is coupled to a host:",
            "input_reconstruction",
            alone && rebuilt,
        );
        let rests = self.is_quasi_static();
        say(
            "quasi-static, without damping:",
            "negative_tension",
            rests && solver.negative_tension,
        );
        let stepped = solver.time_step_max != usual.time_step_max;
        say("quasi-static:", "time_step_max", rests && stepped);
        let beams = self.all_beams();
        say(
            "beams push as they pull:",
            "negative_tension",
            beams && solver.negative_tension,
        );
        let meshed = !self.lines.iter().any(Line::is_open);
        say(
            "all lines or their sections have `elements`, and here",
            "elements",
            meshed && solver.elements.is_some(),
        );
        let bends = |section: &Section| {
            self.line_types
                .get(&section.line_type)
                .is_some_and(LineType::bends)
        };
        let chosen = solver.integrator != Integrator::Auto || self.sections().all(bends);
        let aimed = solver.tolerance != usual.tolerance;
        say(
            "elements and integrator are given, so that",
            "tolerance",
            meshed && chosen && aimed,
        );
    }
}

/// Adds a note that names the keys that change nothing, where there are any.
fn say(notes: &mut Vec<Note>, at: &str, why: &str, keys: &[Key]) {
    let idle: Vec<&str> = keys
        .iter()
        .filter(|(_, idle)| *idle)
        .map(|(key, _)| *key)
        .collect();
    let verb = match idle.len() {
        0 => return,
        1 => "changes",
        _ => "change",
    };
    let text = format!("{why} `{}` {verb} nothing", idle.join("`, `"));
    notes.push(Note::new(at, text));
}
