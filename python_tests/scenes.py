"""Scenes for the tests of the FMU: small, and each with something that another lacks."""


def table(name, *keys):
    """A table of TOML with its keys; a list of tables where the name is in brackets."""
    return "\n".join([f"[{name}]", *keys]) + "\n"


def point(name, position, kind, *keys):
    return table("[points]", f'name = "{name}"', f"position = {position}", f'kind = "{kind}"', *keys)


def line(name, ends, sections, *keys):
    """A line; its sections are (type, length) or (type, length, elements)."""
    words = ("type = \"{}\"", "length = {}", "elements = {}")
    listed = ", ".join("{ " + ", ".join(w.format(v) for w, v in zip(words, section)) + " }" for section in sections)
    return table("[lines]", f'name = "{name}"', f'from = "{ends[0]}"', f'to = "{ends[1]}"', f"sections = [{listed}]", *keys)


def scene(title, *tables):
    """A scene with a title, which further keys may follow."""
    return "\n".join([f"title = {title}\n", *tables])


SEA = table("water", "density = 1025.0")
OUTPUT = ("duration = 10.0", "interval = 0.05")

CHAIN = scene(
    '"one chain line on a seabed"', SEA, table("seabed", "depth = 200.0"),
    table("line_types.chain", "mass = 113.35", "diameter = 0.0766", "axial_stiffness = 753.6e6", "axial_damping = 2.0e6",
          "drag_normal = 2.0", "drag_tangential = 0.4", "added_mass_normal = 0.8", "added_mass_tangential = 0.25"),
    point("anchor", [837.6, 0.0, -200.0], "fixed"), point("fairlead", [40.868, 0.0, -14.0], "coupled"),
    line("line1", ("anchor", "fairlead"), [("chain", 835.35, 20)]), table("output", *OUTPUT))

CLUMPED = CHAIN.replace('kind = "coupled"', 'kind = "coupled"\nmass = 500.0\nvolume = 0.2')

# Given by its weight, at a fairlead with a mass of its own, with mass and impedance as outputs.
MATCHED = CLUMPED.replace("mass = 113.35", "weight = 975.0\nmass = 113.35").replace(
    "interval = 0.05", 'interval = 0.05\ninterface = "impedance"')

SHORT_PROFILE = CHAIN.replace("density = 1025.0",
                              "density = 1025.0\ncurrent = { profile = [[0.0, 0.5, 0.0], [-10.0, 0.2, 0.0]] }")

CHAIN_BALANCED = CHAIN.replace("interval = 0.05", "interval = 0.05\nenergy_balance = true")
CHAIN_PROFILE = CHAIN.replace("interval = 0.05", "interval = 0.05\nprofile = true")

CURRENT = CHAIN.replace("density = 1025.0", "density = 1025.0\ncurrent = { velocity = [1.0, 0.5, 0.0] }")

# Given by its weight and off the seabed: water acts by its flow alone.
CURRENT_ALONE = CURRENT.replace("mass = 113.35", "weight = 975.0").replace("[seabed]\ndepth = 200.0\n", "").replace(
    "length = 835.35", "length = 820.0")

# The host gives the flow of the water at the nodes, and an acceleration of added mass.
HOSTED = CHAIN.replace("density = 1025.0", 'density = 1025.0\nflow = "host"')

SWELL = table("water.waves", "regular = { height = 6.0, period = 10.0, direction = 0.3, phase = 0.7 }")
WAVES = CHAIN.replace("[seabed]", f"{SWELL}\n[seabed]")

TWO_ROPES = scene(
    '"two ropes in air, one of two sections, and a span between two driven points"\ngravity = 9.81',
    table("line_types.rope", "weight = 0.49", "axial_stiffness = 2505.0", "axial_damping = 5.0"),
    table("line_types.wire", "mass = 0.2", "axial_stiffness = 1.0e5", "damping_ratio = 0.05"),
    point("wall", [0.0, 0.0, 0.0], "fixed"), point("buoy1", [14.0, 1.0, 0.0], "coupled"),
    point("buoy2", [20.0, -8.0, 2.0], "coupled"),
    line("slack", ("wall", "buoy1"), [("rope", 10.0, 8), ("wire", 5.0, 4)]),
    line("span", ("buoy1", "buoy2"), [("wire", 12.0)]))

TWO_ROPES_ON_THREADS = TWO_ROPES + "\n[solver]\nthreads = 2\n"

ELASTIC = scene(
    '"two elements of a soft cord: cheap enough for many steps"',
    table("line_types.cord", "mass = 1.0", "axial_stiffness = 50.0", "axial_damping = 5.0"),
    point("wall", [0.0, 0.0, 0.0], "fixed"), point("hand", [10.0, 0.0, 0.0], "coupled"),
    line("cord", ("wall", "hand"), [("cord", 9.0, 2)]))

BARGE = scene(
    '"two opposite lines of a vessel"', SEA, table("seabed", "depth = 100.0"),
    table("line_types.chain", "mass = 113.35", "diameter = 0.0766", "axial_stiffness = 753.6e6", "damping_ratio = 0.2",
          "drag_normal = 2.0", "added_mass_normal = 0.8"),
    table("[vessels]", 'name = "barge"', "position = [10.0, -5.0, -3.0]"),
    point("anchor1", [340.0, -5.0, -100.0], "fixed"), point("anchor2", [-320.0, -5.0, -100.0], "fixed"),
    point("fairlead1", [20.0, 0.0, -7.0], "coupled", 'on = "barge"'),
    point("fairlead2", [-20.0, 0.0, -7.0], "coupled", 'on = "barge"'),
    line("line1", ("anchor1", "fairlead1"), [("chain", 340.0, 20)]),
    line("line2", ("anchor2", "fairlead2"), [("chain", 340.0, 20)]),
    table("motion", "barge = { x = [[2.0, 12.0]], y = [[1.0, 15.0]], roll = [[0.05, 8.0]], yaw = [[0.1, 20.0]], ramp = 10.0 }"),
    table("output", "duration = 20.0", "interval = 0.05"))

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

WINCH = scene(
    '"a chain on a winch above a seabed"', SEA, table("seabed", "depth = 60.0"),
    table("line_types.chain", "mass = 20.0", "diameter = 0.05", "axial_stiffness = 1.0e6", "drag_normal = 1.2"),
    point("anchor", [0.0, 0.0, -60.0], "fixed"), point("fairlead", [60.0, 0.0, -20.0], "coupled"),
    line("line1", ("anchor", "fairlead"), [("chain", 100.0, 25)], 'winch = { end = "b", length_max = 30.0 }'),
    table("output", *OUTPUT, "profile = true"))

ROPE = scene(
    '"a viscoelastic rope in air that the host can release"',
    table("line_types.rope", "mass = 20.0", "static_stiffness = 4.0e7", "dynamic_stiffness = 9.0e7",
          "static_damping = 2.0e8", "dynamic_damping = 2.0e6"),
    point("anchor", [0.0, 0.0, -100.0], "fixed"), point("fairlead", [202.0, 0.0, -90.0], "coupled"),
    line("line1", ("anchor", "fairlead"), [("rope", 200.0, 20)], 'release = "b"'), table("output", *OUTPUT, "energy_balance = true"))
