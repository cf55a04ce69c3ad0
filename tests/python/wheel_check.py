#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the contents of the installed package and of the folder of python/make_wheel: wheel_check.py ENVIRONMENT
FOLDER. Must run in this environment's interpreter. Exits with 1 if files are missing, unexpected or too large."""
import importlib.metadata
import pathlib
import re
import subprocess
import sys
import tarfile

SYSTEM = {"libstdc++.so.6", "libm.so.6", "libgcc_s.so.1", "libc.so.6", "ld-linux-x86-64.so.2", "linux-vdso.so.1"}
# 4.11 measured, 3.94 of them the estimator (functions that nothing calls are 0.02 of it); with a static library or headers it is of more
LARGEST_MB = 4.5


def problems_of(files: dict[str, float], libraries: set[str]) -> list[str]:
    """Checks the files of the package. `files`: size in MB by path in the package."""
    out = []
    if beyond := libraries - SYSTEM:
        out.append(f"needs shared libraries that not every system has: {', '.join(sorted(beyond))}")
    if (size := sum(files.values())) > LARGEST_MB:
        out.append(f"is of {size:.1f} MB, must be {LARGEST_MB} at most")
    out += [f"{path} is of the library's development and no part of the package" for path in files if path.endswith((".hpp", ".a", ".cmake"))]
    out += [f"has no {needed}" for needed in ("tumble/py.typed", "tumble/_tumble.pyi", "tumble/__init__.py") if needed not in files]
    return out


def problems_of_what_is_given_away(names: list[str], sources: list[str]) -> list[str]:
    """Checks the folder. `names`: files in the folder; `sources`: paths in the source distribution, without its first folder."""
    out = []
    wheels = [name for name in names if name.endswith(".whl")]
    if len(wheels) != 1 or not re.fullmatch(r"tumble-[\d.]+-(cp311-cp311|cp312-abi3)-(manylinux[\w.]+_x86_64)+\.whl", wheels[0]):
        out.append(f"has wheels {wheels}, must be one that says the C library it runs with")
    out += [f"has no {needed} among its sources" for needed in (
        "pyproject.toml", "CMakeLists.txt", "LICENSE", "bindings/module.cpp", "estimator/CMakeLists.txt", "estimator/include/tumble/tumble.hpp",
        "src/tumble/__init__.py") if needed not in sources]
    out += [f"has {path} among its sources" for path in sources if re.match(r"build/|tests/|evalio/", path)]
    return out


def main() -> int:
    controls = [({}, set()), ({"tumble/py.typed": 0, "tumble/_tumble.pyi": 9, "tumble/__init__.py": 0}, set()),
                ({"tumble/py.typed": 0, "tumble/_tumble.pyi": 0, "tumble/__init__.py": 0}, {"libpcl_common.so"})]
    given_away = [([], []), (["tumble-0.1.0-cp311-cp311-linux_x86_64.whl"], []), ([], ["build/x.o"])]
    if not all(problems_of(*control) for control in controls) or not all(problems_of_what_is_given_away(*each) for each in given_away):
        print("a negative control passes")
        return 1
    files = {str(f): pathlib.Path(f.locate()).stat().st_size / 1e6 for f in importlib.metadata.files("tumble") or [] if "__pycache__" not in str(f)}
    module = [importlib.metadata.distribution("tumble").locate_file(f) for f in files if f.endswith(".so")]
    if len(module) != 1:
        print(f"has {len(module)} compiled modules, must have one")
        return 1
    listed = subprocess.run(["ldd", str(module[0])], check=True, capture_output=True, text=True).stdout
    found = problems_of(files, {pathlib.Path(line.split()[0]).name for line in listed.splitlines() if line.strip()})
    folder = pathlib.Path(sys.argv[2])
    archives = list(folder.glob("*.tar.gz"))
    if len(archives) != 1:
        print(f"{folder} has {len(archives)} source distributions, must have one")
        return 1
    with tarfile.open(archives[0]) as archive:
        sources = [name.partition("/")[2] for name in archive.getnames()]
    found += problems_of_what_is_given_away([path.name for path in folder.iterdir()], sources)
    for problem in found:
        print(f"the package {problem}")
    for path in sorted(folder.iterdir()):
        print(f"{path.name}: {path.stat().st_size / 1e6:.2f} MB")
    print(f"package of {sum(files.values()):.2f} MB in {len(files)} files")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
