"""Line laws through the FMU: viscoelastic ropes, lines that let go, and winches, for both FMI versions."""

import fmpy
import numpy as np

TIME = np.arange(0.0, 10.001, 0.05)


def sway(amplitude, period, release_at=None):
    """Inputs of a fairlead that sways along x, and lets go at a time [s]."""
    names = [("time", "f8"), ("fairlead.x", "f8"), ("line1.release", "?")]
    signals = np.zeros(TIME.size, dtype=names)
    signals["time"] = TIME
    signals["fairlead.x"] = amplitude * np.sin(2 * np.pi * TIME / period) * np.minimum(TIME / period, 1.0)
    if release_at is not None:
        signals["line1.release"] = TIME >= release_at
    return signals


def simulate(fmu, signals):
    return fmpy.simulate_fmu(str(fmu), stop_time=TIME[-1], output_interval=0.05, input=signals,
                             output=["line1.tension_b", "fairlead.fx", "solver.energy_error"])


def test_a_line_that_is_told_to_lets_go_and_the_fairlead_feels_nothing_more(package, version):
    found = simulate(package("ROPE", version), sway(0.3, 4.0, release_at=6.0))
    held, gone = found["time"] < 6.0, found["time"] > 6.1
    assert (found["line1.tension_b"][held] > 1e4).all()
    assert (found["line1.tension_b"][gone] == 0.0).all() and (found["fairlead.fx"][gone] == 0.0).all()
    assert np.isfinite(found["solver.energy_error"]).all()


def test_the_release_is_a_truth_value_that_is_false_at_first(library, version):
    variable = library("ROPE", version).description.variables["line1.release"]
    assert variable["causality"] == "input" and variable["type"] == "Boolean"
    assert variable["start"] == "false"


def test_the_parameters_of_a_viscoelastic_rope_are_variables(library, version):
    names = library("ROPE", version).description.names("parameter")
    assert {f"rope.{key}_{of}" for key in ("static", "dynamic") for of in ("stiffness", "damping")} <= set(names)


def test_a_winch_hauls_in_and_the_tension_rises_to_that_of_the_shorter_line(package, library, version):
    """Smoothly from 0 to -8 m; a host that starts at -8 m has the tension that it ends near."""
    signals = np.zeros(TIME.size, dtype=[("time", "f8"), ("line1.length_change", "f8")])
    signals["time"] = TIME
    part = np.clip(TIME / 6.0, 0.0, 1.0)
    signals["line1.length_change"] = -8.0 * part * part * (3.0 - 2.0 * part)
    found = simulate(package("WINCH", version), signals)["line1.tension_b"]
    signals["line1.length_change"] = -8.0
    there = simulate(package("WINCH", version), signals)["line1.tension_b"]
    assert found[0] < 0.95 * there[0]
    assert abs(found[-20:].mean() / there[0] - 1.0) < 0.02
    assert np.ptp(there) < 1e-3 * there[0]
    variable = library("WINCH", version).description.variables["line1.length_change"]
    assert variable["causality"] == "input"


def test_a_winch_that_is_asked_for_more_than_it_has_stops_the_host(package, version):
    signals = np.zeros(TIME.size, dtype=[("time", "f8"), ("line1.length_change", "f8")])
    signals["time"] = TIME
    signals["line1.length_change"] = 20.0 * TIME
    try:
        simulate(package("WINCH", version), signals)
    except Exception as error:
        assert "fmi" in str(error).lower()
    else:
        raise AssertionError("a length that the winch does not have was taken")
