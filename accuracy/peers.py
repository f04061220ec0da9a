#!/usr/bin/env python3
"""Run MoorDyn and CableDyn over one scene at their own best settings, for `moorline accuracy --peers`.

The conversation is in lines of JSON. The first line on standard input describes a scene of lines, some of whose ends are
driven; the first answer lists the runs of the ladder. Every further line asks for one of them and gets its results.
Everything else goes to standard error.

Input (SI units)
    name, gravity [m/s²], density [kg/m³], null in air, seabed {depth [m], stiffness [Pa/m], damping [Pa·s/m]} or null,
    lies_on_seabed, whether a line lies on it at rest, points, lines, duration [s], interval [s], elements [-] of the
    longest line, hosts, the communication steps [s] of hosts (none if absent), and time_limit_seconds [s], the CPU time
    that all passes of a run may take.
    A point has kind (fixed, coupled, that is driven, or free), position at rest [m], mass [kg], volume [m³], drag_area
    [m²], added_mass [-] and, if it is driven, motion: position [m] and attitude [rad] of a body at rest, the place of
    the point on it, arm [m], sines of x, y, z, roll, pitch, yaw, each a list of [amplitude [m, rad], period [s], phase
    [rad]], and ramp [s]. A driven point has one line and no mass.
    A line has from and to, numbers of points, driven, its driven end, a, b or null, has_surface, whether it loses the
    water above z = 0, clamped, the directions [-] of clamped ends or nulls, and sections, each with start, the place of
    its first node at rest [m], length [m], mass [kg/m], diameter [m], axial_stiffness [N], axial_damping [N·s],
    bending_stiffness [N·m²], drag_normal, drag_tangential, added_mass_normal and added_mass_tangential [-].
First answer
    runs, each with peer, label, host, deck, and family, a name that runs share which differ in their mesh alone, from
    coarse to fine. host is null for a run of the offline ladder, or the one of hosts that the run is in. deck is the
    number of elements where the settings are those of a deck, else null. left_out: peers that cannot run the scene,
    with the reason.
Question
    run, its number from 0, and read, whether its results are wanted beside its cost.
Answer
    Either cpu_seconds [s] and, where wanted, tension [N] at the driven end of every line that has one, and mid [m], the
    position at s = L/2 of every line, both at interval, 2·interval, ...; or failed, the reason.

Offline and in a host
    Offline, the peer chooses its communication step: that of its path and of its forces. In a host, the communication
    step is the host's, H. The host gives the fairlead's motion up to the next communication point, calls the peer until
    it is there, and reads the force on the fairlead once. The internal step divides H and is at most H. Results between
    communication points are interpolated by cubics. The peers may know the path within H.

Cost of a run
    CPU time of the time loop, with the force on the fairlead read at every communication point. The deck, the initial
    equilibrium and the results of this module are not charged: a first pass reads them and is not timed. Further passes
    repeat the same steps and are timed, and their median counts. The cost of calls from Python, measured on calls that
    do no work, is subtracted. Each run has its own process, on the core that the parent is bound to.

MoorDyn's settings
    Schemes: RK2, RK4 and Midpoint2 (one fixed-point correction), the one that costs least per second at its stability
    limit, at 1.1, 0.9 and 0.6 of that limit. The limit comes from the scheme's amplification factor on the axial waves
    of the mesh, on slack segments and on the seabed's spring and damper; MoorDyn's own CFL option knows the undamped
    axial wave only. The prediction is on the safe side for some lines; on the others the runs at 1.1 fail. The rest did
    not pay: Euler and Heun (one evaluation) need steps 3 to 10 times smaller for the same error, AB2 to AB4 do not
    converge, Midpoint and backward Euler with more iterations, Wilson and ACA cost more for the same answer.
    Communication step: the path goes in as straight pieces with the secant velocity, so that it has no jumps in
    position (given the velocity at the start of the step the fairlead jumps by ah²/2). Offline it is one or two
    internal steps, up to eight where it divides the output interval, and at most 1/200 of the motion's period, or one
    internal step where that is longer; a communication step costs 0.4 µs more than its internal ones. In a host, the
    scheme is the one that costs least at the internal step that divides H, and the path has one piece in H or one for
    every internal step: with one, the jumps of the velocity send axial waves through a chain in a storm that are 40 % of
    the tension's deviation.
    Tension: the force at the fairlead's node (last segment, drag and weight of its half) less the node's mass times
    its known acceleration. MoorDyn returns the force without the inertia, which is some 1 % of the tension's deviation
    on a coarse taut line. RK2 and Midpoint leave that force at the middle of the last internal step; it is given the
    time it belongs to.

CableDyn's settings
    Two-node elements, generalised-α in process. A relative tolerance of 1e-2 or 1e-1 in Newton's iteration is enough
    (the default 1e-8 costs up to twice as much for the same errors; on oc3_catenary 1e-1 costs 13 to 25 % less than
    1e-2). Where the line meets the seabed: ρ∞ = 0.4 with 1/360 and 1/180 of the motion's period, best for tension, and
    ρ∞ = 0 with 1/180 and 1/90, best for position. Where it does not: ρ∞ = 0.9 and reused tangents with 1/30 and 1/20 of
    the period. A tolerance of 1 costs 1 to 2 % less than 1e-1 on taut_polyester, with the same errors as long as it
    converges; on oc4_chain it changes the tension by 13 to 80 % of its deviation. ρ∞ = 1 costs as much as 0.9, and
    diverges earlier. The cubic element with a token bending stiffness reaches the position error of 28 two-node
    elements with 8, at the same cost, and diverges with 6; where the line meets the seabed it costs several times more. It
    is left out.
    The path is exact in position, velocity and acceleration at every step, also between communication points.
    Offline, a communication point is a multiple of the output interval, or every step where the step is longer.
    Tension: CalcOutput, which has the end's inertia in it (FairTen has not).

Decks as they come
    In a host, each peer has two more runs with settings that a user may take without a study, with 20 and 40 elements:
    MoorDyn's RK2 with an internal step of 1 ms, and CableDyn without options of its solver (a tolerance of 1e-8,
    ρ∞ = 0.4, new tangents in every iteration) with 1/180 of the motion's period, as it has no default step.

Systems
    A point that rides on a vessel is a driven point with the path of the rigid body. MoorDyn has a line for every
    section, joined by free points without mass. The peers that cannot compute a scene are left out, see beyond().

Both get a water depth (CableDyn drops drag and added mass without one) that a scene without a seabed never reaches,
and where the motion reaches z = 0 the whole scene is lowered by 10 m (MoorDyn drops the water above), which changes
nothing in still water.
"""

