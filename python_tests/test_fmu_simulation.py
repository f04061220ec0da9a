"""Simulations through the FMU: by FMPy as a user would, and call by call."""

import math
import random
import struct

import fmpy
import numpy as np
import pytest

from fmu_calls import ERROR, OK, Slave


def swing(time):
    return {"fairlead.x": 2.0 * math.sin(0.7 * time), "fairlead.z": 0.5 * math.sin(1.1 * time)}


def bits(values):
    flat = [x for v in values for x in (v if isinstance(v, list) else [v])]
    return [struct.pack("<d", x) for x in flat]


def same(rows, others):
    return [bits(r.values()) for r in rows] == [bits(o.values()) for o in others]


def test_fmpy_simulates(package, version):
    result = fmpy.simulate_fmu(str(package("CHAIN", version)), stop_time=5.0, output_interval=0.05)
    assert len(result) == 101 and all(np.isfinite(result[name]).all() for name in result.dtype.names)
    assert result["line1.tension_b"][0] > 0.0


def test_fmpy_drives_inputs(package, version):
    time = np.linspace(0.0, 5.0, 101)
    signals = np.array([(t, 0.5 * math.sin(t)) for t in time], dtype=[("time", float), ("fairlead.x", float)])
    result = fmpy.simulate_fmu(str(package("CHAIN", version)), stop_time=5.0, output_interval=0.05, input=signals,
                               start_values={"chain.mass": 120.0})
    assert np.ptp(result["line1.tension_b"]) > 0.0


def test_fmi2_input_derivatives_are_velocities(library):
    """As a host does that interpolates inputs: x and its derivative, never a velocity."""
    rows = []
    for derivative in (True, False):
        one = Slave(library("CHAIN", 2)).initialize()
        x, vx = (one.library.description.reference(f"fairlead.{n}") for n in ("x", "vx"))
        for k in range(40):
            t = 0.05 * k
            one.expect(one.set_references([x], [2.0 * math.sin(t)]))
            if derivative:
                one.expect(one.set_derivatives([x], [1], [2.0 * math.cos(t)]))
            else:
                one.expect(one.set_references([vx], [2.0 * math.cos(t)]))
            one.expect(one.step(t, 0.05))
            rows.append(one.outputs())
        one.free()
    assert same(rows[:40], rows[40:])


def test_both_versions_give_the_same_bits(library):
    rows = []
    for version in (2, 3):
        one = Slave(library("CHAIN", version)).initialize()
        rows.append(one.run(40, drive=swing))
        one.free()
    assert same(*rows)


def stream(label, node, time):
    """A flow that differs at every node."""
    size = {"v": 0.8, "a": 0.3}[label[0]]
    return size * math.sin(0.6 * time + 0.2 * node + ord(label[1]))


def test_arrays_of_the_flow_in_fmpy_are_its_scalars_to_the_last_bit(package):
    """FMI 3.0 takes the flow of the water as arrays, FMI 2.0 as scalars, both from FMPy's input table."""
    time = np.linspace(0.0, 5.0, 101)
    labels = ["vx", "vy", "vz", "ax", "ay", "az"]
    tables = {
        2: [(f"line1.flow.{label}[{node + 1}]", float, [stream(label, node, t) for t in time])
            for label in labels for node in range(21)],
        3: [(f"line1.flow.{label}", (float, 21), [[stream(label, node, t) for node in range(21)] for t in time])
            for label in labels],
    }
    outputs, rows = ["fairlead.fx", "fairlead.fy", "fairlead.fz", "line1.tension_b"], []
    for version, columns in tables.items():
        signals = np.zeros(len(time), dtype=[("time", float), *((name, kind) for name, kind, _ in columns)])
        signals["time"] = time
        for name, _, values in columns:
            signals[name] = values
        result = fmpy.simulate_fmu(str(package("HOSTED", version)), stop_time=5.0, output_interval=0.05, input=signals,
                                   output=outputs)
        rows.append(np.array([result[name] for name in outputs]))
    assert np.array_equal(*rows) and np.ptp(rows[0][1]) > 100.0


