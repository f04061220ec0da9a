"""Mooring-line dynamics: statics, time-domain runs, coupling step by step, FMUs.

>>> import moorline
>>> scene = moorline.Scene.load("oc3.toml")            # a scene, or a deck of MoorDyn or MAP++
>>> scene.statics().lines["line1"].end_b.tension       # static equilibrium
>>> table = moorline.run(scene)                        # a run in time: a dict of arrays
>>> simulation = moorline.Simulation(scene)            # coupling: inputs in, a step, outputs out
>>> simulation.advance({"fairlead.x": 0.1}, 0.05)
>>> simulation["line1.tension_b"]

SI units; z is up and z = 0 is the still water level; a line runs from end A, the anchor, to end B, the fairlead. Forces are those that the
mooring applies to the vessel. Names of inputs, outputs and parameters are those of the FMU.
"""

from moorline._moorline import Scene, Simulation, State, __version__, fmu
from moorline.errors import Error, InputError, OutputError, SceneError, StaticsError, StepError
from moorline.plotting import animate, plot, plot3d
from moorline.results import Table
from moorline.runs import Case, batch, run
from moorline.sweeps import sweep

__all__ = [
    "Case", "Error", "InputError", "OutputError", "Scene", "SceneError", "Simulation", "State", "StaticsError", "StepError", "Table",
    "__version__", "animate", "batch", "fmu", "plot", "plot3d", "run", "sweep",
]
