//! Mooring for scripts that use MoorDyn's Python package: a class around `moorline_system`, whose objects count from 0 in the deck's order.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use moorline_system::log::{Log, WARNING};
use moorline_system::nodes::Quantity;
use moorline_system::settings::Settings;
use moorline_system::system::System;
use moorline_system::{Code, failure::Outcome};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::Failure;

/// Nodal quantities by their names in Python.
const QUANTITIES: [(&str, Quantity); 9] = [
    ("position", Quantity::Position),
    ("velocity", Quantity::Velocity),
    ("force", Quantity::Force),
    ("tension", Quantity::Tension),
    ("bending", Quantity::Bending),
    ("weight", Quantity::Weight),
    ("drag", Quantity::Drag),
    ("froude_krylov", Quantity::FroudeKrylov),
    ("seabed", Quantity::Seabed),
];

/// Value of a property of an object.
#[derive(IntoPyObject)]
pub(crate) enum Value {
    Flag(bool),
    Whole(i64),
    Number(f64),
    Vector(Vec<f64>),
    Matrix(Vec<Vec<f64>>),
    Ends(Vec<(usize, i32)>),
}

impl Value {
    fn whole(number: usize) -> Value {
        Value::Whole(i64::try_from(number).unwrap_or(i64::MAX))
    }

    fn matrix<const N: usize>(rows: &[[f64; N]]) -> Value {
        Value::Matrix(rows.iter().map(|row| row.to_vec()).collect())
    }
}

fn unknown(what: &str) -> moorline_system::Failure {
    moorline_system::Failure::value(format!("there is no quantity {what:?}"))
}

/// A mooring with MoorDyn's interface, read from a deck.
#[pyclass(frozen, module = "moorline")]
pub(crate) struct MoorDyn {
    /// `None` after `close`.
    system: Mutex<Option<System>>,
}

impl MoorDyn {
    fn call<T>(&self, body: impl FnOnce(&mut System) -> Outcome<T>) -> Result<T, Failure> {
        let mut system = self.system.lock().unwrap_or_else(PoisonError::into_inner);
        let closed = || moorline_system::Failure::new(Code::InvalidInput, "the system is closed");
        let done = system.as_mut().ok_or_else(closed).and_then(body);
        done.map_err(Failure::MoorDyn)
    }
}

#[pymethods]
impl MoorDyn {
    /// Reads a deck.
    #[new]
    fn new(path: PathBuf) -> Result<MoorDyn, Failure> {
        let settings = Settings::read(|name| std::env::var(name).ok());
        let system = settings.and_then(|settings| System::create(&path, settings, Log::from_level(WARNING)));
        Ok(MoorDyn {
            system: Mutex::new(Some(system.map_err(Failure::MoorDyn)?)),
        })
    }

    /// Closes the system: all later calls are refused.
    fn close(&self) {
        *self.system.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }

    /// Returns the number of coupled degrees of freedom.
    fn degrees_of_freedom(&self) -> Result<usize, Failure> {
        self.call(|system| Ok(system.deck.degrees_of_freedom()))
    }

    /// Returns the numbers of bodies, rods, points and lines.
    fn counts(&self) -> Result<[usize; 4], Failure> {
        self.call(|system| {
            let lists = &system.deck.lists;
            Ok([
                lists.bodies.len(),
                lists.rods.len(),
                lists.points.len(),
                lists.lines.len(),
            ])
        })
    }

    /// Sets the lowest levels of messages written to the console and to the file.
    #[pyo3(signature = (*, console=None, file=None))]
    fn set_levels(&self, console: Option<i32>, file: Option<i32>) -> Result<(), Failure> {
        self.call(|system| {
            console
                .into_iter()
                .for_each(|level| system.log.set_console(level));
            file.into_iter()
                .for_each(|level| system.log.set_file_level(level));
            Ok(())
        })
    }

    /// Writes messages to a file as well.
    fn set_log_file(&self, path: PathBuf) -> Result<(), Failure> {
        self.call(|system| system.log.set_file(&path))
    }

