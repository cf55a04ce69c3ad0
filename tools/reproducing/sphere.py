# SPDX-License-Identifier: BSD-3-Clause
"""The rolling sphere: J. Zevering et al., IMU-based pose-estimation for spherical robots with limited resources, MFI 2021."""
from __future__ import annotations

import pathlib
import statistics
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from . import pictures
from .page import Table, finish, number, share
from .readings import Estimate, Recording, map_in_world, pose_distances, yaw_alignment
from .runs import Runs

HERE = pathlib.Path(__file__).resolve().parent
MADGWICK, COMPLEMENTARY, AUTOGAIN, OURS = ATTITUDES = ("attitude/madgwick", "attitude/complementary", "attitude/autogain",
                                                       "attitude/tumble")
ROTATION, FUSED, BATCH, LIVE = "position/rolling", "position/autogain_fusion", "position/tumble", "position/tumble_live"
WIDE = f"{FUSED} with the diameter"  # the code of the MFI paper uses the sphere's diameter, but the paper's equation uses the radius
POSITIONS = (ROTATION, FUSED, WIDE, BATCH, LIVE)
# gain of the MFI paper; its weight of 0.02 per sample, converted at our 250 Hz to a time constant: -dt / ln(1 - 0.02)
SETTINGS = {MADGWICK: f"{MADGWICK}.gain_rad_s=0.2", COMPLEMENTARY: f"{COMPLEMENTARY}.tau_s=0.198", WIDE: f"{FUSED}.radius_m=0.29"}
MAPS = ("slam/poses_rolling", "slam/poses_autogain_fusion", "slam/poses_tumble", "slam/rolling_prior")
LABELS = dict(zip(ATTITUDES + POSITIONS + MAPS, (
    "Madgwick, gain 0.2", "complementary, 0.02", "Autogain (published)", "ours",
    "rotation alone", "published fusion", "published fusion, radius 0.29 m", "ours, whole recording", "ours, live",
    "rotation alone", "published fusion", "ours, IMU alone", "ours, IMU and lidar")))
COLOURS = dict(zip(ATTITUDES + POSITIONS, (pictures.RAW, "tab:green", pictures.PUBLISHED, pictures.OURS,
                                           pictures.RAW, pictures.PUBLISHED, "tab:olive", pictures.OURS, pictures.LIVE)))
SLOW, FAST = "slow_roll", "roll"  # scenario with the speed of the MFI paper, and scenario of the catalogue
SLIP, SLIDE, FAST_SLIP = "slip_l", "slide_l", "slip"
BELOW_M = 0.1  # points farther below the floor are errors of the map, not noise of the lidar
MAP_DRAWS = 8
TRACKER_HZ = 120.0  # rate of the optical tracker in the MFI paper, at which the paper computes the derivative
SETTLING = 75  # number of omitted samples at the start and at the end of a standstill, while the filters settle
MOVING_RAD_S = 0.05
DRAWN_STEP_DEG = 1e-5  # smaller steps are drawn at this value


def reproduce(runs: Runs, folder: pathlib.Path, check: bool) -> list[str]:
    """Runs the missing sweeps, then writes sphere.md and its pictures to `folder`. With `check`, only returns the lines that differ."""
    last = min(runs.seeds[0] + MAP_DRAWS - 1, runs.seeds[1])
    runs.sweep("sphere_roll", "slip", [OURS, AUTOGAIN], scenario=FAST, keep=True)
    runs.sweep("sphere_slip", "slip", (ROTATION, FUSED, BATCH, LIVE), scenario=FAST_SLIP, keep=True)
    runs.sweep("sphere_maps", "slip", MAPS, scenario=FAST, keep=True, last=last)
    turns = {name: [turning(runs, name, seed) for seed in runs.draws] for name in (SLOW, FAST)}
    legs = {name: [leg(runs, name, seed) for seed in runs.draws] for name in (SLIP, SLIDE, FAST_SLIP)}
    maps = {seed: rolled_map(runs, seed) for seed in range(runs.seeds[0], last + 1)}
    if not check:
        draw_jitter(turns[SLOW][0], folder / "sphere_jitter.png")
        draw_distance(turns[SLOW][0], folder / "sphere_distance.png")
        draw_paths(legs[SLIP], folder / "sphere_slip.png")
        draw_paths(legs[SLIDE], folder / "sphere_slide.png")
        draw_legs(legs, folder / "sphere_legs.png")
        draw_map(maps, folder / "sphere_map.png")
    return finish(folder / "sphere.md", page(runs, turns, legs, maps), check)


