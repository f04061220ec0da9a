//! Properties of a line that is a geometrically exact beam, and its state.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use crate::math::rotation::{frame_along, turned_to};
use crate::physics::section::{
    self, Mixture, Section, SectionLaw, Sextuple, StepStrain, StrainEnergy, split,
};

/// A line as a beam: two-node elements, one per segment, and lumped rotary inertia.
#[derive(Debug, Clone)]
pub struct Beam {
    /// Elements, one per segment.
    pub elements: Vec<BeamElement>,
    /// Rotary inertia of the nodes about their three directors [kg m²].
    pub rotary_inertia: Vec<Vector3<f64>>,
    /// Direction of the line at ends A and B where they are clamped, with the point in its reference attitude [-].
    pub clamped: [Option<Vector3<f64>>; 2],
    /// True if the initial shape is free of stress; otherwise the straight line is.
    pub rests_as_it_starts: bool,
}

/// A two-node beam element.
#[derive(Debug, Clone, Copy)]
pub struct BeamElement {
    /// Unstretched length [m].
    pub length: f64,
    /// Stiffness of its section.
    pub law: SectionLaw,
    /// Viscous damping of its section, along the same axes.
    pub damping: SectionLaw,
}

/// State of a beam: the frames and rates of its nodes in addition to positions and velocities.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct BeamState {
    /// Orthonormal frames of the nodes, d₁ d₂ d₃ as columns [-].
    pub frames: Vec<Matrix3<f64>>,
    /// Angular velocities along those directors [rad/s].
    pub spins: Vec<Vector3<f64>>,
    /// Starred strains of the unstressed elements [-], [1/m].
    pub rest: Vec<Sextuple>,
    /// Frames of clamped ends A and B in their points' reference attitude [-].
    pub carried: [Matrix3<f64>; 2],
    /// Course of the nodes over the last steps.
    pub course: Course,
}

/// Mean rates of the nodes of a beam over the last steps, from which those of the next step are predicted. The unknowns of a step are the mean rates
/// over it. They contain no motion that alternates from step to step, such as motion that the step does not resolve.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// Length of the last step [s].
    length: f64,
    /// Mean velocity [m/s] and angular velocity along the directors [rad/s] over the last step, and their first and second backward differences.
    rates: Vec<[Sextuple; 3]>,
}

impl Course {
    /// Course of `nodes` nodes at rest.
    fn at_rest(nodes: usize) -> Course {
        Course {
            length: 0.0,
            rates: vec![[Sextuple::zeros(); 3]; nodes],
        }
    }

    /// Mean rates of node `i` over the next step of a length [s], on the parabola through the last three.
    pub fn predict(&self, i: usize, length: f64) -> Sextuple {
        let ([rate, first, second], apart) = self.scaled(i, length);
        rate + apart * (first + 0.5 * (apart + 1.0) * second)
    }

    /// Rates of node `i` at the end of the last step, on the same parabola; `None` before the first step.
    pub fn reached(&self, i: usize) -> Option<Sextuple> {
        let [rate, first, second] = self.rates[i];
        (self.length > 0.0).then(|| rate + 0.5 * first + 0.375 * second)
    }

    /// Records the mean rates of node `i` over a step of a length [s].
    pub fn follow(&mut self, i: usize, rate: Sextuple, length: f64) {
        let ([last, first, _], apart) = self.scaled(i, length);
        let change = (rate - last) / apart;
        self.rates[i] = [rate, change, change - first];
    }

    /// Ends a step of a length [s], after [`Course::follow`] for all nodes.
    pub fn end_step(&mut self, length: f64) {
        self.length = length;
    }

    /// Rates and differences of node `i`, scaled to steps of a length [s], and the time between the middles of the last step and
    /// the next, relative to that length [-].
    fn scaled(&self, i: usize, length: f64) -> ([Sextuple; 3], f64) {
        if self.length == 0.0 {
            return (self.rates[i], 1.0);
        }
        let ([rate, first, second], ratio) = (self.rates[i], length / self.length);
        let scaled = [rate, ratio * first, ratio * ratio * second];
        (scaled, 0.5 + 0.5 / ratio)
    }
}

