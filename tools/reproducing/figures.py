# SPDX-License-Identifier: BSD-3-Clause
"""Checks and writes the tables of README.md, docs/figures.md and peers/README.md: runs sweeps and compares each cell with docs/figures.yaml.

docs/figures.yaml names the sweeps (scenarios, seeds, methods, or a command), the tables (page, titles, groups of rows with their columns, tolerance) and, below
the line `values:`, the value of each cell. A row SCENARIO@VALUE shows the runs of a scenario with this value of the sweep's varied parameter. A cell
is stale if a new run differs from its value by more than the table's tolerance.
"""
import math
import pathlib
import re
import sqlite3
import statistics
import subprocess

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILE = ROOT / "docs/figures.yaml"


def load(file=FILE):
    described = yaml.safe_load(file.read_text())
    described.setdefault("values", {})
    return described


def sweep_command(name, sweep, program, folder, jobs):
    """Returns the command of a sweep, and the databases that it fills."""
    if "command" in sweep:
        return sweep["command"].format(folder=folder / name, jobs=jobs).split(), folder / name
    first, last = (int(number) for number in str(sweep["seeds"]).split(".."))
    suite = folder / f"{name}.yaml"
    suite.parent.mkdir(parents=True, exist_ok=True)
    suite.write_text(yaml.safe_dump({"name": name, "doc": f"Sweep '{name}' of docs/figures.yaml.", "scenarios": sweep["scenarios"],
                                     "seeds": {"first": first, "last": last}, "methods": sweep["methods"],
                                     "timeout_s": sweep.get("timeout_s", 300), **({"vary": sweep["vary"]} if "vary" in sweep else {})}, sort_keys=False))
    database = folder / name / f"{name}.db"
    database.parent.mkdir(exist_ok=True)
    return [str(program), "sweep", str(suite), "--jobs", str(jobs), "--examples", "0", "--failures", "0", "--db", str(database)], folder / name


def read_scores(folder, varied="", scenario="scenario"):
    """Returns (status, {metric: value}) for each (scenario, seed, kind/method), from all databases of a folder; with the keys `varied` set to other values.
    The SQL expression `scenario` names the scenario."""
    scores = {}
    for file in sorted(folder.glob("*.db")):
        with sqlite3.connect(f"file:{file}?mode=ro", uri=True) as database:
            columns = f"SELECT {scenario}, seed, kind, method, status, metric, value FROM "
            for name, seed, kind, method, status, metric, value in database.execute(
                    columns + ("curves WHERE method <> '' AND varied = ?" if varied else "scores WHERE method <> '' AND '' = ?"), (varied,)):
                values = scores.setdefault((name, seed, f"{kind}/{method}"), (status, {}))[1]
                if metric:
                    values[metric] = value
    return scores


def read_sweep(folder, sweep):
    """Returns the scores of a sweep. The runs with a VALUE of a varied parameter belong to the scenario SCENARIO@VALUE."""
    scores = read_scores(folder)
    for keys in sweep.get("vary", {}):
        scores |= read_scores(folder, keys, "scenario || '@' || printf('%g', setting)")
    return scores


def cell(scores, scenario, column, method):
    """Returns the value of a cell and its number of simulated runs. A failed run counts as infinite in a median, and as one failure. A mean omits
    failed runs. The statistic `count` is the number of runs whose metric is 1."""
    draws = [entry for (of, _, by), entry in scores.items() if of == scenario and by == method]
    if column["statistic"] == "failures":
        return sum(status != "ok" for status, _ in draws), len(draws)
    if column["statistic"] == "count":
        verdicts = [values[column["metric"]] for _, values in draws if column["metric"] in values]
        return verdicts.count(1) if verdicts else None, len(draws)
    used = [values.get(column["metric"]) if status == "ok" else math.inf for status, values in draws]
    used = [value for value in used if value is not None and not math.isnan(value)]  # a run without clipped samples has no such score
    if column["statistic"] == "mean":
        used = [value for value in used if math.isfinite(value)]
    if not used:
        return None, len(draws)
    value = {"median": statistics.median, "mean": statistics.fmean, "max": max}[column["statistic"]](used)
    return value * column.get("scale", 1.0), len(draws)


def computed(group, scores):
    """Returns a list of [value, number of runs] per row, in the order of the columns. Rows are scenarios or methods; a column may be a text."""
    out = {}
    for row in group["rows"]:
        cells = []
        for column in group["columns"]:
            if "text" in column:
                continue
            scenario, method = (row, column["method"]) if group["by"] == "scenario" else (column["scenario"], row)
            value, draws = cell(scores, scenario, column, method)
            if value is not None:
                value = "failed" if math.isinf(value) else float(f"{value:.4g}")
            cells.append([value, draws])
        out[row] = cells
    return out


