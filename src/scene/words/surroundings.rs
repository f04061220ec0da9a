//! Gravity, water, current, waves and seabed in words.

use super::{join, triple};
use crate::scene::check::{number, quantity};
use crate::scene::{
    ContactLaw, Current, Scene, Sea, Seabed, SpectrumKind, TimeFunction, Water, WaveComponents, Waves,
};

impl Scene {
    pub(super) fn surroundings_in_words(&self) -> Vec<String> {
        let gravity = match self.gravity {
            0.0 => "no gravity".to_string(),
            gravity => format!("gravity {} along -z", quantity(gravity, "m/s²")),
        };
        let water = self.water.as_ref().map(|water| self.water_in_words(water));
        let seabed = self
            .seabed
            .as_ref()
            .map(|seabed| seabed_in_words(seabed, self.all_beams()));
        let water = water.unwrap_or_else(|| "no water".to_string());
        vec![gravity, water, seabed.unwrap_or_else(|| "no seabed".to_string())]
    }

    /// "still water, 1025 kg/m³, without a free surface".
    fn water_in_words(&self, water: &Water) -> String {
        let still = water.current.is_none() && !water.accelerates();
        let still = if still { "still " } else { "" };
        let mut words = format!(
            "{still}water, {}, {}",
            quantity(water.density, "kg/m³"),
            self.surface_in_words()
        );
        if let Some(current) = &water.current {
            words += &format!(
                "; current {}; drag follows the velocity relative to the water, in static equilibrium too",
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
                .map_or("", |_| ", in addition to the current");
            words += &format!(
                "; its velocity and acceleration at the nodes are inputs of the host{added}, zero without a host; drag and inertia forces on \
                 lines and points follow from them; the surface stays level"
            );
        }
        words
    }

    /// Names of the lines that meet the water's surface, or of those that do not.
    fn lines_that_meet_surface(&self, meet: bool) -> Vec<&str> {
        let lines = self.lines.iter().filter(|line| self.meets_surface(line) == meet);
        lines.map(|line| line.name.as_str()).collect()
    }

    /// "without a free surface", or the lines that may come out of the water.
    fn surface_in_words(&self) -> String {
        let [piercing, submerged] = [true, false].map(|meet| self.lines_that_meet_surface(meet));
        if piercing.is_empty() {
            return "without a free surface".to_string();
        }
        let have = |names: &[&str]| {
            format!(
                "{} {}",
                join(names),
                if names.len() == 1 { "has" } else { "have" }
            )
        };
        let moves = self.waves().is_some();
        let level = if moves { ", moved by the waves" } else { "" };
        let others = match submerged.is_empty() {
            true => String::new(),
            false => format!("; {} them everywhere", have(&submerged)),
        };
        let piercing = have(&piercing);
        format!(
            "with a free surface at z = 0{level}, above which {piercing} no buoyancy, drag or added mass{others}"
        )
    }

    /// Effects of the water that are not modelled: "current, waves and the free surface".
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
            _ if piercing > 0 || self.surface_matters() => absent.push("the free surface above some lines"),
            _ => absent.push("the free surface"),
        }
        if absent.is_empty() {
            absent.push("second-order waves");
        }
        join(&absent)
    }

    /// "linear (Airy) waves in …: significant height 6 m, …".
    fn waves_in_words(&self, waves: &Waves) -> String {
        let seas: Vec<String> = waves.seas.iter().map(sea_in_words).collect();
        let seas = seas.join("; ");
        let depth = self.seabed.as_ref().map(|seabed| quantity(seabed.depth, "m"));
        let over = depth.map_or("deep water".to_string(), |depth| {
            format!("a water depth of {depth}")
        });
        let height = height_of(waves.deviation());
        let all = match waves.seas.len() {
            1 => String::new(),
            _ => format!(", {height} of significant height in total"),
        };
        let ramp = waves.ramp().map(|ramp| quantity(ramp, "s"));
        let ramp = ramp.map_or(", without a ramp".to_string(), |ramp| {
            format!(", with a ramp of {ramp}")
        });
        format!(
            "linear (Airy) waves in {over}: {seas}{all}{ramp}; Wheeler stretching; components with less than 1e-4 of the acceleration at the \
             surface are neglected; drag, Froude-Krylov force and added mass follow the motion relative to the water; no drift, wave breaking \
             or wave-current interaction; the initial equilibrium includes the current but no waves"
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
        let (count, plural) = (rows.len(), if rows.len() == 1 { "" } else { "s" });
        let height = height_of(sea.variance().sqrt());
        return format!("{count} wave component{plural} with a significant height of {height}");
    }
    let kind = match sea.spectrum {
        Some(SpectrumKind::PiersonMoskowitz) => "Pierson-Moskowitz spectrum".to_string(),
        _ => format!("JONSWAP spectrum, peak enhancement {}", number(sea.gamma())),
    };
    let spread = sea.spreading.map(number);
    let spread = spread.map(|s| format!(", cos²ˢ spreading of the half angle with s = {s}"));
    let [height, period] =
        [(sea.significant_height, "m"), (sea.peak_period, "s")].map(|(value, unit)| of(value, unit));
    let (direction, seed, count) = (
        of(sea.direction, "rad"),
        sea.seed.unwrap_or_default(),
        sea.number(),
    );
    let spread = spread.unwrap_or_default();
    format!(
        "{kind}, significant height {height}, peak period {period}, towards {direction}{spread}; {count} components of equal \
         energy, seed {seed}"
    )
}

