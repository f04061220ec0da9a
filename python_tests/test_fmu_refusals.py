"""Every call that must be refused: with a status, a message that names the culprit, and nothing changed."""

import math
import pathlib
import re
from ctypes import c_bool, c_char_p, c_double, c_int, c_size_t, c_uint32

import fmpy
import pytest

from fmu_calls import ERROR, OK, Slave


def refused(one, status, *words):
    assert status == ERROR
    _, category, text = one.messages[-1]
    assert category == "logStatusError"
    for word in words:
        assert word in text, text


def test_inputs_that_are_not_finite_are_refused_and_the_state_kept(slave):
    one = slave().initialize()
    one.run(3)
    one.expect(one.set("fairlead.x", 0.5))
    references = [one.library.description.reference(n) for n in ("fairlead.y", "fairlead.x")]
    for bad in (math.nan, math.inf, -math.inf):
        refused(one, one.set_references(references, [0.1, bad]), "fairlead.x", "not a finite number")
    assert (one.get("fairlead.x"), one.get("fairlead.y")) == (0.5, 0.0), "all or nothing"
    one.run(3, start=0.15)


def test_inputs_that_no_arithmetic_can_carry_are_refused(slave):
    """What a host forgot to initialise, before and after initialization."""
    one = slave()
    refused(one, one.set("fairlead.z", 1e300), "fairlead.z", "beyond 1e12")
    one.initialize(fairlead__z=0.1)
    refused(one, one.set("fairlead.vx", -1e155), "fairlead.vx", "beyond 1e12")
    one.run(3)


def test_parameters_out_of_range_are_refused_by_their_key(slave):
    one = slave()
    refused(one, one.set("chain.mass", -1.0), "chain", "mass")
    refused(one, one.set("gravity", math.nan), "gravity")
    refused(one, one.set("solver.input_reconstruction", 7), "solver.input_reconstruction", "neither 0")
    assert one.get("chain.mass") == 113.35
    one.initialize()


def test_parameters_are_closed_after_initialization(slave):
    one = slave().initialize()
    refused(one, one.set("chain.mass", 120.0), "chain.mass", "after initialization")


def test_outputs_and_calculated_parameters_are_not_to_be_set(slave):
    one = slave().initialize()
    for name in ("fairlead.fx", "line1.catenary_sag"):
        refused(one, one.set(name, 1.0), name, "not to be set")


def test_outputs_exist_from_initialization_on(slave):
    one = slave()
    status, _ = one.get_references([one.library.description.reference("fairlead.fx")])
    refused(one, status, "fairlead.fx", "initialization")
    assert one.get("chain.mass") == 113.35


def test_unknown_references_are_refused_with_the_number(slave):
    one = slave().initialize()
    for reference in (0, 10_000, 2**32 - 1):
        refused(one, one.get_references([1, reference])[0], str(reference))
        refused(one, one.set_references([1, reference], [0.0, 0.0]), str(reference))


def test_the_wrong_type_is_refused_with_the_variable(slave):
    one = slave().initialize()
    d = one.library.description
    for kind in ("integer", "boolean", "string"):
        refused(one, one.get_references([d.reference("fairlead.x")], kind=kind)[0], "fairlead.x", "Float64")
        refused(one, one.set_references([d.reference("fairlead.x")], [1], kind=kind), "fairlead.x", "Float64")
    refused(one, one.get_references([d.reference("solver.substeps")])[0], "solver.substeps", "Int32")
    for kind in ("real", "integer", "boolean", "string"):
        assert one.get_references([], kind=kind)[0] == OK, "asking for nothing is no mistake"


def test_wrong_counts_are_refused(library):
    one = Slave(library("CHAIN_PROFILE", 3)).initialize()
    reference = one.library.description.reference("line1.profile.x")
    assert one.get_references([reference], size=21)[0] == OK
    for size in (1, 20, 22):
        refused(one, one.get_references([reference], size=size)[0], "21 values", str(size))
    refused(one, one.get_references([1, 2], size=2, counts=(2, 1))[0], "room for 1")
    one.free()


def test_null_pointers_and_impossible_lengths_are_refused(slave, version):
    one = slave().initialize()
    tail = [c_size_t(1)] if version == 3 else []
    name = "GetReal" if version == 2 else "GetFloat64"
    refused(one, one.call(name, None, c_size_t(1), None, *tail), "null")
    tail = [c_size_t(2**62)] if version == 3 else []
    refused(one, one.call(name, (c_uint32 * 1)(1), c_size_t(2**62), (c_double * 1)(), *tail), "memory")
    for function in ("GetFMUstate", "SetFMUstate"):
        refused(one, one.call(one._state_name(function), None), "null")


def test_a_null_handle_does_not_crash(library, version):
    one = Slave(library("CHAIN", version))
    one.free()
    assert one.handle is None
    for call in (one.terminate, one.reset, one.exit, lambda: one.step(0.0, 0.1), lambda: one.call("FreeInstance")):
        call()


