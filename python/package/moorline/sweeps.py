"""Load cases: on all cores of this machine, or distributed by Dask."""

import functools
import importlib
import os
import tempfile
from collections.abc import Callable
from typing import Any

from moorline import _moorline
from moorline.errors import InputError
from moorline.progress import Progress, shown
from moorline.results import Table

__all__ = ["sweep"]

Path = str | os.PathLike[str]


def sweep(base: Path, cases: Path, output: Path | None = None, *, client: Any = None, start: float | None = None, series: bool = False,
          progress: Progress = False) -> Table:
    """Runs a scene case by case and returns the table of `moorline sweep`, to the last bit.

    `base` is a scene or a deck, `cases` a CSV or TOML file. The folder `output` gets the same files as from the command line, and a sweep
    that was ended goes on from there; without it nothing is kept. Results count from `start` [s], or from the end of the ramps; `series`
    keeps all results in time. A case that fails has its reason in the column `failure`.

    `client` is a client of Dask, whose workers run the cases. They read the base, the cases and the files that these name, and write
    series, by the paths of this process; a worker that reads other content is refused.
    """
    if output is None:
        if series:
            raise InputError("series: they are written into a folder: give `output`", place="series")
        with tempfile.TemporaryDirectory() as folder:
            return sweep(base, cases, folder, client=client, start=start, progress=progress)
    base, cases, output = (os.path.abspath(path) for path in (base, cases, output))
    work = _moorline.Sweep(base, cases, start)
    left = work.open(output, series)
    try:
        with shown(progress) as call:
            if client is None:
                work.run(progress=call)
            else:
                _distribute(work, left, client, (base, cases, start), output if series else None, call)
        return work.table()
    finally:
        work.close()


def _distribute(work: _moorline.Sweep, left: list[int], client: Any, source: tuple[str, str, float | None], folder: str | None,
                progress: Callable[[int, int], object] | None) -> None:
    """Runs cases on the workers of a client and keeps their rows as they end."""
    as_completed = importlib.import_module("distributed").as_completed
    content = _moorline.__version__, work.fingerprint()
    futures = client.map(_run_case, left, source=source, content=content, folder=folder, pure=False)
    try:
        for done, future in enumerate(as_completed(futures), 1):
            work.add(future.result())
            future.release()
            if progress is not None:
                progress(done, len(left))
    except BaseException:
        client.cancel(futures)
        work.table()  # with the cases that have ended
        raise


def _run_case(number: int, source: tuple[str, str, float | None], content: tuple[str, str], folder: str | None) -> bytes:
    """Runs a case on a worker and returns its row."""
    return _read(source, content).run_case(number, folder)


@functools.lru_cache(maxsize=1)
def _read(source: tuple[str, str, float | None], content: tuple[str, str]) -> _moorline.Sweep:
    """The cases of a sweep, read once in a process."""
    work = _moorline.Sweep(*source)
    if (_moorline.__version__, work.fingerprint()) != content:
        raise InputError(f"{source[1]}: this worker reads other cases or files than the client, or has another version of moorline than "
                         f"{content[0]}", place="cases")
    return work
