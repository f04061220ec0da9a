"""libmoordyn of moorline beside that of MoorDyn, which the package `moordyn` of PyPI carries: the same programs, decks and motions.

The programs are those of capi/moordyn/hosts/hosts.c: the calls of WEC-Sim, HydroChrono, foamMooring and ERF. Both codes get the deck's segments and,
by moorline's default behind this interface, the same laws, paths and meaning of forces.
"""

import math
import os
import pathlib
import re
import shutil
import subprocess

import numpy as np
import pytest

import decks
from conftest import HERE, MOORLINE

moordyn = pytest.importorskip("moordyn", reason="the package moordyn is not installed: no peer to compare with")

OURS = pathlib.Path(MOORLINE).parent / "libmoordyn.so"
HOSTS = HERE.parent / "capi" / "moordyn" / "hosts" / "hosts.c"
INCLUDE = HERE.parent / "capi" / "moordyn" / "include"
# of MoorDyn, for a tight equilibrium: its stationary solver ends far from it where lines meet at free points
RELAXATION = {"ICgenDynamic": 1, "dtIC": 1.0, "TmaxIC": 400, "CdScaleIC": 5, "threshIC": 1e-6}
# beside every deck; MoorDyn skips three lines of a table, and reads no line behind its last row
FILES = {
    "rope.txt": "--- rope ---\nstrain tension\n(-) (N)\n0.0 0.0\n0.01 1.0e5\n0.05 1.5e6",
    "current_profile.txt": "--- steady current ---\nprofile\nz ux uy uz\n-320.0 0.1 0.0 0.0\n-100.0 0.4 0.1 0.0\n0.0 0.9 0.3 0.0\n",
    "wave_frequencies.txt": "".join(f"{0.05 * k:.2f} {a} {b}\n" for k, (a, b) in enumerate(
        [(0, 0)] * 9 + [(0.3, 0.1), (0.6, -0.4), (1.0, 0.2), (0.8, 0.6), (0.5, -0.3), (0.3, 0.2)] + [(0, 0)] * 4)),
}
BODIES = """\
---------------------- BODIES ----------------------------------------------
ID  Attachment  X0  Y0  Z0  r0  p0  y0  Mass  CG  I  Volume  CdA  Ca
(#)  (-)  (m)  (m)  (m)  (deg)  (deg)  (deg)  (kg)  (m)  (kg-m^2)  (m^3)  (m^2)  (-)
1  Coupled  0 0 0  0 0 0  0 0 0 0 0 0
"""


def peer_library():
    folder = pathlib.Path(moordyn.__file__).resolve().parent.parent / "moordyn.libs"
    found = sorted(folder.glob("libmoordyn*.so*"))
    return found[0] if found else pytest.skip("the package moordyn carries no library of its own")


@pytest.fixture(scope="session")
def hosts(tmp_path_factory):
    """The program of hosts."""
    if not shutil.which("gcc"):
        pytest.skip("there is no gcc on this machine")
    program = tmp_path_factory.mktemp("hosts") / "hosts"
    subprocess.run(["gcc", "-std=gnu99", "-O2", "-Wall", "-Wextra", "-Werror", "-I", INCLUDE, HOSTS, "-o", program, "-ldl"], check=True)
    return program


def with_options(text, options):
    rows = "".join(f"{value}  {key}\n" for key, value in options.items())
    return re.sub(r"(?m)^(-+ OPTIONS.*\n)", lambda head: head.group(1) + rows, text)


def coupled(text):
    """A deck whose fairleads are coupled points."""
    return text.replace(" Vessel ", " Coupled ")


def on_body(text):
    """A deck whose fairleads are on one coupled body."""
    return text.replace(" Vessel ", " Body1 ").replace("---------------------- POINTS", BODIES + "---------------------- POINTS", 1)


def one_chain(segments=20):
    return decks.deck("one line of OC3", ["chain 0.09 77.7066 384.243E6 -0.8 0 1.6 1.0 0.1 0.0"],
                      ["1 Fixed 853.87 0 -320 0 0 0 0", "2 Coupled 5.2 0 -70 0 0 0 0"], [f"1 chain 1 2 902.2 {segments} -"],
                      {"WtrDpth": 320.0, "kBot": 3.0e6, "cBot": 3.0e5})


