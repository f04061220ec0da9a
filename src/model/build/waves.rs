//! Waves of a scene.

use std::f64::consts::TAU;

use crate::physics::airy::{Component, Waves};
use crate::physics::spectrum::Spectrum;
use crate::scene::{Scene, Sea, WaveComponents};

/// Waves of a scene, if it has any.
pub(super) fn waves(scene: &Scene) -> Option<Waves> {
    let waves = scene.water.as_ref()?.waves.as_ref()?;
    let seas = waves.seas.iter().zip(0..);
    let components: Vec<Component> = seas.flat_map(|(sea, place)| components(sea, place)).collect();
    let depth = scene.seabed.as_ref().map(|seabed| seabed.depth);
    let depth = depth.filter(|depth| *depth > 0.0);
    Some(Waves::new(&components, depth, waves.ramp(), scene.gravity))
}

/// Components of the sea at a place in the list.
fn components(sea: &Sea, place: u64) -> Vec<Component> {
    if let Some(regular) = &sea.regular {
        return vec![Component {
            amplitude: regular.half_height().unwrap_or_default(),
            frequency: TAU / regular.period,
            direction: regular.direction,
            phase: regular.phase,
        }];
    }
    if let Some(WaveComponents::Rows(rows)) = &sea.components {
        let row = |[amplitude, period, direction, phase]: &[f64; 4]| Component {
            amplitude: *amplitude,
            frequency: TAU / period,
            direction: *direction,
            phase: *phase,
        };
        return rows.iter().map(row).collect();
    }
    let spectrum = Spectrum {
        significant_height: sea.significant_height.unwrap_or_default(),
        peak_period: sea.peak_period.unwrap_or(1.0),
        peakedness: sea.gamma(),
        direction: sea.direction.unwrap_or_default(),
        spreading: sea.spreading,
    };
    spectrum.draw(
        sea.number() as usize,
        sea.spectrum_seed(place).unwrap_or_default(),
    )
}
