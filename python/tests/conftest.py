"""Scenes and fixtures of the tests, which run against the installed wheel."""

import pathlib
import subprocess
import sys

import pytest

import moorline

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
DECKS = ROOT / "decks" / "tests" / "decks"

CHAIN = """
title = "one chain on a seabed"

[water]
density = 1025.0

[seabed]
depth = 120.0

[line_types.chain]
mass = 126.0
diameter = 0.144
axial_stiffness = 5.5e8
drag_normal = 1.3
added_mass_normal = 1.0

[[points]]
name = "anchor"
position = [405.0, 0.0, -120.0]
kind = "fixed"

[[points]]
name = "fairlead"
position = [5.0, 0.0, -10.0]
kind = "coupled"

[[lines]]
name = "line1"
from = "anchor"
to = "fairlead"
sections = [{ type = "chain", length = 450.0, elements = 20 }]

[motion]
fairlead = { x = [[2.5, 12.0]], z = [[1.5, 9.0]], ramp = 5.0 }

[output]
duration = 10.0
interval = 0.05
"""

SEMI = """
title = "three chains on a vessel"

[water]
density = 1025.0

[seabed]
depth = 120.0

[line_types.chain]
mass = 126.0
diameter = 0.144
axial_stiffness = 5.5e8
drag_normal = 1.3
added_mass_normal = 1.0

[[vessels]]
name = "platform"
position = [0.0, 0.0, 2.0]

[output]
duration = 5.0
interval = 0.1

[motion]
platform = { x = [[2.0, 11.0]], pitch = [[0.05, 9.0]], ramp = 2.0 }
""" + "".join(f"""
[[points]]
name = "anchor{number}"
position = [{410.0 * cos:.6f}, {410.0 * sin:.6f}, -120.0]
kind = "fixed"

[[points]]
name = "fairlead{number}"
position = [{10.0 * cos:.6f}, {10.0 * sin:.6f}, -10.0]
kind = "coupled"
on = "platform"

[[lines]]
name = "line{number}"
from = "anchor{number}"
to = "fairlead{number}"
sections = [{{ type = "chain", length = 450.0, elements = 12 }}]
""" for number, cos, sin in ((1, 1.0, 0.0), (2, -0.5, 0.8660254), (3, -0.5, -0.8660254)))


@pytest.fixture
def chain():
    return moorline.Scene.from_toml(CHAIN)


@pytest.fixture
def semi():
    return moorline.Scene.from_toml(SEMI)


@pytest.fixture
def program(tmp_path):
    """Runs the command line of the wheel and returns the finished process."""

    def call(*arguments, **options):
        command = [sys.executable, "-m", "moorline", *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, **options)

    return call
