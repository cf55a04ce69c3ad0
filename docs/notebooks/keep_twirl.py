# SPDX-License-Identifier: BSD-3-Clause
"""Writes twirl.h5, so that the first notebook needs only the Python package: keep_twirl.py [FILE.h5]

The recording contains the first 12 s of `tumble record twirl --seed 1`. The truth has the rate of the IMU, 100 Hz,
instead of the 2 kHz of the simulation. Needs the program.
"""
import dataclasses
import pathlib
import sys
import tempfile

import tumble

SECONDS = 12


def shortened(recording: tumble.Recording, count: int) -> tumble.Recording:
    """Returns the first `count` samples of the first IMU, with the truth at the times of these samples."""
    imu, truth = recording.imus[0], recording.truth
    step = imu.period_ns // truth.period_ns
    of_samples = {field.name: value[:count] for field in dataclasses.fields(truth.imus[0])
                  if getattr(value := getattr(truth.imus[0], field.name), "shape", ())[:1] == (len(imu),)}
    of_steps = {name: getattr(truth, name)[:(count + 1) * step:step]
                for name in ("position", "quaternion", "velocity", "rate", "label", "specific_force")}
    return dataclasses.replace(
        recording,
        imus=[dataclasses.replace(imu, **{name: getattr(imu, name)[:count] for name in ("time_ns", "gyro", "accel", "clip_flags")})],
        truth=dataclasses.replace(truth, period_ns=imu.period_ns, imus=[dataclasses.replace(truth.imus[0], **of_samples)], **of_steps))


def main() -> None:
    target = sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).with_name("twirl.h5")
    with tempfile.TemporaryDirectory() as folder:
        recording = tumble.read(tumble.record("twirl", pathlib.Path(folder) / "twirl.h5", seed=1))
    tumble.write(target, shortened(recording, SECONDS * 10**9 // recording.imus[0].period_ns))


if __name__ == "__main__":
    main()
