//! `moorline demo`: the main workflow from end to end. The built-in scene becomes an FMU; a host opens it through its C interface, moves the fairlead
//! and reads forces, tensions and shapes.

use std::path::Path;
use std::time::Instant;

use moorline::discretisation;
use moorline::interface::{Binding, Interface, Kind, Layout, Variable};
use moorline::model::Body;
use moorline::output::files::RunFiles;
use moorline::output::package::{Container, Stamp};
use moorline::output::record::{Frame, Node, Record};
use moorline::output::times::Times;
use moorline::output::{collect, write_report};
use moorline::scene::{Scene, load_text};
use moorline::simulation::Simulation;
use moorline_host::{FmiVersion, Fmu, HostError, Slave};

use crate::Library;
use crate::failure::Failure;
use crate::fmu::package;
use crate::folder::Folder;
use crate::summary::run_summary;
use crate::terminal::{Progress, discretise, print, simulate};
use moorline::output::recorder::{columns, input_of, recorded};

/// The built-in scene.
const SCENE: &str = include_str!("../../scenes/demo.toml");

/// Packages the built-in scene, drives the FMU, and shows and writes the results.
pub(crate) fn demo(folder: &Path, library: Library<'_>) -> Result<(), Failure> {
    let mut loaded = load_text(Path::new("demo.toml"), SCENE.to_string())?;
    discretise(&mut loaded, discretisation::select);
    let _open = Folder::open(folder)?;
    let target = folder.join("demo.fmu");
    let plain = (Container::Fmu, &Stamp::default());
    package(&loaded, &target, FmiVersion::Two, plain, library)?;
    let reference = simulate(&loaded)?;
    let record = drive(&target, &loaded.scene, &reference, folder)?;
    write_report(&record, &loaded.scene, folder)?;
    print(&format!(
        "{}\nFMI 2.0 co-simulation through the C interface, steps of {} s, displacements only\n\n{}\n\
         written to {}: {}, results.csv, report.html, …\n",
        loaded.scene.title,
        loaded.scene.output.interval,
        run_summary(&record),
        folder.display(),
        "demo.fmu",
    ))
}

/// Runs the FMU as a host does, and writes its tables and shapes. `reference` gives the motion of the scene and the closed-form shapes to compare
/// with.
fn drive(target: &Path, scene: &Scene, reference: &Simulation, folder: &Path) -> Result<Record, Failure> {
    let failed = |error: HostError| Failure::Computation(format!("{}: {error}", target.display()));
    let interface = Interface::new(scene, reference.model(), Layout::Scalars)
        .map_err(|mistake| failed(HostError::Description(mistake.to_string())))?;
    let fmu = Fmu::open(target).map_err(failed)?;
    let mut host = Host::new(&fmu, &interface, reference).map_err(failed)?;
    let times = Times::new(scene.output.duration, scene.output.interval);
    let columns = (columns(host.recorded.iter().copied()), times.count + 1);
    let mut record = collect::record(scene, reference, Some(reference), columns);
    host.initialize(times.end, &mut record).map_err(failed)?;
    let mut files = RunFiles::create(folder, &record, &scene.output, &times, false)?;
    let mut progress = Progress::new(times.count, 0, times.end);
    for index in 0..=times.count {
        if index > 0 {
            let before = Instant::now();
            let stepped = host.step(times.at(index - 1), times.step(index - 1));
            record.course.counters.wall += before.elapsed();
            record.course.counters.substeps += stepped.map_err(failed)?;
            progress.step(times.at(index));
        }
        let (row, frame) = host.read(times.at(index)).map_err(failed)?;
        files.add(&mut record, index, &row, |_| frame)?;
    }
    progress.finish();
    files.flush()?;
    host.slave.terminate().map_err(failed)?;
    record.course.counters.simulated = times.end;
    Ok(record)
}

/// An instance of the FMU and the variables that this host uses.
struct Host<'a> {
    slave: Slave,
    reference: &'a Simulation,
    /// Displacements of the coupled points and vessels: body, axis, value reference.
    displacements: Vec<(Body, usize, u32)>,
    /// Variables recorded at every step, and their value references.
    recorded: Vec<&'a Variable>,
    references: Vec<u32>,
    /// Position and tension of every node of every line: value references of x, y, z and tension.
    nodes: Vec<Vec<[u32; 4]>>,
}