import cmath
import ctypes
import json
import math
import os
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np

try:
    import resource
except ImportError:  # Windows has no such limits; there the clock on the wall ends a run
    resource = None

# Time of the clock on the wall over CPU time that a run may take [-].
WALL = 20.0
# Depth by which a scene is lowered where its motion reaches the surface [m].
LOWERED = 10.0
# What stands for air's density where CableDyn wants a positive one [kg/m³].
AIR = 1e-6
# Timed passes of a run: at most this many, until they add up to this much CPU time [s].
PASSES, PASSES_CPU = 9, 0.4

# MoorDyn's schemes, and the evaluations of the forces in a step of each.
EVALUATIONS = {"RK2": 2, "RK4": 4, "Midpoint2": 2}
# Internal steps of MoorDyn as parts of the scheme's predicted stability limit [-].
PARTS = (1.1, 0.9, 0.6)
# An aligned internal step that differs from another one of its mesh by at most this part [-] is left out.
NEAR = 0.1
# CableDyn's settings: steps to the motion's period [-], ρ∞ [-], reused tangents, Newton's relative tolerance [-], for a
# line that meets the seabed and for a free one.
LANDING = (
    (360.0, 0.4, False, 1e-2),
    (360.0, 0.4, False, 1e-1),
    (180.0, 0.4, False, 1e-1),
    (180.0, 0.4, False, 1.0),
    (180.0, 0.0, False, 1e-1),
    (90.0, 0.0, False, 1e-1),
    (90.0, 0.0, False, 1.0),
    (60.0, 0.0, False, 1e-1),
    (40.0, 0.0, False, 1e-1),
)
RATES = (30.0, 20.0, 16.0, 12.0, 10.0, 9.0, 8.0)
FREE = tuple((parts, 0.9, True, tolerance) for tolerance in (1e-2, 1e-1, 1.0) for parts in RATES)
FREE += tuple((parts, 1.0, True, 1e-1) for parts in (20.0, 12.0, 9.0))
# Decks as they come: elements [-], MoorDyn's internal step [s], CableDyn's steps to the motion's period [-].
DECK_ELEMENTS, DECK_STEP, DECK_PARTS = (20, 40), 0.001, 180.0


class Motion:
    """The motion of the driven points: position [m], velocity [m/s] and acceleration [m/s²] at any time."""

    def __init__(self, scene):
        """Take the motions of the points in their order."""
        self.motions = [point["motion"] for point in scene["points"] if point["kind"] == "coupled"]

    def period(self, duration):
        """Return the shortest of the points' periods [s].

        A point's is that of the harmonic motion with the same mean squares of velocity and acceleration.
        """
        _, velocity, acceleration = self.at(np.linspace(0.0, duration, 4001))
        squares = [(of_time.reshape(len(of_time), -1, 3) ** 2).sum(2).mean(0) for of_time in (velocity, acceleration)]
        moves = squares[1] > 0.0
        return 2.0 * math.pi * math.sqrt((squares[0][moves] / squares[1][moves]).min()) if moves.any() else duration

    def at(self, times):
        """Return position [m], velocity [m/s] and acceleration [m/s²] of all points at `times` [s], one row each."""
        times = np.asarray(times, float)
        return np.concatenate([placed(motion, times) for motion in self.motions], axis=2)


def placed(motion, times):
    """Return position and two derivatives of a point of a body at `times` [s], shape (3, times, 3)."""
    waves = np.zeros((3, len(times), 6))
    for axis, sines in enumerate(motion["sines"]):
        for amplitude, period, *phase in sines:
            omega = 2.0 * math.pi / period
            angle = omega * times + (phase[0] if phase else 0.0)
            waves[0, :, axis] += amplitude * np.sin(angle)
            waves[1, :, axis] += amplitude * omega * np.cos(angle)
            waves[2, :, axis] -= amplitude * omega**2 * np.sin(angle)
    rise = motion["ramp"]
    ramp = np.stack([np.ones_like(times), np.zeros_like(times), np.zeros_like(times)])
    if rise > 0.0:
        early, rate = times < rise, math.pi / rise
        ramp[0, early] = 0.5 * (1.0 - np.cos(rate * times[early]))
        ramp[1, early] = 0.5 * rate * np.sin(rate * times[early])
        ramp[2, early] = 0.5 * rate**2 * np.cos(rate * times[early])
    value, slope, bend = ramp[:, :, None]
    pose = np.stack(
        [
            value * waves[0],
            slope * waves[0] + value * waves[1],
            bend * waves[0] + 2.0 * slope * waves[1] + value * waves[2],
        ]
    )
    pose[0] += motion["position"] + motion["attitude"]
    arm = np.zeros((3, len(times), 3))
    arm[0] = motion["arm"]
    for axis in range(3):  # roll, then pitch, then yaw
        arm = turned(arm, axis, pose[:, :, 3 + axis])
    return pose[:, :, :3] + arm


