# SPDX-License-Identifier: BSD-3-Clause
"""A saved run gives calibration, map and pose to a new object. Invalid bytes are rejected and leave the object unchanged."""
import copy

import numpy as np
import pytest
from conftest import spinning

import tumble

LEVER = (0.05, 0.0, 0.0)


def tumbling():
    return tumble.TumblingOdometry(imu=tumble.sheets.mti30(), T_IL=np.eye(4), lever_arm_m=LEVER, lag_s=0.1)


def rolling():
    return tumble.RollingOdometry(units=[(tumble.sheets.phidget1044(), np.eye(4))], radius_m=0.145)


MAKERS = {"tumbling": tumbling, "rolling": rolling}


@pytest.fixture(params=MAKERS.values(), ids=MAKERS.keys())
def make(request):
    return request.param


@pytest.fixture(scope="module")
def samples():
    """Samples of a spin that clips at 10 rad/s."""
    return spinning(rail=10.0)[:3]


def cut(samples, first, last=None):
    return [rows[first:last] for rows in samples]


def test_a_loaded_object_starts_at_the_saved_pose(make, samples):
    first, second = make(), make()
    assert second.load(first.save()) is None, "no pose yet"
    first.add_imu(*cut(samples, 0, 250))
    pose = second.load(first.save())
    second.add_imu(*cut(samples, 0, 50))
    if make is rolling:  # without sweeps, TumblingOdometry has no pose
        assert pose.time_ns == samples[0][249] and np.allclose(pose.position, first.newest().position[0])
        assert second.save() != first.save()


def test_streams_and_copies(samples):
    assert not hasattr(tumble.AngularRateStream(lever_arm_m=LEVER), "save")
    stream = tumble.AngularRateStream(lever_arm_m=LEVER)
    stream.add_imu(*cut(samples, 0, 150))
    other = copy.copy(stream)
    assert np.array_equal(stream.add_imu(*cut(samples, 150)).rate, other.add_imu(*cut(samples, 150)).rate)


def test_damaged_bytes_are_refused_and_change_nothing(make, samples):
    odometry = make()
    odometry.add_imu(*cut(samples, 0, 250))
    saved = odometry.save()
    other = make()
    other.add_imu(*cut(samples, 0, 40))
    before = other.save()
    flipped = [saved[:k] + bytes([saved[k] ^ 0x10]) + saved[k + 1:] for k in (*range(40), len(saved) // 2, len(saved) - 1)]
    for damaged in (b"", saved[:39], saved[:40], saved[: len(saved) // 2], saved[:-1], saved + b"\0", bytes(len(saved)), *flipped):
        with pytest.raises(tumble.TumbleError) as caught:
            other.load(damaged)
        assert caught.value.trouble in ("insufficient_data", "out_of_range") and "state" in caught.value.field
    for no_bytes in ("text", 5, bytearray(saved), np.frombuffer(saved, np.uint8)):
        with pytest.raises(tumble.TumbleError) as caught:
            other.load(no_bytes)
        assert (caught.value.trouble, caught.value.field) == ("type", "state")
    assert other.save() == before, "the object is unchanged"
    other.load(saved)


def test_another_rig_is_refused():
    with pytest.raises(tumble.TumbleError, match="kind of the saved state"):
        tumbling().load(rolling().save())
    other = tumble.RollingOdometry(units=[(tumble.sheets.phidget1044(), np.eye(4))], radius_m=0.2)
    with pytest.raises(tumble.TumbleError) as caught:
        other.load(rolling().save())
    assert (caught.value.field, caught.value.value, caught.value.bound) == ("radius_m", 0.145, 0.2)


def test_a_map_is_kept(samples):
    """Saves TumblingOdometry after sweeps of four walls and a floor; a new object localises in this map."""
    points = np.stack(np.meshgrid(np.linspace(-2, 2, 40), np.linspace(-2, 2, 30)), -1).reshape(-1, 2)
    cloud = np.concatenate([np.c_[np.full(len(points), side), points] for side in (-3.0, 3.0)] + [
        np.c_[points, np.full(len(points), -1.0)], np.c_[points[:, :1], np.full((len(points), 1), 4.0), points[:, 1:]]]).astype(np.float32)
    offset = np.linspace(0, 99e6, len(cloud)).astype(np.uint32)

    def feed(which, last):
        out = []
        for k in range(last):
            which.add_imu(*cut(samples, 10 * k, 10 * (k + 1)))
            which.add_sweep(k * 100_000_000, (k + 1) * 100_000_000, cloud, offset)
            out += which.take_all()
        return out

    first, second = tumbling(), tumbling()
    feed(first, 8)
    assert len(first.map().position) > 100
    pose = second.load(first.save())
    assert np.linalg.norm(pose.position) < 0.05
    with_map = feed(second, 8)
    assert not feed(tumbling(), 8)[-1].result.in_prior_map and with_map[-1].result.in_prior_map
