"""Functions of MoorDyn's Python package over moorline: `from moorline import moordyn` in place of `import moordyn`.

    system = moordyn.Create("lines.txt")
    moordyn.Init(system, x, v)
    forces = moordyn.Step(system, x, v, t, dt)
    moordyn.Close(system)

Positions and velocities are those of the coupled bodies (six numbers each) and then of the coupled points (three each), in the order of the
deck; angles are MoorDyn's, R = Rx·Ry·Rz. Positions hold for the start of a step and velocities over all of it; forces are those at its end,
where the points have moved on by velocity times step. Points move smoothly from one such place to the next. Contact and the law of slack
lines are MoorDyn's too. Forces are the reaction at the coupled points: with the inertia of the half segments there, which MoorDyn leaves
out. Functions for things that moorline does not model raise NotImplementedError. Messages go to the logger `moorline.moordyn`.
"""

import logging
import math
import pathlib
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from moorline._moorline import Scene, Simulation, State
from moorline.errors import InputError

Array = NDArray[np.float64]
Vector = tuple[float, float, float]

SUCCESS = 0
LOG = logging.getLogger("moorline.moordyn")


class System:
    """A mooring by MoorDyn's interface."""

    def __init__(self, path: str) -> None:
        read = Scene.load(path)
        described = with_laws(read.to_dict())
        self.scene: Scene = Scene.from_dict(described)
        self.vessels: list[dict[str, Any]] = described.get("vessels", [])
        self.points: list[dict[str, Any]] = described["points"]
        self.lines: list[dict[str, Any]] = described["lines"]
        self.coupled = [point for point in self.points if point["kind"] == "coupled" and "on" not in point]
        self.simulation: Simulation | None = None
        for note in read.notes:
            if "negative_tension" not in note:  # the law is MoorDyn's here
                LOG.warning("%s", note)

    @property
    def freedom(self) -> int:
        """Number of coupled degrees of freedom."""
        return 6 * len(self.vessels) + 3 * len(self.coupled)

    def inputs(self, x: Sequence[float], v: Sequence[float], dt: float) -> dict[str, float | None]:
        """Inputs of moorline at the end of a step [s] of constant velocities: displacements from the reference, angles Z-Y-X."""
        for name, given in (("x", x), ("v", v)):
            if len(given) != self.freedom:
                raise InputError(f"{name}: {len(given)} numbers, but there are {self.freedom} coupled degrees of freedom", place=name)
        inputs: dict[str, float | None] = {}
        place, way = np.array(x, dtype=float), dt * np.array(v, dtype=float)
        at = 0
        for vessel in self.vessels:
            origin = place[at : at + 3] + way[at : at + 3] - vessel.get("position", [0.0] * 3)
            turned = np.asarray(turn(way[at + 3 : at + 6]) @ rotation(place[at + 3 : at + 6]))
            angles = tait_bryan(turned) - vessel.get("attitude", [0.0] * 3)
            names = [f"{vessel['name']}.{axis}" for axis in ("x", "y", "z", "roll", "pitch", "yaw")]
            inputs.update(zip(names, map(float, [*origin, *angles])))
            at += 6
        for point in self.coupled:
            names = [f"{point['name']}.{axis}" for axis in ("x", "y", "z")]
            inputs.update(zip(names, map(float, place[at : at + 3] + way[at : at + 3] - point["position"])))
            at += 3
        return inputs

    @property
    def started(self) -> Simulation:
        """The simulation of an initialised system."""
        if self.simulation is None:
            raise InputError("the system is not initialised, or it is closed: call Init first", place="system")
        return self.simulation

    def forces(self) -> list[float]:
        """Forces and moments on the coupled bodies and points [N, N m]."""
        on_bodies = [f"{vessel['name']}.{axis}" for vessel in self.vessels for axis in ("fx", "fy", "fz", "mx", "my", "mz")]
        on_points = [f"{point['name']}.{axis}" for point in self.coupled for axis in ("fx", "fy", "fz")]
        return [self.started[name] for name in on_bodies + on_points]


