"""Mooring systems as MoorDyn decks with published parameters, for the comparison with MoorDyn and the tests of decks.

OC3 Hywind as in Jonkman (2010), NREL/TP-500-47535; the OC4 semi-submersible as in Robertson et al. (2014), NREL/TP-5000-60601;
VolturnUS-S as in Allen et al. (2020), NREL/TP-5000-76773; their coefficients of drag and added mass as in the public decks of these systems.
The other three are nobody's: a taut rope, a line with a buoy, a line with a clump.
"""

import math

HEADER = """\
--------------------- MoorDyn Input File ------------------------------------
{title}
----------------------- LINE TYPES ------------------------------------------
TypeName   Diam    Mass/m     EA         BA/-zeta    EI         Cd     Ca     CdAx    CaAx
(name)     (m)     (kg/m)     (N)        (N-s/-)     (N-m^2)    (-)    (-)    (-)     (-)
"""
POINTS = """\
---------------------- POINTS ----------------------------------------------
ID    Type      X       Y       Z       Mass   Volume  CdA    Ca
(#)   (-)       (m)     (m)     (m)     (kg)   (m^3)   (m^2)  (-)
"""
LINES = """\
---------------------- LINES -----------------------------------------------
ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#)   (name)     (#)      (#)       (m)       (-)     (-)
"""
OPTIONS = """\
---------------------- OPTIONS ---------------------------------------------
{options}
---------------------- OUTPUTS ---------------------------------------------
FairTen1
AnchTen1
------------------------- need this line -----------------------------------
"""


def deck(title, types, points, lines, options):
    """A deck of rows of text; `options` is a dictionary by MoorDyn's names."""
    rows = "\n".join(f"{value}  {name}" for name, value in options.items())
    listed = lambda head, rows: head + "".join(f"{row}\n" for row in rows)
    return (listed(HEADER.format(title=title), types) + listed(POINTS, points) + listed(LINES, lines)
            + OPTIONS.format(options=rows))


def spread(title, chain, anchor, fairlead, length, segments, depth, headings):
    """Equal lines of one type between anchors and fairleads of a vessel; (radius [m], z [m]) of both, headings in degrees."""
    points, lines = [], []
    for number, heading in enumerate(map(math.radians, headings), start=1):
        for id, kind, (radius, z) in ((2 * number - 1, "Fixed", anchor), (2 * number, "Vessel", fairlead)):
            points.append(f"{id} {kind} {radius * math.cos(heading):.4f} {radius * math.sin(heading):.4f} {z} 0 0 0 0")
        lines.append(f"{number} chain {2 * number - 1} {2 * number} {length} {segments} -")
    return deck(title, [f"chain {chain}"], points, lines, {"WtrDpth": depth, "kBot": 3.0e6, "cBot": 3.0e5})


def oc3(segments=20):
    return spread("OC3 Hywind", "0.09 77.7066 384.243E6 -0.8 0 1.6 1.0 0.1 0.0", (853.87, -320.0), (5.2, -70.0), 902.2,
                  segments, 320.0, (0.0, 120.0, 240.0))


def oc4(segments=20):
    return spread("OC4 DeepCwind semi-submersible", "0.0766 113.35 7.536E8 -1.0 0 2.0 0.8 0.4 0.25", (837.6, -200.0),
                  (40.868, -14.0), 835.35, segments, 200.0, (60.0, 180.0, 300.0))


def volturnus(segments=25):
    return spread("VolturnUS-S", "0.333 685.0 3.27E9 -1.0 0 2.0 0.82 0.4 0.27", (837.6, -200.0), (58.0, -14.0), 850.0,
                  segments, 200.0, (60.0, 180.0, 300.0))


def taut(segments=20):
    """A taut polyester line, off the seabed."""
    return deck("a taut rope", ["rope 0.15 18.0 2.0E7 -0.5 0 1.2 1.0 0.05 0.0"],
                ["1 Fixed 700 0 -300 0 0 0 0", "2 Vessel 10 0 -10 0 0 0 0"], [f"1 rope 1 2 745 {segments} -"],
                {"WtrDpth": 300.0})


def buoyed(segments=16):
    """A chain up to a buoy, and a wire from there to the vessel."""
    return deck("a line with a buoy", ["chain 0.144 126 5.83E8 -0.8 0 1.6 1.0 0.05 0.0", "wire 0.08 30 3.0E8 -0.8 0 1.2 1.0 0.02 0.0"],
                ["1 Fixed -267 0 -70 0 0 0 0", "2 Free -40 0 -12 16755 33.51 12.566 1", "3 Vessel -3 0 -10 0 0 0 0"],
                [f"1 chain 1 2 240 {segments} -", f"2 wire 2 3 40 {segments // 3} -"], {"WtrDpth": 70.0})


def clump(segments=15):
    """A catenary with a clump weight between chain and wire."""
    return deck("a line with a clump", ["chain 0.1 85 4.0E8 -0.8 0 1.6 1.0 0.05 0.0", "wire 0.08 30 3.0E8 -0.8 0 1.2 1.0 0.02 0.0"],
                ["1 Fixed 420 0 -150 0 0 0 0", "2 Free 150 0 -120 6000 0.75 2.0 0.5", "3 Vessel 5 0 -10 0 0 0 0"],
                [f"1 chain 1 2 300 {segments} -", f"2 wire 2 3 150 {segments} -"], {"WtrDpth": 150.0})