def situation(runs: Runs, scenario: str, seed: int) -> tuple[pathlib.Path, Callable[[str], pathlib.Path]]:
    """Returns the recording of one simulated run, and a function that returns the folder of a method's estimate.

    Runs of catalogue scenarios come from the sweeps. Runs of the scenario files in tools/reproducing are simulated one by one.
    """
    own = HERE / f"{scenario}.yaml"
    kept = runs.folder / f"sphere_{scenario}" / str(seed) if own.is_file() else runs.kept(f"sphere_{scenario}", scenario, seed)
    recording = kept / "recording.h5"
    if own.is_file():
        runs.record(own, seed, recording)

    def estimate(method: str) -> pathlib.Path:
        name = method.replace("/", "-").replace(" ", "_")
        swept = kept / "estimates" / name
        if swept.is_dir():
            return swept
        settings = [SETTINGS[method]] if method in SETTINGS else []
        return runs.estimate(recording, method.split()[0], runs.folder / f"sphere_{scenario}_estimates" / str(seed) / name, settings)

    return recording, estimate


@dataclass
class Turning:
    """Attitudes of one rolling sphere: angle to the truth per method, and steps at standstill."""

    time_s: np.ndarray
    moving: slice
    distance_deg: dict[str, np.ndarray]
    rest_step_rad: dict[str, np.ndarray]  # rotation vectors (N, 3) between successive samples before the motion
    mean_rate_rad_s: float  # mean rate while the sphere moves

    def at_tracker(self, method: str) -> tuple[np.ndarray, np.ndarray]:
        """Returns times in s and angles to the truth in degrees while the sphere moves, at the sample rate of the optical tracker in the MFI paper."""
        time_s = self.time_s[self.moving]
        grid = np.arange(time_s[0], time_s[-1], 1 / TRACKER_HZ)
        return grid, np.interp(grid, time_s, self.distance_deg[method][self.moving])


def turning(runs: Runs, scenario: str, seed: int) -> Turning:
    path, estimate_of = situation(runs, scenario, seed)
    recording = Recording(path)
    rate_rad_s = np.linalg.norm(recording.true_rate_rad_s, axis=1)
    turns = np.flatnonzero(rate_rad_s > MOVING_RAD_S)
    moving = slice(int(turns[0]), int(turns[-1]) + 1)
    distance, steps = {}, {}
    for method in ATTITUDES:
        estimate = Estimate(estimate_of(method))
        time_s, angle_rad = pose_distances(recording, estimate)
        distance[method] = np.degrees(np.interp(recording.time_s, time_s, angle_rad))
        R = estimate.poses()[2][SETTLING:moving.start - SETTLING]
        steps[method] = small_rotations(np.swapaxes(R[:-1], 1, 2) @ R[1:])
    return Turning(recording.time_s, moving, distance, steps, float(rate_rad_s[moving].mean()))


def small_rotations(R: np.ndarray) -> np.ndarray:
    """Converts rotations (N, 3, 3) far below one radian to rotation vectors (N, 3) in rad."""
    return np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1) / 2


@dataclass
class Leg:
    """One simulated run along an L: paths seen from above in m, aligned in yaw at the start, and lengths of both legs."""

    true_path_m: np.ndarray
    path_m: dict[str, np.ndarray]
    true_legs_m: tuple[float, float]
    legs_m: dict[str, tuple[float, float]]


