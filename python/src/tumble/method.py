# SPDX-License-Identifier: BSD-3-Clause
"""Runs a Python function as a method of the program, in runs, sweeps and gates.

    import tumble

    def rate(recording):
        return recording.imus[0].gyro

    if __name__ == "__main__":
        tumble.serve("rate", rate)

`tumble.describe_method("mine.yaml", "mine", "rate", "mine.py")` writes the description of this method. The program runs the file for each
simulated run in a separate process. The function receives the sensor data without the ground truth.
"""
from __future__ import annotations

import os
import pathlib
import re
import sys
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .checks import number_from, path_of, refusal, symmetric, unmasked, wrong_type
from .errors import TumbleError
from .estimates import Trajectory, write_tum
from .files import beside
from .recordings import Recording, read

KINDS = ("rate", "attitude", "position", "slam")
ROBOTS = ("rig", "sphere", "pendulum")
TIME_MAX_S = 1e6


def serve(kind: str, function: Callable[[Recording], Any], arguments: Sequence[str] | None = None) -> None:
    """Reads the recording, calls `function` with it, and writes the result to the file that the program requested.

    `function` returns, by kind:
    rate                 (N, 3), rad/s in axes of the first IMU, one row per sample; or a tuple of these rates and covariances (N, 3, 3); or an object with
                         `rate` and `covariance` (Rates)
    attitude             an object with time_ns and quaternion (Attitudes)
    position, slam       an object with time_ns, position and quaternion (Poses, Trajectory)
    """
    if kind not in KINDS:
        raise TumbleError(f"kind is '{kind}'; it must be one of {', '.join(KINDS)}", "unknown", "kind", kind, KINDS)
    words = sys.argv[1:] if arguments is None else list(arguments)
    if len(words) != 2:
        raise SystemExit(f"usage: {sys.argv[0]} RECORDING.h5 OUTPUT; tumble.describe_method explains how the program calls this script")
    recording = read(words[0], truth=False)
    result = function(recording)
    if kind == "rate":
        _write_rates(words[1], recording, result)
    else:
        write_tum(words[1], result)


def _write_rates(path: str, recording: Recording, result: Any) -> None:
    if hasattr(result, "rate"):
        rate, covariance = result.rate, getattr(result, "covariance", None)
    elif isinstance(result, tuple):
        if len(result) not in (1, 2):
            raise refusal("shape", "result", f"{len(result)} values", "rate, or rate and covariance")
        rate, covariance = (*result, None)[:2]
    else:
        rate, covariance = result, None
    times = recording.first_imu.time_ns
    rows = [unmasked("rate", rate).astype(float)]
    if rows[0].shape != (len(times), 3):
        raise TumbleError(f"rate is {rows[0].shape}; it must be {(len(times), 3)}", "shape", "rate", rows[0].shape, (len(times), 3))
    header = "time_ns,wx_rad_s,wy_rad_s,wz_rad_s"
    if covariance is not None:
        matrices = unmasked("covariance", covariance).astype(float)
        if matrices.shape != (len(times), 3, 3):
            raise TumbleError(f"covariance is {matrices.shape}; it must be {(len(times), 3, 3)}", "shape", "covariance", matrices.shape,
                              (len(times), 3, 3))
        symmetric("covariance", matrices)
        rows.append(matrices[:, [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]])
        header += ",cxx,cxy,cxz,cyy,cyz,czz"
    with beside(path) as part, open(part, "w", encoding="ascii") as out:
        print(header, file=out)
        for time_ns, numbers in zip(times.tolist(), np.concatenate(rows, axis=1).tolist(), strict=True):
            print(time_ns, *map(repr, numbers), sep=",", file=out)


def describe_method(path: str | os.PathLike[str], name: str, kind: str, script: str | os.PathLike[str], doc: str = "",
                    robots: Sequence[str] = (), time_limit_s: float = 600.0) -> pathlib.Path:
    """Writes the file that describes `script`, which calls `serve`, as a method named KIND/NAME. The program runs it with this interpreter.

    scenarios/external/EXTERNAL.md lists all keys of such files.
    """
    if kind not in KINDS:
        raise TumbleError(f"kind is '{kind}'; it must be one of {', '.join(KINDS)}", "unknown", "kind", kind, KINDS)
    _require_description(name, script, robots, time_limit_s)
    if isinstance(robots, str):
        robots = (robots,)
    quoted = [_quoted(word) for word in (sys.executable, str(pathlib.Path(script).resolve()), "{recording}", "{output}")]
    lines = [f"name: {_quoted(name)}", f"kind: {kind}", f"command: [{', '.join(quoted)}]", f"time_limit_s: {float(time_limit_s)!r}"]
    if doc:
        lines.append(f"doc: {_quoted(doc)}")
    if robots:
        lines.append(f"robots: [{', '.join(robots)}]")
    with beside(path_of("path", path)) as part:
        pathlib.Path(part).write_text("\n".join(lines) + "\n", encoding="utf-8")
    return pathlib.Path(path)


def _require_description(name: str, script: str | os.PathLike[str], robots: Sequence[str], time_limit_s: float) -> None:
    """Raises the errors that the program would report when it reads the file."""
    if not isinstance(name, str) or not re.fullmatch(r"[a-z][a-z0-9_]{0,99}", name):
        raise refusal("out_of_range", "name", repr(name), "a lower-case letter followed by lower-case letters, digits and underscores, at most 100 characters")
    if not pathlib.Path(path_of("script", script)).is_file():
        raise refusal("file", "script", os.fspath(script), "a file")
    if number_from("time_limit_s", time_limit_s, 0.0) == 0.0 or time_limit_s > TIME_MAX_S:
        raise refusal("out_of_range", "time_limit_s", time_limit_s, f"within (0, {TIME_MAX_S:g}]")
    if not isinstance(robots, Sequence):
        raise wrong_type("robots", robots, "names")
    for robot in (robots,) if isinstance(robots, str) else robots:
        if robot not in ROBOTS:
            raise refusal("unknown", "robots", repr(robot), f"one of {', '.join(ROBOTS)}")


def _quoted(text: str) -> str:
    return "'" + text.replace("'", "''") + "'"


__all__ = ["Trajectory", "describe_method", "serve"]