class Body(NamedTuple):
    """A coupled body."""

    system: System
    """The system."""
    place: int
    """Place in the order of the deck, from 0."""


class Point(NamedTuple):
    """A point."""

    system: System
    """The system."""
    place: int
    """Place in the order of the deck, from 0."""


class Line(NamedTuple):
    """A line."""

    system: System
    """The system."""
    place: int
    """Place in the order of the deck, from 0."""

    @property
    def name(self) -> str:
        """Name of the line."""
        return str(self.system.lines[self.place]["name"])


def with_laws(scene: dict[str, Any]) -> dict[str, Any]:
    """The scene with MoorDyn's contact, its law of slack lines and its meaning of inputs, which lead to the end of a step."""
    if "seabed" in scene:
        scene["seabed"]["contact"] = "as_given"
    scene.setdefault("solver", {}).update(negative_tension=True, input_reconstruction="interpolate")
    return scene


def rotation(angles: Sequence[float] | Array) -> Array:
    """Rotation matrix of MoorDyn's angles [rad]."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles), np.sin(angles)
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
    about_y = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    about_z = np.array([[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(about_x @ about_y @ about_z)


def turn(way: Array) -> Array:
    """Rotation matrix of a turn about an axis, as a vector [rad]."""
    angle = float(np.linalg.norm(way))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = way / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * np.asarray(cross @ cross)


def tait_bryan(matrix: Array) -> Array:
    """Roll, pitch and yaw of a rotation matrix, R = Rz·Ry·Rx [rad]."""
    roll = np.arctan2(matrix[2, 1], matrix[2, 2])
    pitch = np.arcsin(np.clip(-matrix[2, 0], -1.0, 1.0))
    yaw = np.arctan2(matrix[1, 0], matrix[0, 0])
    return np.array([roll, pitch, yaw])


def Create(filepath: str = "") -> System:
    """Reads a deck, by default Mooring/lines.txt."""
    return System(filepath or "Mooring/lines.txt")


def NCoupledDOF(instance: System) -> int:
    """Number of coupled degrees of freedom."""
    return instance.freedom


def SetVerbosity(instance: System, verbosity: int) -> int:
    """Accepted: the level of the logger `moorline.moordyn` decides."""
    return SUCCESS


SetLogLevel = SetVerbosity


def SetLogFile(instance: System, filepath: str) -> int:
    """Writes the messages to a file too."""
    LOG.addHandler(logging.FileHandler(filepath))
    return SUCCESS


def Log(instance: System, level: int, msg: str) -> int:
    """Writes a message to the log."""
    LOG.log(logging.INFO, "%s", msg)
    return SUCCESS


def Init(instance: System, x: Sequence[float], v: Sequence[float]) -> int:
    """Solves the static equilibrium at the positions given."""
    instance.simulation = Simulation(instance.scene, inputs=instance.inputs(x, v, 0.0))
    return SUCCESS


Init_NoIC = Init


def Step(instance: System, x: Sequence[float], v: Sequence[float], t: float, dt: float) -> list[float]:
    """Steps by dt [s] and returns the forces at the end; positions are those of the start, velocities those of the whole step."""
    instance.started.advance(instance.inputs(x, v, dt), dt)
    return instance.forces()


def Close(instance: System) -> int:
    """Ends the use of a system."""
    instance.simulation = None
    return SUCCESS


def Serialize(instance: System) -> bytes:
    """The state as bytes."""
    return instance.started.save().to_bytes()


def Deserialize(instance: System, data: bytes) -> None:
    """Goes back to a state of `Serialize`."""
    instance.started.restore(State.from_bytes(bytes(data)))


def Save(instance: System, filepath: str) -> None:
    """Writes the state to a file."""
    pathlib.Path(filepath).write_bytes(Serialize(instance))


def Load(instance: System, filepath: str) -> None:
    """Goes back to the state of a file of `Save`."""
    Deserialize(instance, pathlib.Path(filepath).read_bytes())


SaveState, LoadState = Save, Load


def _numbered(found: list[Any], number: int, kind: str) -> int:
    if not 1 <= number <= len(found):
        raise InputError(f"{kind} {number}: there are {len(found)}, counted from 1", place=kind)
    return number - 1


def GetNumberBodies(instance: System) -> int:
    """Number of bodies."""
    return len(instance.vessels)


def GetBody(instance: System, body: int) -> Body:
    """A body, counted from 1."""
    return Body(instance, _numbered(instance.vessels, body, "body"))


def GetNumberRods(instance: System) -> int:
    """Number of rods: moorline has none."""
    return 0


def GetNumberPoints(instance: System) -> int:
    """Number of points."""
    return len(instance.points)


def GetPoint(instance: System, point: int) -> Point:
    """A point, counted from 1."""
    return Point(instance, _numbered(instance.points, point, "point"))


def GetNumberLines(instance: System) -> int:
    """Number of lines."""
    return len(instance.lines)


def GetLine(instance: System, line: int) -> Line:
    """A line, counted from 1."""
    return Line(instance, _numbered(instance.lines, line, "line"))


def GetFASTtens(instance: System, n_lines: int) -> tuple[list[float], list[float], list[float], list[float]]:
    """Horizontal and vertical tensions at the fairleads, and at the anchors, of the first lines [N]."""
    lines = [instance.lines[_numbered(instance.lines, number, "line")]["name"] for number in range(1, n_lines + 1)]
    forces = np.array([instance.started.end_forces(name) for name in lines]).reshape(-1, 2, 3)
    horizontal, vertical = np.hypot(forces[..., 0], forces[..., 1]), np.abs(forces[..., 2])
    return horizontal[:, 1].tolist(), vertical[:, 1].tolist(), horizontal[:, 0].tolist(), vertical[:, 0].tolist()


def GetBodyID(instance: Body) -> int:
    """Number of a body, from 1."""
    return instance.place + 1


def GetBodyForce(instance: Body) -> tuple[float, ...]:
    """Force and moment of the mooring on a body [N, N m]."""
    at = 6 * instance.place
    return tuple(instance.system.forces()[at : at + 6])


def GetPointID(instance: Point) -> int:
    """Number of a point, from 1."""
    return instance.place + 1


def _state(instance: Point) -> Any:
    return instance.system.started.point(instance.system.points[instance.place]["name"])


def _vector(numbers: Array) -> Vector:
    x, y, z = map(float, numbers)
    return x, y, z


def GetPointPos(instance: Point) -> Vector:
    """Position of a point [m]."""
    return _vector(_state(instance).position)


def GetPointVel(instance: Point) -> Vector:
    """Velocity of a point [m/s]."""
    return _vector(_state(instance).velocity)


def GetPointForce(instance: Point) -> Vector:
    """Force of the lines on a point [N]."""
    return _vector(_state(instance).force)


def _attached(instance: Point) -> list[tuple[int, int]]:
    name, lines = instance.system.points[instance.place]["name"], instance.system.lines
    return [(line, end) for line, of in enumerate(lines) for end, key in enumerate(("from", "to")) if of[key] == name]


def GetPointNAttached(instance: Point) -> int:
    """Number of line ends at a point."""
    return len(_attached(instance))


def GetPointAttached(instance: Point, i: int) -> tuple[Line, int]:
    """A line at a point, and its end there: 0 is A, 1 is B."""
    line, end = _attached(instance)[i]
    return Line(instance.system, line), end


def GetLineID(instance: Line) -> int:
    """Number of a line, from 1."""
    return instance.place + 1


def GetLineN(instance: Line) -> int:
    """Number of segments of a line: that of moorline's mesh."""
    return GetLineNumberNodes(instance) - 1


