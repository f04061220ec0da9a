//! Conversion of a scene into the discrete model.

mod beam;
mod reach;
mod resting;
mod spacing;
mod waves;

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::Vector3;

use self::reach::may_touch_seabed;
use super::{
    Bending, Contact, Current, Drag, End, FreePoint, FroudeKrylov, Line, Model, Motion, Network, Nodes,
    Point, PointContact, Regularised, Release, Role, Seabed, Segments, Surface, Vessel, Winch, mesh,
};
use crate::math::circle;
use crate::physics::bending;
use crate::physics::catenary::Section;
use crate::physics::flow::Profile;
use crate::physics::friction::Friction;
use crate::physics::ground::{Grid, Ground};
use crate::physics::morison::{DragCoefficients, drag_per_length};
use crate::physics::point::Sphere;
use crate::physics::rayleigh;
use crate::physics::seabed::{ContactCoefficients, under_point};
use crate::physics::stretch::StretchLaw;
use crate::physics::tension_table::TensionTable;
use crate::physics::viscoelastic::Viscoelastic;
use crate::physics::weight::submerged_weight;
use crate::scene::channel::LineEnd;
use crate::scene::{
    self, Axis, ContactLaw, FibreLaw, InitialShape, Integrator, LineType, Names, PointKind, RestShape, Scene,
    SceneError, Strain, TimeFunction,
};

/// Maximum number of segments that a winch pays out.
const WINCH_SEGMENTS_MAX: f64 = 1e5;

/// Number of elements of every line relative to a single line [-]: its length over that of the longest line that it is connected to by free points.
pub fn line_shares(scene: &Scene) -> Vec<f64> {
    spacing::shares(scene)
}

impl Model {
    /// Discretises a scene.
    ///
    /// # Errors
    /// The mistakes that [`Scene::check`] finds, and names that do not exist.
    pub fn new(scene: &Scene) -> Result<Model, SceneError> {
        scene.check()?;
        let names = Names::of(scene);
        let mut vessels: Vec<Vessel> = scene.vessels.iter().map(|v| vessel(scene, v)).collect();
        let mut points: Vec<Point> = scene
            .points
            .iter()
            .map(|point| build_point(scene, &names, &vessels, point))
            .collect();
        let seabed = scene.seabed.as_ref().and_then(seabed).map(Arc::new);
        let mut lines = Vec::with_capacity(scene.lines.len());
        let elements = spacing::elements(scene);
        let damped = spacing::damping_lengths(scene);
        for (index, line) in scene.lines.iter().enumerate() {
            let sizes = (elements[index], &damped[index][..]);
            let mut built = build_line((scene, &names), index, line, (&points, &vessels), sizes)?;
            rest_as_it_lies(&mut built, &points, line.rest_shape);
            lay_on(&mut built, seabed.as_ref());
            resting::sink(&mut built, &points);
            points[built.ends[0]].attached.push((index, End::A));
            points[built.ends[1]].attached.push((index, End::B));
            lines.push(built);
        }
        let networks = networks(&points, &lines);
        list_on_vessels(&mut vessels, &points, &lines, &networks);
        networks.iter().try_for_each(|network| {
            check_beam(&points, &lines, network)?;
            check_integrator(scene, &lines, network)
        })?;
        Ok(Model {
            gravity: scene.gravity,
            seabed_level: scene.seabed.as_ref().map(|seabed| -seabed.depth),
            seabed_friction: scene.seabed.as_ref().map_or(0.0, |seabed| seabed.friction.axial),
            seabed,
            current: scene.water.as_ref().and_then(current),
            waves: waves::waves(scene),
            host_flow: scene.water.as_ref().is_some_and(|water| water.flow.is_some()),
            networks,
            points,
            lines,
            vessels,
            solver: scene.solver.clone(),
            energy_balance: scene.output.energy_balance,
            force: scene.output.force,
            derivatives: scene.output.derivatives,
            interval: scene.output.interval,
        })
    }

    /// Number and lengths [m] of the lines' elements with the reasons, one sentence per line. `scene` is the scene of this model.
    pub fn mesh_in_words(&self, scene: &Scene) -> Vec<String> {
        spacing::in_words(scene, self)
    }
}

