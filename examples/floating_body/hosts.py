"""Body and mooring, two FMUs, in FMPy and in libcosim."""

import json
import os
import pathlib
import subprocess
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from body import AXES, COMING, FORCE, FREE, LAST, MOTION, PLACES, Waves

HERE = pathlib.Path(__file__).resolve().parent
MOORLINE = os.environ.get("MOORLINE", str(HERE.parents[1] / "target" / "release" / "moorline"))
LINES = tuple(f"line{i}.tension_b" for i in (1, 2, 3))
ENERGY = ("solver.energy_error", "solver.power_residual")
IMPEDANCE = FREE + tuple(f"{matrix}_{place}" for matrix in ("mass", "damping", "stiffness") for place in PLACES)
RESULTS = ("time",) + MOTION + FORCE + LINES + ENERGY  # columns of a run


@dataclass(frozen=True)
class Case:
    """A moored run. Both FMUs step at once (Jacobi), with the last force of the mooring or with the last two, extrapolated; with the force of
    the coming step the body steps first."""

    body: str = "spar"  # or barge
    step: float = 0.1  # communication step [s]
    duration: float = 600.0  # [s]
    coupling: str = LAST  # or EXTRAPOLATED, COMING
    waves: Waves = Waves()
    start: tuple[float, ...] = (0.0,) * 6  # displacement at the start [m, rad]
    integrator: str = "auto"  # of the lines


