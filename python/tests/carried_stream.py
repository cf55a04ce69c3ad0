# SPDX-License-Identifier: BSD-3-Clause
"""Compares HandHeldRateStream with the batch smoother, MotionRegimeStream and the gyro: median and 90 % quantile of the error where the gyro clips, rad/s.

    python carried_stream.py SEED...     SEED: seeds of the scenario `twirl`; the script calls the program
"""
import pathlib
import sys
import tempfile

import numpy as np

import tumble


def errors(seed, folder):
    recording = tumble.read(tumble.record("twirl", folder / f"{seed}.h5", seed=seed))
    imu, truth = recording.imus[0], recording.truth.imu_rate[0]
    stated = {"gravity_m_s2": recording.gravity_m_s2, "gyro_range_rad_s": imu.gyro_range_rad_s, "accel_range_m_s2": imu.accel_range_m_s2}
    stream = tumble.HandHeldRateStream(period_s=imu.period_ns * 1e-9, **stated)
    own = tumble.Rates.joined([stream.add_imu(*imu.samples), stream.flush()])
    batch = tumble.HandHeldSmoother(**stated).estimate(*imu.samples)[0]
    clipped = batch.clipped_axes != 0
    rates = {"gyro": imu.gyro, "HandHeldRateStream": own.rate, "HandHeldSmoother": batch.rate,
            "MotionRegimeStream": tumble.rate(imu, recording.gravity_m_s2, live=True).rate}
    print(seed, f"{np.count_nonzero(clipped)} clipped, {np.count_nonzero((own.clipped_axes != 0) != clipped)} called otherwise by the stream", end="")
    for name, rate in rates.items():
        error = np.linalg.norm(rate - truth, axis=1)[clipped]
        print(f"; {name} {np.median(error):.3f} / {np.quantile(error, 0.9):.3f}", end="")
    print()


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        for given in sys.argv[1:]:
            errors(int(given), pathlib.Path(made))