/// Shape and friction of the seabed; `None` for a level plane without friction.
fn seabed(seabed: &scene::Seabed) -> Option<Seabed> {
    let ground = match (&seabed.grid, seabed.slope) {
        (Some(grid), _) => {
            let heights = grid.depth.iter().map(|row| row.iter().map(|d| -d).collect());
            let heights: Vec<Vec<f64>> = heights.collect();
            Ground::Grid(Grid::new(&grid.x, &grid.y, &heights)?)
        }
        (None, slope) => Ground::Plane {
            height: -seabed.depth,
            slope: slope.unwrap_or_default(),
        },
    };
    let friction = seabed.friction.acts().then_some(Friction {
        axial: seabed.friction.axial,
        transverse: seabed.friction.transverse,
    });
    (!seabed.is_level() || friction.is_some()).then_some(Seabed {
        ground,
        level: seabed.is_level(),
        friction,
    })
}

/// Stiffness along the seabed of a node that sticks, relative to the maximum axial stiffness EA/l of its segments [-]: the
/// displacement before a node slides is then small compared with the stretch between two nodes.
const STICK: f64 = 10.0;

/// Sets the seabed under a line, and the stiffness of nodes that stick to it.
fn lay_on(line: &mut Line, seabed: Option<&Arc<Seabed>>) {
    if let Some(winch) = &mut line.winch {
        lay_on(winch.longest_mut(), seabed);
    }
    let springs: Vec<f64> = line
        .segments
        .axial_stiffness
        .iter()
        .zip(&line.segments.length)
        .map(|(ea, length)| ea / length)
        .collect();
    if line.beam.is_some() {
        return; // beams are modelled on a level seabed without friction only
    }
    if let (Some(contact), Some(seabed)) = (&mut line.nodes.contact, seabed) {
        contact.seabed = Some(seabed.clone());
        if seabed.friction.is_some() {
            let at = |i: usize| springs.get(i).copied().unwrap_or(0.0);
            let stick = |i: usize| STICK * at(i).max(at(i.wrapping_sub(1)));
            contact.stick = (0..=springs.len()).map(stick).collect();
        }
    }
}

/// Current of the water; `None` if it is zero at all heights.
fn current(water: &scene::Water) -> Option<Current> {
    let current = water.current.as_ref()?;
    let uniform = current.velocity.unwrap_or_default();
    let mut rows = current.profile.iter().flatten();
    if uniform == [0.0; 3] && rows.all(|[_, vx, vy]| *vx == 0.0 && *vy == 0.0) {
        return None;
    }
    let row = |[z, vx, vy]: &[f64; 3]| (*z, Vector3::new(*vx, *vy, 0.0));
    let profile = match &current.profile {
        Some(rows) => Profile::through(&rows.iter().map(row).collect::<Vec<_>>()),
        None => Profile::uniform(Vector3::from(uniform)),
    };
    Some(Current {
        profile,
        factor: current.factor.clone(),
    })
}

fn vessel(scene: &Scene, vessel: &scene::Vessel) -> Vessel {
    Vessel::new(
        vessel.name.clone(),
        Vector3::from(vessel.position),
        Vector3::from(vessel.attitude),
        scene
            .motion
            .get(&vessel.name)
            .map(|path| (Motion::until(path, scene.output.duration), vessel.motion_angles)),
    )
}

fn build_point(scene: &Scene, names: &Names, vessels: &[Vessel], point: &scene::Point) -> Point {
    let place = Vector3::from(point.position);
    let carrier = point.on.as_ref().and_then(|name| names.vessel_index(name));
    let role = match (point.kind, carrier) {
        (PointKind::Coupled, Some(vessel)) => Role::Carried { vessel, arm: place },
        (PointKind::Coupled, None) => Role::Coupled {
            motion: scene
                .motion
                .get(&point.name)
                .map(|path| Motion::until(path, scene.output.duration)),
        },
        (PointKind::Fixed, _) => Role::Fixed,
        (PointKind::Prescribed, _) => point.motion.as_ref().map_or(Role::Fixed, |path| {
            Role::Prescribed(Motion::until(path, scene.output.duration))
        }),
        (PointKind::Free, _) => Role::Free(free_point(scene, names, point)),
    };
    Point {
        name: point.name.clone(),
        reference: carrier.map_or(place, |vessel| vessels[vessel].reference_place(place)),
        role,
        load: point.force.clone(),
        moment: point.moment.clone(),
        own: (point.kind != PointKind::Free && has_mass_or_water(point)).then(|| FreePoint {
            axes: [false; 3],
            contact: None,
            ..free_point(scene, names, point)
        }),
        attached: Vec::new(),
    }
}

