//! Water, current and waves, in words.

use super::{number, quantity};
use crate::scene::{
    Current, RegularWave, Scene, Sea, SpectrumKind, TimeFunction, Water, WaveComponents, Waves,
};

/// "still water of 1025 kg/m³ that fills all space".
pub(super) fn water_in_words(scene: &Scene, water: &Water) -> String {
    let density = quantity(water.density, "kg/m³");
    let surface = surface_in_words(scene);
    let mut words = match (&water.current, &water.waves) {
        (None, None) => return format!("still water of {density} {surface}"),
        (None, Some(_)) => format!("water of {density} {surface}"),
        (Some(current), _) => format!(
            "water of {density} {surface}, with a current: {}; the drag on lines follows their velocity through the \
             water, at rest too",
            current_in_words(current)
        ),
    };
    if let Some(waves) = &water.waves {
        words += &format!("; {}", waves_in_words(scene, waves));
    }
    words
}

/// "linear waves (Airy) …: significant height 6 m, …".
fn waves_in_words(scene: &Scene, waves: &Waves) -> String {
    let seas: Vec<String> = waves.seas.iter().map(sea_in_words).collect();
    let over = match &scene.seabed {
        Some(bed) => format!("a depth of {}", quantity(bed.depth, "m")),
        None => "deep water".to_string(),
    };
    let total = waves.seas.iter().map(Sea::variance).sum::<f64>();
    let all = match waves.seas.len() {
        1 => String::new(),
        _ => {
            let height = (4e3 * total.sqrt()).round() / 1e3;
            format!(", together of a significant height of {}", quantity(height, "m"))
        }
    };
    let ramp = match waves.ramp() {
        Some(ramp) => format!(", growing over a ramp of {}", quantity(ramp, "s")),
        None => ", at once in full".to_string(),
    };
    format!(
        "linear waves (Airy) over {over}: {}{all}{ramp}; velocities and accelerations are stretched to the surface as Wheeler does, and \
         components that do not reach a place are left out there (1e-4 of the surface's acceleration); drag, Froude-Krylov force and added \
         mass act with the motion of the water past the line; no drift, no breaking, no waves made or turned by the current, and the \
         equilibrium at the start is that of still water or of the current",
        seas.join("; ")
    )
}

fn sea_in_words(sea: &Sea) -> String {
    if let Some(regular) = &sea.regular {
        return regular_in_words(regular);
    }
    if let Some(WaveComponents::Rows(rows)) = &sea.components {
        let trains = match rows.len() {
            1 => "1 wave train".to_string(),
            count => format!("{count} wave trains"),
        };
        let height = (4e3 * sea.variance().sqrt()).round() / 1e3;
        return format!("{trains} of a significant height of {}", quantity(height, "m"));
    }
    let kind = match sea.spectrum {
        Some(SpectrumKind::PiersonMoskowitz) => "a Pierson-Moskowitz spectrum".to_string(),
        _ => format!("a JONSWAP spectrum of peakedness {}", number(sea.gamma())),
    };
    let count = sea.number();
    let spread = match sea.spreading {
        Some(s) => format!(", spread by cos²ˢ of half the angle with s = {}", number(s)),
        None => String::new(),
    };
    format!(
        "{kind}, significant height {}, peak period {}, towards {}{spread}, as {count} wave trains of equal energy drawn with the seed {}",
        quantity(sea.significant_height.unwrap_or_default(), "m"),
        quantity(sea.peak_period.unwrap_or_default(), "s"),
        quantity(sea.direction.unwrap_or_default(), "rad"),
        sea.seed.unwrap_or_default()
    )
}

fn regular_in_words(regular: &RegularWave) -> String {
    format!(
        "a regular wave of height {} and period {} towards {}",
        quantity(2.0 * regular.half_height().unwrap_or_default(), "m"),
        quantity(regular.period, "s"),
        quantity(regular.direction, "rad")
    )
}