def leg(runs: Runs, scenario: str, seed: int) -> Leg:
    path, estimate_of = situation(runs, scenario, seed)
    recording = Recording(path)
    true_path = recording.true_pose(recording.time_s, "centre")[0][:, :2]
    corner = corner_of(true_path)
    paths = {m: path_above(recording, Estimate(estimate_of(m))) for m in POSITIONS}
    lengths = {m: legs_of(estimated, corner) for m, estimated in paths.items()}
    return Leg(true_path - true_path[0], paths, legs_of(true_path, corner), lengths)


def corner_of(path_m: np.ndarray) -> int:
    """Returns the index of the corner of an L: the point farthest from the line between its ends."""
    along = path_m[-1] - path_m[0]
    offset = path_m - path_m[0]
    return int(np.argmax(np.abs(along[0] * offset[:, 1] - along[1] * offset[:, 0])))


def legs_of(path_m: np.ndarray, corner: int) -> tuple[float, float]:
    """Returns the distances from the start to the corner and from the corner to the end."""
    return float(np.linalg.norm(path_m[corner] - path_m[0])), float(np.linalg.norm(path_m[-1] - path_m[corner]))


def path_above(recording: Recording, estimate: Estimate) -> np.ndarray:
    """Returns the estimated path of the centre at the samples of the IMU (N, 2), in the true axes, from its start."""
    time_s, p, R = estimate.poses()
    _, R_true = recording.true_pose(time_s[:1], estimate.frame)
    p = (p - p[0]) @ yaw_alignment(R[0], R_true[0]).T
    return np.stack([np.interp(recording.time_s, time_s, p[:, k]) for k in (0, 1)], axis=1)


def rolled_map(runs: Runs, seed: int) -> dict[str, np.ndarray]:
    """Returns the map points (N, 3) of each method in the true world, whose floor is at z = 0."""
    kept = runs.kept("sphere_maps", FAST, seed)
    recording = Recording(kept / "recording.h5")
    return {m: map_in_world(recording, Estimate(kept / "estimates" / m.replace("/", "-"))) for m in MAPS}


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def page(runs: Runs, turns: dict[str, list[Turning]], legs: dict[str, list[Leg]], maps: dict) -> str:
    rates = {name: number(statistics.median(t.mean_rate_rad_s for t in draws), 2) for name, draws in turns.items()}
    steps = {m: np.concatenate([t.rest_step_rad[m] for t in turns[SLOW]]) for m in ATTITUDES}
    true_legs = {name: [number(statistics.median(d.true_legs_m[k] for d in draws)) for k in (0, 1)] for name, draws in legs.items() if name != FAST_SLIP}
    return PAGE.format(draws=len(turns[SLOW]), first=runs.seeds[0], last=runs.seeds[1], jitter=jitter_table(steps).text(),
                       distance=distance_table(turns).text(), slow=rates[SLOW], fast=rates[FAST], ways=leg_table(legs).text(),
                       true_legs=", and ".join(f"{first} m and {second} m in `{name}`" for name, (first, second) in true_legs.items()),
                       rooms=room_table(maps).text(), rooms_draws=len(maps), map_seed=next(iter(maps)),
                       lag1=number(lag_1([t.rest_step_rad[MADGWICK] for t in turns[SLOW]]), 2).replace("-", "−"))


def jitter_table(steps: dict[str, np.ndarray]) -> Table:
    table = Table(["quantity", "MFI paper", *(LABELS[m] for m in ATTITUDES)])
    table.add("rms step at standstill", "0.229° (Madgwick), 0.0084° (complementary)",
              *(number(np.degrees(rms(np.linalg.norm(steps[m], axis=1)))) + "°" for m in ATTITUDES))
    return table


def lag_1(parts: list[np.ndarray]) -> float:
    """Returns the correlation of successive rotation steps."""
    return float(sum(np.sum(p[1:] * p[:-1]) for p in parts) / sum(np.sum(p * p) for p in parts))


