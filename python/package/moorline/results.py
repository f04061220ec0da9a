"""Results as named tuples and arrays. The names are those of `moorline statics --json` and `moorline modes --json`."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, SupportsIndex, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from moorline._moorline import Scene

Array = NDArray[np.float64]
Item = TypeVar("Item")


class Named(tuple[Item, ...], Generic[Item]):
    """Items with names: `lines["line1"]` is `lines[0]` where that is its name."""

    @property
    def names(self) -> list[str]:
        """Names of the items, in their order."""
        return [item.name for item in self]  # type: ignore[attr-defined]

    @overload
    def __getitem__(self, key: str) -> Item: ...
    @overload
    def __getitem__(self, key: SupportsIndex) -> Item: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[Item, ...]: ...
    def __getitem__(self, key: Any) -> Any:
        if not isinstance(key, str):
            return super().__getitem__(key)
        for item in self:
            if item.name == key:  # type: ignore[attr-defined]
                return item
        raise KeyError(f"{key}: there are {', '.join(self.names)}")


class End(NamedTuple):
    """An end of a line."""

    force: Array
    """Force of the line on the support of this end [N]."""
    tension: float
    """Size of that force [N]."""


class Catenary(NamedTuple):
    """The closed-form elastic catenary of a line."""

    tension_a: float
    """Axial tension at end A [N]."""
    tension_b: float
    """Axial tension at end B [N]."""
    horizontal: float
    """Horizontal part of the force at end B [N]."""
    vertical: float
    """Pull on end B downwards [N]."""
    laid_length: float
    """Unstretched length on the seabed [m]."""
    sag: float
    """Greatest vertical distance below the chord [m]."""


class Profile(NamedTuple):
    """Nodes of a line from end A to end B."""

    s: Array
    """Unstretched arc length from end A [m]."""
    x: Array
    """Position along x [m]."""
    y: Array
    """Position along y [m]."""
    z: Array
    """Height above still water [m]."""
    tension: Array
    """Effective tension [N]."""
    curvature: Array | None
    """Curvature [1/m]; None without bending stiffness."""
    moment: Array | None
    """Bending moment [N m]; None without bending stiffness."""


class Line(NamedTuple):
    """A line in equilibrium."""

    name: str
    """Name of the line."""
    end_a: End
    """End A, the anchor."""
    end_b: End
    """End B, the fairlead."""
    horizontal: float
    """Horizontal part of the force at end B [N]."""
    vertical: float
    """Pull on end B downwards [N]."""
    laid_length: float
    """Unstretched length on the seabed [m]."""
    stretched_length: float
    """Length under tension [m]."""
    sag: float
    """Greatest vertical distance below the chord [m]."""
    catenary: Catenary | None
    """Closed form of the line, where it has one."""
    profile: Profile
    """Nodes from end A to end B."""


class Point(NamedTuple):
    """A point in equilibrium."""

    name: str
    """Name of the point."""
    kind: str
    """fixed, coupled, prescribed or free."""
    position: Array
    """Position [m]."""
    force: Array
    """Force of all lines on the point [N]."""


class PointState(NamedTuple):
    """A point of a simulation now."""

    position: Array
    """Position [m]."""
    velocity: Array
    """Velocity [m/s]."""
    force: Array
    """Force of all lines, and of the mass and volume of the point, on its support [N]; without the inertia of the line ends and of the point where
    the scene has `force = "without_inertia"`."""


class Hold(NamedTuple):
    """Force and stiffness of the mooring on a vessel."""

    force: Array
    """Force [N] and moment [N m] about the vessel's origin."""
    stiffness: Array | None
    """6×6 stiffness [N/m, N/rad, N, N m/rad]: minus the change of force with displacement and rotation; None with beams."""


class Vessel(NamedTuple):
    """A vessel in equilibrium."""

    name: str
    """Name of the vessel."""
    force: Array
    """Force [N] and moment [N m] about the vessel's origin, from closed-form catenaries where the lines have them."""
    stiffness: Array | None
    """6×6 stiffness [N/m, N/rad, N, N m/rad], from closed-form catenaries where the lines have them; None with beams."""
    elements: Hold
    """The same from the elements of all lines."""


class Statics(NamedTuple):
    """A static equilibrium."""

    title: str
    """Title of the scene."""
    lines: Named[Line]
    """Lines in the order of the scene."""
    points: Named[Point]
    """Points in the order of the scene."""
    vessels: Named[Vessel]
    """Vessels in the order of the scene."""


class Place(NamedTuple):
    """A node of a line."""

    line: str
    """Name of the line."""
    node: int
    """Node, from 0 at end A."""
    s: float
    """Unstretched arc length from end A [m]."""
    point: str | None
    """Name of the point there; None between the ends."""


