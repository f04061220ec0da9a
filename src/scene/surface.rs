//! Lines that may come out of the water.

use super::{Line, MotionPath, Point, PointKind, Scene};

/// Depth of a wave trough in standard deviations of the elevation [-].
const TROUGH: f64 = 3.0;

impl Scene {
    /// Returns whether a line may come out of the water: as set by `water.surface`; otherwise if, in the reference configuration, one of its ends
    /// lies above z = 0, or above the troughs of waves, or if it is buoyant or ends at a free point that floats, and is long enough to come up. Beams
    /// never do.
    pub fn meets_surface(&self, line: &Line) -> bool {
        self.meets_surface_between(line, [&line.from, &line.to].map(|name| self.point(name)))
    }

    /// As [`Scene::meets_surface`], for the given points at the ends of the line.
    pub(crate) fn meets_surface_between(&self, line: &Line, ends: [Option<&Point>; 2]) -> bool {
        let Some(water) = &self.water else {
            return false;
        };
        if self.is_beam(line) {
            return false;
        }
        water.surface.unwrap_or_else(|| self.comes_up(line, ends))
    }

    fn comes_up(&self, line: &Line, ends: [Option<&Point>; 2]) -> bool {
        let end = |point: Option<&Point>| Some((self.reference_position(point?)?[2], self.floats(point?)));
        let [Some((a, a_floats)), Some((b, b_floats))] = ends.map(end) else {
            return false;
        };
        let length = line.length();
        let buoyant = self.types_of(line).any(|line_type| self.weight(line_type) < 0.0);
        // the maximum height to which a line of this length could be pulled up
        let highest = match (a_floats, b_floats) {
            (true, true) => f64::INFINITY,
            (true, false) => b + length,
            (false, true) => a + length,
            (false, false) if buoyant => 0.5 * (a + b + length),
            (false, false) => a.max(b),
        };
        let waves = self.waves();
        let trough = waves.map_or(0.0, |waves| -TROUGH * waves.deviation());
        highest > trough
    }

    /// Returns whether a line is modelled as submerged at any height without the user having been told: the scene leaves `water.surface` open, and no
    /// note on the scene's own motion, if the run follows it, names an end of the line.
    pub(crate) fn submerges_silently(&self, line: &Line, follows_scene: bool) -> bool {
        let open = self.water.as_ref().is_some_and(|water| water.surface.is_none());
        let mut ends = [&line.from, &line.to]
            .into_iter()
            .filter_map(|name| self.point(name));
        let noted = |point: &Point| follows_scene && self.highest(point) > 0.0;
        open && !self.meets_surface(line) && !ends.any(noted)
    }

    /// Greatest height to which the scene's own motion lifts a point [m].
    pub(super) fn highest(&self, point: &Point) -> f64 {
        self.reference_position(point).map_or(0.0, |place| place[2]) + self.rise(point)
    }

    /// Maximum height by which the scene's own motion lifts a point [m].
    fn rise(&self, point: &Point) -> f64 {
        let body = point.on.as_ref().unwrap_or(&point.name);
        let path = point.motion.as_ref().or_else(|| self.motion.get(body));
        let Some([_, _, z, roll, pitch, _]) = path.map(MotionPath::greatest) else {
            return 0.0;
        };
        let [x, y, height] = point.position;
        let arm = match point.on {
            Some(_) => x.hypot(y).hypot(height),
            None => 0.0,
        };
        z + arm * (roll + pitch).min(2.0) // a rotation moves a point by at most twice its arm
    }