impl<'a> Host<'a> {
    fn new(fmu: &Fmu, interface: &'a Interface, reference: &'a Simulation) -> Result<Self, HostError> {
        let find = |variable: &Variable| fmu.reference(&variable.name);
        let recorded: Vec<&Variable> = recorded(interface).collect();
        let mut displacements = Vec::new();
        for variable in interface.variables() {
            if let Binding::Displacement { body, axis } = variable.binding {
                displacements.push((body, axis, find(variable)?));
            }
        }
        let node = |line: &str, number: usize| -> Result<[u32; 4], HostError> {
            let of = |quantity: &str| fmu.reference(&format!("{line}.profile.{quantity}[{number}]"));
            Ok([of("x")?, of("y")?, of("z")?, of("tension")?])
        };
        let mut nodes = Vec::new();
        for line in &reference.model().lines {
            let count = line.nodes.arc.len();
            nodes.push(
                (1..=count)
                    .map(|i| node(&line.name, i))
                    .collect::<Result<_, _>>()?,
            );
        }
        Ok(Host {
            slave: fmu.instantiate("demo", false)?,
            reference,
            displacements,
            references: recorded.iter().map(|v| find(v)).collect::<Result<_, _>>()?,
            recorded,
            nodes,
        })
    }

    /// Initializes the FMU, and records its equilibrium.
    fn initialize(&mut self, end: f64, record: &mut Record) -> Result<(), HostError> {
        self.slave.enter_initialization(0.0, Some(end))?;
        self.set_motion(0.0)?;
        self.slave.exit_initialization()?;
        self.record_statics(record)
    }

    /// Makes a step of length `step` [s] from `time` [s]; returns the number of internal steps.
    fn step(&mut self, time: f64, step: f64) -> Result<u64, HostError> {
        self.set_motion(time)?;
        self.slave.do_step(time, step)?;
        Ok(self.slave.integer("solver.substeps")?.unsigned_abs().into())
    }

    /// Moves the coupled points and vessels to the scene's motion at `time` [s].
    fn set_motion(&mut self, time: f64) -> Result<(), HostError> {
        for moving in self.reference.model().moving(time) {
            for &(owner, axis, reference) in &self.displacements {
                if owner == moving.body {
                    self.slave.set_real(&[reference], &[moving.pose[axis]])?;
                }
            }
        }
        Ok(())
    }

    /// Replaces the equilibrium and the closed form in a record by those of the FMU.
    fn record_statics(&mut self, record: &mut Record) -> Result<(), HostError> {
        let model = self.reference.model();
        for (line, built) in record.lines.iter_mut().zip(&model.lines) {
            // The built-in scene has one line at each fairlead: the point's force is the line's.
            let fairlead = &model.points[built.ends[1]].name;
            let mut force = |axis: &str| self.slave.real(&format!("{fairlead}.{axis}"));
            let horizontal = force("fx")?.hypot(force("fy")?);
            let mut read = |quantity: &str| self.slave.real(&format!("{}.{quantity}", line.name));
            if let Some(equilibrium) = &mut line.equilibrium {
                equilibrium.horizontal = horizontal;
                equilibrium.tension_b = read("tension_b")?;
                equilibrium.sag = read("sag")?;
                equilibrium.laid_length = read("laid_length")?;
            }
            if let Some(catenary) = &mut line.catenary {
                catenary.figures.tension_b = read("catenary_tension_b")?;
                catenary.figures.horizontal = read("catenary_horizontal")?;
                catenary.figures.sag = read("catenary_sag")?;
            }
        }
        Ok(())
    }

    /// Reads a row and the shape of the lines.
    fn read(&mut self, time: f64) -> Result<(Vec<f64>, Frame), HostError> {
        let mut row = Vec::with_capacity(1 + self.recorded.len());
        row.push(time);
        let moving = self.reference.model().moving(time);
        for (variable, &reference) in self.recorded.iter().zip(&self.references) {
            let value = match input_of(variable, self.reference.model(), &moving, time) {
                Some(input) => input,
                None if variable.kind == Kind::Int32 => f64::from(self.slave.integer(&variable.name)?),
                None => {
                    let mut value = [0.0];
                    self.slave.get_real(&[reference], &mut value)?;
                    value[0]
                }
            };
            row.push(value);
        }
        let mut lines = Vec::with_capacity(self.nodes.len());
        for (line, references) in self.reference.model().lines.iter().zip(&self.nodes) {
            let mut nodes = Vec::with_capacity(references.len());
            for (&s, references) in line.nodes.arc.iter().zip(references) {
                let mut values = [0.0; 4];
                self.slave.get_real(references, &mut values)?;
                let [x, y, z, tension] = values;
                nodes.push(Node {
                    s,
                    position: [x, y, z],
                    tension,
                    bending: None,
                });
            }
            lines.push(nodes);
        }
        Ok((row, Frame { time, lines }))
    }
}