def lindahl():
    """The chain of Lindahl (1985), which slackens and snaps in every turn of 1.25 s."""
    return decks.deck("Lindahl's chain", ["chain 0.0022 0.0818 1.0E4 20 0 2.5 2.8 0.16 0.0"],
                      ["1 Fixed 32.554 0 -3 0 0 0 0", "2 Coupled 0 0 0 0 0 0 0"], ["1 chain 1 2 33.0 40 -"],
                      {"WtrDpth": 3.0, "kBot": 3.0e7, "cBot": 3.0e4, "g": 9.81})


def sea():
    """A chain from near the surface in waves and a current from files."""
    text = one_chain().replace("5.2 0 -70", "5.2 0 -10").replace("902.2 20", "920 20")
    return with_options(text, {"WaveKin": 7, "dtWave": 0.25, "Currents": 1})


def rope(stiffness, damping):
    """A taut rope with another law of tension."""
    return coupled(decks.taut()).replace("2.0E7 -0.5", f"{stiffness} {damping}")


def light_cable(bending_stiffness=0, depth=100):
    """A short, stiff cable that slaps on a soft seabed: its axial waves are 5 times as fast as its steps are long."""
    return decks.deck("a cable", [f"cable 0.2 80 7.0E8 -0.8 {bending_stiffness} 1.2 1.0 0.1 0.0"],
                      ["1 Fixed 150 0 -100 0 0 0 0", "2 Coupled 0 0 -10 0 0 0 0"],
                      ["1 cable 1 2 200 30 -"], {"WtrDpth": depth, "kBot": 3.0e4, "cBot": 0.0})


def bridle():
    """A chain that parts to two fairleads."""
    return decks.deck("a bridle", ["chain 0.09 77.7066 384.243E6 -0.8 0 1.6 1.0 0.1 0.0"],
                      ["1 Fixed 853.87 0 -320 0 0 0 0", "2 Free 60 0 -90 0 0 0 0", "3 Coupled 5 8 -70 0 0 0 0", "4 Coupled 5 -8 -70 0 0 0 0"],
                      ["1 chain 1 2 845 20 -", "2 chain 2 3 58 4 -", "3 chain 2 4 58 4 -"], {"WtrDpth": 320.0, "kBot": 3.0e6, "cBot": 3.0e5})


def ramped(t, duration):
    """A smooth growth from 0 to 1, and its rate [1/s]."""
    s = min(t / duration, 1.0)
    return 3 * s**2 - 2 * s**3, (6 * s - 6 * s**2) / duration


def harmonic(base, parts, duration=20.0):
    """Motion about `base`: amplitude, period [s] and phase by degree of freedom."""

    def at(t):
        place, rate = np.array(base, float), np.zeros(len(base))
        growth, speed = ramped(t, duration)
        for axis, (amplitude, period, phase) in parts.items():
            w = 2 * math.pi / period
            place[axis] += amplitude * growth * math.sin(w * t + phase)
            rate[axis] += amplitude * (growth * w * math.cos(w * t + phase) + speed * math.sin(w * t + phase))
        return place, rate

    return at


SWAY = harmonic([5.2, 0, -70], {0: (5, 12, 0), 2: (2, 9, 0)})
ROPE = harmonic([10, 0, -10], {0: (2, 12, 0), 2: (1, 9, 0)})
FLOAT = harmonic([0, 0, -10], {0: (2, 12, 0), 1: (1, 15, 0.3), 2: (1.5, 9, 0)})
SIX = harmonic([0] * 6, {0: (3, 12, 0), 1: (1, 15, 0), 2: (1.5, 9, 0), 3: (0.05, 10, 0), 4: (0.06, 12, 0), 5: (0.03, 20, 0)})


def turn(period):
    return harmonic([0, 0, 0], {0: (0.2, period, math.pi / 2), 2: (0.2, period, 0)}, 5.0)


