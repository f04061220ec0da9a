//! Water surface over a line of a leapfrog. Between two steps, weight, drag and mass of the surface-piercing nodes are set to the values for
//! their submergence, so that the kernels need no special case.

use crate::math::lanes::{LANES, Lanes};
use crate::math::striping::{Column, Field, Striping};
use crate::model::{Dry, Line, Nodes, Surface};

/// A line that may pierce the surface, and its submergence at t_n.
#[derive(Debug, Clone)]
pub struct SurfaceNow {
    surface: Surface,
    nodes: Nodes,
    /// Largest radius of the segments adjacent to the nodes [m].
    radius: Column,
    /// Height of the water surface at the nodes, and its minimum [m].
    level: Vec<f64>,
    lowest: f64,
    dry: Vec<Dry>,
    /// Buoyancy that the nodes would lose in still water [N]; used in waves.
    calm: Vec<f64>,
    /// Work of the difference in buoyancy between waves and still water since the state was loaded [J].
    pub lifted: f64,
    /// Dry fractions of the nodes at t_{n−1} [-].
    before: Vec<f64>,
    /// True if any node is partly dry, or was at t_{n−1}.
    crosses: bool,
}

/// Properties of a node at t_n.
#[derive(Debug, Clone, Copy)]
pub struct NodeNow {
    /// Weight less buoyancy [N].
    pub weight: f64,
    /// Mass across and along the line [kg].
    pub masses: [f64; 2],
    /// Drag coefficients across and along the line [N s²/m²].
    pub drag: [f64; 2],
    /// Mass in the Froude-Krylov force, across and along the line [kg].
    pub froude_krylov: [f64; 2],
}

impl SurfaceNow {
    /// Allocates the surface over a line; `None` if the line does not pierce the surface.
    pub fn new(line: &Line, striping: Striping) -> Option<SurfaceNow> {
        let surface = line.surface.clone()?;
        let count = line.segment_count() + 1;
        let segments = |i: usize| &surface.radius[i.saturating_sub(1)..(i + 1).min(count - 1)];
        let greatest = |i: usize| segments(i).iter().copied().fold(0.0, f64::max);
        let radii: Vec<f64> = (0..count).map(greatest).collect();
        Some(SurfaceNow {
            radius: striping.column(&radii, f64::NEG_INFINITY),
            surface,
            nodes: line.nodes.clone(),
            level: vec![0.0; count],
            lowest: 0.0,
            dry: vec![Dry::default(); count],
            before: vec![0.0; count],
            calm: vec![0.0; count],
            lifted: 0.0,
            crosses: false,
        })
    }

    /// Sets the height of the water surface at the nodes [m].
    pub fn set_level(&mut self, level: impl Fn(usize) -> f64) {
        self.lowest = f64::INFINITY;
        for (i, height) in self.level.iter_mut().enumerate() {
            *height = level(i);
            self.lowest = self.lowest.min(*height);
        }
    }

    /// Computes dry fractions and lost buoyancy of nodes at `position` [m].
    pub fn find(&mut self, striping: Striping, position: &Field) {
        let submerged = self.top(striping, position) <= self.lowest;
        if submerged && !self.crosses {
            return;
        }
        self.crosses = false;
        for (before, dry) in self.before.iter_mut().zip(&mut self.dry) {
            *before = dry.part;
            *dry = Dry::default();
            self.crosses |= *before > 0.0;
        }
        if submerged {
            return;
        }
        self.crosses = true;
        for i in 0..self.surface.radius.len() {
            let heights = [i, i + 1].map(|node| position.get(striping.slot(node)).z - self.level[node]);
            let Some(at) = self.surface.segment(i, heights, 0.0) else {
                continue;
            };
            for end in 0..2 {
                let dry = &mut self.dry[i + end];
                dry.part += self.surface.share[i][end] * at.parts[end];
                dry.weight += self.surface.buoyancy[i] * at.parts[end];
            }
        }
    }

    /// Computes the buoyancy that nodes at `position` [m] would lose in still water.
    pub fn find_calm(&mut self, striping: Striping, position: &Field) {
        self.calm.fill(0.0);
        if self.top(striping, position) <= 0.0 {
            return;
        }
        for i in 0..self.surface.radius.len() {
            let heights = [i, i + 1].map(|node| position.get(striping.slot(node)).z);
            if let Some(at) = self.surface.segment(i, heights, 0.0) {
                for end in 0..2 {
                    self.calm[i + end] += self.surface.buoyancy[i] * at.parts[end];
                }
            }
        }
    }

    /// Upper bound on the height of the line above still water [m], for nodes at `position` [m].
    fn top(&self, striping: Striping, position: &Field) -> f64 {
        let last = striping.rows();
        let rows = position.rows(last).iter().zip(self.radius.rows(last));
        let tops = rows.skip(1).map(|(position, radius)| position.z + *radius);
        let top = tops.fold(Lanes::splat(f64::NEG_INFINITY), Lanes::max);
        (0..LANES).map(|lane| top[lane]).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Adds the work of the difference in buoyancy between waves and still water on node `i`, which rises by `way` [m].
    pub fn lift(&mut self, i: usize, way: f64) {
        self.lifted += (self.calm[i] - self.dry[i].weight) * way;
    }

    /// Indices of the nodes that are partly dry, or were before the last [`Self::find`].
    pub fn crossed(&self) -> impl Iterator<Item = usize> + '_ {
        let count = if self.crosses { self.dry.len() } else { 0 };
        let nodes = self.dry[..count].iter().zip(&self.before).enumerate();
        nodes.filter_map(|(i, (dry, before))| (dry.part > 0.0 || *before > 0.0).then_some(i))
    }

    /// Properties of a node at t_n.
    pub fn node(&self, i: usize) -> NodeNow {
        let (nodes, dry) = (&self.nodes, self.dry[i]);
        let wet = 1.0 - dry.part;
        let drag = nodes.drag.as_ref();
        NodeNow {
            weight: nodes.weight[i] + dry.weight,
            masses: nodes.masses(i, dry.part),
            drag: drag.map_or([0.0; 2], |drag| [wet * drag.normal[i], wet * drag.tangent[i]]),
            froude_krylov: nodes
                .froude_krylov
                .as_ref()
                .map_or([0.0; 2], |masses| masses.masses(i, dry.part)),
        }
    }

    /// Buoyancy that a node loses at t_n [N]; in waves, that which it would lose in still water.
    pub fn lack(&self, i: usize, waves: bool) -> f64 {
        if waves { self.calm[i] } else { self.dry[i].weight }
    }
}
