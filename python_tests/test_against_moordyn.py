"""Beside MoorDyn, the package `moordyn` of PyPI, on decks that both read: equilibria, and the tensions of driven systems.

Both codes get the deck's own segments, MoorDyn's contact (`contact = "as_given"`) and its law of slack lines
(`negative_tension = true`), so that what is left is the codes' own: meshes, time steps, end forces. What is compared is the force
on the fairlead. MoorDyn's FairTen is another number, the last segment's tension, 1 % lower on OC3 with 20 segments.
"""

import json
import re

import numpy as np
import pytest

import decks
from runs import run

moordyn = pytest.importorskip("moordyn", reason="the package moordyn is not installed: no peer to compare with")

from moordyn_peer import Peer  # noqa: E402

STEP = 0.02  # communication step [s]
TRANSIENT = 20.0  # of the driven runs [s]
MOTION = ["--move", "vessel.x=5,12", "--move", "vessel.z=2,9", "--ramp", TRANSIENT, "--duration", 60]


@pytest.fixture
def as_peers(moorline, tmp_path):
    """Converts a deck to a scene with the peers' laws and returns its path."""

    def convert(text):
        deck, scene = tmp_path / "deck.txt", tmp_path / "scene.toml"
        deck.write_text(text)
        done = moorline("convert", deck, "-o", scene)
        assert done.returncode == 0, done.stderr
        laws = {"contact": '"as_given"', "negative_tension": "true", "interval": STEP}
        converted = scene.read_text()
        for key, value in laws.items():
            converted = re.sub(rf"(?m)^{key} = \S+", f"{key} = {value}", converted)
        scene.write_text(converted)
        return scene

    return convert


def at_rest(moorline, scene):
    """Points of the equilibrium by their number in the deck: position [m] and force of the lines [N]."""
    done = moorline("statics", scene, "--json")
    assert done.returncode == 0, done.stderr
    points = json.loads(done.stdout)["points"]
    return {int(point["name"].removeprefix("point")): point for point in points}


def vessel_points(text):
    return [int(number) for number in re.findall(r"(?m)^(\d+) Vessel", text)]


def started_at(text, points):
    """The deck with its free points where they are in equilibrium: MoorDyn's relaxation hardly damps them."""
    for number in re.findall(r"(?m)^(\d+) Free", text):
        place = " ".join(map(repr, points[int(number)]["position"]))
        text = re.sub(rf"(?m)^{number} Free \S+ \S+ \S+", f"{number} Free {place}", text)
    return text


@pytest.mark.parametrize("name, time_step, tolerance", [
    ("oc3", 0.002, 3e-5), ("oc4", 0.002, 1e-5), ("volturnus", 0.002, 1e-6), ("taut", 0.004, 1e-6),
    ("buoyed", 0.002, 1e-3), ("clump", 0.002, 1e-3),
])
def test_fairlead_forces_in_equilibrium_are_moordyns(moorline, as_peers, tmp_path, name, time_step, tolerance):
    """The seabed acts at nodes in MoorDyn. Free points still swing there after its relaxation, by 0.03 % of the force."""
    text = getattr(decks, name)()
    points = at_rest(moorline, as_peers(text))
    fairleads = vessel_points(text)
    ours = np.array([points[number]["force"] for number in fairleads])
    peer = Peer(moordyn, started_at(text, points), tmp_path, time_step)
    theirs = peer.start([points[number]["position"] for number in fairleads])
    peer.close()
    error = np.linalg.norm(ours - theirs, axis=1) / np.linalg.norm(ours, axis=1)
    print(f"{name}: differences of fairlead forces {error}")
    assert error.max() < tolerance


def driven(moorline, as_peers, folder, text, time_step):
    """Sizes of the fairlead forces [N] of moorline and of MoorDyn in time, a column for each line."""
    folder.mkdir()
    scene = as_peers(text)
    points = at_rest(moorline, scene)
    columns = run(moorline, scene, folder / "run", *MOTION)
    count = len(vessel_points(text))
    ours = np.array([columns[f"line{number}.tension_b"] for number in range(1, count + 1)]).T
    still = np.array([points[number]["position"] for number in vessel_points(text)])
    peer = Peer(moordyn, text, folder, time_step, {"dtIC": 1.0, "TmaxIC": 200.0, "CdScaleIC": 5.0, "threshIC": 1e-4})
    theirs = [peer.start(still)]
    moved = np.array([columns["vessel.x"], np.zeros_like(columns["time"]), columns["vessel.z"]]).T
    theirs += [peer.step(still + shift, STEP) for shift in moved[1:]]
    peer.close()
    late = columns["time"] > TRANSIENT
    return ours[late], np.linalg.norm(theirs, axis=2)[late]


def rms(difference):
    return np.sqrt((difference**2).mean(axis=0))


@pytest.mark.parametrize("name, segments, peak_tolerance", [("oc3", 20, 0.004), ("volturnus", 25, 0.004)])
def test_driven_tensions_differ_by_less_than_the_meshes_leave_open(moorline, as_peers, tmp_path, name, segments, peak_tolerance):
    """Each code at n and 2n segments: what halving the segments changes in one code is more than what the codes differ by."""
    coarse = driven(moorline, as_peers, tmp_path / "coarse", getattr(decks, name)(segments), 0.002)
    fine = driven(moorline, as_peers, tmp_path / "fine", getattr(decks, name)(2 * segments), 0.001)
    size = fine[0].std(axis=0)
    open_in_ours, open_in_theirs = (rms(a - b) / size for a, b in zip(coarse, fine))
    at_coarse, at_fine = (rms(ours - theirs) / size for ours, theirs in (coarse, fine))
    peaks = abs(fine[0].max(axis=0) / fine[1].max(axis=0) - 1.0)
    print(f"{name}: mesh {open_in_ours} ours, {open_in_theirs} MoorDyn's; codes {at_coarse} at n, {at_fine} at 2n; peaks {peaks}")
    assert (at_coarse < np.minimum(open_in_ours, open_in_theirs)).all()
    assert (at_fine < np.minimum(open_in_ours, open_in_theirs)).all()
    assert (peaks < peak_tolerance).all()