def distance_table(turns: dict[str, list[Turning]]) -> Table:
    methods = (MADGWICK, AUTOGAIN, OURS)
    table = Table(["quantity", "MFI paper, Madgwick", "MFI paper, Autogain", *(f"`{name}`, {LABELS[m]}" for name in turns for m in methods)])
    at = {(name, m): [t.at_tracker(m)[1] for t in draws] for name, draws in turns.items() for m in methods}
    for name, madgwick, autogain, measure, unit in (
            ("mean distance", "1.35", "1.29", lambda d: float(d.mean()), "°"),
            ("rms distance", "1.545", "1.548", rms, "°"),
            ("highest distance", "4.68", "4.48", lambda d: float(d.max()), "°"),
            ("total variation per second", "4.06", "2.94", lambda d: float(np.abs(np.diff(d)).sum() * TRACKER_HZ / len(d)), "°/s"),
            ("median step, 120 Hz", "0.0226", "0.0084", lambda d: float(np.median(np.abs(np.diff(d)))), "°"),
            ("median second difference, 120 Hz", "0.0102", "0.0036", lambda d: float(np.median(np.abs(np.diff(d, 2)))), "°")):
        table.add(name, madgwick + unit, autogain + unit, *(number(statistics.median(measure(d) for d in draws)) + unit for draws in at.values()))
    return table


def leg_table(legs: dict[str, list[Leg]]) -> Table:
    table = Table(["quantity", "MFI paper", *(LABELS[m] for m in POSITIONS)])
    printed_slip = ("1.52 m; 1.13 m", "1.47 m; 0.93 m", "−10 to +10 %", "all")
    printed_slide = ("0.81 m; 1.02 m", "0.48 m; 0.46 m", "-", "1 of 2")
    for scenario, printed in ((SLIP, printed_slip), (SLIDE, printed_slide)):
        draws = legs[scenario]
        for k, which in enumerate(("first", "second")):
            table.add(f"`{scenario}`: median {which} leg", printed[k], *(number(statistics.median(d.legs_m[m][k] for d in draws)) + " m" for m in POSITIONS))
        errors = {m: leg_errors(draws, m) for m in POSITIONS}
        table.add(f"`{scenario}`: range of leg errors", printed[2],
                  *(f"{100 * min(errors[m]):+.1f} to {100 * max(errors[m]):+.1f} %".replace("-", "−") for m in POSITIONS))
        table.add(f"`{scenario}`: legs within ±10 %", printed[3], *(share(statistics.fmean(abs(e) <= 0.1 for e in errors[m])) for m in POSITIONS))
    return table


def leg_errors(legs: list[Leg], method: str) -> list[float]:
    """Returns the relative length errors of both legs of all runs."""
    return [estimate / truth - 1 for d in legs for estimate, truth in zip(d.legs_m[method], d.true_legs_m)]


def room_table(maps: dict[int, dict[str, np.ndarray]]) -> Table:
    table = Table(["quantity", "MFI paper", *(LABELS[m] for m in MAPS)])
    below = {m: sum(int(np.sum(points[m][:, 2] < -BELOW_M)) for points in maps.values()) for m in MAPS}
    total = {m: sum(len(points[m]) for points in maps.values()) for m in MAPS}
    table.add(f"map points below −{BELOW_M} m", "not counted",
              *(f"{below[m]} of {total[m]} ({share(below[m] / max(1, total[m]))})" for m in MAPS))
    return table


def draw_jitter(turn: Turning, path: pathlib.Path) -> None:
    figure, axes = pictures.panels(1, 1, 8.0, 3.4)
    for method in ATTITUDES:
        steps_deg = np.maximum(np.degrees(np.linalg.norm(turn.rest_step_rad[method], axis=1)), DRAWN_STEP_DEG)
        axes[0, 0].plot(turn.time_s[SETTLING:SETTLING + len(steps_deg)], steps_deg, color=COLOURS[method], lw=0.9, label=LABELS[method])
    axes[0, 0].set(xlabel="time at standstill [s]", ylabel="step from sample to sample [°]", yscale="log")
    pictures.legend(figure, axes[0, 0], 4)
    pictures.save(figure, path)


