# SPDX-License-Identifier: BSD-3-Clause
"""What functions of the package are given: refused by name, with the value found and its bound."""
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
SYMMETRIC = 1e-3  # in correlations, as of a function of Python that the program calls
RIGID = 1e-6  # as the program asks of what it reads


def refusal(trouble: str, field: str, value: Any, bound: Any, index: int | None = None) -> TumbleError:
    """The error "FIELD is VALUE, must be BOUND"."""
    where = "" if index is None else f" (row {index})"
    return TumbleError(f"{field} is {value}, must be {bound}{where}", trouble, field, value, bound, index)


def wrong_type(field: str, given: Any, bound: str) -> TumbleError:
    """The error of an argument that is something else."""
    return refusal("type", field, type(given).__name__, bound)


def having(field: str, given: Any, what: str, *names: str) -> None:
    """Refuses what lacks one of the attributes `names`; `what` it should have been."""
    if given is None or not all(hasattr(given, name) for name in names):
        raise wrong_type(field, given, what)


def path_of(field: str, given: Any) -> str:
    """A path as text."""
    if not isinstance(given, (str, os.PathLike)):
        raise wrong_type(field, given, "a path")
    return os.fspath(given)


def whole(field: str, given: Any, low: int, high: int) -> int:
    """A whole number within bounds, of Python or numpy; no other number is cut down to one."""
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
    """A finite number of at least `low`."""
    if not isinstance(given, kinds.Real) or isinstance(given, bool):
        raise refusal("type", field, repr(given), "a number")
    number = float(given)
    if not (math.isfinite(number) and number >= low):
        raise refusal("out_of_range", field, number, "finite" + (f" and at least {low:g}" if math.isfinite(low) else ""))
    return number


def unmasked(field: str, given: Any) -> Array:
    """As an array of numbers that are real; what lies below a mask is none, and a complex number would lose a part."""
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
    """Refuses times of which one is not after the one before."""
    late = np.flatnonzero(times[1:] <= times[:-1])
    if len(late):
        k = int(late[0]) + 1
        raise refusal("time_order", field, int(times[k]), f"above {int(times[k - 1])}", k)


def symmetric(field: str, matrices: Array) -> None:
    """Refuses covariances (N, M, M) of which one is not symmetric, up to what single precision makes of one."""
    deviation = np.sqrt(np.maximum(np.diagonal(matrices, axis1=1, axis2=2), 0.0))
    apart = np.abs(matrices - matrices.transpose(0, 2, 1)) > SYMMETRIC * deviation[:, :, None] * deviation[:, None, :]
    bad = np.flatnonzero(apart.any(axis=(1, 2)))
    if len(bad):
        raise refusal("out_of_range", field, matrices[bad[0]].tolist(), "symmetric", int(bad[0]))


def rigid(field: str, given: Any) -> None:
    """Refuses what is no rotation and shift, (4, 4)."""
    pose = unmasked(field, given)
    if pose.shape != (4, 4):
        raise refusal("shape", field, pose.shape, (4, 4))
    turn = pose[:3, :3].astype(float)
    fits = np.isfinite(pose).all() and np.abs(turn.T @ turn - np.eye(3)).max() <= RIGID and np.linalg.det(turn) > 0.0
    if not fits or not np.array_equal(pose[3], [0, 0, 0, 1]):
        raise refusal("out_of_range", field, "no rigid transform", "a rotation and a translation")
