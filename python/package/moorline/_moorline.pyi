"""The extension module: doors to the library, which computes."""

import os
from collections.abc import Callable, Sequence
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from moorline.errors import Error
from moorline.results import Mode, PointState, Statics, Table

__all__ = ["MoorDyn", "Scene", "Simulation", "State", "Sweep", "__version__", "batch", "fmu", "main", "run"]
__version__: str

@final
class Scene:
    """A mooring as described by the user. A scene does not change: methods return new scenes."""

    @staticmethod
    def load(path: str | os.PathLike[str], *, depth: float | None = None, vessel: str | None = None,
             positions: dict[str, tuple[float, float, float]] | None = None) -> Scene:
        """Reads a scene, or a deck of MoorDyn or MAP++. For a deck: depth of the water [m]; name of the only vessel, which carries its coupled
        points; reference positions of vessels by name [m]."""
    @staticmethod
    def from_toml(text: str, *, folder: str | os.PathLike[str] | None = None) -> Scene:
        """Reads a scene from TOML. File names in it are relative to the folder."""
    @staticmethod
    def from_dict(scene: dict[str, Any], *, folder: str | os.PathLike[str] | None = None) -> Scene:
        """Reads a scene from a dict with the keys of the scene format. Numpy arrays and numbers are accepted as lists and numbers."""
    def to_toml(self) -> str:
        """Returns the scene as TOML that refers to no other file and is read back to the same numbers, bit for bit."""
    def to_dict(self) -> dict[str, Any]:
        """Returns the scene as a dict, with the keys of `to_toml`."""
    @property
    def title(self) -> str:
        """Title."""
    @property
    def lines(self) -> list[str]:
        """Names of the lines."""
    @property
    def points(self) -> list[str]:
        """Names of the points."""
    @property
    def vessels(self) -> list[str]:
        """Names of the vessels."""
    @property
    def notes(self) -> list[str]:
        """Remarks on a valid scene."""
    def in_words(self) -> str:
        """Describes in sentences which effects the scene models and which it does not."""
    @property
    def parameters(self) -> dict[str, float]:
        """Parameters and their values, by the names of the FMU."""
    def with_parameters(self, values: dict[str, float]) -> Scene:
        """Returns the scene with other values of some parameters, such as `chain.drag_normal`."""
    def with_motion(self, motion: Any = None, *, duration: float | None = None, interval: float | None = None) -> Scene:
        """Returns the scene with the motion in columns, whose length sets the duration unless `duration` [s] is given; `interval` is the output
        interval [s]."""
    def discretised(self) -> Scene:
        """Returns the scene with its discretisation: elements, integrator and time step. Values that the scene leaves open are selected by
        convergence trials, which take about a second."""
    def statics(self) -> Statics:
        """Returns the static equilibrium without waves."""
    def modes(self, count: int = 10) -> list[Mode]:
        """Returns the lowest natural modes about the static equilibrium."""
    def __eq__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, tuple[str]]: ...

@final
class State:
    """Saved state: everything that changes in a simulation."""

    def to_bytes(self) -> bytes:
        """Returns the state as bytes, which only this version of moorline reads."""
    @staticmethod
    def from_bytes(data: bytes) -> State:
        """Reads bytes written by `to_bytes`."""
    def __reduce__(self) -> tuple[Any, tuple[bytes]]: ...