def drive(program, library, host, folder, text, motion, step):
    """Forces of a library under a host, a row a step, and the processor time of all steps [s]."""
    folder.mkdir(parents=True)
    for name, content in {"deck": text, **FILES}.items():
        (folder / name).write_text(content)
    motion.tofile(folder / "motion")
    freedom = motion.shape[1] // 2
    command = [program, library, host, "deck", freedom, "motion", step, "forces"]
    environment = {key: value for key, value in os.environ.items() if not key.startswith("MOORLINE_")}
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, env=environment, cwd=folder)
    assert done.returncode == 0, done.stderr
    return np.fromfile(folder / "forces").reshape(-1, freedom), float(done.stdout.split()[-1])


def rms(values):
    return np.sqrt((values**2).sum(axis=1).mean())


CASES = [
    # name, deck, host, motion, communication step [s], duration [s], dtM [s], transient [s], greatest difference of forces
    ("oc3", one_chain(), "hydrochrono", SWAY, 0.02, 60, 0.002, 20, 0.005),
    ("oc3", one_chain(), "erf", SWAY, 0.05, 60, 0.002, 20, 0.005),
    ("oc3", one_chain(), "foam_mooring", SWAY, 0.02, 60, 0.002, 20, 0.005),
    ("taut", coupled(decks.taut()), "hydrochrono", ROPE, 0.02, 40, 0.004, 20, 0.005),
    ("taut, tension from a table", rope("rope.txt", "-0.5"), "hydrochrono", ROPE, 0.02, 40, 0.004, 20, 0.005),
    ("taut, viscoelastic", rope("1.2E7|2.4E7", "5.0E7|2.0E6"), "hydrochrono", ROPE, 0.02, 40, 0.002, 20, 0.005),
    ("oc3 in waves and a current", sea(), "hydrochrono", harmonic([5.2, 0, -10], {0: (3, 12, 0), 2: (1.5, 9, 0)}), 0.02, 40, 0.002, 20, 0.005),
    ("cable on a soft seabed", light_cable(), "hydrochrono", FLOAT, 0.02, 40, 0.0005, 15, 0.005),
    ("cable that bends on a soft seabed", light_cable(1.0e4), "hydrochrono", FLOAT, 0.02, 40, 0.0005, 15, 0.005),
    ("cable that bends and hangs", light_cable(1.0e5, 300), "hydrochrono", FLOAT, 0.02, 40, 0.0005, 15, 0.001),
    ("bridle", bridle(), "hydrochrono", harmonic([5, 8, -70, 5, -8, -70], {axis: (3, 12, 0) for axis in (0, 3)}), 0.02, 40, 0.001, 20, 0.005),
    ("clump", coupled(decks.clump()), "hydrochrono", harmonic([5, 0, -10], {0: (3, 12, 0), 2: (1.5, 9, 0)}), 0.02, 40, 0.002, 20, 0.005),
    ("oc4 on a body", on_body(decks.oc4()), "wec_sim", SIX, 0.02, 60, 0.002, 20, 0.002),
    ("oc3 on a body", on_body(decks.oc3()), "wec_sim", SIX, 0.01, 60, 0.002, 20, 0.002),
    ("oc4, three points", coupled(decks.oc4()), "foam_mooring",
     harmonic([*(40.868 * f(math.radians(a)) for a in (60,) for f in (math.cos, math.sin)), -14.0, -40.868, 0.0, -14.0,
               *(40.868 * f(math.radians(300)) for f in (math.cos, math.sin)), -14.0],
              {axis: (2, 12, 0) for axis in (0, 3, 6)}), 0.02, 60, 0.002, 20, 0.005),
    ("lindahl, 3.5 s", lindahl(), "hydrochrono", turn(3.5), 0.01, 20, 0.0005, 8, 0.005),
    ("lindahl, 1.25 s", lindahl(), "hydrochrono", turn(1.25), 0.01, 20, 0.0005, 8, 0.01),
]


@pytest.mark.parametrize("name, text, host, motion, step, duration, dtm, transient, tolerance", CASES,
                         ids=[f"{case[2]}: {case[0]}" for case in CASES])
