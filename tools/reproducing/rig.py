# SPDX-License-Identifier: BSD-3-Clause
"""The tumbling rig: S.-P. Deschenes et al., Saturation-Aware Angular Velocity Estimation, ICRA 2024."""
from __future__ import annotations

import csv
import math
import pathlib
import statistics
from collections.abc import Callable

import numpy as np

from . import pictures
from .page import Table, change, finish, number, share
from .readings import Estimate, Recording, state_true_mounting
from .runs import Runs, Scores

RAW, PUBLISHED, TUNED, BATCH, LAG = RATES = ("rate/raw", "rate/saave", "rate/saave at 10.0", "rate/tumble", "rate/tumble_lag")
SWEPT = (RAW, PUBLISHED, BATCH, LAG)
# the saturation limits of the simulated gyros differ by about one percent between devices and axes; 10.0 rad/s is below all of them
DEFAULT_THRESHOLD_RAD_S = 10.45  # the program's default, for a nominal saturation limit of 10.5 rad/s
THRESHOLD = "saturation_point_rad_s=10.0"
MAPS = dict(zip(RATES, ("slam/icp_raw", "slam/published", f"slam/published slam/published.{THRESHOLD}", "slam/tumble", "slam/tumble_lag")))
LABELS = dict(zip(RATES, ("raw gyro", "published", "published, threshold 10.0 rad/s", "ours, whole recording", "ours, 0.3 s lag")))
COLOURS = dict(zip(RATES, (pictures.RAW, pictures.PUBLISHED, "tab:olive", pictures.OURS, pictures.LIVE)))
HERE = pathlib.Path(__file__).resolve().parent
OVERLAP, FAILED = "map_overlap", "map_failed"
TRANSLATION, ROTATION = "translation_error_end_m", "rotation_error_end_rad"
ANY, ONE, MORE = "any", "one element", "two or three elements"  # number of clipped sensing elements


def reproduce(runs: Runs, folder: pathlib.Path, check: bool) -> list[str]:
    """Runs the missing sweeps, then writes rig.md and its pictures to `folder`. With `check`, only returns the lines that differ."""
    rates = runs.sweep("rig_rates", "hill", SWEPT, scenario="hill", keep=True)
    maps = runs.sweep("rig_maps", HERE / "rig_maps.yaml")
    recordings = {seed: Recording(runs.kept("rig_rates", "hill", seed) / "recording.h5") for seed in rates.seeds(RAW)}
    errors = pooled_errors(recordings, lambda seed, method: estimated(runs, seed, method))
    exact = pooled_errors(recordings, lambda seed, method: estimated(runs, seed, method, exact=True))
    if not check:
        draw_rate(runs, recordings, folder / "rig_rate.png")
        draw_errors(errors, folder / "rig_rate_errors.png")
        draw_localisation(maps, folder / "rig_localisation.png")
        draw_density(recordings, folder / "rig_density.png")
        draw_map(runs, maps, folder / "rig_maps.png")
    return finish(folder / "rig.md", page(runs, recordings, errors, exact, maps), check)


def pooled_errors(recordings: dict[int, Recording], estimate: Callable[[int, str], pathlib.Path]) -> dict[tuple[str, str], np.ndarray]:
    """Returns the rate errors in rad/s at the clipped samples of all simulated runs, by (method, number of clipped elements).

    estimate  folder of the estimate of one method on one run
    """
    pools: dict[tuple[str, str], list[np.ndarray]] = {(m, e): [] for m in RATES for e in (ANY, ONE, MORE)}
    for seed, recording in recordings.items():
        for method in RATES:
            error = np.linalg.norm(Estimate(estimate(seed, method)).rates_rad_s() - recording.true_rate_rad_s, axis=1)
            pools[method, ANY].append(error[recording.clipped])
            pools[method, ONE].append(error[recording.clipped & (recording.clipped_elements == 1)])
            pools[method, MORE].append(error[recording.clipped & (recording.clipped_elements > 1)])
    return {key: np.concatenate(parts) for key, parts in pools.items()}


