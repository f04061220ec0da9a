"""Errors give the place, the mistake and a correction."""

import math
import pickle
import tomllib

import numpy as np
import pytest

import moorline
from conftest import CHAIN, SCENES


def test_a_mistake_in_a_text_has_key_line_and_column():
    with pytest.raises(moorline.SceneError) as caught:
        moorline.Scene.from_toml(CHAIN.replace("diameter = 0.144", "diameter = -0.144"))
    error = caught.value
    assert error.place == "line_types.chain.diameter" and "positive" in error.problem
    ((place, problem, line, column),) = error.mistakes
    assert (place, problem) == (error.place, error.problem)
    assert CHAIN.splitlines()[line - 1].startswith("diameter") and column == len("diameter = ") + 1
    assert isinstance(error, moorline.Error) and isinstance(error, ValueError)


def test_all_mistakes_are_listed():
    text = CHAIN.replace("depth = 120.0", "depth = -120.0").replace("mass = 126.0", "mass = -126.0")
    with pytest.raises(moorline.SceneError) as caught:
        moorline.Scene.from_toml(text)
    assert [place for place, *_ in caught.value.mistakes] == ["seabed.depth", "line_types.chain.mass"]
    assert str(caught.value).count("\n") == 1


def test_a_dict_that_contains_itself_is_refused():
    scene = {}
    scene["points"] = [scene]
    with pytest.raises(moorline.SceneError, match="within each other"):
        moorline.Scene.from_dict(scene)


def test_a_mistake_in_a_dict_has_its_key_path():
    scene = tomllib.loads(CHAIN)
    scene["points"][0]["position"] = [405.0, 0.0]
    with pytest.raises(moorline.SceneError) as caught:
        moorline.Scene.from_dict(scene)
    assert caught.value.place == "points[0].position" and caught.value.mistakes[0][2] is None
    scene["points"][0]["position"] = [405.0, None, -120.0]
    with pytest.raises(moorline.SceneError, match="leave the key out") as caught:
        moorline.Scene.from_dict(scene)
    assert caught.value.place == "points[0].position[1]"
    scene["points"][0]["position"] = [405.0, 0.0, -120.0]
    scene["seabed"]["depth"], scene["line_types"]["chain"]["mass"] = -120.0, -126.0
    with pytest.raises(moorline.SceneError) as caught:
        moorline.Scene.from_dict(scene)
    assert [place for place, *_ in caught.value.mistakes] == ["seabed.depth", "line_types.chain.mass"]
    for wrong in ({1: 2}, {"title": object()}, {"gravity": 2**70}):
        with pytest.raises(moorline.SceneError):
            moorline.Scene.from_dict(wrong)


def test_a_misspelt_key_gets_a_suggestion():
    with pytest.raises(moorline.SceneError, match="did you mean `axial_stiffness`"):
        moorline.Scene.from_toml(CHAIN.replace("axial_stiffness", "axial_stifness"))


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(moorline.SceneError, match="nothing.toml") as caught:
        moorline.Scene.load(tmp_path / "nothing.toml")
    assert str(caught.value.place).endswith("nothing.toml")


def test_a_scene_without_equilibrium_has_place_and_advice():
    scene = moorline.Scene.load(SCENES / "flying_spaghetti.toml")
    with pytest.raises(moorline.StaticsError) as caught:
        scene.statics()
    error = caught.value
    assert error.place and error.advice and error.line and error.line in error.place
    assert str(error).startswith(error.place)


def test_a_step_that_fails_has_time_place_and_advice_and_leaves_the_simulation(chain):
    simulation = moorline.Simulation(chain)
    simulation.advance({"fairlead.x": 0.1}, 0.05)
    before = simulation.outputs()
    with pytest.raises(moorline.StepError) as caught:
        simulation.advance({"fairlead.x": 1e9}, 0.05)
    error = caught.value
    assert error.time == pytest.approx(0.05) and error.line == "line1" and isinstance(error.node, int)
    assert error.advice and error.problem in str(error)
    assert np.array_equal(simulation.outputs(), before) and simulation.time == pytest.approx(0.05)