def test_forces_are_moordyns_for_less_processor_time(hosts, tmp_path, name, text, host, motion, step, duration, dtm, transient, tolerance):
    """Also where lines snap, at twice the tolerance. `dtM` is that of a deck of such a mesh. Processor times are printed: a shared machine
    makes no claim of them but that moorline's is less."""
    text = with_options(text, {"dtM": dtm, "tScheme": "RK2", "writeLog": 0, "disableOutput": 1, **RELAXATION})
    rows = np.array([np.concatenate(motion(k * step)) for k in range(round(duration / step))])
    ours, our_time = drive(hosts, OURS, host, tmp_path / "ours", text, rows, step)
    theirs, their_time = drive(hosts, peer_library(), host, tmp_path / "theirs", text, rows, step)
    late = slice(round(transient / step), None)
    difference = rms(ours[late, :3] - theirs[late, :3]) / rms(theirs[late, :3])
    moment = rms(ours[late, 3:] - theirs[late, 3:]) / rms(theirs[late, 3:]) if host == "wec_sim" else 0.0
    print(f"{host}, {name}, steps of {step} s: forces differ by {difference:.2%} RMS{f', moments by {moment:.2%}' if moment else ''}; "
          f"processor time {our_time:.4f} s and {their_time:.4f} s, ratio {their_time / our_time:.1f}")
    assert difference < tolerance
    assert moment < 4 * tolerance  # three lines nearly balance: the moment is a small difference
    assert our_time < their_time


def at_rest(program, library, folder, text, place):
    """Force of the static equilibrium at a place, after a step of no length."""
    row = np.array([[*place, *np.zeros(len(place))]])
    forces, _ = drive(program, library, "wec_sim", folder, text, row, 1e-6)
    return forces[0]


@pytest.mark.parametrize("place", [[3, -2, 1, 0, 0, 0], [0, 0, 0, 0.2, -0.3, 0.4], [5, 1, -1, -0.1, 0.25, -0.5]])
def test_a_turned_body_has_moordyns_force_and_moment(hosts, tmp_path, place):
    """Angles are Rx Ry Rz, in any combination."""
    options = {"dtM": 0.002, "writeLog": 0, "disableOutput": 1, **RELAXATION, "ICgenDynamic": 0, "TmaxIC": 800}
    text = with_options(on_body(decks.oc4()), options)
    ours = at_rest(hosts, OURS, tmp_path / "ours", text, place)
    theirs = at_rest(hosts, peer_library(), tmp_path / "theirs", text, place)
    for part in (slice(0, 3), slice(3, 6)):
        assert np.linalg.norm(ours[part] - theirs[part]) < 1e-3 * np.linalg.norm(theirs[part])


def test_channels_are_moordyns(hosts, tmp_path):
    """The same names, units and times, and values within the difference of the codes."""
    text = with_options(one_chain(), {"dtM": 0.002, "tScheme": "RK2", "writeLog": 0, **RELAXATION})
    text = text.replace("902.2 20 -", "902.2 20 pvt")
    rows = np.array([np.concatenate(SWAY(k * 0.1)) for k in range(300)])
    tables = []
    for who, library in (("ours", OURS), ("theirs", peer_library())):
        drive(hosts, library, "erf", tmp_path / who, text, rows, 0.1)
        tables.append({name: (tmp_path / who / name).read_text().splitlines() for name in ("deck.out", "deck_Line1.out")})
    ours, theirs = tables
    for name, table in ours.items():
        head, units, *rows = (line.split() for line in table)
        assert head == theirs[name][0].split()
        assert [unit.strip("()") for unit in units] == [unit.strip("()") for unit in theirs[name][1].split()]
        values, peers = (np.array([line.split() for line in lines[2:]], float) for lines in (table, theirs[name]))
        assert values.shape == peers.shape and np.allclose(values[:, 0], peers[:, 0], atol=1e-9)
        late = values[:, 0] > 20
        scale = rms(peers[late, 1:]) / math.sqrt(peers.shape[1] - 1)
        assert rms(values[late, 1:] - peers[late, 1:]) / math.sqrt(peers.shape[1] - 1) < 0.01 * scale
        for column in (slice(k, k + 1) for k, name in enumerate(head) if "Ten" in name):
            assert rms(values[late, column] - peers[late, column]) < 0.005 * rms(peers[late, column]), head[column]