def estimated(runs: Runs, seed: int, method: str, exact: bool = False) -> pathlib.Path:
    """Returns the folder of a rate estimate. exact: the recording contains the true mounting of its IMUs."""
    kept = runs.kept("rig_rates", "hill", seed)
    name = method.replace("/", "-").replace(" ", "_")
    if not exact and method in SWEPT:
        return kept / "estimates" / name
    folder = runs.folder / ("rig_exact_mounting" if exact else "rig_threshold") / str(seed)
    recording = folder / "recording.h5" if exact else kept / "recording.h5"
    if not recording.is_file():
        state_true_mounting(kept / "recording.h5", recording)
    settings = [f"{PUBLISHED}.{THRESHOLD}"] if method == TUNED else []
    return runs.estimate(recording, method.split()[0], folder / name, settings)


def middle(values: np.ndarray) -> float:
    return float(np.median(values)) if len(values) else math.nan


def page(runs: Runs, recordings: dict[int, Recording], errors: dict, exact: dict, maps: Scores) -> str:
    clipped = len(errors[RAW, ANY])
    everywhere, one_at_a_time = sorted(recordings), draws_with_one(recordings)
    headline = table("0.2/0.3 s")
    rate_rows(headline, "median rate error", errors, ANY, "−83.4 %")
    map_rows(headline, maps, everywhere)

    rates = table("0.2 s")
    for source, where in ((errors, "inexact"), (exact, "exact")):
        for elements, printed in ((ONE, "−83.4 %"), (MORE, "-")):
            rate_rows(rates, f"{elements}, {where}", source, elements, printed)

    alike = table("0.3 s")
    if one_at_a_time:
        map_rows(alike, maps, one_at_a_time)
    speeds, forces = highest_values(recordings)
    return PAGE.format(draws=len(recordings), first=runs.seeds[0], last=runs.seeds[1], headline=headline.text(), rates=rates.text(),
                       alike=alike.text(), alike_draws=len(one_at_a_time), threshold=THRESHOLD, unseen=share(unseen_share(recordings)), worst=worst_map(maps),
                       clipping=sum(bool(r.clipped.any()) for r in recordings.values()), clipped=clipped, speed=number(statistics.median(speeds)),
                       force=number(statistics.median(forces)), top_speed=number(max(speeds)), top_force=number(max(forces)),
                       one=share(len(errors[RAW, ONE]) / max(1, clipped)), more=share(len(errors[RAW, MORE]) / max(1, clipped)))


def unseen_share(recordings: dict[int, Recording]) -> float:
    """Returns the fraction of the clipped samples in which no axis exceeds the default threshold of Saave."""
    highest = np.concatenate([np.abs(r.gyro_rad_s[r.clipped]).max(axis=1) for r in recordings.values()])
    return float(np.mean(highest <= DEFAULT_THRESHOLD_RAD_S)) if len(highest) else 0.0


def table(lag: str) -> Table:
    """Returns a table with one column per method. `lag` is the lag of the results in the last column."""
    return Table(["quantity", "ICRA paper", *(LABELS[name] for name in RATES[:-1]), f"ours, {lag} lag"])


def highest_values(recordings: dict[int, Recording]) -> tuple[list[float], list[float]]:
    """Returns the highest angular speed in rad/s and highest acceleration in m/s² of each recording."""
    return ([float(np.linalg.norm(r.true_rate_rad_s, axis=1).max()) for r in recordings.values()],
            [float(np.linalg.norm(r.true_force_m_s2, axis=1).max()) for r in recordings.values()])


def rate_rows(out: Table, quantity: str, errors: dict, elements: str, printed: str) -> None:
    medians = [middle(errors[m, elements]) for m in RATES]
    out.add(quantity, "-", *(number(m) + " rad/s" for m in medians))
    out.add(CHANGE, printed, "-", *(change(m, medians[0]) for m in medians[1:]))


