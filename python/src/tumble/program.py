# SPDX-License-Identifier: BSD-3-Clause
"""Calls the program `tumble` from Python: simulate, estimate, score, sweep. The program is built from the whole tree and is not part of
this package. The package searches the program in $TUMBLE_PROGRAM, then in $PATH."""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import sqlite3
import subprocess
import tempfile
import warnings
from collections.abc import Iterable, Mapping, Sequence
from numbers import Integral, Real
from typing import Any

from .checks import path_of, refusal, whole, wrong_type
from .errors import TumbleError
from .estimates import Estimate, read_estimate
from .files import optional

Path = str | os.PathLike[str]
Number = float | int


class ProgramError(RuntimeError):
    """The program failed by a defect or a signal. The message contains its output."""


def program() -> str:
    """Returns the path of the program. Raises TumbleError `program` if it is not found."""
    named = os.environ.get("TUMBLE_PROGRAM")
    found = shutil.which(named) if named else shutil.which("tumble")
    if found is None:
        place = f"$TUMBLE_PROGRAM ({named})" if named else "$PATH"
        raise TumbleError(f"the program tumble was not found in {place}; build the program (see README.md of the tree) or set TUMBLE_PROGRAM to its path", "program",
                          "TUMBLE_PROGRAM", named, "the program")
    return found


def call(verb: str, *words: Path | Number, timeout_s: float | None = None, accepted: Sequence[int] = (0,)) -> str:
    """Runs `tumble verb words... --quiet` and returns what it prints.

    Raises TumbleError `program` for wrong use, invalid input and failed checks (the value is the exit status) unless `accepted`
    contains the exit status, ProgramError for a defect, and subprocess.TimeoutExpired.
    """
    command = [program(), verb, *map(_word, words), "--quiet"]
    ended = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=timeout_s)
    if ended.returncode in accepted:
        return ended.stdout
    if ended.returncode in (1, 2):
        output = ended.stderr.strip() or ended.stdout.strip()
        raise TumbleError(output, "program", verb, ended.returncode, 0)
    raise ProgramError(f"{' '.join(command)} ended with exit status {ended.returncode}: {ended.stderr.strip()}")


def _word(word: Path | Number) -> str:
    if not isinstance(word, (str, os.PathLike, Real)):
        raise wrong_type("word", word, "a text, a path or a number")
    return os.fspath(word) if isinstance(word, (str, os.PathLike)) else _digits(word)


def _digits(number: Number | Real) -> str:
    """Returns a number as text for the program. The text of a numpy number contains its type, so it is converted first."""
    return repr(int(number) if isinstance(number, Integral) else float(number))


def _named(field: str, given: Path) -> str:
    """Returns a positional argument. Rejects texts that the program would read as an option."""
    text = path_of(field, given)
    if not text or text.startswith("-"):
        raise refusal("unknown", field, repr(text), "a name or a file (write ./-NAME for a file that starts with -)")
    return text


def _settings(settings: Mapping[str, Number] | None) -> list[str]:
    if settings is not None and not isinstance(settings, Mapping):
        raise wrong_type("settings", settings, "a dictionary of numbers by their names")
    for name, value in (settings or {}).items():
        if not isinstance(name, str) or not isinstance(value, Real):
            raise refusal("type", "settings", f"{name!r}: {value!r}", "numbers by their names")
    return [word for name, value in (settings or {}).items() for word in ("--set", f"{name}={_digits(value)}")]


def _methods(methods: Path | Iterable[Path]) -> list[str]:
    if isinstance(methods, (str, os.PathLike)):
        methods = (methods,)
    if not isinstance(methods, Iterable):
        raise wrong_type("methods", methods, "names, or files that describe a method")
    return [word for each in methods for word in ("--method", path_of("methods", each))]


def _seed(field: str, given: Any) -> int:
    return whole(field, given, 0, 2**64 - 1)


def record(scenario: Path, path: Path, seed: int = 1) -> pathlib.Path:
    """Simulates one draw of a scenario and writes its recording."""
    call("record", _named("scenario", scenario), "--seed", _seed("seed", seed), "-o", path_of("path", path))
    return pathlib.Path(path)


def estimate(recording: Path, method: Path, folder: Path, settings: Mapping[str, Number] | None = None) -> pathlib.Path:
    """Runs one method of the program on a recording and writes the folder of its estimate (`read_estimate`).

    settings: parameters by full name, for example {"rate/tumble_lag.lag_s": 0.5}.
    """
    call("estimate", _named("recording", recording), "--method", path_of("method", method), *_settings(settings), "-o",
         path_of("folder", folder))
    return pathlib.Path(folder)


