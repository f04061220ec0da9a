#!/usr/bin/env python3
"""Run MoorDyn and CableDyn over one scene at their own best settings, for `moorline accuracy --peers`.

The conversation is in lines of JSON. The first line on standard input describes a scene of one line whose upper end is
driven; the first answer lists the runs of the ladder. Every further line asks for one of them and gets its results.
Everything else goes to standard error.

Input (SI units)
    name, gravity [m/s²], density [kg/m³], depth [m] or null, seabed {stiffness [Pa/m], damping [Pa·s/m]} or null,
    line {length [m], mass [kg/m], diameter [m], axial_stiffness [N], axial_damping [N·s], drag_normal, drag_tangential,
    added_mass_normal, added_mass_tangential [-]}, anchor [m], fairlead [m],
    harmonics {x, y, z: [[amplitude [m], period [s], phase [rad]], ...], ramp [s]}, duration [s], interval [s],
    elements [-], hosts, the communication steps [s] of hosts (none if absent), and time_limit_seconds [s], the CPU time
    that all passes of a run may take. A density of null is a line in air.
First answer
    runs, each with peer, label, host, deck, and family, a name that runs share which differ in their mesh alone, from
    coarse to fine. host is null for a run of the offline ladder, or the one of hosts that the run is in. deck is the
    number of elements where the settings are those of a deck, else null.
Question
    run, its number from 0, and read, whether its results are wanted beside its cost.
Answer
    Either cpu_seconds [s] and, where wanted, tension [N] at the fairlead and mid [m], the position at s = L/2, both at
    interval, 2·interval, ...; or failed, the reason.

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
# A line shorter than this part [-] of one that just leaves the seabed at its anchor is taken to hang free.
HANGS_FREE = 0.97
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


class Path:
    """The fairlead's prescribed motion: position [m], velocity [m/s] and acceleration [m/s²] at any time."""

    def __init__(self, scene):
        """Take the harmonics of the scene."""
        self.start = np.array(scene["fairlead"], float)
        self.harmonics = scene["harmonics"]

    def period(self, duration):
        """Return the period [s] of the harmonic motion with the same mean squares of velocity and acceleration."""
        _, velocity, acceleration = self.at(np.linspace(0.0, duration, 4001))
        squares = (velocity**2).mean(), (acceleration**2).mean()
        return 2.0 * math.pi * math.sqrt(squares[0] / squares[1]) if squares[1] > 0.0 else duration

    def at(self, times):
        """Return position [m], velocity [m/s] and acceleration [m/s²] at `times` [s], one row each."""
        times = np.asarray(times, float)
        waves = np.zeros((3, len(times), 3))
        for axis, name in enumerate("xyz"):
            for amplitude, period, *phase in self.harmonics[name]:
                omega = 2.0 * math.pi / period
                angle = omega * times + (phase[0] if phase else 0.0)
                waves[0, :, axis] += amplitude * np.sin(angle)
                waves[1, :, axis] += amplitude * omega * np.cos(angle)
                waves[2, :, axis] -= amplitude * omega**2 * np.sin(angle)
        rise = self.harmonics["ramp"]
        ramp = np.stack([np.ones_like(times), np.zeros_like(times), np.zeros_like(times)])
        if rise > 0.0:
            early, rate = times < rise, math.pi / rise
            ramp[0, early] = 0.5 * (1.0 - np.cos(rate * times[early]))
            ramp[1, early] = 0.5 * rate * np.sin(rate * times[early])
            ramp[2, early] = 0.5 * rate**2 * np.cos(rate * times[early])
        value, slope, bend = ramp[:, :, None]
        return (
            self.start + value * waves[0],
            slope * waves[0] + value * waves[1],
            bend * waves[0] + 2.0 * slope * waves[1] + value * waves[2],
        )


class Site:
    """A scene as both peers need it: everything below z = 0, and a depth [m] in any case."""

    def __init__(self, scene):
        """Lower the scene where its motion reaches the surface, and give deep water where it has no seabed."""
        self.path = Path(scene)
        highest = self.path.at(np.linspace(0.0, scene["duration"], 4001))[0][:, 2].max()
        self.lowered = LOWERED if max(highest, scene["anchor"][2]) >= 0.0 else 0.0
        down = np.array([0.0, 0.0, self.lowered])
        self.anchor, self.fairlead = np.array(scene["anchor"]) - down, np.array(scene["fairlead"]) - down
        seabed = scene["seabed"]
        if seabed:
            self.depth = scene["depth"] + self.lowered
            self.stiffness, self.damping = seabed["stiffness"], seabed["damping"]
        else:
            self.depth = scene["line"]["length"] - min(self.anchor[2], self.fairlead[2])
            self.stiffness, self.damping = 1.0e3, 0.0

    def motion(self, step, every, duration):
        """Return times [s] at intervals of `step` [s], and the lowered path at these times.

        The last time is the first multiple of `every` steps that is not before `duration` [s].
        """
        times = step * np.arange(every * math.ceil(duration / (every * step) - 1e-9) + 1)
        position, velocity, acceleration = self.path.at(times)
        position[:, 2] -= self.lowered
        return times, position, velocity, acceleration


