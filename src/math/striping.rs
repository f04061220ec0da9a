//! Striped layout of a chain of nodes over the lanes of vectors: the neighbours of a vector of nodes are whole vectors too.
//!
//! With m = ⌈count/4⌉ rows, node i is in row i mod m of lane ⌊i/m⌋:
//!
//! ```text
//! row 0, halo        ·    m−1   2m−1   3m−1
//! row 1              0     m     2m     3m
//! row 2              1    m+1   2m+1   3m+1
//! …
//! row m             m−1  2m−1   3m−1   4m−1
//! row m+1, halo      m    2m     3m     ·
//! ```
//!
//! The nodes before and after those of a row are in the rows before and after it: no lane is shifted, and no vector that is read overlaps two written
//! ones. The halo rows repeat rows m and 1, shifted by one lane; `wrap` updates them after these rows have changed. Nodes beyond the last one are
//! padding. Segment i, between nodes i and i + 1, is in the slot of node i.
//!
//! The last lane of the last halo row is not a copy: it is the slot of node 4m, which `wrap` does not change. A chain whose last node needs no row,
//! because no value is computed for it, has one row fewer if its segments fill their rows ([`Striping::without_last`]).

use nalgebra::Vector3;
use std::ops::{Index, IndexMut};

use super::lanes::{LANES, Lanes, Vectors};

/// Striped layout of a chain, given by its number of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Striping {
    rows: usize,
}

/// Row and lane of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot {
    /// Row; the first is number 1.
    pub row: usize,
    /// Lane.
    pub lane: usize,
}

impl Striping {
    /// Layout for `count` nodes.
    pub fn new(count: usize) -> Striping {
        Striping {
            rows: count.div_ceil(LANES).max(1),
        }
    }

    /// Layout for `count` nodes, the last of which needs no row.
    pub fn without_last(count: usize) -> Striping {
        Striping::new(count - 1)
    }

    /// Number of rows without the halo [-].
    pub fn rows(self) -> usize {
        self.rows
    }

    /// Number of nodes that fit into the layout [-].
    pub fn room(self) -> usize {
        LANES * self.rows
    }

    /// Slot of node `i`.
    pub fn slot(self, i: usize) -> Slot {
        // faster than a division; every step looks up the end nodes
        let lane = (1..LANES).map(|k| usize::from(i >= k * self.rows)).sum();
        Slot {
            row: i - lane * self.rows + 1,
            lane,
        }
    }

    /// Slots of all nodes that fit into the layout, in order, then that of the next node.
    pub fn slots(self) -> impl Iterator<Item = Slot> {
        let rows = 1..=self.rows;
        let inner = (0..LANES).flat_map(move |lane| rows.clone().map(move |row| Slot { row, lane }));
        inner.chain(std::iter::once(self.slot(self.room())))
    }

    /// Column with a number for every node, and `padding` after the last one.
    pub fn column(self, values: &[f64], padding: f64) -> Column {
        let mut column = Column::new(self, padding);
        column.assign(values);
        column
    }
}

impl Slot {
    /// Slot of the previous node, in a halo row at the start of a lane.
    pub fn before(self) -> Slot {
        Slot {
            row: self.row - 1,
            ..self
        }
    }

    /// Slot of the next node, in a halo row at the end of a lane.
    pub fn after(self) -> Slot {
        Slot {
            row: self.row + 1,
            ..self
        }
    }
}

/// One number for every node of a striped chain.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    rows: Vec<Lanes>,
}

impl Column {
    /// Column with the same number everywhere.
    pub fn new(striping: Striping, value: f64) -> Column {
        Column {
            rows: vec![Lanes::splat(value); striping.rows + 2],
        }
    }

    /// Rows up to the halo after row `last`.
    #[inline(always)]
    pub fn rows(&self, last: usize) -> &[Lanes] {
        &self.rows[..last + 2]
    }

    /// Rows up to the halo after row `last`, for writing.
    #[inline(always)]
    pub fn rows_mut(&mut self, last: usize) -> &mut [Lanes] {
        &mut self.rows[..last + 2]
    }

    /// Numbers in a row.
    #[inline(always)]
    pub fn load(&self, row: usize) -> Lanes {
        self.rows[row]
    }

    /// Writes the numbers in a row.
    #[inline(always)]
    pub fn store(&mut self, lanes: Lanes, row: usize) {
        self.rows[row] = lanes;
    }

    /// Sets all numbers to `value`.
    pub fn fill(&mut self, value: f64) {
        self.rows.fill(Lanes::splat(value));
    }

    /// Writes the numbers of the first nodes.
    pub fn assign(&mut self, values: &[f64]) {
        let slots = self.striping().slots();
        slots.zip(values).for_each(|(at, value)| self[at] = *value);
        self.wrap();
    }

