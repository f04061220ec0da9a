"""Vessels and decks through the FMU: poses in, forces and moments out, for both FMI versions."""

import math

import numpy as np
import pytest

import scenes
from runs import driven, packaged, replayed, run

ORIGIN = np.array([10.0, -5.0, -3.0])  # of the barge [m]
ARMS = np.array([[20.0, 0.0, -7.0], [-20.0, 0.0, -7.0]])  # of its fairleads, body axes [m]
POSE = ["x", "y", "z", "roll", "pitch", "yaw"]
VELOCITY = ["vx", "vy", "vz", "wx", "wy", "wz"]
FORCE = ["fx", "fy", "fz", "mx", "my", "mz"]


def rotation(roll, pitch, yaw):
    """Body to global: by yaw about z, pitch about y', roll about x''."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return about_z @ about_y @ about_x


def at_pose(slave, scene, pose):
    """Force and moment on the vessel in equilibrium at a pose."""
    one = slave(scene)
    one.expect(one.enter())
    for name, value in zip(POSE, pose):
        one.expect(one.set(f"barge.{name}", value))
    return np.array([one.get(f"barge.{name}") for name in FORCE])


def test_the_variables_of_a_vessel_are_those_that_are_documented(library, version):
    description = library("BARGE", version).description
    of_barge = {n for n in description.names("input") if n.startswith("barge.")}
    assert of_barge == {f"barge.{name}" for name in POSE + VELOCITY}
    outputs = {n for n in description.names("output") if n.startswith("barge.")}
    assert outputs == {f"barge.{name}" for name in FORCE}
    units = {name: description.variables[f"barge.{name}"]["unit"] for name in ("x", "yaw", "wz", "fx", "mz")}
    assert units == {"x": "m", "yaw": "rad", "wz": "rad/s", "fx": "N", "mz": "N.m"}
    assert not any(name.startswith("fairlead") for name in description.names("input", "output"))


@pytest.mark.parametrize("pose", [
    (0, 0, 0, 0, 0, 0), (3.0, -2.0, 1.0, 0, 0, 0), (0, 0, 0, 0.3, 0, 0), (0, 0, 0, 0, -0.2, 0), (0, 0, 0, 0, 0, 0.4),
    (2.0, 1.0, -1.0, 0.2, -0.15, 0.5),
])
def test_force_and_moment_are_those_of_the_fairleads_on_their_arms(slave, pose):
    """The same lines with fairleads that the host carries itself."""
    found = at_pose(slave, "BARGE", pose)
    arms = ARMS @ rotation(*pose[3:]).T
    moved = np.array(pose[:3]) + arms - ARMS
    points = slave("FAIRLEADS")
    points.expect(points.enter())
    for number, shift in enumerate(moved, start=1):
        for axis, value in zip("xyz", shift):
            points.expect(points.set(f"fairlead{number}.{axis}", value))
    forces = np.array([[points.get(f"fairlead{number}.f{axis}") for axis in "xyz"] for number in (1, 2)])
    wanted = np.concatenate([forces.sum(axis=0), np.cross(arms, forces).sum(axis=0)])
    assert found == pytest.approx(wanted, rel=1e-9, abs=1e-3)


def test_yaw_between_two_opposite_lines_is_resisted_by_a_moment_alone(slave):
    """Half a turn about z maps the system onto itself, whatever the yaw."""
    greatest = abs(at_pose(slave, "BARGE", (5.0, 0, 0, 0, 0, 0))[0])
    moments = []
    for yaw in (-0.4, -0.2, 0.2, 0.4):
        fx, fy, _, mx, my, mz = at_pose(slave, "BARGE", (0, 0, 0, 0, 0, yaw))
        assert max(abs(fx), abs(fy)) < 1e-6 * greatest
        assert max(abs(mx), abs(my)) < 1e-6 * abs(mz)
        assert mz * yaw < 0.0
        moments.append(mz)
    assert np.array(moments) == pytest.approx(-np.array(moments[::-1]), rel=1e-8)


def test_a_turn_about_the_axis_that_the_lines_end_on_changes_nothing(slave):
    at_rest = at_pose(slave, "SPINDLE", (0, 0, 0, 0, 0, 0))
    turned = at_pose(slave, "SPINDLE", (0, 0, 0, 0, 0, 1.3))
    assert turned == pytest.approx(at_rest, rel=1e-9, abs=1e-4)


def test_half_a_turn_of_the_world_turns_forces_and_moments(slave):
    """The mooring is its own image under half a turn about z; a pose turned with it gives what it gave, turned."""
    pose = (2.0, 1.0, -1.0, 0.1, -0.05, 0.3)
    half = (-2.0, -1.0, -1.0, -0.1, 0.05, 0.3)
    found, image = at_pose(slave, "BARGE", pose), at_pose(slave, "BARGE", half)
    assert image == pytest.approx(found * [-1, -1, 1, -1, -1, 1], rel=1e-8, abs=1e-2)


@pytest.mark.parametrize("velocities", [False, True], ids=["poses", "velocities"])
def test_a_driven_vessel_feels_in_a_host_what_it_feels_in_a_run(moorline, version, tmp_path, velocities):
    scene = tmp_path / "barge.toml"
    scene.write_text(scenes.BARGE)
    options = ["--communication-step", 0.05] + (["--velocities"] if velocities else [])
    columns = run(moorline, scene, tmp_path / "run", *options)
    inputs = [f"barge.{name}" for name in POSE + (VELOCITY if velocities else [])]
    outputs = [*(f"barge.{name}" for name in FORCE), "line1.tension_b", "line2.tension_b"]
    fmu = packaged(moorline, scene, version, tmp_path)
    same = replayed(fmu, columns, inputs, outputs, tmp_path / "unpacked")
    assert all((same[output] == columns[output]).all() for output in outputs)
    result = driven(fmu, columns, outputs, inputs)  # its rounded times can change the degree of the path
    assert np.ptp(columns["barge.mz"]) > 1e4 and np.ptp(columns["barge.fx"]) > 1e4
    for output in outputs:
        size = np.abs(columns[output]).max()
        assert np.abs(result[output] - columns[output]).max() < 3e-3 * size, output


def test_a_deck_of_moordyn_becomes_an_fmu_that_runs_a_minute(moorline, version, tmp_path):
    deck = tmp_path / "mooring.dat"
    deck.write_text(scenes.DECK)
    time = np.arange(0.0, 60.025, 0.05)
    grow = np.minimum(time / 15.0, 1.0)
    columns = {"time": time, "vessel.x": 3.0 * grow * np.sin(2 * math.pi * time / 12.0),
               "vessel.z": 1.5 * grow * np.sin(2 * math.pi * time / 9.0),
               "vessel.pitch": 0.04 * grow * np.sin(2 * math.pi * time / 10.0)}
    outputs = [*(f"vessel.{name}" for name in FORCE), *(f"line{n}.tension_{e}" for n in (1, 2, 3) for e in "ab")]
    result = driven(packaged(moorline, deck, version, tmp_path), columns, outputs, list(columns)[1:])
    assert len(result) == 1201 and all(np.isfinite(result[name]).all() for name in outputs)
    assert min(result[f"line{n}.tension_b"].min() for n in (1, 2, 3)) > 0.0
    assert np.ptp(result["vessel.fx"]) > 1e4 and np.ptp(result["vessel.my"]) > 1e4
    for name in ("fy", "mx", "mz"):  # all is in one vertical plane
        assert np.abs(result[f"vessel.{name}"]).max() < 1e-6 * np.abs(result["vessel.fz"]).max()
    assert result["vessel.fz"].max() < 0.0
