"""A simulation that Python steps: inputs, outputs, saved states."""

import copy
import math
import pickle
import warnings

import numpy as np
import pytest

import moorline
from conftest import CHAIN


def steps(simulation, count, start=0):
    """Steps on a motion and returns all outputs of every step."""
    rows = []
    for k in range(start, start + count):
        t = 0.05 * k
        simulation.advance({"fairlead.x": 2.0 * math.sin(0.5 * t), "fairlead.z": math.sin(0.7 * t)}, 0.05)
        rows.append(simulation.outputs())
    return np.array(rows)


@pytest.mark.parametrize("kind", ["total", "without_inertia"])
def test_the_force_on_a_coupled_point_is_that_of_the_outputs(kind):
    scene = moorline.Scene.from_toml(CHAIN.replace("[output]", f'[output]\nforce = "{kind}"'))
    simulation = moorline.Simulation(scene)
    steps(simulation, 20)
    assert simulation.point("fairlead").force.tolist() == [simulation[f"fairlead.f{axis}"] for axis in "xyz"]


def test_inputs_by_name_and_as_an_array_give_the_same_bits(chain):
    named, listed = moorline.Simulation(chain), moorline.Simulation(chain)
    assert listed.input_names == ["fairlead.x", "fairlead.y", "fairlead.z"]
    values = np.zeros(3)
    for k in range(50):
        t = 0.05 * k
        values[:] = 2.0 * math.sin(0.5 * t), 0.0, math.sin(0.7 * t)
        listed.advance(values, 0.05)
        named.advance({"fairlead.x": values[0], "fairlead.z": values[2]}, 0.05)
    assert np.array_equal(named.outputs(), listed.outputs())
    assert named.time == listed.time == pytest.approx(2.5)


def test_a_step_that_fails_leaves_the_simulation_as_it_was(chain):
    simulation = moorline.Simulation(chain)
    steps(simulation, 10)
    before = simulation.save()
    with pytest.raises(moorline.StepError):
        simulation.advance({"fairlead.x": 1e6}, 0.05)
    assert pickle.dumps(simulation.save()) == pickle.dumps(before)
    assert simulation["fairlead.x"] == 2.0 * math.sin(0.5 * 0.05 * 9)
    simulation.advance({}, 0.05)


def test_outputs_by_name_are_those_of_the_array(chain):
    simulation = moorline.Simulation(chain)
    simulation.advance({"fairlead.x": 0.1}, 0.05)
    values = simulation.outputs()
    assert [simulation[name] for name in simulation.output_names] == values.tolist()
    assert simulation["fairlead.x"] == 0.1 and simulation["chain.drag_normal"] == 1.3
    assert isinstance(simulation["solver.substeps"], int)
    assert simulation.units["line1.tension_b"] == "N" and simulation.units["fairlead.x"] == "m"


def test_outputs_and_positions_are_written_into_arrays_of_the_caller(chain):
    simulation = moorline.Simulation(chain)
    outputs, nodes = np.empty(len(simulation.output_names)), np.empty((21, 3))
    assert simulation.outputs(outputs) is outputs and simulation.positions("line1", nodes) is nodes
    assert np.array_equal(nodes, simulation.positions("line1"))
    assert np.allclose(nodes[[0, -1]], [[405.0, 0.0, -120.0], [5.0, 0.0, -10.0]])
    assert len(simulation.tensions("line1")) == 21
    assert simulation.tensions("line1")[-1] == simulation["line1.tension_b"]


def test_an_input_that_is_not_named_keeps_its_value_and_a_velocity_can_be_given_and_taken_back(chain):
    simulation = moorline.Simulation(chain, velocities=True)
    assert simulation.input_names[3:] == ["fairlead.vx", "fairlead.vy", "fairlead.vz"]
    assert simulation["fairlead.vx"] is None
    simulation.advance({"fairlead.x": 0.01, "fairlead.vx": 0.2}, 0.05)
    simulation.advance(None, 0.05)
    assert (simulation["fairlead.x"], simulation["fairlead.vx"]) == (0.01, 0.2)
    simulation.advance({"fairlead.vx": None}, 0.05)
    assert simulation["fairlead.vx"] is None


