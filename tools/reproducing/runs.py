# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program and reads its databases of scores.

All files are in one work folder. Complete estimates are not computed again, so a stopped run continues.
"""
from __future__ import annotations

import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field


ROOT = pathlib.Path(__file__).resolve().parents[2]


class ProgramFailed(RuntimeError):
    """The program ended with an exit status other than 0. The message contains the command and its errors."""


class RunRejected(ProgramFailed):
    """The simulation rejected a run, for example because the robot was wedged in the ground."""


@dataclass
class Runs:
    """One build of the program with one work folder.

    program  path of `tumble`
    folder   databases, recordings and estimates
    seeds    first and last seed of the simulated runs, both included
    jobs     number of parallel processes of a sweep
    """

    program: pathlib.Path
    folder: pathlib.Path
    seeds: tuple[int, int]
    jobs: int = 1
    commands: list[str] = field(default_factory=list)  #: commands as shown on a page, in the order of the calls

    @property
    def draws(self) -> list[int]:
        return list(range(self.seeds[0], self.seeds[1] + 1))

    def call(self, *words: object, unseen: Iterable[object] = ()) -> str:
        """Runs `tumble words... unseen... --quiet` in the work folder and returns what it prints. Pages show the command without `unseen`."""
        texts = [str(word) for word in words]
        command = " ".join(["tumble", *texts]).replace(f"{ROOT}/", "")
        if command not in self.commands:
            self.commands.append(command)
        print(f"reproduce: {command}", file=sys.stderr, flush=True)
        self.folder.mkdir(parents=True, exist_ok=True)
        ended = subprocess.run([str(self.program), *texts, *map(str, unseen), "--quiet"], cwd=self.folder, capture_output=True, text=True)
        if ended.returncode != 0:
            failure = RunRejected if "the simulation rejected the run" in ended.stderr else ProgramFailed
            raise failure(f"{command}: exit status {ended.returncode}: {ended.stderr.strip()}")
        return ended.stdout

    def sweep(self, name: str, suite: object, methods: Iterable[str] = (), scenario: str = "", keep: bool = False,
              last: int = 0) -> Scores:
        """Runs a suite (many simulated runs) into NAME.db, or continues it, and returns its scores.

        scenario  runs only this scenario of the suite; empty: all
        keep      keeps recording and estimates of each simulated run (`kept`)
        last      last seed, if it differs from `seeds`
        """
        words: list[object] = ["sweep", suite]
        if scenario:
            words += ["--scenario", scenario]
        words += ["--seeds", f"{self.seeds[0]}..{min(last or self.seeds[1], self.seeds[1])}"]
        for method in methods:
            words += ["--method", method]
        words += ["--examples", 0, *(["--keep", "all"] if keep else []), "--db", f"{name}.db"]
        self.call(*words, unseen=("--jobs", self.jobs))
        return Scores(self.folder / f"{name}.db")

    def kept(self, name: str, scenario: str, seed: int) -> pathlib.Path:
        """Returns the folder of one kept simulated run: `recording.h5` and `estimates/KIND-METHOD`."""
        return self.folder / f"{name}.db.files" / "kept" / scenario / str(seed)

    def estimate(self, recording: pathlib.Path, method: str, folder: pathlib.Path, settings: Iterable[str] = ()) -> pathlib.Path:
        """Runs one method on a recording. settings: METHOD.PARAMETER=NUMBER. Returns the folder of the estimate."""
        if not (folder / "estimate.json").is_file():
            shutil.rmtree(folder, ignore_errors=True)
            recording, target = (os.path.relpath(path, self.folder) for path in (recording, folder))
            words = ["estimate", recording, "--method", method]
            for setting in settings:
                words += ["--set", setting]
            self.call(*words, "-o", target)
        return folder

    def record(self, scenario: object, seed: int, recording: pathlib.Path) -> pathlib.Path:
        """Simulates one run of a scenario."""
        if not recording.is_file():
            recording.parent.mkdir(parents=True, exist_ok=True)
            self.call("record", scenario, "--seed", seed, "-o", os.path.relpath(recording, self.folder))
        return recording


class Scores:
    """The scores in a results database. A method with a varied parameter has the name `KIND/NAME KEY=VALUE`."""

    def __init__(self, path: pathlib.Path):
        with sqlite3.connect(f"file:{path.resolve()}?mode=ro", uri=True) as database:
            plain = "SELECT seed, kind || '/' || method, metric, value FROM scores"
            varied = "SELECT seed, kind || '/' || method || ' ' || varied || '=' || setting, metric, value FROM curves"
            self.rows = database.execute(f"{plain} UNION ALL {varied}").fetchall()

    def of(self, method: str, metric: str) -> dict[int, float]:
        """Returns the values of one method by seed, without the runs on which the method failed or has no such score."""
        return {seed: value for seed, name, found, value in self.rows if (name, found) == (method, metric) and value is not None}

    def values(self, method: str, metric: str, seeds: Iterable[int] | None = None, failed: float = float("inf")) -> list[float]:
        """Returns the values of the runs with these seeds; the default is all runs. A run without a value has the value `failed`."""
        values = self.of(method, metric)
        return [values.get(seed, failed) for seed in (self.seeds(method) if seeds is None else seeds)]

    def seeds(self, method: str) -> list[int]:
        """Returns the seeds of all runs of the method, including failed runs."""
        return sorted({seed for seed, name, *_ in self.rows if name == method})
