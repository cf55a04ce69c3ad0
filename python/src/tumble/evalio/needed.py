# SPDX-License-Identifier: BSD-3-Clause
"""Imports evalio and the compiled part, which are optional dependencies."""
from __future__ import annotations

import importlib
from typing import Any

from ..errors import TumbleError


def _trouble(message: str, found: Any, bound: str) -> TumbleError:
    return TumbleError(message, "evalio", "evalio", found, bound)


def needed_evalio() -> Any:
    """Returns the module evalio. Raises TumbleError `evalio` if it is missing."""
    try:
        return importlib.import_module("evalio")
    except ModuleNotFoundError as error:
        raise _trouble("this module needs evalio; install it with: pip install 'evalio>=0.6.1,<0.7'", None, ">= 0.6.1, < 0.7") from error


def needed_bindings() -> Any:
    """Returns the module tumble_evalio. Raises TumbleError `evalio` if it is missing or was compiled for another evalio."""
    tag = needed_evalio()._abi_tag()
    try:
        bindings = importlib.import_module("tumble_evalio")
        bindings.require_abi(tag)
    except ModuleNotFoundError as error:
        raise _trouble("this module needs tumble-evalio; install it with: pip install ./python/evalio", None, "tumble-evalio") from error
    except (ImportError, RuntimeError) as error:
        raise _trouble(f"tumble-evalio is not compatible with the installed evalio: {error}", tag, "the ABI of tumble-evalio") from error
    return bindings
