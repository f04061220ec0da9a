//! Free points in the sea in words.

use std::f64::consts::PI;

use super::significant;
use crate::scene::{Axis, Point, PointKind, Scene};

impl Scene {
    /// What water and bed do to a point; nothing where neither does anything.
    pub(super) fn sea_in_words(&self, point: &Point) -> Option<String> {
        if point.kind != PointKind::Free {
            let own = point.mass.is_some() || point.volume.is_some() || point.drag_area.is_some();
            let text = "which add to the force of its lines on what moves it".to_string();
            let said = [self.water_in_words(point), own.then_some(text)];
            let said: Vec<String> = said.into_iter().flatten().collect();
            return (!said.is_empty()).then(|| said.join(", "));
        }
        let said: Vec<String> = [self.water_in_words(point), self.bed_in_words(point)]
            .into_iter()
            .flatten()
            .collect();
        (!said.is_empty()).then(|| said.join("; "))
    }

    /// Whether the water's surface acts on a free point.
    pub(super) fn surface_matters(&self) -> bool {
        let mut free = self.points.iter().filter(|p| p.kind == PointKind::Free);
        free.any(|point| self.radius(point).is_some())
    }

    /// Radius of the sphere that the water knows a point by [m]; `None` where it does nothing to it.
    fn radius(&self, point: &Point) -> Option<f64> {
        self.water.as_ref()?;
        let of = |value: Option<f64>| value.filter(|value| *value > 0.0);
        let by_volume = of(point.volume).map(|volume| (0.75 * volume / PI).cbrt());
        by_volume.or_else(|| of(point.drag_area).map(|area| (area / PI).sqrt()))
    }

    fn water_in_words(&self, point: &Point) -> Option<String> {
        let radius = self.radius(point)?;
        let acts = |value: Option<f64>| value.is_some_and(|value| value > 0.0);
        let volume = acts(point.volume);
        let acting = [
            ("buoyancy", volume),
            ("drag", acts(point.drag_area)),
            ("added mass", volume && acts(point.added_mass)),
        ];
        let named = |acts: bool| {
            let kinds = acting.iter().filter(|(_, does)| *does == acts);
            kinds.map(|(name, _)| *name).collect::<Vec<&str>>()
        };
        let absent = named(false);
        let absent = match absent.is_empty() {
            true => String::new(),
            false => format!(", no {}", absent.join(", no ")),
        };
        Some(format!(
            "in the water {}{absent}, as of a sphere of radius {} m as far as it is under z = 0",
            named(true).join(", "),
            significant(radius)
        ))
    }

    fn bed_in_words(&self, point: &Point) -> Option<String> {
        let bed = self.seabed.as_ref()?;
        let weight = point.mass.unwrap_or(0.0) * self.gravity;
        let moves = point
            .free
            .as_ref()
            .is_none_or(|axes| axes.contains(&Axis::Z));
        (weight > 0.0 && moves && bed.stiffness > 0.0).then(|| {
            "should it touch the bed, it rests there on a spring that its weight in air presses in by 0.02 m".to_string()
        })
    }
}