    /// Writes a message at a level.
    fn write_log(&self, level: i32, message: &str) -> Result<(), Failure> {
        self.call(|system| {
            system.log.write(level, message);
            Ok(())
        })
    }

    /// Starts at coupled positions [m, rad] with velocities [m/s, rad/s]: in static equilibrium, or on catenaries if `is_approximate`.
    #[pyo3(signature = (x, v, is_approximate=false))]
    fn start(&self, py: Python<'_>, x: Vec<f64>, v: Vec<f64>, is_approximate: bool) -> Result<(), Failure> {
        py.detach(|| self.call(|system| system.start(&x, &v, is_approximate)))
    }

    /// Steps by dt [s] from time t [s] and returns the forces at the end of the step [N, N m].
    fn step(&self, py: Python<'_>, x: Vec<f64>, v: Vec<f64>, t: f64, dt: f64) -> Result<Vec<f64>, Failure> {
        py.detach(|| {
            self.call(|system| {
                system.step(&x, &v, t, dt)?;
                let mut forces = vec![0.0; system.deck.degrees_of_freedom()];
                system.forces(&mut forces)?;
                Ok(forces)
            })
        })
    }

    /// Returns the internal time step [s], the Courant number [-] and the time scheme, as set by the deck or the script.
    fn scheme(&self) -> Result<(f64, f64, String), Failure> {
        self.call(|system| Ok((system.dt, system.cfl, system.scheme.clone())))
    }

    /// Sets the upper limit of the internal time step [s], the Courant number [-] or the time scheme; the last two have no effect.
    #[pyo3(signature = (*, dt=None, cfl=None, name=None))]
    fn set_scheme(&self, dt: Option<f64>, cfl: Option<f64>, name: Option<&str>) -> Result<(), Failure> {
        self.call(|system| {
            dt.map_or(Ok(()), |dt| system.set_dt(dt))?;
            cfl.map_or(Ok(()), |cfl| system.set_cfl(cfl))?;
            name.map_or(Ok(()), |name| system.set_scheme(name))
        })
    }

    /// Returns the state as bytes.
    fn to_bytes<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyBytes>, Failure> {
        let words = self.call(|system| system.serialize())?;
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        Ok(PyBytes::new(py, &bytes))
    }

    /// Restores a state.
    fn restore(&self, data: &[u8]) -> Result<(), Failure> {
        let (words, _) = data.as_chunks();
        let words: Vec<u64> = words.iter().map(|word| u64::from_le_bytes(*word)).collect();
        self.call(|system| system.deserialize(&words))
    }

    /// Writes the state to a file.
    fn save(&self, path: PathBuf) -> Result<(), Failure> {
        self.call(|system| system.save(&path))
    }

    /// Restores the state from a file.
    fn load(&self, path: PathBuf) -> Result<(), Failure> {
        self.call(|system| system.load(&path))
    }

    /// Writes the shape of all lines, or of one, for ParaView.
    #[pyo3(signature = (path, line=None))]
    fn save_vtk(&self, path: PathBuf, line: Option<usize>) -> Result<(), Failure> {
        self.call(|system| system.save_vtk(&path, line))
    }

    /// Detaches a line from a point.
    fn break_line(&self, point: usize, line: usize) -> Result<(), Failure> {
        self.call(|system| system.break_line(point, line))
    }

    /// Returns velocity [m/s] and acceleration [m/s²] of the water at a position, and the surface elevation there [m].
    fn flow(&self, place: [f64; 3]) -> Result<([f64; 3], [f64; 3], f64), Failure> {
        self.call(|system| {
            let flow = system.flow(place)?;
            Ok((flow.velocity, flow.acceleration, flow.elevation))
        })
    }

    /// Returns the height of the seabed at a horizontal position [m], negative below the still water.
    fn depth_at(&self, x: f64, y: f64) -> Result<f64, Failure> {
        self.call(|system| system.depth_at(x, y))
    }

    /// Returns the heights z of the seabed at its mean and at its least depth [m].
    fn depths(&self) -> Result<[f64; 2], Failure> {
        self.call(|system| system.depths())
    }

