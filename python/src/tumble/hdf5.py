# SPDX-License-Identifier: BSD-3-Clause
"""Reads and writes groups of an HDF5 file. Errors name the place of an item that is missing or has the wrong type or shape."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .checks import unmasked
from .errors import TumbleError
from .files import optional

Array = npt.NDArray[Any]
XYZ = "x y z"
CHUNK_BYTES = 2**20  # chunk size of a compressed dataset, see FORMAT.md
PLAIN = {"position_L_m", "range_m", "intensity", "hit_W_m"}  # lidar floats resemble noise, so compression is slow and saves little


class Group:
    """A group of an HDF5 file. The errors of its functions contain the path of the group."""

    def __init__(self, group: Any, path: str) -> None:
        self.group, self.place = group, f"{path}: {group.name}"

    def attribute(self, name: str, kind: type, default: Any = None) -> Any:
        """Returns an attribute as `kind`. Raises TumbleError `file` if it is missing and has no default."""
        value = self.group.attrs.get(name, default)
        if value is None:
            raise missing(f"{self.place} attribute {name}")
        if kind is str:
            return value.decode() if isinstance(value, bytes) else str(value)
        return kind(value)

    def rows(self, name: str, dtype: str, columns: tuple[int, ...] = (), optional: bool = False) -> Any:
        """Returns a dataset of the given type and columns, or None if it is optional and missing. Raises TumbleError `file`."""
        if name not in self.group:
            if optional:
                return None
            raise missing(f"{self.place}/{name}")
        data = self.group[name]
        shape = getattr(data, "shape", None)
        if shape is None or getattr(data, "dtype", None) != np.dtype(dtype):
            found = getattr(data, "dtype", "a group")
            raise TumbleError(f"{self.place}/{name} is {found}; it must be {dtype}", "file", f"{self.place}/{name}", str(found), dtype)
        if shape[1:] != columns:
            bound = "x".join(["N", *map(str, columns)])
            raise TumbleError(f"{self.place}/{name} is {shape}; it must be {bound}", "file", f"{self.place}/{name}", shape, bound)
        return data[()]

    def texts(self, name: str) -> list[str]:
        """Returns a dataset of texts."""
        place = f"{self.place}/{name}"
        if name not in self.group:
            raise missing(place)
        try:
            return [str(text) for text in self.group[name].asstr()[()]]
        except (AttributeError, TypeError, UnicodeDecodeError) as error:
            raise TumbleError(f"{place} must be a list of texts", "file", place, None, "texts") from error

    def member(self, name: str) -> Group:
        """Returns a subgroup."""
        if not hasattr(self.group.get(name), "keys"):
            raise missing(f"{self.place}/{name}")
        return Group(self.group[name], self.place.split(": ")[0])

    def members(self, name: str) -> list[Group]:
        """Returns the groups 0, 1, ... within `name`, in order; an empty list if `name` is missing."""
        if name not in self.group:
            return []
        within = self.group[name]
        path = self.place.split(": ")[0]
        out: list[Group] = []
        while str(len(out)) in within:
            out.append(Group(within[str(len(out))], path))
        return out


def missing(place: str) -> TumbleError:
    """Returns the error for a required item that is missing."""
    return TumbleError(f"{place} is missing", "file", place, None, "there")


def same_length(place: str, first: Array, **others: Array | None) -> None:
    """Raises TumbleError `file` if one of `others` has a different number of rows than `first`; None is skipped."""
    for name, rows in others.items():
        if rows is not None and len(rows) != len(first):
            raise TumbleError(f"{place}/{name} has {len(rows)} rows; it must have {len(first)}", "file", f"{place}/{name}",
                              len(rows), len(first))


def _storage(name: str, rows: Array) -> dict[str, Any]:
    """Returns the storage options that the program uses for such rows (scenarios/recordings/FORMAT.md)."""
    if name in PLAIN or len(rows) == 0:
        return {}
    in_chunk = max(1, CHUNK_BYTES // (rows.itemsize * rows[0].size))
    return {"chunks": (min(len(rows), in_chunk), *rows.shape[1:]), "shuffle": True, "compression": "gzip", "compression_opts": 1}


def put(group: Any, name: str, rows: Any, dtype: str, unit: str, shape: tuple[int, ...], columns: str = "", many: bool = True) -> None:
    """Writes a dataset with its unit and column names, and with the program's storage options.

    many=False: the dataset has a fixed, small number of rows and is not compressed. Raises TumbleError `shape`; `type` for numbers that
    are complex, masked, or floats for an integer type; `out_of_range` for numbers beyond the file's type.
    """
    given = unmasked(f"{group.name}/{name}", rows)
    if np.dtype(dtype).kind in "iu" and given.dtype.kind not in "iu":
        raise TumbleError(f"{group.name}/{name} is {given.dtype}; it must be {np.dtype(dtype)}", "type", f"{group.name}/{name}",
                          given.dtype, np.dtype(dtype))
    if given.shape != shape:
        raise TumbleError(f"{group.name}/{name} is {given.shape}; it must be {shape}", "shape", f"{group.name}/{name}", given.shape,
                          shape)
    if np.dtype(dtype).kind in "iu" and given.size > 0:
        held = np.iinfo(dtype)
        for number in (int(given.min()), int(given.max())):
            if not held.min <= number <= held.max:
                raise TumbleError(f"{group.name}/{name} is {number}; it must be within [{held.min}, {held.max}]", "out_of_range",
                                  f"{group.name}/{name}", number, (held.min, held.max))
    stored = given.astype(dtype)
    data = group.create_dataset(name, data=stored, **_storage(name, stored) if many else {})
    data.attrs["unit"] = unit
    if columns:
        data.attrs["columns"] = columns


def put_texts(group: Any, name: str, texts: Sequence[str]) -> None:
    """Writes a dataset of texts. Each entry has the length of the longest text."""
    rows = [text.encode() for text in texts]
    utf8 = optional("h5py", "files").string_dtype("utf-8", max([1, *map(len, rows)]))
    group.create_dataset(name, data=np.array(rows, dtype=utf8))