CHANGE = "change from raw gyro"
PRINTED = {TRANSLATION: "−71.5 %", ROTATION: "−65.5 %", OVERLAP: "77.2 %; 92.1 %",
           FAILED: "12; 0 of 32"}


def map_rows(out: Table, maps: Scores, seeds: list[int]) -> None:
    """Adds the rows about localisation and map for some simulated runs."""
    for metric, quantity, scale, unit in ((TRANSLATION, "median end error, translation", 1, " m"), (ROTATION, "median end error, rotation", 180 / math.pi, "°")):
        medians = [scale * statistics.median(maps.values(MAPS[m], metric, seeds, failed=math.inf)) for m in RATES]
        out.add(quantity, "-", *(number(m) + unit if math.isfinite(m) else "lost" for m in medians))
        out.add(CHANGE, PRINTED[metric], "-", *(change(m, medians[0]) for m in medians[1:]))
    overlaps = [maps.values(MAPS[m], OVERLAP, seeds, failed=0.0) for m in RATES]
    out.add("mean map overlap", PRINTED[OVERLAP], *(share(statistics.fmean(o)) for o in overlaps))
    failures = [maps.values(MAPS[m], FAILED, seeds, failed=1.0) for m in RATES]
    out.add("mapping failures", PRINTED[FAILED], *(f"{sum(f):.0f} of {len(f)}" for f in failures))


def draws_with_one(recordings: dict[int, Recording]) -> list[int]:
    """Returns the simulated runs with clipping, but with at most 2 % of the clipped samples on two or more sensing elements."""
    def more(r: Recording) -> float:
        return np.mean(r.clipped_elements[r.clipped] > 1) if r.clipped.any() else 1.0
    return [seed for seed, r in sorted(recordings.items()) if more(r) <= 0.02]


def draw_with_collisions(recordings: dict[int, Recording]) -> int:
    """Returns the simulated run with the most collisions between its first and last clipped sample, and of equal runs, the run with the most clipped samples."""
    def collisions(seed: int) -> tuple[int, int]:
        recording = recordings[seed]
        clipped_s = recording.time_s[recording.clipped]
        within = (recording.truth_time_s >= clipped_s[0]) & (recording.truth_time_s <= clipped_s[-1])
        contact = recording.label[within] > 0
        return int(np.sum(contact[1:] & ~contact[:-1])), len(clipped_s)

    return max((seed for seed, r in recordings.items() if r.clipped.any()), key=collisions)


def draw_rate(runs: Runs, recordings: dict[int, Recording], path: pathlib.Path) -> None:
    """Plots the rate during one tumble: of the axis that clips most often, and the angular speed."""
    seed = draw_with_collisions(recordings)
    recording = recordings[seed]
    lost = np.abs(recording.gyro_rad_s - recording.true_rate_rad_s)
    axis = int(np.argmax(lost[recording.clipped].sum(axis=0)))
    at = np.flatnonzero(recording.clipped)
    begin, end = recording.time_s[at[0]] - 0.3, recording.time_s[at[-1]] + 0.5
    figure, axes = pictures.panels(2, 1, 10.0, 6.0, sharex=True)
    contact = recording.label > 0
    for panel, select, name in ((axes[0, 0], lambda w: w[:, axis], f"rate, {'xyz'[axis]} axis [rad/s]"),
                                (axes[1, 0], lambda w: np.linalg.norm(w, axis=1), "angular speed [rad/s]")):
        panel.fill_between(recording.truth_time_s, 0, 1, where=contact, transform=panel.get_xaxis_transform(), color="0.92",
                           lw=0, step="mid", label="contact with the ground")
        panel.plot(recording.time_s, select(recording.true_rate_rad_s), color=pictures.TRUTH, lw=2.0, label="truth")
        panel.plot(recording.time_s, select(recording.gyro_rad_s), color=COLOURS[RAW], lw=1.1, label=LABELS[RAW])
        for method in (PUBLISHED, TUNED, BATCH):
            rates = Estimate(estimated(runs, seed, method)).rates_rad_s()
            panel.plot(recording.time_s, select(rates), color=COLOURS[method], lw=1.1, ls="-" if method == PUBLISHED else "--",
                       label=LABELS[method])
        panel.set(ylabel=name, xlim=(begin, end))
    axes[1, 0].set_xlabel("time [s]")
    pictures.legend(figure, axes[0, 0], 6)
    pictures.save(figure, path)


