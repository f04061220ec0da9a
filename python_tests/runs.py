"""What tests share that compare an FMU with `moorline run`."""

import csv

import fmpy
import numpy as np

from fmu_calls import Library, Slave, unpack


def packaged(moorline, scene, version, folder, *options):
    """Packages a file, a scene or a deck, and returns the path of the .fmu file."""
    fmu = folder / "scene.fmu"
    done = moorline("fmu", scene, "-o", fmu, "--fmi", version, *options)
    assert done.returncode == 0, done.stderr
    return str(fmu)


def run(moorline, scene, folder, *options):
    """Columns of `moorline run`, by name."""
    done = moorline("run", scene, "-o", folder, *options)
    assert done.returncode == 0, done.stderr
    with open(folder / "results.csv") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def driven(fmu, columns, outputs, inputs=(), **options):
    """The FMU in FMPy, its inputs as a run's columns have them at every row."""
    time = columns["time"]
    signals = None
    if inputs:
        names = ["time", *inputs]
        signals = np.array(list(zip(*(columns[name] for name in names))), dtype=[(name, float) for name in names])
    return fmpy.simulate_fmu(fmu, stop_time=time[-1], output_interval=time[1] - time[0], input=signals,
                             output=list(outputs), **options)


def replayed(fmu, columns, inputs, outputs, folder):
    """The FMU called step by step with a run's inputs as they were printed: its outputs must be the run's to the last bit."""
    one = Slave(Library(unpack(fmu, folder)))
    one.initialize()
    rows = [[one.get(name) for name in outputs]]
    step = columns["time"][1]
    for k in range(len(columns["time"]) - 1):
        for name in inputs:
            one.expect(one.set(name, columns[name][k]))
        one.expect(one.step(k * step, step))
        rows.append([one.get(name) for name in outputs])
    one.free()
    return dict(zip(outputs, np.array(rows).T))
