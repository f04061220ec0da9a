"""Decks of MoorDyn and MAP++ as FMUs: every deck of decks/tests/decks and every published system, at rest and driven, for a minute in FMPy."""

import pathlib

import fmpy
import numpy as np
import pytest

import decks
from runs import driven, packaged

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "decks" / "tests" / "decks"
OF_HOST = {"farm.dat": ["--at", "turbine1=0,0,0", "--at", "turbine2=1000,0,0"], "oc3.map": ["--depth", 320]}
FILES = sorted(path.name for path in FOLDER.iterdir() if path.is_file())
SYSTEMS = ["oc3", "oc4", "volturnus", "taut", "buoyed", "clump"]
STEP = 0.05  # communication step [s]


@pytest.fixture
def fmu(moorline, version, tmp_path):
    """Packages a file of decks/tests/decks, with what its host would give, or a system of decks.py."""

    def make(name):
        if name in SYSTEMS:
            deck = tmp_path / f"{name}.txt"
            deck.write_text(getattr(decks, name)())
        else:
            deck = FOLDER / name
        return packaged(moorline, deck, version, tmp_path, *OF_HOST.get(name, []))

    return make


def variables(fmu):
    """Inputs that displace along x or z, and outputs that are tensions or forces."""
    found = fmpy.read_model_description(fmu).modelVariables
    last = lambda variable: variable.name.rsplit(".", 1)[-1]
    inputs = [v.name for v in found if v.causality == "input" and last(v) in ("x", "z")]
    outputs = [v.name for v in found if v.causality == "output" and last(v) in ("tension_a", "tension_b", "fx", "fz")]
    return inputs, outputs


@pytest.mark.parametrize("name", FILES + SYSTEMS)
def test_a_deck_stays_at_rest_for_a_minute_in_a_host(fmu, name):
    path = fmu(name)
    _, outputs = variables(path)
    result = driven(path, {"time": np.arange(0.0, 60.0 + STEP / 2, STEP)}, outputs)
    assert len(result) == 1201
    for output in outputs:
        size = max(np.abs(result[other]).max() for other in outputs if other[:4] == output[:4])
        assert np.ptp(result[output]) < 1e-6 * size, output


@pytest.mark.parametrize("name", FILES + SYSTEMS)
def test_a_driven_deck_runs_a_minute_in_a_host(fmu, name):
    """A metre along, half a metre up and down: less than the slack of the tautest."""
    path = fmu(name)
    inputs, outputs = variables(path)
    time = np.arange(0.0, 60.0 + STEP / 2, STEP)
    grown = np.minimum(time / 15.0, 1.0)
    along, up = grown * np.sin(2 * np.pi * time / 12.0), 0.5 * grown * np.sin(2 * np.pi * time / 9.0)
    columns = {"time": time, **{name: along if name.endswith(".x") else up for name in inputs}}
    result = driven(path, columns, outputs, inputs)
    assert len(result) == 1201 and inputs
    assert all(np.isfinite(result[output]).all() for output in outputs)
    tensions = [output for output in outputs if output.endswith("tension_b")]
    assert all(result[tension].min() >= 0.0 for tension in tensions)
    assert any(np.ptp(result[tension]) > 0.01 * result[tension][0] for tension in tensions)