def draw_errors(errors: dict, path: pathlib.Path) -> None:
    """Plots the distribution of the rate error at clipped samples: with one clipped sensing element, and with more."""
    figure, axes = pictures.panels(1, 2, 9.0, 3.6, sharey=True)
    for panel, elements in zip(axes[0], (ONE, MORE)):
        for method in RATES:
            ordered = np.sort(errors[method, elements])
            if len(ordered):
                panel.plot(ordered, 100 * np.arange(1, len(ordered) + 1) / len(ordered), color=COLOURS[method],
                           label=LABELS[method].replace("0.3 s", "0.2 s"))
        panel.set(xscale="log", xlim=(3e-3, 30), xlabel="rate error [rad/s]", ylim=(0, 100),
                  title=f"{elements} clipped: {len(errors[RAW, elements])} samples")
    axes[0, 0].set_ylabel("share of samples below [%]")
    pictures.legend(figure, axes[0, 0], 5)
    pictures.save(figure, path)


def draw_localisation(maps: Scores, path: pathlib.Path) -> None:
    """Plots the percentiles of the error at the end of the run."""
    figure, axes = pictures.panels(1, 2, 9.0, 3.8)
    for panel, metric, scale, name, limit in ((axes[0, 0], TRANSLATION, 1.0, "translation error [m]", 10.0),
                                              (axes[0, 1], ROTATION, 180 / math.pi, "rotation error [°]", 180.0)):
        for method in RATES:
            values = [scale * v for v in maps.values(MAPS[method], metric, failed=math.inf)]
            pictures.percentiles(panel, values, LABELS[method], COLOURS[method], limit)
        panel.set(yscale="log", xlabel="percentile of the draws", ylabel=name, xlim=(0, 100))
    pictures.legend(figure, axes[0, 0], 5)
    pictures.save(figure, path)


def draw_density(recordings: dict[int, Recording], path: pathlib.Path) -> None:
    """Plots the density of angular speed against acceleration, with the outlines of other data sets."""
    from matplotlib.colors import LogNorm

    speed = np.concatenate([np.linalg.norm(r.true_rate_rad_s, axis=1) for r in recordings.values()])
    force = np.concatenate([np.linalg.norm(r.true_force_m_s2, axis=1) for r in recordings.values()])
    figure, axes = pictures.panels(1, 1, 7.5, 4.6)
    panel = axes[0, 0]
    _, _, _, mesh = panel.hist2d(force, speed, bins=(np.linspace(0, 250, 63), np.linspace(0, 42, 64)),
                                norm=LogNorm(vmin=0.1), cmap="Greys")  # a single sample stays visible
    figure.colorbar(mesh, label=f"samples at 100 Hz, {len(recordings)} draws of hill").ax.set_ylim(bottom=1)
    panel.plot([0, 30.7, 30.7], [4.7, 4.7, 0], color="tab:purple", lw=1.8, label="highest of other data sets, printed in the paper")
    panel.plot([157.8], [18.6], "*", color="tab:red", ms=12, label="highest of the paper's rig")
    panel.axhline(10.5, color="tab:red", lw=1.0, ls=":", label="rail of one gyro axis")
    for (name, corners), colour in zip(outlines().items(), ("tab:green", "tab:blue")):
        upper, highest = zip(*corners)
        panel.stairs(highest, (0.0, *upper), color=colour, lw=1.5, label=name)
    panel.set(xlabel="acceleration, specific force of the IMU [m/s²]", ylabel="angular speed [rad/s]", xlim=(0, 250), ylim=(0, 42))
    panel.legend(loc="upper right", fontsize="small")
    pictures.save(figure, path)


