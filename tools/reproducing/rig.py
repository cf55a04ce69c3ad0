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
# the rails of our gyros differ by a percent from device to device and from axis to axis; 10.0 rad/s is below all of them
DEFAULT_THRESHOLD_RAD_S = 10.45  # of the program, for a nominal rail of 10.5 rad/s
THRESHOLD = "saturation_point_rad_s=10.0"
MAPS = dict(zip(RATES, ("slam/icp_raw", "slam/published", f"slam/published slam/published.{THRESHOLD}", "slam/tumble", "slam/tumble_lag")))
LABELS = dict(zip(RATES, ("raw gyro", "published", "published, threshold 10.0 rad/s", "ours, whole recording", "ours, 0.3 s lag")))
COLOURS = dict(zip(RATES, (pictures.RAW, pictures.PUBLISHED, "tab:olive", pictures.OURS, pictures.LIVE)))
HERE = pathlib.Path(__file__).resolve().parent
OVERLAP, FAILED = "map_overlap", "map_failed"
TRANSLATION, ROTATION = "translation_error_end_m", "rotation_error_end_rad"
ANY, ONE, MORE = "any", "one element", "two or three elements"  # sensing elements at their rail


def reproduce(runs: Runs, folder: pathlib.Path, check: bool) -> list[str]:
    """Runs what is missing, writes rig.md and its pictures into `folder`; with `check` returns stale lines instead."""
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
    """(method, elements at the rail) -> rate errors in rad/s at the clipped samples of all draws.

    estimate  folder of the estimate of a draw and a method
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
    """The folder of an estimate of the rate. exact: the recording states the true mounting of its IMUs."""
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
    headline = table()
    motion_rows(headline, recordings)
    rate_rows(headline, "clipped samples", errors, ANY, "−83.4 %",
              f"The medians are over {clipped} clipped samples. The reference rate is exact here and comes from a second IMU in the paper. The stated centre of mass has an error of up to 20 mm here.")
    map_rows(headline, maps, everywhere)

    rates = table()
    for source, where in ((errors, "stated centre of mass"), (exact, "exact centre of mass")):
        for elements, name, differs in ((ONE, f"{ONE} clipped", "One element is clipped in {} of the clipped samples. The paper reports one saturated axis at a time."),
                                        (MORE, f"{MORE} clipped", "Two or three elements are clipped in {} of the clipped samples. The published method corrects only one axis.")):
            part = share(len(errors[RAW, elements]) / max(1, clipped))
            rate_rows(rates, f"{name}, {where}", source, elements, "−83.4 %" if elements == ONE else "-",
                      differs.format(part))

    alike = table()
    if one_at_a_time:
        map_rows(alike, maps, one_at_a_time)
    return PAGE.format(draws=len(recordings), first=runs.seeds[0], last=runs.seeds[1], headline=headline.text(), rates=rates.text(),
                       alike=alike.text(), alike_draws=len(one_at_a_time), threshold=THRESHOLD, unseen=share(unseen_share(recordings)), worst=worst_map(maps),
                       commands="\n".join("    " + c for c in commands(runs)))


def unseen_share(recordings: dict[int, Recording]) -> float:
    """Share of the clipped samples that exceed the published threshold on no axis."""
    highest = np.concatenate([np.abs(r.gyro_rad_s[r.clipped]).max(axis=1) for r in recordings.values()])
    return float(np.mean(highest <= DEFAULT_THRESHOLD_RAD_S)) if len(highest) else 0.0


def table() -> Table:
    return Table(["quantity", "printed in the paper", *(LABELS[name] for name in RATES), "conditions that differ"])


def motion_rows(out: Table, recordings: dict[int, Recording]) -> None:
    speeds = [float(np.linalg.norm(r.true_rate_rad_s, axis=1).max()) for r in recordings.values()]
    forces = [float(np.linalg.norm(r.true_force_m_s2, axis=1).max()) for r in recordings.values()]
    clipping = sum(bool(r.clipped.any()) for r in recordings.values())
    out.add("runs", "32", *[str(len(recordings))] * len(RATES), f"The gyro clips in {clipping} of the simulated runs. The paper uses a real rig.")
    out.add("highest angular speed", "18.6 rad/s", *[number(max(speeds)) + " rad/s"] * len(RATES),
            f"The median over the simulated runs is {number(statistics.median(speeds))} rad/s.")
    out.add("highest acceleration", "157.8 m/s²", *[number(max(forces)) + " m/s²"] * len(RATES),
            f"The median over the simulated runs is {number(statistics.median(forces))} m/s². The paper's IMU clips at 156.9 m/s² on each axis.")


def rate_rows(out: Table, quantity: str, errors: dict, elements: str, printed: str, differs: str) -> None:
    medians = [middle(errors[m, elements]) for m in RATES]
    out.add(f"median rate error, {quantity}", "-", *(number(m) + " rad/s" for m in medians), differs)
    out.add("change against raw", printed, "-", *(change(m, medians[0]) for m in medians[1:]), "")


PRINTED = {TRANSLATION: "−71.5 %", ROTATION: "−65.5 %", OVERLAP: "map overlap 77.2 % (raw gyro), 92.1 % (published)",
           FAILED: "failed maps: 12 of 32 (raw gyro), 0 of 32 (published)"}


def map_rows(out: Table, maps: Scores, seeds: list[int]) -> None:
    """Rows of localisation and map for some draws."""
    for metric, quantity, scale, unit in ((TRANSLATION, "median translation error at the end", 1, " m"),
                                          (ROTATION, "median rotation error at the end", 180 / math.pi, "°")):
        medians = [scale * statistics.median(maps.values(MAPS[m], metric, seeds, failed=math.inf)) for m in RATES]
        out.add(quantity, "-", *(number(m) + unit if math.isfinite(m) else "lost" for m in medians),
                "error accumulated from the sixth registered sweep to the last sweep, as in the paper")
        out.add("change against raw", PRINTED[metric], "-", *(change(m, medians[0]) for m in medians[1:]),
                "The reference poses are exact here. The paper registers static scans with the published chain to obtain its reference poses.")
    overlaps = [maps.values(MAPS[m], OVERLAP, seeds, failed=0.0) for m in RATES]
    out.add("mean map overlap within 0.25 m", PRINTED[OVERLAP], *(share(statistics.fmean(o)) for o in overlaps),
            "The reference is the true surface, and maps are compared without registration. The paper first registers each map to a slow scan.")
    failures = [maps.values(MAPS[m], FAILED, seeds, failed=1.0) for m in RATES]
    out.add("mapping failures", PRINTED[FAILED], *(f"{sum(f):.0f} of {len(f)}" for f in failures),
            "A map fails if more than 15 % of its points are farther than 0.25 m from the reference, as in the paper.")


def draws_with_one(recordings: dict[int, Recording]) -> list[int]:
    """Draws that clip, with at most 2 % of the clipped samples at two rails or more."""
    def more(r: Recording) -> float:
        return np.mean(r.clipped_elements[r.clipped] > 1) if r.clipped.any() else 1.0
    return [seed for seed, r in sorted(recordings.items()) if more(r) <= 0.02]


def commands(runs: Runs) -> list[str]:
    """The sweeps of this page, and how the picture of the maps is made."""
    return [*(c for c in runs.commands if c.startswith("tumble sweep") and "rig_" in c), "tumble record hill --seed N -o recording.h5",
            "tumble estimate recording.h5 --method METHOD -o ESTIMATE",
            f"tumble estimate recording.h5 --method {PUBLISHED} --set {PUBLISHED}.{THRESHOLD} -o ESTIMATE", "tumble render recording.h5 ESTIMATE... --map -o maps.png"]


def draw_with_collisions(recordings: dict[int, Recording]) -> int:
    """The draw with most collisions between its first and its last clipped sample; of equal ones the one that clips longest."""
    def collisions(seed: int) -> tuple[int, int]:
        recording = recordings[seed]
        clipped_s = recording.time_s[recording.clipped]
        within = (recording.truth_time_s >= clipped_s[0]) & (recording.truth_time_s <= clipped_s[-1])
        contact = recording.label[within] > 0
        return int(np.sum(contact[1:] & ~contact[:-1])), len(clipped_s)

    return max((seed for seed, r in recordings.items() if r.clipped.any()), key=collisions)


def draw_rate(runs: Runs, recordings: dict[int, Recording], path: pathlib.Path) -> None:
    """Rate through one tumble: the axis that clips most, and the angular speed."""
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
    """Distribution of the rate error at clipped samples: with one element at its rail, and with more."""
    figure, axes = pictures.panels(1, 2, 9.0, 3.6, sharey=True)
    for panel, elements in zip(axes[0], (ONE, MORE)):
        for method in RATES:
            ordered = np.sort(errors[method, elements])
            if len(ordered):
                panel.plot(ordered, 100 * np.arange(1, len(ordered) + 1) / len(ordered), color=COLOURS[method], label=LABELS[method])
        panel.set(xscale="log", xlim=(3e-3, 30), xlabel="rate error [rad/s]", ylim=(0, 100),
                  title=f"{elements} clipped: {len(errors[RAW, elements])} samples")
    axes[0, 0].set_ylabel("share of samples below [%]")
    pictures.legend(figure, axes[0, 0], 5)
    pictures.save(figure, path)


def draw_localisation(maps: Scores, path: pathlib.Path) -> None:
    """Percentiles of the error at the end of the run."""
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
    """Density of angular speed against acceleration, with the outlines of other data sets."""
    from matplotlib.colors import LogNorm

    speed = np.concatenate([np.linalg.norm(r.true_rate_rad_s, axis=1) for r in recordings.values()])
    force = np.concatenate([np.linalg.norm(r.true_force_m_s2, axis=1) for r in recordings.values()])
    figure, axes = pictures.panels(1, 1, 7.5, 4.6)
    panel = axes[0, 0]
    _, _, _, mesh = panel.hist2d(force, speed, bins=(np.linspace(0, 250, 63), np.linspace(0, 42, 64)),
                                norm=LogNorm(vmin=0.1), cmap="Greys")  # one sample is visible
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
    """Data set -> steps (up to this acceleration in m/s², highest angular speed there in rad/s)."""
    out: dict[str, list[tuple[float, float]]] = {}
    with open(HERE / "outlines.csv", encoding="utf-8") as file:
        for name, force, speed in csv.reader(line for line in file if not line.startswith("#")):
            out.setdefault(name, []).append((float(force), float(speed)))
    return out


def worst_map(maps: Scores) -> int:
    """The draw whose map with the raw gyro has the median overlap among the failed ones; else the lowest overlap."""
    overlap = maps.of(MAPS[RAW], OVERLAP)
    failed = [seed for seed, value in maps.of(MAPS[RAW], FAILED).items() if value > 0 and seed in overlap]
    ordered = sorted(failed or overlap, key=lambda seed: overlap[seed])
    return ordered[len(ordered) // 2] if failed else ordered[0]


def draw_map(runs: Runs, maps: Scores, path: pathlib.Path) -> None:
    """Maps of one draw side by side, points coloured by their distance to the true surface."""
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
    pictures.save(figure, path, colours=255)


# colours, and height of the scale in pixels, of the program's pictures of maps: tools/pictures/map_pictures.cpp
ERROR_COLOURS = [(0.0, "#316ec8"), (0.1, "#5abe8c"), (0.25, "#f5e15a"), (0.5, "#f58c32"), (1.0, "#d71928")]
SCALE_PX = 26

PAGE = """# The tumbling rig: the paper next to our simulation

