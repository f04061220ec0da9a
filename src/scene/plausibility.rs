//! Notes on values that are accepted but unusual for moorings, most of them slips of units. Notes on single values follow from the usual range of
//! their key in the property table; the rules here concern several keys.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::check::{Findings, number, quantity, rounded, rules};
use super::motion_file::AXES;
use super::names::Names;
use super::notes::{Note, chord_between};
use super::path::quoted;
use super::table::check_table;
use super::table_ends::motions;
use super::water::SPEED_USUAL;
use super::{
    Integrator, Line, LineType, MotionPath, Point, PointKind, Scene, Sea, Section, Strain, WaveComponents,
};
use crate::math::circle;

/// Speed of axial waves √(EA/m) [m/s]: 350 in a chain of a 1:50 model, 5200 in solid steel, 5700 in carbon fibre with its coat.
const WAVE_SPEED: [f64; 2] = [300.0, 6000.0];
/// Strain under the line's own weight [-]: steel bears 0.003, nylon breaks at 0.2 to 0.3.
const WEIGHT_STRAIN: f64 = 0.2;
/// Strain [-] beyond which ropes of polyester and steel break or yield.
const STRAIN: f64 = 0.05;
/// Strain between the ends [-] up to which lines at a free point are not noted: its position is a first guess, and the equilibrium gives the strain.
const FIRST_GUESS_STRAIN: f64 = 0.5;
/// Mass per volume of the diameter [kg/m³]: 200 for foam, 7850 for steel, 11 340 for lead. The upper limit is the geometric mean of steel and three
/// times steel, the value of a chain with its bar diameter.
pub const MASS_PER_VOLUME: [f64; 2] = [200.0, 14_000.0];
/// Weight in water per volume of the diameter, as a density without sign [kg/m³], of a line without a given mass: 30 for ropes that nearly float.
const EXCESS_MIN: f64 = 1.0;
/// Density of steel [kg/m³].
pub(crate) const STEEL: f64 = 7850.0;
/// Mass of a chain relative to one straight bar of its links [-]: two bars side by side, the bends and any studs make it somewhat
/// more than three.
const CHAIN: std::ops::Range<f64> = 2.7..4.0;
/// Normal drag coefficient [-] from which it is taken to refer to the bar of a chain (2.4 on the bar, 1.3 on the volume-equivalent diameter): the
/// bar diameter is then given on purpose, as in several published systems.
pub const DRAG_ON_BAR: f64 = 1.8;
/// Height of an end above the seabed, relative to the length of its line [-], up to which it is taken to lie on the seabed.
const ON_SEABED: f64 = 0.02;
/// Distance of a fairlead from its vessel's origin [m]: the longest vessel is 488 m long.
const FAIRLEAD_DISTANCE: f64 = 300.0;
/// Unstretched length of a line [m]: the longest moorings, in water 3000 m deep, are less than half as long.
const LENGTH: f64 = 20e3;
/// Ratio of the unstretched length of a line to the distance between its ends [-].
const LENGTH_OVER_CHORD: f64 = 20.0;
/// Ratio of the lengths of neighbouring elements [-]: the node between them has the mass of the longer one, and swings on the shorter one.
const ELEMENT_RATIO: f64 = 20.0;
/// Period of a motion [s]; in models at 1:100, waves have periods of a few tenths of a second.
const PERIOD: f64 = 0.1;
/// Height above z = 0 of the highest row of a current [m].
const CURRENT_HEIGHT: f64 = 1.0;
/// Ratio of height to length at which a wave breaks in deep water (Michell 1893) [-].
const BREAKING_DEEP: f64 = 0.142;
/// Ratio of height to depth at which a wave breaks in shallow water (McCowan 1894) [-].
const BREAKING_SHALLOW: f64 = 0.78;

/// A rule, which adds notes on its findings.
type Rule = fn(&Scene, &mut Vec<Note>);