def turned(vector, axis, angle):
    """Return `vector` turned about a global axis by `angle` [rad], both with their first two derivatives in time."""
    unit = np.eye(3)[axis]
    cos, sin = np.cos(angle[0])[:, None], np.sin(angle[0])[:, None]
    value, slope, bend = (
        cos * part + (1.0 - cos) * part[:, axis : axis + 1] * unit + sin * np.cross(unit, part) for part in vector
    )
    rate, change = angle[1:, :, None]
    across = np.cross(unit, value)
    return np.stack(
        [
            value,
            slope + rate * across,
            bend + 2.0 * rate * np.cross(unit, slope) + change * across + rate**2 * np.cross(unit, across),
        ]
    )


class Site:
    """A scene as both peers need it: everything below z = 0, and a depth [m] in any case."""

    def __init__(self, scene):
        """Lower the scene where its motion reaches the surface, and give deep water where it has no seabed."""
        self.motion = Motion(scene)
        driven = self.motion.at(np.linspace(0.0, scene["duration"], 4001))[0]
        heights = np.concatenate([driven[:, 2::3].ravel(), [point["position"][2] for point in scene["points"]]])
        self.lowered = LOWERED if heights.max() >= 0.0 else 0.0
        seabed = scene["seabed"]
        if seabed:
            self.depth = seabed["depth"] + self.lowered
            self.stiffness, self.damping = seabed["stiffness"], seabed["damping"]
        else:
            self.depth = max(map(length, scene["lines"])) - heights.min() + self.lowered
            self.stiffness, self.damping = 1.0e3, 0.0

    def below(self, place):
        """Return a place [m] of the scene, lowered."""
        return [place[0], place[1], place[2] - self.lowered]

    def path(self, step, every, duration):
        """Return times [s] at intervals of `step` [s], and the lowered paths of the driven points at these times.

        The last time is the first multiple of `every` steps that is not before `duration` [s].
        """
        times = step * np.arange(every * math.ceil(duration / (every * step) - 1e-9) + 1)
        position, velocity, acceleration = self.motion.at(times)
        position[:, 2::3] -= self.lowered
        return times, position, velocity, acceleration


def length(line):
    """Return the unstretched length [m] of a line."""
    return sum(section["length"] for section in line["sections"])


def bends(line):
    """Return whether a line has bending stiffness."""
    return any(section["bending_stiffness"] > 0.0 for section in line["sections"])


def driven_lines(scene, *values):
    """Return the lines with a driven end, each after the place of its point among the driven ones, and their `values`."""
    coupled = [index for index, point in enumerate(scene["points"]) if point["kind"] == "coupled"]
    end = {"a": "from", "b": "to"}
    lines = zip(scene["lines"], *values)
    return [(coupled.index(row[0][end[row[0]["driven"]]]), *row) for row in lines if row[0]["driven"]]


def meshed(scene, elements):
    """Return the number of elements of every section of every line, with `elements` on the longest line."""
    longest = max(map(length, scene["lines"]))
    counts = [[elements * section["length"] / longest for section in line["sections"]] for line in scene["lines"]]
    return [[max(1, math.floor(count + 0.5)) for count in line] for line in counts]


def resampled(times, values, wanted):
    """Return `values` given at evenly spaced `times` [s] at the times `wanted` [s], by cubics through four points."""
    step = times[1] - times[0]
    at = np.clip(np.floor((wanted - times[0]) / step).astype(int) - 1, 0, len(times) - 4)
    u = ((wanted - times[at]) / step).reshape((-1,) + (1,) * (values.ndim - 1))
    weights = (
        -(u - 1.0) * (u - 2.0) * (u - 3.0) / 6.0,
        u * (u - 2.0) * (u - 3.0) / 2.0,
        -u * (u - 1.0) * (u - 3.0) / 2.0,
        u * (u - 1.0) * (u - 2.0) / 6.0,
    )
    return sum(weight * values[at + point] for point, weight in enumerate(weights))


def arcs(line, counts):
    """Return the unstretched arc length [m] of every node of a line with `counts` elements in its sections."""
    lengths = [np.full(count, section["length"] / count) for section, count in zip(line["sections"], counts)]
    return np.concatenate([[0.0], np.cumsum(np.concatenate(lengths))])


def half_way(arc, nodes):
    """Return the position [m] half-way along a line: by a cubic through four nodes, on a chord where there are fewer."""
    nodes, last, half = np.asarray(nodes), len(arc) - 1, 0.5 * arc[-1]
    after = min(max(int(np.searchsorted(arc, half)), 1), last)
    first, count = (min(max(after - 2, 0), last - 3), 4) if last >= 3 else (after - 1, 2)
    places = arc[first : first + count]
    weights = [
        np.prod([(half - other) / (own - other) for k, other in enumerate(places) if k != index])
        for index, own in enumerate(places)
    ]
    return np.array(weights) @ nodes[first : first + count]


