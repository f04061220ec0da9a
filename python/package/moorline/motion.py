"""Motions in memory: the columns of a motion file as arrays."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moorline.errors import InputError

__all__ = ["columns"]


def columns(motion: Any) -> dict[str, NDArray[np.float64]]:
    """Columns of a motion, such as time and fairlead.x, from a dict, a DataFrame of pandas or polars, or a structured array.

    The index of a pandas DataFrame is its time where it is named so.
    """
    if isinstance(motion, Mapping):
        named = dict(motion)
    elif getattr(getattr(motion, "dtype", None), "names", None):
        named = {name: motion[name] for name in motion.dtype.names}
    elif hasattr(motion, "columns"):
        named = {name: motion[name] for name in motion.columns}
        index = getattr(motion, "index", None)
        if "time" not in named and getattr(index, "name", None) == "time":
            named["time"] = index
    else:
        kind = type(motion).__name__
        raise InputError(f"motion: a {kind} has no columns: give a dict of arrays or a DataFrame", place="motion")
    return {str(name): _numbers(str(name), values) for name, values in named.items()}


def _numbers(name: str, values: Any) -> NDArray[np.float64]:
    kind = str(getattr(getattr(values, "dtype", None), "kind", ""))
    if kind in ("m", "M", "c") or np.ma.is_masked(values):
        what = {"m": "durations", "M": "dates", "c": "complex numbers"}.get(kind, "masked numbers")
        raise InputError(f"{name}: {what} are no numbers of a motion: give times in seconds, displacements and rates", place=name)
    try:
        array = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        array = None
    if array is None or array.ndim != 1:
        raise InputError(f"{name}: a column of a motion is a row of numbers", place=name)
    return array