/// The rules, in the order of a scene.
const RULES: [Rule; 13] = [
    current,
    wave_steepness,
    sea_angles,
    line_type_properties,
    fairlead_distance,
    anchor_height,
    line_length,
    line_strain,
    weight_strain,
    element_lengths,
    swapped_ends,
    turns,
    sines,
];

impl Scene {
    /// Returns notes on values that are far from those of moorings, most of them slips of units.
    pub fn plausibility(&self) -> Vec<Note> {
        let mut findings = Findings::default();
        check_table(self, &mut findings);
        let mut notes = findings.notes;
        RULES.iter().for_each(|rule| rule(self, &mut notes));
        notes
    }
}

/// Returns whether a value lies outside a range.
fn outside(value: f64, [lower, upper]: [f64; 2]) -> bool {
    !(lower..=upper).contains(&value)
}

/// Notes rows of a current's profile, and its factor; the usual range of the velocity is checked separately.
fn current(scene: &Scene, notes: &mut Vec<Note>) {
    let Some(current) = scene.current() else {
        return;
    };
    let rows = current.profile.as_deref().unwrap_or_default();
    let speed = |[_, x, y]: &[f64; 3]| x.hypot(*y);
    let fast = rows.iter().position(|row| speed(row) > SPEED_USUAL);
    let high = rows.iter().position(|row| row[0] > CURRENT_HEIGHT);
    rules! { notes, "water.current";
        "profile[{row}]" given row = fast =>
            "{} is unusual: less than {SPEED_USUAL} m/s is usual, with rows of z [m], vx and vy [m/s]",
            quantity(significant(speed(&rows[row])), "m/s");
        "profile[{row}]" given row = high =>
            "{} above the water: heights count upwards from the surface, and depths are negative",
            quantity(rows[row][0], "m");
    }
    let [x, y, _] = current.velocity.unwrap_or_default();
    let fastest = rows.iter().map(speed).fold(x.hypot(y), f64::max);
    let factors = current.factor.iter().flat_map(|factor| factor.corners());
    let factor = factors.map(f64::abs).fold(0.0, f64::max);
    let speed = significant(factor * fastest);
    rules! { notes, "water.current";
        "velocity" if x.abs().max(y.abs()) <= SPEED_USUAL && x.hypot(y) > SPEED_USUAL =>
            "{} is unusual: less than {SPEED_USUAL} m/s is usual", quantity(significant(x.hypot(y)), "m/s");
        "factor" if fastest <= SPEED_USUAL && factor * fastest > SPEED_USUAL =>
            "a current of {} with it is unusual: less than {SPEED_USUAL} m/s is usual",
            quantity(speed, "m/s");
    }
}

/// The seas of a scene, with their key paths.
fn seas(scene: &Scene) -> impl Iterator<Item = (String, &Sea)> {
    let waves = scene.waves().into_iter();
    waves.flat_map(|waves| (0..).map(|index| waves.path(index)).zip(&waves.seas))
}

/// Rows of the components of a sea.
fn trains(sea: &Sea) -> &[[f64; 4]] {
    match &sea.components {
        Some(WaveComponents::Rows(rows)) => rows,
        _ => &[],
    }
}

fn wave_steepness(scene: &Scene, notes: &mut Vec<Note>) {
    for (at, sea) in seas(scene) {
        let regular = sea.regular.as_ref().and_then(|wave| {
            let height = 2.0 * wave.half_height()?;
            Some((format!("{at}.regular"), height, wave.period))
        });
        let spectrum = sea.significant_height.zip(sea.peak_period);
        let spectrum = spectrum.map(|(height, period)| (format!("{at}.significant_height"), height, period));
        let rows = trains(sea)
            .iter()
            .enumerate()
            .map(|(row, [amplitude, period, ..])| {
                (format!("{at}.components[{row}]"), 2.0 * amplitude, *period)
            });
        let mut steep = regular.into_iter().chain(spectrum).chain(rows);
        let note = |(at, height, period)| Some(Note::new(at, breaking(scene, height, period)?));
        notes.extend(steep.find_map(note));
    }
}

