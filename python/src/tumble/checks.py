# SPDX-License-Identifier: BSD-3-Clause
"""Checks function arguments. Each error names the argument, the value found and its bound."""
from __future__ import annotations

import math
import numbers as kinds
import operator
import os
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import TumbleError

Array = npt.NDArray[Any]
SYMMETRIC = 1e-3  # tolerance of a correlation; the program uses the same value for the covariances of a Python method
RIGID = 1e-6  # tolerance of a rotation, the same as in the program's readers


def refusal(trouble: str, field: str, value: Any, bound: Any, index: int | None = None) -> TumbleError:
    """Returns the error "FIELD is VALUE; it must be BOUND"."""
    where = "" if index is None else f" (row {index})"
    return TumbleError(f"{field} is {value}; it must be {bound}{where}", trouble, field, value, bound, index)


def wrong_type(field: str, given: Any, bound: str) -> TumbleError:
    """Returns the error for an argument of the wrong type."""
    return refusal("type", field, type(given).__name__, bound)


def having(field: str, given: Any, what: str, *names: str) -> None:
    """Raises TumbleError `type` if `given` lacks one of the attributes `names`. `what` describes a valid argument."""
    if given is None or not all(hasattr(given, name) for name in names):
        raise wrong_type(field, given, what)


def path_of(field: str, given: Any) -> str:
    """Returns a path as text."""
    if not isinstance(given, (str, os.PathLike)):
        raise wrong_type(field, given, "a path")
    return os.fspath(given)


def whole(field: str, given: Any, low: int, high: int) -> int:
    """Returns an integer of Python or numpy within bounds. Rejects floats instead of truncating them."""
    try:
        if isinstance(given, (bool, np.bool_)):
            raise TypeError
        number = operator.index(given)
    except TypeError:
        raise refusal("type", field, repr(given), "a whole number") from None
    if not low <= number <= high:
        raise refusal("out_of_range", field, number, f"within [{low}, {high}]")
    return number


def number_from(field: str, given: Any, low: float = -math.inf) -> float:
    """Returns a finite number that is at least `low`."""
    if not isinstance(given, kinds.Real) or isinstance(given, bool):
        raise refusal("type", field, repr(given), "a number")
    number = float(given)
    if not (math.isfinite(number) and number >= low):
        raise refusal("out_of_range", field, number, "finite" + (f" and at least {low:g}" if math.isfinite(low) else ""))
    return number


def unmasked(field: str, given: Any) -> Array:
    """Returns an array of real numbers. Rejects masked values and complex numbers."""
    if np.ma.is_masked(given):
        raise refusal("type", field, "masked", "numbers without a mask")
    try:
        out = np.asarray(given)
    except (TypeError, ValueError):
        raise wrong_type(field, given, "an array of numbers") from None
    if out.dtype.kind not in "iuf":
        raise refusal("type", field, out.dtype, "real numbers")
    return out


def rising(field: str, times: Array) -> None:
    """Raises TumbleError `time_order` if a time is not later than the previous time."""
    late = np.flatnonzero(times[1:] <= times[:-1])
    if len(late):
        k = int(late[0]) + 1
        raise refusal("time_order", field, int(times[k]), f"above {int(times[k - 1])}", k)


def symmetric(field: str, matrices: Array) -> None:
    """Raises TumbleError if one of the covariances (N, M, M) is not symmetric to single precision."""
    deviation = np.sqrt(np.maximum(np.diagonal(matrices, axis1=1, axis2=2), 0.0))
    apart = np.abs(matrices - matrices.transpose(0, 2, 1)) > SYMMETRIC * deviation[:, :, None] * deviation[:, None, :]
    bad = np.flatnonzero(apart.any(axis=(1, 2)))
    if len(bad):
        raise refusal("out_of_range", field, matrices[bad[0]].tolist(), "symmetric", int(bad[0]))


def rigid(field: str, given: Any) -> None:
    """Raises TumbleError if `given` is not a rigid transform (4, 4)."""
    pose = unmasked(field, given)
    if pose.shape != (4, 4):
        raise refusal("shape", field, pose.shape, (4, 4))
    turn = pose[:3, :3].astype(float)
    fits = np.isfinite(pose).all() and np.abs(turn.T @ turn - np.eye(3)).max() <= RIGID and np.linalg.det(turn) > 0.0
    if not fits or not np.array_equal(pose[3], [0, 0, 0, 1]):
        raise refusal("out_of_range", field, "not a rigid transform", "a rotation and a translation")