/// Returns whether a point has mass, or forces from the water.
fn has_mass_or_water(point: &scene::Point) -> bool {
    let sizes = [point.mass, point.volume, point.drag_area];
    sizes.iter().flatten().any(|size| *size > 0.0)
}

fn free_point(scene: &Scene, names: &Names, point: &scene::Point) -> FreePoint {
    let axes = match &point.free {
        None => [true; 3],
        Some(free) => [Axis::X, Axis::Y, Axis::Z].map(|axis| free.contains(&axis)),
    };
    let mass = point.mass.unwrap_or(0.0);
    let density = scene.water.as_ref().map_or(0.0, |water| water.density);
    let volume = point.volume.unwrap_or(0.0);
    let of_water = [
        volume,
        point.drag_area.unwrap_or(0.0),
        point.added_mass.unwrap_or(0.0),
    ];
    FreePoint {
        axes,
        mass,
        weight: submerged_weight(mass, density * volume, scene.gravity),
        sphere: Sphere::new(of_water, density, scene.gravity),
        contact: point_contact((scene, names), point, axes, mass * scene.gravity),
    }
}

/// Contact of a free point with the weight `dry` [N] in air that moves along `axes`; a point without weight rests on the ends of
/// its lines.
fn point_contact(
    (scene, names): (&Scene, &Names),
    point: &scene::Point,
    axes: [bool; 3],
    dry: f64,
) -> Option<PointContact> {
    let seabed = scene.seabed.as_ref()?;
    let in_reach = scene.lines.iter().any(|line| {
        let tied = line.from == point.name || line.to == point.name;
        tied && may_touch_seabed(scene, names, line)
    });
    if !axes[2] || dry == 0.0 || seabed.stiffness <= 0.0 || !in_reach {
        return None;
    }
    let density = scene.water.as_ref().map_or(0.0, |water| water.density);
    let wet = dry - density * scene.gravity * point.volume.unwrap_or(0.0);
    let coefficients = under_point(dry, seabed.damping / seabed.stiffness);
    Some(PointContact {
        seabed_level: -seabed.depth,
        level: -seabed.depth + wet.max(0.0) / coefficients.stiffness,
        coefficients,
    })
}

/// Properties of a line type in the scene's surroundings, per unstretched length.
pub(super) struct LineLaw {
    law: StretchLaw,
    axial_stiffness: f64,                 // EA [N], at rest
    viscoelastic: Option<[f64; 2]>,       // EA_d [N], BA_s [N s]
    axial_damping: f64,                   // BA [N s], minimum
    numerical_damping: f64,               // BA over the length of a segment, minimum [N s/m]
    mass: f64,                            // m [kg/m]
    displaced: f64,                       // ρA [kg/m]
    added_normal: f64,                    // ρA·C_an [kg/m]
    added_tangent: f64,                   // ρA·C_at [kg/m]
    weight: f64,                          // w [N/m]
    pub(super) diameter: Option<f64>,     // d [m]
    pub(super) displaced_weight: f64,     // ρ g A [N/m]
    mass_damping: f64,                    // α [1/s]
    bending_stiffness: f64,               // EI [N m²]
    bending_damping: f64,                 // β [s]
    drag: Option<DragCoefficients>,       // [N s²/m³]
    contact: Option<ContactCoefficients>, // [N/m², N s/m²]
}

/// Damping ratio ζ of a segment of the length that ratios refer to: as given, or the numerical one.
fn damping_ratio(scene: &Scene, line_type: &LineType) -> f64 {
    let open = numerical_ratio(scene, line_type);
    line_type.damping_ratio.unwrap_or(open)
}

/// Minimum ζ of every segment: [`scene::NUMERICAL_DAMPING_RATIO`] for cables whose type leaves the axial damping open.
fn numerical_ratio(scene: &Scene, line_type: &LineType) -> f64 {
    if line_type.leaves_damping_open() && !scene.makes_beams(line_type) {
        scene::NUMERICAL_DAMPING_RATIO
    } else {
        0.0
    }
}