def median_cpu(timed_pass):
    """Return the median CPU time [s] of a few passes; `timed_pass` returns one pass's.

    Not the least: on a shared virtual machine the CPU clock now and then jumps by a tick of 4 ms either way, which is
    more than a cheap pass takes. The thread's clock, because the process's counts in such ticks under a CPU limit.
    """
    costs = [timed_pass()]
    while sum(costs) < PASSES_CPU and len(costs) < PASSES:
        costs.append(timed_pass())
    return max(float(np.median(costs)), 0.0)


def numbers(values):
    """Return values as words that read back to the same bits."""
    return " ".join(f"{value:.17g}" for value in values)


def line_type(section, *coefficients):
    """Return the row of a section's line type, its coefficients in the order of a peer's columns."""
    kind = ("diameter", "mass", "axial_stiffness", "axial_damping", "bending_stiffness")
    return numbers(section[key] for key in kind + coefficients)


def point_rows(scene, site):
    """Return the rows of the points, which both peers spell alike."""
    own = ("mass", "volume", "drag_area", "added_mass")
    rows = (
        f"{index} {point['kind']} {numbers(site.below(point['position']))} {numbers(point[key] for key in own)}"
        for index, point in enumerate(scene["points"], 1)
    )
    return list(rows)


def options(scene, site):
    """Return the options that both peers spell alike."""
    return f"""{scene["gravity"]:.17g} g
{site.depth:.17g} WtrDpth
{site.stiffness:.17g} kBot
{site.damping:.17g} cBot"""


def divided(whole, limit):
    """Return `whole` [s] divided into the fewest equal parts of at most `limit` [s]."""
    return whole / math.ceil(whole / limit - 1e-9)


def aligned(limit, interval):
    """Return the largest step [s] not above `limit` [s] that divides `interval` [s] or is a multiple of it."""
    return interval * math.floor(limit / interval + 1e-9) if limit >= interval else divided(interval, limit)


def distinct(runs):
    """Return `runs` without those that have the settings, and so the label, of an earlier one."""
    first = {}
    for run in runs:
        first.setdefault((run["peer"], run["label"], run["host"]), run)
    return list(first.values())


def in_host(host):
    """Return the suffix of the names of families in a host of communication step `host` [s]; empty offline."""
    return "" if host is None else f", in a host of {host:g} s"


# MoorDyn


def growth(scheme, z):
    """Return by how much `scheme` multiplies a mode in a step [-], z = λΔt [-] with λ the mode's eigenvalue.

    Midpoint2 corrects once and mixes 0.45 of the last step's slope into the first estimate (MoorDyn's relaxation).
    """
    if scheme == "RK2":
        return abs(1.0 + z + z * z / 2.0)
    if scheme == "RK4":
        return abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0))))
    # On the state and the last slope over λ: g = 0.55 (x + z y/2) + 0.45 y, y' = x + z g/2, x' = x + z y'.
    last = 0.55 * z / 2.0 + 0.45
    slope = np.array([1.0 + 0.55 * z / 2.0, z / 2.0 * last])
    return abs(np.linalg.eigvals(np.array([[1.0 + z * slope[0], z * slope[1]], slope]))).max()


def eigenvalues(scene, elements, bedded):
    """Return the fast modes' eigenvalues λ [1/s] of lumped lines.

    Of every kind of section: axial waves of the mesh; the same segments slack, when their damping acts without their
    stiffness; waves of bending; where `bedded`, contact with the seabed.
    """
    kinds = {}
    for line, counts in zip(scene["lines"], meshed(scene, elements)):
        for section, count in zip(line["sections"], counts):
            kind = section | {"start": None, "length": section["length"] / count}
            kinds[json.dumps(kind)] = kind
    return [mode for kind in kinds.values() for mode in section_modes(scene, kind, bedded)]


def section_modes(scene, section, bedded):
    """Return the eigenvalues λ [1/s] of the modes of a section whose length is that of one of its elements."""
    displaced = scene["density"] * math.pi / 4.0 * section["diameter"] ** 2  # ρA [kg/m]
    mass_tangential = section["mass"] + displaced * section["added_mass_tangential"]
    mass_normal = section["mass"] + displaced * section["added_mass_normal"]
    wave = math.sqrt(section["axial_stiffness"] / mass_tangential)
    modes = []
    for part in (1.0, 0.75, 0.5, 0.25, 0.1):
        omega = part * 2.0 * wave / section["length"]
        modes.append((omega, omega * section["axial_damping"] / (2.0 * section["axial_stiffness"])))
    seabed = scene["seabed"]
    if bedded and seabed["stiffness"] > 0.0:
        omega = math.sqrt(seabed["stiffness"] * section["diameter"] / mass_normal)
        modes.append((omega, seabed["damping"] * section["diameter"] / (2.0 * omega * mass_normal)))
    if section["bending_stiffness"] > 0.0:
        modes.append((4.0 / section["length"] ** 2 * math.sqrt(section["bending_stiffness"] / mass_normal), 0.0))
    slack = -2.0 * modes[0][1] * modes[0][0]
    pairs = [(omega * -ratio, omega * cmath.sqrt(ratio**2 - 1.0)) for omega, ratio in modes]
    return [slack] + [centre + sign * half for centre, half in pairs for sign in (1.0, -1.0)]


def stable_step(scheme, modes):
    """Return the largest step [s] at which no mode of eigenvalues `modes` [1/s] grows by more than 0.2 % a step."""
    step = 0.01 / max(abs(mode) for mode in modes)
    while all(growth(scheme, mode * 1.02 * step) <= 1.002 for mode in modes):
        step *= 1.02
    return step


