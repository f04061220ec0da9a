"""A rigid body in linear waves: Cummins' equation in six degrees of freedom, stepped together with a mooring.

(M + A∞) a + ∫K(τ) v(t − τ) dτ + D v + C x = F_wave(t) + F_mooring − F_rest

x: displacement of the origin at still water [m] and small rotations [rad] about the axes x, y, z (z up). K: retardation; A∞: added mass at
infinite frequency; D: additional linear damping; C: hydrostatics with the weight. F_rest is the force of the mooring at rest, with which
weight and buoyancy balance. Source: Cummins (1962), The impulse response function and ship motions, Schiffstechnik 9, 101-109; Ogilvie (1964),
5th Symposium on Naval Hydrodynamics, 3-79. Valid for small motions; waves come from -x.
"""

import pathlib
from dataclasses import dataclass

import numpy as np

DENSITY, GRAVITY = 1025.0, 9.80665  # [kg/m³], [m/s²]
AXES = ("x", "y", "z", "roll", "pitch", "yaw")
MOTION = AXES + ("vx", "vy", "vz", "wx", "wy", "wz")  # names of the motion, as those of the inputs of moorline's FMU
FORCE = ("fx", "fy", "fz", "mx", "my", "mz")
FREE = tuple("free_" + name for name in FORCE)
PLACES = tuple(a + ("" if len(a + b) == 2 else "_") + b for a in AXES for b in AXES)  # xx, xy ... yaw_yaw
RADIUS = 0.8  # spectral radius of the integration at infinite frequency [-]
MEMORY = 40.0  # length of the retardation function that is kept [s]
RAMP = 20.0  # time over which waves begin [s]
LAST, EXTRAPOLATED, COMING = "last", "extrapolated", "coming"  # forces of the mooring with which the body makes a step


@dataclass(frozen=True)
class Shape:
    """Mass and hydrostatics of a body. A point mass, such as a turbine, makes up the weight that buoyancy less the mooring carries."""

    mass: float  # of the body without the point mass [kg]
    centre: float  # height of its centre of mass [m]
    inertia: tuple[float, float]  # about its centre of mass: roll and pitch, yaw [kg m²]
    volume: float  # displaced [m³]
    buoyancy: float  # height of the centre of the displaced volume [m]
    waterplane: float  # area [m²]
    second_moment: float  # of the waterplane, about x and about y [m⁴]
    point_height: float  # of the point mass [m]
    damping: tuple[float, float, float] = (0.0, 0.0, 0.0)  # additional: surge and sway, heave [N s/m], yaw [N m s]
    yaw_stiffness: float = 0.0  # additional [N m]


def cone(top: float, bottom: float, upper: float, lower: float) -> tuple[float, float]:
    """Volume [m³] and its moment about z = 0 [m⁴] between two heights [m] at which the diameters are `top` and `bottom` [m]."""
    r = np.poly1d([(top - bottom) / 2 / (upper - lower), 0]) + (bottom / 2 - (top - bottom) / 2 / (upper - lower) * lower)
    volume, moment = (np.pi * r * r).integ(), (np.pi * r * r * np.poly1d([1, 0])).integ()
    return volume(upper) - volume(lower), moment(upper) - moment(lower)


def oc3_spar() -> Shape:
    """The OC3 Hywind spar: Jonkman (2010), NREL/TP-500-47535, tables 3-1 and 3-3, sections 3 and 4. Height of tower, nacelle and rotor as one
    mass: 249 718 kg at 43.4 m, 350 000 kg at 89.6 m."""
    parts = np.array([cone(6.5, 6.5, 0, -4), cone(6.5, 9.4, -4, -12), cone(9.4, 9.4, -12, -120)])
    volume, moment = parts.sum(axis=0)
    return Shape(7_466_330, -89.9155, (4.22923e9, 1.6423e8), volume, moment / volume, np.pi * 3.25**2, np.pi * 3.25**4 / 4,
                 70.4, (1e5, 1.3e5, 1.3e7), 9.834e7)


def barge() -> Shape:
    """A square box, 20 m wide, of draft 2.838 m and depth 5 m: a hull of 900 t, uniform, and cargo at 3 m height; 1000 t in all."""
    side, draft = 20.0, 2.838
    hull = 9e5 / 12 * np.array([side**2 + 5.0**2, 2 * side**2])
    return Shape(9e5, -0.338, tuple(hull), side**2 * draft, -draft / 2, side**2, side**4 / 12, 3.0)


