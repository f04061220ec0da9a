"""Progress of long work, on a terminal or in a notebook."""

import sys
import time
from collections.abc import Callable

__all__ = ["Progress", "shown"]

Progress = bool | Callable[[int, int], object]
"""True shows a line on standard error; a function is called with the steps made and to be made."""


class Bar:
    """A line on standard error, with the part that is done and the time that remains."""

    def __init__(self) -> None:
        self.start = self.last = time.monotonic()
        self.is_shown = False

    def __call__(self, done: int, total: int) -> None:
        now = time.monotonic()
        if total == 0 or now - self.last < 0.2:
            return
        self.last, self.is_shown = now, True
        left = (now - self.start) * (total - done) / max(done, 1)
        filled = 40 * done // total
        sys.stderr.write(f"\r{'█' * filled}{'░' * (40 - filled)} {100 * done // total:3d} %  {left:.0f} s left   ")
        sys.stderr.flush()

    def close(self) -> None:
        """Removes the line."""
        if self.is_shown:
            sys.stderr.write("\r" + " " * 70 + "\r")
            sys.stderr.flush()


class shown:
    """Context of a progress: the function to call, or None."""

    def __init__(self, progress: Progress) -> None:
        self.bar = Bar() if progress is True else None
        self.call = progress if callable(progress) else self.bar

    def __enter__(self) -> Callable[[int, int], object] | None:
        return self.call

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.close()
