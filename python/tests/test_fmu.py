"""The FMU of a scene and a simulation in Python are the same mooring."""

import math

import numpy as np
import pytest

import moorline

fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed: no host for the FMU")


def test_a_simulation_gives_what_the_fmu_gives_to_the_last_bit(semi, tmp_path):
    from fmpy import extract, read_model_description
    from fmpy.fmi2 import FMU2Slave

    moorline.fmu(semi, tmp_path / "semi.fmu")
    description = read_model_description(str(tmp_path / "semi.fmu"))
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    reals = {variable.name for variable in description.modelVariables if variable.type == "Real"}
    slave = FMU2Slave(guid=description.guid, unzipDirectory=extract(str(tmp_path / "semi.fmu")),
                      modelIdentifier=description.coSimulation.modelIdentifier)
    slave.instantiate()
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    simulation = moorline.Simulation(semi)
    outputs = [name for name in simulation.output_names if name in reals]
    for k in range(60):
        t = 0.05 * k
        inputs = {"platform.x": 2.0 * math.sin(0.6 * t), "platform.pitch": 0.03 * math.sin(0.8 * t)}
        slave.setReal([references[name] for name in inputs], list(inputs.values()))
        slave.doStep(t, 0.05)
        simulation.advance(inputs, 0.05)
    values = slave.getReal([references[name] for name in outputs])
    assert np.array_equal(values, [simulation[name] for name in outputs])
    slave.terminate()
    slave.freeInstance()