def moorline(*arguments: object) -> str:
    """Runs the program and returns its standard output."""
    done = subprocess.run([MOORLINE, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"moorline {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


class Moorings:
    """Scenes and FMUs of the moorings, made from the decks in a folder where they are needed first."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        self.made: dict[tuple, object] = {}

    def scene(self, body: str) -> pathlib.Path:
        """The deck as a scene whose three lines hang on one vessel, `body`."""
        path = self.folder / f"{body}.toml"
        if not path.exists():
            moorline("convert", HERE / f"{body}.dat", "--vessel", "body", "-o", path)
        return path

    def statics(self, body: str) -> tuple[np.ndarray, np.ndarray]:
        """Force [N, N m] and stiffness [N/m, N, N m] of the mooring at rest."""
        if body not in self.made:
            vessel = json.loads(moorline("statics", self.scene(body), "--json"))["vessels"][0]
            self.made[body] = np.array(vessel["force"]), np.array(vessel["stiffness"])
        return self.made[body]

    def fmu(self, case: Case) -> pathlib.Path:
        """The mooring's FMU, with energy balance; for the coming step with the keys of docs/coupling.md."""
        name = f"{case.body}_{'impedance' if case.coupling == COMING else 'force'}_{case.step}_{case.integrator}"
        path = self.folder / f"{name}.fmu"
        if not path.exists():
            changes = {"interval = 0.05": f"interval = {case.step}", 'integrator = "auto"': f'integrator = "{case.integrator}"'}
            if case.integrator == "auto":
                changes["energy_balance = false"] = "energy_balance = true"
            if case.coupling == COMING:
                changes['input_reconstruction = "smooth"'] = 'input_reconstruction = "interpolate"'
                changes['force = "total"'] = 'interface = "impedance"\nforce = "without_inertia"'
            text = self.scene(case.body).read_text()
            for old, new in changes.items():
                if old not in text:
                    raise RuntimeError(f"{self.scene(case.body)} has no line `{old}`")
                text = text.replace(old, new)
            path.with_suffix(".toml").write_text(text)
            moorline("fmu", path.with_suffix(".toml"), "-o", path)
        return path

    def body_fmu(self) -> pathlib.Path:
        """The body's FMU, with its tables."""
        from pythonfmu.builder import FmuBuilder

        path = self.folder / "FloatingBody.fmu"
        if not path.exists():
            files = [HERE / name for name in ("body.py", "spar.csv", "barge.csv")]
            FmuBuilder.build_FMU(HERE / "body_fmu.py", dest=self.folder, project_files=files)
        return path

    def parameters(self, case: Case) -> dict[str, object]:
        """Parameters of the body's FMU."""
        reals = {"step": case.step, "wave_height": case.waves.height, "wave_period": case.waves.period}
        reals |= dict(zip(("rest_" + name for name in FORCE), self.statics(case.body)[0]))
        reals |= dict(zip(("start_" + name for name in AXES), case.start))
        others = {"body": case.body, "coupling": case.coupling, "wave_seed": case.waves.seed}
        return others | {name: float(value) for name, value in reals.items()}


class Fmu:
    """An FMU 2.0 in FMPy, with values by name."""

    def __init__(self, path: pathlib.Path, name: str) -> None:
        from fmpy import extract, read_model_description
        from fmpy.fmi2 import FMU2Slave

        description = read_model_description(str(path))
        self.number = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.slave = FMU2Slave(guid=description.guid, unzipDirectory=extract(str(path)), instanceName=name,
                               modelIdentifier=description.coSimulation.modelIdentifier)
        self.slave.instantiate(loggingOn=name == "body")  # pythonfmu has no other way to say what is wrong
        self.slave.setupExperiment(startTime=0.0)

    def references(self, names: Iterable[str], prefix: str = "") -> list[int]:
        """Value references of names."""
        return [self.number[prefix + name] for name in names]

    def start(self, parameters: dict[str, object]) -> None:
        """Sets parameters before initialization."""
        setter = {str: self.slave.setString, bool: self.slave.setBoolean, int: self.slave.setInteger, float: self.slave.setReal}
        for name, value in parameters.items():
            setter[type(value)]([self.number[name]], [value])
        self.slave.enterInitializationMode()


def in_fmpy(case: Case, moorings: Moorings) -> dict[str, np.ndarray]:
    """Runs a case in a loop over FMPy; columns RESULTS, a row a communication point."""
    body, mooring = Fmu(moorings.body_fmu(), "body"), Fmu(moorings.fmu(case), "mooring")
    loads = FORCE + (IMPEDANCE if case.coupling == COMING else ())
    motion_out, motion_in = body.references(MOTION), mooring.references(MOTION, "body.")
    load_in, load_out = body.references(loads), mooring.references(loads, "body.")
    rest = mooring.references(LINES + (ENERGY if case.integrator == "auto" else ()))
    body.start(moorings.parameters(case))
    mooring.start({})
    mooring.slave.setReal(motion_in, body.slave.getReal(motion_out))
    body.slave.exitInitializationMode()
    mooring.slave.exitInitializationMode()
    rows = []
    for k in range(round(case.duration / case.step) + 1):
        load, motion = mooring.slave.getReal(load_out), body.slave.getReal(motion_out)
        rows.append([k * case.step, *motion, *load[:6], *mooring.slave.getReal(rest)])
        body.slave.setReal(load_in, load)
        if case.coupling == COMING:  # the body first; the mooring then has the motion at the end of the step
            body.slave.doStep(k * case.step, case.step)
            motion = body.slave.getReal(motion_out)
        mooring.slave.setReal(motion_in, motion)
        mooring.slave.doStep(k * case.step, case.step)
        if case.coupling != COMING:
            body.slave.doStep(k * case.step, case.step)
    for fmu in (body, mooring):
        fmu.slave.terminate()
        fmu.slave.freeInstance()
    return dict(zip(RESULTS, np.array(rows).T))


def in_libcosim(case: Case, moorings: Moorings) -> dict[str, np.ndarray]:
    """Runs a case in libcosim, whose master steps all FMUs at once: with the last force only."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.WARNING)
    execution = CosimExecution.from_step_size(step_size=round(case.step * 1e9))  # [ns]
    paths = {"body": moorings.body_fmu(), "mooring": moorings.fmu(case)}
    number = {name: Fmu(path, name).number for name, path in paths.items()}
    index = {name: execution.add_local_slave(CosimLocalSlave(fmu_path=str(path), instance_name=name)) for name, path in paths.items()}
    setter = {str: execution.string_initial_value, bool: execution.boolean_initial_value, int: execution.integer_initial_value,
              float: execution.real_initial_value}
    for name, value in moorings.parameters(case).items():
        setter[type(value)](index["body"], number["body"][name], value)
    for source, target, names in (("body", "mooring", MOTION), ("mooring", "body", FORCE)):
        for name in names:
            pair = [number[one]["body." * (one == "mooring") + name] for one in (source, target)]
            execution.connect_real_variables(index[source], pair[0], index[target], pair[1])
    observer, rows = CosimObserver.create_last_value(), []
    execution.add_observer(observer)
    motion = [number["body"][name] for name in MOTION]
    others = [number["mooring"][name] for name in tuple("body." + name for name in FORCE) + LINES + ENERGY]
    for k in range(round(case.duration / case.step)):
        execution.step()
        rows.append([(k + 1) * case.step, *observer.last_real_values(index["body"], motion),
                     *observer.last_real_values(index["mooring"], others)])
    return dict(zip(RESULTS, np.array(rows).T))
