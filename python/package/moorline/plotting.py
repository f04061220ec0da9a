"""Pictures with matplotlib, an optional dependency: lines coloured by tension, seabed, surface and the axes of vessels."""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from moorline._moorline import Scene, Simulation
from moorline.errors import InputError
from moorline.results import Named, Shapes, Table

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d.axes3d import Axes3D  # type: ignore[import-untyped]

__all__ = ["animate", "plot", "plot3d"]

Array = NDArray[np.float64]

COLOURS = "viridis"
SURFACE = "#3b8fc4"
SEABED = "#8a7355"
AXES = {"x": "#c0392b", "y": "#2e8b57", "z": "#2c5aa0"}


class Shape(NamedTuple):
    """A line to be drawn."""

    name: str
    """Name of the line."""
    position: Array
    """Positions of the nodes [m]."""
    tension: Array
    """Tensions of the nodes [N]."""


class Frame(NamedTuple):
    """Origin and axes of a vessel."""

    name: str
    """Name of the vessel."""
    origin: Array
    """Origin [m]."""
    axes: Array
    """Unit vectors of the body's axes, as columns [-]."""


class Picture(NamedTuple):
    """Content of a picture at one time."""

    scene: dict[str, Any]
    """The scene."""
    lines: Named[Shape]
    """Lines."""
    vessels: list[Frame]
    """Vessels."""
    caption: str
    """Title and time."""


def plot(what: Scene | Simulation | Table, *, ax: "Axes | None" = None, across: str | None = None, frame: int = -1) -> "Axes":
    """Draws a side view: a scene in static equilibrium, a simulation as it is now, or a run with shapes at one of its times.

    `across` is the horizontal axis of the picture, "x" or "y"; by default the one along which the mooring is longer. `frame` counts the
    times of a run's shapes.
    """
    picture = _picture(what, frame)
    if ax is None:
        from matplotlib import pyplot

        _, ax = pyplot.subplots(figsize=(9.0, 4.5), layout="constrained")
    column = _column(picture, across)
    _side(ax, picture, column, _norm([picture]))
    return ax


def plot3d(what: Scene | Simulation | Table, *, ax: "Axes3D | None" = None, frame: int = -1) -> "Axes3D":
    """Draws a view in space; the arguments are those of `plot`."""
    picture = _picture(what, frame)
    if ax is None:
        from matplotlib import pyplot

        figure = pyplot.figure(figsize=(8.0, 6.0), layout="constrained")
        ax = figure.add_subplot(projection="3d")
    _space(ax, picture, _norm([picture]))
    return ax


def animate(table: Table, *, across: str | None = None, space: bool = False, speed: float = 1.0) -> "FuncAnimation":
    """Animates a run that kept its shapes, in a side view or in space, at `speed` times real time.

    In a notebook `HTML(animation.to_jshtml())` shows the result; `animation.save("run.gif")` writes it.
    """
    from matplotlib import pyplot
    from matplotlib.animation import FuncAnimation

    if not 0.0 < speed < float("inf"):
        raise InputError(f"speed: {speed} is not positive and finite", place="speed")
    shapes = _shapes(table)
    pictures = [_picture(table, frame) for frame in range(len(shapes.time))]
    norm = _norm(pictures)
    figure = pyplot.figure(figsize=(8.0, 6.0) if space else (9.0, 4.5), layout="constrained")
    ax: Any = figure.add_subplot(projection="3d") if space else figure.add_subplot()
    column = _column(pictures[0], across)
    limits = _limits(pictures)

    def draw(frame: int) -> list[Any]:
        ax.clear()
        if space:
            _space(ax, pictures[frame], norm, limits, bar=frame == 0 and not figure.axes[1:])
        else:
            _side(ax, pictures[frame], column, norm, limits, bar=frame == 0 and not figure.axes[1:])
        return []

    draw(0)
    steps = np.diff(shapes.time)
    interval = 1000.0 * float(np.median(steps)) / speed if len(steps) else 100.0
    animation = FuncAnimation(figure, draw, frames=len(pictures), interval=interval, blit=False)
    pyplot.close(figure)
    return animation


def _shapes(table: Table) -> Shapes:
    if table.shapes is None:
        raise InputError("table: the run has kept no shapes: give `run` an interval, such as shapes=0.5", place="table")
    return table.shapes


