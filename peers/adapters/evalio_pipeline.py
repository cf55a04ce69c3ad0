# SPDX-License-Identifier: BSD-3-Clause
"""Runs any pipeline of evalio (Potokar, Kaess 2025, PyPI evalio): DLIO, LIO-SAM, CT-ICP, MAD-ICP, LOAM, FORM.

Settings are evalio's defaults, which are those of the pipelines' authors, and the additional KEY=VALUE of a peer's
YAML. The calls have the order of evalio's Experiment.setup. The poses are those of the IMU. MAD-ICP deskews, because
points have times. Its option `realtime` is off, because it limits the computing time.

`shift_s=T` is an option of this adapter. It corrects time stamps of a pipeline that states the start of a sweep,
although its pose belongs to another time. Each shift is the one with the smallest error on `stroll`. A pose that is
identical to the previous one is left out, because LIO-SAM skips sweeps within its mappingProcessInterval."""
import numpy as np
from evalio import pipelines, types
from evalio._cpp import helpers

from poses import Track
from recording import SEQUENCE_NS, Recording, Sweep

ORIGIN_NS = 1_000_000_000_000  # the times of the package are unsigned
SWEEP_NS = 100_000_000
RINGS, COLUMNS = 16, SWEEP_NS // SEQUENCE_NS
FIELDS = np.dtype([("x", "f4"), ("y", "f4"), ("z", "f4"), ("intensity", "f4"), ("t", "u4"), ("range", "u4"), ("ring", "u2")])
TYPES = {"f4": "FLOAT32", "u4": "UINT32", "u2": "UINT16"}


def value(text: str, like):
    """Converts the text of a parameter to the type of its default."""
    return text == "true" if isinstance(like, bool) else type(like)(text)


def cloud(sweep: Sweep) -> types.LidarMeasurement:
    """Returns a dense row-major cloud, in which cells without a return are zero."""
    cells = sweep.organised(RINGS, COLUMNS)
    there = cells >= 0
    k = cells[there]
    out = np.zeros((RINGS, COLUMNS), FIELDS)
    out["ring"], out["t"] = np.arange(RINGS)[:, None], np.arange(COLUMNS)[None, :] * SEQUENCE_NS
    for axis, name in enumerate("xyz"):
        out[name][there] = sweep.points_L_m[k, axis]
    out["intensity"][there], out["t"][there] = sweep.intensity[k], sweep.offset_ns[k]
    out["range"][there] = 1000.0 * np.linalg.norm(sweep.points_L_m[k], axis=1)
    metadata = helpers.PointCloudMetadata(stamp=types.Stamp.from_nsec(ORIGIN_NS + sweep.start_ns), width=COLUMNS, height=RINGS,
                                          point_step=FIELDS.itemsize, row_step=FIELDS.itemsize * COLUMNS, is_bigendian=0, is_dense=1)
    fields = [helpers.Field(name=name, datatype=getattr(helpers.DataType, TYPES[kind.str[1:]]), offset=offset)
              for name, (kind, offset) in FIELDS.fields.items()]
    measurement = helpers.pc2_to_evalio(metadata, fields, out.tobytes())
    helpers.fill_col_row_major(measurement)
    return measurement


def run(sensors: Recording, name: str, *settings: str) -> Track:
    pipeline = pipelines.get_pipeline(name)()
    parameters = pipeline.default_params()
    shift_ns = 0
    for key, text in (setting.split("=", 1) for setting in settings):
        if key == "shift_s":
            shift_ns = int(round(float(text) * 1e9))
            continue
        parameters[key] = value(text, parameters[key])
    unused = pipeline.set_params(parameters)
    if unused:
        raise SystemExit(f"{name} does not know {sorted(unused)}")
    pipeline.set_imu_params(types.ImuParams(gyro=sensors.gyro_noise_rad_s_sqrt_hz, accel=sensors.accel_noise_m_s2_sqrt_hz,
                                            gravity=np.array([0.0, 0.0, -sensors.gravity_m_s2]), rate=1e9 / sensors.period_ns))
    pipeline.set_lidar_params(types.LidarParams(num_rows=RINGS, num_columns=COLUMNS, min_range=0.3, max_range=100.0, rate=10.0))
    T_IL = sensors.T_IL
    pipeline.set_imu_T_lidar(types.SE3(types.SO3.from_mat(T_IL[:3, :3]), T_IL[:3, 3]))
    pipeline.initialize()
    track, fed = Track([], [], "imu"), 0

    def take() -> None:
        for stamp, pose in pipeline.saved_estimates():
            T_WI, time_ns = np.array(pose.to_mat()), stamp.to_nsec() - ORIGIN_NS + shift_ns
            if time_ns < 0 or (track.T_WA and np.array_equal(T_WI, track.T_WA[-1])):
                continue
            track.time_ns.append(time_ns)
            track.T_WA.append(T_WI)

    for sweep in sensors.sweeps:
        upto = sensors.until(sweep.end_ns, fed)
        for k in range(fed, upto):
            pipeline.add_imu(types.ImuMeasurement(types.Stamp.from_nsec(ORIGIN_NS + int(sensors.time_ns[k])),
                                                  sensors.gyro_I_rad_s[k], sensors.accel_I_m_s2[k]))
        fed = upto
        pipeline.add_lidar(cloud(sweep))
        take()
    return track
