//! Gravity, water, current, waves and seabed in words.

use super::{join, triple};
use crate::scene::check::{number, quantity};
use crate::scene::{
    ContactLaw, Current, Scene, Sea, Seabed, SpectrumKind, TimeFunction, Water, WaveComponents, Waves,
};

impl Scene {
    pub(super) fn surroundings_in_words(&self) -> Vec<String> {
        let gravity = match self.gravity {
            0.0 => "no gravity: nothing has a weight".to_string(),
            gravity => format!("gravity {}, downwards along z", quantity(gravity, "m/s²")),
        };
        let water = self.water.as_ref().map(|water| self.water_in_words(water));
        let seabed = self.seabed.as_ref().map(seabed_in_words);
        let water = water.unwrap_or_else(|| "no water".to_string());
        vec![gravity, water, seabed.unwrap_or_else(|| "no seabed".to_string())]
    }

    /// "still water of 1025 kg/m³ that fills all space".
    fn water_in_words(&self, water: &Water) -> String {
        let still = water.current.is_none() && !water.accelerates();
        let still = if still { "still " } else { "" };
        let mut words = format!(
            "{still}water of {} {}",
            quantity(water.density, "kg/m³"),
            self.surface_in_words()
        );
        if let Some(current) = &water.current {
            words += &format!(
                ", with a current: {}; the drag on lines follows their velocity through the water, at rest too",
                current_in_words(current)
            );
        }
        if let Some(waves) = &water.waves {
            words += &format!("; {}", self.waves_in_words(waves));
        }
        if water.flow.is_some() {
            let added = water
                .current
                .as_ref()
                .map_or("", |_| ", to which the current is added");
            words += &format!(
                "; a host gives its velocity and acceleration at the nodes{added}, and without a host they are zero; drag and the force of the \
                 accelerated water on lines and points follow them, and the surface stays level"
            );
        }
        words
    }

    /// Names of the lines that meet the water's surface, or of those that do not.
    fn lines_that_meet_surface(&self, meet: bool) -> Vec<&str> {
        let lines = self.lines.iter().filter(|line| self.meets_surface(line) == meet);
        lines.map(|line| line.name.as_str()).collect()
    }

    /// "that fills all space", or the lines that may come out of the water.
    fn surface_in_words(&self) -> String {
        let [piercing, submerged] = [true, false].map(|meet| self.lines_that_meet_surface(meet));
        if piercing.is_empty() {
            return "that fills all space".to_string();
        }
        let have = |names: &[&str]| {
            format!(
                "{} {}",
                join(names),
                if names.len() == 1 { "has" } else { "have" }
            )
        };
        let moves = self.waves().is_some();
        let level = if moves { ", which the waves move" } else { "" };
        let others = match submerged.is_empty() {
            true => String::new(),
            false => format!(", while {} them everywhere", have(&submerged)),
        };
        let piercing = have(&piercing);
        format!(
            "with its surface at z = 0{level}: above it {piercing} no buoyancy, drag and added mass{others}"
        )
    }

    /// Effects of the water that are not modelled: "current, waves and the water's surface".
    pub(super) fn absences_of_water(&self) -> String {
        let water = self.water.as_ref();
        let [piercing, submerged] = [true, false].map(|meet| self.lines_that_meet_surface(meet).len());
        let mut absent = Vec::new();
        if water.is_none_or(|water| water.current.is_none()) {
            absent.push("current");
        }
        if water.is_none_or(|water| !water.accelerates()) {
            absent.push("waves");
        }
        match (piercing, submerged) {
            (1.., 0) => {}
            _ if piercing > 0 || self.surface_matters() => absent.push("the water's surface over some lines"),
            _ => absent.push("the water's surface"),
        }
        if absent.is_empty() {
            absent.push("second-order waves");
        }
        join(&absent)
    }

    /// "linear waves (Airy) …: significant height 6 m, …".
    fn waves_in_words(&self, waves: &Waves) -> String {
        let seas: Vec<String> = waves.seas.iter().map(sea_in_words).collect();
        let seas = seas.join("; ");
        let depth = self.seabed.as_ref().map(|seabed| quantity(seabed.depth, "m"));
        let over = depth.map_or("deep water".to_string(), |depth| format!("a depth of {depth}"));
        let height = height_of(waves.deviation());
        let all = match waves.seas.len() {
            1 => String::new(),
            _ => format!(", together of a significant height of {height}"),
        };
        let ramp = waves.ramp().map(|ramp| quantity(ramp, "s"));
        let ramp = ramp.map_or(", at once in full".to_string(), |ramp| {
            format!(", growing over a ramp of {ramp}")
        });
        format!(
            "linear waves (Airy) over {over}: {seas}{all}{ramp}; velocities and accelerations are stretched to the surface as Wheeler does, and \
             components that do not reach a place are left out there (1e-4 of the surface's acceleration); drag, Froude-Krylov force and added \
             mass act with the motion of the water past the line; no drift, no breaking, no waves made or turned by the current, and the \
             equilibrium at the start is that of still water or of the current"
        )
    }
}

/// Significant height of an elevation with a standard deviation [m].
fn height_of(deviation: f64) -> String {
    quantity((4e3 * deviation).round() / 1e3, "m")
}