def GetLineNumberNodes(instance: Line) -> int:
    """Number of nodes of a line."""
    return len(instance.system.started.tensions(instance.name))


def GetLineUnstretchedLength(instance: Line) -> float:
    """Unstretched length of a line [m]."""
    return float(sum(section["length"] for section in instance.system.lines[instance.place]["sections"]))


def GetLineNodePos(instance: Line, i: int) -> Vector:
    """Position of a node [m]."""
    return _vector(instance.system.started.positions(instance.name)[i])


def GetLineNodeVel(instance: Line, i: int) -> Vector:
    """Velocity of a node [m/s]."""
    return _vector(instance.system.started.velocities(instance.name)[i])


def GetLineNodeTen(instance: Line, i: int) -> Vector:
    """Tension at a node, of the segments beside it, along the line there towards end B [N]."""
    nodes = instance.system.started.positions(instance.name)
    along = nodes[min(i + 1, len(nodes) - 1)] - nodes[max(i - 1, 0)]
    return _vector(instance.system.started.segment_tensions(instance.name)[i] * along / np.linalg.norm(along))


def GetLineFairTen(instance: Line) -> float:
    """Tension of the last segment of a line, at end B [N]."""
    return float(instance.system.started.segment_tensions(instance.name)[-1])


def GetLineMaxTen(instance: Line) -> float:
    """Greatest tension along a line [N]."""
    return float(instance.system.started[f"{instance.name}.tension_max"])