    /// Returns whether a free point is lighter than the water it displaces.
    fn floats(&self, point: &Point) -> bool {
        let density = self.water.as_ref().map_or(0.0, |water| water.density);
        let displaced = density * point.volume.unwrap_or(0.0);
        point.kind == PointKind::Free && displaced > point.mass.unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line of 30 m between points at the given heights [m].
    fn scene(water: &str, line_type: &str, heights: [f64; 2], end: &str) -> Scene {
        let [a, b] = heights;
        let text = format!(
            r#"
            water = {{ density = 1025.0{water} }}
            line_types.rope = {{ diameter = 0.1, axial_stiffness = 1e6, {line_type} }}
            points = [
              {{ name = "a", position = [0.0, 0.0, {a}], kind = "fixed" }},
              {{ name = "b", position = [10.0, 0.0, {b}], {end} }},
            ]
            vessels = [{{ name = "barge", position = [0.0, 0.0, 0.0] }}]
            lines = [{{ name = "line", from = "a", to = "b", sections = [{{ type = "rope", length = 30.0 }}] }}]
            "#
        );
        Scene::from_toml(&text).unwrap()
    }

    fn meets(scene: &Scene) -> bool {
        scene.meets_surface(&scene.lines[0])
    }

    #[test]
    fn a_line_meets_the_surface_where_an_end_is_above_it_or_it_could_float_up() {
        let held = "kind = \"fixed\"";
        let (heavy, light) = ("mass = 20.0", "mass = 5.0");
        assert!(meets(&scene("", heavy, [-20.0, 0.5], held)));
        assert!(!meets(&scene("", heavy, [-20.0, 0.0], held)));
        assert!(!meets(&scene("", heavy, [-10.0, -4.0], held)));
        assert!(meets(&scene("", light, [-10.0, -4.0], held)));
        assert!(!meets(&scene("", light, [-40.0, -4.0], held)));
        let buoy = "kind = \"free\", mass = 10.0, volume = 1.0";
        let clump = "kind = \"free\", mass = 1e4, volume = 1.0";
        assert!(meets(&scene("", heavy, [-20.0, -5.0], buoy)));
        assert!(!meets(&scene("", heavy, [-40.0, -5.0], buoy)));
        assert!(!meets(&scene("", heavy, [-20.0, -5.0], clump)));
    }

    #[test]
    fn the_scenes_motion_lifts_a_point_by_its_amplitudes_or_its_highest_row() {
        let mut scene = scene("", "mass = 20.0", [-20.0, -2.0], "kind = \"coupled\"");
        assert_eq!(scene.rise(&scene.points[1]), 0.0);
        for (path, rise) in [
            ("z = [[1.5, 10.0], [-1.0, 7.0]]", 2.5),
            ("x = [[9.0, 10.0]]", 0.0),
            ("table = [[0.0, 0.0, 0.0, 0.0], [5.0, 0.0, 0.0, 2.1]]", 2.1),
            ("table = [[0.0, 0.0, 0.0, 0.0], [5.0, 0.0, 0.0, -2.1]]", 0.0),
        ] {
            let moved = crate::scene::part(path).unwrap();
            scene.motion.insert("b".to_string(), moved);
            assert_eq!(scene.rise(&scene.points[1]), rise, "{path}");
        }
    }

    #[test]
    fn a_vessel_lifts_a_point_by_its_arm_as_it_rolls() {
        let held = "kind = \"coupled\", on = \"barge\"";
        let mut scene = scene("", "mass = 20.0", [-20.0, -2.0], held);
        let path = crate::scene::part("roll = [[0.1, 10.0]]\nz = [[0.5, 9.0]]").unwrap();
        scene.motion.insert("barge".to_string(), path);
        let rise = 0.5 + 0.1 * f64::hypot(10.0, 2.0);
        approx::assert_relative_eq!(scene.rise(&scene.points[1]), rise, max_relative = 1e-12);
    }

    #[test]
    fn the_scene_decides_whether_lines_meet_the_surface() {
        let held = "kind = \"fixed\"";
        let heavy = "mass = 20.0";
        let given = |word: &str, z: f64| {
            let water = format!(", surface = {word}");
            meets(&scene(&water, heavy, [-20.0, z], held))
        };
        assert!(given("true", -19.0));
        assert!(!given("false", 5.0));
    }
}
