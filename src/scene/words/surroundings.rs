//! Water, current and waves, in words.

use super::{number, quantity};
use crate::scene::{
    Current, RegularWave, Scene, Sea, SpectrumKind, TimeFunction, Water, WaveComponents, Waves,
};

/// "still water of 1025 kg/m³ that fills all space".
pub(super) fn water_in_words(scene: &Scene, water: &Water) -> String {
    let density = quantity(water.density, "kg/m³");
    let mut words = match (&water.current, &water.waves) {
        (None, None) => return format!("still water of {density} that fills all space"),
        (None, Some(_)) => format!("water of {density} that fills all space"),
        (Some(current), _) => format!(
            "water of {density} that fills all space, with a current: {}; the drag on lines follows their velocity through the \
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
    let total = waves.seas.iter().map(variance).sum::<f64>();
    let all = match waves.seas.len() {
        1 => String::new(),
        _ => {
            let height = (4e3 * total.sqrt()).round() / 1e3;
            format!(
                ", together of a significant height of {}",
                quantity(height, "m")
            )
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
        let height = (4e3 * variance(sea).sqrt()).round() / 1e3;
        return format!(
            "{trains} of a significant height of {}",
            quantity(height, "m")
        );
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

/// Variance of the elevation [m²].
fn variance(sea: &Sea) -> f64 {
    if let Some(regular) = &sea.regular {
        return 0.5 * regular.half_height().unwrap_or_default().powi(2);
    }
    match &sea.components {
        Some(WaveComponents::Rows(rows)) => rows.iter().map(|row| 0.5 * row[0] * row[0]).sum(),
        _ => (0.25 * sea.significant_height.unwrap_or_default()).powi(2),
    }
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
            ", times a function of time; the force of the water's own acceleration is left out"
                .to_string()
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

/// What the water of a scene does not do.
pub(super) fn absence_in_words(scene: &Scene) -> &'static str {
    let flows = scene.water.as_ref().is_some_and(|w| w.current.is_some());
    let waves = scene.water.as_ref().is_some_and(|w| w.waves.is_some());
    match (flows, waves, scene.surface_matters()) {
        (true, false, true) => "waves and the water's surface over lines",
        (true, false, false) => "waves and the water's surface",
        (false, false, true) => "current, waves and the water's surface over lines",
        (false, false, false) => "current, waves and the water's surface",
        (true, true, _) => "the water's surface over lines",
        (false, true, _) => "current and the water's surface over lines",
    }
}
