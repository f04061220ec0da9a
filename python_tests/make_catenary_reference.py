"""Makes tests/reference/catenary.csv: elastic catenaries of every class in 60-digit arithmetic.

    python python_tests/make_catenary_reference.py        (needs mpmath)

Each row is chosen by its forces: they give the positions of the ends, which are rounded to 12 digits; the forces that belong to
the rounded positions are then found by Newton's method from there. Nothing is shared with the Rust solver: the unknowns are the
forces at A (and what lies on the seabed), the formulas those of the textbook with asinh, and every row is checked by
Gauss-Legendre quadrature of dx/ds = H/T + H/EA, dz/ds = V/T + V/EA, dV/ds = w.

Frame: A at (0, 0), B at (XF, ZF), the seabed at z = seabed_height; sections from A to B: unstretched length L [m], weight w [N/m], EA [N]; CB is
Coulomb friction. V > 0: the tension vector points up going from A to B.
"""

import csv
import pathlib
import random

from mpmath import asinh, findroot, mp, mpf, nstr, quad, sqrt

mp.dps = 60
OUT = pathlib.Path(__file__).parents[1] / "tests" / "reference" / "catenary.csv"
COLUMNS = (
    "id cls XF ZF seabed seabed_height CB nseg L1 w1 EA1 L2 w2 EA2 L3 w3 EA3 "
    "H_fair V_fair T_fair H_anch V_anch T_anch laid_unstretched mid_x mid_z stretched_length"
).split()


def fly(section, length, h, v):
    """x, z, elongation and V at the end of a flight over `length` of a section that starts under (h, v)."""
    _, w, ea = section
    if w == 0:
        t = sqrt(h * h + v * v)
        return length * h * (1 / t + 1 / ea), length * v * (1 / t + 1 / ea), length * t / ea, v
    end = v + w * length
    ta, tb = sqrt(h * h + v * v), sqrt(h * h + end * end)
    spread = asinh(end / h) - asinh(v / h) if h else mpf(0)
    x = h / w * spread + h * length / ea
    z = (tb - ta) / w + length * (v + end) / (2 * ea)
    return x, z, (end * tb - v * ta + h * h * spread) / (2 * w * ea), end


def cut(sections, start, stop):
    """The parts of the sections between two arc lengths."""
    at = mpf(0)
    for length, w, ea in sections:
        lower, upper = max(start, at), min(stop, at + length)
        if upper > lower:
            yield upper - lower, (length, w, ea)
        at += length


def walk(sections, friction, h_a, v_a, lies=None, until=None):
    """End of the walk from A: x, z, H, V, elongation, lowest z. `lies`: arc lengths from, to of what is on the seabed."""
    total = sum(s[0] for s in sections)
    until = total if until is None else until
    a, b = lies or (total, total)
    x = z = stretch = mpf(0)
    h, v, lowest = h_a, v_a, mpf(0)
    for piece, (start, stop) in enumerate(((mpf(0), a), (a, b), (b, total))):
        if piece == 1 and lies:
            lowest, v = z, mpf(0)
        for length, section in cut(sections, start, min(stop, until)):
            if piece == 1:
                _, w, ea = section
                grown = h + friction * w * length
                dx, e, h = length + length * (h + grown) / 2 / ea, length * (h + grown) / 2 / ea, grown
                x, stretch = x + dx, stretch + e
            else:
                dx, dz, e, v = fly(section, length, h, v)
                x, z, stretch = x + dx, z + dz, stretch + e
    return x, z, h, v, stretch, lowest


def check(sections, friction, h_a, v_a, lies, end):
    """The walk's end by quadrature of the differential equations."""
    total = sum(s[0] for s in sections)
    a, b = lies or (total, total)
    x = z = mpf(0)
    h, v = h_a, v_a
    for piece, (start, stop) in enumerate(((mpf(0), a), (a, b), (b, total))):
        for length, (_, w, ea) in cut(sections, start, stop):
            if piece == 1:
                x += quad(lambda s: 1 + (h + friction * w * s) / ea, [0, length])
                h, v = h + friction * w * length, mpf(0)
                continue
            bend = -v / w if w else mpf(-1)
            # halved towards the bend, where V = 0 within a length H/w
            points = {mpf(0), length} | ({bend} if 0 < bend < length else set())
            if 0 <= bend <= length and h:
                points |= {p for k in range(60) for p in (bend - length / 2**k, bend + length / 2**k) if 0 < p < length}
            points = sorted(points)

            def rate(s, component):
                force = (h, v + w * s)
                return force[component] * (1 / sqrt(h * h + force[1] ** 2) + 1 / ea)

            x += quad(lambda s: rate(s, 0), points) if h else 0
            z += quad(lambda s: rate(s, 1), points)
            v += w * length
    scale = total
    assert abs(x - end[0]) < mpf(10) ** -25 * scale and abs(z - end[1]) < mpf(10) ** -25 * scale, (x - end[0], z - end[1])


def rounded(value):
    """A decimal that a double reproduces, as text."""
    return "0" if value == 0 else repr(float(nstr(value, 12)))