The paper is S.-P. Deschênes et al., *Saturation-Aware Angular Velocity Estimation: Extending the Robustness of SLAM to
Aggressive Motions*, ICRA 2024. A lidar rig is pushed down a hill and its gyro saturates. The published method recovers the
saturated axis from the accelerometer.

`tools/reproduce papers` writes this page. The script simulates {draws} runs of the scenario `hill` (seeds {first} to {last}) and runs
the published methods and our methods on the same recordings. The published methods run with the constants of the authors' launch files.

{headline}
- *raw gyro* is the published chain with the unchanged readings of the gyro (`rate/raw`, `slam/icp_raw`).
- *published* stands for `rate/saave` and `slam/published`. *ours* stands for `rate/tumble` and `slam/tumble` on the
  whole recording, and for `rate/tumble_lag` and `slam/tumble_lag` with a fixed lag.
- *published, threshold 10.0 rad/s* stands for the published methods with `{threshold}`.
  The default threshold of 10.45 rad/s fits a gyro that saturates at 10.5 rad/s, as in the paper. Each simulated run has its
  own gyro, and the saturation limits of the gyros differ by about 1 %.
  {unseen} of the clipped samples do not exceed 10.45 rad/s on any axis, and the published method does not change these samples.
- If a method fails on a simulated run, the run counts with the largest error, an overlap of 0 and a failed map.

