"""Functions of MoorDyn's Python package over moorline: `from moorline import moordyn` in place of `import moordyn`.

    system = moordyn.Create("lines.txt")
    moordyn.Init(system, x, v)
    forces = moordyn.Step(system, x, v, t, dt)
    moordyn.Close(system)

Positions and velocities are those of the coupled bodies (six numbers each) and then of the coupled points (three each), in the order of the
deck; angles are MoorDyn's, R = Rx·Ry·Rz. Positions hold for the start of a step and velocities over all of it; forces are those at its end.
Laws and forces are MoorDyn's too, unless the environment variables of docs/moordyn.md choose others. Objects count from 1, nodes from 0 at
end A. Functions for things that moorline does not model raise NotImplementedError; other mistakes raise the errors of moorline.
"""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from moorline._moorline import MoorDyn
from moorline.errors import InputError

Vector = tuple[float, ...]
Matrix = list[list[float]]

SUCCESS = 0
BODY, ROD, POINT, LINE = range(4)
KINDS = ("body", "rod", "point", "line")


class _Object(NamedTuple):
    system: MoorDyn
    place: int


class Body(_Object):
    """A body."""


class Rod(_Object):
    """A rod."""


class Point(_Object):
    """A point."""


class Line(_Object):
    """A line."""


def _place(system: MoorDyn, kind: int, number: int) -> int:
    count = system.counts()[kind]
    if not 1 <= number <= count:
        raise InputError(f"{KINDS[kind]} {number}: there are {count}, counted from 1", place=KINDS[kind])
    return number - 1


def Create(filepath: str = "") -> MoorDyn:
    """Reads a deck, by default Mooring/lines.txt."""
    return MoorDyn(filepath or "Mooring/lines.txt")


def NCoupledDOF(instance: MoorDyn) -> int:
    """Number of coupled degrees of freedom."""
    return instance.degrees_of_freedom()


def SetVerbosity(instance: MoorDyn, verbosity: int) -> int:
    """Sets the least level of the messages on the console."""
    instance.set_levels(console=verbosity)
    return SUCCESS


def SetLogLevel(instance: MoorDyn, verbosity: int) -> int:
    """Sets the least level of the messages in the file."""
    instance.set_levels(file=verbosity)
    return SUCCESS


def SetLogFile(instance: MoorDyn, filepath: str) -> int:
    """Writes the messages to a file too."""
    instance.set_log_file(filepath)
    return SUCCESS


def Log(instance: MoorDyn, level: int, msg: str) -> int:
    """Writes a message to the log."""
    instance.write_log(level, msg)
    return SUCCESS


def Init(instance: MoorDyn, x: Sequence[float], v: Sequence[float]) -> int:
    """Solves the static equilibrium at the positions given."""
    instance.start(list(x), list(v))
    return SUCCESS


def Init_NoIC(instance: MoorDyn, x: Sequence[float], v: Sequence[float]) -> int:
    """Starts on catenaries, without an equilibrium."""
    instance.start(list(x), list(v), True)
    return SUCCESS


def Step(instance: MoorDyn, x: Sequence[float], v: Sequence[float], t: float, dt: float) -> Vector:
    """Steps by dt [s] and returns the forces at the end; positions are those of the start, velocities those of the whole step."""
    return tuple(instance.step(list(x), list(v), t, dt))


def Close(instance: MoorDyn) -> int:
    """Ends the use of a system."""
    instance.close()
    return SUCCESS


def GetDt(instance: MoorDyn) -> float:
    """Internal step of the deck or the script [s]."""
    return instance.scheme()[0]


def SetDt(instance: MoorDyn, dt: float) -> int:
    """Sets the upper limit of the internal step [s]."""
    instance.set_scheme(dt=dt)
    return SUCCESS


def GetCFL(instance: MoorDyn) -> float:
    """Courant number of the deck or the script [-]; nothing follows from it."""
    return instance.scheme()[1]


def SetCFL(instance: MoorDyn, cfl: float) -> int:
    """Keeps a Courant number [-]."""
    instance.set_scheme(cfl=cfl)
    return SUCCESS


