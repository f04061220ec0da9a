#!/usr/bin/env python3
"""Draws the forces of moorline's libmoordyn and of MoorDyn's over time, for some of the cases that python_tests/test_libmoordyn.py compares.

MOORLINE=target/release/moorline .venv/bin/python capi/moordyn/hosts/traces.py docs/figures/libmoordyn.svg
"""

import pathlib
import subprocess
import sys
import tempfile

import matplotlib.pyplot as plt
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "python_tests"))
import test_libmoordyn as compared

SHOWN = "oc3", "taut, tension from a table", "clump", "lindahl, 3.5 s", "lindahl, 1.25 s"
"""Cases by name, with the calls of HydroChrono."""


def traces(case, program, folder):
    """Times [s] and forces of moorline and of MoorDyn [N], a row a step."""
    _, text, host, motion, step, duration, dtm, _, _ = case
    text = compared.with_options(text, {"dtM": dtm, "tScheme": "RK2", "writeLog": 0, "disableOutput": 1, **compared.RELAXATION})
    rows = np.array([np.concatenate(motion(k * step)) for k in range(round(duration / step))])
    libraries = {"ours": compared.OURS, "theirs": compared.peer_library()}
    forces = [compared.drive(program, library, host, folder / name, text, rows, step)[0] for name, library in libraries.items()]
    return step * np.arange(1, len(rows) + 1), *forces


def main():
    plt.rcParams["svg.hashsalt"] = "libmoordyn"
    cases = [next(case for case in compared.CASES if (case[0], case[2]) == (name, "hydrochrono")) for name in SHOWN]
    figure, axes = plt.subplots(len(cases), 1, figsize=(9, 2.2 * len(cases)), layout="constrained")
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        program = folder / "hosts"
        subprocess.run(["gcc", "-std=gnu99", "-O2", "-I", compared.INCLUDE, compared.HOSTS, "-o", program, "-ldl"], check=True)
        for number, (case, plot) in enumerate(zip(cases, axes)):
            t, ours, theirs = traces(case, program, folder / str(number))
            late = t > t[-1] - 10.0
            unit, scale = ("N", 1.0) if np.abs(theirs[late]).max() < 1e4 else ("kN", 1e3)
            size = [np.linalg.norm(forces[late, :3], axis=1) / scale for forces in (theirs, ours)]
            plot.plot(t[late], size[0], color="0.6", linewidth=3, label="MoorDyn 2.7.2")
            plot.plot(t[late], size[1], color="tab:blue", linewidth=1, label="moorline")
            plot.set_title(case[0], loc="left", fontsize="medium")
            plot.set_ylabel(f"force [{unit}]")
    axes[0].legend(loc="upper right", ncols=2)
    axes[-1].set_xlabel("time [s]")
    figure.savefig(sys.argv[1], metadata={"Date": None})


if __name__ == "__main__":
    main()