/// Returns the note on a wave that would break below this height, in deep water a seventh of its length; `None` for other waves.
fn breaking(scene: &Scene, height: f64, period: f64) -> Option<String> {
    if scene.gravity <= 0.0 || period.is_nan() || period <= 0.0 {
        return None;
    }
    let deep = scene.gravity * period * period / TAU; // length in deep water [m]
    let limit = match &scene.seabed {
        Some(seabed) => {
            // Fenton & McKee 1990, within 2 %
            let shortening = (TAU * seabed.depth / deep).powf(0.75).tanh().powf(2.0 / 3.0);
            (BREAKING_DEEP * deep * shortening).min(BREAKING_SHALLOW * seabed.depth)
        }
        None => BREAKING_DEEP * deep,
    };
    (height > limit).then(|| {
        format!(
            "a wave with a height of {} and a period of {} breaks: the highest is {}, and linear waves are much lower",
            quantity(height, "m"),
            quantity(period, "s"),
            quantity((100.0 * limit).round() / 100.0, "m")
        )
    })
}

/// Returns the note on an angle of more than one turn, which may have been given in degrees.
pub(super) fn degrees(angle: f64) -> Option<String> {
    (angle.abs() > TAU).then(|| {
        format!(
            "{} is more than a turn of 6.283 rad: {} degrees are {:.4} rad",
            quantity(angle, "rad"),
            number(angle),
            angle.to_radians()
        )
    })
}

/// Notes angles in rows of components; angles of single keys are recognised by their unit.
fn sea_angles(scene: &Scene, notes: &mut Vec<Note>) {
    for (at, sea) in seas(scene) {
        let mut angles = trains(sea).iter().flat_map(|row| &row[2..]);
        let text = angles.find_map(|angle| degrees(*angle));
        notes.extend(text.map(|text| Note::new(format!("{at}.components"), text)));
    }
}

fn line_type_properties(scene: &Scene, notes: &mut Vec<Note>) {
    for (name, line_type) in &scene.line_types {
        let at = format!("line_types.{}", quoted(name));
        // without water a scene is a bench test, of any material
        if scene.water.is_some() {
            wave_speed(scene, line_type, &at, notes);
            mass_per_volume(scene, line_type, &at, notes);
        }
    }
}

/// Stiffness EA of a line type [N], for a table the secant stiffness of its last row, and its key.
fn stiffness(line_type: &LineType) -> Option<(f64, &'static str)> {
    let table = line_type.tension_strain.as_ref().and_then(|table| {
        let [strain, tension] = table.rows.last()?;
        (*strain > 0.0).then(|| (tension / strain, "tension_strain"))
    });
    let of = |key: &'static str| move |value: f64| (value, key);
    let given = line_type.axial_stiffness.map(of("axial_stiffness"));
    let slow = line_type.static_stiffness.map(of("static_stiffness"));
    given.or(table).or(slow).filter(|(ea, _)| *ea > 0.0)
}

fn wave_speed(scene: &Scene, line_type: &LineType, at: &str, notes: &mut Vec<Note>) {
    let mass = scene.mass(line_type);
    let Some((ea, key)) = stiffness(line_type).filter(|_| mass > 0.0 && mass.is_finite()) else {
        return;
    };
    let speed = (ea / mass).sqrt();
    rules! { notes, at;
        "{key}" if outside(speed, WAVE_SPEED) =>
            "EA of {ea:.3e} N and a mass of {} give axial waves a speed of {speed:.0} m/s: 300 to 6000 m/s is usual, with EA in N and the \
             mass in kg/m", quantity(significant(mass), "kg/m");
    }
}

/// A number rounded to four significant digits.
fn significant(value: f64) -> f64 {
    rounded(value, 4)
}

