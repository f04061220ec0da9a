"""What users will compare first: published cases and exact motion, through the FMU in FMPy, for both FMI versions."""

import math
import pathlib

import numpy as np
import pytest

from runs import driven, packaged, run

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"

# SeaFEM validation case 11: closed-form elastic catenary, and the equilibrium of 22 two-node elements
CATENARY_SAG, CATENARY_HORIZONTAL, END_REACTION = 0.7177774654, 17.00889855, 3.4648145
DISCRETE_SAG = 0.7182741621
MINUTE = {"time": [0.0, 0.05, 60.0]}  # a communication step, and the end [s]


@pytest.mark.parametrize("initial", ["{ parabola = 0.72 }", '"straight"'], ids=["parabola", "straight"])
def test_seafem_case_11_settles_from_any_start(moorline, version, tmp_path, initial):
    text = (SCENES / "seafem11.toml").read_text().replace("initial = { parabola = 0.72 }", f"initial = {initial}")
    scene = tmp_path / "scene.toml"
    scene.write_text(text)
    outputs = ["line1.sag", "fairlead.fz", "line1.catenary_sag", "line1.catenary_horizontal"]
    result = driven(packaged(moorline, scene, version, tmp_path), MINUTE, outputs)
    assert result["line1.catenary_sag"][0] == pytest.approx(CATENARY_SAG, rel=1e-9)
    assert result["line1.catenary_horizontal"][0] == pytest.approx(CATENARY_HORIZONTAL, rel=1e-9)
    assert abs(result["line1.sag"][0] - DISCRETE_SAG) > 1e-3  # it did start elsewhere
    assert result["line1.sag"][-1] == pytest.approx(DISCRETE_SAG, abs=1e-6)
    assert result["fairlead.fz"][-1] == pytest.approx(-END_REACTION, abs=1e-6)


def ramped(t, amplitude, period, ramp=20.0):
    """amplitude·sin(2πt/period) under the scene's cosine ramp, and its derivative."""
    omega, rate = 2.0 * math.pi / period, math.pi / ramp
    rising = t < ramp
    r = np.where(rising, 0.5 * (1.0 - np.cos(rate * t)), 1.0)
    dr = np.where(rising, 0.5 * rate * np.sin(rate * t), 0.0)
    sine, cosine = np.sin(omega * t), np.cos(omega * t)
    return amplitude * r * sine, amplitude * (dr * sine + omega * r * cosine)


def test_a_host_disturbs_the_tension_less_than_promised(moorline, version, tmp_path):
    """RMS over the last 60 s, relative to the standard deviation of the tension."""
    exact = run(moorline, SCENES / "oc3_catenary.toml", tmp_path / "exact")
    fmu = packaged(moorline, SCENES / "oc3_catenary.toml", version, tmp_path)

    def error(step, velocities):
        t = np.arange(0.0, 120.0 + 0.5 * step, step)
        (x, vx), (z, vz) = ramped(t, 5.0, 12.0), ramped(t, 2.0, 9.0)
        columns = {"time": t, "fairlead.x": x, "fairlead.z": z}
        if velocities:
            columns |= {"fairlead.vx": vx, "fairlead.vz": vz}
        result = driven(fmu, columns, ["line1.tension_b"], list(columns)[1:])
        window = result["time"] > 60.0
        reference = np.interp(result["time"][window], exact["time"], exact["line1.tension_b"])
        return np.sqrt(np.mean((result["line1.tension_b"][window] - reference) ** 2)) / reference.std()

    assert error(0.05, velocities=False) < 2e-3
    assert error(0.05, velocities=True) < 5e-4
