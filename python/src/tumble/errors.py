# SPDX-License-Identifier: BSD-3-Clause
"""Defines TumbleError, which invalid input raises."""
from __future__ import annotations

from typing import Any


class TumbleError(ValueError):
    """Invalid input: the field, the value found and the violated bound.

    trouble   "empty", "non_finite", "time_order", "gap", "out_of_range", "insufficient_data", "degenerate" or "diverged", from the library's
              `Status`; "type", "shape" or "unknown" for an argument; "file" for a file; "program" for the program
    field     input or parameter; for a file, its path and the place within the file
    value     value found, in the unit of the field; a time is an int in nanoseconds
    bound     violated bound: a number or a text
    index     index of the rejected sample in an array. A stream has processed the samples before it; an estimator of whole recordings
              has processed none
    so_far    results from the samples before the rejected one, if there are any
    """

    def __init__(self, message: str, trouble: str = "", field: str | None = None, value: Any = None, bound: Any = None,
                 index: int | None = None, so_far: Any = None) -> None:
        super().__init__(message)
        self.trouble = trouble
        self.field = field
        self.value = value
        self.bound = bound
        self.index = index
        self.so_far = so_far
