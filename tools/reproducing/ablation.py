# SPDX-License-Identifier: BSD-3-Clause
"""Measures the effect of each mechanism of the estimators: runs the same simulated runs with the mechanism switched off.

docs/ablation.yaml names the sweeps (scenarios, methods, metrics) and the mechanisms (sweep, settings that switch the mechanism off, source files).
The module writes docs/ablation.md, and each change with its interval to changes.csv in the work folder.
"""
import csv
import math
import pathlib
import subprocess

import numpy
import yaml

from reproducing import figures
from reproducing.page import Table, finish

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILE, PAGE = ROOT / "docs/ablation.yaml", ROOT / "docs/ablation.md"
RESAMPLES = 4000
SMALL = 1.0  #: percent; a change whose interval is within this bound is small
VARIANTS = {"tumble": "whole", "tumble_lag": "lag", "tumble_live": "live"}
QUANTILES = {"median": 0.5, "tail": 0.9}


def varied_keys(off):
    """Returns the `vary` entries of a suite that switch a mechanism off, as {keys joined by +: [value]}."""
    joined = {}
    for key, value in off.items():
        joined.setdefault(float(value), []).append(key)
    return {"+".join(keys): [value] for value, keys in joined.items()}


def keys_of(method, off):
    """Returns the entry of varied_keys() that changes a method; empty if the method lacks the mechanism."""
    found = [keys for keys in varied_keys(off) if any(key.startswith(method + ".") for key in keys.split("+"))]
    if len(found) > 1:
        raise SystemExit(f"reproduce: docs/ablation.yaml sets parameters of {method} to different values; one mechanism must set them to one value")
    return found[0] if found else ""


def quantile(values, share):
    return numpy.sort(values, axis=-1)[..., math.ceil(share * values.shape[-1]) - 1]


def change(on, off, share):
    """Returns the change of a quantile in percent, and its 95 % interval from a bootstrap over the seeds."""
    picks = numpy.random.default_rng(1).integers(len(on), size=(RESAMPLES, len(on)))
    with numpy.errstate(invalid="ignore", divide="ignore"):
        value, resampled = (numpy.nan_to_num(100.0 * (quantile(b, share) / quantile(a, share) - 1.0), nan=0.0, posinf=math.inf)
                            for a, b in ((on, off), (on[picks], off[picks])))
    ordered = numpy.sort(resampled)
    return float(value), float(ordered[round(0.025 * RESAMPLES)]), float(ordered[round(0.975 * RESAMPLES) - 1])


def errors(runs, seeds, metric):
    """Returns the errors by seed; a failed run has an infinite error."""
    return numpy.array([runs[seed][1].get(metric, math.nan) if runs[seed][0] == "ok" else math.inf for seed in seeds])


def by_seed(scores, scenario, method):
    return {seed: run for (of, seed, by), run in scores.items() if (of, by) == (scenario, method)}


def compared(name, mechanism, sweep, folder, on):
    """Returns one row of changes per scenario and method of the mechanism."""
    rows = []
    for method, metric in sweep["metrics"].items():
        keys = keys_of(method, mechanism["without"])
        off = figures.read_scores(folder, keys) if keys else {}
        for scenario in sweep["scenarios"]:
            with_it, without = by_seed(on, scenario, method), by_seed(off, scenario, method)
            seeds = sorted(with_it.keys() & without.keys())
            a, b = errors(with_it, seeds, metric), errors(without, seeds, metric)
            known = ~(numpy.isnan(a) | numpy.isnan(b))
            a, b = a[known], b[known]
            if len(a) < 2:
                continue
            row = {"mechanism": name, "scenario": scenario, "method": method, "runs": len(a), "equal": int((a == b).sum()),
                   "failed_on": int(numpy.isinf(a).sum()), "failed_off": int(numpy.isinf(b).sum())}
            for statistic, share in QUANTILES.items():
                row |= dict(zip((statistic, statistic + "_low", statistic + "_high"), change(a, b, share)))
            if "coverage" in sweep:
                row["coverage_on"], row["coverage_off"] = (100.0 * float(numpy.nanmean([runs[seed][1].get(sweep["coverage"], math.nan) for seed in seeds]))
                                                           for runs in (with_it, without))
            rows.append(row)
    return rows