def stable_steps(scene, elements, bedded):
    """Return the largest stable internal step [s] of every scheme on a mesh of `elements` segments."""
    modes = eigenvalues(scene, elements, bedded)
    return {scheme: stable_step(scheme, modes) for scheme in EVALUATIONS}


class Mooring:
    """The lines of a scene as MoorDyn has them: a line for every section, joined by free points without mass."""

    def __init__(self, scene, site, elements):
        """Number the joints after the points of the scene, and lay out the rows of types, points and lines."""
        self.types, self.points, self.lines, self.numbers, self.arcs = [], point_rows(scene, site), [], [], []
        for line, counts in zip(scene["lines"], meshed(scene, elements)):
            first, start = len(self.lines) + 1, line["from"] + 1
            for section, count in zip(line["sections"], counts):
                number = len(self.lines) + 1
                if number > first:
                    start = len(self.points) + 1
                    self.points.append(f"{start} free {numbers(site.below(section['start']))} 0 0 0 0")
                last = number == first + len(counts) - 1
                end = line["to"] + 1 if last else len(self.points) + 1
                coefficients = ("drag_normal", "added_mass_normal", "drag_tangential", "added_mass_tangential")
                self.types.append(f"type{number} {line_type(section, *coefficients)}")
                self.lines.append(f"{number} type{number} {start} {end} {section['length']:.17g} {count} -")
            self.numbers.append(range(first, len(self.lines) + 1))
            self.arcs.append(arcs(line, counts))


def moordyn_deck(scene, site, mooring, scheme, step):
    """Return MoorDyn's input for a mooring and an internal step of `step` [s].

    The step is written a little too long, and MoorDyn shortens it to fit: written to the last digit, rounding leaves
    a splinter of a step at the end of some host steps, and the force then belongs to another time.
    """
    types, points, lines = ("\n".join(rows) for rows in (mooring.types, mooring.points, mooring.lines))
    return f"""--- LINE TYPES ---
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s) (N-m2) (-) (-) (-) (-)
{types}
--- POINTS ---
ID Type X Y Z Mass Vol CdA Ca
(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)
{points}
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (-) (#) (#) (m) (-) (-)
{lines}
--- OPTIONS ---
0 writeLog
{options(scene, site)}
{scene["density"]:.17g} rho
{1.000001 * step:.17g} dtM
{scheme} tScheme
1 disableOutput
1 disableOutTime
--- OUTPUTS ---
--- need this line ---
"""


class MoorDyn:
    """One MoorDyn run, in this process and the current directory."""

    def __init__(self, scene, run):
        """Write the deck and lay out the host's steps."""
        import cmoordyn

        self.library, self.scene, self.run = cmoordyn, scene, run
        self.site = Site(scene)
        times, position, _, _ = self.site.path(run["communication"], 1, scene["duration"])
        self.times, self.start = times, position[0].tolist()
        secant = np.diff(position, axis=0) / run["communication"]
        self.steps = list(zip(position[:-1].tolist(), secant.tolist(), times[:-1].tolist()))
        self.mooring = Mooring(scene, self.site, run["elements"])
        with open("deck.txt", "w", encoding="ascii") as deck:
            deck.write(moordyn_deck(scene, self.site, self.mooring, run["scheme"], run["step"]))

    def open(self):
        """Return a system in its initial equilibrium."""
        system = self.library.create("deck.txt")
        self.library.set_verbosity(system, 4096)
        self.library.init(system, self.start, [0.0] * len(self.start), 0)
        return system

    def read(self):
        """Run once, and return times [s] and values of tensions [N] and mid-positions [m]."""
        system, library = self.open(), self.library
        lines = [[library.get_line(system, number) for number in numbers] for numbers in self.mooring.numbers]
        counts = meshed(self.scene, self.run["elements"])
        ends = [
            (place, of_line[0] if line["driven"] == "a" else of_line[-1], 0 if line["driven"] == "a" else count[-1])
            for place, line, of_line, count in driven_lines(self.scene, lines, counts)
        ]
        forces, masses, mids = [], [], []
        for position, velocity, start in self.steps:
            loads = np.reshape(library.step(system, position, velocity, start, self.run["communication"]), (-1, 3))
            forces.append([loads[place] for place, _, _ in ends])
            masses.append([library.line_get_node_m(line, node) for _, line, node in ends])
            mids.append([self.half_way(of_line, *rest) for of_line, *rest in zip(lines, counts, self.mooring.arcs)])
        library.close(system)
        late = 0.0 if self.run["scheme"] == "RK4" else 0.5 * self.run["step"]
        acceleration = self.site.motion.at(self.times[1:] - late)[2].reshape(len(self.steps), -1, 3)
        inertia = np.einsum("tkij,tkj->tki", np.array(masses), acceleration[:, [place for place, _, _ in ends]])
        tension = np.linalg.norm(np.array(forces) - inertia, axis=2)
        return (self.times[1:] - late, tension), (self.times[1:], np.array(mids))

    def half_way(self, lines, counts, arc):
        """Return the position [m] half-way along a line that consists of `lines` with `counts` elements."""
        place = self.library.line_get_node_pos
        nodes = [place(line, node) for line, count in zip(lines, counts) for node in range(count)]
        return half_way(arc, nodes + [place(lines[-1], counts[-1])])

    def timed(self):
        """Run once, and return the CPU time [s] less that of as many empty calls; each step returns the forces."""
        system, step, length = self.open(), self.library.step, self.run["communication"]
        begin = time.thread_time()
        for position, velocity, start in self.steps:
            step(system, position, velocity, start, length)
        solved = time.thread_time()
        empty = self.library.get_dt
        for _position, _velocity, _start in self.steps:
            empty(system)
        ended = time.thread_time()
        self.library.close(system)
        return (solved - begin) - (ended - solved)


