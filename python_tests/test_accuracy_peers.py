"""The peers' side of `moorline accuracy`: the script `accuracy/peers.py` describes to MoorDyn the system that moorline computes.

claim: motions are differentiated exactly, nodes of uneven meshes give the place half-way, and MoorDyn's tensions and places on a bridle (a turning
vessel, a free plate, a line of two sections) are moorline's, up to the mesh.
"""

import importlib.util
import json
import pathlib
import re

import numpy as np
import pytest

from runs import run

ROOT = pathlib.Path(__file__).resolve().parent.parent
MOTION = """[motion]
barge = { x = [[1.5, 11.0]], z = [[1.0, 9.0]], roll = [[0.1, 12.0, 0.5]], pitch = [[0.06, 10.0]], yaw = [[0.2, 20.0]], ramp = 10.0 }"""


@pytest.fixture(scope="module")
def peers():
    """The script as a module."""
    spec = importlib.util.spec_from_file_location("peers", ROOT / "accuracy" / "peers.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def bridle(tmp_path_factory):
    """A scene of 1 s under the peers' laws."""
    text = (ROOT / "scenes" / "bridle.toml").read_text()
    text = re.sub(r"(?s)\[motion\].*?(?=\n\[output\])", MOTION + "\n", text)
    text = text.replace("duration = 60.0", "duration = 1.0") + "\n[solver]\nnegative_tension = true\n"
    scene = tmp_path_factory.mktemp("bridle") / "bridle.toml"
    scene.write_text(text)
    return scene


@pytest.fixture(scope="module")
def question(moorline, bridle):
    """The scene as the script gets it, from a study whose own runs are few: equilibria."""
    asked, python = bridle.parent / "question.json", bridle.parent / "python"
    scene = bridle.parent / "equilibria.toml"
    scene.write_text(bridle.read_text() + 'integrator = "quasi_static"\n')
    python.write_text(f'#!/bin/sh\n[ "$1" = -c ] && echo ready || head -1 > {asked}\n')
    python.chmod(0o755)
    done = moorline("accuracy", scene, "-o", bridle.parent / "out", "--peers", python)
    assert "no peer gave a result" in done.stderr
    return json.loads(asked.read_text())


def test_the_derivatives_of_a_turning_bodys_motion_are_those_of_its_places(peers):
    motion = {
        "position": [3.0, -2.0, 1.0], "attitude": [0.1, -0.2, 2.0], "arm": [20.0, 8.0, -2.0], "ramp": 5.0,
        "sines": [[[2.0, 11.0]], [], [[1.0, 9.0, 0.3]], [[0.1, 12.0, 0.5]], [[0.06, 10.0]], [[0.2, 20.0]]],
    }  # fmt: skip
    times, step = np.array([1.0, 4.0, 7.3, 12.9]), 1e-4
    position, velocity, acceleration = peers.placed(motion, times)
    before, after = (peers.placed(motion, times + shift) for shift in (-step, step))
    assert np.allclose((after[0] - before[0]) / (2.0 * step), velocity, atol=1e-7)
    assert np.allclose((after[1] - before[1]) / (2.0 * step), acceleration, atol=1e-7)
    # The arm keeps its length about the origin of the body.
    centre = peers.placed(motion | {"arm": [0.0, 0.0, 0.0]}, times)[0]
    assert np.allclose(np.linalg.norm(position - centre, axis=1), np.linalg.norm(motion["arm"]))


def test_an_uneven_mesh_gives_the_place_half_way(peers):
    line = {"sections": [{"length": 30.0}, {"length": 10.0}]}
    arc = peers.arcs(line, [4, 5])
    assert arc.tolist() == [0.0, 7.5, 15.0, 22.5, 30.0, 32.0, 34.0, 36.0, 38.0, 40.0]
    cubic = np.array([[s, 0.1 * s**2, 1e-3 * s**3] for s in arc])
    assert np.allclose(peers.half_way(arc, cubic), [20.0, 40.0, 8.0])
    assert np.allclose(peers.half_way(np.array([0.0, 4.0, 6.0]), cubic[:3]), 0.25 * cubic[0] + 0.75 * cubic[1])


def test_a_driven_bridle_in_moordyn_is_moorlines(peers, moorline, question, bridle, tmp_path, monkeypatch):
    pytest.importorskip("cmoordyn", reason="the package moordyn is not installed: no peer to compare with")
    duration = 30.0
    scene = question | {"duration": duration}
    monkeypatch.chdir(tmp_path)
    settings = peers.moordyn_run(40, "Midpoint2", (0.0025, 0.00125), None, "")
    results = peers.results(scene, peers.MoorDyn(scene, settings))
    columns = run(moorline, bridle, tmp_path / "out", "--duration", duration)
    late = int(10.0 / scene["interval"])
    for tension, line in zip(results["tension"], ("leg_port", "leg_starboard"), strict=True):
        own, theirs = columns[f"{line}.tension_b"][1:][late:], np.array(tension)[late:]
        assert np.sqrt(np.mean((own - theirs) ** 2)) < 0.05 * own.std(), line
    # The roll and the yaw of the barge make the two legs unlike.
    assert np.abs(np.subtract(*results["tension"])).max() > 0.2 * np.std(results["tension"][0])
    assert "CableDyn" in peers.beyond(scene) and "MoorDyn" not in peers.beyond(scene)
