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

CLUMPED = CHAIN.replace('kind = "coupled"', 'kind = "coupled"\nmass = 500.0\nvolume = 0.2')

SHORT_PROFILE = CHAIN.replace("density = 1025.0",
                              "density = 1025.0\ncurrent = { profile = [[0.0, 0.5, 0.0], [-10.0, 0.2, 0.0]] }")

CHAIN_PROFILE = CHAIN.replace("interval = 0.05", "interval = 0.05\nprofile = true")

CURRENT = CHAIN.replace("density = 1025.0", "density = 1025.0\ncurrent = { velocity = [1.0, 0.5, 0.0] }")

# Given by its weight and off the bed: water acts by its flow alone.
CURRENT_ALONE = CURRENT.replace("mass = 113.35", "weight = 975.0").replace("[seabed]\ndepth = 200.0\n", "").replace(
    "length = 835.35", "length = 820.0")

WAVES = CHAIN.replace("[seabed]", """\
[water.waves]
regular = { height = 6.0, period = 10.0, direction = 0.3, phase = 0.7 }

[seabed]""")

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

TWO_ROPES_ON_THREADS = TWO_ROPES + "\n[solver]\nthreads = 2\n"

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

BARGE = """\
title = "two opposite lines of a vessel"

[water]
density = 1025.0

[seabed]
depth = 100.0

[line_types.chain]
mass = 113.35
diameter = 0.0766
axial_stiffness = 753.6e6
damping_ratio = 0.2
drag_normal = 2.0
added_mass_normal = 0.8

[[vessels]]
name = "barge"
position = [10.0, -5.0, -3.0]

[[points]]
name = "anchor1"
position = [340.0, -5.0, -100.0]
kind = "fixed"

[[points]]
name = "anchor2"
position = [-320.0, -5.0, -100.0]
kind = "fixed"

[[points]]
name = "fairlead1"
position = [20.0, 0.0, -7.0]
kind = "coupled"
on = "barge"

[[points]]
name = "fairlead2"
position = [-20.0, 0.0, -7.0]
kind = "coupled"
on = "barge"

[[lines]]
name = "line1"
from = "anchor1"
to = "fairlead1"
sections = [{ type = "chain", length = 340.0, elements = 20 }]

[[lines]]
name = "line2"
from = "anchor2"
to = "fairlead2"
sections = [{ type = "chain", length = 340.0, elements = 20 }]

[motion]
barge = { x = [[2.0, 12.0]], y = [[1.0, 15.0]], roll = [[0.05, 8.0]], yaw = [[0.1, 20.0]], ramp = 10.0 }

[output]
duration = 20.0
interval = 0.05
"""

# The same lines, but the host moves the two fairleads by themselves.
FAIRLEADS = (
    BARGE[:BARGE.index("[motion]")]
    .replace('[[vessels]]\nname = "barge"\nposition = [10.0, -5.0, -3.0]\n\n', "")
    .replace("position = [20.0, 0.0, -7.0]", "position = [30.0, -5.0, -10.0]")
    .replace("position = [-20.0, 0.0, -7.0]", "position = [-10.0, -5.0, -10.0]")
    .replace('on = "barge"\n', "")
)

# Both lines end on the axis about which the vessel yaws.
SPINDLE = BARGE.replace("position = [20.0, 0.0, -7.0]", "position = [0.0, 0.0, -7.0]").replace(
    "position = [-20.0, 0.0, -7.0]", "position = [0.0, 0.0, -7.0]")

DECK = """\
--------------------- MoorDyn Input File ------------------------------------
Two lines of a vessel, one of them with a buoy between its chain and its wire
----------------------- LINE TYPES ------------------------------------------
Name     Diam    MassDen      EA         BA/-zeta    EI    Cd     Ca    CdAx   CaAx
(-)      (m)     (kg/m)       (N)        (N-s/-)     (-)   (-)    (-)   (-)    (-)
chain    0.138   113.35     7.536E8     -0.8       0.0   1.4    1.0   0.4    0.25
wire     0.09    40.0       3.0E8       -0.5       0.0   1.2    1.0   0.02   0.0
---------------------- POINTS -----------------------------------------------
ID   Attachment    X        Y         Z      M     V     CdA   CA
(-)   (-)         (m)      (m)       (m)    (kg)  (m^3)  (m^2) (-)
1    Fixed       330.0      0.0    -100.0    0     0      0     0
2    Fixed      -330.0      0.0    -100.0    0     0      0     0
3    Vessel       20.0      0.0     -10.0    0     0      0     0
4    Vessel      -20.0      0.0     -10.0    0     0      0     0
5    Free       -130.0      0.0     -60.0  500.0   2.0    2.0   0.5
---------------------- LINES ------------------------------------------------
ID      LineType   AttachA   AttachB   UnstrLen  NumSegs   LineOutputs
(-)       (-)        (-)       (-)       (m)       (-)       (-)
1        chain        1         3       340.0      20         -
2        chain        2         5       215.0      20         -
3        wire         5         4       122.0      12         -
---------------------- OPTIONS ----------------------------------------------
0.001    dtM       - time step (s)
3.0e6    kbot      - bottom stiffness (Pa/m)
3.0e5    cbot      - bottom damping (Pa-s/m)
100.0    WtrDpth   - water depth (m)
------------------------ OUTPUTS --------------------------------------------
FairTen1 FairTen3 AnchTen2 Point5Pz
END
------------------------- need this line ------------------------------------
"""

WINCH = """\
title = "a chain on a winch above a bed"

[water]
density = 1025.0

[seabed]
depth = 60.0

[line_types.chain]
mass = 20.0
diameter = 0.05
axial_stiffness = 1.0e6
drag_normal = 1.2

[[points]]
name = "anchor"
position = [0.0, 0.0, -60.0]
kind = "fixed"

[[points]]
name = "fairlead"
position = [60.0, 0.0, -20.0]
kind = "coupled"

[[lines]]
name = "line1"
from = "anchor"
to = "fairlead"
sections = [{ type = "chain", length = 100.0, elements = 25 }]
winch = { end = "b", length_max = 30.0 }

[output]
duration = 10.0
interval = 0.05
profile = true
"""

ROPE = """\
title = "a viscoelastic rope in air that the host can let go"

[line_types.rope]
mass = 20.0
static_stiffness = 4.0e7
dynamic_stiffness = 9.0e7
static_damping = 2.0e8
dynamic_damping = 2.0e6

[[points]]
name = "anchor"
position = [0.0, 0.0, -100.0]
kind = "fixed"

[[points]]
name = "fairlead"
position = [202.0, 0.0, -90.0]
kind = "coupled"

[[lines]]
name = "line1"
from = "anchor"
to = "fairlead"
release = "b"
sections = [{ type = "rope", length = 200.0, elements = 20 }]

[output]
duration = 10.0
interval = 0.05
"""
