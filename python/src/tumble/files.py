# SPDX-License-Identifier: BSD-3-Clause
"""Files: packages that only some need, and results that are there whole or not at all."""
from __future__ import annotations

import contextlib
import importlib
import os
import pathlib
import tempfile
from collections.abc import Iterator
from typing import Any


def optional(module: str, extra: str) -> Any:
    """A package that is no requirement. ImportError says how to get it; what is wrong inside of it is its own error."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
        raise ImportError(f"this needs {module}: pip install 'tumble[{extra}]'") from error


@contextlib.contextmanager
def beside(path: str | os.PathLike[str]) -> Iterator[str]:
    """A name in the folder of `path` to write to; renamed to `path` in the end, or gone where something was raised."""
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
