"""Scenes from files, texts and dicts; statics and modes."""

import copy
import json
import pickle
import tomllib

import numpy as np
import pytest

import moorline
from conftest import CHAIN, DECKS, SCENES, SEMI


def test_a_scene_is_the_same_from_a_file_a_text_and_a_dict(chain, tmp_path):
    (tmp_path / "chain.toml").write_text(CHAIN)
    assert moorline.Scene.load(tmp_path / "chain.toml") == chain
    assert moorline.Scene.from_dict(tomllib.loads(CHAIN)) == chain
    assert moorline.Scene.from_toml(chain.to_toml()) == chain
    assert moorline.Scene.from_dict(chain.to_dict()) == chain


def test_arrays_and_numbers_of_numpy_are_lists_and_numbers_of_a_dict(chain):
    scene = tomllib.loads(CHAIN)
    scene["points"][0]["position"] = np.array(scene["points"][0]["position"])
    scene["seabed"]["depth"] = np.float64(120.0)
    scene["lines"][0]["sections"][0]["elements"] = np.int64(20)
    assert moorline.Scene.from_dict(scene) == chain


def test_a_deck_is_a_scene_and_takes_what_it_leaves_to_its_host():
    scene = moorline.Scene.load(DECKS / "moordyn_v1.dat")
    assert scene.lines and scene.statics().lines[0].end_b.tension > 0.0
    with pytest.raises(moorline.SceneError, match="depth"):
        moorline.Scene.load(DECKS / "oc3.map")
    assert moorline.Scene.load(DECKS / "oc3.map", depth=320.0).lines


def test_statics_are_those_of_the_program_to_the_last_bit(semi, program, tmp_path):
    (tmp_path / "semi.toml").write_text(SEMI)
    printed = json.loads(program("statics", "semi.toml", "--json").stdout)
    found = semi.statics()
    for line, expected in zip(found.lines, printed["lines"], strict=True):
        assert line.name == expected["name"]
        assert line.end_b.force.tolist() == expected["end_b"]["force"]
        assert line.catenary._asdict() == expected["catenary"]
        assert (line.horizontal, line.laid_length, line.sag) == tuple(expected[key] for key in ("horizontal", "laid_length", "sag"))
        for name in ("s", "x", "y", "z", "tension"):
            assert getattr(line.profile, name).tolist() == [node[name] for node in expected["profile"]]
        assert line.profile.curvature is None
    vessel, expected = found.vessels["platform"], printed["vessels"][0]
    assert vessel.stiffness.tolist() == expected["stiffness"] and vessel.stiffness.shape == (6, 6)
    assert vessel.elements.stiffness.tolist() == expected["elements"]["stiffness"]
    assert found.points["fairlead1"].kind == "coupled"
    with pytest.raises(KeyError, match="line1, line2, line3"):
        found.lines["line9"]


def test_modes_are_those_of_the_program_to_the_last_bit(chain, program, tmp_path):
    (tmp_path / "chain.toml").write_text(CHAIN)
    printed = json.loads(program("modes", "chain.toml", "--json", "--count", 3).stdout)
    found = chain.modes(3)
    for mode, expected in zip(found, printed["modes"], strict=True):
        assert (mode.period, mode.frequency, mode.modal_mass) == tuple(expected[key] for key in ("period", "frequency", "modal_mass"))
        assert mode.greatest._asdict() == expected["greatest"] and mode.direction == expected["direction"]
        shape = mode.shapes["line1"]
        assert shape.transverse.tolist() == [node["transverse"] for node in expected["shapes"][0]["nodes"]]


def test_parameters_have_the_names_of_the_fmu_and_give_another_scene(chain):
    assert chain.parameters["chain.drag_normal"] == 1.3
    other = chain.with_parameters({"chain.drag_normal": 1.8, "seabed.depth": 121.0})
    assert (other.parameters["chain.drag_normal"], chain.parameters["chain.drag_normal"]) == (1.8, 1.3)
    assert other.to_dict()["seabed"]["depth"] == 121.0


def test_remarks_follow_changed_parameters_and_motions(chain):
    unlikely = chain.with_parameters({"chain.drag_normal": 120.0})
    assert [note for note in unlikely.notes if "drag_normal" in note] and not [note for note in chain.notes if "drag_normal" in note]
    assert unlikely.with_parameters({"chain.drag_normal": 1.3}).notes == chain.notes
    lifted = chain.with_motion({"time": [0.0, 10.0], "fairlead.z": [0.0, 500.0]})
    assert lifted.notes != chain.notes


def test_scenes_are_pickled_to_the_last_bit(chain):
    assert pickle.loads(pickle.dumps(chain)) == chain


def test_all_public_scenes_load_and_say_what_they_model():
    for path in sorted(SCENES.glob("*.toml")):
        scene = moorline.Scene.load(path)
        assert scene.title in repr(scene) or '"' in scene.title
        assert scene.in_words().strip()


def test_a_copy_of_statics_is_plain_data(chain):
    found = chain.statics()
    again = copy.deepcopy(found)
    assert again.lines["line1"].end_b.tension == found.lines["line1"].end_b.tension