BODIES = {"spar": oc3_spar, "barge": barge}


def mass_and_stiffness(shape: Shape, mooring_weight: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Mass matrix, hydrostatic stiffness with the weight, both about the origin, and the point mass [kg].

    `mooring_weight`: the downward force of the mooring at rest [N]."""
    point = DENSITY * shape.volume - mooring_weight / GRAVITY - shape.mass
    masses, heights = np.array([shape.mass, point]), np.array([shape.centre, shape.point_height])
    moment, second = masses @ heights, masses @ heights**2
    mass = np.diag([masses.sum()] * 3 + [shape.inertia[0] + second] * 2 + [shape.inertia[1]])
    mass[0, 4] = mass[4, 0] = moment
    mass[1, 3] = mass[3, 1] = -moment
    turning = DENSITY * GRAVITY * (shape.volume * shape.buoyancy + shape.second_moment) - GRAVITY * moment
    return mass, np.diag([0, 0, DENSITY * GRAVITY * shape.waterplane, turning, turning, shape.yaw_stiffness]), point


def six(c11: float, c33: float, c55: float, c15: float, c66: float) -> np.ndarray:
    """Matrix of a body that looks alike from x and from y."""
    matrix = np.diag([c11, c11, c33, c55, c55, c66])
    matrix[0, 4] = matrix[4, 0] = c15
    matrix[1, 3] = matrix[3, 1] = -c15
    return matrix


class Hydrodynamics:
    """Frequencies [rad/s], added mass A, radiation damping B (n × 6 × 6), excitation F (n × 6) by unit waves along x, and A∞ of a body.

    F e^(−iωt) is the force by the wave Re e^(i(kx − ωt)). Made by `hydrodynamics.py`."""

    def __init__(self, name: str) -> None:
        table = np.loadtxt(pathlib.Path(__file__).with_name(f"{name}.csv"), delimiter=",")
        self.infinite = six(*table[-1, 1:6])
        table = table[:-1]
        self.omega = table[:, 0]
        self.added_mass = np.array([six(*row[1:6]) for row in table])
        self.damping = np.array([six(*row[6:11]) for row in table])
        self.excitation = np.zeros((len(table), 6), dtype=complex)
        self.excitation[:, [0, 2, 4]] = table[:, 11::2] + 1j * table[:, 12::2]

    def at(self, table: np.ndarray, omega: np.ndarray | float) -> np.ndarray:
        """A table at frequencies within it, linear in between."""
        i = np.clip(np.searchsorted(self.omega, omega) - 1, 0, len(table) - 2)
        part = (omega - self.omega[i]) / (self.omega[i + 1] - self.omega[i])
        return table[i] + (part * (table[i + 1] - table[i]).T).T

    def retardation(self, times: np.ndarray) -> np.ndarray:
        """K(t) = (2/π) ∫ B(ω) cos ωt dω over the table, by the trapezoidal rule [N/m, N, N m]; times are short beside 2π/Δω = 251 s."""
        spacing = self.omega[1] - self.omega[0]  # the first row is at Δω, and B(0) = 0
        weight = np.where(self.omega < self.omega[-1], spacing, spacing / 2)
        return 2 / np.pi * np.tensordot(np.cos(np.outer(times, self.omega)) * weight, self.damping, axes=1)


@dataclass(frozen=True)
class Waves:
    """Regular waves of a height [m] and period [s], or with a seed ≥ 0 a sea of that significant height and peak period."""

    height: float = 0.0
    period: float = 10.0
    seed: int = -1

    def components(self) -> tuple[np.ndarray, np.ndarray]:
        """Frequencies [rad/s] and complex amplitudes [m]. A sea has 400 components of random phase, each at a random place of its band, so that
        it does not repeat itself; JONSWAP spectrum, γ = 3.3 (DNV-RP-C205, 3.5.5)."""
        peak = 2 * np.pi / self.period
        if self.seed < 0:
            return np.array([peak]), np.array([self.height / 2 + 0j])
        random, gamma = np.random.default_rng(self.seed), 3.3
        width = 3.0 * peak / 400
        omega = 0.4 * peak + width * (np.arange(400) + random.random(400))
        sigma = np.where(omega < peak, 0.07, 0.09)
        shape = 5 / 16 * self.height**2 * peak**4 / omega**5 * np.exp(-1.25 * (peak / omega) ** 4)
        shape *= (1 - 0.287 * np.log(gamma)) * gamma ** np.exp(-0.5 * ((omega / peak - 1) / sigma) ** 2)
        return omega, np.sqrt(2 * shape * width) * np.exp(2j * np.pi * random.random(400))


class Body:
    """A body that is stepped by the generalised-α method (Chung & Hulbert 1993, J. Appl. Mech. 60, 371-375) with a fixed step [s]."""

    def __init__(self, name: str, step: float, rest: np.ndarray, waves: Waves = Waves()) -> None:
        """`rest`: force [N] and moment [N m] of the mooring at rest."""
        self.shape, self.data = BODIES[name](), Hydrodynamics(name)
        self.step, self.rest, self.time = step, np.asarray(rest, dtype=float), 0.0
        mass, self.stiffness, self.point_mass = mass_and_stiffness(self.shape, -self.rest[2])
        self.mass = mass + self.data.infinite
        surge, heave, yaw = self.shape.damping
        self.damping = np.diag([surge, surge, heave, 0.0, 0.0, yaw])
        count = round(MEMORY / step)
        kernel = step * self.data.retardation(step * np.arange(count + 1))
        kernel[[0, -1]] /= 2  # trapezoidal rule
        self.present, self.past = kernel[0], np.hstack(list(kernel[1:]))
        self.history, self.newest = np.zeros((2 * count, 6)), count  # velocities, newest first, from `newest` on
        self.omega, amplitude = waves.components()
        self.wave_force = self.data.at(self.data.excitation, self.omega) * amplitude[:, None]
        self.x, self.v, self.a = np.zeros(6), np.zeros(6), None

    def load(self, time: float) -> np.ndarray:
        """Force of the waves [N, N m] at a time [s], less the mooring's at rest."""
        ramp = 0.5 - 0.5 * np.cos(np.pi * min(time / RAMP, 1.0))
        return ramp * (np.exp(-1j * self.omega * time) @ self.wave_force).real - self.rest

    def remembered(self) -> np.ndarray:
        """Radiation force by the velocities kept, of which the newest is one step old when the next is found [N, N m]."""
        count = len(self.history) // 2
        return self.past @ self.history[self.newest:self.newest + count].ravel()

    def remember(self) -> None:
        """Stores the velocity."""
        count = len(self.history) // 2
        if self.newest == 0:
            self.history[count:], self.newest = self.history[:count], count
        self.newest -= 1
        self.history[self.newest] = self.v

    def advance(self, force: np.ndarray, at_end: np.ndarray, by_motion: tuple[np.ndarray, ...] | None = None) -> None:
        """Makes a step with the force of the mooring at its start, and `at_end` at its end. `by_motion`: mass, damping and stiffness of the
        mooring for the force at the end, at_end − mass a − damping v − stiffness x; `force` is then without inertia."""
        h, x, v = self.step, self.x, self.v
        alpha_m, alpha_f = (2 * RADIUS - 1) / (RADIUS + 1), RADIUS / (RADIUS + 1)
        gamma, beta = 0.5 - alpha_m + alpha_f, 0.25 * (1 - alpha_m + alpha_f) ** 2
        mass, damping, stiffness = by_motion or (0.0, 0.0, 0.0)
        mass, own = self.mass + mass, self.damping + self.present
        start = self.load(self.time) + force - self.remembered() - own @ v - self.stiffness @ x
        if self.a is None:
            self.a = np.linalg.solve(mass, start)
        self.remember()
        damping, stiffness = own + damping, self.stiffness + stiffness
        x = x + h * v + h * h * (0.5 - beta) * self.a
        v = v + h * (1 - gamma) * self.a
        end = self.load(self.time + h) + at_end - self.remembered() - damping @ v - stiffness @ x
        matrix = (1 - alpha_m) * mass + (1 - alpha_f) * (h * gamma * damping + h * h * beta * stiffness)
        self.a = np.linalg.solve(matrix, (1 - alpha_f) * end + alpha_f * start - alpha_m * (mass @ self.a))
        self.x, self.v = x + beta * h * h * self.a, v + gamma * h * self.a
        self.time += h

    def dynamic_stiffness(self, omega: float) -> np.ndarray:
        """C − ω²(M + A(ω)) − iω(D + B(ω)), by which the response to a force F e^(−iωt) is F over it, without mooring [N/m, N, N m]."""
        mass = self.mass + self.data.at(self.data.added_mass, omega) - self.data.infinite
        radiated = self.data.at(self.data.damping, omega)
        return self.stiffness - omega**2 * mass - 1j * omega * (self.damping + radiated)
