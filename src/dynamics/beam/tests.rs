use super::*;
use crate::model::{BeamElement, BeamState, FreePoint, PointContact};
use crate::physics::point::Sphere;
use crate::physics::seabed::ContactCoefficients;
use crate::physics::section::SectionLaw;
use approx::assert_relative_eq;

fn spaghetti_law(bending: f64) -> SectionLaw {
    SectionLaw {
        shear: 1e4,
        axial: 1e4,
        bending,
        torsion: bending,
    }
}

const UNDAMPED: SectionLaw = SectionLaw {
    shear: 0.0,
    axial: 0.0,
    bending: 0.0,
    torsion: 0.0,
};

/// Straight beam of n elements at rest, with a mass of 1 kg/m and a rotary inertia of 10 kg m.
fn beam(n: usize, a: Vector3<f64>, b: Vector3<f64>, law: SectionLaw) -> (Beam, Nodes, LineState) {
    let length = (b - a).norm() / n as f64;
    let share = |i: usize| {
        if i == 0 || i == n { 0.5 * length } else { length }
    };
    let lengths: Vec<f64> = (0..=n).map(share).collect();
    let element = BeamElement {
        length,
        law,
        damping: UNDAMPED,
    };
    let beam = Beam {
        elements: vec![element; n],
        rotary_inertia: lengths.iter().map(|l| 10.0 * l * Vector3::repeat(1.0)).collect(),
        clamped: [None, None],
        rests_as_it_starts: false,
    };
    let nodes = Nodes {
        arc: (0..=n).map(|i| i as f64 * length).collect(),
        mass: lengths.clone(),
        mass_normal: lengths.clone(),
        mass_tangent: lengths.clone(),
        weight: vec![0.0; n + 1],
        length: lengths,
        drag: None,
        froude_krylov: None,
        contact: None,
        mass_damping: None,
    };
    let position = (0..=n).map(|i| a + (b - a) * i as f64 / n as f64).collect();
    let mut shape = LineState::at_rest(position);
    let attitude = [Matrix3::identity(); 2];
    shape.beam = Some(BeamState::at_rest(&beam, &shape.position, attitude));
    (beam, nodes, shape)
}

/// Flying spaghetti: state of the beam at `time` [s]; the load acts until 2.5 s.
struct Flight {
    beam: Beam,
    nodes: Nodes,
    shape: LineState,
    work: BeamWork,
    time: f64,
    moment: Vector3<f64>,
    solves: usize,
}

impl Flight {
    fn new(n: usize, bending: f64, moment: Vector3<f64>) -> Flight {
        let (a, b) = (Vector3::new(6.0, 0.0, 0.0), Vector3::new(0.0, 8.0, 0.0));
        let (beam, nodes, shape) = beam(n, a, b, spaghetti_law(bending));
        Flight {
            beam,
            nodes,
            shape,
            work: BeamWork::new(n + 1),
            time: 0.0,
            moment,
            solves: 0,
        }
    }

    fn step(&mut self, dt: f64) -> Flow {
        let loaded = ((2.5 - self.time) / dt).clamp(0.0, 1.0);
        let mut ends = [BeamEnd::default(); 2];
        ends[0].load = loaded * join(8.0 * Vector3::x(), self.moment);
        let at = |node: usize| Section {
            position: self.shape.position[node],
            frame: Matrix3::identity(),
        };
        let case = BeamStep {
            beam: &self.beam,
            nodes: &self.nodes,
            ends,
            targets: [at(0), at(self.shape.position.len() - 1)],
            bodies: [None; 2],
            length: dt,
            energy_balance: true,
        };
        let (solves, flow) = self.work.step(&case, &mut self.shape).unwrap();
        self.solves += solves;
        self.time += dt;
        flow
    }

    fn view(&self) -> BeamView<'_> {
        BeamView {
            beam: &self.beam,
            nodes: &self.nodes,
            shape: &self.shape,
        }
    }
}

fn clockwise() -> Vector3<f64> {
    -80.0 * Vector3::z()
}

const FREE: [[bool; 6]; 2] = [[false; 6]; 2];

