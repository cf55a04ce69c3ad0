# SPDX-License-Identifier: BSD-3-Clause
"""Prints data classes with arrays as short texts."""
from __future__ import annotations

from typing import Any

import numpy as np

_LIST_MAX = 4  # a longer list is printed as its length
_TEXT_MAX = 60


class Shown:
    """Base of data classes. Prints an array by type and shape, so that a recording fits on a few lines."""

    def __repr__(self) -> str:
        members = ", ".join(f"{name}={_short(value)}" for name, value in vars(self).items())
        return f"{type(self).__name__}({members})"


def _short(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"<{value.dtype} {' x '.join(map(str, value.shape)) or 'scalar'}>"
    if isinstance(value, (list, tuple)):
        return f"<{len(value)} items>" if len(value) > _LIST_MAX else f"[{', '.join(map(_short, value))}]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key!r}: {_short(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, str) and len(value) > _TEXT_MAX:
        return f"<text of {len(value)} characters>"
    return repr(value)
