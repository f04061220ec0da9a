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
    """A mooring as the user described it. A scene does not change: methods return other scenes."""

    @staticmethod
    def load(path: str | os.PathLike[str], *, depth: float | None = None, vessel: str | None = None,
             positions: dict[str, tuple[float, float, float]] | None = None) -> Scene:
        """Reads a scene, or a deck of MoorDyn or MAP++. For a deck: depth of the water [m]; name of the one vessel that its coupled points
        ride on; reference positions of vessels by name [m]."""
    @staticmethod
    def from_toml(text: str, *, folder: str | os.PathLike[str] | None = None) -> Scene:
        """Reads a scene from TOML. The files that it names stand relative to the folder."""
    @staticmethod
    def from_dict(scene: dict[str, Any], *, folder: str | os.PathLike[str] | None = None) -> Scene:
        """Reads a scene from a dict with the keys of the scene format. Arrays and numbers of numpy are lists and numbers."""
    def to_toml(self) -> str:
        """The scene as TOML that needs no other file and is read back to the same numbers, bit for bit."""
    def to_dict(self) -> dict[str, Any]:
        """The scene as a dict, with the keys of `to_toml`."""
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
        """Remarks on a scene that can be used as it is."""
    def in_words(self) -> str:
        """What the scene models and what it does not, in sentences."""
    @property
    def parameters(self) -> dict[str, float]:
        """Parameters and their values, by the names of the FMU."""
    def with_parameters(self, values: dict[str, float]) -> Scene:
        """The scene with other values of some parameters, such as `chain.drag_normal`."""
    def with_motion(self, motion: Any = None, *, duration: float | None = None, interval: float | None = None) -> Scene:
        """The scene with the motion of columns, which lasts as long as they do; with another duration [s] or interval of rows [s]."""
    def discretised(self) -> Scene:
        """The scene with elements, integrator and step. Where they are left open, trials of about a second select them."""
    def statics(self) -> Statics:
        """Static equilibrium at rest, without waves."""
    def modes(self, count: int = 10) -> list[Mode]:
        """The lowest natural modes about the static equilibrium."""
    def __eq__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, tuple[str]]: ...

@final
class State:
    """All that changes in a simulation."""

    def to_bytes(self) -> bytes:
        """The state as bytes, which this version of moorline reads."""
    @staticmethod
    def from_bytes(data: bytes) -> State:
        """Reads the bytes of `to_bytes`."""
    def __reduce__(self) -> tuple[Any, tuple[bytes]]: ...