fn mass_per_volume(scene: &Scene, line_type: &LineType, at: &str, notes: &mut Vec<Note>) {
    let Some(diameter) = line_type.diameter.filter(|diameter| *diameter > 0.0) else {
        return;
    };
    let on_bar = line_type.drag_normal.is_some_and(|drag| drag >= DRAG_ON_BAR);
    let mass = scene.mass(line_type);
    let density = mass / (circle::area(diameter));
    if mass == 0.0 || !density.is_finite() {
        return;
    }
    let light = match line_type.mass {
        Some(_) => density < MASS_PER_VOLUME[0],
        None => density.abs() < EXCESS_MIN,
    };
    let heavy = dense(diameter, mass, MASS_PER_VOLUME[1], "diameter").filter(|_| !light && !on_bar);
    rules! { notes, at;
        "diameter" if light =>
            "a mass of {} and a diameter of {} give a density of {density:.3} kg/m³: 200 to 12 000 kg/m³ is usual, with the diameter in m",
            quantity(significant(mass), "kg/m"), quantity(diameter, "m");
        "diameter" given heavy = heavy => "{heavy}";
    }
}

/// Returns the note on a diameter [m] and a mass [kg/m] that give a density above a limit [kg/m³]: the diameter should be that of a cylinder of
/// the line's volume, not that of a chain's bar.
pub fn dense(diameter: f64, mass: f64, limit: f64, key: &str) -> Option<String> {
    let density = mass / (circle::area(diameter));
    if density <= limit {
        return None;
    }
    let steel_diameter = (mass / (STEEL * circle::area(1.0))).sqrt();
    let as_steel = format!(
        "for buoyancy and drag, {key} is that of a cylinder of the line's volume ({steel_diameter:.4} m if it is steel)"
    );
    Some(if CHAIN.contains(&(density / STEEL)) {
        format!(
            "mass and {key} {diameter} m are those of a chain with this bar diameter, since the density would be {density:.0} kg/m³; {as_steel}"
        )
    } else {
        format!(
            "mass and {key} {diameter} m give a density of {density:.0} kg/m³, more than steel; {as_steel}"
        )
    })
}

fn fairlead_distance(scene: &Scene, notes: &mut Vec<Note>) {
    for (i, point) in scene.points.iter().enumerate() {
        let Some(vessel) = &point.on else { continue };
        let [x, y, z] = point.position;
        let distance = x.hypot(y).hypot(z);
        rules! { notes, "points";
            "[{i}].position" if distance > FAIRLEAD_DISTANCE =>
                "{distance:.0} m from the origin of {vessel}: positions of points on a vessel are in its own frame, usually within its size";
        }
    }
}

/// Notes fixed points above the water with lines to coupled points or into the water: most are anchors whose depth lacks its minus sign.
fn anchor_height(scene: &Scene, notes: &mut Vec<Note>) {
    for (i, point) in scene.points.iter().enumerate().filter(|_| scene.water.is_some()) {
        let lines = scene.lines.iter().filter(|line| line.joins(&point.name));
        let others = lines.flat_map(|line| [&line.from, &line.to]);
        let mut others = others.filter_map(|name| scene.point(name));
        let is_moored = |other: &Point| other.kind == PointKind::Coupled || other.position[2] < 0.0;
        let height = point.position[2];
        rules! { notes, "points";
            "[{i}].position" if point.kind == PointKind::Fixed && height > 0.0 && others.any(is_moored) =>
                "{} above the water: a fixed point is usually an anchor below it, where z is negative",
                quantity(height, "m");
        }
    }
}

impl Scene {
    /// Strain [-] beyond which a line is noted: 5 %, or the end of its tension tables if that is greater; infinite with a measure for large strains.
    pub(crate) fn usual_strain(&self, line: &Line) -> f64 {
        let of_type = |line_type: &LineType| match (&line_type.tension_strain, line_type.strain) {
            (_, Strain::Green | Strain::Logarithmic(_)) => f64::INFINITY,
            (Some(table), _) => table.rows.last().map_or(STRAIN, |row| row[0].max(STRAIN)),
            (None, Strain::Engineering) => STRAIN,
        };
        self.types_of(line).map(of_type).fold(STRAIN, f64::max)
    }
}