def draw_distance(turn: Turning, path: pathlib.Path) -> None:
    """Plots the angle to the truth over one run, and its derivative."""
    figure, axes = pictures.panels(2, 1, 8.5, 5.6, sharex=True)
    for method in (MADGWICK, AUTOGAIN, OURS):
        time_s, distance_deg = turn.at_tracker(method)
        axes[0, 0].plot(time_s, distance_deg, color=COLOURS[method], lw=1.2, label=LABELS[method])
        axes[1, 0].plot(time_s[1:], np.diff(distance_deg) * TRACKER_HZ, color=COLOURS[method], lw=0.7)
    axes[0, 0].set_ylabel("distance to the truth [°]")
    axes[1, 0].set(xlabel="time [s]", ylabel="its derivative [°/s]")
    pictures.legend(figure, axes[0, 0], 3)
    pictures.save(figure, path)


def draw_paths(legs: list[Leg], path: pathlib.Path) -> None:
    """Plots the paths of three runs along the L, from above."""
    figure, axes = pictures.panels(1, 3, 10.5, 4.0)
    for panel, draw in zip(axes[0], legs):
        panel.plot(*draw.true_path_m.T, color=pictures.TRUTH, lw=2.4, label="truth")
        for method in POSITIONS:
            panel.plot(*draw.path_m[method].T, color=COLOURS[method], lw=1.3, ls="--" if method == LIVE else "-", label=LABELS[method])
        panel.set_aspect("equal", adjustable="datalim")
        panel.set_xlabel("x [m]")
    axes[0, 0].set_ylabel("y [m]")
    pictures.legend(figure, axes[0, 0], 6)
    pictures.save(figure, path)


def draw_legs(legs: dict[str, list[Leg]], path: pathlib.Path) -> None:
    """Plots the relative errors of all legs against their percentile."""
    figure, axes = pictures.panels(1, 3, 10.5, 3.8)
    for panel, (name, draws) in zip(axes[0], legs.items()):
        panel.axhspan(-10, 10, color="0.9", lw=0, label="−10 to +10 %")
        for method in POSITIONS:
            errors = np.sort(100 * np.array(leg_errors(draws, method)))
            panel.plot(100 * (np.arange(len(errors)) + 0.5) / len(errors), errors, color=COLOURS[method],
                       ls="--" if method == LIVE else "-", label=LABELS[method])
        panel.set(xlabel="percentile of the legs", title=f"scenario {name}", xlim=(0, 100))
    axes[0, 0].set_ylabel("error of the leg's length [%]")
    pictures.legend(figure, axes[0, 0], 6)
    pictures.save(figure, path)


def draw_map(maps: dict[int, dict[str, np.ndarray]], path: pathlib.Path) -> None:
    """Plots the map of the room in one run from the side, with points below the floor in red."""
    points = next(iter(maps.values()))
    figure, axes = pictures.panels(2, 2, 9.5, 5.4, sharex=True, sharey=True)
    for panel, method in zip(axes.flat, MAPS):
        p = points[method]
        below = p[:, 2] < -BELOW_M
        panel.scatter(*p[~below][::3, [0, 2]].T, s=0.3, color="0.45", lw=0)
        panel.scatter(*p[below][:, [0, 2]].T, s=0.8, color="tab:red", lw=0)
        panel.set(xlim=(-8, 8), ylim=(-2.5, 4.5))
        panel.set_title(f"{LABELS[method]}: {below.sum()} of {len(p)} points below the floor", fontsize="small")
    for panel in axes[1]:
        panel.set_xlabel("x [m]")
    for panel in axes[:, 0]:
        panel.set_ylabel("height z [m]")
    pictures.save(figure, path)