def stale(name, tolerance, expected, found):
    """Returns messages about the cells that differ from their expected value by more than the tolerance."""
    out = []
    for row, cells in found.items():
        for number, ((value, draws), (was, was_draws)) in enumerate(zip(cells, expected.get(row) or [[None, 0]] * len(cells)), 1):
            same = value == was or (isinstance(value, float) and isinstance(was, (int, float)) and
                                    abs(value - was) <= tolerance * max(abs(was), abs(value)))
            if not same or draws != was_draws:
                out.append(f"{name}: row '{row}', value {number} is {value} of {draws} draws, but docs/figures.yaml states {was} of {was_draws}")
    return out


def shown(value, draws, column):
    if value is None:
        return "–"
    if column["statistic"] in ("failures", "count"):
        return f"{int(value)} of {draws}"
    return value if isinstance(value, str) else f"{value:.3g}" if value < 1000 else f"{value:.0f}"


def rendered(name, described):
    """Returns the Markdown of a table from the values of docs/figures.yaml."""
    table, values = described["tables"][name], described["values"].get(name, {})
    lines = [table["text"].strip(), "", "| " + " | ".join(table["titles"]) + " |", "|---|" + "---:|" * (len(table["titles"]) - 1)]
    for group in table["groups"]:
        for row, label in group["rows"].items():
            known = iter(values[row])
            cells = [column["text"] if "text" in column else shown(*next(known), column) for column in group["columns"]]
            lines.append("| " + " | ".join([label, *cells]) + " |")
    return "\n".join([*lines, "", f"Command: `tools/reproduce figures {name}`."])


def block(name):
    return re.compile(rf"(<!-- {name}: written by tools/reproduce figures -->\n).*?(<!-- end of {name} -->)", re.S)


def stale_pages(described, root=ROOT):
    """Returns messages about tables whose text on their page differs from docs/figures.yaml."""
    out = []
    for name, table in described["tables"].items():
        found = block(name).search((root / table["page"]).read_text())
        if not found or found.group(0) != block(name).sub(lambda m: m.group(1) + rendered(name, described) + "\n" + m.group(2), found.group(0)):
            out.append(f"{table['page']}: table '{name}' differs from docs/figures.yaml; run tools/reproduce figures --pages")
    return out


def write_pages(described, root=ROOT):
    for name, table in described["tables"].items():
        page = root / table["page"]
        page.write_text(block(name).sub(lambda m: m.group(1) + rendered(name, described) + "\n" + m.group(2), page.read_text()))


def write_values(described, file=FILE):
    text = file.read_text()
    head = text[:text.index("\nvalues:")] if "\nvalues:" in text else text.rstrip("\n")
    lines = ["values:"]
    for name, rows in described["values"].items():
        lines.append(f"  {name}:")
        lines += [f"    {row}: [" + ", ".join(f"[{'null' if v is None else v}, {n}]" for v, n in cells) + "]" for row, cells in rows.items()]
    file.write_text(head + "\n" + "\n".join(lines) + "\n")


def run(names, program, folder, jobs, write, pages):
    """Runs the sweeps of the named tables. Returns the number of stale cells, whose values differ from docs/figures.yaml."""
    described = load()
    if pages:
        write_pages(described)
        return 0
    unknown = [name for name in names if name not in described["tables"]]
    if unknown:
        raise SystemExit(f"reproduce: docs/figures.yaml has no table '{unknown[0]}'; its tables are {', '.join(described['tables'])}")
    names = names or list(described["tables"])
    complaints, scores = [], {}
    for name in names:
        table, found = described["tables"][name], {}
        for group in table["groups"]:
            sweep = group["sweep"]
            if sweep not in scores:
                command, databases = sweep_command(sweep, described["sweeps"][sweep], program, folder, jobs)
                if subprocess.run(command, cwd=ROOT).returncode not in (0, 1):
                    raise SystemExit(f"reproduce: {' '.join(command)} failed")
                scores[sweep] = read_sweep(databases, described["sweeps"][sweep])
            found |= computed(group, scores[sweep])
        complaints += stale(name, table["tolerance"], described["values"].get(name, {}), found)
        described["values"][name] = found
    if write:
        write_values(described)
        write_pages(described)
    print("\n".join(complaints) if complaints else f"reproduce: {', '.join(names)}: all cells agree with docs/figures.yaml")
    return 0 if write else len(complaints)