/// Returns whether a line ends at a free point, whose position is a first guess.
fn is_guessed(scene: &Scene, line: &Line) -> bool {
    scene.free_points().any(|point| line.joins(&point.name))
}

/// Notes lines that are too long, except in scenes without water (bench tests); chords of zero (loops) or to free points (first guesses) are ignored.
fn line_length(scene: &Scene, notes: &mut Vec<Note>) {
    let names = Names::of(scene);
    for (i, line) in scene.lines.iter().enumerate().filter(|_| scene.water.is_some()) {
        let length = line.length();
        let chord =
            chord_between(scene, names.ends(line)).filter(|chord| *chord > 0.0 && !is_guessed(scene, line));
        let near = chord.filter(|chord| length <= LENGTH && length > LENGTH_OVER_CHORD * chord);
        rules! { notes, "lines";
            "[{i}]" if length > LENGTH => "{} long: less than 20 km is usual", quantity(length, "m");
            "[{i}]" given chord = near =>
                "it is {} long, and its ends are {} apart: less than 20 times their distance is usual, with lengths and positions in m",
                quantity(length, "m"), quantity(significant(chord), "m");
        }
    }
}

fn line_strain(scene: &Scene, notes: &mut Vec<Note>) {
    let names = Names::of(scene);
    for (i, line) in scene.lines.iter().enumerate() {
        let length = line.length();
        let strain_max = match is_guessed(scene, line) {
            true => FIRST_GUESS_STRAIN.max(scene.usual_strain(line)),
            false => scene.usual_strain(line),
        };
        let chord = chord_between(scene, names.ends(line)).unwrap_or(0.0);
        rules! { notes, "lines";
            "[{i}]" if chord > (1.0 + strain_max) * length =>
                "its ends are {} m apart, and it is {} m long unstretched: it is strained by at least {:.0} %",
                number(chord), number(length), 100.0 * (chord / length - 1.0);
        }
    }
}

fn weight_strain(scene: &Scene, notes: &mut Vec<Note>) {
    for (i, line) in scene.lines.iter().enumerate() {
        if scene.usual_strain(line).is_infinite() {
            continue;
        }
        let types = line.sections.iter().filter_map(|section| {
            let line_type = scene.type_of(section)?;
            Some((line_type, scene.weight(line_type).abs() * section.length))
        });
        let weight: f64 = types.clone().map(|(_, weight)| weight).sum();
        let softest = types
            .filter_map(|(line_type, _)| stiffness(line_type))
            .map(|(ea, _)| ea)
            .fold(f64::INFINITY, f64::min);
        rules! { notes, "lines";
            "[{i}]" if weight > WEIGHT_STRAIN * softest =>
                "its weight of {weight:.3e} N strains it by up to {:.0} %, with EA {softest:.3e} N: less than 20 % is usual, with EA in N",
                100.0 * weight / softest;
        }
    }
}

/// Notes sections whose elements, of given numbers, are far shorter than the adjacent ones.
fn element_lengths(scene: &Scene, notes: &mut Vec<Note>) {
    if scene.solver.integrator == Integrator::QuasiStatic {
        return;
    }
    for (i, line) in scene.lines.iter().enumerate() {
        let length = |section: &Section| Some(section.length / section.elements? as f64);
        let lengths: Vec<_> = line.sections.iter().map(length).collect();
        let uneven = (1..lengths.len()).find_map(|next| {
            let [before, after] = [lengths[next - 1]?, lengths[next]?];
            let shorter = if before < after { next - 1 } else { next };
            let [short, long] = [before.min(after), before.max(after)];
            (long > ELEMENT_RATIO * short).then_some((shorter, short, long))
        });
        rules! { notes, "lines";
            "[{i}].sections[{section}].elements" given (section, short, long) = uneven =>
                "elements of {} beside elements of {}: with long time steps, the tension of such short elements is inaccurate; similar lengths \
                 are usual", quantity(significant(short), "m"), quantity(significant(long), "m");
        }
    }
}

