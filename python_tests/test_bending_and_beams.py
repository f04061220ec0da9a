"""Cables that bend and beams, through the FMU in FMPy, for both FMI versions."""

import pathlib

import numpy as np
import pytest

from runs import driven, packaged, replayed, run

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"
BENT = ["curvature_max", "moment_max", "moment_a", "moment_b"]


@pytest.mark.parametrize("name", ["flying_spaghetti", "flying_spaghetti_3d"])
def test_a_flying_rod_keeps_its_energy_and_flies_as_in_a_run(moorline, version, tmp_path, name):
    scene = SCENES / f"{name}.toml"
    columns = run(moorline, scene, tmp_path / "run")
    outputs = [*(f"rod.{key}" for key in BENT), "rod.tension_max", "solver.energy_error", "solver.substeps"]
    result = driven(packaged(moorline, scene, version, tmp_path), columns, outputs)
    assert len(result) == 101
    assert np.abs(result["solver.energy_error"]).max() < 1e-9 * 380.0  # J, of the 380 J that the loads give
    assert (result["solver.substeps"][1:] == 1).all()
    assert result["rod.moment_max"].max() > 50.0
    for output in outputs[:-2]:
        assert result[output] == pytest.approx(columns[output], rel=1e-7, abs=1e-7), output


@pytest.mark.parametrize("key, value, counts", [
    ("shear_stiffness", 2e3, True), ("rotary_inertia", 5.0, True), ("bending_stiffness", 500.0, True),
    ("torsional_stiffness", 200.0, False),  # the flight is in a plane: nothing twists
])
def test_what_a_beam_is_made_of_are_parameters(moorline, version, tmp_path, key, value, counts):
    scene = SCENES / "flying_spaghetti.toml"
    lines = scene.read_text().splitlines()
    changed_scene = tmp_path / "changed.toml"
    changed_scene.write_text("\n".join(f"{key} = {value}" if line.startswith(f"{key} =") else line for line in lines))
    columns, outputs = {"time": np.arange(0.0, 3.05, 0.1)}, ["rod.curvature_max", "solver.energy_error"]
    fmu = packaged(moorline, scene, version, tmp_path)
    given = driven(fmu, columns, outputs)["rod.curvature_max"]
    changed = driven(fmu, columns, outputs, start_values={f"rod.{key}": value})
    written = driven(packaged(moorline, changed_scene, version, tmp_path), columns, outputs)
    assert changed["rod.curvature_max"] == pytest.approx(written["rod.curvature_max"], rel=1e-9, abs=1e-12)
    assert (np.abs(changed["rod.curvature_max"] - given).max() > 1e-3) == counts
    assert np.abs(changed["solver.energy_error"]).max() < 1e-6


def test_a_power_cable_bends_in_a_host_as_in_a_run(moorline, version, tmp_path):
    scene = tmp_path / "power_cable.toml"
    scene.write_text((SCENES / "power_cable.toml").read_text().replace("profile = true", "profile = false"))
    columns = run(moorline, scene, tmp_path / "run", "--communication-step", 0.05)
    outputs = [*(f"cable.{key}" for key in BENT), "hang_off.fx", "hang_off.fz"]
    inputs = [f"hang_off.{axis}" for axis in "xyz"]
    fmu = packaged(moorline, scene, version, tmp_path)
    same = replayed(fmu, columns, inputs, outputs, tmp_path / "unpacked")
    assert all((same[output] == columns[output]).all() for output in outputs)
    result = driven(fmu, columns, outputs, inputs)  # its rounded times can change the degree of the path
    assert len(result) == 1201
    assert columns["cable.moment_max"].max() > 1.5 * columns["cable.moment_max"][0]
    for output in outputs:
        size = max(np.abs(columns[output]).max(), 1e-3)  # the end on the seabed does not bend
        assert np.abs(result[output] - columns[output]).max() < 3e-3 * size, output
    assert result["cable.moment_max"] == pytest.approx(1e4 * result["cable.curvature_max"], rel=1e-9)  # EI in N m²
    assert (result["cable.moment_max"] >= result["cable.moment_b"]).all()
    assert result["cable.moment_b"].min() > 0.0
