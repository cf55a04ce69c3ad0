# SPDX-License-Identifier: BSD-3-Clause
"""Groups of a file of HDF5: what is missing or of another type or shape is said by its place."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import TumbleError

Array = npt.NDArray[Any]
XYZ = "x y z"


class Group:
    """A group of a file that says where it is when something is missing or of another type."""

    def __init__(self, group: Any, path: str) -> None:
        self.group, self.place = group, f"{path}: {group.name}"

    def attribute(self, name: str, kind: type, default: Any = None) -> Any:
        value = self.group.attrs.get(name, default)
        if value is None:
            raise missing(f"{self.place} attribute {name}")
        if kind is str:
            return value.decode() if isinstance(value, bytes) else str(value)
        return kind(value)

    def rows(self, name: str, dtype: str, columns: tuple[int, ...] = (), optional: bool = False) -> Any:
        if name not in self.group:
            if optional:
                return None
            raise missing(f"{self.place}/{name}")
        data = self.group[name]
        shape = getattr(data, "shape", None)
        if shape is None or getattr(data, "dtype", None) != np.dtype(dtype):
            found = getattr(data, "dtype", "a group")
            raise TumbleError(f"{self.place}/{name} is {found}, must be {dtype}", "file", f"{self.place}/{name}", str(found), dtype)
        if shape[1:] != columns:
            bound = "x".join(["N", *map(str, columns)])
            raise TumbleError(f"{self.place}/{name} is {shape}, must be {bound}", "file", f"{self.place}/{name}", shape, bound)
        return data[()]

    def members(self, name: str) -> list[Group]:
        if name not in self.group:
            return []
        within = self.group[name]
        path = self.place.split(": ")[0]
        out = []
        while str(len(out)) in within:
            out.append(Group(within[str(len(out))], path))
        return out


def missing(place: str) -> TumbleError:
    return TumbleError(f"{place} is missing", "file", place, None, "there")


def same_length(place: str, first: Array, **others: Array | None) -> None:
    for name, rows in others.items():
        if rows is not None and len(rows) != len(first):
            raise TumbleError(f"{place}/{name} has {len(rows)} rows, must have {len(first)}", "file", f"{place}/{name}",
                              len(rows), len(first))


def put(group: Any, name: str, rows: Any, dtype: str, unit: str, shape: tuple[int, ...], columns: str = "") -> None:
    """Writes a dataset with its unit and the names of its columns. TumbleError `shape`, `type` where numbers that are whole are none."""
    given = np.asarray(rows)
    if np.dtype(dtype).kind in "iu" and given.dtype.kind not in "iu":
        raise TumbleError(f"{group.name}/{name} is {given.dtype}, must be {np.dtype(dtype)}", "type", f"{group.name}/{name}",
                          given.dtype, np.dtype(dtype))
    if given.shape != shape:
        raise TumbleError(f"{group.name}/{name} is {given.shape}, must be {shape}", "shape", f"{group.name}/{name}", given.shape,
                          shape)
    data = group.create_dataset(name, data=given.astype(dtype))
    data.attrs["unit"] = unit
    if columns:
        data.attrs["columns"] = columns