class ModeShape(NamedTuple):
    """Displacements of a line in a mode, at its nodes from end A to end B."""

    name: str
    """Name of the line."""
    s: Array
    """Unstretched arc length from end A [m]."""
    x: Array
    """Displacement along x [-]."""
    y: Array
    """Displacement along y [-]."""
    z: Array
    """Displacement along z [-]."""
    axial: Array
    """Displacement along the line, towards end B [-]."""
    transverse: Array
    """Displacement across the line in its vertical plane, upwards [-]."""
    out_of_plane: Array
    """Displacement across that plane [-]."""


class Mode(NamedTuple):
    """A natural mode about the static equilibrium."""

    period: float | None
    """Natural period [s]; None without a restoring force."""
    frequency: float
    """Natural frequency [Hz]."""
    modal_mass: float
    """Modal mass [kg] where the greatest displacement is 1."""
    greatest: Place
    """The place that moves most."""
    direction: str
    """axial, transverse or out_of_plane."""
    shares: dict[str, float]
    """Parts of the directions in the motion of that line [-]; their sum is 1."""
    shapes: Named[ModeShape]
    """Shapes of the lines that move, the greatest displacement being 1."""


class LineShapes(NamedTuple):
    """Shape of a line at several times."""

    name: str
    """Name of the line."""
    position: Array
    """Positions [m]: time, node from end A, axis."""
    tension: Array
    """Effective tension [N]: time, node."""


class Shapes(NamedTuple):
    """Shapes of all lines at several times."""

    time: Array
    """Times [s]."""
    lines: Named[LineShapes]
    """Lines in the order of the scene."""


class Table(dict[str, NDArray[Any]]):
    """Columns of a run: a dict of arrays by name, which pandas.DataFrame, polars.DataFrame and pyarrow.table take as it is."""

    units: dict[str, str]
    """Unit of every column."""
    descriptions: dict[str, str]
    """Meaning of every column."""
    notes: list[str]
    """Remarks on the scene and on the course of the run."""
    shapes: Shapes | None
    """Shapes of the lines; None of a run that does not keep them."""
    substeps: int
    """Internal steps [-]."""
    wall: float
    """Time that the steps took [s]."""
    scene: "Scene | None"
    """The scene that was run."""

    def __init__(self, columns: Mapping[str, NDArray[Any]] = {}, *, units: Mapping[str, str] = {},
                 descriptions: Mapping[str, str] = {}, notes: Iterable[str] = (), shapes: Shapes | None = None,
                 substeps: int = 0, wall: float = 0.0, scene: "Scene | None" = None) -> None:
        super().__init__(columns)
        self.units = dict(units)
        self.descriptions = dict(descriptions)
        self.notes = list(notes)
        self.shapes = shapes
        self.substeps = substeps
        self.wall = wall
        self.scene = scene

    def __repr__(self) -> str:
        rows = len(next(iter(self.values()), ()))
        return f"<moorline.Table of {rows} rows: {', '.join(self)}>"


def _array(numbers: Any) -> Array | None:
    return None if numbers is None else np.array(numbers, dtype=np.float64)


def _columns(rows: list[dict[str, float]], names: Iterable[str]) -> list[Array | None]:
    """Arrays of the values of rows; None of names that rows do not have."""
    return [np.array([row[name] for row in rows], dtype=np.float64) if rows and name in rows[0] else None for name in names]


def statics(found: dict[str, Any]) -> Statics:
    """Named tuples of the JSON of an equilibrium."""

    def line(of: dict[str, Any]) -> Line:
        ends = {end: End(np.array(of[end]["force"]), of[end]["tension"]) for end in ("end_a", "end_b")}
        catenary = of["catenary"] and Catenary(**of["catenary"])
        profile = Profile(*_columns(of["profile"], Profile._fields))  # type: ignore[arg-type]
        return Line(**{**of, **ends, "catenary": catenary, "profile": profile})

    def vessel(of: dict[str, Any]) -> Vessel:
        elements = Hold(np.array(of["elements"]["force"]), _array(of["elements"]["stiffness"]))
        return Vessel(of["name"], np.array(of["force"]), _array(of["stiffness"]), elements)

    def point(of: dict[str, Any]) -> Point:
        return Point(of["name"], of["kind"], np.array(of["position"]), np.array(of["force"]))

    return Statics(found["title"], Named(map(line, found["lines"])), Named(map(point, found["points"])),
                   Named(map(vessel, found["vessels"])))


def modes(found: dict[str, Any]) -> list[Mode]:
    """Named tuples of the JSON of natural modes."""

    def shape(of: dict[str, Any]) -> ModeShape:
        return ModeShape(of["line"], *_columns(of["nodes"], ModeShape._fields[1:]))  # type: ignore[arg-type]

    def mode(of: dict[str, Any]) -> Mode:
        return Mode(**{**of, "greatest": Place(**of["greatest"]), "shapes": Named(map(shape, of["shapes"]))})

    return [mode(of) for of in found["modes"]]


def shapes(time: Array, lines: list[tuple[str, Array, Array]]) -> Shapes:
    """Named tuples of the shapes of a run."""
    return Shapes(time, Named(LineShapes(*line) for line in lines))