def _picture(what: Any, frame: int) -> Picture:
    """Lines and vessels at the time of the picture."""
    if isinstance(what, Simulation):
        scene = what.scene.to_dict()
        lines = [Shape(name, what.positions(name), what.tensions(name)) for name in what.scene.lines]
        poses = {name: [what[f"{name}.{axis}"] for axis in ("x", "y", "z", "roll", "pitch", "yaw")] for name in what.scene.vessels}
        caption = f"t = {what.time:.2f} s"
    elif isinstance(what, Table):
        shapes = _shapes(what)
        if what.scene is None:
            raise InputError("table: it has no scene: use the table that `run` returns", place="table")
        scene = what.scene.to_dict()
        lines = [Shape(line.name, line.position[frame], line.tension[frame]) for line in shapes.lines]
        row = int(np.argmin(np.abs(what["time"] - shapes.time[frame])))
        columns = {name: [f"{name}.{axis}" for axis in ("x", "y", "z", "roll", "pitch", "yaw")] for name in what.scene.vessels}
        poses = {name: [float(what[column][row]) for column in of] for name, of in columns.items() if set(of) <= set(what)}
        caption = f"t = {shapes.time[frame]:.2f} s"
    elif isinstance(what, Scene):
        scene = what.to_dict()
        profiles = [(line.name, line.profile) for line in what.statics().lines]
        lines = [Shape(name, np.column_stack([of.x, of.y, of.z]), of.tension) for name, of in profiles]
        poses = {name: [0.0] * 6 for name in what.vessels}
        caption = "static equilibrium"
    else:
        raise InputError(f"a {type(what).__name__} cannot be drawn: a Scene, a Simulation or the Table of a run can", place="what")
    vessels = [_vessel(vessel, poses[vessel["name"]]) for vessel in scene.get("vessels", []) if vessel["name"] in poses]
    title = scene.get("title", "")
    return Picture(scene, Named(lines), vessels, f"{title}, {caption}" if title else caption)


def _vessel(vessel: dict[str, Any], pose: list[float]) -> Frame:
    """Origin and axes of a vessel: yaw about z, then pitch about y', then roll about x''."""
    origin = np.array(vessel.get("position", [0.0] * 3)) + pose[:3]
    roll, pitch, yaw = np.array(vessel.get("attitude", [0.0] * 3)) + pose[3:]
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    about_y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
    about_z = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
    return Frame(vessel["name"], origin, about_z @ about_y @ about_x)


def _arrow(picture: Picture) -> float:
    """Length of a vessel's axes in the picture [m]."""
    return 0.08 * float(np.ptp(np.concatenate([line.position for line in picture.lines]), axis=0).max())


def _nodes(pictures: list[Picture]) -> Array:
    """All places that are drawn [m]."""
    shapes = [line.position for picture in pictures for line in picture.lines]
    origins = [vessel.origin[None] for picture in pictures for vessel in picture.vessels]
    tips = [vessel.origin + _arrow(picture) * vessel.axes.T for picture in pictures for vessel in picture.vessels]
    return np.concatenate(shapes + origins + tips)


def _limits(pictures: list[Picture]) -> Array:
    """Least and greatest coordinates with a margin [m]."""
    nodes = _nodes(pictures)
    least, greatest = nodes.min(axis=0), nodes.max(axis=0)
    margin = 0.06 * max(np.ptp(nodes, axis=0).max(), 1e-9)
    if "water" in pictures[0].scene:
        greatest[2] = max(greatest[2], 0.0)
    return np.array([least - margin, greatest + margin])


def _norm(pictures: list[Picture]) -> Any:
    """Scale of colours for tensions [kN]."""
    from matplotlib.colors import Normalize

    tensions = np.concatenate([line.tension for picture in pictures for line in picture.lines])
    return Normalize(1e-3 * tensions.min(), 1e-3 * max(tensions.max(), tensions.min() + 1e-9))


def _column(picture: Picture, across: str | None) -> int:
    if across not in (None, "x", "y"):
        raise InputError(f'across: "{across}" is no horizontal axis: "x" or "y"', place="across")
    if across is not None:
        return "xy".index(across)
    x, y, _ = np.ptp(_nodes([picture]), axis=0)
    return 0 if x >= y else 1


def _seabed(scene: dict[str, Any], x: Array, y: Array) -> Array | None:
    """Height of the seabed [m]; for the picture linear between soundings."""
    seabed = scene.get("seabed")
    if seabed is None:
        return None
    if "grid" not in seabed:
        along_x, along_y = seabed.get("slope", [0.0, 0.0])
        return np.asarray(-seabed["depth"] + along_x * x + along_y * y)
    depth = np.array(seabed["grid"]["depth"])
    (i, next_i, u), (j, next_j, v) = _between(seabed["grid"]["x"], x), _between(seabed["grid"]["y"], y)
    near = (1.0 - u) * depth[j, i] + u * depth[j, next_i]
    far = (1.0 - u) * depth[next_j, i] + u * depth[next_j, next_i]
    return np.asarray(-((1.0 - v) * near + v * far))


def _between(lines: list[float], places: Array) -> tuple[Any, Any, Array]:
    """Lines of a grid on both sides of places, and the part of the way between them [-]; outside, the outermost line holds."""
    last = len(lines) - 1
    at = np.interp(places, lines, np.arange(last + 1.0))
    below = np.minimum(at.astype(int), last)
    return below, np.minimum(below + 1, last), at - below