def odometry(recording: Path, folder: Path | None = None, live: bool = False, options: Sequence[Path | Number] = (),
             timeout_s: float | None = None, base_frame: str | None = None) -> Estimate:
    """Estimates trajectory and map of an IMU and a lidar from a bag, with `tumble odometry`. Returns the estimate.

    recording: a ROS 1 bag, ROS 2 bag, MCAP file, recording (HDF5) or another file that `tumble import` reads.
    folder:    receives trajectory, map and replay page; must be new or empty. Default: the files are not kept.
    live:      uses past data only (`slam/tumble_live`).
    options:   further words of the command, for example ["--lever-arm", 0.1, 0, 0.02, "--imu-topic", "/imu"].
    base_frame frame of the bag's /tf_static, for example "base_link", whose poses are returned; None: the IMU. The option
               --T-base-imu states the pose of the IMU in a frame that /tf_static lacks.

    `poses` of the result are in a world with z up, at the times of the IMU. Warns if the method's own health rejects
    the estimate. Raises TumbleError for a recording that cannot be used; the message names the option that helps.
    """
    if isinstance(options, (str, os.PathLike)) or not isinstance(options, Sequence):
        raise wrong_type("options", options, "a list of words")
    words: list[Path | Number] = [_named("recording", recording), *options, *(["--live"] if live else []),
                                  *([] if base_frame is None else ["--base-frame", path_of("base_frame", base_frame)])]
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch) / "odometry" if folder is None else pathlib.Path(path_of("folder", folder))
        report = json.loads(call("odometry", *words, "-o", out, "--json", timeout_s=timeout_s, accepted=(0, 1)))
        if report["status"] == "diverged":
            warnings.warn(f"the estimate of {recording} is diverged: {report['message']}", stacklevel=2)
        return read_estimate(out)


def score(estimate: Path, recording: Path, kind: str | None = None, frame: str | None = None) -> dict[str, float | None]:
    """Scores an estimate (a folder, or a TUM file with kind "position" or "slam") against the ground truth of a recording.

    Returns the value of each metric; None for a metric without data to score.
    """
    words = [*(["--kind", kind] if kind else []), *(["--frame", frame] if frame else [])]
    scored = json.loads(call("score", _named("estimate", estimate), _named("recording", recording), *words, "--json"))
    return {row["metric"]: row["value"] for row in scored["scores"]}


def run(scenario: Path, seed: int = 1, methods: Path | Iterable[Path] = (), folder: Path | None = None,
        settings: Mapping[str, Number] | None = None) -> dict[str, Any]:
    """Simulates one draw of a scenario, runs methods and scores their estimates. With `folder`, also writes recording, estimates and pictures.

    methods: one or several names; default: all methods that apply. Returns the JSON output of the program.
    """
    words: list[Path | Number] = ["--seed", _seed("seed", seed), *_methods(methods), *_settings(settings)]
    if len(words) > 2 or folder is not None:
        words += ["-o", folder] if folder is not None else []
        return _run(scenario, words)
    # with a seed alone, the program would select methods and write to a folder named after the scenario
    with tempfile.TemporaryDirectory() as scratch:
        return _run(scenario, [*words, "-o", pathlib.Path(scratch) / "run"])


def _run(scenario: Path, words: Sequence[Path | Number]) -> dict[str, Any]:
    report: dict[str, Any] = json.loads(call("run", _named("scenario", scenario), *words, "--json"))
    return report


def sweep(suite: Path, db: Path, seeds: tuple[int, int] | None = None, methods: Path | Iterable[Path] = (), jobs: int | None = None,
          data: Path | None = None, timeout_s: float | None = None) -> Any:
    """Runs a suite, a suite's file or a scenario, stores the scores in a results database, and returns `results(db)`.

    seeds     first and last seed, both included; default: the seeds of the suite
    methods   one or several names, or files NAME.yaml that describe a command (`describe_method`); default: the methods of the suite
    jobs      number of concurrent processes; default: number of processors
    Results that the database already contains are not computed again. No pictures of single draws are written.
    """
    words: list[Path | Number] = ["--db", path_of("db", db), "--examples", 0, *_methods(methods)]
    if seeds is not None:
        if not isinstance(seeds, Sequence) or isinstance(seeds, str) or len(seeds) != 2:
            raise refusal("type", "seeds", repr(seeds), "the first and the last seed")
        words += ["--seeds", f"{_seed('seeds', seeds[0])}..{_seed('seeds', seeds[1])}"]
    if jobs is not None:
        words += ["--jobs", whole("jobs", jobs, 1, 2**31 - 1)]
    if data is not None:
        words += ["--data", data]
    call("sweep", _named("suite", suite), *words, timeout_s=timeout_s)
    return results(db)


def score_rows(db: Path) -> list[dict[str, Any]]:
    """Returns the rows of a results database as dictionaries: scenario, seed, kind, method, status, metric, value.

    An outcome without scores has one row whose metric is None.
    """
    path = pathlib.Path(path_of("db", db))
    if not path.is_file():
        raise TumbleError(f"{path} does not exist", "file", str(path), None, "a results database")
    connection = sqlite3.connect(f"file:{path.resolve()}?mode=ro", uri=True)
    try:
        cursor = connection.execute("SELECT scenario, seed, kind, method, status, metric, value FROM scores "
                                    "ORDER BY scenario, seed, kind, method, metric")
        names = [column[0] for column in cursor.description]
        rows = [dict(zip(names, row, strict=True)) for row in cursor]
    except sqlite3.DatabaseError as error:
        raise TumbleError(f"{path} is not a results database: {error}", "file", str(path), None, "a results database") from error
    finally:
        connection.close()
    for row in rows:
        row["seed"] %= 2**64  # the database stores the same bits as a signed number
    return rows


def results(db: Path) -> Any:
    """Returns `score_rows` as a pandas data frame: `pip install tumble[tables]`.

    This expression gives a table of one metric: `frame[frame.metric == "ate_m"].pivot(index="seed", columns="method", values="value")`.
    """
    pandas = optional("pandas", "tables")
    return pandas.DataFrame(score_rows(db), columns=["scenario", "seed", "kind", "method", "status", "metric", "value"])