ROWS = []


def add(cls, sections, unknowns, forces, friction=0.0, seabed=None, positions=3):
    """Adds the row whose positions the starting `unknowns` give, rounded; `forces` maps unknowns to h_a, v_a, lies."""
    sections = [tuple(mpf(rounded(mpf(v))) for v in s) for s in sections]
    friction = mpf(rounded(mpf(friction)))
    total = sum(s[0] for s in sections)

    def place(*u):
        h_a, v_a, lies = forces(sections, friction, *u)
        x, z, _, _, _, lowest = walk(sections, friction, h_a, v_a, lies)
        return [x, z, lowest][:positions]

    start = [mpf(u) for u in unknowns]
    # decimals as text, and what a double makes of them: the row asks for exactly what the solver is given
    text = [rounded(p) for p in place(*start)]
    target = [mpf(float(t)) for t in text]
    sections = [tuple(mpf(float(v)) for v in s) for s in sections]
    friction = mpf(float(friction))
    total = sum(s[0] for s in sections)
    solution = start
    if start:
        scales = [u or mpf(1) for u in start]
        root = findroot(
            lambda *u: [p - t for p, t in zip(place(*[k * c for k, c in zip(u, scales)]), target)],
            [mpf(1)] * len(start),
            tol=mpf(10) ** -90,
            maxsteps=60,
        )
        solution = [k * c for k, c in zip(root if len(start) > 1 else [root], scales)]
    h_a, v_a, lies = forces(sections, friction, *solution)
    end = walk(sections, friction, h_a, v_a, lies)
    assert all(abs(p - t) < mpf(10) ** -45 * total for p, t in zip([end[0], end[1], end[5]][:positions], target))
    check(sections, friction, h_a, v_a, lies, end)
    middle = walk(sections, friction, h_a, v_a, lies, until=total / 2)
    row = {"id": len(ROWS) + 1, "cls": cls, "XF": text[0], "ZF": text[1], "seabed": int(seabed is not None), "CB": rounded(friction)}
    row["seabed_height"] = text[2] if positions == 3 else rounded(mpf(seabed or 0))
    row["nseg"] = len(sections)
    for i, s in enumerate(sections, 1):
        row |= {f"L{i}": rounded(s[0]), f"w{i}": rounded(s[1]), f"EA{i}": rounded(s[2])}
    values = {
        "H_fair": end[2], "V_fair": end[3], "T_fair": sqrt(end[2] ** 2 + end[3] ** 2),
        "H_anch": h_a, "V_anch": v_a, "T_anch": sqrt(h_a**2 + v_a**2),
        "laid_unstretched": lies[1] - lies[0] if lies else mpf(0),
        "mid_x": middle[0], "mid_z": middle[1], "stretched_length": total + end[4],
    }  # fmt: skip
    ROWS.append(row | {k: nstr(v, 22) for k, v in values.items()})


def suspended(sections, friction, h, v):
    return h, v, None


def weight_at(sections, s):
    return sum(length * w for length, (_, w, _) in cut(sections, mpf(0), s))


def from_anchor(sections, friction, h_b, lift):
    """A on the seabed: H at B and the arc length where the line lifts off."""
    on_seabed = weight_at(sections, lift) * friction
    assert on_seabed < h_b, "friction would hold all tension before A: choose more"
    return h_b - on_seabed, mpf(0), (mpf(0), lift)


def over_seabed(sections, friction, h_a, drop, lift):
    """A above the seabed: H at A, the arc lengths of touchdown and of lift-off."""
    return h_a, -weight_at(sections, drop), (drop, lift)