def exact_steps(limit, period):
    """Return the communication step and the internal step [s], the internal one `limit` [s] to three digits.

    The communication step is two internal steps where the path allows it: eight cost 4 to 8 % less than one, and jumps
    of the velocity eight times as long add 0.6 to 14 % of the tension's deviation. It need not divide the output interval.
    """
    step = float(f"{limit:.3g}")
    return step * max(1, min(2, math.floor(period / 200.0 / step + 1e-9))), step


def aligned_steps(limit, period, interval):
    """Return the communication step and the internal step [s], the cheapest with the internal one at most `limit` [s].

    The internal step divides the communication step, which divides `interval` [s]: both are shorter than they could be,
    the less so the cheaper.
    """
    if limit >= interval:
        step = aligned(limit, interval)
        return step, step
    longest = max(limit, min(period / 200.0, 8.0 * limit))
    hosts = [interval / parts for parts in range(1, math.ceil(interval / limit) + 1)]
    steps = [(host, divided(host, limit)) for host in hosts if host <= longest * (1.0 + 1e-9)]
    if not steps:
        host = aligned(longest, interval)
        steps = [(host, host)]
    return min(steps, key=lambda pair: 1.0 / pair[1] + 0.1 / pair[0])


def moordyn_run(elements, scheme, steps, host, family):
    """Return a run of MoorDyn; `steps` are its communication step and its internal step [s]."""
    communication, step = steps
    label = f"n = {elements}, {scheme}, dtM {step:.3g} s"
    if host is None:
        label += f", host step {communication:.3g} s"
    elif communication < host:
        label += ", path at every step"
    run = {"peer": "MoorDyn", "label": label, "family": family + in_host(host), "host": host}
    return run | {"elements": elements, "scheme": scheme, "step": step, "communication": communication}


def moordyn_offline(scene, period, bedded):
    """Return the runs of MoorDyn offline; `period` [s] is the motion's, `bedded` whether the line meets the seabed."""
    runs = []
    for count in scene["elements"]:
        limits = stable_steps(scene, count, bedded)
        scheme = min(limits, key=lambda name: EVALUATIONS[name] / limits[name])
        exact = [exact_steps(min(part * limits[scheme], period / 8.0), period) for part in PARTS]
        for part, steps in zip(PARTS, exact):
            runs.append(moordyn_run(count, scheme, steps, None, f"MoorDyn at {part:g} of its limit"))
        for part in PARTS:
            steps = aligned_steps(min(part * limits[scheme], period / 8.0), period, scene["interval"])
            if all(abs(steps[1] / step - 1.0) > NEAR for _, step in exact):
                runs.append(moordyn_run(count, scheme, steps, None, f"MoorDyn at {part:g} of its limit, aligned"))
    return distinct(runs)


def moordyn_hosted(scene, period, bedded, host):
    """Return the runs of MoorDyn in a host of communication step `host` [s]."""
    runs = []
    for count in scene["elements"]:
        limits = stable_steps(scene, count, bedded)
        for part in PARTS:
            steps = {name: divided(host, min(part * limit, period / 8.0)) for name, limit in limits.items()}
            scheme = min(steps, key=lambda name: (EVALUATIONS[name] / steps[name], -limits[name]))
            step, family = steps[scheme], f"MoorDyn at {part:g} of its limit"
            runs.append(moordyn_run(count, scheme, (host, step), host, family))
            runs.append(moordyn_run(count, scheme, (step, step), host, f"{family}, path at every step"))
    for count in DECK_ELEMENTS:
        run = moordyn_run(count, "RK2", (host, divided(host, DECK_STEP)), host, "deck: MoorDyn")
        runs.append(run | {"label": "deck: " + run["label"], "deck": count})
    return distinct(runs)


# CableDyn


def cabledyn_deck(scene, site, run):
    """Return CableDyn's input."""
    solver, types, lines, sections, clamps = "", [], [], [], []
    if run["radius"] is not None:
        solver = f"""dynamic_solver {run["tolerance"]:g} 1e-14 30 12
{run["radius"]:g} rhoInf
{run["reuse"]} modified_newton
"""
    for number, (line, counts) in enumerate(zip(scene["lines"], meshed(scene, run["elements"])), 1):
        lines.append(f"{number} {line['from'] + 1} {line['to'] + 1} -")
        for section, count in zip(line["sections"], counts):
            name = f"type{len(types) + 1}"
            coefficients = ("drag_normal", "drag_tangential", "added_mass_normal", "added_mass_tangential")
            types.append(f"{name} {line_type(section, *coefficients)}")
            sections.append(f"{number} {name} {section['length']:.17g} {count}")
        for end, direction in zip("AB", line["clamped"]):
            if direction:
                clamps.append(f"{number} {end} Rigid {numbers(direction)}")
    if clamps:
        heading = ["--- END CONNECTIONS ---", "LineID End Stiffness EzX EzY EzZ", "(-) (-) (N-m/rad) (-) (-) (-)"]
        clamps = heading + clamps
    points = point_rows(scene, site)
    types, points, lines, sections, clamps = (
        "".join(f"{row}\n" for row in rows) for rows in (types, points, lines, sections, clamps)
    )
    return f"""--- LINE TYPES ---
Name Diam Mass EA BA EI Cdn Cdt Can Cat
(-) (m) (kg/m) (N) (N-s) (N-m^2) (-) (-) (-) (-)
{types}--- POINTS ---
ID Type X Y Z Mass Vol CdA Ca
(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
{points}--- LINES ---
ID NodeA NodeB Outputs
(-) (-) (-) (-)
{lines}--- SECTIONS ---
LineID LineType Length NumSegs
(-) (-) (m) (-)
{sections}{clamps}--- OPTIONS ---
{run["step"]:.17g} dtM
{scene["duration"]:.17g} TMax
{solver}{options(scene, site)}
{scene["density"]:.17g} rhoW
--- need this line ---
"""