def GetTimeScheme(instance: MoorDyn) -> str:
    """Name of the time scheme of the deck or the script; nothing follows from it."""
    return instance.scheme()[2]


def SetTimeScheme(instance: MoorDyn, name: str) -> int:
    """Keeps the name of a time scheme."""
    instance.set_scheme(name=name)
    return SUCCESS


def Serialize(instance: MoorDyn) -> bytes:
    """The state as bytes."""
    return instance.to_bytes()


def Deserialize(instance: MoorDyn, data: bytes) -> None:
    """Goes back to a state of `Serialize`."""
    instance.restore(bytes(data))


def Save(instance: MoorDyn, filepath: str) -> None:
    """Writes the state to a file."""
    instance.save(filepath)


def Load(instance: MoorDyn, filepath: str) -> None:
    """Goes back to the state of a file of `Save`."""
    instance.load(filepath)


SaveState, LoadState = Save, Load


def SaveVTK(instance: MoorDyn, filename: str) -> int:
    """Writes the shapes of all lines for ParaView."""
    instance.save_vtk(filename)
    return SUCCESS


def BreakLine(instance: MoorDyn, point: int, line: int) -> int:
    """Breaks a line off a point, from the next step on."""
    instance.break_line(_place(instance, POINT, point), _place(instance, LINE, line))
    return SUCCESS


def GetFASTtens(instance: MoorDyn, n_lines: int) -> tuple[Vector, Vector, Vector, Vector]:
    """Horizontal and vertical forces at the fairleads, and at the anchors, of the first lines [N]."""
    places = [_place(instance, LINE, number) for number in range(1, n_lines + 1)]
    forces = [instance.line(place, "end_tensions") for place in places]
    fair_h, fair_v, anchor_h, anchor_v = (tuple(force[i] for force in forces) for i in range(4))
    return fair_h, fair_v, anchor_h, anchor_v


def GetWaves(instance: MoorDyn) -> MoorDyn:
    """The water, for `GetWavesKin`."""
    return instance


def GetWavesKin(instance: MoorDyn, x: float, y: float, z: float, seafloor: Any = None) -> tuple[Vector, Vector, float]:
    """Velocity [m/s] and acceleration [m/s²] of the water at a place, and elevation of the surface there [m]."""
    velocity, acceleration, elevation = instance.flow((x, y, z))
    return tuple(velocity), tuple(acceleration), elevation


def GetSeafloor(instance: MoorDyn) -> MoorDyn:
    """The seabed, for `GetDepthAt` and its like."""
    return instance


def GetDepthAt(instance: MoorDyn, x: float, y: float) -> float:
    """Height z of the seabed at a place [m], negative below still water."""
    return instance.depth_at(x, y)


def GetAverageDepth(instance: MoorDyn) -> float:
    """Mean height z of the seabed [m]."""
    return instance.depths()[0]


def GetMinDepth(instance: MoorDyn) -> float:
    """Height z of the seabed where it is shallowest [m]."""
    return instance.depths()[1]


def GetNumberBodies(instance: MoorDyn) -> int:
    """Number of bodies."""
    return instance.counts()[BODY]


def GetNumberRods(instance: MoorDyn) -> int:
    """Number of rods."""
    return instance.counts()[ROD]


def GetNumberPoints(instance: MoorDyn) -> int:
    """Number of points."""
    return instance.counts()[POINT]


def GetNumberLines(instance: MoorDyn) -> int:
    """Number of lines."""
    return instance.counts()[LINE]


def GetBody(instance: MoorDyn, body: int) -> Body:
    """A body, counted from 1."""
    return Body(instance, _place(instance, BODY, body))


def GetRod(instance: MoorDyn, rod: int) -> Rod:
    """A rod, counted from 1."""
    return Rod(instance, _place(instance, ROD, rod))


def GetPoint(instance: MoorDyn, point: int) -> Point:
    """A point, counted from 1."""
    return Point(instance, _place(instance, POINT, point))