/// "1 m/s along (1, 0, 0) at all heights".
fn current_in_words(current: &Current) -> String {
    let triple = |v: [f64; 3]| {
        let speed = v.iter().map(|c| c * c).sum::<f64>().sqrt();
        let [x, y, z] = v.map(number);
        let speed = quantity((1e6 * speed).round() / 1e6, "m/s");
        format!("({x}, {y}, {z}) m/s, a speed of {speed}, at all heights")
    };
    let shape = match (&current.velocity, &current.profile) {
        (_, Some(rows)) => profile_in_words(rows),
        (velocity, None) => triple(velocity.unwrap_or_default()),
    };
    let times = match &current.factor {
        None => ", steady".to_string(),
        Some(TimeFunction::Constant(factor)) => format!(", steady, times {}", number(*factor)),
        Some(_) => {
            ", times a function of time; the force of the water's own acceleration is left out".to_string()
        }
    };
    shape + &times
}

/// "from (0.3, 0) m/s at z = -200 m to (1, 0) m/s at z = 0 m, straight between 3 heights and constant outside".
fn profile_in_words(rows: &[[f64; 3]]) -> String {
    let lower = rows.iter().min_by(|a, b| a[0].total_cmp(&b[0]));
    let upper = rows.iter().max_by(|a, b| a[0].total_cmp(&b[0]));
    let (Some(lower), Some(upper)) = (lower, upper) else {
        return "no rows".to_string();
    };
    let place = |[z, x, y]: &[f64; 3]| {
        format!(
            "({}, {}) m/s at z = {}",
            number(*x),
            number(*y),
            quantity(*z, "m")
        )
    };
    if rows.len() == 1 {
        return format!("{}, and at all other heights", place(lower));
    }
    format!(
        "from {} to {}, straight between {} heights and constant outside",
        place(lower),
        place(upper),
        rows.len()
    )
}

/// "that fills all space", or which lines know its surface.
fn surface_in_words(scene: &Scene) -> String {
    let named = |meet: bool| {
        let lines = scene.lines.iter();
        let lines = lines.filter(|line| scene.meets_surface(line) == meet);
        lines.map(|line| line.name.as_str()).collect::<Vec<_>>()
    };
    let (piercing, submerged) = (named(true), named(false));
    if piercing.is_empty() {
        return "that fills all space".to_string();
    }
    let moves = scene.water.as_ref().is_some_and(|w| w.waves.is_some());
    let level = if moves { ", which the waves move" } else { "" };
    let mut said = format!(
        "with its surface at z = 0{level}: above it {} no buoyancy, drag and added mass",
        have(&piercing)
    );
    if !submerged.is_empty() {
        said += &format!(", while {} them everywhere", have(&submerged));
    }
    said
}

/// "a, b and c have".
fn have(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => format!("{one} has"),
        [first @ .., last] => format!("{} and {last} have", first.join(", ")),
    }
}

/// What the water of a scene does not do.
pub(super) fn absence_in_words(scene: &Scene) -> &'static str {
    let flows = scene.water.as_ref().is_some_and(|w| w.current.is_some());
    let waves = scene.water.as_ref().is_some_and(|w| w.waves.is_some());
    let mut lines = scene.lines.iter();
    let all = !scene.lines.is_empty() && lines.clone().all(|line| scene.meets_surface(line));
    let any = lines.any(|line| scene.meets_surface(line)) || scene.surface_matters();
    match (flows, waves, all, any) {
        (true, true, true, _) => "second-order waves",
        (true, true, _, true) => "the water's surface over some lines",
        (true, true, _, false) => "the water's surface",
        (false, true, true, _) => "current",
        (false, true, _, true) => "current and the water's surface over some lines",
        (false, true, _, false) => "current and the water's surface",
        (true, _, true, _) => "waves",
        (true, _, _, true) => "waves and the water's surface over some lines",
        (true, _, _, false) => "waves and the water's surface",
        (false, _, true, _) => "current and waves",
        (false, _, _, true) => "current, waves and the water's surface over some lines",
        (false, _, _, false) => "current, waves and the water's surface",
    }
}