/// Simulates 10 s in steps of 0.1 s: after the load ends, energy and momenta are constant, and the work of the load equals
/// the energy of the beam.
fn assert_conserves(bending: f64, moment: Vector3<f64>) -> Flight {
    let mut flight = Flight::new(20, bending, moment);
    let (mut given, mut worst) = (0.0, 0.0_f64);
    let mut reference = None;
    for step in 1..=100 {
        given += flight.step(0.1).external_work;
        let (energy, momentum) = (flight.view().energy(FREE).total(), flight.view().momentum());
        if step >= 25 {
            let (e, p) = *reference.get_or_insert((energy, momentum));
            worst = worst.max((energy - e).abs() / e);
            worst = worst.max((momentum.linear - p.linear).norm() / p.linear.norm());
            worst = worst.max((momentum.angular - p.angular).norm() / p.angular.norm());
            assert_relative_eq!(given, energy, max_relative = 1e-10);
        }
    }
    assert!(worst < 1e-10, "{worst:e}");
    let impulse = 2.5 * 8.0 * Vector3::x();
    assert_relative_eq!(flight.view().momentum().linear, impulse, epsilon = 1e-11);
    flight
}

#[test]
fn a_flying_beam_keeps_energy_and_both_momenta() {
    for moment in [clockwise(), -clockwise()] {
        for bending in [100.0, 500.0] {
            assert_conserves(bending, moment);
        }
    }
}

#[test]
fn a_beam_turned_about_two_axes_keeps_energy_and_both_momenta_in_space() {
    let flight = assert_conserves(100.0, Vector3::new(0.0, -40.0, -80.0));
    assert!(flight.shape.position[0].z.abs() > 0.5);
}

#[test]
fn newton_converges_quadratically() {
    let mut flight = Flight::new(40, 100.0, Vector3::new(30.0, 0.0, -80.0));
    (0..50).for_each(|_| {
        flight.step(0.05);
    });
    assert!(flight.solves <= 50 * 6, "{} solves", flight.solves);
}

/// Beam in water over a seabed, with prescribed translation and rotation at end A.
fn dragged(n: usize) -> (Flight, impl Fn(f64) -> Section) {
    let mut flight = Flight::new(n, 100.0, Vector3::zeros());
    let nodes = &mut flight.nodes;
    let count = nodes.mass.len();
    nodes.mass_normal = nodes.mass.iter().map(|m| 2.0 * m).collect();
    nodes.mass_tangent = nodes.mass.iter().map(|m| 1.2 * m).collect();
    nodes.weight = nodes.length.iter().map(|l| 5.0 * l).collect();
    nodes.mass_damping = Some(nodes.mass.iter().map(|m| 0.1 * m).collect());
    nodes.drag = Some(crate::model::Drag {
        normal: nodes.length.iter().map(|l| 3.0 * l).collect(),
        tangent: nodes.length.iter().map(|l| 0.3 * l).collect(),
    });
    nodes.contact = Some(crate::model::Contact {
        seabed_level: -0.2,
        level: vec![-0.2; count],
        stiffness: vec![200.0; count - 1],
        damping: vec![5.0; count - 1],
        weight: vec![0.0; count - 1],
        mass: vec![1.0; count - 1],
        regularised: None,
        at_nodes: false,
        seabed: None,
        stick: Vec::new(),
    });
    for element in &mut flight.beam.elements {
        element.damping = SectionLaw {
            shear: 1.0,
            axial: 10.0,
            bending: 2.0,
            torsion: 1.0,
        };
    }
    let start = Section {
        position: flight.shape.position[0],
        frame: flight.shape.beam.as_ref().unwrap().frames[0],
    };
    let target = move |t: f64| Section {
        position: start.position + (1.0 - t.cos()) * Vector3::new(0.5, 0.2, 0.7),
        frame: cayley(0.3 * (1.0 - t.cos()) * Vector3::new(0.2, 1.0, 0.5)) * start.frame,
    };
    (flight, target)
}

