# SPDX-License-Identifier: BSD-3-Clause
"""Converts the sweeps of a recording to evalio's dense clouds: row by row, with a time per point."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ..errors import TumbleError
from ..recordings import Lidar, Sweep
from .needed import needed_evalio

needed_evalio()
from evalio import types  # noqa: E402
from evalio._cpp import helpers  # noqa: E402

Array = npt.NDArray[Any]

#: Stamp of time 0, as in the program's exports, so that results of evalio, `tumble export` and `tumble score` have one clock.
ORIGIN_NS = 1_000_000_000_000_000_000

_POINT = np.dtype([("x", "f4"), ("y", "f4"), ("z", "f4"), ("intensity", "f4"), ("t", "u4"), ("range", "u4"), ("ring", "u2")])
_TYPES = {"f4": "FLOAT32", "u4": "UINT32", "u2": "UINT16"}


def stamp(time_ns: int) -> types.Stamp:
    return types.Stamp(sec=(ORIGIN_NS + time_ns) // 10**9, nsec=(ORIGIN_NS + time_ns) % 10**9)


class Grid:
    """Assigns the returns of a lidar to rows (rings) and columns. If the rings fire in a fixed sequence, a column is one sequence.
    Otherwise the returns of a ring fill its columns in order."""

    def __init__(self, lidar: Lidar) -> None:
        ring, offset = np.asarray(lidar.ring).astype(np.int64), lidar.offset_ns.astype(np.int64)
        self.rows = int(ring.max(initial=0)) + 1
        first = np.unique(offset[ring == 0])
        step = int(np.gcd.reduce(np.diff(first))) if len(first) > 1 else 0
        columns = int(offset.max(initial=0)) // step + 1 if step else 0
        longest = max((int(np.bincount(sweep.ring).max(initial=0)) for sweep in lidar), default=0)
        fixed = bool(step) and columns <= 4 * max(longest, 1) and all(
            len(np.unique(sweep.ring.astype(np.int64) * columns + sweep.offset_ns // step)) == len(sweep.ring) for sweep in lidar)
        self.sequence_ns = step if fixed else 0
        self.columns = max(1, columns if fixed else longest)
        for name, value, bound in (("rings", self.rows, 256), ("columns", self.columns, 65_536)):
            if value > bound:
                raise TumbleError(f"{name} is {value}; it must be at most {bound}, the limit of evalio's points", "out_of_range", name, value, bound)

    def cells(self, ring: Array, offset_ns: Array) -> Array:
        """Returns an array (rows, columns) with the index of the return in each cell, or -1 for an empty cell."""
        if self.sequence_ns:
            column = offset_ns.astype(np.int64) // self.sequence_ns
        else:
            order = np.argsort(ring, kind="stable")
            begins = np.searchsorted(ring[order], ring[order], side="left")
            column = np.empty(len(ring), np.int64)
            column[order] = np.arange(len(ring)) - begins
        out = np.full((self.rows, self.columns), -1)
        out[ring, column] = np.arange(len(ring))
        return out


def measurement(sweep: Sweep, grid: Grid, own_body_L: Any = None) -> types.LidarMeasurement:
    """Converts a sweep to a dense cloud, row by row; cells without a return are 0. evalio converts it from bytes.

    own_body_L (2, 3): smallest and largest corner of a box; returns within the box are skipped.
    """
    kept = np.ones(len(sweep.position), bool)
    if own_body_L is not None:
        kept = ~np.all((sweep.position > np.float32(own_body_L[0])) & (sweep.position < np.float32(own_body_L[1])), axis=1)
    position, offset, ring = sweep.position[kept], sweep.offset_ns[kept], sweep.ring[kept]
    cells = grid.cells(ring, offset)
    there = cells >= 0
    k = cells[there]
    out = np.zeros((grid.rows, grid.columns), _POINT)
    out["ring"], out["t"] = np.arange(grid.rows)[:, None], np.arange(grid.columns)[None, :] * grid.sequence_ns
    for axis, name in enumerate("xyz"):
        out[name][there] = position[k, axis]
    out["intensity"][there], out["t"][there] = sweep.intensity[kept][k], offset[k]
    out["range"][there] = 1000.0 * np.linalg.norm(position[k], axis=1)
    metadata = helpers.PointCloudMetadata(stamp=stamp(sweep.start_ns), width=grid.columns, height=grid.rows, point_step=_POINT.itemsize,
                                          row_step=_POINT.itemsize * grid.columns, is_bigendian=0, is_dense=1)
    fields = [helpers.Field(name=name, datatype=getattr(helpers.DataType, _TYPES[kind.str[1:]]), offset=at)
              for name, (kind, at, *_) in (_POINT.fields or {}).items()]
    cloud = helpers.pc2_to_evalio(metadata, fields, out.tobytes())
    helpers.fill_col_row_major(cloud)
    return cloud