def matters(row):
    return any(row[s + "_low"] > 0 or row[s + "_high"] < 0 for s in QUANTILES) or row["failed_on"] != row["failed_off"]


def is_small(row):
    return all(-SMALL <= row[s + "_low"] and row[s + "_high"] <= SMALL for s in QUANTILES)


def percent(value):
    """Returns a change in percent; `∞` if runs fail without the mechanism."""
    return "∞" if value > 1e4 else f"{value + 0.0:.0f}".replace("-0", "0")


def interval(row, statistic):
    return f"{percent(row[statistic])} [{percent(row[statistic + '_low'])}, {percent(row[statistic + '_high'])}]"


def lines_of(mechanism):
    return sum(len((ROOT / "estimator" / file).read_text().splitlines()) for file in mechanism.get("files", []))


def coverage_change(row):
    return abs(row.get("coverage_on", 0.0) - row.get("coverage_off", 0.0))


def before_and_after(row, name, last=""):
    on, off = (row.get(f"{name}_{state}", 0.0) for state in ("on", "off"))
    return f"{on:.0f} → {off:.0f}{last}" if abs(on - off) >= 1.0 else ""  # also empty for NaN


def cells(row):
    return [row["scenario"], VARIANTS[row["method"].split("/")[1]], interval(row, "median"), interval(row, "tail"), before_and_after(row, "failed"),
            before_and_after(row, "coverage", " %")]


def page(described, rows):
    table = Table(["mechanism", "source lines", "scenario", "variant", "median", "tail", "failed", "within 3σ", "changed"])
    without_effect = []
    for name, mechanism in described["mechanisms"].items():
        own = [row for row in rows if row["mechanism"] == name]
        changed = [row for row in own if matters(row)]
        if own and all(row["equal"] == row["runs"] and coverage_change(row) < 1.0 for row in own):
            without_effect.append("- " + mechanism["does"])
        elif own:
            size = lambda row: (abs(row["failed_off"] - row["failed_on"]), max(abs(row[s]) for s in QUANTILES), coverage_change(row))
            table.add(mechanism["does"], str(lines_of(mechanism) or "–"), *cells(max(changed or own, key=size)), f"{len(changed)}/{len(own)}")
    equal = "\nThese mechanisms change no error in these scenarios:\n\n" + "\n".join(without_effect) + "\n" if without_effect else ""
    return described["text"].strip() + "\n\n" + table.text() + equal + "\nCommand: `tools/reproduce ablation`.\n"


def run(names, draws, program, folder, jobs, check):
    """Runs the sweeps of the named mechanisms and writes the page. Returns the lines of the page that differ, if `check` is set."""
    described = yaml.safe_load(FILE.read_text())
    mechanisms = described["mechanisms"]
    unknown = [name for name in names if name not in mechanisms]
    if unknown:
        raise SystemExit(f"reproduce: docs/ablation.yaml has no mechanism '{unknown[0]}'; its mechanisms are {', '.join(mechanisms)}")
    rows = []
    for name, sweep in described["sweeps"].items():
        own = {key: value for key, value in mechanisms.items() if value["sweep"] == name and (not names or key in names)}
        if not own:
            continue
        last = described["first_seed"] + (draws or sweep["draws"]) - 1
        vary = {keys: values for mechanism in own.values() for keys, values in varied_keys(mechanism["without"]).items()}
        command, databases = figures.sweep_command(name, {**sweep, "seeds": f"{described['first_seed']}..{last}", "methods": list(sweep["metrics"]),
                                                          "vary": vary}, program, folder, jobs)
        if subprocess.run(command, cwd=ROOT).returncode not in (0, 1):
            raise SystemExit(f"reproduce: {' '.join(command)} failed")
        on = figures.read_scores(databases)
        rows += [row for key, mechanism in own.items() for row in compared(key, mechanism, sweep, databases, on)]
    with open(folder / "changes.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, list(dict.fromkeys(key for row in rows for key in row)), restval="")
        writer.writeheader()
        writer.writerows(rows)
    text = page(described, rows)
    if names:
        print(text)
        return []
    return finish(PAGE, text, check)
