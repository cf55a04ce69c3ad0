#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What the installed package consists of: wheel_check.py ENVIRONMENT. Ends with 1 where it is more, or less, than it should be."""
import importlib.metadata
import pathlib
import subprocess
import sys

SYSTEM = {"libstdc++.so.6", "libm.so.6", "libgcc_s.so.1", "libc.so.6", "ld-linux-x86-64.so.2", "linux-vdso.so.1"}
LARGEST_MB = 4.0


def problems_of(files: dict[str, float], libraries: set[str]) -> list[str]:
    """`files`: path in the package to its size in MB."""
    out = []
    if beyond := libraries - SYSTEM:
        out.append(f"needs shared libraries that not every system has: {', '.join(sorted(beyond))}")
    if (size := sum(files.values())) > LARGEST_MB:
        out.append(f"is of {size:.1f} MB, must be {LARGEST_MB} at most")
    out += [f"{path} is of the library's development and no part of the package" for path in files if path.endswith((".hpp", ".a", ".cmake"))]
    out += [f"has no {needed}" for needed in ("tumble/py.typed", "tumble/_tumble.pyi", "tumble/__init__.py") if needed not in files]
    return out


def main() -> int:
    controls = [({}, set()), ({"tumble/py.typed": 0, "tumble/_tumble.pyi": 9, "tumble/__init__.py": 0}, set()),
                ({"tumble/py.typed": 0, "tumble/_tumble.pyi": 0, "tumble/__init__.py": 0}, {"libpcl_common.so"})]
    if not all(problems_of(*control) for control in controls):
        print("a negative control passes")
        return 1
    files = {str(f): pathlib.Path(f.locate()).stat().st_size / 1e6 for f in importlib.metadata.files("tumble") or [] if "__pycache__" not in str(f)}
    module = [importlib.metadata.distribution("tumble").locate_file(f) for f in files if f.endswith(".so")]
    if len(module) != 1:
        print(f"has {len(module)} compiled modules, must have one")
        return 1
    listed = subprocess.run(["ldd", str(module[0])], check=True, capture_output=True, text=True).stdout
    found = problems_of(files, {pathlib.Path(line.split()[0]).name for line in listed.splitlines() if line.strip()})
    for problem in found:
        print(f"the package {problem}")
    print(f"package of {sum(files.values()):.2f} MB in {len(files)} files")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