@pytest.mark.parametrize("inputs, words", [
    ({"fairlead.q": 1.0}, "did you mean"),
    ({"line1.tension_b": 1.0}, "no input"),
    ({"chain.drag_normal": 1.0}, "no input"),
    ({"fairlead.x": math.nan}, "not a finite number"),
    ({"fairlead.x": None}, "only velocities"),
    ([1.0, 2.0], "3 inputs: fairlead.x"),
    (np.array([1.0, 0.0, math.inf]), "not a finite number"),
    ({"fairlead.x": 1.0, "fairlead.y": math.nan}, "not a finite number"),
    ("fairlead.x", "must be a dict"),
    ({"fairlead.x": "far"}, "far is no number"),
    ({1: 1.0}, "no such input"),
])
def test_wrong_inputs_are_refused_by_name_and_change_nothing(chain, inputs, words):
    simulation = moorline.Simulation(chain)
    simulation.advance({"fairlead.y": 0.1}, 0.05)
    state = simulation.save().to_bytes()
    with pytest.raises(moorline.InputError, match=words) as caught:
        simulation.advance(inputs, 0.05)
    assert caught.value.place and simulation.save().to_bytes() == state


@pytest.mark.parametrize("step", [-0.1, math.nan, math.inf])
def test_a_step_that_is_no_time_is_refused(chain, step):
    with pytest.raises(moorline.InputError, match="step"):
        moorline.Simulation(chain).advance(None, step)


def test_unknown_names_are_refused_with_a_suggestion(chain):
    simulation = moorline.Simulation(chain)
    with pytest.raises(moorline.InputError, match="did you mean `line1.tension_"):
        simulation["line1.tension"]
    with pytest.raises(moorline.InputError, match="did you mean `line1`"):
        simulation.positions("line")
    with pytest.raises(moorline.InputError, match="did you mean `chain.drag_normal`"):
        chain.with_parameters({"chain.drag": 1.0})
    with pytest.raises(moorline.InputError, match="did you mean `line1.tension_"):
        moorline.run(chain, duration=1.0, columns=["line1.tension"])


@pytest.mark.parametrize("motion, words", [
    ({"fairlead.x": [0.0, 1.0]}, "time"),
    ({"time": [0.0, 1.0]}, "no column moves anything"),
    ({"time": [0.0, 1.0], "fairlead.x": [0.0]}, "1 rows, but there are 2 times"),
    ({"time": [0.0, 1.0], "fairlead.x": [0.0, math.nan]}, "row 1: NaN is not a finite number"),
    ({"time": [0.0, 1.0], "fairlead.vx": [0.0, 1.0]}, "velocities follow"),
    ({"time": [0.0, 1.0], "fairlead.x": ["a", "b"]}, "a row of numbers"),
    ({"time": np.array([0, 3000], "timedelta64[ms]"), "fairlead.x": [0.0, 1.0]}, "durations are no numbers"),
    ({"time": [0.0, 1.0], "fairlead.x": np.ma.array([0.0, 9.0], mask=[False, True])}, "masked numbers"),
    ([1.0, 2.0], "has no columns"),
])
def test_a_wrong_motion_is_refused_with_its_column(chain, motion, words):
    with pytest.raises(moorline.InputError, match=words):
        moorline.run(chain, motion)


def test_a_motion_of_nothing_and_one_back_in_time_are_mistakes_of_the_scene(chain):
    with pytest.raises(moorline.SceneError, match="nothing"):
        moorline.run(chain, {"time": [0.0, 1.0], "nothing.x": [0.0, 1.0]})
    with pytest.raises(moorline.SceneError) as caught:
        moorline.run(chain, {"time": [0.0, 1.0, 0.5], "fairlead.x": [0.0, 1.0, 2.0]})
    assert caught.value.place.startswith("motion.fairlead")


def test_a_parameter_out_of_its_bounds_is_refused(chain):
    with pytest.raises(moorline.SceneError) as caught:
        chain.with_parameters({"chain.drag_normal": -1.0})
    assert caught.value.place == "line_types.chain.drag_normal"
    with pytest.raises(moorline.InputError, match="not a finite number"):
        chain.with_parameters({"chain.drag_normal": math.nan})


def test_an_fmu_that_cannot_be_written_is_refused_by_its_path(chain, tmp_path):
    with pytest.raises(moorline.OutputError, match="no folder"):
        moorline.fmu(chain, tmp_path / "no" / "chain.fmu")
    with pytest.raises(moorline.InputError, match="2 or 3"):
        moorline.fmu(chain, tmp_path / "chain.fmu", fmi=1)


def test_errors_are_pickled_with_their_facts():
    with pytest.raises(moorline.SceneError) as caught:
        moorline.Scene.from_toml("gravity = -1.0")
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again), again.place) == (moorline.SceneError, str(caught.value), caught.value.place)