/// A line runs from its anchor, end A, to its fairlead, end B: outputs and closed forms are named accordingly.
fn swapped_ends(scene: &Scene, notes: &mut Vec<Note>) {
    let Some(seabed) = &scene.seabed else {
        return;
    };
    let names = Names::of(scene);
    for (i, line) in scene.lines.iter().enumerate() {
        let [Some(a), Some(b)] = names.ends(line) else {
            continue;
        };
        let (Some(from), Some(to)) = (scene.reference_position(a), scene.reference_position(b)) else {
            continue;
        };
        let [height_a, height_b] = [from, to].map(|[x, y, z]| z - seabed.lowest_at([x, y]));
        let on_seabed = ON_SEABED * line.length();
        let reversed = to[2] < from[2] && height_b <= on_seabed && height_a > on_seabed;
        rules! { notes, "lines";
            "[{i}].to" if b.kind == PointKind::Fixed && a.kind == PointKind::Coupled && reversed =>
                "end B, {}, is on the seabed and end A, {}, is the one that moves: a line runs from its anchor to its fairlead, so that \
                 `tension_b` is the fairlead's; here it is the anchor's", line.to, line.from;
        }
    }
}

/// Returns the note on a roll or pitch beyond a right angle or a yaw beyond a turn (axes 3, 4 and 5) [rad], which may have been given in degrees.
fn turned(axis: usize, angle: f64) -> Option<String> {
    let limit = if axis == 5 { TAU } else { FRAC_PI_2 };
    let angle = significant(angle.abs());
    (angle > limit).then(|| {
        format!(
            "{} of {} is a turn by {:.0} degrees: {} degrees are {:.4} rad",
            AXES[axis],
            quantity(angle, "rad"),
            angle.to_degrees(),
            number(angle),
            angle.to_radians()
        )
    })
}

/// Notes the angles of vessels, and the maximum angles of motions.
fn turns(scene: &Scene, notes: &mut Vec<Note>) {
    let mut say = |at: String, axis: usize, angle: f64| {
        notes.extend(turned(axis, angle).map(|text| Note::new(at, text)));
    };
    for (i, vessel) in scene.vessels.iter().enumerate() {
        for (axis, angle) in vessel.attitude.iter().enumerate() {
            say(format!("vessels[{i}].attitude[{axis}]"), 3 + axis, *angle);
        }
    }
    for (at, motion) in motions(scene) {
        let greatest = motion.greatest();
        for axis in 3..6 {
            let key = match motion {
                MotionPath::Harmonic(_) => AXES[axis],
                MotionPath::File(_) => "file",
                MotionPath::Table(_) => "table",
            };
            say(format!("{at}.{key}"), axis, greatest[axis]);
        }
    }
}

/// Notes phases and periods of motions.
fn sines(scene: &Scene, notes: &mut Vec<Note>) {
    for (at, motion) in motions(scene) {
        let MotionPath::Harmonic(harmonic) = motion else {
            continue;
        };
        for (name, sines) in harmonic.axes() {
            let mut phases = sines.iter().filter_map(|sine| sine.get(2));
            let phase = phases.find_map(|phase| degrees(*phase));
            let mut periods = sines.iter().filter_map(|sine| sine.get(1));
            let short = periods.find(|period| **period < PERIOD);
            rules! { notes, &at;
                "{name}" given phase = phase => "phase: {phase}";
                "{name}" given period = short =>
                    "a period of {} is unusual: {PERIOD} s and more is usual, and a frequency of {} Hz is a period of {}",
                    quantity(*period, "s"), number(*period), quantity(significant(1.0 / period), "s");
            }
        }
    }
}