/// EI of a cable's section [N m²]: as given or of its solid section, divided among its strands.
fn bending_stiffness(line_type: &LineType) -> f64 {
    let of_section =
        |section: scene::SolidSection| bending::solid_round(section.diameter, section.youngs_modulus);
    let solid = line_type
        .bending_stiffness
        .or(line_type.solid_section.map(of_section));
    let power = match line_type.fibre_law {
        FibreLaw::Linear => 1,
        FibreLaw::Squared => 2,
    };
    let strands = line_type.fibres.unwrap_or(1).max(1);
    bending::of_strands(solid.unwrap_or(0.0), strands, power)
}

/// The law of the axial force and its EA [N].
fn stretch_law(line_type: &LineType) -> (StretchLaw, f64) {
    if let Some(table) = &line_type.tension_strain {
        let (table, ea) = TensionTable::through(&table.rows);
        return (StretchLaw::Tabulated(table), ea);
    }
    let law = match line_type.strain {
        Strain::Engineering => StretchLaw::Engineering,
        Strain::Green => StretchLaw::Green,
        Strain::Logarithmic(poisson) => StretchLaw::Logarithmic { poisson },
    };
    let stiffness = line_type.axial_stiffness.or(line_type.static_stiffness);
    (law, stiffness.unwrap_or(0.0))
}

/// Law of a line type, whose damping ratio refers to segments of the length `damped` [m].
fn line_law(scene: &Scene, line_type: &LineType, damped: f64) -> LineLaw {
    let density = scene.water.as_ref().map_or(0.0, |water| water.density);
    let displaced = line_type.diameter.map_or(0.0, |d| density * circle::area(d));
    let mass = line_type
        .mass
        .unwrap_or_else(|| line_type.weight.unwrap_or(0.0) / scene.gravity);
    let weight = line_type
        .weight
        .unwrap_or_else(|| submerged_weight(mass, displaced, scene.gravity));
    let rayleigh = line_type
        .rayleigh
        .map(|r| rayleigh::coefficients(r.ratios, r.frequencies));
    let (law, ea) = stretch_law(line_type);
    let fast = line_type.dynamic_stiffness.unwrap_or(ea); // EA in fast motion [N]
    let critical = (fast * mass).sqrt(); // critical damping of a segment over its length [N s/m]
    let drag = line_type.diameter.and_then(|diameter| {
        let (normal, tangent) = (
            line_type.drag_normal.unwrap_or(0.0),
            line_type.drag_tangential.unwrap_or(0.0),
        );
        (density > 0.0 && normal + tangent > 0.0).then(|| drag_per_length(density, diameter, normal, tangent))
    });
    let contact = scene
        .seabed
        .as_ref()
        .zip(line_type.diameter)
        .and_then(|(seabed, diameter)| {
            (seabed.stiffness > 0.0).then_some(ContactCoefficients {
                stiffness: seabed.stiffness * diameter,
                damping: seabed.damping * diameter,
            })
        });
    LineLaw {
        law,
        axial_stiffness: ea,
        viscoelastic: line_type
            .dynamic_stiffness
            .zip(line_type.static_damping)
            .map(<[f64; 2]>::from),
        axial_damping: line_type
            .axial_damping
            .or(line_type.dynamic_damping)
            .unwrap_or(0.0)
            + rayleigh.map_or(0.0, |r| r.stiffness * ea)
            + damping_ratio(scene, line_type) * damped * critical,
        numerical_damping: numerical_ratio(scene, line_type) * critical,
        mass,
        displaced,
        added_normal: displaced * line_type.added_mass_normal.unwrap_or(0.0),
        added_tangent: displaced * line_type.added_mass_tangential.unwrap_or(0.0),
        weight,
        diameter: line_type.diameter,
        displaced_weight: displaced * scene.gravity,
        mass_damping: rayleigh.map_or(0.0, |r| r.mass),
        bending_stiffness: match scene.makes_beams(line_type) {
            true => 0.0, // beams have their own
            false => bending_stiffness(line_type),
        },
        bending_damping: rayleigh.map_or(0.0, |r| r.stiffness),
        drag,
        contact,
    }
}