def test_calls_out_of_order_are_refused(slave):
    one = slave()
    refused(one, one.exit(), "out of order")
    refused(one, one.step(0.0, 0.1), "out of order", "before initialization")
    refused(one, one.terminate(), "out of order")
    one.expect(one.enter())
    refused(one, one.enter(), "out of order")
    refused(one, one.step(0.0, 0.1), "in initialization mode")
    one.expect(one.exit())
    refused(one, one.exit(), "out of order")
    one.run(2)
    one.expect(one.terminate())
    refused(one, one.step(0.1, 0.05), "after terminate")
    refused(one, one.set("fairlead.x", 1.0), "fairlead.x", "after terminate")
    assert math.isfinite(one.get("fairlead.fx")), "results stay readable"


@pytest.mark.parametrize("step", [-0.1, math.nan, math.inf])
def test_impossible_steps_are_refused(slave, step):
    one = slave().initialize()
    refused(one, one.step(0.0, step), "step of")
    refused(one, one.step(math.nan, 0.1), "step of")
    one.run(2)


def test_model_exchange_and_other_functions_are_there_and_refuse(slave, version):
    one = slave().initialize()
    names = {2: ["EnterEventMode", "EnterContinuousTimeMode", "CancelStep"],
             3: ["EnterEventMode", "EnterContinuousTimeMode", "EnterStepMode", "EnterConfigurationMode",
                 "EvaluateDiscreteStates"]}[version]
    for name in names:
        refused(one, one.call(name), f"fmi{version}{name}")
    one.run(2)


def test_every_function_of_both_standards_is_exported(library):
    headers = pathlib.Path(fmpy.__file__).parent / "c-code"
    dll = library("CHAIN", 2).dll
    for version in (2, 3):
        names = set(re.findall(rf"\b(fmi{version}\w+)TYPE\b", (headers / f"fmi{version}Functions.h").read_text()))
        assert len(names) > 40
        assert [name for name in sorted(names) if not hasattr(dll, name)] == []


def test_a_wrong_token_is_refused_with_a_message(library, version):
    for token in ("", "00000000-0000-0000-0000-000000000000"):
        for logging in (True, False):
            one = Slave(library("CHAIN", version), token=token, logging=logging)
            assert not one.handle
            (message,) = one.messages
            assert "token" in message[2] and one.library.description.token in message[2]
    good = Slave(library("CHAIN", version))
    assert good.handle
    good.free()


def test_missing_resources_are_refused_with_the_place(library, version, tmp_path):
    for place in ("", str(tmp_path)):
        one = Slave(library("CHAIN", version), resources=place)
        assert not one.handle and len(one.messages) == 1
        assert (str(tmp_path) if place else "no resource location") in one.messages[0][2]


def test_a_changed_scene_no_longer_fits_its_token(library, version, tmp_path):
    source = library("CHAIN", version)
    scene = (source.folder / "resources" / "scene.toml").read_text()
    (tmp_path / "scene.toml").write_text(scene.replace("113.35", "113.36"))
    one = Slave(source, resources=str(tmp_path))
    assert not one.handle and "token" in one.messages[0][2]


def test_nothing_is_logged_while_logging_is_off(slave):
    one = slave(logging=False).initialize()
    assert one.step(5.0, 0.1) == ERROR and one.set("fairlead.fx", 1.0) == ERROR
    assert one.messages == []


def test_only_declared_and_chosen_categories_are_logged(slave, version):
    one = slave()
    declared = {c.get("name") for c in one.library.description.root.find("LogCategories")}
    switch = c_bool if version == 3 else c_int

    def choose(on, *names):
        array = (c_char_p * len(names))(*(n.encode() for n in names))
        return one.call("SetDebugLogging", switch(on), c_size_t(len(names)), array)

    one.initialize()
    one.step(5.0, 0.1)
    assert {m[1] for m in one.messages} <= declared and one.messages
    refused(one, choose(1, "logSecrets"), "logSecrets")
    one.expect(choose(1, "logEvents"))
    one.messages.clear()
    assert one.step(5.0, 0.1) == ERROR and one.messages == []
    one.expect(choose(0))
    one.expect(choose(1))
    assert one.step(5.0, 0.1) == ERROR and len(one.messages) == 1


def test_a_null_logger_is_no_mistake(slave):
    one = slave(with_logger=False).initialize()
    assert one.step(5.0, 0.1) == ERROR
    one.run(2)


def test_a_per_cent_sign_in_a_message_is_only_text(library, version, tmp_path):
    place = tmp_path / "100%s%n"
    one = Slave(library("CHAIN", version), resources=str(place))
    assert not one.handle and "100%s%n" in one.messages[0][2]


def test_fmi2_input_derivatives_of_other_orders_and_variables_are_refused(library):
    one = Slave(library("CHAIN", 2)).initialize()
    derive = lambda name, order, value: one.set_derivatives(
        [one.library.description.reference(name)], [order], [value])
    assert derive("fairlead.x", 1, 0.3) == OK and one.get("fairlead.vx") == 0.3
    assert derive("fairlead.vx", 1, 0.3) == OK
    refused(one, derive("fairlead.x", 2, 0.3), "fairlead.x", "order 2")
    refused(one, derive("fairlead.fx", 1, 0.3), "fairlead.fx", "only inputs")
    refused(one, derive("fairlead.x", 1, math.nan), "fairlead.x", "not a finite")
    one.free()