def _side(ax: Any, picture: Picture, column: int, norm: Any, limits: Array | None = None, bar: bool = True) -> None:
    from matplotlib.collections import LineCollection

    limits = _limits([picture]) if limits is None else limits
    (left, right), (low, high) = limits[:, column], limits[:, 2]
    middle = limits[:, 1 - column].mean()
    along = np.linspace(left, right, 200)
    places = (along, np.full(200, middle)) if column == 0 else (np.full(200, middle), along)
    height = _seabed(picture.scene, *places)
    if height is not None:
        low = min(low, height.min() - 0.04 * (right - left))
        ax.fill_between(along, height, low, color=SEABED, alpha=0.35, linewidth=0.0)
        ax.plot(along, height, color=SEABED, linewidth=1.0)
    if "water" in picture.scene:
        ax.axhline(0.0, color=SURFACE, linewidth=1.0)
        high = max(high, 0.02 * (right - left))
    for line in picture.lines:
        points = line.position[:, [column, 2]]
        pieces = np.stack([points[:-1], points[1:]], axis=1)
        means = 0.5e-3 * (line.tension[:-1] + line.tension[1:])
        ax.add_collection(LineCollection(list(pieces), array=means, cmap=COLOURS, norm=norm, linewidths=2.0))
        ends = points[[0, -1]]
        ax.plot(ends[:, 0], ends[:, 1], linestyle="", marker="o", markersize=4, color="0.2")
    length = _arrow(picture)
    for vessel in picture.vessels:
        start = vessel.origin[[column, 2]]
        for name, axis in zip(AXES, vessel.axes.T):
            tip = start + length * axis[[column, 2]]
            if np.hypot(*(tip - start)) > 0.02 * length:
                ax.plot(*np.column_stack([start, tip]), color=AXES[name], linewidth=1.5)
        ax.annotate(vessel.name, start, xytext=(4, 6), textcoords="offset points", fontsize=9)
    ax.set(xlim=(left, right), ylim=(low, high), xlabel=f"{'xy'[column]} [m]", ylabel="z [m]", title=picture.caption)
    ax.set_aspect("equal" if high - low > 0.25 * (right - left) else "auto")  # shallow water would be a thin strip
    if bar:
        _bar(ax, norm)


def _space(ax: Any, picture: Picture, norm: Any, limits: Array | None = None, bar: bool = True) -> None:
    from mpl_toolkits.mplot3d.art3d import Line3DCollection  # type: ignore[import-untyped]

    limits = _limits([picture]) if limits is None else limits.copy()
    spans = np.ptp(limits, axis=0)
    for axis in (0, 1):  # a mooring in one plane has some breadth too
        widened = max(spans[axis], 0.4 * spans[:2].max())
        limits[:, axis] += np.array([-0.5, 0.5]) * (widened - spans[axis])
    x, y = np.meshgrid(*(np.linspace(limits[0, axis], limits[1, axis], 30) for axis in (0, 1)))
    height = _seabed(picture.scene, x, y)
    if height is not None:
        limits[0, 2] = min(limits[0, 2], height.min())
        ax.plot_surface(x, y, height, color=SEABED, alpha=0.25, linewidth=0.0, shade=False)
    if "water" in picture.scene:
        ax.plot_surface(x, y, np.zeros_like(x), color=SURFACE, alpha=0.12, linewidth=0.0, shade=False)
    for line in picture.lines:
        pieces = np.stack([line.position[:-1], line.position[1:]], axis=1)
        means = 0.5e-3 * (line.tension[:-1] + line.tension[1:])
        ax.add_collection3d(Line3DCollection(list(pieces), array=means, cmap=COLOURS, norm=norm, linewidths=2.0))
        ax.scatter(*line.position[[0, -1]].T, color="0.2", s=10, depthshade=False)
    length = _arrow(picture)
    for vessel in picture.vessels:
        for name, axis in zip(AXES, vessel.axes.T):
            ax.plot(*np.column_stack([vessel.origin, vessel.origin + length * axis]), color=AXES[name], linewidth=1.8)
        ax.text(*vessel.origin, f"  {vessel.name}", fontsize=9)
    ax.set(xlim=limits[:, 0], ylim=limits[:, 1], zlim=limits[:, 2], xlabel="x [m]", ylabel="y [m]", zlabel="z [m]", title=picture.caption)
    aspect = np.ptp(limits, axis=0)
    aspect[2] = max(aspect[2], 0.3 * aspect.max())
    ax.set_box_aspect(aspect)
    ax.view_init(elev=25.0, azim=-75.0)  # along none of the usual directions of lines
    if bar:
        _bar(ax, norm)


def _bar(ax: Any, norm: Any) -> None:
    from matplotlib.cm import ScalarMappable

    ax.figure.colorbar(ScalarMappable(norm, COLOURS), ax=ax, label="tension [kN]", shrink=0.8)
