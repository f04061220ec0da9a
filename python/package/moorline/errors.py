"""Errors of moorline, with the place, the mistake and a correction."""

from typing import Any

__all__ = ["Error", "InputError", "OutputError", "SceneError", "StaticsError", "StepError"]


class Error(Exception):
    """Base of all errors of moorline."""

    place: str | None
    """Place: a key path of the scene, a line and node, or the name of an input."""
    problem: str
    """The problem, without its place."""
    advice: str | None
    """A remedy; None where the problem contains it."""
    partial: Any
    """Table of a failed run up to the failure; None of other errors."""

    def __init__(self, message: str, *, place: str | None = None, problem: str | None = None, advice: str | None = None,
                 **facts: Any) -> None:
        super().__init__(message)
        self.place = place
        self.problem = message if problem is None else problem
        self.advice = advice
        self.partial = None
        self.__dict__.update(facts)


class SceneError(Error, ValueError):
    """A scene or a deck is wrong."""

    mistakes: list[tuple[str, str, int | None, int | None]]
    """Every mistake: key path, problem, and line and column of the text (None where the scene is no text)."""

    def __init__(self, message: str, **facts: Any) -> None:
        self.mistakes = []
        super().__init__(message, **facts)


class StaticsError(Error):
    """There is no static equilibrium, or none was found."""

    line: str | None
    """Name of the line, where one line fails."""
    residual: float | None
    """Force out of balance [N], where that is the problem."""

    def __init__(self, message: str, **facts: Any) -> None:
        self.line = self.residual = None
        super().__init__(message, **facts)


class StepError(Error):
    """A step failed. The simulation is as it was before the step."""

    time: float | None
    """Time at which the step starts [s]."""
    line: str | None
    """Name of the line."""
    node: int | None
    """Node, from 0 at end A."""
    residual: float | None
    """Force out of balance [N], where that is the problem."""

    def __init__(self, message: str, **facts: Any) -> None:
        self.time = self.line = self.node = self.residual = None
        super().__init__(message, **facts)


class InputError(Error, ValueError):
    """An argument, an input or a motion is wrong."""


class OutputError(Error, OSError):
    """A file cannot be written."""

    def __str__(self) -> str:
        return str(self.args[0])
