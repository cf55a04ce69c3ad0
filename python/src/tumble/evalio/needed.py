# SPDX-License-Identifier: BSD-3-Clause
"""evalio and the compiled half, which are no requirements of the package."""
from __future__ import annotations

import importlib
from typing import Any

from ..errors import TumbleError


def _trouble(message: str, found: Any, bound: str) -> TumbleError:
    return TumbleError(message, "evalio", "evalio", found, bound)


def needed_evalio() -> Any:
    """The module evalio. TumbleError `evalio` where it is missing."""
    try:
        return importlib.import_module("evalio")
    except ModuleNotFoundError as error:
        raise _trouble("this needs evalio: pip install 'evalio>=0.6.1,<0.7'", None, ">= 0.6.1, < 0.7") from error


def needed_bindings() -> Any:
    """The module tumble_evalio. TumbleError `evalio` where it is missing, or was compiled for another evalio."""
    tag = needed_evalio()._abi_tag()
    try:
        bindings = importlib.import_module("tumble_evalio")
        bindings.require_abi(tag)
    except ModuleNotFoundError as error:
        raise _trouble("this needs tumble-evalio: pip install ./python/evalio", None, "tumble-evalio") from error
    except (ImportError, RuntimeError) as error:
        raise _trouble(f"tumble-evalio does not go with the evalio that is here: {error}", tag, "the ABI of tumble-evalio") from error
    return bindings
