//! Free points in the sea in words.

use std::f64::consts::PI;

use super::significant;
use crate::scene::{Axis, InitialShape, Line, Point, PointKind, Scene};

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

    /// Where a free point starts.
    pub(super) fn start_in_words(&self, point: &Point) -> Option<&'static str> {
        if point.kind != PointKind::Free {
            return None;
        }
        let network = self.network_of(point);
        let mut shapes = network.iter().map(|line| &line.initial);
        Some(match shapes.any(|shape| *shape == InitialShape::Static) {
            true => "starts in static equilibrium",
            false => "starts at its position, as no line of its network is `static`",
        })
        .filter(|_| !network.is_empty())
    }

    /// The lines that hang together with a free point, through it and others.
    fn network_of(&self, point: &Point) -> Vec<&Line> {
        let free: Vec<&str> = self
            .points
            .iter()
            .filter(|point| point.kind == PointKind::Free)
            .map(|point| point.name.as_str())
            .collect();
        let mut joined = vec![point.name.as_str()];
        let (mut network, mut rest): (Vec<&Line>, Vec<&Line>) = (vec![], self.lines.iter().collect());
        loop {
            let (reached, beyond): (Vec<&Line>, _) = rest.into_iter().partition(|line| {
                [&line.from, &line.to]
                    .iter()
                    .any(|end| joined.contains(&end.as_str()))
            });
            if reached.is_empty() {
                return network;
            }
            let ends = reached
                .iter()
                .flat_map(|line| [line.from.as_str(), line.to.as_str()]);
            joined.extend(ends.filter(|end| free.contains(end)));
            network.extend(reached);
            rest = beyond;
        }
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
        let moves = point.free.as_ref().is_none_or(|axes| axes.contains(&Axis::Z));
        (weight > 0.0 && moves && bed.stiffness > 0.0).then(|| {
            "should it touch the bed, it rests there on a spring that its weight in air presses in by 0.02 m".to_string()
        })
    }
}