def outlines() -> dict[str, list[tuple[float, float]]]:
    """Returns steps by data set: upper acceleration in m/s², and the highest angular speed up to this acceleration in rad/s."""
    out: dict[str, list[tuple[float, float]]] = {}
    with open(HERE / "outlines.csv", encoding="utf-8") as file:
        for name, force, speed in csv.reader(line for line in file if not line.startswith("#")):
            out.setdefault(name, []).append((float(force), float(speed)))
    return out


def worst_map(maps: Scores) -> int:
    """Returns the simulated run whose map from the raw gyro has the median overlap of all failed maps; if no map failed, the lowest overlap."""
    overlap = maps.of(MAPS[RAW], OVERLAP)
    failed = [seed for seed, value in maps.of(MAPS[RAW], FAILED).items() if value > 0 and seed in overlap]
    ordered = sorted(failed or overlap, key=lambda seed: overlap[seed])
    return ordered[len(ordered) // 2] if failed else ordered[0]


def draw_map(runs: Runs, maps: Scores, path: pathlib.Path) -> None:
    """Draws the maps of one simulated run side by side, with points coloured by their distance to the true surface."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import LinearSegmentedColormap
    from PIL import Image

    seed, methods = worst_map(maps), (RAW, PUBLISHED, BATCH)
    folder = runs.folder / f"rig_map_{seed}"
    recording = runs.record("hill", seed, folder / "recording.h5")
    estimates = [runs.estimate(recording, MAPS[m], folder / MAPS[m].replace("/", "-")) for m in methods]
    runs.call("render", *(p.relative_to(runs.folder) for p in (recording, *estimates)), "--map", "-o", f"{folder.name}/maps.png")
    image = Image.open(folder / "maps.png").convert("RGB")
    image = image.crop((0, 0, image.width, image.height - SCALE_PX))
    image = image.resize((1200, round(1200 * image.height / image.width)), Image.LANCZOS)
    figure, axes = pictures.panels(1, 1, 12.0, 12.0 * image.height / image.width + 0.9)
    panel = axes[0, 0]
    panel.imshow(np.asarray(image))
    panel.axis("off")
    for k, method in enumerate(methods):
        overlap = maps.of(MAPS[method], OVERLAP).get(seed, 0.0)
        panel.text((k + 0.5) * image.width / 3, -8, f"{LABELS[method]}: {share(overlap)} within 0.25 m", ha="center", va="bottom")
    colours = LinearSegmentedColormap.from_list("error", ERROR_COLOURS)
    figure.colorbar(ScalarMappable(cmap=colours), ax=panel, orientation="horizontal", aspect=60, shrink=0.6, pad=0.02,
                    label="distance to the true surface [m], 1 m or more in red")
    pictures.save(figure, path, palette=False)


# colours of the program's pictures of maps, and height of their scale in pixels: tools/pictures/map_pictures.cpp
ERROR_COLOURS = [(0.0, "#316ec8"), (0.1, "#5abe8c"), (0.25, "#f5e15a"), (0.5, "#f58c32"), (1.0, "#d71928")]
SCALE_PX = 26

PAGE = """# The tumbling rig: the ICRA paper next to our simulation

The authors of *Saturation-Aware Angular Velocity Estimation* (Deschênes et al., ICRA 2024) push a lidar rig down a hill
until its gyro saturates. The paper's method Saave recovers the rate about one saturated axis per sample from the
accelerometer. `tools/reproduce papers --only rig` writes this page from {draws} simulated runs of the scenario `hill`
(seeds {first} to {last}).

{headline}
- In the column *ICRA paper*, the first of two numbers is for the raw gyro, and the second for Saave.
- The column *raw gyro* shows the clipped readings (`rate/raw`), and the mapping of the ICRA paper with these readings
  (`slam/icp_raw`).
- The column *published* shows the rates of Saave (`rate/saave`), and the mapping of the ICRA paper with
  these rates (`slam/published`). The mapping uses constants from launch files of the ICRA paper's authors.
- Saave treats gyro readings above a saturation threshold of 10.45 rad/s as clipped. In {unseen} of our clipped samples,
  no axis exceeds 10.45 rad/s, because the simulated gyros have different saturation limits. The column *published,
  threshold 10.0 rad/s* shows Saave with `{threshold}`.
- The column *ours, whole recording* shows `rate/tumble` and `slam/tumble`. The column *ours, 0.2/0.3 s
  lag* shows `rate/tumble_lag` with a lag of 0.2 s, and `slam/tumble_lag` with a lag of 0.3 s.
- The gyro clips in {clipping} of {draws} simulated runs, for {clipped} samples in total. The highest angular speed is
  {top_speed} rad/s (median over the runs: {speed} rad/s; ICRA paper: up to 18.6 rad/s). The highest acceleration is
  {top_force} m/s² (median over the runs: {force} m/s²; ICRA paper: up to 157.8 m/s²).
- The median rate error covers only clipped samples. The end error is the error of the motion from the sixth registered
  sweep to the last, as in the ICRA paper.
- The map overlap is the share of map points within 0.25 m of the true surface. A map fails if its overlap is below
  85 %, as in the ICRA paper.
- In medians and means, a failed run counts with an infinite error and a map overlap of 0. The ICRA paper limits
  rotation errors to 90°, but our rotation errors reach 180°.

## What is reproduced

- With an exact centre of mass, one clipped gyro axis and a saturation threshold of 10.0 rad/s, Saave reduces the rate
  error nearly as much as in the ICRA paper.
- Mapping with Saave reduces the median localisation errors at least as much as in the ICRA paper. Saave also increases
  the map overlap on the runs most similar to the ICRA paper.
- Mapping with Saave sometimes fails in our simulation, whose fastest motions exceed the motions of the ICRA paper.

## What differs from the ICRA paper

| condition | ICRA paper | our simulation |
|---|---|---|
| motion | one hill | slopes of 20 to 45° |
| gyro | one device, 10.5 rad/s | one device per run |
| accelerometer range | 156.9 m/s² | 196.1 m/s² |
| saturated axes | one at a time | up to three at once |
| rate reference | second IMU, also clips | exact |
| centre of mass | found by balancing the rig | within 20 mm |
| lidar mounting | as measured | within 1 cm and 1° |
| clock | as measured | within 5 ms |
| pose reference | registered static scans | exact |
| map reference | registered slow scan | true surface, aligned once |
| aborted registration | ends the mapper | replaced by IMU odometry |

## Rate through a tumble

![angular rate in one simulated tumble with many collisions](rig_rate.png)

## Rate error with and without recovery

{rates}
The table shows the median rate error. Of the clipped samples, {one} have one clipped sensing element, and {more} have
two or three. In the rows *inexact*, the assumed centre of mass has an error of up to 20 mm.

![distribution of the rate error](rig_rate_errors.png)

## Localisation error

![percentiles of the localisation error](rig_localisation.png)

The figure shows a failed run as an error of 10 m and 180°.

The table covers only the {alike_draws} of {draws} simulated runs that are most similar to the ICRA paper. A run
counts as similar to the ICRA paper if at most 2 % of its clipped samples have several clipped sensing elements.

{alike}
## Map outliers

![maps of seed {worst}, coloured by error](rig_maps.png)

## Angular speed against acceleration

![angular speed against acceleration](rig_density.png)

A rectangle marks the highest values of other data sets according to the ICRA paper: 4.7 rad/s and 30.7 m/s². Two
lines show the highest angular speed per 5 m/s² of acceleration in the data sets [BROAD and
AirbrakesV2](../real_gyros.md).
"""
