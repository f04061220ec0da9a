"""Scenes for the tests of the FMU: small, and each with something that another lacks."""

CHAIN = """\
title = "one chain line on a seabed"

[water]
density = 1025.0

[seabed]
depth = 200.0

[line_types.chain]
mass = 113.35
diameter = 0.0766
axial_stiffness = 753.6e6
axial_damping = 2.0e6
drag_normal = 2.0
drag_tangential = 0.4
added_mass_normal = 0.8
added_mass_tangential = 0.25

[[points]]
name = "anchor"
position = [837.6, 0.0, -200.0]
kind = "fixed"

[[points]]
name = "fairlead"
position = [40.868, 0.0, -14.0]
kind = "coupled"

[[lines]]
name = "line1"
from = "anchor"
to = "fairlead"
sections = [{ type = "chain", length = 835.35, elements = 20 }]

[output]
duration = 10.0
interval = 0.05
"""

CHAIN_PROFILE = CHAIN.replace("interval = 0.05", "interval = 0.05\nprofile = true")

TWO_ROPES = """\
title = "two ropes in air, one of two sections, and a span between two driven points"
gravity = 9.81

[line_types.rope]
weight = 0.49
axial_stiffness = 2505.0
axial_damping = 5.0

[line_types.wire]
mass = 0.2
axial_stiffness = 1.0e5
damping_ratio = 0.05

[[points]]
name = "wall"
position = [0.0, 0.0, 0.0]
kind = "fixed"

[[points]]
name = "buoy1"
position = [14.0, 1.0, 0.0]
kind = "coupled"

[[points]]
name = "buoy2"
position = [20.0, -8.0, 2.0]
kind = "coupled"

[[lines]]
name = "slack"
from = "wall"
to = "buoy1"
sections = [{ type = "rope", length = 10.0, elements = 8 }, { type = "wire", length = 5.0, elements = 4 }]

[[lines]]
name = "span"
from = "buoy1"
to = "buoy2"
sections = [{ type = "wire", length = 12.0 }]
"""

ELASTIC = """\
title = "two elements of a soft cord: cheap enough for many steps"

[line_types.cord]
mass = 1.0
axial_stiffness = 50.0
axial_damping = 5.0

[[points]]
name = "wall"
position = [0.0, 0.0, 0.0]
kind = "fixed"

[[points]]
name = "hand"
position = [10.0, 0.0, 0.0]
kind = "coupled"

[[lines]]
name = "cord"
from = "wall"
to = "hand"
sections = [{ type = "cord", length = 9.0, elements = 2 }]
"""