## What is reproduced

- The published rate method reduces the error nearly as much as in the paper under the conditions of the paper. The
  conditions are one clipped sensing element, the exact centre of mass and a threshold below every saturation limit.
- Over all simulated runs, the published mapping chain reduces the median errors of localisation at least as much as in the paper.
- On the simulated runs whose conditions are most similar to the paper, the recovery raises the map overlap as in the paper.
- The published recovery does not remove all mapping failures here. Some simulated motions are faster than those of the paper.
  Our maps are not registered to the reference before the overlap is measured.

## What differs from the paper

| | paper | our simulation |
| --- | --- | --- |
| motion | 32 real runs of 5 to 10 m on one hill | random slope of 20 to 45°, 5 to 10 m long, with rocks and trunks |
| saturation limit of the gyro | one device, 10.5 rad/s | one device per run, 10.5 rad/s with a spread of about 1 % and tilted sensing elements |
| saturated axes | one at a time | two or three axes at a time in some clipped samples |
| rate reference | second IMU (VN-100), which has noise and also clips | exact rate of the simulation |
| centre of mass | found by balancing the rig | error of up to 20 mm, except in rows named "exact centre of mass" |
| lidar calibration, clock | as measured | mounting errors of up to 1 cm and 1°, clock errors of up to 5 ms |
| pose reference | static scans, registered with the published chain | exact pose |
| map reference | slow scan, to which each map is registered | true surface, aligned with the map by position and yaw at the start |
| rotation errors | above 90° reported as 90° | up to 180° |
| registration that aborts | ends the mapper | IMU odometry replaces the registration of the sweep |

