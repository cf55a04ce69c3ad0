# SPDX-License-Identifier: BSD-3-Clause
"""TumblingOdometry as a pipeline of evalio. Sweeps and poses go through the compiled half; here are its parameters."""
from __future__ import annotations

from typing import Any

import numpy as np

from .. import _tumble
from .needed import needed_bindings

#: What a data set of evalio states: the noise densities, gravity and rate of its ImuParams, the range of its LidarParams.
_STATED = ("gravity_m_s2",)
#: What evalio's data sets do not say and the estimator takes: parameter of the pipeline to its default.
_BESIDE = {"gyro_range_rad_s": 0.0, "accel_range_m_s2": 0.0,
           **{f"own_body_{end}_{axis}_m": 0.0 for end in ("low", "high") for axis in "xyz"}}


def _coordinate(parameter: Any, axis: str) -> str:
    """The axis stands before the unit: lever_arm_x_m."""
    suffix = "_" + parameter.unit.replace("^", "").replace("/", "_").replace(" ", "_")
    if parameter.name.endswith(suffix):
        return f"{parameter.name.removesuffix(suffix)}_{axis}{suffix}"
    return f"{parameter.name}_{axis}"


class Tumble(needed_bindings().Feed):  # type: ignore[misc]  # a class of the compiled half, which has no stubs
    """TumblingOdometry: a body that tumbles, with an IMU whose gyro may clip and a lidar whose sweeps are bent.

    Poses are of the IMU, at its samples inside of sweeps: each sweep's last word, 0.3 s after its end. `evalio run` ends when
    it hands out the last sweep, so that the last half second has no pose; finish() gives it to who feeds the pipeline himself. The parameters are those of
    `tumble.TumblingOdometry.parameters()` that a data set does not state, and those that it cannot: lever arm from the centre of mass
    to the IMU (IMU axes), ranges of the IMU (0: not stated), the box of the robot's own returns (lidar axes; all 0: none).
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
        out: dict[str, bool | int | float | str] = dict(_BESIDE)
        for parameter in _tumble.TumblingOdometry.parameters():
            if parameter.name in _STATED:
                continue
            default = parameter.default
            if isinstance(default, tuple):
                # the lever arm has no default, and no data set states it: zero unless it is given
                known = [0.0 if np.isnan(value) else value for value in default]
                out |= {_coordinate(parameter, axis): value for axis, value in zip("xyz", known, strict=True)}
            else:
                out[parameter.name] = default
        return out

    def set_params(self, params: dict[str, bool | int | float | str]) -> dict[str, bool | int | float | str]:
        """Takes what it knows, returns the rest."""
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
        """TumbleError with field, value and bound for a parameter beyond its bounds."""
        self.begin(_tumble.TumblingOdometry(**self.options()), round(1e9 / self._lidar.rate))

    def options(self) -> dict[str, Any]:
        """Keywords of TumblingOdometry."""
        given = self.default_params() | self._given
        beside = {name: given.pop(name) for name in _BESIDE}
        options: dict[str, Any] = {
            "imu": _tumble.ImuSheet(rate_hz=self._imu.rate, gyro_noise_rad_s_sqrt_hz=self._imu.gyro,
                                    accel_noise_m_s2_sqrt_hz=self._imu.accel, gyro_range_rad_s=beside["gyro_range_rad_s"],
                                    accel_range_m_s2=beside["accel_range_m_s2"]),
            "lidar": _tumble.LidarSheet(range_min_m=self._lidar.min_range, range_max_m=self._lidar.max_range),
            "gravity_m_s2": float(np.linalg.norm(self._imu.gravity)), "T_IL": self._T_IL}
        body = [[beside[f"own_body_{end}_{axis}_m"] for axis in "xyz"] for end in ("low", "high")]
        if np.any(body):
            options["own_body_L"] = body
        for parameter in _tumble.TumblingOdometry.parameters():
            if isinstance(parameter.default, tuple):
                options[parameter.name] = [given.pop(_coordinate(parameter, axis)) for axis in "xyz"]
        return options | given
