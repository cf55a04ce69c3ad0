# SPDX-License-Identifier: BSD-3-Clause
"""Runs one published estimator on a recording: adapt.py ADAPTER RECORDING OUTPUT [ARGUMENT...].
Prints its version with adapt.py --version ADAPTER PACKAGE.

ADAPTER is a file of the folder adapters. Its function `run(recording, *arguments)` returns time stamps with poses or
attitudes. The script levels them (poses.py) and writes a TUM file."""
import hashlib
import importlib
import importlib.metadata
import pathlib
import sys

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


def main(arguments: list[str]) -> None:
    if arguments[0] == "--version":
        print(version(*arguments[1:]))
        return
    adapter, source, output, *rest = arguments
    sensors = recording.read(source)
    track = importlib.import_module(f"adapters.{adapter}").run(sensors, *rest)
    poses.write_tum(output, poses.levelled(track, sensors))


main(sys.argv[1:])
