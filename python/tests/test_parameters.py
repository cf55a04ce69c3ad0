# SPDX-License-Identifier: BSD-3-Clause
"""For every parameter of every class: the default is within the bounds and accepted; a value beyond a bound is rejected by name."""
import math

import numpy as np
import pytest

import tumble

NEEDED = {
    "AngularRateSmoother": {"lever_arm_m": (0.0, 0.0, 0.0)},
    "MotionRegimeSmoother": {"lever_arm_m": (0.0, 0.0, 0.0)},
    "AngularRateStream": {"lever_arm_m": (0.0, 0.0, 0.0)},
    "MotionRegimeStream": {"lever_arm_m": (0.0, 0.0, 0.0)},
    "Saave": {"lever_arm_m": (0.0, 0.0, 0.0), "saturation_point_rad_s": 10.0},
    "HandHeldSmoother": {}, "Vqf": {}, "TumbleAttitude": {}, "Strapdown": {}, "ImuDataSheet": {}, "LidarDataSheet": {},
    "RollingSmoother": {"radius_m": 0.145},
    "RollingOdometry": {"units": [(tumble.sheets.phidget1044(), np.eye(4))], "radius_m": 0.145},
    "LidarInertialOdometry": {"T_IL": np.eye(4)},
    "TumblingOdometry": {"imu": tumble.sheets.mti30(), "T_IL": np.eye(4), "lever_arm_m": (0.0, 0.0, 0.0)},
}
LISTED = [(name, parameter) for name in NEEDED for parameter in getattr(tumble, name).parameters()]


def make(name, **more):
    return getattr(tumble, name)(**(NEEDED[name] | more))


def test_lists_are_not_empty():
    assert len(LISTED) > 300
    for name in NEEDED:
        listed = getattr(tumble, name).parameters()
        assert listed and len({p.name for p in listed}) == len(listed), name
        assert all(p.meaning and p.unit for p in listed)


@pytest.mark.parametrize(("name", "parameter"), LISTED, ids=[f"{name}.{p.name}" for name, p in LISTED])
def test_bounds_of(name, parameter):
    vector = isinstance(parameter.default, tuple)
    wrap = (lambda x: (0.0 if parameter.low <= 0 else parameter.default[0], x, 0.0)) if vector else (lambda x: x)
    coordinates = parameter.default if vector else (parameter.default,)
    if parameter.name not in NEEDED[name]:  # has a default
        assert all(parameter.low <= x <= parameter.high for x in coordinates)
    beyond = [math.nan] if parameter.high > 1e300 else [parameter.high * 1.01 + 1.0, math.nan]
    whole = isinstance(parameter.default, (bool, int)) and not isinstance(parameter.default, float)
    for value in [*beyond, parameter.low - 1.0]:
        with pytest.raises(tumble.TumbleError) as caught:
            make(name, **{parameter.name: wrap(value)})
        assert caught.value.trouble == "out_of_range"
        assert caught.value.field == parameter.name
        assert caught.value.bound
    if whole and parameter.high > parameter.low + 0.5:
        with pytest.raises(tumble.TumbleError, match="whole number"):
            make(name, **{parameter.name: parameter.low + 0.5})
    for wrong in ("1", None, [1.0, 2.0]):
        with pytest.raises(tumble.TumbleError) as caught:
            make(name, **{parameter.name: wrong})
        assert caught.value.trouble in ("type", "shape")


@pytest.mark.parametrize("name", NEEDED)
def test_defaults_are_accepted_and_unknown_names_are_not(name):
    listed = getattr(tumble, name).parameters()
    needed = NEEDED[name]
    make(name, **{p.name: p.default for p in listed if p.name not in needed})
    for wrong in ("nonsense", listed[0].name + "s", ""):
        with pytest.raises(tumble.TumbleError) as caught:
            make(name, **{wrong: 1.0})
        assert caught.value.trouble == "unknown"
        assert caught.value.value == wrong
        assert f" keywords of {name} (nearest: " in str(caught.value)
        assert len(str(caught.value)) < 500, "not some 200 names"
    with pytest.raises(tumble.TumbleError, match=f"nearest: {listed[0].name}"):
        make(name, **{listed[0].name + "s": 1.0})


@pytest.mark.parametrize(("name", "key"), [(name, key) for name, needed in NEEDED.items() for key in needed])
def test_what_has_no_default_must_be_given(name, key):
    given = {k: v for k, v in NEEDED[name].items() if k != key}
    with pytest.raises(tumble.TumbleError) as caught:
        getattr(tumble, name)(**given)
    assert (caught.value.trouble, caught.value.field) == ("empty", key)


def test_numbers_arrive():
    """Setting a parameter changes the results; setting it to its default does not."""
    from conftest import spinning
    samples = spinning(rail=7.0)[:3]
    run = lambda **options: tumble.Vqf(**options).add_imu(*samples).quaternion
    tau = next(p for p in tumble.Vqf.parameters() if p.name == "tau_s")
    assert np.array_equal(run(), run(tau_s=tau.default))
    assert not np.array_equal(run(), run(tau_s=2 * tau.default))
    assert tumble.ImuDataSheet(rate_hz=250).rate_hz == 250.0


def test_relations_between_parameters_name_the_field():
    """An error of a library constructor reaches Python with field, value and bound."""
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.AngularRateStream(lever_arm_m=(0, 0, 0), period_s=1e-4, lag_s=10.0)
    assert caught.value.trouble == "out_of_range"
    assert caught.value.field and caught.value.bound and isinstance(caught.value.value, float)


@pytest.mark.parametrize("T_IL", [np.eye(3), 2 * np.eye(4), np.full((4, 4), np.nan), np.diag([1, 1, -1, 1]), "x", np.ones((4, 4))])
def test_refuses_what_is_no_transform(T_IL):
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.LidarInertialOdometry(T_IL=T_IL)
    assert caught.value.field == "T_IL"


@pytest.mark.parametrize("key", ["imu", "lidar"])
def test_refuses_another_sheet(key):
    with pytest.raises(tumble.TumbleError) as caught:
        make("TumblingOdometry", **{key: 5})
    assert (caught.value.trouble, caught.value.field) == ("type", key)


@pytest.mark.parametrize("value", [10**400, 10**5000, 1j, np.array([8.0, 9.0]), np.array([]), "8", None.__class__, [8.0]],
                         ids=["beyond_a_double", "beyond_a_text", "complex", "two", "none_at_all", "text", "class", "list"])
@pytest.mark.parametrize("make", [
    lambda v: tumble.ImuDataSheet(gyro_range_rad_s=v), lambda v: tumble.MotionRegimeStream(lever_arm_m=(0, 0, 0), gyro_range_rad_s=v),
    lambda v: tumble.RollingSmoother(radius_m=v)])
def test_what_is_no_number_is_refused(make, value):
    """Values that Python cannot convert to a float are rejected."""
    with pytest.raises(tumble.TumbleError) as caught:
        make(value)
    assert (caught.value.trouble, caught.value.bound) == ("type", "a number")
    assert caught.value.field in ("gyro_range_rad_s", "radius_m")
