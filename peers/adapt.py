# SPDX-License-Identifier: BSD-3-Clause
"""Runs one published estimator on a recording: adapt.py ADAPTER RECORDING OUTPUT [ARGUMENT...].
Prints its version with adapt.py --version ADAPTER PACKAGE. Prints time and memory as JSON with adapt.py --time ADAPTER
RECORDING OUTPUT [ARGUMENT...].

ADAPTER is a file of the folder adapters. Its function `run(recording, *arguments)` returns time stamps with poses or
attitudes. The script levels them (poses.py) and writes a TUM file."""
import ctypes
import hashlib
import importlib
import importlib.metadata
import json
import pathlib
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import poses  # noqa: E402
import recording  # noqa: E402


def version(adapter: str, package: str) -> str:
    """Returns the version of the package, and a digest of the adapter's files."""
    digest = hashlib.sha256()
    for file in ("adapt.py", "frames.py", "poses.py", "recording.py", f"adapters/{adapter}.py"):
        digest.update((HERE / file).read_bytes())
    return f"{package} {importlib.metadata.version(package)}, adapter {digest.hexdigest()[:12]}"


class TimedSweeps(list):
    """Measures the processor time from each sweep to the next, of all threads. An adapter reads the sweeps in one loop."""
    def __iter__(self):
        self.spent_ms: list[float] = []
        for sweep in super().__iter__():
            start_s = time.process_time()
            yield sweep
            self.spent_ms.append(1e3 * (time.process_time() - start_s))


def resident_mib(row: str) -> float:
    """Returns the resident memory (VmRSS), or its peak (VmHWM)."""
    return int(pathlib.Path("/proc/self/status").read_text().split(f"{row}:")[1].split()[0]) / 1024


def main(arguments: list[str]) -> None:
    if arguments[0] == "--version":
        print(version(*arguments[1:]))
        return
    timed = arguments[0] == "--time"
    adapter, source, output, *rest = arguments[1:] if timed else arguments
    sensors = recording.read(source)
    module = importlib.import_module(f"adapters.{adapter}")
    if timed:
        sensors.sweeps = TimedSweeps(sensors.sweeps)
        ctypes.CDLL(None).malloc_trim(0)  # returns freed memory of the recording
        pathlib.Path("/proc/self/clear_refs").write_text("5")  # resets VmHWM
    before_mib = resident_mib("VmRSS")
    track = module.run(sensors, *rest)
    after_mib = resident_mib("VmHWM")
    poses.write_tum(output, poses.levelled(track, sensors))
    if timed:
        print("\n" + json.dumps({"ms": sensors.sweeps.spent_ms, "mib": after_mib - before_mib, "poses": len(track.time_ns)}))


main(sys.argv[1:])
