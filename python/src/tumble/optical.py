# SPDX-License-Identifier: BSD-3-Clause
"""Uses the attitudes of motion-capture cameras as a reference for an IMU. Attitudes are (N, 4), x y z w, body to world; times are (N,) int64, ns."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import TumbleError
from .recordings import Imu
from .truth import Truth

Array = npt.NDArray[Any]
GRAVITY_M_S2 = 9.80665


def nearest(value: Any) -> Array:
    """Rounds to int64, ties away from zero."""
    return np.asarray(np.copysign(np.floor(np.abs(value) + 0.5), value), np.int64)


def upper_median(values: Array) -> Any:
    """Returns the median, or the larger of the two middle values."""
    return np.sort(values)[len(values) // 2]


def _product(a: Array, b: Array) -> Array:
    v, w = a[..., :3], a[..., 3:]
    u, s = b[..., :3], b[..., 3:]
    return np.concatenate([w * u + s * v + np.cross(v, u), w * s - (v * u).sum(-1, keepdims=True)], axis=-1)


def _inverse(q: Array) -> Array:
    return np.asarray(q * np.array([-1.0, -1.0, -1.0, 1.0]))


def _rotated(q: Array, v: Array) -> Array:
    t = 2.0 * np.cross(q[..., :3], v)
    return v + q[..., 3:] * t + np.cross(q[..., :3], t)


def _rotation_vector(q: Array) -> Array:
    """Returns rotation vectors with an angle of at most pi."""
    norm = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(norm, np.abs(q[..., 3:]))
    return np.where(norm > 0.0, angle / np.where(norm > 0.0, norm, 1.0), 0.0) * np.where(q[..., 3:] < 0.0, -1.0, 1.0) * q[..., :3]


def _slerp(a: Array, b: Array, share: Array) -> Array:
    cosine = (a * b).sum(-1)
    angle = np.arccos(np.minimum(np.abs(cosine), 1.0))
    sine = np.sin(angle)
    linear = np.abs(cosine) >= 1.0 - np.finfo(float).eps
    safe = np.where(linear, 1.0, sine)
    first = np.where(linear, 1.0 - share, np.sin((1.0 - share) * angle) / safe)
    second = np.where(linear, share, np.sin(share * angle) / safe) * np.where(cosine < 0.0, -1.0, 1.0)
    return np.asarray(first[:, None] * a + second[:, None] * b)


def _angles(q: Array) -> Array:
    """Returns the angle between each attitude and the next."""
    turn = _product(_inverse(q[:-1]), q[1:])
    return np.asarray(2.0 * np.arctan2(np.linalg.norm(turn[:, :3], axis=1), np.abs(turn[:, 3])))


def steady_stamps(time_ns: Array, before_ns: Array, after_ns: Array) -> Array:
    """Restores time stamps that were rounded to a grid coarser than the sample period.

    Each stamp is moved, within its bounds, to a line through ten neighbours on either side, up to the next gap. A gap is a step that
    exceeds 1.3 times the median step plus the bounds.
    """
    count = len(time_ns)
    k = np.arange(count)
    steps = np.diff(time_ns)
    gap = np.append(True, steps > 1.3 * upper_median(steps) + (before_ns + after_ns)[1:])
    piece = np.maximum.accumulate(np.where(gap, k, 0))
    starts = np.append(np.flatnonzero(gap), count)
    piece_last = starts[np.searchsorted(starts, k, side="right")] - 1
    first, last = np.maximum(piece, k - 10), np.minimum(piece_last, k + 10)
    at = k[:, None] + np.arange(-10, 11)
    inside = (at >= first[:, None]) & (at <= last[:, None])
    at = np.clip(at, 0, count - 1)
    u = np.where(inside, at - k[:, None], 0).astype(float)
    v = np.where(inside, time_ns[at] - time_ns[:, None] + 0.5 * (after_ns - before_ns)[at], 0.0)
    n, x, y, xx, xy = inside.sum(1), u.sum(1), v.sum(1), (u * u).sum(1), (u * v).sum(1)
    determinant = n * xx - x * x
    offset = nearest(np.where(determinant > 0.0, (y * xx - x * xy) / np.where(determinant > 0.0, determinant, 1.0), y / n))
    return time_ns + np.where(np.abs(offset) > 1000, np.clip(offset, -before_ns, after_ns), 0)


def interpolated(time_ns: Array, values: Array, at_ns: Array) -> Array:
    """Interpolates linearly; before the first and after the last value, the nearest value is used."""
    after = np.searchsorted(time_ns, at_ns)
    inside = np.clip(after, 1, len(time_ns) - 1)
    share = ((at_ns - time_ns[inside - 1]) / (time_ns[inside] - time_ns[inside - 1]))[:, None]
    between = (1.0 - share) * values[inside - 1] + share * values[inside]
    return np.asarray(np.where((after == 0)[:, None], values[0], np.where((after == len(time_ns))[:, None], values[-1], between)))


def rates(time_ns: Array, q: Array, at_ns: Array) -> Array:
    """Returns the angular rate in body axes at the increasing times `at_ns`: the derivative of a parabola through the rotation vectors.

    The window is +-20 ms, or two median steps if they are longer. The rate is NaN if the window has a gap of more than 2.5 median steps,
    fewer than three attitudes, or no attitude on one side. Among windows of 10 to 70 ms, 20 ms gives the smallest error at unclipped
    samples of three hand-held recordings of RepoIMU (median 0.05 to 0.12 rad/s).
    """
    step = float(upper_median(np.diff(time_ns)))
    reach, gap = nearest(1.01 * max(20e6, 2.0 * step)), nearest(2.5 * step)
    first, end = np.searchsorted(time_ns, at_ns - reach), np.searchsorted(time_ns, at_ns + reach, side="right")
    gaps = np.append(0, np.cumsum(np.diff(time_ns) > gap))
    out = np.full((len(at_ns), 3), np.nan)
    kept = np.flatnonzero(end - first >= 3)
    kept = kept[gaps[end[kept] - 1] == gaps[first[kept]]]
    begins, ends = time_ns[first[kept]] - at_ns[kept], time_ns[end[kept] - 1] - at_ns[kept]
    kept = kept[(begins <= gap // 2 - reach) & (ends >= reach - gap // 2) & (begins < 0) & (ends > 0)]
    if len(kept) == 0:
        return out
    first, end, at_ns = first[kept, None], end[kept, None], at_ns[kept, None]
    window = first + np.arange((end - first).max())
    inside = window < end
    window = np.minimum(window, end - 1)
    distance = np.where(inside, np.abs(time_ns[window] - at_ns), np.iinfo(np.int64).max)
    middle = np.take_along_axis(window, distance.argmin(1)[:, None], 1)
    unit_s = 0.5e-9 * (time_ns[end - 1] - time_ns[first])  # normalises the time, for good conditioning
    u = 1e-9 * (time_ns[window] - at_ns) / unit_s
    rows = np.stack([np.ones_like(u), u, u * u], axis=-1) * inside[..., None]
    turns = _rotation_vector(_product(_inverse(q[middle]), q[window]))
    out[kept] = np.linalg.solve(rows.swapaxes(1, 2) @ rows, rows.swapaxes(1, 2) @ turns)[:, 1] / unit_s
    return out


def differences(period_ns: int, position: Array, q: Array, reach: int) -> tuple[Array, Array]:
    """Returns velocity and body rate of a regular series by central differences over `reach` samples on each side."""
    k = np.arange(len(q))
    before, after = np.maximum(k - reach, 0), np.minimum(k + reach, len(q) - 1)
    span_s = ((after - before) * (period_ns * 1e-9))[:, None]
    rate = _rotated(_product(_inverse(q), q[before]), _rotation_vector(_product(_inverse(q[before]), q[after]))) / span_s
    velocity = np.where(np.isfinite(rate[:, :1]), (position[after] - position[before]) / span_s, np.nan)
    return velocity, rate


def truth_of(time_ns: Array, q: Array, end_ns: int) -> Truth:
    """Returns a truth in steps of 1 ms that ends at `end_ns` or with the attitudes. In gaps above 2.5 median steps, it is unknown (NaN)."""
    period_ns = 1_000_000
    at_ns = np.arange(0, min(end_ns, int(time_ns[-1])) + 1, period_ns)
    after = np.searchsorted(time_ns, at_ns)
    before = np.maximum(after - 1, 0)
    exact = time_ns[after] == at_ns
    known = exact | ((after > 0) & (time_ns[after] - time_ns[before] <= upper_median(np.diff(time_ns)) * 5 // 2))
    share = np.where(exact, 1.0, (at_ns - time_ns[before]) / np.maximum(time_ns[after] - time_ns[before], 1))
    attitude = np.where(exact[:, None], q[after], _slerp(q[before], q[after], share))
    attitude[~known] = np.nan
    position = np.full((len(at_ns), 3), np.nan)
    velocity, rate = differences(period_ns, position, attitude, 70)
    return Truth(period_ns, position, attitude, velocity, rate)


def without_glitches(time_ns: Array, q: Array) -> tuple[Array, Array]:
    """Removes errors of the cameras: a norm that differs from 1 by more than 1 %, repeated attitudes before a jump, and jumps.

    A jump is a step whose rate exceeds the rates before and after by more than 10 rad/s; these are medians of four steps, three to six
    steps away. The three samples on either side of a jump, and the samples between two jumps less than 0.5 s apart, are also removed.
    """
    norm = np.linalg.norm(q, axis=1)
    sound = np.abs(norm - 1.0) <= 1e-2
    time_ns, q = time_ns[sound], q[sound] / norm[sound, None]
    angles = _angles(q)
    kept = np.ones(len(q), bool)
    starts = np.flatnonzero(np.append(True, (np.diff(q, axis=0) != 0.0).any(axis=1)))
    for first, last in zip(starts[:-1], starts[1:] - 1, strict=True):
        if last > first and last + 2 < len(q) and angles[last] > max(0.02, 1.5 * angles[last + 1]):
            kept[first + 1:last + 1] = False
    time_ns, q = time_ns[kept], q[kept]
    speed = _angles(q) / (1e-9 * np.diff(time_ns))
    limit = np.maximum(_beside(speed), _beside(speed[::-1])[::-1]) + 10.0
    kept = np.ones(len(q), bool)
    leaps: list[list[int]] = []
    for step in np.flatnonzero(speed > limit).tolist():
        if leaps and step <= leaps[-1][1] + 3:
            leaps[-1][1] = step
        else:
            leaps.append([step, step])
    away = False  # between a jump and its return
    for k, (first, last) in enumerate(leaps):
        kept[max(first - 3, 0):last + 5] = False
        pair = away and time_ns[first] - time_ns[leaps[k - 1][1]] < 500_000_000
        if pair:
            kept[max(leaps[k - 1][1] - 3, 0):first + 4] = False
        away = not pair
    return time_ns[kept], q[kept]


def _beside(speed: Array) -> Array:
    """Returns the lower median of the speeds three to six steps before each step; 0 without such a step."""
    at = np.arange(len(speed))[:, None] - np.arange(3, 7)
    ordered = np.sort(np.where(at >= 0, speed[at], np.inf), axis=1)
    count = (at >= 0).sum(1)
    return np.where(count > 0, np.take_along_axis(ordered, np.maximum(count - 1, 0)[:, None] // 2, 1)[:, 0], 0.0)


def aligned(time_ns: Array, q: Array, imu: Imu) -> tuple[Array, Array]:
    """Returns the attitudes of the IMU in a world with z up, in the IMU's clock, from the attitudes of the cameras.

    Only samples whose gyro readings are below 0.9 of the extreme reading of each axis are used. The first delay has the largest correlation
    of |w| within +-0.1 s; robust least squares refine it. The rotation solves Wahba's problem (Markley and Crassidis, Fundamentals of
    Spacecraft Attitude Determination and Control, 2014, section 5.3) for rates and gravity. The vertical is the mean specific force, which
    assumes that the body ends with about its initial position and speed. Raises TumbleError `insufficient_data` for fewer than 200 samples.
    """
    speed = np.linalg.norm(imu.gyro, axis=1)
    free = (speed >= 0.5) & (np.abs(imu.gyro) <= 0.9 * np.abs(imu.gyro).max(axis=0)).all(axis=1)
    if min(len(time_ns), free.sum()) < 200:
        raise TumbleError("the reference cannot be aligned; it must have 200 samples with rotation below saturation", "insufficient_data", "samples",
                          int(free.sum()), 200)
    delay_s = _delay(time_ns, q, imu.time_ns[free], speed[free])
    shift = nearest(delay_s * 1e9)
    w, pose = _reference(time_ns, q, imu.time_ns + shift)
    known = np.isfinite(w).all(axis=1)
    pairs = free & known
    gyro, accel, w, pairs_pose = imu.gyro[pairs], imu.accel[pairs], w[pairs], pose[pairs]
    weight = 1.0 / ((1.0 + (np.linalg.norm(accel, axis=1) - GRAVITY_M_S2) ** 2) * 25.0)
    q_IV = np.array([0.0, 0.0, 0.0, 1.0])
    for _ in range(20):
        up = _up(pose[known], imu.accel[known], q_IV)
        gravity = GRAVITY_M_S2 * _rotated(_inverse(pairs_pose), up)
        q_IV = _closest_rotation(gyro.T @ w / (0.15**2 * 5.0) + (accel * weight[:, None]).T @ gravity)
    up = _up(pose[known], imu.accel[known], q_IV)
    level = np.append(np.cross(up, [0.0, 0.0, 1.0]), 1.0 + up[2])
    out = _product(_product(level / np.linalg.norm(level), q), _inverse(q_IV))
    return time_ns - shift, out / np.linalg.norm(out, axis=1, keepdims=True)


def _delay(time_ns: Array, q: Array, at_ns: Array, speed: Array) -> float:
    def seen(delay_s: float) -> Array:
        return np.asarray(np.linalg.norm(rates(time_ns, q, at_ns + nearest(delay_s * 1e9)), axis=1))

    def correlation(delay_s: float) -> float:
        found = seen(delay_s)
        known = np.isfinite(found)
        return float(np.corrcoef(speed[known], found[known])[0, 1]) if known.sum() > 1 else -1.0

    delay_s = max((1e-3 * ms for ms in range(-100, 101, 5)), key=correlation)
    for _ in range(4):
        before, now, after = (seen(delay_s + step) for step in (-4e-3, 0.0, 4e-3))
        error, slope = speed - now, (after - before) / 8e-3
        used = np.isfinite(slope) & (np.abs(error) <= 3.0 * upper_median(np.abs(error[np.isfinite(error)])))
        delay_s += float(np.clip((slope[used] @ error[used]) / (slope[used] @ slope[used]), -0.05, 0.05))
    return delay_s


def _reference(time_ns: Array, q: Array, at_ns: Array) -> tuple[Array, Array]:
    """Returns rates and attitudes of the cameras at given times."""
    after = np.clip(np.searchsorted(time_ns, at_ns), 1, len(time_ns) - 1)
    share = (at_ns - time_ns[after - 1]) / (time_ns[after] - time_ns[after - 1])
    return rates(time_ns, q, at_ns), _slerp(q[after - 1], q[after], share)


def _up(pose: Array, accel: Array, q_IV: Array) -> Array:
    total = _rotated(pose, _rotated(_inverse(q_IV), accel)).sum(axis=0)
    return np.asarray(total / np.linalg.norm(total))


def _closest_rotation(B: Array) -> Array:
    """Returns the rotation R with the largest trace(R^T B): the eigenvector of the largest eigenvalue of Davenport's matrix."""
    K = np.empty((4, 4))
    K[:3, :3] = B + B.T - np.trace(B) * np.eye(3)
    K[3, :3] = K[:3, 3] = B[2, 1] - B[1, 2], B[0, 2] - B[2, 0], B[1, 0] - B[0, 1]
    K[3, 3] = np.trace(B)
    q = np.linalg.eigh(K)[1][:, 3]
    return np.where(q[3] < 0.0, -q, q)