def test_initial_outputs_are_the_static_forces_where_the_host_put_the_fairlead(slave):
    one = slave()
    one.expect(one.enter())
    at_rest = one.outputs()
    one.expect(one.set("fairlead.x", -5.0))
    pulled = one.outputs()
    assert pulled["line1.tension_b"] > at_rest["line1.tension_b"]
    one.expect(one.set("fairlead.x", 0.0))
    assert one.outputs() == at_rest, "the order of what was set leaves no trace"
    one.expect(one.set("fairlead.x", -5.0))
    one.expect(one.exit())
    assert one.outputs() == pulled
    one.run(20, drive=lambda t: {"fairlead.x": -5.0})
    assert one.get("line1.tension_b") == pytest.approx(pulled["line1.tension_b"], rel=2e-3), "rest stays at rest"


def test_static_forces_agree_with_the_closed_form_catenary(slave):
    one = slave().initialize()
    catenary = one.values("calculatedParameter")
    assert -one.get("fairlead.fx") == pytest.approx(-catenary["line1.catenary_horizontal"], rel=0.02)
    assert one.get("line1.tension_b") == pytest.approx(catenary["line1.catenary_tension_b"], rel=0.02)


def test_the_weight_and_buoyancy_of_a_driven_point_are_in_its_force(slave):
    bare, clumped = (slave(scene).initialize().outputs() for scene in ("CHAIN", "CLUMPED"))
    own = clumped["fairlead.fz"] - bare["fairlead.fz"]
    assert own == pytest.approx(-9.80665 * (500.0 - 1025.0 * 0.2), rel=1e-9)
    assert clumped["line1.tension_b"] == bare["line1.tension_b"]


def test_a_table_that_a_line_leaves_is_noted_once_in_the_log(slave):
    one = slave("SHORT_PROFILE").initialize()
    one.run(5)
    notes = [text for _, _, text in one.messages if "water.current.profile" in text]
    assert len(notes) == 1 and "below the lowest row at -10 m" in notes[0]


def test_parameters_set_in_initialization_solve_the_statics_again(slave):
    one = slave()
    one.expect(one.set("line1.length", 840.0))
    one.expect(one.enter())
    longer = one.outputs()
    one.expect(one.set("chain.mass", 150.0))
    heavier = one.outputs()
    assert heavier["line1.tension_b"] > longer["line1.tension_b"]
    assert one.get("chain.mass") == 150.0 and one.get("line1.length") == 840.0
    fresh = slave().initialize(line1__length=840.0, chain__mass=150.0)
    assert fresh.outputs() == heavier


def test_reset_goes_back_to_just_after_instantiation(slave):
    one = slave().initialize(chain__mass=150.0, fairlead__x=3.0)
    one.run(10, drive=swing)
    one.expect(one.reset())
    assert one.get("chain.mass") == 113.35 and one.get("fairlead.x") == 0.0
    again, fresh = one.initialize().run(10, drive=swing), slave().initialize().run(10, drive=swing)
    assert same(again, fresh)


def test_a_saved_state_replays_to_the_last_bit(slave):
    one = slave().initialize()
    one.run(15, drive=swing)
    one.expect(one.set("fairlead.y", 0.25))
    state = one.save()
    first = one.run(15, start=0.75, drive=swing)
    one.expect(one.restore(state))
    assert one.get("fairlead.y") == 0.25
    assert same(first, one.run(15, start=0.75, drive=swing))
    one.expect(one.free_state(state))
    assert not state.value, "the pointer is set to null"
    one.expect(one.free_state(state))


def test_a_pointer_given_to_get_state_is_used_again(slave):
    one = slave().initialize()
    state = one.save()
    address = state.value
    one.run(5, drive=swing)
    one.save(state)
    assert state.value == address
    after = one.outputs()
    one.run(5, start=0.25, drive=swing)
    one.expect(one.restore(state))
    assert one.outputs() == after
    one.expect(one.free_state(state))


@pytest.mark.parametrize("scene, driven, start", [("CHAIN", "fairlead", -30.0), ("TWO_ROPES", "buoy1", 0.6)])
def test_a_serialised_state_goes_on_in_another_instance_to_the_last_bit(slave, scene, driven, start):
    """Also where the other instance began elsewhere: what the start decided, like step limits, travels along."""
    drive = lambda time: {f"{driven}.x": start + 0.2 * math.sin(0.7 * time)}
    one = slave(scene).initialize(**{f"{driven}__x": start, "gravity": 9.5})
    one.run(15, drive=drive)
    state = one.save()
    data = one.serialize(state)
    first = one.run(40, start=0.75, drive=drive)
    fresh, used = slave(scene), slave(scene).initialize(gravity=9.5)
    used.run(3)
    for other in (fresh, used):
        status, back = other.deserialize(data)
        other.expect(status)
        other.expect(other.restore(back))
        assert other.get("gravity") == 9.5
        assert same(first, other.run(40, start=0.75, drive=drive))
        other.free_state(back)
    one.free_state(state)


