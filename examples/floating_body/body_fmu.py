"""The body of `body.py` as an FMU (FMI 2.0), made by pythonfmu: `Moorings.body_fmu` in `hosts.py`. Its names are those of moorline's FMU, without the vessel's."""

import numpy as np
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real, String

from body import AXES, BODIES, COMING, EXTRAPOLATED, FORCE, FREE, LAST, MOTION, PLACES, Body, Waves

MATRICES = ("mass", "damping", "stiffness")


class FloatingBody(Fmi2Slave):
    """Inputs: force of the mooring and, with `coupling` "coming", its parts free, mass, damping and stiffness. Outputs: displacement and velocity."""

    def __init__(self, **kwargs) -> None:
        super().__init__(**kwargs)
        self.body, self.step, self.coupling = "spar", 0.1, LAST
        self.wave_height, self.wave_period, self.wave_seed = 0.0, 10.0, -1
        self.motion, self.rest, self.force, self.free = np.zeros(12), np.zeros(6), np.zeros(6), np.zeros(6)
        self.mass, self.damping, self.stiffness = np.zeros(36), np.zeros(36), np.zeros(36)
        self.force_before: np.ndarray | None = None
        self.solver: Body | None = None
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        self.register_variable(String("body", description="spar or barge", **fixed))
        self.register_variable(Real("step", description="communication step, fixed [s]", **fixed))
        self.register_variable(String("coupling", description="force of a step: last, extrapolated or coming", **fixed))
        self.register_variable(Real("wave_height", description="height, or significant height [m]", **fixed))
        self.register_variable(Real("wave_period", description="period, or peak period [s]", **fixed))
        self.register_variable(Integer("wave_seed", description="of the phases of a sea; -1: regular waves", **fixed))
        self.reals("rest", tuple("rest_" + name for name in FORCE), fixed, "mooring at rest [N, N m]")
        self.reals("motion", tuple("start_" + name for name in AXES), fixed, "displacement at the start [m, rad]")
        self.reals("force", FORCE, {"causality": Fmi2Causality.input}, "force of the mooring [N, N m]")
        self.reals("free", FREE, {"causality": Fmi2Causality.input}, "force of the coming step at x = v = a = 0 [N, N m]")
        for matrix in MATRICES:
            names = tuple(f"{matrix}_{place}" for place in PLACES)
            self.reals(matrix, names, {"causality": Fmi2Causality.input}, f"{matrix} of the mooring [SI]")
        self.reals("motion", MOTION, {"causality": Fmi2Causality.output}, "displacement or velocity [m, rad, m/s, rad/s]")

    def reals(self, array: str, names: tuple[str, ...], role: dict, description: str) -> None:
        """Registers the entries of an array of this object as variables."""
        for i, name in enumerate(names):
            self.register_variable(Real(name, description=description, **role, getter=lambda i=i: float(getattr(self, array)[i]),
                                        setter=lambda value, i=i: getattr(self, array).__setitem__(i, value)))

    def exit_initialization_mode(self) -> None:
        """Makes the body, at rest at its start."""
        if self.body not in BODIES or self.coupling not in (LAST, EXTRAPOLATED, COMING):
            raise ValueError(f"body is {self.body}, coupling {self.coupling}: spar or barge; {LAST}, {EXTRAPOLATED} or {COMING}")
        self.solver = Body(self.body, self.step, self.rest, Waves(self.wave_height, self.wave_period, self.wave_seed))
        self.solver.x = self.motion[:6].copy()

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Makes a step, which must have the length `step`."""
        if abs(step_size - self.step) > 1e-6 * self.step:
            raise ValueError(f"the step is {step_size} s; it has to be the parameter step, {self.step} s")
        if self.coupling == COMING:
            self.solver.advance(self.force, self.free, tuple(getattr(self, name).reshape(6, 6) for name in MATRICES))
        elif self.coupling == EXTRAPOLATED and self.force_before is not None:
            self.solver.advance(self.force, 2 * self.force - self.force_before)
        else:
            self.solver.advance(self.force, self.force)
        self.force_before = self.force.copy()
        self.motion[:6], self.motion[6:] = self.solver.x, self.solver.v
        return True