class CableDyn:
    """One CableDyn run, in this process and the current directory."""

    def __init__(self, scene, run):
        """Write the deck and lay out the steps; the C interface is called without the Python layer's checks."""
        import cabledyn
        from cabledyn._lib import _lib

        self.create, self.library, self.scene, self.run = cabledyn.CableDyn, _lib, scene, run
        self.site = Site(scene)
        with open("deck.dat", "w", encoding="ascii") as deck:
            deck.write(cabledyn_deck(scene, self.site, run))
        self.every = round(run["communication"] / run["step"])
        self.times, *path = self.site.path(run["step"], self.every, scene["duration"])
        with self.create("deck.dat") as model:
            self.size, self.driven = model.n_coupled_dof, model.host_dofs()
            rest = np.asarray(model.get_coupled_motion()[0], float)
        self.history = []
        for order, values in enumerate(path):
            full = np.tile(rest if order == 0 else np.zeros(self.size), (len(self.times), 1))
            full[:, self.driven] = values
            self.history.append(full)
        self.flags = ctypes.c_bool(), ctypes.c_bool(), ctypes.c_int(), ctypes.c_int()
        self.replies = tuple(ctypes.byref(flag) for flag in self.flags)

    def calls(self):
        """Return the pointers to position, velocity and acceleration of every step, made beforehand."""
        double, width = ctypes.POINTER(ctypes.c_double), 8 * self.size
        return [
            tuple(ctypes.cast(values.ctypes.data + width * index, double) for values in self.history)
            for index in range(1, len(self.times))
        ]

    def read(self):
        """Run once, and return times [s] and values of tensions [N] and mid-positions [m]."""
        step, length = self.library.CableDyn_Step, ctypes.c_double(self.run["step"])
        forces, mids, every = [], [], self.every
        counts = meshed(self.scene, self.run["elements"])
        with self.create("deck.dat") as model:
            known = [
                (arcs(*given), self.rows(*given, line))
                for *given, line in zip(self.scene["lines"], counts, model.lines)
            ]
            for index, arguments in enumerate(self.calls(), 1):
                step(model._handle, length, *arguments, self.size, *self.replies)
                if self.flags[3].value != 0:
                    raise RuntimeError(f"step to {self.times[index]:g} s failed with status {self.flags[3].value}")
                if index % every != 0:
                    continue
                forces.append(model.calc_output()[self.driven].reshape(-1, 3))
                mids.append(
                    [half_way(arc, line.node_positions()[rows]) for line, (arc, rows) in zip(model.lines, known)]
                )
        places = [place for place, _ in driven_lines(self.scene)]
        times, tension = self.times[every::every], np.linalg.norm(np.array(forces), axis=2)[:, places]
        return (times, tension), (times, np.array(mids))

    def rows(self, given, counts, line):
        """Return the nodes of a line from its end A on that its deck has.

        CableDyn may turn a line round, and adds nodes to lines that bend.
        """
        first = [int(np.flatnonzero(line.deck_nodes == node)[0]) for node in range(1, sum(counts) + 2)]
        start = np.array(self.site.below(self.scene["points"][given["from"]]["position"]))
        far = np.linalg.norm(line.node_positions()[first][[0, -1]] - start, axis=1)
        return first if far[0] < far[1] else first[::-1]

    def timed(self):
        """Run once, and return the CPU time [s] less that of as many refused calls."""
        calls = self.calls()
        with self.create("deck.dat") as model:
            return self.loop(model._handle, calls) - self.loop(ctypes.c_void_p(), calls)

    def loop(self, handle, calls):
        """Return the CPU time [s] of all steps and of the forces at communication points; a null handle refuses all."""
        step, length, every = self.library.CableDyn_Step, ctypes.c_double(self.run["step"]), self.every
        size, replies = self.size, self.replies
        output, loads, status = self.library.CableDyn_CalcOutput, (ctypes.c_double * size)(), replies[3]
        begin = time.thread_time()
        for index, (position, velocity, acceleration) in enumerate(calls, 1):
            step(handle, length, position, velocity, acceleration, size, *replies)
            if index % every == 0:
                output(handle, loads, size, status)
        return time.thread_time() - begin


def cabledyn_run(elements, steps, solver, host, family):
    """Return a run of CableDyn; `steps` are its communication step and its step [s].

    `solver` is ρ∞ [-], whether tangents are reused, and Newton's relative tolerance [-], or None each for the defaults.
    """
    communication, step = steps
    radius, reuse, tolerance = solver
    label = f"n = {elements}, dt {step:.3g} s"
    label += ", default solver" if radius is None else f", rhoInf {radius:g}, tolerance {tolerance:g}"
    label += ", modified Newton" if reuse else ""
    run = {"peer": "CableDyn", "label": label, "family": family + in_host(host), "host": host}
    run |= {"elements": elements, "step": step, "communication": communication}
    return run | {"radius": radius, "reuse": reuse, "tolerance": tolerance}


