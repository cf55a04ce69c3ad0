# SPDX-License-Identifier: BSD-3-Clause
"""For evalio (PyPI `evalio`): our pipeline `tumble`, and recordings of this harness as its data set `tumble`.

    EVALIO_CUSTOM=tumble.evalio evalio run -d tumble/hill_1 -p tumble -p kiss -o out

Needs evalio 0.6.1 or newer and the compiled half: `pip install ./python ./python/evalio`. What is missing, or of another ABI, is
TumbleError `evalio` here: evalio itself passes over an ImportError and does not say why.
"""
from .pipeline import Tumble
from .poses import read_poses
from .recordings import Recordings

__all__ = ["Recordings", "Tumble", "read_poses"]
