# SPDX-License-Identifier: BSD-3-Clause
"""Estimators that were saved or pickled continue with the same bits. Invalid bytes are rejected and leave the estimator unchanged."""
import copy
import pickle

import numpy as np
import pytest
from conftest import spinning

import tumble

LEVER = (0.05, 0.0, 0.0)
SHEET = tumble.sheets.mti30()


def rows_of(out):
    """Returns all numbers in the results of a stream."""
    names = ("time_ns", "rate", "covariance", "quaternion", "position", "velocity")
    return [getattr(out, name).copy() for name in names if hasattr(out, name)]


class Stream:
    """A stream that returns results from add_imu."""

    def __init__(self, make, end="flush"):
        self.make, self.end = make, end

    def feed(self, stream, samples):
        return rows_of(stream.add_imu(*samples))

    def rest(self, stream):
        return rows_of(getattr(stream, self.end)()) if self.end else []


class Odometry(Stream):
    """An odometry class, whose results are requested after the samples."""

    def feed(self, odometry, samples):
        odometry.add_imu(*samples)
        return rows_of(odometry.take()) if isinstance(odometry, tumble.RollingOdometry) else []

    def rest(self, odometry):
        if isinstance(odometry, tumble.RollingOdometry):
            odometry.finish()
            return rows_of(odometry.take())
        return [*rows_of(odometry.newest_rate()), *rows_of(odometry.smoothed_rate()), odometry.rig().covariance.copy()]


STREAMS = {
    "rate": Stream(lambda: tumble.RateStream(lever_arm_m=LEVER, gyro_range_rad_s=10.0)),
    "regime": Stream(lambda: tumble.RegimeStream(lever_arm_m=LEVER, lag_s=0.1)),
    "carried": Stream(lambda: tumble.HandHeldStream(gyro_range_rad_s=10.0, lag_s=0.15)),
    "rolling_live": Stream(lambda: tumble.RollingFilter(radius_m=0.145), end=""),
    "rolling": Stream(lambda: tumble.RollingSmoother(radius_m=0.145, lag_s=0.2), end="finish"),
    "tumbling_odometry": Odometry(lambda: tumble.TumblingOdometry(imu=SHEET, T_IL=np.eye(4), lever_arm_m=LEVER, lag_s=0.1)),
    "rolling_odometry": Odometry(lambda: tumble.RollingOdometry(units=[(tumble.sheets.phidget1044(), np.eye(4))], radius_m=0.145)),
}


@pytest.fixture(params=STREAMS.values(), ids=STREAMS.keys())
def kind(request):
    return request.param


@pytest.fixture(scope="module")
def samples():
    """Samples of a spin that clips at 10 rad/s."""
    return spinning(rail=10.0)[:3]


def cut(samples, first, last=None):
    return [rows[first:last] for rows in samples]


def same(a, b):
    return len(a) == len(b) and all(np.array_equal(x, y, equal_nan=True) for x, y in zip(a, b, strict=True))


def loaded(kind, stream):
    out = kind.make()
    out.load(stream.save())
    return out


WAYS = {"load": loaded, "pickle": lambda _, stream: pickle.loads(pickle.dumps(stream)), "copy": lambda _, stream: copy.copy(stream)}


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS.keys())
@pytest.mark.parametrize("at", [0, 17, 150, 399])
def test_split_anywhere_gives_the_same_bits(kind, samples, way, at):
    whole = kind.make()
    kind.feed(whole, cut(samples, 0, at))
    other = way(kind, whole)
    assert other.save() == whole.save()
    assert same(kind.feed(whole, cut(samples, at)), kind.feed(other, cut(samples, at)))
    assert other.save() == whole.save() and len(whole.save()) > 1000
    assert same(kind.rest(whole), kind.rest(other))


def test_damaged_bytes_are_refused_and_change_nothing(kind, samples):
    stream = kind.make()
    kind.feed(stream, cut(samples, 0, 250))
    saved = stream.save()
    other = kind.make()
    kind.feed(other, cut(samples, 0, 40))
    before = other.save()
    flipped = [saved[:k] + bytes([saved[k] ^ 0x10]) + saved[k + 1:] for k in (*range(40), len(saved) // 2, len(saved) - 1)]
    for damaged in (b"", saved[:39], saved[:40], saved[: len(saved) // 2], saved[:-1], saved + b"\0", bytes(len(saved)), *flipped):
        with pytest.raises(tumble.TumbleError) as caught:
            other.load(damaged)
        assert caught.value.trouble in ("too_few", "out_of_range") and "state" in caught.value.field
        with pytest.raises(tumble.TumbleError):
            type(other).__new__(type(other)).__setstate__(damaged)
    for no_bytes in ("text", 5, bytearray(saved), np.frombuffer(saved, np.uint8)):
        with pytest.raises(tumble.TumbleError) as caught:
            other.load(no_bytes)
        assert (caught.value.trouble, caught.value.field) == ("type", "state")
    assert other.save() == before, "it is as it was"
    other.load(saved)
    assert other.save() == saved, "the control"


def test_other_parameters_are_named(samples):
    saved = tumble.RateStream(lever_arm_m=LEVER).save()
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.RateStream(lever_arm_m=LEVER, lag_s=0.3).load(saved)
    assert (caught.value.trouble, caught.value.field, caught.value.value, caught.value.bound) == ("out_of_range", "lag_s", 0.2, 0.3)
    with pytest.raises(tumble.TumbleError, match="kind of the saved state"):
        tumble.RegimeStream(lever_arm_m=LEVER).load(saved)


def test_a_map_is_kept(samples):
    """Saves TumblingOdometry after sweeps of four walls and a floor, and adds further sweeps to both copies."""
    points = np.stack(np.meshgrid(np.linspace(-2, 2, 40), np.linspace(-2, 2, 30)), -1).reshape(-1, 2)
    cloud = np.concatenate([np.c_[np.full(len(points), side), points] for side in (-3.0, 3.0)] + [
        np.c_[points, np.full(len(points), -1.0)], np.c_[points[:, :1], np.full((len(points), 1), 4.0), points[:, 1:]]]).astype(np.float32)
    offset = np.linspace(0, 99e6, len(cloud)).astype(np.uint32)
    odometry = tumble.TumblingOdometry(imu=SHEET, T_IL=np.eye(4), lever_arm_m=LEVER)

    def feed(which, first, last):
        out = []
        for k in range(first, last):
            which.add_imu(*cut(samples, 10 * k, 10 * (k + 1)))
            which.add_sweep(k * 100_000_000, (k + 1) * 100_000_000, cloud, offset)
            out += [sweep.report.pose.matrix.copy() for sweep in which.take_all()]
        return out

    feed(odometry, 0, 6)
    other = pickle.loads(pickle.dumps(odometry))
    a, b = feed(odometry, 6, 10), feed(other, 6, 10)
    assert len(a) >= 3 and same(a, b)
    assert len(odometry.map().position) > 100 and np.array_equal(odometry.map().position, other.map().position)
    assert odometry.save() == other.save()
