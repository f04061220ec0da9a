"""The example of a floating body, `examples/floating_body`: its tables, its equation of motion, and its coupling with a mooring."""

import dataclasses
import pathlib
import sys

import pytest

np = pytest.importorskip("numpy")
pytest.importorskip("pythonfmu", reason="pythonfmu makes the body's FMU")

from conftest import MOORLINE  # noqa: E402

EXAMPLE = pathlib.Path(__file__).resolve().parents[1] / "examples" / "floating_body"
sys.path.insert(0, str(EXAMPLE))
import hosts  # noqa: E402
import run as example  # noqa: E402
from body import COMING, EXTRAPOLATED, LAST, MOTION, Body, Waves  # noqa: E402

sys.path.remove(str(EXAMPLE))
BARGE = hosts.Case("barge", 0.1, 300.0, LAST, Waves(2.0, 8.0, 1))


@pytest.fixture(scope="module")
def moorings(tmp_path_factory):
    hosts.MOORLINE = MOORLINE
    return hosts.Moorings(tmp_path_factory.mktemp("floating_body"))


@pytest.fixture(scope="module")
def coming(moorings):
    """The barge in a sea, with the force of the coming step."""
    return hosts.in_fmpy(dataclasses.replace(BARGE, coupling=COMING), moorings)


@pytest.mark.parametrize("name, bound", [("spar", 0.001), ("barge", 0.015)])
def test_retardation_added_mass_and_damping_obey_ogilvie(name, bound):
    assert example.ogilvie(name) < bound


@pytest.mark.parametrize("name", ["spar", "barge"])
def test_long_waves_lift_a_body_by_its_waterplane_stiffness(name, moorings):
    assert example.long_waves(Body(name, 0.1, moorings.statics(name)[0])) == pytest.approx(1.0, abs=0.002)


def test_the_weight_of_the_spar_balances_with_the_turbine_of_5_mw(moorings):
    body = Body("spar", 0.1, moorings.statics("spar")[0])
    assert body.point_mass == pytest.approx(599_718, rel=1e-3)  # tower, nacelle and rotor: Jonkman (2010), section 2


def test_an_unmoored_spar_in_regular_waves_moves_as_its_rao(moorings):
    omega = 0.6
    run = example.unmoored(hosts.Case(duration=1500.0, waves=Waves(2.0, 2 * np.pi / omega)), moorings)
    exact = np.abs(example.rao("spar", omega, moorings, moored=False))
    found = [example.amplitude(run, axis, omega) for axis in ("x", "z", "pitch")]
    assert found == pytest.approx(exact[[0, 2, 4]], rel=0.01)


@pytest.mark.parametrize("integrator, bound", [("quasi_static", 0.002), ("auto", 0.01)])
def test_a_moored_spar_surges_at_its_eigenvalue(integrator, bound, moorings):
    period, mode = example.surge_mode("spar", moorings)
    run = hosts.in_fmpy(hosts.Case(duration=700.0, start=tuple(2.0 * mode), integrator=integrator), moorings)
    assert example.period_of(run, "x") == pytest.approx(period, rel=bound)


@pytest.mark.parametrize("coupling, rms, deviation", [(LAST, 0.5, 4.0), (EXTRAPOLATED, 0.1, 0.8)])
def test_a_barge_of_1000_t_can_take_past_forces(coupling, rms, deviation, moorings, coming):
    run = hosts.in_fmpy(dataclasses.replace(BARGE, coupling=coupling), moorings)
    over_rms, over_deviation = example.difference(run, coming, "line1.tension_b")
    assert over_rms < rms and over_deviation < deviation


def test_the_lines_of_a_barge_gain_no_energy_from_the_integration(coming):
    assert np.max(np.abs(coming["solver.energy_error"])) < 1e-6 * example.exchanged(coming)


def test_libcosim_gets_what_a_loop_in_fmpy_gets(moorings):
    pytest.importorskip("libcosimpy")
    case = dataclasses.replace(BARGE, duration=60.0)
    one, other = hosts.in_fmpy(case, moorings), hosts.in_libcosim(case, moorings)
    for name in (*MOTION, *hosts.LINES):
        assert np.max(np.abs(one[name][1:] - other[name])) <= 1e-9 * np.ptp(one[name]), name


def test_the_body_refuses_another_step_than_its_own(moorings):
    body = hosts.Fmu(moorings.body_fmu(), "body")
    body.start(moorings.parameters(BARGE))
    body.slave.exitInitializationMode()
    with pytest.raises(Exception, match="fmi2DoStep failed"):
        body.slave.doStep(0.0, 0.05)