@final
class Simulation:
    """A mooring that a host steps in time.

    It starts in static equilibrium at the inputs of the start. Inputs are those at the present time; the path of a fairlead is continued
    smoothly from them over the next step.
    """

    def __new__(cls, scene: Scene, *, inputs: dict[str, float | None] | Sequence[float] | NDArray[np.float64] | None = None,
                start_time: float = 0.0, velocities: bool = False) -> Self:
        """Solves the static equilibrium. With `velocities`, arrays of inputs hold velocities too; otherwise these are derived."""
    @property
    def scene(self) -> Scene:
        """The scene, with its discretisation."""
    @property
    def time(self) -> float:
        """Time [s]."""
    @property
    def input_names(self) -> list[str]:
        """Names of the inputs in the order of an array."""
    @property
    def output_names(self) -> list[str]:
        """Names of the outputs in the order of an array."""
    @property
    def units(self) -> dict[str, str]:
        """Unit of every input, output and parameter."""
    def advance(self, inputs: dict[str, float | None] | Sequence[float] | NDArray[np.float64] | None, h: float) -> None:
        """Sets inputs, by names or as an array in the order of `input_names`, and steps from the present time to `h` [s] later. An input that
        is not named keeps its value; a velocity of None is derived from the displacements. Likely mistakes are warned of once."""
    def __getitem__(self, name: str, /) -> Any:
        """An input, output or parameter by name."""
    def outputs(self, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """All outputs in the order of `output_names`; written into `out` where that is given."""
    def derivatives(self, outputs: Sequence[str], inputs: Sequence[str]) -> NDArray[np.float64]:
        """Derivatives of outputs by inputs, displacements and velocities at the end of the last step: a row an output, a column an input. The
        scene asks for them with `derivatives = true` in `[output]`."""
    def rates(self, outputs: Sequence[str]) -> NDArray[np.float64]:
        """Rates of outputs in time, per second, at the end of the last step. The scene asks for them with `derivatives = true` in `[output]`."""
    def positions(self, line: str, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Positions of the nodes of a line from end A to end B [m], a row a node; written into `out` where that is given."""
    def velocities(self, line: str, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Velocities of the nodes of a line from end A to end B [m/s], a row a node; written into `out` where that is given."""
    def flow_places(self, line: str, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Places of the nodes of a line from end A to end B for which the flow of the water is due next [m], a row a node; written into `out` where
        that is given."""
    def set_flow(self, line: str, velocities: NDArray[np.float64], accelerations: NDArray[np.float64]) -> None:
        """Sets velocities [m/s] and accelerations [m/s²] of the water at these places, a row a node, for the coming steps."""
    def point(self, name: str) -> PointState:
        """Position, velocity and force of a point."""
    def end_forces(self, line: str) -> NDArray[np.float64]:
        """Forces of a line on its supports at end A and end B [N], a row an end."""
    def tensions(self, line: str) -> NDArray[np.float64]:
        """Effective tensions at the nodes of a line [N]; at the ends the size of the force."""
    def segment_tensions(self, line: str) -> NDArray[np.float64]:
        """Tensions of the segments next to the nodes of a line [N]: of one at an end, the mean of two between the ends, as in MoorDyn."""
    def save(self) -> State:
        """All that changes. A simulation that is restored to it continues to the same bits."""
    def restore(self, state: State) -> None:
        """Goes back to a saved state, of this or another simulation of the same scene."""
    def copy(self) -> Simulation:
        """A second simulation in the same state."""
    def __copy__(self) -> Simulation: ...
    def __deepcopy__(self, _memo: Any) -> Simulation: ...

def fmu(scene: Scene, path: str | os.PathLike[str], fmi: int = 2) -> None:
    """Packages a scene as an FMU of FMI 2.0 or 3.0."""

def run(scene: Scene, *, columns: Sequence[str] | None = None, shapes: float | None = None,
        progress: Callable[[int, int], object] | None = None) -> Table:
    """Runs a scene with its motion: see `moorline.run`."""

def batch(scenes: Sequence[Scene], *, columns: Sequence[str] | None = None, shapes: float | None = None, threads: int | None = None,
          progress: Callable[[int, int], object] | None = None) -> list[Table | Error]:
    """Runs scenes on several threads: see `moorline.batch`."""

def main(arguments: Sequence[str | os.PathLike[str]]) -> int:
    """Runs the program `moorline` with its arguments, of which the first is its name, and returns the exit code."""

@final
class Sweep:
    """The cases of a sweep, and once it is opened its folder."""

    def __new__(cls, base: str | os.PathLike[str], cases: str | os.PathLike[str], start: float | None = None) -> Self:
        """Reads and checks the cases of a file with a base. `start` is the time from which results count [s]; None is the end of the ramps."""
    def __len__(self) -> int:
        """Number of cases."""
    def fingerprint(self) -> str:
        """Fingerprint of the cases and of all files that they name."""
    def open(self, folder: str | os.PathLike[str], series: bool = False) -> list[int]:
        """Opens the folder of the sweep, and returns the numbers of the cases that have not ended there."""
    def close(self) -> None:
        """Closes the folder."""
    def run_case(self, number: int, folder: str | os.PathLike[str] | None = None) -> bytes:
        """Runs a case by its number and returns its row as bytes. `folder` is that of a sweep with series."""
    def add(self, row: bytes) -> None:
        """Keeps the row of a case that ended elsewhere."""
    def run(self, progress: Callable[[int, int], object] | None = None) -> None:
        """Runs the cases that are left on all cores, and writes the table. Ctrl-C ends it, with the table of the cases that have ended."""
    def table(self) -> Table:
        """Writes the table of the cases that have ended, and returns it."""

@final
class MoorDyn:
    """A mooring by MoorDyn's interface, read from a deck."""

    def __new__(cls, path: str | os.PathLike[str]) -> Self:
        """Reads a deck."""
    def close(self) -> None:
        """Ends its use: every later call is refused."""
    def degrees_of_freedom(self) -> int:
        """Number of coupled degrees of freedom."""
    def counts(self) -> list[int]:
        """Numbers of bodies, rods, points and lines."""
    def set_levels(self, *, console: int | None = None, file: int | None = None) -> None:
        """Least levels of the messages that the console, and the file, take."""
    def set_log_file(self, path: str | os.PathLike[str]) -> None:
        """Writes messages to a file too."""
    def write_log(self, level: int, message: str) -> None:
        """Writes a message of a level."""
    def start(self, x: Sequence[float], v: Sequence[float], is_approximate: bool = False) -> None:
        """Starts at coupled positions [m, rad] with velocities [m/s, rad/s]: in static equilibrium, or on catenaries."""
    def step(self, x: Sequence[float], v: Sequence[float], t: float, dt: float) -> list[float]:
        """Steps by dt [s] from time t [s], and returns the forces at the end [N, N m]."""
    def scheme(self) -> tuple[float, float, str]:
        """Internal step [s], Courant number [-] and time scheme, as the deck or the script gives them."""
    def set_scheme(self, *, dt: float | None = None, cfl: float | None = None, name: str | None = None) -> None:
        """Sets the upper limit of the internal step [s], the Courant number [-] or the time scheme; nothing follows from the last two."""
    def to_bytes(self) -> bytes:
        """The state as bytes."""
    def restore(self, data: bytes) -> None:
        """Goes back to a state."""
    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the state to a file."""
    def load(self, path: str | os.PathLike[str]) -> None:
        """Goes back to the state of a file."""
    def save_vtk(self, path: str | os.PathLike[str], line: int | None = None) -> None:
        """Writes the shape of all lines, or of one, for ParaView."""
    def break_line(self, point: int, line: int) -> None:
        """Breaks a line off a point."""
    def flow(self, place: Sequence[float]) -> tuple[list[float], list[float], float]:
        """Velocity [m/s] and acceleration [m/s²] of the water at a place, and elevation of the surface there [m]."""
    def depth_at(self, x: float, y: float) -> float:
        """Depth of the seabed at a place [m]."""
    def depths(self) -> list[float]:
        """Mean and least depth of the seabed [m]."""
    def body(self, index: int, what: str) -> Any:
        """A value of a body, by name."""
    def rod(self, index: int, what: str, node: int = 0) -> Any:
        """A value of a rod, or of one of its nodes, by name."""
    def point(self, index: int, what: str) -> Any:
        """A value of a point, by name; `ends` are the lines there, each with its end: 0 is A, 1 is B."""
    def line(self, index: int, what: str, node: int = 0) -> Any:
        """A value of a line, or of one of its nodes, by name."""
    def set_line(self, index: int, *, unstretched_length: float | None = None, constant_stiffness: float | None = None) -> None:
        """Sets the unstretched length [m] or the axial stiffness [N] of a line, before the start only."""