    /// Numbers of the first `count` nodes.
    pub fn values(&self, count: usize) -> impl Iterator<Item = f64> + '_ {
        self.striping().slots().take(count).map(|at| self[at])
    }

    /// Updates the halo.
    #[inline(always)]
    pub fn wrap(&mut self) {
        let last = self.rows.len() - 1;
        self.rows[0] = self.rows[last - 1].moved_up();
        // the sum prevents the compiler from storing lane by lane, which would delay loads of the whole vector
        self.rows[last] = self.rows[1].moved_down_before(self.rows[last]) + Lanes::splat(0.0);
    }

    /// Striped layout of the chain.
    pub fn striping(&self) -> Striping {
        Striping {
            rows: self.rows.len() - 2,
        }
    }
}

impl Index<Slot> for Column {
    type Output = f64;
    fn index(&self, at: Slot) -> &f64 {
        &self.rows[at.row][at.lane]
    }
}

impl IndexMut<Slot> for Column {
    fn index_mut(&mut self, at: Slot) -> &mut f64 {
        &mut self.rows[at.row][at.lane]
    }
}

/// One vector for every node of a striped chain.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Field {
    rows: Vec<Vectors>,
}

impl Field {
    /// Field of zero vectors.
    pub fn zeros(striping: Striping) -> Field {
        Field {
            rows: vec![Vectors::zero(); striping.rows + 2],
        }
    }

    /// Rows up to the halo after row `last`.
    #[inline(always)]
    pub fn rows(&self, last: usize) -> &[Vectors] {
        &self.rows[..last + 2]
    }

    /// Rows up to the halo after row `last`, for writing.
    #[inline(always)]
    pub fn rows_mut(&mut self, last: usize) -> &mut [Vectors] {
        &mut self.rows[..last + 2]
    }

    /// Vectors in a row.
    #[inline(always)]
    pub fn load(&self, row: usize) -> Vectors {
        self.rows[row]
    }

    /// Writes the vectors in a row.
    #[inline(always)]
    pub fn store(&mut self, vectors: Vectors, row: usize) {
        self.rows[row] = vectors;
    }

    /// Vector of a node.
    #[inline(always)]
    pub fn get(&self, at: Slot) -> Vector3<f64> {
        self.rows[at.row].get(at.lane)
    }

    /// Writes the vector of a node.
    #[inline(always)]
    pub fn set(&mut self, at: Slot, vector: Vector3<f64>) {
        self.rows[at.row].set(at.lane, vector);
    }

    /// Updates the halo.
    #[inline(always)]
    pub fn wrap(&mut self) {
        let last = self.rows.len() - 1;
        self.rows[0] = self.rows[last - 1].moved_up();
        self.wrap_after();
    }

    /// Updates the halo after the last row.
    #[inline(always)]
    pub fn wrap_after(&mut self) {
        let last = self.rows.len() - 1;
        // stored as a whole, see Column::wrap
        self.rows[last] = self.rows[1].moved_down_before(self.rows[last]) + Vectors::zero();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_stand_in_the_rows_before_and_after() {
        for count in 1..30 {
            let striping = Striping::new(count);
            assert!(striping.room() >= count && striping.room() < count + LANES);
            let values: Vec<f64> = (0..count).map(|i| i as f64).collect();
            let column = striping.column(&values, -1.0);
            assert!(column.values(count).eq(values));
            for i in 0..count {
                let at = striping.slot(i);
                assert_eq!(striping.slots().nth(i), Some(at));
                assert_eq!(column[at], i as f64);
                assert!(i == 0 || column[at.before()] == i as f64 - 1.0);
                assert!(i + 1 == count || column[at.after()] == i as f64 + 1.0);
            }
        }
    }

    #[test]
    fn a_last_node_without_a_row_stands_behind_the_others() {
        for count in 2..30 {
            let striping = Striping::without_last(count);
            assert!(striping.room() + 1 >= count);
            let values: Vec<f64> = (0..count).map(|i| i as f64).collect();
            let mut column = striping.column(&values, -1.0);
            column.wrap();
            assert!(column.values(count).eq(values));
            let last = striping.slot(count - 1);
            assert_eq!(last.row > striping.rows(), striping.room() == count - 1);
            assert_eq!(column[last.before()], count as f64 - 2.0);
        }
    }

    #[test]
    fn vectors_stand_where_numbers_do() {
        let striping = Striping::new(11);
        let mut field = Field::zeros(striping);
        let vector = |i: usize| Vector3::new(i as f64, -1.0, 2.0 * i as f64);
        (0..11).for_each(|i| field.set(striping.slot(i), vector(i)));
        field.wrap();
        for i in 1..10 {
            let at = striping.slot(i);
            let near = [at.before(), at, at.after()].map(|at| field.get(at));
            assert_eq!(near, [i - 1, i, i + 1].map(vector));
        }
    }
}