/// Builds a line of the scene, with `elements` elements [-] if the scene leaves the number open; damping ratios refer to
/// segments of the lengths `damped` [m], one per section.
fn build_line(
    (scene, names): (&Scene, &Names),
    index: usize,
    line: &scene::Line,
    (points, vessels): (&[Point], &[Vessel]),
    (elements, damped): (f64, &[f64]),
) -> Result<Line, SceneError> {
    let point = |key: &str, name: &str| {
        names.point_index(name).ok_or_else(|| {
            SceneError::new(
                format!("lines[{index}].{key}"),
                format!("there is no point \"{name}\""),
            )
        })
    };
    let ends = [point("from", &line.from)?, point("to", &line.to)?];
    let mut laws = Vec::with_capacity(line.sections.len());
    for ((number, section), damped) in line.sections.iter().enumerate().zip(damped) {
        let line_type = scene.line_types.get(&section.line_type).ok_or_else(|| {
            SceneError::new(
                format!("lines[{index}].sections[{number}].type"),
                format!("there is no line type \"{}\"", section.line_type),
            )
        })?;
        laws.push(line_law(scene, line_type, *damped));
    }
    check_mixture(index, &laws)?;
    let wanted = spacing::refinements(scene, line, ends.map(|end| &points[end]), vessels, &laws);
    let mut lengths = mesh::lengths(&pieces(line), elements, &wanted);
    let at_winch = winch_segments(index, line, &mut lengths)?;
    let beam = beam::build(scene, index, line, &laws, &lengths)?;
    let parts = segment_parts(&laws, &lengths);
    let mut built = Line {
        name: line.name.clone(),
        ends,
        segments: segments(&parts),
        nodes: nodes(scene, &parts, may_touch_seabed(scene, names, line)),
        bending: None,
        surface: None,
        sections: catenary_sections(line, &laws),
        initial: match scene.solver.integrator {
            Integrator::QuasiStatic => InitialShape::Static, // in equilibrium from the start
            _ => line.initial.clone(),
        },
        beam,
        release: releases(line),
        winch: None,
        linear_load: [false; 2],
    };
    if let (Some(winch), Some(segments)) = (&line.winch, at_winch) {
        return on_winch(index, built, segments, winch);
    }
    if let (Some(_), Some(contact)) = (&built.beam, &mut built.nodes.contact) {
        contact.at_nodes = false; // beams have contact along their elements
    }
    built.bending = line_bending(index, line, &parts, &built)?;
    if let Some(bending) = built.bending.as_mut().filter(|_| scene.solver.negative_tension) {
        bending.compression_max.fill(0.0); // springs of other codes carry no compression
    }
    if let (Some(bending), Some(laws)) = (&built.bending, &mut built.segments.viscoelastic) {
        for (law, most) in laws.iter_mut().zip(&bending.compression_max) {
            law.push = *most;
        }
    }
    if scene.meets_surface_between(line, names.ends(line)) {
        built.surface = Some(Surface::new(&parts, &built.nodes.length));
    }
    built.linear_load = [End::A, End::B].map(|end| built.has_linear_load(end));
    Ok(built)
}

/// Extends the mesh of a line on a winch by the maximum length paid out, and by one more segment for paths that overshoot. Returns the first
/// segment of the last section and the number of segments at zero length change; `None` without a winch.
fn winch_segments(
    index: usize,
    line: &scene::Line,
    lengths: &mut [Vec<f64>],
) -> Result<Option<[usize; 2]>, SceneError> {
    let Some((winch, last)) = line.winch.as_ref().zip(lengths.last_mut()) else {
        return Ok(None);
    };
    let (within, length) = (last.len(), last.last().copied().unwrap_or(1.0));
    let more = (winch.length_max / length).ceil() + 1.0;
    if more > WINCH_SEGMENTS_MAX {
        return Err(SceneError::new(
            format!("lines[{index}].winch.length_max"),
            format!(
                "{} m would be {more} elements of {length} m: give the section at the winch longer elements",
                winch.length_max
            ),
        ));
    }
    last.resize(within + more as usize, length);
    let before: usize = lengths.iter().rev().skip(1).map(Vec::len).sum();
    Ok(Some([before, before + within]))
}