@pytest.mark.parametrize("scene", ["CHAIN", "TWO_ROPES"])
def test_a_state_can_be_saved_in_every_phase(slave, scene):
    one = slave(scene)
    phases = [lambda: None, one.enter, lambda: one.outputs() and None, one.exit, lambda: one.step(0.0, 0.05),
              one.terminate]
    for advance in phases:
        status = advance()
        assert not status
        state = one.save()
        status, back = one.deserialize(one.serialize(state))
        one.expect(status)
        one.expect(one.restore(back))
        one.free_state(state), one.free_state(back)


def test_foreign_and_broken_state_bytes_are_refused(slave, library, version):
    one = slave().initialize()
    state = one.save()
    data = one.serialize(state)
    assert one.serialize_into(state, len(data) - 1) == ERROR and "room" in one.messages[-1][2]
    one.free_state(state)
    rng = random.Random(1)
    broken = [b"", b"x", data[:-1], data + b"\0", data[: len(data) // 2]]
    for _ in range(50):
        k = rng.randrange(len(data))
        broken.append(data[:k] + bytes([data[k] ^ 0x55]) + data[k + 1:])
    for bytes_ in broken:
        status, back = one.deserialize(bytes_)
        assert status == ERROR and not back.value
    other = slave("TWO_ROPES").initialize()
    status, _ = other.deserialize(data)
    assert status == ERROR and "another FMU" in other.messages[-1][2]
    one.run(2)


def test_a_step_of_zero_changes_nothing(slave):
    one = slave().initialize()
    one.run(5, drive=swing)
    before = one.outputs()
    one.expect(one.step(0.25, 0.0))
    assert one.outputs() == before
    one.run(1, start=0.25)


@pytest.mark.parametrize("clock", ["accumulated", "multiplied", "mixed"])
def test_clocks_that_round_differently_are_all_accepted(slave, clock):
    one = slave().initialize()
    h, total = 1.0 / 60.0, 0.0
    for k in range(3000):
        time = {"accumulated": total, "multiplied": k * h, "mixed": total if k % 2 else k * h}[clock]
        one.expect(one.step(time, h))
        total += h
    assert [m for m in one.messages if m[0] != OK] == []


def test_a_tenth_may_be_added_a_hundred_thousand_times(slave):
    one = slave("ELASTIC").initialize()
    time = 0.0
    for k in range(100_000):
        status = one.step(k * 0.1 if k % 1000 == 0 else time, 0.1)
        if status != OK:
            break
        time += 0.1
        if k % 1000 == 0:
            time = k * 0.1 + 0.1
    one.expect(status)


def test_a_small_difference_of_clocks_is_said_and_a_large_one_refused(slave):
    one = slave().initialize()
    one.run(4)
    one.expect(one.step(0.2 + 0.8e-6 * 0.05, 0.05))
    assert one.messages[-1][1] == "logStatusWarning"
    before = one.outputs()
    for time in (0.2, 0.25 + 1e-3, 0.3, 0.0):
        assert one.step(time, 0.05) == ERROR and "last step ended" in one.messages[-1][2]
    assert one.outputs() == before


def test_the_communication_step_may_vary(slave):
    one = slave().initialize()
    time, rng = 0.0, random.Random(2)
    while time < 3.0:
        h = rng.choice([0.001, 0.01, 0.05, 0.1])
        for name, value in swing(time).items():
            one.expect(one.set(name, value))
        one.expect(one.step(time, h))
        time += h
    assert math.isfinite(one.get("line1.tension_b"))


def test_a_last_step_of_rounding_changes_nothing(slave):
    """A host that adds tenths and cuts its last step to the end of its run asks for 2e-14 s more."""
    one = slave().initialize()
    time, steps, rows = 0.0, [], []
    while time < 10.0:
        steps.append(min(0.1, 10.0 - time))
        for name, value in swing(time).items():
            one.expect(one.set(name, value))
        one.expect(one.step(time, steps[-1]))
        time += steps[-1]
        rows.append(one.outputs())
    assert steps[-1] < 1e-13 and rows[-1].pop("solver.substeps") == 0
    assert rows[-2].pop("solver.substeps") > 0
    assert rows[-1] == pytest.approx(rows[-2], rel=1e-9)
    if one.version == 3:
        assert (one.get("time"), one.reached.value) == (10.0, 10.0)


def test_steps_too_short_to_be_made_add_up(slave):
    """Across a saved state, too; and the simulation goes on as without them."""
    one, other = slave().initialize(), slave().initialize()
    rows = one.run(20, drive=swing)
    assert same(rows, other.run(20, drive=swing))
    time = 1.0
    for _ in range(8):
        one.expect(one.step(time, 3e-7))
        time += 3e-7
        state = one.save()
        status, copy = one.deserialize(one.serialize(state))
        one.expect(status)
        one.expect(one.restore(copy))
        one.free_state(state), one.free_state(copy)
    other.expect(other.step(1.0, 2.4e-6))
    for name, value in one.outputs().items():
        if name not in ("solver.substeps", "solver.input_error"):  # of the last step made
            assert value == pytest.approx(other.get(name), rel=1e-4, abs=1e-3), name


def test_a_simulation_may_start_at_any_time(slave):
    one = slave()
    one.expect(one.enter(start=100.0, stop=100.2))
    one.expect(one.exit())
    one.run(4, start=100.0)
    assert one.step(100.2, 0.05) == ERROR and "stop time" in one.messages[-1][2]
    if one.version == 3:
        assert one.get("time") == pytest.approx(100.2)


def test_fmi2_status_functions_answer(slave, library):
    import ctypes
    one = Slave(library("CHAIN", 2)).initialize()
    one.run(2)
    real, whole, flag, text = ctypes.c_double(), ctypes.c_int(-1), ctypes.c_int(-1), ctypes.c_char_p()
    one.expect(one.call("GetRealStatus", 2, ctypes.byref(real)))
    assert real.value == pytest.approx(0.1)
    one.expect(one.call("GetStatus", 0, ctypes.byref(whole)))
    one.expect(one.call("GetBooleanStatus", 3, ctypes.byref(flag)))
    assert (whole.value, flag.value) == (OK, 0)
    assert one.step(7.0, 0.1) == ERROR
    one.expect(one.call("GetStatus", 0, ctypes.byref(whole)))
    assert whole.value == ERROR
    one.expect(one.call("GetStringStatus", 1, ctypes.byref(text)))
    assert text.value == b"no step is pending"
    assert one.call("GetIntegerStatus", 0, ctypes.byref(whole)) == ERROR
    one.free()


def test_velocities_only_count_once_they_are_given(slave):
    """Hosts write the start value 0 of every input before the simulation."""
    names = [f"fairlead.v{a}" for a in "xyz"]
    plain = slave().initialize().run(20, drive=swing)
    zeroed = slave().initialize(**{name.replace(".", "__"): 0.0 for name in names}).run(20, drive=swing)
    assert same(plain, zeroed)
    given = slave().initialize()
    rows = given.run(20, drive=lambda t: {**swing(t), "fairlead.vx": 1.4 * math.cos(0.7 * t)})
    assert not same(plain, rows)


def test_velocities_that_are_never_but_zero_are_not_told(slave):
    """Dymola and others write every input at every communication point, 0 to those that nothing is connected to."""
    names = [f"fairlead.v{a}" for a in "xyz"]
    zeros = dict.fromkeys(names, 0.0)
    plain = slave().initialize().run(20, drive=swing)
    zeroed = slave().initialize().run(20, drive=lambda t: {**zeros, **swing(t)})
    assert same(plain, zeroed)


def test_a_vessel_is_told_its_velocity_without_its_angular_velocity(slave):
    """Those that nothing is connected to stay 0 whatever the angles do."""

    def drive(velocity, angular):
        return lambda t: {
            "barge.x": 2.0 * math.sin(0.7 * t), "barge.yaw": 0.1 * math.sin(0.6 * t),
            **({"barge.vx": 1.4 * math.cos(0.7 * t), "barge.vy": 0.0, "barge.vz": 0.0} if velocity else {}),
            **({"barge.wx": 0.0, "barge.wy": 0.0, "barge.wz": 0.0} if angular else {}),
        }

    told = slave("BARGE").initialize().run(20, drive=drive(True, False))
    zeroed = slave("BARGE").initialize().run(20, drive=drive(True, True))
    assert same(told, zeroed)
    assert not same(told, slave("BARGE").initialize().run(20, drive=drive(False, False)))