/// "(1, 0, 0) m/s (speed 1 m/s) at all depths, steady".
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
            format!("{} m/s (speed {speed}) at all depths", triple(velocity))
        }
    };
    let times = match &current.factor {
        None => ", steady".to_string(),
        Some(TimeFunction::Constant(factor)) => format!(", steady, with a factor of {}", number(*factor)),
        Some(_) => {
            ", with a factor that varies in time; inertia forces of the accelerating current are neglected"
                .to_string()
        }
    };
    shape + &times
}

/// "from (0.3, 0) m/s at z = -200 m to (1, 0) m/s at z = 0 m, linear between 3 depths and constant beyond them".
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
        1 => format!("{lower} and at all other depths"),
        count => format!("from {lower} to {upper}, linear between {count} depths and constant beyond them"),
    }
}

fn seabed_in_words(seabed: &Seabed, under_beams: bool) -> String {
    let law = match seabed.contact {
        ContactLaw::Regularised => {
            "both reduced on coarse meshes, where up to 0.2 of critical damping is kept; lines at rest lie up to 1.5 % of an element below the seabed"
        }
        ContactLaw::AsGiven => "used as given",
        ContactLaw::AtNodes => "used as given, at the nodes only",
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
    let friction = match seabed.friction.acts() && !under_beams {
        true => friction_in_words(seabed),
        false => "no friction".to_string(),
    };
    let shape = shape_in_words(seabed);
    let statics = match seabed.is_level() {
        true => "",
        false => "; statics use elements, since there is no closed-form catenary on such a seabed",
    };
    format!(
        "{shape}: normal stiffness {spring} and damping {damper}{chosen} per metre of length and of diameter, {law}; {friction}{statics}"
    )
}

/// Shape of the seabed.
fn shape_in_words(seabed: &Seabed) -> String {
    let depth = quantity(-seabed.depth, "m");
    match (&seabed.grid, seabed.slope) {
        (Some(grid), _) => {
            let soundings = || grid.depth.iter().flatten().copied();
            let least = soundings().fold(f64::INFINITY, f64::min);
            let most = soundings().fold(f64::NEG_INFINITY, f64::max);
            let span = |line: &[f64]| match line {
                [first, .., last] => format!("from {} to {}", number(*first), quantity(*last, "m")),
                _ => "uniform".to_string(),
            };
            format!(
                "seabed interpolated from {} by {} soundings, x {}, y {}, depth from {} to {}, constant beyond them",
                grid.x.len(),
                grid.y.len(),
                span(&grid.x),
                span(&grid.y),
                number(least),
                quantity(most, "m")
            )
        }
        (None, Some([x, y])) if !seabed.is_level() => format!(
            "plane seabed through z = {depth} at the origin, rising by {} per metre of x and {} per metre of y",
            number(x),
            number(y)
        ),
        _ => format!("flat seabed at z = {depth}"),
    }
}

fn friction_in_words(seabed: &Seabed) -> String {
    let friction = seabed.friction;
    let [axial, transverse] = [friction.axial, friction.transverse].map(number);
    let coefficients = match friction.axial == friction.transverse {
        true => format!("Coulomb friction with a coefficient of {axial}"),
        false => format!(
            "Coulomb friction with coefficients of {axial} along the line, {transverse} across it and for points"
        ),
    };
    format!(
        "{coefficients}, with sticking and sliding; each line starts as if laid without tension from end A (from end B if only that is on the seabed) and then pulled at the other end"
    )
}