def cabledyn_runs(scene, period, bedded, host):
    """Return the runs of CableDyn's families, offline or in a host of communication step `host` [s]."""
    runs = []
    for count in scene["elements"]:
        for parts, *solver in LANDING if bedded else FREE:
            family = f"CableDyn, {parts:g} steps to the period, {solver[0]:g}, {solver[2]:g}"
            if host is None:
                step = aligned(period / parts, scene["interval"])
                steps = max(step, scene["interval"]), step
            else:
                steps = host, divided(host, period / parts)
            runs.append(cabledyn_run(count, steps, solver, host, family))
    return distinct(runs)


def cabledyn_hosted(scene, period, bedded, host):
    """Return the runs of CableDyn in a host of communication step `host` [s]."""
    runs = cabledyn_runs(scene, period, bedded, host)
    for count in DECK_ELEMENTS:
        steps = host, divided(host, period / DECK_PARTS)
        run = cabledyn_run(count, steps, (None, None, None), host, "deck: CableDyn")
        runs.append(run | {"label": "deck: " + run["label"], "deck": count})
    return runs


def beyond(scene):
    """Return the reasons why peers cannot run a scene, by their names."""
    if Site(scene).lowered and any(line["has_surface"] for line in scene["lines"]):
        return dict.fromkeys(["MoorDyn", "CableDyn"], "a line comes out of the water")
    reasons = {}
    if any(any(line["clamped"]) for line in scene["lines"]):
        reasons["MoorDyn"] = "it clamps no line to a point"
    elif any(bends(line) and len(line["sections"]) > 1 for line in scene["lines"]):
        reasons["MoorDyn"] = "a line that bends has hinges between its sections"
    if any(point["drag_area"] or point["added_mass"] for point in scene["points"] if point["kind"] == "free"):
        reasons["CableDyn"] = "its free points have neither drag nor added mass, whatever the deck gives them"
    return reasons


# One process a run


def single(scene, run, limit, read):
    """Run one rung here in at most `limit` [s] of CPU, and return its answer; a peer that fails says why."""
    if resource is not None:
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(limit), hard))
    answer = {}
    with tempfile.TemporaryDirectory() as directory:
        os.chdir(directory)
        try:
            peer = {"MoorDyn": MoorDyn, "CableDyn": CableDyn}[run["peer"]](scene, run)
            if read:
                answer |= results(scene, peer)
            answer |= {"cpu_seconds": median_cpu(peer.timed)}
        except Exception as error:  # whatever a peer raises is the answer
            answer = {"failed": f"{type(error).__name__}: {error}"}
        os.chdir(os.path.dirname(directory))
    return answer


def results(scene, peer):
    """Return a peer's tensions [N] and mid-positions [m], line by line, at the scene's output times."""
    wanted = scene["interval"] * np.arange(1, round(scene["duration"] / scene["interval"]) + 1)
    tension, mid = (resampled(*series, wanted) for series in peer.read())
    if not (np.isfinite(tension).all() and np.isfinite(mid).all()):
        raise RuntimeError("the results are not finite")
    mid[:, :, 2] += peer.site.lowered
    return {"tension": tension.T.tolist(), "mid": mid.transpose(1, 0, 2).tolist()}


def in_own_process(scene, run, limit, read):
    """Run one rung in a process of its own, for at most `limit` [s] of CPU; a crash or a timeout is an answer too."""
    command = [sys.executable, os.path.abspath(__file__), "--single"]
    question = json.dumps([scene, run, limit, read])
    try:
        done = subprocess.run(
            command, input=question, stdout=subprocess.PIPE, text=True, timeout=WALL * limit, check=False
        )
    except subprocess.TimeoutExpired:
        return {"failed": f"not done in {WALL * limit:g} s"}
    try:
        return json.loads(done.stdout)
    except json.JSONDecodeError:
        if hasattr(signal, "SIGXCPU") and done.returncode == -signal.SIGXCPU:
            return {"failed": f"not done in {limit:g} s of CPU time"}
        return {"failed": f"ended with exit code {done.returncode}"}


def main():
    """Read a scene, name its ladder, and run what is asked for; with `--single`, one rung."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # the peers print, and standard output is for answers only
    if "--single" in sys.argv[1:]:
        json.dump(single(*json.load(sys.stdin)), answers)
        answers.close()
        return
    scene = json.loads(sys.stdin.readline())
    scene["density"] = scene["density"] or AIR
    period, bedded = Motion(scene).period(scene["duration"]), scene["lies_on_seabed"]
    runs = moordyn_offline(scene, period, bedded) + cabledyn_runs(scene, period, bedded, None)
    for host in scene.get("hosts", []):
        runs += moordyn_hosted(scene, period, bedded, host) + cabledyn_hosted(scene, period, bedded, host)
    reasons = beyond(scene)
    runs = [run for run in runs if run["peer"] not in reasons]
    left_out = [{"peer": peer, "reason": reason} for peer, reason in reasons.items()]
    named = [{key: run.get(key) for key in ("peer", "label", "family", "host", "deck")} for run in runs]
    print(json.dumps({"runs": named, "left_out": left_out}), file=answers, flush=True)
    limit = scene["time_limit_seconds"]
    for line in sys.stdin:
        question = json.loads(line)
        answer = in_own_process(scene, runs[question["run"]], limit, question["read"])
        print(json.dumps(answer), file=answers, flush=True)


if __name__ == "__main__":
    main()