fn sea_in_words(sea: &Sea) -> String {
    let of = |value: Option<f64>, unit| quantity(value.unwrap_or_default(), unit);
    if let Some(regular) = &sea.regular {
        let height = of(regular.half_height().map(|half| 2.0 * half), "m");
        let [period, direction] =
            [(regular.period, "s"), (regular.direction, "rad")].map(|(n, unit)| quantity(n, unit));
        return format!("a regular wave of height {height} and period {period} towards {direction}");
    }
    if let Some(WaveComponents::Rows(rows)) = &sea.components {
        let (count, trains) = (rows.len(), if rows.len() == 1 { "train" } else { "trains" });
        let height = height_of(sea.variance().sqrt());
        return format!("{count} wave {trains} of a significant height of {height}");
    }
    let kind = match sea.spectrum {
        Some(SpectrumKind::PiersonMoskowitz) => "a Pierson-Moskowitz spectrum".to_string(),
        _ => format!("a JONSWAP spectrum of peakedness {}", number(sea.gamma())),
    };
    let spread = sea.spreading.map(number);
    let spread = spread.map(|s| format!(", spread by cos²ˢ of half the angle with s = {s}"));
    let [height, period] =
        [(sea.significant_height, "m"), (sea.peak_period, "s")].map(|(value, unit)| of(value, unit));
    let (direction, seed, count) = (
        of(sea.direction, "rad"),
        sea.seed.unwrap_or_default(),
        sea.number(),
    );
    let spread = spread.unwrap_or_default();
    format!(
        "{kind}, significant height {height}, peak period {period}, towards {direction}{spread}, as {count} wave trains of equal energy drawn \
         with the seed {seed}"
    )
}

/// "(1, 0, 0) m/s, a speed of 1 m/s, at all heights, steady".
fn current_in_words(current: &Current) -> String {
    let shape = match (&current.velocity, &current.profile) {
        (_, Some(rows)) => profile_in_words(rows),
        (velocity, None) => {
            let velocity = velocity.unwrap_or_default();
            let speed = velocity
                .iter()
                .map(|component| component * component)
                .sum::<f64>()
                .sqrt();
            let speed = quantity((1e6 * speed).round() / 1e6, "m/s");
            format!("{} m/s, a speed of {speed}, at all heights", triple(velocity))
        }
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
        let ([x, y], z) = ([*x, *y].map(number), quantity(*z, "m"));
        format!("({x}, {y}) m/s at z = {z}")
    };
    let [lower, upper] = [lower, upper].map(place);
    match rows.len() {
        1 => format!("{lower}, and at all other heights"),
        count => format!("from {lower} to {upper}, straight between {count} heights and constant outside"),
    }
}

fn seabed_in_words(seabed: &Seabed) -> String {
    let law = match seabed.contact {
        ContactLaw::Regularised => {
            "softened together to suit the mesh, with no less than 0.2 of critical damping where the seabed has it; a resting line lies on the seabed"
        }
        ContactLaw::AsGiven => "exactly as given",
        ContactLaw::AtNodes => "exactly as given, at the nodes alone",
    };
    let chosen = if seabed.has_default_stiffness() {
        " (default)"
    } else {
        ""
    };
    let (spring, damper) = (
        quantity(seabed.stiffness, "Pa/m"),
        quantity(seabed.damping, "Pa s/m"),
    );
    let (shape, friction) = (shape_in_words(seabed), friction_in_words(seabed));
    format!(
        "{shape}: normal spring of {spring} and damper of {damper}{chosen} per metre of line and of diameter, {law}; {friction}"
    )
}

/// Shape of the seabed.
fn shape_in_words(seabed: &Seabed) -> String {
    let depth = quantity(-seabed.depth, "m");
    let elements = "there is no closed-form catenary over such a seabed, elements are used instead";
    match (&seabed.grid, seabed.slope) {
        (Some(grid), _) => {
            let soundings = || grid.depth.iter().flatten().copied();
            let least = soundings().fold(f64::INFINITY, f64::min);
            let most = soundings().fold(f64::NEG_INFINITY, f64::max);
            let span = |line: &[f64]| match line {
                [first, .., last] => format!("from {} to {}", number(*first), quantity(*last, "m")),
                _ => "alike everywhere".to_string(),
            };
            format!(
                "seabed through {} by {} soundings, x {}, y {}, from {} to {} deep, smooth between them and constant outside; {elements}",
                grid.x.len(),
                grid.y.len(),
                span(&grid.x),
                span(&grid.y),
                number(least),
                quantity(most, "m")
            )
        }
        (None, Some([x, y])) if !seabed.is_level() => format!(
            "seabed on a plane through z = {depth} at the origin that rises by {} per metre of x and {} per metre of y; {elements}",
            number(x),
            number(y)
        ),
        _ => format!("flat seabed at z = {depth}"),
    }
}

fn friction_in_words(seabed: &Seabed) -> String {
    let friction = seabed.friction;
    if !friction.acts() {
        return "no friction".to_string();
    }
    let [axial, transverse] = [friction.axial, friction.transverse].map(number);
    let coefficients = match friction.axial == friction.transverse {
        true => format!("Coulomb friction with the coefficient {axial}"),
        false => format!(
            "Coulomb friction with the coefficients {axial} along the line, {transverse} across it and for points"
        ),
    };
    format!(
        "{coefficients}, which sticks and slides; at the start every line lies as if laid without tension from end A, or from end B where only that is on the seabed, and hauled at the other end"
    )
}
