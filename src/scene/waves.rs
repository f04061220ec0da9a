//! Waves that a scene can write down: `{ … }` of one sea, `[{ … }, { … }]` of several that add up.

use std::fmt;

use serde::de::value::MapAccessDeserializer;
use serde::de::{self, Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Serialize, Serializer};

/// Seas that add up, such as swell and a wind sea.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Waves {
    /// The seas.
    pub seas: Vec<Sea>,
}

/// A sea: `regular`, or `components` as a list, or a `spectrum`, with a `ramp`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sea {
    /// One train of waves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub regular: Option<RegularWave>,
    /// Rows of amplitude [m], period [s], direction [rad], phase [rad]; or, of a spectrum, their number [-].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub components: Option<WaveComponents>,
    /// A file of MoorDyn's format that the components stand in: rows of ω [rad/s], real and imaginary part of the amplitude [m] of
    /// sin(ωt − kx) and direction [rad].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// A spectrum that components are drawn from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spectrum: Option<SpectrumKind>,
    /// Significant height of a spectrum, four standard deviations of the elevation [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub significant_height: Option<f64>,
    /// Period of a spectrum's peak [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peak_period: Option<f64>,
    /// Peakedness γ of a JONSWAP spectrum [-]; 3.3 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub peakedness: Option<f64>,
    /// Mean direction that a spectrum's waves travel to, from x towards y [rad]; 0 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<f64>,
    /// Exponent s of the spread cos²ˢ(½(θ − direction)) of a spectrum's directions [-]; all alike where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spreading: Option<f64>,
    /// What the frequencies, phases and directions of a spectrum's components are drawn from [-]; 0 where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Duration of the cosine ramp ½(1 − cos(πt/ramp)) of all seas [s]; none where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ramp: Option<f64>,
}

/// One train of waves, η = a cos(k·x − ωt + phase). Give its `height` or its `amplitude`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegularWave {
    /// Height from trough to crest [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Half the height [m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub amplitude: Option<f64>,
    /// Period [s].
    pub period: f64,
    /// Direction it travels to, from x towards y [rad].
    #[serde(default)]
    pub direction: f64,
    /// Phase [rad]; with 0 a crest is at x = y = 0 at t = 0.
    #[serde(default)]
    pub phase: f64,
}

/// Shape of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpectrumKind {
    /// Of a sea that still grows (Hasselmann et al. 1973).
    Jonswap,
    /// Of a fully developed sea (Pierson & Moskowitz 1964).
    PiersonMoskowitz,
}

/// Components as a list, or how many of them.
#[derive(Debug, Clone, PartialEq)]
pub enum WaveComponents {
    /// Rows of amplitude [m], period [s], direction [rad], phase [rad].
    Rows(Vec<[f64; 4]>),
    /// How many are drawn from a spectrum [-].
    Number(u64),
}

/// Components drawn from a spectrum where the scene gives no number [-].
const COMPONENTS: u64 = 100;
/// Peakedness of a JONSWAP spectrum where the scene gives none [-], the mean of the measurements.
const PEAKEDNESS: f64 = 3.3;

impl Sea {
    /// How many components are drawn from the spectrum [-].
    pub fn number(&self) -> u64 {
        match self.components {
            Some(WaveComponents::Number(number)) => number,
            _ => COMPONENTS,
        }
    }

    /// Variance of the elevation [m²].
    pub fn variance(&self) -> f64 {
        if let Some(regular) = &self.regular {
            return 0.5 * regular.half_height().unwrap_or_default().powi(2);
        }
        match &self.components {
            Some(WaveComponents::Rows(rows)) => rows.iter().map(|row| 0.5 * row[0] * row[0]).sum(),
            _ => (0.25 * self.significant_height.unwrap_or_default()).powi(2),
        }
    }

    /// Peakedness γ of the spectrum [-]; 1 makes a Pierson-Moskowitz spectrum of it.
    pub fn gamma(&self) -> f64 {
        match self.spectrum {
            Some(SpectrumKind::PiersonMoskowitz) => 1.0,
            _ => self.peakedness.unwrap_or(PEAKEDNESS),
        }
    }
}

impl RegularWave {
    /// Half the height [m]; `None` unless one of the two is given.
    pub fn half_height(&self) -> Option<f64> {
        match (self.height, self.amplitude) {
            (Some(height), None) => Some(0.5 * height),
            (None, amplitude) => amplitude,
            (Some(_), Some(_)) => None,
        }
    }
}

impl Waves {
    /// Standard deviation of the elevation [m].
    pub fn deviation(&self) -> f64 {
        self.seas.iter().map(Sea::variance).sum::<f64>().sqrt()
    }

    /// Duration of the ramp [s], where one of the seas says so.
    pub fn ramp(&self) -> Option<f64> {
        self.seas.iter().find_map(|sea| sea.ramp)
    }
}

impl Serialize for Waves {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.seas.as_slice() {
            [sea] => sea.serialize(serializer),
            seas => seas.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Waves {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WavesVisitor)
    }
}

struct WavesVisitor;

impl<'de> Visitor<'de> for WavesVisitor {
    type Value = Waves;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "a sea, { regular = { height, period } }, { components = [[amplitude, period, direction, phase], …] } or \
             { spectrum = \"jonswap\", significant_height, peak_period }, or an array of seas",
        )
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Waves, A::Error> {
        let sea = Sea::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Waves { seas: vec![sea] })
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Waves, A::Error> {
        let mut seas = Vec::new();
        while let Some(sea) = sequence.next_element()? {
            seas.push(sea);
        }
        Ok(Waves { seas })
    }
}

impl Serialize for WaveComponents {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            WaveComponents::Rows(rows) => rows.serialize(serializer),
            WaveComponents::Number(number) => number.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for WaveComponents {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ComponentsVisitor)
    }
}

struct ComponentsVisitor;

impl<'de> Visitor<'de> for ComponentsVisitor {
    type Value = WaveComponents;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "rows [[amplitude, period, direction, phase], …], or the number of components of a spectrum",
        )
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<WaveComponents, E> {
        let number = u64::try_from(value);
        number
            .map(WaveComponents::Number)
            .map_err(|_| de::Error::invalid_value(de::Unexpected::Signed(value), &self))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<WaveComponents, E> {
        Ok(WaveComponents::Number(value))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<WaveComponents, A::Error> {
        let mut rows = Vec::new();
        while let Some(row) = sequence.next_element()? {
            rows.push(row);
        }
        Ok(WaveComponents::Rows(rows))
    }
}