def test_a_simulation_starts_in_equilibrium_at_its_inputs(chain):
    here, there = moorline.Simulation(chain), moorline.Simulation(chain, inputs={"fairlead.x": -5.0}, start_time=3.0)
    assert there["line1.tension_b"] > 1.02 * here["line1.tension_b"] and there.time == 3.0
    assert here["line1.tension_b"] == pytest.approx(chain.statics().lines[0].end_b.tension, rel=1e-12)


def stream(simulation, count, give):
    """Steps in a flow that `give` sets from the places where it is due and the time, and returns all outputs of every step."""
    rows = []
    for _ in range(count):
        x, _, z = simulation.flow_places("line1").T
        velocity = np.stack([0.5 + 0.002 * x, 0.01 * z, np.full(21, 0.1 * simulation.time)], axis=1)
        give(velocity, 0.1 * velocity[:, ::-1])
        simulation.advance({"fairlead.x": 0.2 * simulation.time}, 0.1)
        rows.append(simulation.outputs())
    return np.array(rows)


def test_derivatives_are_those_of_steps_from_a_saved_state_and_rates_those_of_the_next_step():
    asked = CHAIN + 'derivatives = true\n[solver]\ninput_reconstruction = "interpolate"\n'
    simulation = moorline.Simulation(moorline.Scene.from_toml(asked))
    outputs, inputs = ["fairlead.fx", "fairlead.fz"], ["fairlead.x", "fairlead.vz"]
    values = {"fairlead.x": 0.02, "fairlead.z": 0.01, "fairlead.vx": 0.4, "fairlead.vz": 0.2}
    simulation.advance(values, 0.05)
    start = simulation.save()

    def stepped(change, step=0.05):
        simulation.restore(start)
        simulation.advance(values | change, step)
        return np.array([simulation[name] for name in outputs])

    by_hand = [stepped({name: values[name] + 1e-6}) - stepped({name: values[name] - 1e-6}) for name in inputs]
    stepped({})
    derivatives, rates = simulation.derivatives(outputs, inputs), simulation.rates(outputs)
    assert derivatives.shape == (2, 2) and rates.shape == (2,)
    assert np.allclose(derivatives, np.array(by_hand).T / 2e-6, rtol=1e-5)
    assert np.all(np.isfinite(rates)) and np.any(rates != 0.0)
    with pytest.raises(moorline.InputError, match="only outputs of type Float64"):
        simulation.derivatives(["solver.substeps"], inputs)
    with pytest.raises(moorline.InputError, match="did you mean|fairlead.fx"):
        simulation.derivatives(["fairlead.f"], inputs)


def test_without_its_key_a_scene_has_no_derivatives(chain):
    simulation = moorline.Simulation(chain)
    with pytest.raises(moorline.InputError, match="`derivatives` in"):
        simulation.rates(["fairlead.fx"])


def test_a_flow_given_as_arrays_is_that_of_its_inputs_by_name_and_is_saved(chain):
    hosted = chain.to_dict()
    hosted["water"]["flow"] = "host"
    hosted = moorline.Scene.from_dict(hosted)
    arrays, named = moorline.Simulation(hosted), moorline.Simulation(hosted)
    assert arrays.input_names == ["fairlead.x", "fairlead.y", "fairlead.z"], "a flow has a method of its own"

    def by_name(*flow):
        values = {f"line1.flow.{kind}{axis}[{node + 1}]": values[node, column] for kind, values in zip("va", flow)
                  for column, axis in enumerate("xyz") for node in range(21)}
        named.advance(values, 0.0)

    def whole(velocity, acceleration):
        arrays.set_flow("line1", velocity, acceleration)

    rows = stream(arrays, 20, whole)
    assert np.array_equal(rows, stream(named, 20, by_name))
    assert np.array_equal(arrays.flow_places("line1"), arrays.positions("line1"))
    state = arrays.save()
    rows = stream(arrays, 5, whole)
    arrays.restore(state)
    assert np.array_equal(rows, stream(arrays, 5, whole))
    still = stream(moorline.Simulation(hosted), 5, lambda *_: None)
    assert np.ptp(rows - still) > 100.0


