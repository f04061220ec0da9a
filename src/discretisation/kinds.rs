//! Networks of lines that are copies of one another: the same lines between points at the same positions except for a displacement along the seabed,
//! with the same motion. Over a long time in waves, the errors of their meshes are equal, so one network of each kind is tried. Networks with beams
//! are not tried and do not prevent trials of the others.

use std::collections::BTreeMap;

use crate::scene::{Line, MotionPath, Point, Scene, Vessel};

use super::{Discretisation, Mesh, Networks, elements_of, short_sections};

/// Greatest distance at which two positions are taken as the same [m].
const SAME_PLACE: f64 = 1e-3;

/// The networks of a scene by kind.
pub(super) struct Kinds {
    /// First network of the same kind, for every network.
    first: Vec<usize>,
    /// Scene reduced to the first network of each kind.
    pub(super) scene: Scene,
    /// Index in the whole scene of every line of the reduced scene.
    lines: Vec<usize>,
}

impl Kinds {
    /// Returns the kinds; `None` if every network must be tried or none can be.
    pub(super) fn of(scene: &Scene, networks: &Networks) -> Option<Kinds> {
        let level = scene
            .seabed
            .as_ref()
            .is_none_or(|seabed| seabed.slope.is_none() && seabed.file.is_none() && seabed.grid.is_none());
        let alone = |lines: &Vec<usize>| Part::of(scene, lines).displaced();
        let seen: Vec<Part> = networks.lines.iter().map(alone).collect();
        let of_kind = |(i, network): (usize, &Part)| {
            let same = seen.iter().position(|other| level && other == network);
            same.unwrap_or(i)
        };
        let first: Vec<usize> = seen.iter().enumerate().map(of_kind).collect();
        let is_tried = |&network: &usize| first[network] == network && !networks.beams[network];
        let kept = (0..first.len()).filter(is_tried);
        let mut lines: Vec<usize> = kept.flat_map(|network| networks.lines[network].clone()).collect();
        lines.sort_unstable();
        (!lines.is_empty() && lines.len() < scene.lines.len()).then(|| Kinds {
            first,
            scene: Part::of(scene, &lines).in_place_of_all(scene),
            lines,
        })
    }

    /// Returns the result for the whole scene from the result for the reduced scene.
    pub(super) fn expanded(
        &self,
        found: &Discretisation,
        scene: &Scene,
        networks: &Networks,
    ) -> Discretisation {
        let mesh = |network: usize| {
            let tried = |mesh: &&Mesh| {
                let mut lines = mesh.lines.iter().map(|&line| self.lines[line]);
                lines.any(|line| networks.lines[self.first[network]].contains(&line))
            };
            let lines = networks.lines[network].clone();
            match found.meshes.iter().find(tried) {
                Some(mesh) => Mesh {
                    lines,
                    ..mesh.clone()
                },
                None => Mesh {
                    tried: !networks.beams[network],
                    ..Mesh::by_rule(lines, scene.solver.tolerance)
                },
            }
        };
        let meshes: Vec<Mesh> = (0..networks.lines.len()).map(mesh).collect();
        let mut whole = networks.with_elements(scene, &elements_of(&meshes));
        for (lines, &first) in networks.lines.iter().zip(&self.first) {
            for (&line, of_kind) in lines.iter().zip(&networks.lines[first]) {
                if let Some(tried) = self.lines.iter().position(|kept| kept == of_kind) {
                    short_sections::take_over(&mut whole, line, &found.scene, tried);
                }
            }
        }
        if !networks.beams.contains(&true) {
            whole.solver.integrator = found.scene.solver.integrator;
        }
        whole.solver.time_step_max = found.scene.solver.time_step_max;
        Discretisation {
            scene: whole,
            meshes: networks.open(&meshes).cloned().collect(),
            duration: found.duration,
            untried_steps: found.untried_steps,
        }
    }
}

/// Lines of a scene, with their points and the vessels and motions of these.
#[derive(PartialEq)]
struct Part {
    lines: Vec<Line>,
    points: Vec<Point>,
    vessels: Vec<Vessel>,
    motion: BTreeMap<String, MotionPath>,
}

impl Part {
    fn of(scene: &Scene, lines: &[usize]) -> Part {
        let lines: Vec<Line> = lines.iter().map(|&line| scene.lines[line].clone()).collect();
        let joined = |point: &&Point| lines.iter().any(|line| line.joins(&point.name));
        let points: Vec<Point> = scene.points.iter().filter(joined).cloned().collect();
        let carries = |vessel: &&Vessel| points.iter().any(|point| point.on.as_ref() == Some(&vessel.name));
        let vessels: Vec<Vessel> = scene.vessels.iter().filter(carries).cloned().collect();
        let names = points.iter().map(|point| &point.name);
        let names = names.chain(vessels.iter().map(|vessel| &vessel.name));
        let motion = names.filter_map(|name| Some((name.clone(), scene.motion.get(name)?.clone())));
        Part {
            motion: motion.collect(),
            lines,
            points,
            vessels,
        }
    }

    /// Returns the scene reduced to this part.
    fn in_place_of_all(self, scene: &Scene) -> Scene {
        let mut reduced = scene.clone();
        reduced.lines = self.lines;
        reduced.points = self.points;
        reduced.vessels = self.vessels;
        reduced.motion = self.motion;
        reduced.output.channels.clear();
        reduced
    }

    /// Replaces names by numbers, and positions by whole numbers of [`SAME_PLACE`], horizontally from the first vessel or point.
    fn displaced(mut self) -> Part {
        let vessels = self.vessels.iter().map(|vessel| vessel.position);
        let mut places = vessels.chain(self.points.iter().map(|point| point.position));
        let origin = places.next().unwrap_or_default();
        let about =
            |[x, y, z]: [f64; 3]| [x - origin[0], y - origin[1], z].map(|part| (part / SAME_PLACE).round());
        let mut numbers = BTreeMap::new();
        for (i, vessel) in self.vessels.iter_mut().enumerate() {
            vessel.position = about(vessel.position);
            number(&mut numbers, &mut vessel.name, format!("vessel {i}"));
        }
        for (i, point) in self.points.iter_mut().enumerate() {
            match &mut point.on {
                Some(vessel) => *vessel = numbers[vessel].clone(),
                None => point.position = about(point.position),
            }
            number(&mut numbers, &mut point.name, format!("point {i}"));
        }
        for (i, line) in self.lines.iter_mut().enumerate() {
            line.name = format!("line {i}");
            line.from = numbers[&line.from].clone();
            line.to = numbers[&line.to].clone();
        }
        let motion = self.motion.into_iter();
        self.motion = motion
            .map(|(name, path)| (numbers[&name].clone(), path))
            .collect();
        self
    }
}

/// Renames a point or vessel of a part.
fn number(numbers: &mut BTreeMap<String, String>, name: &mut String, number: String) {
    numbers.insert(std::mem::replace(name, number.clone()), number);
}
