# SPDX-License-Identifier: BSD-3-Clause
"""A function of Python as a method of the program, where a name of a method may stand: in runs, sweeps, gates.

    import tumble

    def rate(recording):
        return recording.imus[0].gyro

    if __name__ == "__main__":
        tumble.serve("rate", rate)

and `tumble.describe_method("mine.yaml", "mine", "rate", "mine.py")` beside it. The program runs the file for each draw, in a process
of its own; it sees the sensors, never the truth.
"""
from __future__ import annotations

import os
import pathlib
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .errors import TumbleError
from .estimates import Trajectory, write_tum
from .files import beside
from .recordings import Recording, read

KINDS = ("rate", "attitude", "position", "slam")


def serve(kind: str, function: Callable[[Recording], Any], arguments: Sequence[str] | None = None) -> None:
    """Answers the program: reads the recording, calls `function` with it, leaves the result where it is wanted.

    What `function` returns: of a rate (N, 3), rad/s in axes of the first IMU, one row for each of its samples, or that and
    (N, 3, 3) of covariances, or whatever has `rate` and `covariance` (Rates); of an attitude whatever has time_ns and
    quaternion (Attitudes); of a position or slam whatever has time_ns, position and quaternion (Poses, Trajectory).
    """
    if kind not in KINDS:
        raise TumbleError(f"kind is '{kind}', must be one of {', '.join(KINDS)}", "unknown", "kind", kind, KINDS)
    words = sys.argv[1:] if arguments is None else list(arguments)
    if len(words) != 2:
        raise SystemExit(f"usage: {sys.argv[0]} RECORDING.h5 OUTPUT (see tumble.describe_method)")
    recording = read(words[0], truth=False)
    result = function(recording)
    if kind == "rate":
        _write_rates(words[1], recording, result)
    else:
        write_tum(words[1], result)


def _write_rates(path: str, recording: Recording, result: Any) -> None:
    if hasattr(result, "rate"):
        rate, covariance = result.rate, result.covariance
    elif isinstance(result, tuple):
        rate, covariance = result
    else:
        rate, covariance = result, None
    times = recording.imus[0].time_ns
    rows = [np.asarray(rate, dtype=float)]
    if rows[0].shape != (len(times), 3):
        raise TumbleError(f"rate is {rows[0].shape}, must be {(len(times), 3)}", "shape", "rate", rows[0].shape, (len(times), 3))
    header = "time_ns,wx_rad_s,wy_rad_s,wz_rad_s"
    if covariance is not None:
        matrices = np.asarray(covariance, dtype=float)
        if matrices.shape != (len(times), 3, 3):
            raise TumbleError(f"covariance is {matrices.shape}, must be {(len(times), 3, 3)}", "shape", "covariance", matrices.shape,
                              (len(times), 3, 3))
        rows.append(matrices[:, [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]])
        header += ",cxx,cxy,cxz,cyy,cyz,czz"
    with beside(path) as part, open(part, "w", encoding="ascii") as out:
        print(header, file=out)
        for time_ns, numbers in zip(times.tolist(), np.concatenate(rows, axis=1).tolist(), strict=True):
            print(time_ns, *map(repr, numbers), sep=",", file=out)


def describe_method(path: str | os.PathLike[str], name: str, kind: str, script: str | os.PathLike[str], doc: str = "",
                    robots: Sequence[str] = (), time_limit_s: float = 600.0) -> pathlib.Path:
    """Writes the file that makes `script`, which calls `serve`, a method named KIND/NAME: this interpreter runs it. All keys of
    such files: scenarios/methods/EXTERNAL.md."""
    if kind not in KINDS:
        raise TumbleError(f"kind is '{kind}', must be one of {', '.join(KINDS)}", "unknown", "kind", kind, KINDS)
    quoted = [_quoted(word) for word in (sys.executable, str(pathlib.Path(script).resolve()), "{recording}", "{output}")]
    lines = [f"name: {_quoted(name)}", f"kind: {kind}", f"command: [{', '.join(quoted)}]", f"time_limit_s: {float(time_limit_s)!r}"]
    if doc:
        lines.append(f"doc: {_quoted(doc)}")
    if robots:
        lines.append(f"robots: [{', '.join(robots)}]")
    with beside(path) as part:
        pathlib.Path(part).write_text("\n".join(lines) + "\n", encoding="utf-8")
    return pathlib.Path(path)


def _quoted(text: str) -> str:
    return "'" + text.replace("'", "''") + "'"


__all__ = ["Trajectory", "describe_method", "serve"]