    /// Returns a property of a body, by name.
    fn body(&self, index: usize, what: &str) -> Result<Value, Failure> {
        self.call(|system| {
            Ok(match what {
                "number" => Value::whole(system.body(index)?.number),
                "type" => Value::Whole(system.body_type(index)?.into()),
                "place" => Value::Vector(system.body_state(index)?.place.to_vec()),
                "rate" => Value::Vector(system.body_state(index)?.rate.to_vec()),
                "force" => Value::Vector(system.body_force(index)?.to_vec()),
                "mass" => Value::matrix(&system.body_mass(index)?),
                _ => return Err(unknown(what)),
            })
        })
    }

    /// Returns a property of a rod, or of one of its nodes, by name.
    #[pyo3(signature = (index, what, node=0))]
    fn rod(&self, index: usize, what: &str, node: usize) -> Result<Value, Failure> {
        self.call(|system| {
            let [position, velocity] = match what {
                "position" | "velocity" => system.rod_node(index, node)?,
                _ => [[0.0; 3]; 2],
            };
            let rod = system.rod(index)?;
            Ok(match what {
                "number" => Value::whole(rod.number),
                "segments" => Value::whole(rod.segments),
                "position" => Value::Vector(position.to_vec()),
                "velocity" => Value::Vector(velocity.to_vec()),
                _ => return Err(unknown(what)),
            })
        })
    }

    /// Returns a property of a point, by name; `ends` are the attached lines, each with its end at the point: 0 for A, 1 for B.
    fn point(&self, index: usize, what: &str) -> Result<Value, Failure> {
        self.call(|system| {
            Ok(match what {
                "number" => Value::whole(system.point_number(index)?),
                "type" => Value::Whole(system.point_type(index)?.into()),
                "position" => Value::Vector(system.point_state(index)?.position.as_slice().to_vec()),
                "velocity" => Value::Vector(system.point_state(index)?.velocity.as_slice().to_vec()),
                "force" => Value::Vector(system.point_force(index)?.to_vec()),
                "mass" => Value::matrix(&system.point_mass(index)?),
                "ends" => Value::Ends(system.point_attached(index)?),
                _ => return Err(unknown(what)),
            })
        })
    }

    /// Returns a property of a line, or of one of its nodes, by name.
    #[pyo3(signature = (index, what, node=0))]
    fn line(&self, index: usize, what: &str, node: usize) -> Result<Value, Failure> {
        let quantity = QUANTITIES.iter().find(|(name, _)| *name == what);
        self.call(|system| {
            if let Some((_, quantity)) = quantity {
                return Ok(Value::Vector(
                    system.node_vector(index, node, *quantity)?.to_vec(),
                ));
            }
            Ok(match what {
                "number" => Value::whole(system.line(index)?.number),
                "segments" => Value::whole(system.line(index)?.segments),
                "unstretched_length" => Value::Number(system.unstretched_length(index)?),
                "has_constant_stiffness" => Value::Flag(system.has_constant_stiffness(index)?),
                "constant_stiffness" => Value::Number(system.constant_stiffness(index)?),
                "fairlead_tension" => Value::Number(system.fairlead_tension(index)?),
                "greatest_tension" => Value::Number(system.greatest_tension(index)?),
                "end_tensions" => Value::Vector(system.end_tensions(index)?.to_vec()),
                "curvature" => Value::Number(system.node_curvature(index, node)?),
                "mass" => Value::matrix(&system.node_mass(index, node)?),
                _ => return Err(unknown(what)),
            })
        })
    }

    /// Sets the unstretched length [m] or the axial stiffness [N] of a line; only before the start.
    #[pyo3(signature = (index, *, unstretched_length=None, constant_stiffness=None))]
    fn set_line(
        &self,
        index: usize,
        unstretched_length: Option<f64>,
        constant_stiffness: Option<f64>,
    ) -> Result<(), Failure> {
        self.call(|system| {
            let (length, stiffness) = (unstretched_length, constant_stiffness);
            length.map_or(Ok(()), |length| system.set_unstretched_length(index, length))?;
            stiffness.map_or(Ok(()), |stiffness| {
                system.set_constant_stiffness(index, stiffness)
            })
        })
    }
}