def GetLine(instance: MoorDyn, line: int) -> Line:
    """A line, counted from 1."""
    return Line(instance, _place(instance, LINE, line))


def GetPointNAttached(instance: Point) -> int:
    """Number of line ends at a point."""
    return len(instance.system.point(instance.place, "ends"))


def GetPointAttached(instance: Point, i: int) -> tuple[Line, int]:
    """A line at a point, and its end there: 0 is A, 1 is B."""
    line, end = instance.system.point(instance.place, "ends")[i]
    return Line(instance.system, line), end


def SetLineUnstretchedLength(instance: Line, l: float) -> int:
    """Sets the unstretched length of a line [m], before `Init` only."""
    instance.system.set_line(instance.place, unstretched_length=l)
    return SUCCESS


def SetLineConstantEA(instance: Line, ea: float) -> int:
    """Sets the axial stiffness of a line [N], before `Init` only."""
    instance.system.set_line(instance.place, constant_stiffness=ea)
    return SUCCESS


def SaveLineVTK(instance: Line, filename: str) -> int:
    """Writes the shape of a line for ParaView."""
    instance.system.save_vtk(filename, instance.place)
    return SUCCESS


def GetRodNumberNodes(instance: Rod) -> int:
    """Number of nodes of a rod."""
    return int(instance.system.rod(instance.place, "segments")) + 1


def GetLineNumberNodes(instance: Line) -> int:
    """Number of nodes of a line."""
    return int(instance.system.line(instance.place, "segments")) + 1


# Functions that read one value of an object: kind, value, part of it, description.
_READ: dict[str, tuple[str, str, slice | None, str]] = {
    "GetBodyID": ("body", "number", None, "Number of a body in the deck."),
    "GetBodyType": ("body", "type", None, "Kind of a body: -1 coupled, 0 free, 1 fixed."),
    "GetBodyPos": ("body", "place", slice(0, 3), "Position of a body [m]."),
    "GetBodyAngle": ("body", "place", slice(3, 6), "Angles of a body [rad]."),
    "GetBodyVel": ("body", "rate", slice(0, 3), "Velocity of a body [m/s]."),
    "GetBodyAngVel": ("body", "rate", slice(3, 6), "Angular velocity of a body [rad/s]."),
    "GetBodyForce": ("body", "force", None, "Force [N] and moment [N m] on a coupled body."),
    "GetBodyM": ("body", "mass", None, "Mass matrix of the end nodes that a coupled body carries [kg, kg m, kg m²]."),
    "GetRodID": ("rod", "number", None, "Number of a rod in the deck."),
    "GetRodN": ("rod", "segments", None, "Number of segments of a rod."),
    "GetPointID": ("point", "number", None, "Number of a point in the deck."),
    "GetPointType": ("point", "type", None, "Kind of a point: -1 coupled, 0 free, 1 fixed."),
    "GetPointPos": ("point", "position", None, "Position of a point [m]."),
    "GetPointVel": ("point", "velocity", None, "Velocity of a point [m/s]."),
    "GetPointForce": ("point", "force", None, "Force on a point [N]."),
    "GetPointM": ("point", "mass", None, "Mass matrix of a point with its end nodes [kg]."),
    "GetLineID": ("line", "number", None, "Number of a line in the deck."),
    "GetLineN": ("line", "segments", None, "Number of segments of a line."),
    "GetLineUnstretchedLength": ("line", "unstretched_length", None, "Unstretched length of a line [m]."),
    "IsLineConstantEA": ("line", "has_constant_stiffness", None, "True if a line has one constant axial stiffness."),
    "GetLineConstantEA": ("line", "constant_stiffness", None, "Axial stiffness of a line [N]."),
    "GetLineFairTen": ("line", "fairlead_tension", None, "Tension of a line at end B [N]."),
    "GetLineMaxTen": ("line", "greatest_tension", None, "Greatest tension along a line [N]."),
}
# Functions that read a value of a node: kind, value, description.
_READ_NODE: dict[str, tuple[str, str, str]] = {
    "GetRodNodePos": ("rod", "position", "Position of a node of a rod [m]."),
    "GetRodNodeVel": ("rod", "velocity", "Velocity of a node of a rod [m/s]."),
    "GetLineNodePos": ("line", "position", "Position of a node [m]."),
    "GetLineNodeVel": ("line", "velocity", "Velocity of a node [m/s]."),
    "GetLineNodeForce": ("line", "force", "Sum of all forces on a node but inertia [N]."),
    "GetLineNodeTen": ("line", "tension", "Tension at a node, towards end B [N]."),
    "GetLineNodeBendStiff": ("line", "bending", "Force of bending stiffness on a node [N]."),
    "GetLineNodeWeight": ("line", "weight", "Weight less buoyancy of a node [N]."),
    "GetLineNodeDrag": ("line", "drag", "Drag on a node [N]."),
    "GetLineNodeFroudeKrilov": ("line", "froude_krylov", "Force of the accelerated water on a node [N]."),
    "GetLineNodeSeabedForce": ("line", "seabed", "Force of the seabed on a node [N]."),
    "GetLineNodeCurv": ("line", "curvature", "Curvature at a node [1/m]."),
    "GetLineNodeM": ("line", "mass", "Mass matrix of a node with its added mass [kg]."),
}
_WATER = "water that a host gives is not modelled; waves and currents belong to the deck"
_RODS = "rods are not modelled"
_PRESSURE = "bending by the pressure inside a line is not modelled"
REFUSED = {
    **dict.fromkeys(["ExternalWaveKinInit", "ExternalWaveKinGetN", "ExternalWaveKinGetCoordinates", "GetWaveKinCoordinates",
                     "ExternalWaveKinSet", "SetWaveKin"], _WATER),
    **dict.fromkeys(["GetRodType", "GetRodForce", "GetRodM"], _RODS),
    **dict.fromkeys(["IsLinePressBend", "SetLinePressBend", "SetLinePressInt"], _PRESSURE),
    **dict.fromkeys(["SaveBodyVTK", "UseBodyVTK", "SaveRodVTK", "SavePointVTK"], "bodies, rods and points have no shape"),
    "SetLineUnstretchedLengthVel": "lines that are paid out or hauled in are not driven through this interface: a scene has winches",
}