def _refusal(name: str) -> Callable[..., Any]:
    def refuse(*_: Any) -> Any:
        raise NotImplementedError(f"moorline.moordyn has no {name}: {REFUSED[name]}")

    refuse.__name__ = refuse.__qualname__ = name
    refuse.__doc__ = f"Not in moorline: {REFUSED[name]}."
    return refuse


_WAVES = "water that a host gives is not modelled; waves and currents belong to the deck or the scene"
_STEPS = "solver.tolerance and solver.time_step_max of a scene set the steps"
_RODS = "rods are not modelled"
_PARTS = "moorline does not hold the parts of a node's force"
_VTK = "`moorline run` writes shapes for ParaView"
_LINES = "properties of a line belong to the scene: Scene.with_parameters gives another one"
REFUSED = {
    **dict.fromkeys(["GetWaves", "GetWavesKin", "ExternalWaveKinInit", "ExternalWaveKinGetN", "ExternalWaveKinGetCoordinates",
                     "GetWaveKinCoordinates", "ExternalWaveKinSet", "SetWaveKin"], _WAVES),
    **dict.fromkeys(["GetDt", "SetDt", "GetCFL", "SetCFL", "GetTimeScheme", "SetTimeScheme"], _STEPS),
    **dict.fromkeys(["GetRod", "GetRodID", "GetRodType", "GetRodForce", "GetRodM", "GetRodN", "GetRodNumberNodes", "GetRodNodePos",
                     "GetRodNodeVel"], _RODS),
    **dict.fromkeys(["GetLineNodeForce", "GetLineNodeBendStiff", "GetLineNodeWeight", "GetLineNodeDrag", "GetLineNodeFroudeKrilov",
                     "GetLineNodeSeabedForce", "GetLineNodeCurv", "GetLineNodeM", "GetPointM", "GetBodyM"], _PARTS),
    **dict.fromkeys(["SaveVTK", "SaveBodyVTK", "UseBodyVTK", "SaveRodVTK", "SavePointVTK", "SaveLineVTK"], _VTK),
    **dict.fromkeys(["SetLineUnstretchedLength", "SetLineUnstretchedLengthVel", "IsLineConstantEA", "GetLineConstantEA",
                     "SetLineConstantEA", "IsLinePressBend", "SetLinePressBend", "SetLinePressInt"], _LINES),
    **dict.fromkeys(["GetSeafloor", "GetDepthAt", "GetAverageDepth", "GetMinDepth"], "the seabed is that of the scene"),
    **dict.fromkeys(["GetBodyType", "GetPointType"], "types are words in moorline: see the scene's points and vessels"),
    **dict.fromkeys(["GetBodyState", "GetBodyPos", "GetBodyAngle", "GetBodyVel", "GetBodyAngVel"], "the motion of a body is an input"),
    "BreakLine": "`release` in the scene declares a line that may be released, and is then an input of Simulation",
}
globals().update({name: _refusal(name) for name in REFUSED})
