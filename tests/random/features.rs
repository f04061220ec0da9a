//! What a scene has: the physics that random scenes must cover.

use moorline::scene::{
    ContactLaw, InitialShape, Integrator, LineModel, LineType, MotionPath, PointKind, Reconstruction,
    RestShape, Scene, Strain,
};

use crate::run::Case;

/// Names of what a case has.
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

/// Whether the paths of driven points jump.
pub fn jumps(scene: &Scene) -> bool {
    scene.solver.input_reconstruction == Reconstruction::Jump
}

/// The types of all sections.
pub fn used_types(scene: &Scene) -> Vec<&LineType> {
    let sections = scene.lines.iter().flat_map(|line| &line.sections);
    sections
        .map(|section| &scene.line_types[&section.line_type])
        .collect()
}

/// The names of those that hold.
fn held<const N: usize>(list: [(&'static str, bool); N]) -> impl Iterator<Item = &'static str> {
    list.into_iter().filter(|(_, has)| *has).map(|(name, _)| name)
}

fn surroundings(scene: &Scene) -> Vec<&'static str> {
    let water = scene.water.as_ref();
    let current = water.and_then(|water| water.current.as_ref());
    let seas = water
        .and_then(|water| water.waves.as_ref())
        .map(|waves| &waves.seas[..]);
    let sea = |what: fn(&moorline::scene::Sea) -> bool| seas.is_some_and(|seas| seas.iter().any(what));
    let bed = scene.seabed.as_ref();
    held([
        ("dry", water.is_none()),
        ("water", water.is_some()),
        ("no gravity", scene.gravity == 0.0),
        (
            "current: uniform",
            current.is_some_and(|current| current.velocity.is_some()),
        ),
        (
            "current: profile",
            current.is_some_and(|current| current.profile.is_some()),
        ),
        (
            "current: in time",
            current.is_some_and(|current| current.factor.is_some()),
        ),
        ("waves: regular", sea(|sea| sea.regular.is_some())),
        ("waves: spectrum", sea(|sea| sea.spectrum.is_some())),
        (
            "waves: rows",
            sea(|sea| sea.regular.is_none() && sea.spectrum.is_none()),
        ),
        (
            "lines at the surface",
            scene.lines.iter().any(|line| scene.meets_surface(line)),
        ),
        ("seabed: level", bed.is_some_and(|bed| bed.is_level())),
        ("seabed: slope", bed.is_some_and(|bed| bed.slope.is_some())),
        ("seabed: grid", bed.is_some_and(|bed| bed.grid.is_some())),
        ("seabed: friction", bed.is_some_and(|bed| bed.friction.acts())),
        (
            "seabed: as given",
            bed.is_some_and(|bed| bed.contact == ContactLaw::AsGiven),
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

fn bends(kind: &LineType) -> bool {
    kind.bending_stiffness > Some(0.0) || kind.solid_section.is_some()
}

fn bodies(scene: &Scene) -> Vec<&'static str> {
    let kind = |kind: PointKind| scene.points.iter().any(|point| point.kind == kind);
    let path = |what: fn(&MotionPath) -> bool| scene.motion.values().any(what);
    held([
        ("point: coupled", kind(PointKind::Coupled)),
        ("point: prescribed", kind(PointKind::Prescribed)),
        ("point: free", kind(PointKind::Free)),
        (
            "point: on rails",
            scene.points.iter().any(|point| point.free.is_some()),
        ),
        (
            "point: load",
            scene.points.iter().any(|point| point.force.is_some()),
        ),
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
    let any = |what: fn(&moorline::scene::Line) -> bool| scene.lines.iter().any(what);
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
        ("break", any(|line| line.parting.is_some())),
        ("winch", any(|line| line.winch.is_some())),
    ])
    .collect()
}
