# SPDX-License-Identifier: BSD-3-Clause
"""Plug-ins for evalio (PyPI `evalio`): the pipeline `tumble`, and recordings of this project as the data set `tumble`.

    EVALIO_CUSTOM=tumble.evalio evalio run -d tumble/hill_1 -p tumble -p kiss -o out

Needs evalio 0.6.1 or newer and the compiled part: `pip install ./python ./python/evalio`. A missing package or a different ABI raises
TumbleError `evalio`, because evalio ignores an ImportError without a message.
"""
from .pipeline import Tumble
from .poses import read_poses
from .recordings import Recordings

__all__ = ["Recordings", "Tumble", "read_poses"]