@final
class Simulation:
    """A mooring that a host steps in time.

    It starts in static equilibrium with the inputs of the start. Inputs refer to the current time; the path of a fairlead is extrapolated
    smoothly from them over the next step.
    """

    def __new__(cls, scene: Scene, *, inputs: dict[str, float | None] | Sequence[float] | NDArray[np.float64] | None = None,
                start_time: float = 0.0, velocities: bool = False) -> Self:
        """Solves the static equilibrium. With `velocities`, input arrays include velocities; otherwise velocities are derived."""
    @property
    def scene(self) -> Scene:
        """The scene with its discretisation."""
    @property
    def time(self) -> float:
        """Time [s]."""
    @property
    def input_names(self) -> list[str]:
        """Names of the inputs, in the order of an input array."""
    @property
    def output_names(self) -> list[str]:
        """Names of the outputs, in the order of an output array."""
    @property
    def units(self) -> dict[str, str]:
        """Units of all inputs, outputs and parameters, by name."""
    def advance(self, inputs: dict[str, float | None] | Sequence[float] | NDArray[np.float64] | None, h: float) -> None:
        """Sets inputs, by name or as an array in the order of `input_names`, and steps by `h` [s] from the current time. An input that is not named
        keeps its value; a velocity of None is derived from the displacements. Warns once of likely mistakes."""
    def __getitem__(self, name: str, /) -> Any:
        """An input, output or parameter by name."""
    def outputs(self, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Returns all outputs in the order of `output_names`, in `out` if given."""
    def derivatives(self, outputs: Sequence[str], inputs: Sequence[str]) -> NDArray[np.float64]:
        """Returns the derivatives of outputs with respect to inputs, displacements and velocities, at the end of the last step: one row per output,
        one column per input. Requires `derivatives = true` in `[output]` of the scene."""
    def rates(self, outputs: Sequence[str]) -> NDArray[np.float64]:
        """Returns the time derivatives of outputs [per second] at the end of the last step. Requires `derivatives = true` in `[output]` of the
        scene."""
    def positions(self, line: str, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Returns the positions of the nodes of a line from end A to end B [m], one row per node, in `out` if given."""
    def velocities(self, line: str, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Returns the velocities of the nodes of a line from end A to end B [m/s], one row per node, in `out` if given."""
    def flow_places(self, line: str, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Returns the positions at which the water flow is required next, for the nodes of a line from end A to end B [m], one row per node, in `out`
        if given."""
    def set_flow(self, line: str, velocities: NDArray[np.float64], accelerations: NDArray[np.float64]) -> None:
        """Sets velocities [m/s] and accelerations [m/s²] of the water at these positions, one row per node, for the following steps."""
    def point(self, name: str) -> PointState:
        """Returns position, velocity and force of a point."""
    def end_forces(self, line: str) -> NDArray[np.float64]:
        """Returns the forces of a line on its supports at end A and end B [N], one row per end."""
    def tensions(self, line: str) -> NDArray[np.float64]:
        """Returns the effective tensions at the nodes of a line [N]; at the ends, the magnitude of the force."""
    def segment_tensions(self, line: str) -> NDArray[np.float64]:
        """Returns the segment tensions at the nodes of a line [N]: of the end segment at an end, otherwise the mean of the two adjacent segments, as
        in MoorDyn."""
    def save(self) -> State:
        """Saves the state. A simulation restored to it continues bit for bit."""
    def restore(self, state: State) -> None:
        """Restores a state saved by this or another simulation of the same scene."""
    def copy(self) -> Simulation:
        """Returns a second simulation in the same state."""
    def __copy__(self) -> Simulation: ...
    def __deepcopy__(self, _memo: Any) -> Simulation: ...

def fmu(scene: Scene, path: str | os.PathLike[str], fmi: int = 2) -> None:
    """Packages a scene as an FMU for FMI 2.0 or 3.0."""

def run(scene: Scene, *, columns: Sequence[str] | None = None, shapes: float | None = None,
        progress: Callable[[int, int], object] | None = None) -> Table:
    """Runs a scene with its motion: see `moorline.run`."""

def batch(scenes: Sequence[Scene], *, columns: Sequence[str] | None = None, shapes: float | None = None, threads: int | None = None,
          progress: Callable[[int, int], object] | None = None) -> list[Table | Error]:
    """Runs scenes on several threads: see `moorline.batch`."""

def main(arguments: Sequence[str | os.PathLike[str]]) -> int:
    """Runs the program `moorline` with its arguments, the first of which is its name, and returns the exit code."""

@final
class Sweep:
    """The cases of a sweep, and its folder once opened."""

    def __new__(cls, base: str | os.PathLike[str], cases: str | os.PathLike[str], start: float | None = None) -> Self:
        """Reads and checks the cases of a file with a base. `start` is the time from which results count [s]; None is the end of the ramps."""
    def __len__(self) -> int:
        """Returns the number of cases."""
    def fingerprint(self) -> str:
        """Returns the fingerprint of the cases and of all files that they refer to."""
    def open(self, folder: str | os.PathLike[str], series: bool = False) -> list[int]:
        """Opens the folder of the sweep and returns the numbers of the cases that have not been completed there."""
    def close(self) -> None:
        """Closes the folder."""
    def run_case(self, number: int, folder: str | os.PathLike[str] | None = None) -> bytes:
        """Runs a case by its number and returns its row as bytes. `folder` is the folder of a sweep that stores time series."""
    def add(self, row: bytes) -> None:
        """Adds the row of a case that was run elsewhere."""
    def run(self, progress: Callable[[int, int], object] | None = None) -> None:
        """Runs the remaining cases on all cores and writes the table. Ctrl-C stops the sweep and leaves the table of the completed cases."""
    def table(self) -> Table:
        """Writes the table of the completed cases and returns it."""

@final
class MoorDyn:
    """A mooring with MoorDyn's interface, read from a deck."""

    def __new__(cls, path: str | os.PathLike[str]) -> Self:
        """Reads a deck."""
    def close(self) -> None:
        """Closes the system: all later calls are refused."""
    def degrees_of_freedom(self) -> int:
        """Returns the number of coupled degrees of freedom."""
    def counts(self) -> list[int]:
        """Returns the numbers of bodies, rods, points and lines."""
    def set_levels(self, *, console: int | None = None, file: int | None = None) -> None:
        """Sets the lowest levels of messages written to the console and to the file."""
    def set_log_file(self, path: str | os.PathLike[str]) -> None:
        """Writes messages to a file as well."""
    def write_log(self, level: int, message: str) -> None:
        """Writes a message at a level."""
    def start(self, x: Sequence[float], v: Sequence[float], is_approximate: bool = False) -> None:
        """Starts at coupled positions [m, rad] with velocities [m/s, rad/s]: in static equilibrium, or on catenaries if `is_approximate`."""
    def step(self, x: Sequence[float], v: Sequence[float], t: float, dt: float) -> list[float]:
        """Steps by dt [s] from time t [s] and returns the forces at the end of the step [N, N m]."""
    def scheme(self) -> tuple[float, float, str]:
        """Returns the internal time step [s], the Courant number [-] and the time scheme, as set by the deck or the script."""
    def set_scheme(self, *, dt: float | None = None, cfl: float | None = None, name: str | None = None) -> None:
        """Sets the upper limit of the internal time step [s], the Courant number [-] or the time scheme; the last two have no effect."""
    def to_bytes(self) -> bytes:
        """Returns the state as bytes."""
    def restore(self, data: bytes) -> None:
        """Restores a state."""
    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the state to a file."""
    def load(self, path: str | os.PathLike[str]) -> None:
        """Restores the state from a file."""
    def save_vtk(self, path: str | os.PathLike[str], line: int | None = None) -> None:
        """Writes the shape of all lines, or of one, for ParaView."""
    def break_line(self, point: int, line: int) -> None:
        """Detaches a line from a point."""
    def flow(self, place: Sequence[float]) -> tuple[list[float], list[float], float]:
        """Returns velocity [m/s] and acceleration [m/s²] of the water at a position, and the surface elevation there [m]."""
    def depth_at(self, x: float, y: float) -> float:
        """Returns the height of the seabed at a horizontal position [m], negative below the still water."""
    def depths(self) -> list[float]:
        """Returns the heights z of the seabed at its mean and at its least depth [m]."""
    def body(self, index: int, what: str) -> Any:
        """Returns a property of a body, by name."""
    def rod(self, index: int, what: str, node: int = 0) -> Any:
        """Returns a property of a rod, or of one of its nodes, by name."""
    def point(self, index: int, what: str) -> Any:
        """Returns a property of a point, by name; `ends` are the attached lines, each with its end at the point: 0 for A, 1 for B."""
    def line(self, index: int, what: str, node: int = 0) -> Any:
        """Returns a property of a line, or of one of its nodes, by name."""
    def set_line(self, index: int, *, unstretched_length: float | None = None, constant_stiffness: float | None = None) -> None:
        """Sets the unstretched length [m] or the axial stiffness [N] of a line; only before the start."""