/// Line on a winch at zero length change, from the line at its maximum length.
fn on_winch(
    index: usize,
    longest: Line,
    segments: [usize; 2],
    winch: &scene::Winch,
) -> Result<Line, SceneError> {
    if longest.uniform_law().is_none() {
        return Err(SceneError::new(
            format!("lines[{index}].winch"),
            "a line on a winch has one strain measure all along",
        ));
    }
    if segments[1] < 2 {
        return Err(SceneError::new(
            format!("lines[{index}].sections"),
            "a line on a winch needs at least 2 elements",
        ));
    }
    let mut line = longest.clone();
    let winch = Winch::new(longest, segments, winch);
    let path = winch.path.iter().flat_map(TimeFunction::corners);
    if let Some(problem) = path.map(|change| winch.check(change)).find_map(Result::err) {
        return Err(SceneError::new(format!("lines[{index}].winch.path"), problem));
    }
    line.winch = Some(winch);
    line.pay_out(segments[1], 0.0);
    Ok(line)
}

/// The segments of a line from the laws of its sections and the lengths [m] of their elements.
fn segment_parts<'a>(laws: &'a [LineLaw], lengths: &[Vec<f64>]) -> Vec<SegmentPart<'a>> {
    let of_section = |(law, lengths): (&'a LineLaw, &Vec<f64>)| -> Vec<SegmentPart<'a>> {
        let part = |&length: &f64| SegmentPart { length, law };
        lengths.iter().map(part).collect()
    };
    laws.iter().zip(lengths).flat_map(of_section).collect()
}

/// Conditions for the release of a line's ends.
fn releases(line: &scene::Line) -> Option<[Release; 2]> {
    let mut releases = [Release::default(); 2];
    let side = |end: LineEnd| usize::from(end == LineEnd::B);
    if let Some(end) = line.release {
        releases[side(end)].on_release = true;
    }
    if let Some(failure) = &line.failure {
        let end = &mut releases[side(failure.at)];
        (end.tension, end.time) = (failure.tension, failure.time);
    }
    (line.release.is_some() || line.failure.is_some()).then_some(releases)
}

/// Refuses a line with a viscoelastic section and a section of another strain measure.
fn check_mixture(index: usize, laws: &[LineLaw]) -> Result<(), SceneError> {
    let viscoelastic = laws.iter().any(|law| law.viscoelastic.is_some());
    if viscoelastic && laws.iter().any(|law| law.law != StretchLaw::Engineering) {
        return Err(SceneError::new(
            format!("lines[{index}].sections"),
            "a line with a viscoelastic section has other sections of engineering strain only, without a table",
        ));
    }
    Ok(())
}

/// Sections of the closed-form catenary.
fn catenary_sections(line: &scene::Line, laws: &[LineLaw]) -> Vec<Section> {
    let section = |(section, law): (&scene::Section, &LineLaw)| Section {
        length: section.length,
        weight: law.weight,
        axial_stiffness: law.axial_stiffness,
    };
    line.sections.iter().zip(laws).map(section).collect()
}

/// Sections as used by the mesher.
fn pieces(line: &scene::Line) -> Vec<mesh::Piece> {
    let piece = |section: &scene::Section| mesh::Piece {
        length: section.length,
        elements: section.elements,
    };
    line.sections.iter().map(piece).collect()
}

/// Joints and clamps of a line, if any of its sections has bending stiffness.
fn line_bending(
    index: usize,
    line: &scene::Line,
    parts: &[SegmentPart],
    built: &Line,
) -> Result<Option<Bending>, SceneError> {
    if built.beam.is_some() || parts.iter().all(|part| part.law.bending_stiffness == 0.0) {
        return Ok(None);
    }
    if parts.len() < 2 {
        return Err(SceneError::new(
            format!("lines[{index}].sections"),
            "a line bends between its elements: it needs at least 2 of them",
        ));
    }
    let clamps = [line.clamped_a, line.clamped_b]
        .map(|clamp| clamp.and_then(|along| Vector3::from(along).try_normalize(0.0)));
    let per_segment =
        |value: fn(&LineLaw) -> f64| parts.iter().map(|part| value(part.law)).collect::<Vec<_>>();
    Ok(Some(Bending::new(
        &built.segments.length,
        per_segment(|law| law.bending_stiffness),
        &per_segment(|law| law.bending_damping),
        clamps,
    )))
}

/// Takes the initial shape as the one without bending moments, if the scene gives a shape and requests this.
fn rest_as_it_lies(line: &mut Line, points: &[Point], rest_shape: RestShape) {
    let nodes = line.given_shape(line.ends.map(|point| points[point].reference));
    if let (Some(bending), Some(nodes), RestShape::Initial) = (&mut line.bending, nodes, rest_shape) {
        bending.rest_at(&nodes);
    }
}

