//! Keys that are given and change nothing, for what else the scene is.

use super::notes::Note;
use super::path::quoted;
use super::table::Table;
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
            self.idle_of_line_type(&format!("line_types.{}", quoted(name)), line_type, &mut notes);
        }
        for (i, point) in self.points.iter().enumerate() {
            self.idle_of_point(&format!("points[{i}]"), point, &mut notes);
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
        let waves = self.water.as_ref().is_some_and(|water| water.waves.is_some());
        let seabed = self.seabed.as_ref();
        let sounded = seabed.is_some_and(|seabed| seabed.grid.is_some()) && !waves;
        let why = "with soundings and without waves,";
        say(&mut notes, "seabed", why, &[("depth", sounded)]);
        notes
    }

    fn sections(&self) -> impl Iterator<Item = &Section> {
        self.lines.iter().flat_map(|line| &line.sections)
    }

    fn is_quasi_static(&self) -> bool {
        self.solver.integrator == Integrator::QuasiStatic
    }

    fn idle_of_line_type(&self, at: &str, line_type: &LineType, notes: &mut Vec<Note>) {
        let dry = self.water.is_none();
        let wet = line_type.entries().filter(|(key, _)| key.rule.acts.in_water());
        let wet: Vec<Key> = wet
            .map(|(key, value)| (key.name(), dry && !value.is_absent()))
            .collect();
        say(notes, at, "without [water],", &wet);
        let beam = line_type.model == LineModel::Beam || self.solver.integrator == Integrator::Beam;
        // a beam may have its rotary inertia from the diameter
        let spun = beam && line_type.rotary_inertia.is_none() && line_type.solid_section.is_none();
        let bare = dry && self.seabed.is_none() && line_type.diameter.is_some() && !spun;
        say(notes, at, "without [water] and [seabed],", &[("diameter", bare)]);
        if self.is_quasi_static() {
            say(notes, at, "quasi-static:", &self.idle_at_rest(line_type));
        }
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

    /// Keys of a line type that act on what moves, and so on nothing at rest.
    fn idle_at_rest(&self, line_type: &LineType) -> [Key; 11] {
        let wet = self.water.is_some();
        let still = self.water.as_ref().is_some_and(|water| water.current.is_none());
        let given = |value: Option<f64>| value.is_some();
        [
            ("axial_damping", given(line_type.axial_damping)),
            ("damping_ratio", given(line_type.damping_ratio)),
            ("rayleigh", line_type.rayleigh.is_some()),
            ("dynamic_stiffness", given(line_type.dynamic_stiffness)),
            ("static_damping", given(line_type.static_damping)),
            ("dynamic_damping", given(line_type.dynamic_damping)),
            ("rotary_inertia", given(line_type.rotary_inertia)),
            ("drag_normal", still && given(line_type.drag_normal)),
            ("drag_tangential", still && given(line_type.drag_tangential)),
            ("added_mass_normal", wet && given(line_type.added_mass_normal)),
            (
                "added_mass_tangential",
                wet && given(line_type.added_mass_tangential),
            ),
        ]
    }

    fn idle_of_point(&self, at: &str, point: &Point, notes: &mut Vec<Note>) {
        let [volume, drag_area, added_mass] =
            [point.volume, point.drag_area, point.added_mass].map(|value| value.is_some());
        let Some(water) = &self.water else {
            let keys = [
                ("volume", volume),
                ("drag_area", drag_area),
                ("added_mass", added_mass),
            ];
            return say(notes, at, "without [water],", &keys);
        };
        if self.is_quasi_static() {
            say(notes, at, "quasi-static:", &[("added_mass", added_mass)]);
            let still = drag_area && water.current.is_none();
            say(
                notes,
                at,
                "quasi-static, without a current:",
                &[("drag_area", still)],
            );
        } else {
            let why = "it is a part of the mass of displaced water, and without `volume`";
            say(notes, at, why, &[("added_mass", added_mass && !volume)]);
        }
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
        let flexible = |section: &Section| {
            !self
                .line_types
                .get(&section.line_type)
                .is_some_and(LineType::bends)
        };
        let chosen = solver.integrator != Integrator::Auto || !self.sections().any(flexible);
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