def make():
    pick = random.Random(20240607)

    def spread(lower, upper):
        return 10 ** pick.uniform(lower, upper)

    for _ in range(8):
        length, w = spread(0.5, 3.2), spread(0, 3.5)
        share = pick.uniform(-0.9, -0.1)
        section = (length, w, w * length * spread(2, 6))
        add("suspended", [section], [w * length * spread(-1.5, 0.7), w * length * share], suspended, positions=2)
    for share, strain in ((0.3, 0.02), (-0.4, 0.2), (-0.5, 1e-4), (2.0, 0.05)):
        section = (120.0, 40.0, 4800.0 * 50 / strain)
        add("over-stretched", [section], [4800.0 * 50, 4800.0 * share], suspended, positions=2)
    for ea, force in ((1e13, 3e5), (1e13, 4e7), (3e12, 2e4), (1e11, 7e5)):
        add("stiff", [(700.0, 90.0, ea)], [force, -0.3 * 63000], suspended, positions=2)
    for w, force, share in ((1e-11, 2e-9, -0.5), (1e-8, 3e-5, -0.2), (1e-5, 7.0, -0.5), (1e-11, 3e-9, -0.9)):
        add("light", [(300.0, w, 5e6)], [force, 300 * w * share], suspended, positions=2)
    for ea, force in ((20.0, 15.0), (300.0, 30.0), (4000.0, 2.0)):
        add("soft", [(25.0, 8.0, ea)], [force, -70.0], suspended, positions=2)
    for h, v in ((30.0, 400.0), (900.0, 120.0), (2.0, 520.0), (5000.0, -300.0)):
        add("buoyant", [(80.0, -7.0, 2e6)], [h, v], suspended, positions=2)
    for h, v in ((900.0, 350.0), (12.0, -80.0)):
        add("weightless", [(55.0, 0.0, 4e5)], [h, v], suspended, positions=2)
    add("weightless in the middle", [(30.0, 50.0, 1e7), (40.0, 0.0, 2e6), (35.0, 20.0, 1e7)], [60.0, -1499.0], suspended, positions=2)
    for h, v in ((1e-9, -300.0), (1e-6, 2.0), (1e-12, 900.0)):
        add("nearly vertical", [(60.0, 20.0, 3e5)], [h, v], suspended, positions=2)
    add("fairlead below", [(60.0, 20.0, 3e5)], [250.0, -1500.0], suspended, positions=2)

    for h, share in ((4.0, 0.4), (0.3, 0.7), (30.0, 0.05), (0.01, 0.5), (200.0, 0.9)):
        length, w = spread(1, 3), spread(0, 3)
        section = (length, w, w * length * spread(2.3, 5))
        add("touching down", [section], [h * w * length, share * length], from_anchor, seabed=0, positions=2)
    for h, share, mu in ((4.0, 0.4, 0.8), (0.6, 0.5, 1.0), (30.0, 0.05, 0.3), (0.2, 0.55, 0.3), (90.0, 0.7, 1.4)):
        length, w = spread(1, 3), spread(0, 3)
        section = (length, w, w * length * spread(2.3, 5))
        add("touching down with friction", [section], [h * w * length, share * length], from_anchor, mu, seabed=0, positions=2)
    for drop, lift, h, mu in ((0.2, 0.5, 0.4, 0.0), (0.35, 0.4, 3.0, 0.0), (0.1, 0.9, 0.02, 0.0), (0.2, 0.5, 0.4, 0.7), (0.05, 0.6, 2.0, 0.2)):
        add("touching down between raised ends", [(400.0, 150.0, 8e7)], [h * 6e4, 400 * drop, 400 * lift], over_seabed, mu, seabed=1)

    chain = [(300.0, 1200.0, 6e8), (450.0, 120.0, 6e7), (90.0, 1500.0, 6e8)]
    for h, v in ((1.5e5, -2e5), (9e5, 1e5), (3e4, -3.9e5)):
        add("three sections, suspended", chain, [h, v], suspended, positions=2)
    for h, lift, mu in ((6e5, 180.0, 0.0), (2e5, 420.0, 0.0), (7e5, 150.0, 0.6), (5e5, 390.0, 0.9)):
        add("three sections, touching down", chain, [h, lift], from_anchor, mu, seabed=0, positions=2)
    for h, drop, lift, mu in ((2e5, 60.0, 200.0, 0.0), (2e5, 60.0, 330.0, 0.5)):
        add("three sections between raised ends", chain, [h, drop, lift], over_seabed, mu, seabed=1)
    wave = [(300.0, 300.0, 5e8), (120.0, -420.0, 5e8), (260.0, 300.0, 5e8)]
    for h, lift in ((3e4, 190.0), (1e4, 210.0)):
        add("lazy wave", wave, [h, lift], from_anchor, 0.2 if h > 2e4 else 0.0, seabed=0, positions=2)
    # H = 0: what hangs is as long as its weight stretches it to, the rest of the line lies in any shape
    for length, w, ea, rise, span in ((90.0, 40.0, 3e5, 30.0, 20.0), (700.0, 900.0, 1e9, 320.0, 100.0)):
        slack(length, w, ea, rise, span)

    with OUT.open("w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, restval="", lineterminator="\n")
        table.writeheader()
        table.writerows(ROWS)
    print(f"{len(ROWS)} rows in {OUT.name}")


def slack(length, w, ea, rise, span):
    """A row whose line hangs vertically from B and has length to spare on the seabed; only the forces are its own."""
    length, w, ea, rise = (mpf(v) for v in (length, w, ea, rise))
    # hung + w hung²/2EA = rise
    hung = 2 * rise / (1 + sqrt(1 + 2 * w * rise / ea))
    row = {"id": len(ROWS) + 1, "cls": "degenerate slack", "XF": span, "ZF": rounded(rise), "seabed": 1, "seabed_height": 0}
    row |= {"CB": 0, "nseg": 1, "L1": rounded(length), "w1": rounded(w), "EA1": rounded(ea)}
    force = nstr(w * hung, 22)
    row |= {"H_fair": 0, "V_fair": force, "T_fair": force, "H_anch": 0, "V_anch": 0, "T_anch": 0}
    ROWS.append(row | {"laid_unstretched": nstr(length - hung, 22), "stretched_length": nstr(length + w * hung**2 / 2 / ea, 22)})


if __name__ == "__main__":
    make()