/// One segment and the law of its section.
#[derive(Clone, Copy)]
pub(super) struct SegmentPart<'a> {
    pub(super) length: f64,
    pub(super) law: &'a LineLaw,
}

fn segments(parts: &[SegmentPart]) -> Segments {
    let damping = |part: &SegmentPart| {
        let numerical = part.law.numerical_damping * part.length;
        part.law.axial_damping.max(numerical)
    };
    let axial_damping: Vec<f64> = parts.iter().map(damping).collect();
    let viscoelastic = |(part, damping): (&SegmentPart, &f64)| match part.law.viscoelastic {
        Some([fast, slow_damping]) => {
            Viscoelastic::new([part.law.axial_stiffness, fast], [slow_damping, *damping])
        }
        None => Viscoelastic::plain(part.law.axial_stiffness, *damping),
    };
    Segments {
        viscoelastic: parts
            .iter()
            .any(|part| part.law.viscoelastic.is_some())
            .then(|| parts.iter().zip(&axial_damping).map(viscoelastic).collect()),
        length: parts.iter().map(|part| part.length).collect(),
        axial_stiffness: parts.iter().map(|part| part.law.axial_stiffness).collect(),
        axial_damping,
        law: parts.iter().map(|part| part.law.law.clone()).collect(),
    }
}

fn nodes(scene: &Scene, parts: &[SegmentPart], may_touch_seabed: bool) -> Nodes {
    let lump = |density: &dyn Fn(&LineLaw) -> f64| lumped(parts, density);
    let length = lump(&|_| 1.0);
    let weight = lump(&|law| law.weight);
    let any = |has: &dyn Fn(&LineLaw) -> bool| parts.iter().any(|part| has(part.law));
    let drag = any(&|law| law.drag.is_some()).then(|| Drag {
        normal: lump(&|law| law.drag.map_or(0.0, |drag| drag.normal)),
        tangent: lump(&|law| law.drag.map_or(0.0, |drag| drag.tangent)),
    });
    let accelerates = scene.water.as_ref().is_some_and(scene::Water::accelerates);
    let froude_krylov = (accelerates && any(&|law| law.displaced > 0.0)).then(|| FroudeKrylov {
        normal: lump(&|law| law.displaced + law.added_normal),
        tangent: lump(&|law| law.displaced + law.added_tangent),
    });
    let mass_normal = lump(&|law| law.mass + law.added_normal);
    let contact = (may_touch_seabed && any(&|law| law.contact.is_some())).then(|| contact(scene, parts));
    let mut arc = vec![0.0];
    arc.extend(parts.iter().scan(0.0, |arc, part| {
        *arc += part.length;
        Some(*arc)
    }));
    Nodes {
        arc,
        mass: lump(&|law| law.mass),
        mass_normal,
        mass_tangent: lump(&|law| law.mass + law.added_tangent),
        mass_damping: any(&|law| law.mass_damping != 0.0).then(|| lump(&|law| law.mass_damping * law.mass)),
        length,
        weight,
        drag,
        froude_krylov,
        contact,
    }
}

/// Lumps a quantity per length to the nodes, half of each neighbouring segment to a node.
fn lumped(parts: &[SegmentPart], density: &dyn Fn(&LineLaw) -> f64) -> Vec<f64> {
    let mut nodes = vec![0.0; parts.len() + 1];
    for (i, part) in parts.iter().enumerate() {
        let half = 0.5 * part.length * density(part.law);
        nodes[i] += half;
        nodes[i + 1] += half;
    }
    nodes
}

