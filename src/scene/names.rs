//! Look-up of points and vessels by name, for loops over all of them.

use std::collections::HashMap;

use super::{Line, Point, Scene, Vessel};

/// Points and vessels of a scene by name; the first one if a name occurs twice.
pub(crate) struct Names<'s> {
    scene: &'s Scene,
    points: HashMap<&'s str, usize>,
    vessels: HashMap<&'s str, usize>,
}

impl<'s> Names<'s> {
    /// Look-up by name for a scene.
    pub(crate) fn of(scene: &'s Scene) -> Names<'s> {
        let points = scene.points.iter().map(|point| &point.name[..]);
        let vessels = scene.vessels.iter().map(|vessel| &vessel.name[..]);
        Names {
            scene,
            points: by_name(points),
            vessels: by_name(vessels),
        }
    }

    pub(crate) fn point_index(&self, name: &str) -> Option<usize> {
        self.points.get(name).copied()
    }

    pub(crate) fn point(&self, name: &str) -> Option<&'s Point> {
        Some(&self.scene.points[self.point_index(name)?])
    }

    pub(crate) fn ends(&self, line: &Line) -> [Option<&'s Point>; 2] {
        [&line.from, &line.to].map(|name| self.point(name))
    }

    pub(crate) fn vessel_index(&self, name: &str) -> Option<usize> {
        self.vessels.get(name).copied()
    }

    pub(crate) fn vessel(&self, name: &str) -> Option<&'s Vessel> {
        Some(&self.scene.vessels[self.vessel_index(name)?])
    }
}

fn by_name<'s>(
    names: impl DoubleEndedIterator<Item = &'s str> + ExactSizeIterator,
) -> HashMap<&'s str, usize> {
    names
        .enumerate()
        .rev()
        .map(|(index, name)| (name, index))
        .collect()
}