def test_a_flow_that_cannot_be_used_is_refused_and_changes_nothing(chain):
    with pytest.raises(moorline.InputError, match='flow = "host"'):
        moorline.Simulation(chain).flow_places("line1")
    hosted = moorline.Simulation(moorline.Scene.from_toml(chain.to_toml().replace("[water]", '[water]\nflow = "host"')))
    flow, short, wild = np.ones((21, 3)), np.ones((20, 3)), np.full((21, 3), np.nan)
    for velocity, acceleration, said in [(short, flow, "velocities"), (flow, wild, "accelerations")]:
        with pytest.raises(moorline.InputError, match=said):
            hosted.set_flow("line1", velocity, acceleration)
    assert hosted["line1.flow.vx[1]"] == 0.0
    hosted.set_flow("line1", 1000.0 * flow, flow)
    with pytest.raises(moorline.StepError, match="line1.flow.vx"):
        hosted.advance(None, 0.1)


def test_a_restored_simulation_replays_to_the_last_bit(chain):
    simulation = moorline.Simulation(chain)
    steps(simulation, 40)
    state = simulation.save()
    first = steps(simulation, 40, 40)
    simulation.restore(state)
    assert np.array_equal(steps(simulation, 40, 40), first)
    for bytes_of in (state.to_bytes(), pickle.loads(pickle.dumps(state)).to_bytes()):
        other = moorline.Simulation(chain)
        other.restore(moorline.State.from_bytes(bytes_of))
        assert np.array_equal(steps(other, 40, 40), first)


def test_a_state_is_restored_in_a_simulation_that_started_elsewhere(chain):
    simulation = moorline.Simulation(chain, inputs={"fairlead.x": 1.0}, start_time=2.0)
    steps(simulation, 10)
    state = simulation.save()
    first = steps(simulation, 10, 10)
    other = moorline.Simulation(chain)
    other.restore(state)
    assert other["fairlead.x"] == pytest.approx(2.0 * math.sin(0.225))
    assert np.array_equal(steps(other, 10, 10), first)


def test_a_copy_continues_to_the_same_bits(chain):
    simulation = moorline.Simulation(chain)
    steps(simulation, 20)
    others = [simulation.copy(), copy.copy(simulation), copy.deepcopy(simulation)]
    first = steps(simulation, 20, 20)
    assert all(np.array_equal(steps(other, 20, 20), first) for other in others)


def test_damaged_and_foreign_states_are_refused(chain, semi):
    data = moorline.Simulation(chain).save().to_bytes()
    for wrong in (b"", data[:-1], data[:60] + bytes([data[60] ^ 1]) + data[61:], b"x" + data):
        with pytest.raises(moorline.InputError):
            moorline.State.from_bytes(wrong)
    other = moorline.Simulation(semi)
    with pytest.raises(moorline.InputError, match="another scene"):
        other.restore(moorline.State.from_bytes(data))


def test_a_vessel_is_moved_by_pose(semi):
    simulation = moorline.Simulation(semi)
    assert simulation.input_names == [f"platform.{axis}" for axis in ("x", "y", "z", "roll", "pitch", "yaw")]
    simulation.advance({"platform.pitch": 0.01}, 0.05)
    assert abs(simulation["platform.my"]) > 0.0


def test_a_mesh_that_is_expected_to_miss_the_tolerance_is_warned_of():
    scene = moorline.Scene.from_toml(CHAIN.replace(", elements = 20", "") + "[solver]\ntolerance = 1e-5\n")
    with pytest.warns(UserWarning, match="above solver.tolerance = 0.00001") as found:
        simulation = moorline.Simulation(scene)
    assert [str(warning.message) for warning in found] == simulation.scene.notes[len(scene.notes):]


def test_likely_mistakes_are_warned_of_once(chain):
    simulation = moorline.Simulation(chain)
    with pytest.warns(UserWarning, match="has moved by 50.000 m in one communication step"):
        simulation.advance({"fairlead.x": 50.0}, 5.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulation.advance({"fairlead.x": 0.0}, 5.0)


def test_a_motion_of_few_samples_is_warned_of(chain):
    simulation = moorline.Simulation(chain)
    with pytest.warns(UserWarning, match="are too few for its extrapolation") as found:
        for k in range(60):
            simulation.advance({"fairlead.x": 2.0 * math.sin(math.pi * k / 5)}, 0.8)
    assert len(found) == 1