fn contact(scene: &Scene, parts: &[SegmentPart]) -> Contact {
    let seabed = scene
        .seabed
        .as_ref()
        .expect("contact is built only over a seabed");
    let of = |density: &dyn Fn(&LineLaw) -> f64| -> Vec<f64> {
        parts.iter().map(|part| part.length * density(part.law)).collect()
    };
    let weight = of(&|law| law.weight);
    let stiffness = of(&|law| law.contact.map_or(0.0, |contact| contact.stiffness));
    let damping = of(&|law| law.contact.map_or(0.0, |contact| contact.damping));
    let given = stiffness.iter().zip(&damping);
    let given = given.map(|(&stiffness, &damping)| ContactCoefficients { stiffness, damping });
    let regularised = (seabed.contact == ContactLaw::Regularised).then(|| Regularised {
        given: given.collect(),
        load: weight.clone(),
    });
    let mut contact = Contact {
        seabed_level: -seabed.depth,
        level: vec![-seabed.depth; parts.len() + 1],
        stiffness,
        damping,
        weight,
        mass: of(&|law| law.mass + law.added_normal),
        regularised,
        at_nodes: seabed.contact == ContactLaw::AtNodes,
        seabed: None,
        stick: Vec::new(),
    };
    let lengths: Vec<f64> = parts.iter().map(|part| part.length).collect();
    resting::size(&mut contact, &lengths);
    contact
}

/// Refuses a beam that shares a free point with another line.
fn check_beam(points: &[Point], lines: &[Line], network: &Network) -> Result<(), SceneError> {
    let beam = network.lines.iter().find(|&&line| lines[line].beam.is_some());
    match (beam, network.lines.len()) {
        (None, _) | (_, 1) => Ok(()),
        (Some(&beam), _) => {
            let shared = network.free_points.iter();
            let mut shared = shared.filter(|&&point| points[point].attached.len() > 1);
            let name = shared.next().map_or("", |&point| points[point].name.as_str());
            Err(SceneError::new(
                format!("lines[{beam}]"),
                format!(
                    "line \"{}\" is a beam and meets another line at the free point \"{name}\": a beam may end at a free point of its own, \
                     or at points that are fixed, coupled or prescribed",
                    lines[beam].name
                ),
            ))
        }
    }
}

/// Refuses a leapfrog for lines that it cannot integrate.
fn check_integrator(scene: &Scene, lines: &[Line], network: &Network) -> Result<(), SceneError> {
    let integrator = scene.solver.integrator;
    let refuse = |what: String| {
        let right = "use \"generalised_alpha\" or \"auto\"";
        Err(SceneError::new("solver.integrator", format!("{what}; {right}")))
    };
    if !matches!(integrator, Integrator::Leapfrog | Integrator::AxialImplicit) {
        return Ok(());
    }
    if let Some(&line) = network.lines.iter().find(|&&line| !lines[line].serves_leapfrog()) {
        let name = &lines[line].name;
        return refuse(format!(
            "a leapfrog needs mass on every node and one strain measure along line \"{name}\"; where the line bends, engineering strain, no Rayleigh \
             damping and no viscoelastic sections"
        ));
    }
    Ok(())
}

/// Lines grouped by shared free points.
fn networks(points: &[Point], lines: &[Line]) -> Vec<Network> {
    let mut of_line: Vec<usize> = (0..lines.len()).collect();
    for point in points.iter().filter(|point| point.free().is_some()) {
        let joined: Vec<usize> = point.attached.iter().map(|(line, _)| of_line[*line]).collect();
        let Some(first) = joined.iter().copied().min() else {
            continue;
        };
        for network in &mut of_line {
            if joined.contains(network) {
                *network = first;
            }
        }
    }
    let mut networks = BTreeMap::<usize, Network>::new();
    for (line, &id) in of_line.iter().enumerate() {
        networks.entry(id).or_default().lines.push(line);
    }
    for (index, point) in points
        .iter()
        .enumerate()
        .filter(|(_, point)| point.free().is_some())
    {
        if let Some((line, _)) = point.attached.first() {
            networks
                .entry(of_line[*line])
                .or_default()
                .free_points
                .push(index);
        }
    }
    networks.into_values().collect()
}

/// Lists the points that every vessel carries, and the networks that end there.
fn list_on_vessels(vessels: &mut [Vessel], points: &[Point], lines: &[Line], networks: &[Network]) {
    for (index, point) in points.iter().enumerate() {
        if let Role::Carried { vessel, .. } = point.role {
            vessels[vessel].points.push(index);
        }
    }
    for (number, network) in networks.iter().enumerate() {
        for point in network.lines.iter().flat_map(|&line| lines[line].ends) {
            if let Role::Carried { vessel, .. } = points[point].role
                && vessels[vessel].networks.last() != Some(&number)
            {
                vessels[vessel].networks.push(number);
            }
        }
    }
}
