# SPDX-License-Identifier: BSD-3-Clause
"""What goes wrong with input."""
from __future__ import annotations

from typing import Any


class TumbleError(ValueError):
    """Input that a caller has to expect trouble with: which field, the value found, the bound that it broke.

    trouble   "empty", "non_finite", "time_order", "gap", "out_of_range", "too_few", "degenerate", "diverged" as the library
              has them (`Status`); "type", "shape", "unknown" of an argument; "file" of a file; "program" of the program
    field     the input or the parameter; of a file its path and place
    value     what was found, in the field's unit; a time is an int of nanoseconds
    bound     what it broke: a number, or a text
    index     of an array of samples: the one that was refused; a stream has taken in those before it, what takes a whole recording none
    so_far    what came out of these, where anything does
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
