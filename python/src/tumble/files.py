# SPDX-License-Identifier: BSD-3-Clause
"""Imports optional packages, and writes files that are either complete or absent."""
from __future__ import annotations

import contextlib
import importlib
import os
import pathlib
import tempfile
from collections.abc import Iterator
from typing import Any


def optional(module: str, extra: str) -> Any:
    """Imports an optional package. If it is missing, raises ImportError with the install command. Errors within the package are not caught."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
        raise ImportError(f"this function needs the package {module}; install it with: pip install 'tumble[{extra}]'") from error


@contextlib.contextmanager
def beside(path: str | os.PathLike[str]) -> Iterator[str]:
    """Yields a temporary name in the folder of `path`. On success the file is renamed to `path`; on an exception it is deleted."""
    target = pathlib.Path(path)
    handle, part = tempfile.mkstemp(prefix=f".{target.name}.", dir=target.parent)
    os.close(handle)
    try:
        yield part
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(part, 0o666 & ~umask)
        os.replace(part, target)
    except BaseException:
        pathlib.Path(part).unlink(missing_ok=True)
        raise