PAGE = """# The rolling sphere: the MFI paper next to our simulation

The authors of *IMU-Based Pose-Estimation for Spherical Robots with Limited Resources* (Zevering et al., IEEE MFI 2021)
roll a sphere with a diameter of 29 cm by hand. The paper's attitude filter Autogain switches between Madgwick's
filter and a complementary filter. The paper's position filter fuses the rolling velocity with the integrated
acceleration.
`tools/reproduce papers --only sphere` writes this page from {draws} simulated runs of each scenario (seeds {first} to
{last}). The numbers for figures of the MFI paper come from data files of its authors.

## What is reproduced

- At standstill, Madgwick's filter has more than ten times larger attitude steps than the complementary filter, in the
  MFI paper and in our simulation.
- At the pace of the MFI paper (scenario `slow_roll`), Autogain and Madgwick's filter have similar attitude errors. The
  attitude error of Autogain changes more slowly.
- In the faster scenario `roll`, Autogain and Madgwick's filter have nearly equal errors. Above 2.1 rad/s, Autogain
  applies only Madgwick's correction.

## What differs from the MFI paper

| condition | MFI paper | our simulation |
|---|---|---|
| published methods | three averaged gyros, 125 Hz | first IMU, 250 Hz |
| our methods | - | all three IMUs, 250 Hz |
| weights of the fusion | varying, limiter 1.1 | equal, limiter 1.2 |
| integrated acceleration | direction of the force only | force in m/s² |
| roll correction | never made in the code | made, as printed |
| attitude reference | optical tracker, fitted to Autogain | exact, aligned in yaw |
| position reference | tape measure at way points | exact |
| slip and slide | provoked by hand | slippery patches |

## Jitter at standstill: Madgwick against complementary

{jitter}
An attitude step is the rotation of the estimated attitude between two successive samples (figure 2 of the MFI paper).
The accelerometer correction of Madgwick's filter rotates the attitude by at most 2 · gain · sample time. With gain 0.2,
the limit of a correction is 0.092° at our sample time of 4 ms, and 0.229° at 10 ms. Madgwick's filter alternates
between two attitudes: successive steps have a correlation of {lag1} in our simulation, and −0.83 in the MFI paper's
data.

![steps at standstill](sphere_jitter.png)

## Autogain against Madgwick: distance to the reference and its derivative

The *distance* is the angle between estimated and true attitude (figures 5 and 6 of the MFI paper). A *step* is the
change of the attitude error between samples at 120 Hz. A *second difference* is the difference of two
successive steps of the attitude error.

Each cell is a median over the simulated runs. The mean angular rate is {slow} rad/s in `slow_roll`, {fast} rad/s in
`roll`, and 0.56 rad/s in a log of the MFI paper's authors. In the MFI paper, the total variation of the attitude
error includes noise of the optical tracker.

{distance}
![attitude error in the first run of slow_roll](sphere_distance.png)

## The L-shaped path of 1 m × 1 m with slip and with slide

{ways}
- In the column *MFI paper*, the first of two lengths comes from rotation alone, and the second from the position
  filter. A cell with one value shows the result of the position filter.
- In the scenario `slip_l` (figure 7 of the MFI paper), the sphere spins 1.5 to 2.8 times faster on slippery patches
  than without slip.
- On slippery patches of `slide_l` (figure 8 of the MFI paper), a hand slows the rotation to at most 0.7 times the rate
  without slip.
- The first and second leg of the path have median true lengths of
  {true_legs}.
- The column *published fusion* shows the position filter with the sphere's radius of 0.145 m. The column *published
  fusion, radius 0.29 m* uses the sphere's diameter as radius, like the code of the MFI paper.
- While the velocity from the accelerometer is near zero, the position filter halves the rolling velocity. A
  doubled sphere radius partly compensates for the halved rolling velocity.

![three paths with slip, from above](sphere_slip.png)

![three paths with slide, from above](sphere_slide.png)

![errors of the legs](sphere_legs.png)

The figure also shows the scenario `slip`, in which the sphere rolls 1 m in 2 to 5 s (MFI paper: 5 to 9 s).

## The map of a room

{rooms}
The table counts map points more than 0.1 m below the floor, in {rooms_draws} simulated runs of the scenario
`roll` in a furnished room.

![the map of seed {map_seed} from the side](sphere_map.png)
"""