## Rate through a tumble

![rate through a tumble](rig_rate.png)

Of all simulated runs, the figure shows the run with the most collisions during clipping. Grey marks contact with the ground.

## Rate error with and without recovery

{rates}
The gyro has three sensing elements, one near each axis. A clipped element reports its saturation limit.

![distribution of the rate error](rig_rate_errors.png)

## Localisation error

![percentiles of the localisation error](rig_localisation.png)

If a method failed, the figure shows an error of 10 m and 180°.

{alike_draws} of the {draws} simulated runs are most similar to the paper: two or three elements are clipped in at most 2 % of the
clipped samples. The table shows localisation and maps of the similar runs:

{alike}
## Map outliers

![maps coloured by error](rig_maps.png)

Seed {worst}: maps with the raw gyro, with the published method, and with ours (whole recording). The colour is the distance to the true surface.

## Angular speed against acceleration

![density of angular speed against acceleration](rig_density.png)

The paper states that its rig exceeds all other data sets in the paper by 13.9 rad/s and 127.1 m/s². The rectangle shows the
highest values of the other data sets: 4.7 rad/s and 30.7 m/s². The outlines of the paper's figure are not public as numbers.
Two public data sets replace the outlines: BROAD (Laidig et al., Data 2021, CC BY 4.0) and the model rockets of AirbrakesV2 (MIT).
Each outline is the highest angular speed in steps of 5 m/s². BROAD and AirbrakesV2 have no lidar, and reach higher angular
speeds than the data sets of the paper.

## Commands

The following sweeps, run in the work folder `build/reproduce/papers`, give the numbers of this page:

{commands}

The script computes the rate errors from the recordings and estimates that the first sweep stores. For the rows with the exact
centre of mass, the script writes the true mounting into a copy of each recording and runs `tumble estimate` on the copy.
"""