impl Clone for Course {
    fn clone(&self) -> Self {
        Course {
            length: self.length,
            rates: self.rates.clone(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.length = source.length;
        self.rates.clone_from(&source.rates);
    }
}

impl BeamState {
    /// Beam at rest on node positions [m], without twist; the points that the ends are clamped to have the given
    /// attitudes [-].
    pub fn at_rest(beam: &Beam, position: &[Vector3<f64>], attitude: [Matrix3<f64>; 2]) -> BeamState {
        let last = position.len() - 1;
        let clamp = |end: usize| beam.clamped[end].map(|direction| attitude[end] * direction);
        let direction = |i: usize| match i {
            0 => clamp(0).unwrap_or_else(|| node_direction(position, 0)),
            i if i == last => clamp(1).unwrap_or_else(|| node_direction(position, last)),
            i => node_direction(position, i),
        };
        let mut frames = Vec::with_capacity(position.len());
        let mut frame = frame_along(direction(0), Vector3::z());
        for i in 0..=last {
            frame = turned_to(&frame, direction(i));
            frames.push(frame);
        }
        let section = |i: usize| Section {
            position: position[i],
            frame: frames[i],
        };
        let rest = |(i, element): (usize, &BeamElement)| match beam.rests_as_it_starts {
            true => {
                let plain = section::strain(&section(i), &section(i + 1), element.length);
                let mut rest = section::corrected(&plain, element.length);
                rest[2] = section::straight()[2]; // unstretched at the length of the element
                rest
            }
            false => section::straight(),
        };
        BeamState {
            rest: beam.elements.iter().enumerate().map(rest).collect(),
            carried: [0, 1].map(|end| attitude[end].transpose() * frames[end * last]),
            spins: vec![Vector3::zeros(); position.len()],
            course: Course::at_rest(position.len()),
            frames,
        }
    }
}

/// Unit tangent at a node: the mean of its segments' directions; at an end, that of the arc through it and the next node.
fn node_direction(position: &[Vector3<f64>], i: usize) -> Vector3<f64> {
    let last = position.len() - 1;
    let segment = |i: usize| unit(position[i + 1] - position[i]).unwrap_or_else(Vector3::zeros);
    let inner = |i: usize| unit(segment(i - 1) + segment(i)).unwrap_or_else(|| segment(i));
    let direction = match i {
        0 | 1 if last == 1 => segment(0),
        0 => mirrored(inner(1), segment(0)),
        i if i == last => mirrored(inner(last - 1), segment(last - 1)),
        i => inner(i),
    };
    unit(direction).unwrap_or_else(Vector3::x)
}

fn unit(v: Vector3<f64>) -> Option<Vector3<f64>> {
    v.try_normalize(f64::MIN_POSITIVE)
}

/// A direction mirrored about another: a circle's tangents at both ends of a chord.
fn mirrored(v: Vector3<f64>, about: Vector3<f64>) -> Vector3<f64> {
    2.0 * v.dot(&about) * about - v
}

impl BeamElement {
    /// Strain relative to the unstressed state, from the sections at both ends.
    #[inline(always)]
    pub fn strain(&self, a: &Section, b: &Section, rest: &Sextuple) -> Sextuple {
        section::corrected(&section::strain(a, b, self.length), self.length) - rest
    }

    /// Strain of the element over a step between two plain strains [-], [1/m], relative to the unstressed starred strains.
    pub fn over_step(
        &self,
        strains: [&Sextuple; 2],
        rest: &Sextuple,
        mixture: Mixture,
    ) -> StepStrain<Vector3<f64>> {
        let pair = |both: &Sextuple| split(both).into();
        StepStrain {
            laws: [&self.law, &self.damping].map(|law| pair(&law.diagonal())),
            length: self.length,
            strains: strains.map(pair),
            rest: pair(rest),
            mixture,
        }
    }

    /// Energy at a strain relative to the unstressed state.
    pub fn energy(&self, strain: &Sextuple) -> StrainEnergy {
        self.law.energy(strain, self.length)
    }
}

impl Clone for BeamState {
    fn clone(&self) -> Self {
        BeamState {
            frames: self.frames.clone(),
            spins: self.spins.clone(),
            rest: self.rest.clone(),
            carried: self.carried,
            course: self.course.clone(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.frames.clone_from(&source.frames);
        self.spins.clone_from(&source.spins);
        self.rest.clone_from(&source.rest);
        self.carried = source.carried;
        self.course.clone_from(&source.course);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const NONE: SectionLaw = SectionLaw {
        shear: 0.0,
        axial: 0.0,
        bending: 0.0,
        torsion: 0.0,
    };

    fn beam(n: usize, length: f64, clamped: [Option<Vector3<f64>>; 2], rests: bool) -> Beam {
        let element = BeamElement {
            length: length / n as f64,
            law: NONE,
            damping: NONE,
        };
        Beam {
            elements: vec![element; n],
            rotary_inertia: vec![Vector3::zeros(); n + 1],
            clamped,
            rests_as_it_starts: rests,
        }
    }

    /// A quarter circle of radius 1 m.
    fn quarter(n: usize) -> Vec<Vector3<f64>> {
        (0..=n)
            .map(|i| std::f64::consts::FRAC_PI_2 * i as f64 / n as f64)
            .map(|angle| Vector3::new(angle.sin(), 0.0, 1.0 - angle.cos()))
            .collect()
    }

    #[test]
    fn frames_on_an_arc_lie_along_its_tangents() {
        let n = 6;
        let arc = quarter(n);
        let state = BeamState::at_rest(
            &beam(n, 1.57, [None, None], false),
            &arc,
            [Matrix3::identity(); 2],
        );
        for (frame, r) in state.frames.iter().zip(&arc) {
            let tangent = Vector3::new(1.0 - r.z, 0.0, r.x);
            assert_relative_eq!(frame.column(2).into_owned(), tangent, epsilon = 1e-14);
        }
    }

    #[test]
    fn a_beam_that_rests_as_it_starts_is_not_bent_there_and_is_stretched_by_its_length() {
        let n = 5;
        let arc = quarter(n);
        for length in [1.5, std::f64::consts::FRAC_PI_2] {
            let beam = beam(n, length, [None, None], true);
            let state = BeamState::at_rest(&beam, &arc, [Matrix3::identity(); 2]);
            for i in 0..n {
                let section = |i: usize| Section {
                    position: arc[i],
                    frame: state.frames[i],
                };
                let mut strain = beam.elements[i].strain(&section(i), &section(i + 1), &state.rest[i]);
                let stretch = std::mem::take(&mut strain[2]);
                let expected = std::f64::consts::FRAC_PI_2 / length - 1.0;
                assert_relative_eq!(stretch, expected, epsilon = 3e-5 + 0.02 * expected); // elements of 0.3 rad
                assert_relative_eq!(strain, Sextuple::zeros(), epsilon = 1e-15);
            }
        }
    }

    #[test]
    fn a_clamped_end_points_along_its_clamp_and_follows_the_attitude_of_its_point() {
        let turn = crate::math::rotation::cayley(Vector3::new(0.0, 0.4, 0.1));
        let beam = beam(4, 1.5, [Some(Vector3::z()), None], false);
        let state = BeamState::at_rest(&beam, &quarter(4), [turn, Matrix3::identity()]);
        let along = state.frames[0].column(2).into_owned();
        assert_relative_eq!(along, turn * Vector3::z(), epsilon = 1e-14);
        assert_relative_eq!(turn * state.carried[0], state.frames[0], epsilon = 1e-14);
    }

    #[test]
    fn rates_on_a_parabola_are_predicted_after_three_steps() {
        let (step, mut course) = (0.1, Course::at_rest(1));
        let rate = |k: usize| {
            let t = step * (k as f64 + 0.5);
            Sextuple::repeat(2.0 - 3.0 * t + 7.0 * t * t)
        };
        for k in 0..3 {
            course.follow(0, rate(k), step);
            course.end_step(step);
        }
        assert_relative_eq!(course.predict(0, step), rate(3), epsilon = 1e-14);
        let half_way = Sextuple::repeat(2.0 - 0.9 + 0.63); // at t = 0.3 s
        assert_relative_eq!(course.reached(0).unwrap(), half_way, epsilon = 1e-14);
    }
}
