//! Features of a scene: the physics that random scenes must cover.

use moorline::scene::{
    ContactLaw, Current, InitialShape, Integrator, Line, LineModel, LineType, MotionPath, Point, PointKind,
    Reconstruction, RestShape, Scene, Sea, Seabed, Strain,
};

use crate::run::Case;

/// Names of the features of a case.
pub fn of(case: &Case) -> Vec<&'static str> {
    let (scene, drive) = (&case.scene, &case.drive);
    let used = used_types(scene);
    let mut all = surroundings(scene);
    all.extend(types(&used));
    all.extend(bodies(scene));
    all.extend(lines(scene));
    let solver = &scene.solver;
    let integrator = match solver.integrator {
        Integrator::Auto => "integrator: auto",
        Integrator::Leapfrog => "integrator: leapfrog",
        Integrator::AxialImplicit => "integrator: axial_implicit",
        Integrator::GeneralisedAlpha => "integrator: generalised_alpha",
        Integrator::Bossak => "integrator: bossak",
        Integrator::Beam => "integrator: beam",
        Integrator::QuasiStatic => "integrator: quasi_static",
    };
    all.push(integrator);
    let rest = [
        ("negative tension", solver.negative_tension),
        ("jumps between communication points", jumps(scene)),
        ("spectral radius", solver.spectral_radius.is_some()),
        ("host: own steps", !drive.follows),
        ("host: irregular steps", drive.is_irregular()),
        ("host: jump of a body", drive.jumps()),
    ];
    all.extend(rest.iter().filter(|(_, has)| *has).map(|(name, _)| *name));
    all
}

/// Returns whether the paths of driven points jump.
pub fn jumps(scene: &Scene) -> bool {
    scene.solver.input_reconstruction == Reconstruction::Jump
}

/// Line types of all sections.
pub fn used_types(scene: &Scene) -> Vec<&LineType> {
    let sections = scene.lines.iter().flat_map(|line| &line.sections);
    sections
        .map(|section| &scene.line_types[&section.line_type])
        .collect()
}

/// Names of the entries that are true.
fn held<const N: usize>(list: [(&'static str, bool); N]) -> impl Iterator<Item = &'static str> {
    list.into_iter().filter(|(_, has)| *has).map(|(name, _)| name)
}

fn surroundings(scene: &Scene) -> Vec<&'static str> {
    let water = scene.water.as_ref();
    let current =
        |what: fn(&Current) -> bool| water.and_then(|water| water.current.as_ref()).is_some_and(what);
    let seas = water
        .and_then(|water| water.waves.as_ref())
        .map(|waves| &waves.seas[..]);
    let sea = |what: fn(&Sea) -> bool| seas.is_some_and(|seas| seas.iter().any(what));
    let seabed = |what: fn(&Seabed) -> bool| scene.seabed.as_ref().is_some_and(what);
    let meets = scene.lines.iter().any(|line| scene.meets_surface(line));
    held([
        ("dry", water.is_none()),
        ("water", water.is_some()),
        ("no gravity", scene.gravity == 0.0),
        ("current: uniform", current(|current| current.velocity.is_some())),
        ("current: profile", current(|current| current.profile.is_some())),
        ("current: in time", current(|current| current.factor.is_some())),
        ("waves: regular", sea(|sea| sea.regular.is_some())),
        ("waves: spectrum", sea(|sea| sea.spectrum.is_some())),
        (
            "waves: rows",
            sea(|sea| sea.regular.is_none() && sea.spectrum.is_none()),
        ),
        ("lines at the surface", meets),
        ("seabed: level", seabed(Seabed::is_level)),
        ("seabed: slope", seabed(|seabed| seabed.slope.is_some())),
        ("seabed: grid", seabed(|seabed| seabed.grid.is_some())),
        ("seabed: friction", seabed(|seabed| seabed.friction.acts())),
        (
            "seabed: as given",
            seabed(|seabed| seabed.contact == ContactLaw::AsGiven),
        ),
    ])
    .collect()
}

fn types(used: &[&LineType]) -> Vec<&'static str> {
    let any = |what: fn(&LineType) -> bool| used.iter().any(|kind| what(kind));
    let stiffness = |kind: &LineType| kind.axial_stiffness.unwrap_or(1e6);
    held([
        ("EA below 1e5 N", used.iter().any(|kind| stiffness(kind) < 1e5)),
        ("EA above 1e11 N", used.iter().any(|kind| stiffness(kind) > 1e11)),
        ("BA none", any(|kind| kind.axial_damping == Some(0.0))),
        ("BA given", any(|kind| kind.axial_damping > Some(0.0))),
        ("damping ratio", any(|kind| kind.damping_ratio.is_some())),
        ("Rayleigh damping", any(|kind| kind.rayleigh.is_some())),
        ("weight given", any(|kind| kind.weight.is_some())),
        ("mass below 0.1 kg/m", any(|kind| kind.mass < Some(0.1))),
        ("mass above 100 kg/m", any(|kind| kind.mass > Some(100.0))),
        ("drag", any(|kind| kind.drag_normal.is_some())),
        ("added mass", any(|kind| kind.added_mass_normal.is_some())),
        ("strain: Green", any(|kind| kind.strain == Strain::Green)),
        (
            "strain: logarithmic",
            any(|kind| matches!(kind.strain, Strain::Logarithmic(_))),
        ),
        ("tension table", any(|kind| kind.tension_strain.is_some())),
        ("viscoelastic rope", any(|kind| kind.dynamic_stiffness.is_some())),
        (
            "bending",
            any(|kind| kind.model == LineModel::Cable && bends(kind)),
        ),
        ("beam", any(|kind| kind.model == LineModel::Beam)),
    ])
    .collect()
}

/// Returns whether a type has bending stiffness.
pub fn bends(kind: &LineType) -> bool {
    kind.bending_stiffness > Some(0.0) || kind.solid_section.is_some()
}

fn bodies(scene: &Scene) -> Vec<&'static str> {
    let point = |what: fn(&Point) -> bool| scene.points.iter().any(what);
    let path = |what: fn(&MotionPath) -> bool| scene.motion.values().any(what);
    held([
        ("point: coupled", point(|point| point.kind == PointKind::Coupled)),
        (
            "point: prescribed",
            point(|point| point.kind == PointKind::Prescribed),
        ),
        ("point: free", point(|point| point.kind == PointKind::Free)),
        ("point: on rails", point(|point| point.free.is_some())),
        ("point: load", point(|point| point.force.is_some())),
        ("vessel", !scene.vessels.is_empty()),
        ("motion: table", path(|path| matches!(path, MotionPath::Table(_)))),
        (
            "motion: harmonic",
            path(|path| matches!(path, MotionPath::Harmonic(_))),
        ),
        ("motion: turning", path(MotionPath::turns)),
    ])
    .collect()
}

fn lines(scene: &Scene) -> Vec<&'static str> {
    let any = |what: fn(&Line) -> bool| scene.lines.iter().any(what);
    held([
        ("several sections", any(|line| line.sections.len() > 1)),
        ("elements chosen", any(|line| line.sections[0].elements.is_none())),
        ("given shape", any(|line| line.initial != InitialShape::Static)),
        ("bent at rest", any(|line| line.rest_shape == RestShape::Initial)),
        (
            "clamped",
            any(|line| line.clamped_a.is_some() || line.clamped_b.is_some()),
        ),
        ("release", any(|line| line.release.is_some())),
        ("break", any(|line| line.failure.is_some())),
        ("winch", any(|line| line.winch.is_some())),
    ])
    .collect()
}
