# SPDX-License-Identifier: BSD-3-Clause
"""TumblingOdometry as an evalio pipeline. This file handles the parameters; the compiled part handles sweeps and poses."""
from __future__ import annotations

from typing import Any

import numpy as np

from .. import _tumble
from .needed import needed_bindings

#: Parameters of TumblingOdometry that an evalio data set states.
_STATED = ("gravity_m_s2",)
#: Additional parameters of the pipeline, which evalio's data sets do not state: name to default.
_ADDITIONAL = {"gyro_range_rad_s": 0.0, "accel_range_m_s2": 0.0,
           **{f"own_body_{end}_{axis}_m": 0.0 for end in ("low", "high") for axis in "xyz"}}


def _coordinate(parameter: Any, axis: str) -> str:
    """Returns the name of one coordinate, with the axis before the unit: lever_arm_x_m."""
    suffix = "_" + parameter.unit.replace("^", "").replace("/", "_").replace(" ", "_")
    if parameter.name.endswith(suffix):
        return f"{parameter.name.removesuffix(suffix)}_{axis}{suffix}"
    return f"{parameter.name}_{axis}"


class Tumble(needed_bindings().Feed):  # type: ignore[misc]  # the compiled part has no stubs
    """TumblingOdometry as a pipeline: a tumbling body with an IMU whose gyro may clip, and a lidar with motion-distorted sweeps.

    The poses are final (smoothed) poses of the IMU at its samples within sweeps, 0.3 s after the end of each sweep. `evalio run` ends
    with the last sweep, so the last half second has no pose; callers that run the pipeline themselves get these poses by finish().
    The parameters are those of `tumble.TumblingOdometry.parameters()` that a data set does not state, and three more: lever arm from
    the centre of mass to the IMU (IMU axes), ranges of the IMU (0: not stated), and the box of the robot's own returns (lidar axes;
    all 0: none).
    """

    def __init__(self) -> None:
        super().__init__()
        self._given: dict[str, Any] = {}
        self._imu: Any = None
        self._lidar: Any = None
        self._T_IL = np.eye(4)

    @staticmethod
    def name() -> str:
        return "tumble"

    @staticmethod
    def version() -> str:
        from .. import __version__

        return __version__

    @staticmethod
    def url() -> str:
        return "-"

    @staticmethod
    def default_params() -> dict[str, bool | int | float | str]:
        out: dict[str, bool | int | float | str] = dict(_ADDITIONAL)
        for parameter in _tumble.TumblingOdometry.parameters():
            if parameter.name in _STATED:
                continue
            default = parameter.default
            if isinstance(default, tuple):
                # the lever arm has no default and no data set states it, so zero is used
                known = [0.0 if np.isnan(value) else value for value in default]
                out |= {_coordinate(parameter, axis): value for axis, value in zip("xyz", known, strict=True)}
            else:
                out[parameter.name] = default
        return out

    def set_params(self, params: dict[str, bool | int | float | str]) -> dict[str, bool | int | float | str]:
        """Stores the known parameters and returns the others."""
        known = self.default_params()
        self._given |= {name: value for name, value in params.items() if name in known}
        return {name: value for name, value in params.items() if name not in known}

    def set_imu_params(self, params: Any) -> None:
        self._imu = params

    def set_lidar_params(self, params: Any) -> None:
        self._lidar = params

    def set_imu_T_lidar(self, T: Any) -> None:
        self._T_IL = np.array(T.to_mat())

    def initialize(self) -> None:
        """Creates the estimator. Raises TumbleError with field, value and bound for a parameter beyond its bounds."""
        self.begin(_tumble.TumblingOdometry(**self.options()), round(1e9 / self._lidar.rate))

    def options(self) -> dict[str, Any]:
        """Returns the keywords of TumblingOdometry."""
        given = self.default_params() | self._given
        additional = {name: given.pop(name) for name in _ADDITIONAL}
        options: dict[str, Any] = {
            "imu": _tumble.ImuDataSheet(rate_hz=self._imu.rate, gyro_noise_rad_s_sqrt_hz=self._imu.gyro,
                                    accel_noise_m_s2_sqrt_hz=self._imu.accel, gyro_range_rad_s=additional["gyro_range_rad_s"],
                                    accel_range_m_s2=additional["accel_range_m_s2"]),
            "lidar": _tumble.LidarDataSheet(range_min_m=self._lidar.min_range, range_max_m=self._lidar.max_range),
            "gravity_m_s2": float(np.linalg.norm(self._imu.gravity)), "T_IL": self._T_IL}
        body = [[additional[f"own_body_{end}_{axis}_m"] for axis in "xyz"] for end in ("low", "high")]
        if np.any(body):
            options["own_body_L"] = body
        for parameter in _tumble.TumblingOdometry.parameters():
            if isinstance(parameter.default, tuple):
                options[parameter.name] = [given.pop(_coordinate(parameter, axis)) for axis in "xyz"]
        return options | given
