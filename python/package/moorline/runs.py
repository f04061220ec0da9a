"""Runs of scenes in time: one, or many on all cores."""

import os
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from moorline import _moorline
from moorline._moorline import Scene
from moorline.errors import Error, InputError
from moorline.progress import Progress, shown
from moorline.results import Table

__all__ = ["Case", "batch", "run"]

Source = Scene | str | os.PathLike[str] | dict[str, Any]
"""A scene, the path of a scene or a deck, or a scene as a dict."""


class Case(NamedTuple):
    """A run of a batch."""

    scene: Source
    """The scene, its path, or a dict."""
    motion: Any = None
    """Motion as of `run`; None is that of the scene."""
    duration: float | None = None
    """Duration [s]; None is that of the motion or the scene."""
    interval: float | None = None
    """Time between rows [s]; None is that of the scene."""

    def moved(self) -> Scene:
        """The scene with the motion, duration and interval."""
        scene = self.scene
        if isinstance(scene, dict):
            scene = Scene.from_dict(scene)
        elif isinstance(scene, (str, os.PathLike)):
            scene = Scene.load(scene)
        elif not isinstance(scene, Scene):
            raise InputError(f"scene: a {type(scene).__name__} is no scene, no path and no dict", place="scene")
        if self.motion is None and self.duration is None and self.interval is None:
            return scene
        return scene.with_motion(self.motion, duration=self.duration, interval=self.interval)


def run(scene: Source, motion: Any = None, duration: float | None = None, interval: float | None = None, *,
        columns: Sequence[str] | None = None, shapes: float | None = None, progress: Progress = False) -> Table:
    """Runs a scene in time and returns its columns: the rows of `moorline run`, to the last bit.

    `motion` moves coupled points and vessels in place of the motion of the scene: columns `time` [s] and such as `fairlead.x` [m] or
    `platform.pitch` [rad], as a dict of arrays or a DataFrame. `columns` are the names to keep; `shapes` is the interval [s] at which the
    shapes of the lines are kept. Ctrl-C ends the run. An error has the rows up to it as `partial`.
    """
    moved = Case(scene, motion, duration, interval).moved()
    with shown(progress) as call:
        table = _moorline.run(moved, columns=_names(columns), shapes=_interval(shapes), progress=call)
    table.scene = moved
    return table


def batch(cases: Iterable[Source | Case | tuple[Any, ...]], *, columns: Sequence[str] | None = None, shapes: float | None = None,
          threads: int | None = None, progress: Progress = False) -> list[Table | Error]:
    """Runs many cases on all cores, without the lock of the interpreter. Results are those of single runs, to the last bit.

    A case is a scene, or a tuple (scene, motion, duration, interval) of which the end may be left out. A case that fails gives its error
    in place of a table, and the others go on.
    """
    done: list[Table | Error | None] = []
    scenes: list[Scene] = []
    for case in cases:
        try:
            scenes.append((Case(*case) if isinstance(case, tuple) else Case(case)).moved())
            done.append(None)
        except Error as error:
            done.append(error)
    with shown(progress) as call:
        results = _moorline.batch(scenes, columns=_names(columns), shapes=_interval(shapes), threads=threads, progress=call)
    pairs = iter(zip(results, scenes))
    for place, known in enumerate(done):
        if known is None:
            result, scene = next(pairs)
            if isinstance(result, Table):
                result.scene = scene
            done[place] = result
    return [one for one in done if one is not None]


def _names(columns: Sequence[str] | None) -> list[str] | None:
    return None if columns is None else [columns] if isinstance(columns, str) else list(columns)


def _interval(shapes: float | None) -> float | None:
    if shapes is not None and not 0.0 < shapes < float("inf"):
        raise InputError(f"shapes: an interval of {shapes} s is not positive and finite", place="shapes")
    return shapes
