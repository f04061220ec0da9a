"""MoorDyn in this process, from a deck of ours: its equilibrium, and its forces under a motion that is given.

MoorDyn finds its equilibrium by dynamic relaxation, so it is asked for a tight one. Its coupled points jump by half the
acceleration times the step squared where a host gives velocities of the steps' beginnings; it gets those of the way through each
step instead, so that its points go through where the motion has them.
"""

import re

import numpy as np

RELAXATION = {"dtIC": 1.0, "TmaxIC": 800.0, "CdScaleIC": 5.0, "threshIC": 1e-8}
SETTINGS = re.compile(r"(?mi)^\S+\s+(dtM|cfl|dtIC|TmaxIC|CdScaleIC|threshIC|fileIC|writeLog|tScheme|ICgenDynamic)\b.*\n")


class Peer:
    """One MoorDyn system; close it."""

    def __init__(self, moordyn, text, folder, time_step, relaxation=RELAXATION):
        """`time_step` [s] is that of its explicit second-order Runge-Kutta scheme."""
        settings = {"dtM": time_step, "tScheme": "RK2", "writeLog": 0, "disableOutput": 1, "disableOutTime": 1, **relaxation}
        rows = "".join(f"{value}  {name}\n" for name, value in settings.items())
        head, tail = re.split(r"(?mi)^-+ *(?:SOLVER )?OPTIONS.*\n", SETTINGS.sub("", text), maxsplit=1)
        path = folder / "peer.txt"
        path.write_text(f"{head}---------------- OPTIONS ----------------\n{rows}{tail}")
        self.moordyn = moordyn
        self.system = moordyn.Create(str(path))
        assert self.system, "MoorDyn refuses the deck"
        moordyn.SetVerbosity(self.system, moordyn.LEVEL_NONE)
        self.time = 0.0

    def start(self, positions):
        """Equilibrium with the coupled points at `positions` [m], a row each; forces on them [N]."""
        self.positions = np.asarray(positions, float)
        still = np.zeros(self.positions.size)
        assert self.moordyn.NCoupledDOF(self.system) == still.size
        self.moordyn.Init(self.system, self.positions.ravel(), still)
        return self.step(self.positions, 1e-6)

    def step(self, positions, duration):
        """Forces [N] on the coupled points, a row each, after they have moved to `positions` [m] in `duration` [s]."""
        positions = np.asarray(positions, float)
        velocity = (positions - self.positions) / duration
        forces = self.moordyn.Step(self.system, self.positions.ravel(), velocity.ravel(), self.time, duration)
        self.positions, self.time = positions, self.time + duration
        return np.array(forces).reshape(-1, 3)

    def point_force(self, number):
        """Net force [N] on a point by its number in the deck."""
        return np.array(self.moordyn.GetPointForce(self.moordyn.GetPoint(self.system, number)))

    def point_position(self, number):
        """Position [m] of a point by its number in the deck."""
        return np.array(self.moordyn.GetPointPos(self.moordyn.GetPoint(self.system, number)))

    def close(self):
        self.moordyn.Close(self.system)