def lies_on_seabed(scene, path):
    """Return whether the line reaches the seabed, by the inextensible catenary that leaves it at the anchor.

    Its parameter a [m] satisfies X = a·acosh(1 + Z/a), its length is √(Z² + 2Za). This chooses settings only: the seabed
    stays in the decks.
    """
    if not scene["seabed"]:
        return False
    position = path.at(np.linspace(0.0, scene["duration"], 4001))[0]
    across = np.hypot(*(position - np.array(scene["anchor"]))[:, :2].T).min()
    above = (position[:, 2] - scene["anchor"][2]).min()
    if above <= 0.0 or across <= 0.0:
        return True
    lower, upper = 1e-6 * above, 1e9 * (above + across)
    for _ in range(200):
        middle = math.sqrt(lower * upper)
        if middle * math.acosh(1.0 + above / middle) < across:
            lower = middle
        else:
            upper = middle
    return scene["line"]["length"] > HANGS_FREE * math.sqrt(above**2 + 2.0 * above * lower)


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


def half_way(nodes):
    """Return the position [m] half-way along a line of equal elements: between nodes by a cubic, as moorline's."""
    nodes = np.asarray(nodes)
    last = len(nodes) - 1
    if last % 2 == 0 or last < 3:
        return 0.5 * (nodes[last // 2] + nodes[(last + 1) // 2])
    first = last // 2 - 1
    return np.array([-1.0, 9.0, 9.0, -1.0]) @ nodes[first : first + 4] / 16.0


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


def line_type(line, *coefficients):
    """Return the row of a line type without bending stiffness, its coefficients in the order of a peer's columns."""
    kind = ("diameter", "mass", "axial_stiffness", "axial_damping")
    return numbers([line[key] for key in kind] + [0.0] + [line[key] for key in coefficients])


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
    """Return the fast modes' eigenvalues λ [1/s] of a lumped line.

    Axial waves of the mesh; the same segments slack, when their damping acts without their stiffness; where
    `bedded`, contact with the seabed.
    """
    line, density = scene["line"], scene["density"]
    displaced = density * math.pi / 4.0 * line["diameter"] ** 2  # ρA [kg/m]
    mass_tangential = line["mass"] + displaced * line["added_mass_tangential"]
    mass_normal = line["mass"] + displaced * line["added_mass_normal"]
    wave = math.sqrt(line["axial_stiffness"] / mass_tangential)
    modes = []
    for part in (1.0, 0.75, 0.5, 0.25, 0.1):
        omega = part * 2.0 * wave * elements / line["length"]
        modes.append((omega, omega * line["axial_damping"] / (2.0 * line["axial_stiffness"])))
    seabed = scene["seabed"]
    if bedded and seabed["stiffness"] > 0.0:
        omega = math.sqrt(seabed["stiffness"] * line["diameter"] / mass_normal)
        modes.append((omega, seabed["damping"] * line["diameter"] / (2.0 * omega * mass_normal)))
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


def moordyn_deck(scene, site, elements, scheme, step):
    """Return MoorDyn's input for one line of `elements` segments and an internal step of `step` [s].

    The step is written a little too long, and MoorDyn shortens it to fit: written to the last digit, rounding leaves
    a splinter of a step at the end of some host steps, and the force then belongs to another time.
    """
    line = scene["line"]
    row = line_type(line, "drag_normal", "added_mass_normal", "drag_tangential", "added_mass_tangential")
    return f"""--- LINE TYPES ---
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
(-) (m) (kg/m) (N) (N-s) (N-m2) (-) (-) (-) (-)
line {row}
--- POINTS ---
ID Type X Y Z Mass Vol CdA Ca
(#) (-) (m) (m) (m) (kg) (m3) (m2) (-)
1 Fixed {numbers(site.anchor)} 0 0 0 0
2 Coupled {numbers(site.fairlead)} 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(#) (-) (#) (#) (m) (-) (-)
1 line 1 2 {line["length"]:.17g} {elements} -
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
        times, position, _, _ = self.site.motion(run["communication"], 1, scene["duration"])
        self.times = times
        secant = np.diff(position, axis=0) / run["communication"]
        self.steps = list(zip(position[:-1].tolist(), secant.tolist(), times[:-1].tolist()))
        with open("deck.txt", "w", encoding="ascii") as deck:
            deck.write(moordyn_deck(scene, self.site, run["elements"], run["scheme"], run["step"]))

    def open(self):
        """Return a system in its initial equilibrium."""
        system = self.library.create("deck.txt")
        self.library.set_verbosity(system, 4096)
        self.library.init(system, self.site.fairlead.tolist(), [0.0, 0.0, 0.0], 0)
        return system

    def read(self):
        """Run once, and return times [s] and values of tension [N] and mid-position [m]."""
        system, library = self.open(), self.library
        line, nodes, length = library.get_line(system, 1), self.run["elements"], self.run["communication"]
        forces, masses, mids = [], [], []
        for position, velocity, start in self.steps:
            forces.append(library.step(system, position, velocity, start, length))
            masses.append(library.line_get_node_m(line, nodes))
            mids.append(half_way([library.line_get_node_pos(line, node) for node in range(nodes + 1)]))
        library.close(system)
        late = 0.0 if self.run["scheme"] == "RK4" else 0.5 * self.run["step"]
        acceleration = self.site.path.at(self.times[1:] - late)[2]
        inertia = np.einsum("tij,tj->ti", np.array(masses), acceleration)
        tension = np.linalg.norm(np.array(forces) - inertia, axis=1)
        return (self.times[1:] - late, tension), (self.times[1:], np.array(mids))

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
    """Return CableDyn's input; its end A is the fairlead."""
    line = scene["line"]
    row = line_type(line, "drag_normal", "drag_tangential", "added_mass_normal", "added_mass_tangential")
    solver = ""
    if run["radius"] is not None:
        solver = f"""dynamic_solver {run["tolerance"]:g} 1e-14 30 12
{run["radius"]:g} rhoInf
{run["reuse"]} modified_newton
"""
    return f"""--- LINE TYPES ---
Name Diam Mass EA BA EI Cdn Cdt Can Cat
(-) (m) (kg/m) (N) (N-s) (N-m^2) (-) (-) (-) (-)
line {row}
--- POINTS ---
ID Type X Y Z
(-) (-) (m) (m) (m)
1 Coupled {numbers(site.fairlead)}
2 Fixed {numbers(site.anchor)}
--- LINES ---
ID NodeA NodeB Outputs
(-) (-) (-) (-)
1 1 2 -
--- SECTIONS ---
LineID LineType Length NumSegs
(-) (-) (m) (-)
1 line {line["length"]:.17g} {run["elements"]}
--- OPTIONS ---
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
        self.times, *path = self.site.motion(run["step"], self.every, scene["duration"])
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
        """Run once, and return times [s] and values of tension [N] and mid-position [m]."""
        step, length = self.library.CableDyn_Step, ctypes.c_double(self.run["step"])
        forces, mids, every = [], [], self.every
        with self.create("deck.dat") as model:
            line = model.lines[0]
            for index, arguments in enumerate(self.calls(), 1):
                step(model._handle, length, *arguments, self.size, *self.replies)
                if self.flags[3].value != 0:
                    raise RuntimeError(f"step to {self.times[index]:g} s failed with status {self.flags[3].value}")
                if index % every != 0:
                    continue
                forces.append(model.calc_output()[self.driven])
                mids.append(half_way(line.node_positions()))
        times, tension = self.times[every::every], np.linalg.norm(np.array(forces), axis=1)
        return (times, tension), (times, np.array(mids))

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
    """Return a peer's tension [N] and mid-position [m] at the scene's output times."""
    wanted = scene["interval"] * np.arange(1, round(scene["duration"] / scene["interval"]) + 1)
    tension, mid = (resampled(*series, wanted) for series in peer.read())
    if not (np.isfinite(tension).all() and np.isfinite(mid).all()):
        raise RuntimeError("the results are not finite")
    mid[:, 2] += peer.site.lowered
    return {"tension": tension.tolist(), "mid": mid.tolist()}


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
    path = Path(scene)
    period, bedded = path.period(scene["duration"]), lies_on_seabed(scene, path)
    runs = moordyn_offline(scene, period, bedded) + cabledyn_runs(scene, period, bedded, None)
    for host in scene.get("hosts", []):
        runs += moordyn_hosted(scene, period, bedded, host) + cabledyn_hosted(scene, period, bedded, host)
    named = [{key: run.get(key) for key in ("peer", "label", "family", "host", "deck")} for run in runs]
    print(json.dumps({"runs": named}), file=answers, flush=True)
    limit = scene["time_limit_seconds"]
    for line in sys.stdin:
        question = json.loads(line)
        answer = in_own_process(scene, runs[question["run"]], limit, question["read"])
        print(json.dumps(answer), file=answers, flush=True)


if __name__ == "__main__":
    main()