#[test]
fn the_energy_balance_of_a_damped_beam_in_water_over_a_seabed_closes_to_rounding() {
    let (mut flight, target) = dragged(20);
    let held = [[true; 6], [false; 6]];
    let start = flight.view().energy(held).total();
    let (mut given, mut lost) = (0.0, 0.0);
    for _ in 0..200 {
        let case = BeamStep {
            beam: &flight.beam,
            nodes: &flight.nodes,
            ends: [
                BeamEnd {
                    held: [true; 6],
                    ..BeamEnd::default()
                },
                BeamEnd::default(),
            ],
            targets: [target(flight.time + 0.02); 2],
            bodies: [None; 2],
            length: 0.02,
            energy_balance: true,
        };
        let (_, flow) = flight.work.step(&case, &mut flight.shape).unwrap();
        flight.time += 0.02;
        given += flow.external_work;
        lost += flow.dissipation;
        let energy = flight.view().energy(held).total();
        assert_relative_eq!(energy - start, given - lost, epsilon = 1e-8);
    }
    assert!(lost > 1.0 && flight.shape.position[20].z < -0.1);
}

/// Point that is free along all axes, with a mass [kg], a volume [m³] and a seabed at a height [m].
fn body(mass: f64, volume: f64, seabed: f64) -> FreePoint {
    let (density, gravity) = (1000.0, 10.0);
    FreePoint {
        axes: [true; 3],
        mass,
        weight: gravity * (mass - density * volume),
        sphere: Sphere::new([volume, 0.3, 0.5], density, gravity),
        contact: Some(PointContact {
            seabed_level: seabed,
            level: seabed,
            coefficients: ContactCoefficients {
                stiffness: 2e4,
                damping: 50.0,
            },
        }),
    }
}

#[test]
fn the_energy_balance_of_a_beam_with_a_buoy_and_a_clump_in_a_current_closes_to_rounding() {
    let mut flight = Flight::new(12, 100.0, Vector3::zeros());
    let (buoy, clump) = (body(20.0, 0.1, -9.0), body(40.0, 0.01, -0.4));
    let bodies = [&buoy, &clump].map(|point| {
        let water = Vector3::new(0.5, 0.3, 0.0);
        Some(Body { point, water })
    });
    let held = |flight: &Flight| {
        let ends = [(&buoy, 0), (&clump, 12)].map(|(point, node)| {
            let height = flight.shape.position[node].z;
            let squared = flight.shape.velocity[node].norm_squared();
            0.5 * point.at(height).mass * squared + point.potential(height)
        });
        flight.view().energy(FREE).total() + ends[0] + ends[1]
    };
    let (start, mut flow) = (held(&flight), Flow::default());
    let mut lowest = f64::INFINITY;
    for _ in 0..150 {
        let case = BeamStep {
            beam: &flight.beam,
            nodes: &flight.nodes,
            ends: [BeamEnd::default(); 2],
            targets: [Section {
                position: Vector3::zeros(),
                frame: Matrix3::identity(),
            }; 2],
            bodies,
            length: 0.02,
            energy_balance: true,
        };
        flow.add(flight.work.step(&case, &mut flight.shape).unwrap().1);
        assert_relative_eq!(
            held(&flight) - start,
            flow.external_work - flow.dissipation,
            epsilon = 1e-8
        );
        lowest = flight.shape.position[12].z.min(lowest);
    }
    assert!(flow.dissipation > 1.0 && flow.external_work > 0.1 && lowest < -0.4);
}

#[test]
fn a_turn_of_more_than_half_a_circle_in_a_step_is_refused_and_changes_nothing() {
    let mut flight = Flight::new(6, 100.0, 1e7 * Vector3::z());
    let before = flight.shape.clone();
    let case = BeamStep {
        beam: &flight.beam,
        nodes: &flight.nodes,
        ends: [
            BeamEnd {
                load: join(Vector3::zeros(), 1e7 * Vector3::z()),
                ..BeamEnd::default()
            },
            BeamEnd::default(),
        ],
        targets: [Section {
            position: Vector3::zeros(),
            frame: Matrix3::identity(),
        }; 2],
        bodies: [None; 2],
        length: 1.0,
        energy_balance: true,
    };
    assert!(flight.work.step(&case, &mut flight.shape).is_err());
    assert_eq!(flight.shape, before);
}