def _tidy(value: Any, part: slice | None = None) -> Any:
    """Vectors are tuples; matrices and numbers stay what they are."""
    is_vector = isinstance(value, list) and not isinstance(value[0], list)
    return tuple(value[part] if part else value) if is_vector else value


def _named(function: Callable[..., Any], name: str, description: str) -> Callable[..., Any]:
    function.__name__ = function.__qualname__ = name
    function.__doc__ = description
    return function


def _reader(kind: str, what: str, part: slice | None) -> Callable[..., Any]:
    return lambda instance: _tidy(getattr(instance.system, kind)(instance.place, what), part)


def _node_reader(kind: str, what: str) -> Callable[..., Any]:
    return lambda instance, i: _tidy(getattr(instance.system, kind)(instance.place, what, i))


def _refusal(name: str, reason: str) -> Callable[..., Any]:
    def refuse(*_: Any) -> Any:
        raise NotImplementedError(f"moorline.moordyn has no {name}: {reason}")

    return refuse


def GetBodyState(instance: Body) -> tuple[Vector, Vector]:
    """Position [m] and angles [rad] of a body, and their rates [m/s, rad/s]."""
    return _tidy(instance.system.body(instance.place, "place")), _tidy(instance.system.body(instance.place, "rate"))


for _name, (_kind, _what, _part, _text) in _READ.items():
    globals()[_name] = _named(_reader(_kind, _what, _part), _name, _text)
for _name, (_kind, _what, _text) in _READ_NODE.items():
    globals()[_name] = _named(_node_reader(_kind, _what), _name, _text)
for _name, _text in REFUSED.items():
    globals()[_name] = _named(_refusal(_name, _text), _name, f"Not in moorline: {_text}.")

if TYPE_CHECKING:

    def __getattr__(name: str) -> Callable[..., Any]: ...
