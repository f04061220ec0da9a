//! Copies of a scene placed next to each other, for tests and benches.

use moorline::scene::Scene;

/// `count` separate copies of a scene, spaced along an axis by a distance [m].
pub fn copies(one: &Scene, count: usize, axis: usize, distance: f64) -> Scene {
    let mut scene = one.clone();
    (scene.vessels, scene.points, scene.lines) = (Vec::new(), Vec::new(), Vec::new());
    scene.motion.clear();
    for unit in 0..count {
        let named = |name: &str| format!("{name}_{unit}");
        let moved = |mut place: [f64; 3]| {
            place[axis] += distance * unit as f64;
            place
        };
        for mut vessel in one.vessels.clone() {
            (vessel.name, vessel.position) = (named(&vessel.name), moved(vessel.position));
            scene.vessels.push(vessel);
        }
        for mut point in one.points.clone() {
            if point.on.is_none() {
                point.position = moved(point.position);
            }
            (point.name, point.on) = (named(&point.name), point.on.as_deref().map(named));
            scene.points.push(point);
        }
        for mut line in one.lines.clone() {
            (line.name, line.from, line.to) = (named(&line.name), named(&line.from), named(&line.to));
            scene.lines.push(line);
        }
        let motion = one.motion.iter().map(|(name, path)| (named(name), path.clone()));
        scene.motion.extend(motion);
    }
    scene
}
