#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Generates results databases of any size from a small real database, to measure the time of merge, report and compare.

    synthetic_results.py SMALL.db FOLDER --outcomes N [--shards K]

The script repeats rows of SMALL.db with new seeds until there are N outcomes. It multiplies each value by a number
between 0.5 and 2. It distributes contiguous parts of the seeds to FOLDER/shard_1.db ... shard_K.db, as `tumble sweep
--shard` does. Schema, notes and certificates are copied from SMALL.db. The scores are artificial.
"""
import argparse
import pathlib
import random
import sqlite3

DIGEST = "%032x"


def read(small):
    """Returns (key, values of the motion, outcomes with their scores) of each draw."""
    values, outcomes = {}, {}
    for scenario, seed, metric, value in small.execute(
            "SELECT scenario, seed, metric, value FROM draw_values WHERE varied = ''"):
        values.setdefault((scenario, seed), []).append((metric, value))
    for row in small.execute("SELECT id, scenario, seed, kind, method, status, message, recording_digest FROM outcomes "
                             "WHERE varied = '' AND kind <> ''"):
        scores = small.execute("SELECT metric, value FROM score_values WHERE outcome = ?", row[:1]).fetchall()
        outcomes.setdefault(row[1:3], []).append((row, scores))
    return [(key, values.get(key, []), rows) for key, rows in outcomes.items()]


def make_shard(path, small, draws, seeds, first_digest):
    path.unlink(missing_ok=True)
    shard = sqlite3.connect(path, isolation_level=None)
    shard.execute("PRAGMA synchronous = OFF")
    for pragma in ("application_id", "user_version"):
        shard.execute(f"PRAGMA {pragma} = {small.execute('PRAGMA ' + pragma).fetchone()[0]}")
    for (sql,) in small.execute("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY rowid"):
        shard.execute(sql)
    shard.execute("BEGIN")
    for table in ("notes", "certificates"):
        rows = small.execute(f"SELECT * FROM {table}").fetchall()
        if rows:
            shard.executemany(f"INSERT INTO {table} VALUES ({','.join('?' * len(rows[0]))})", rows)
    outcome = 0
    dice = random.Random(seeds[0])
    for seed in seeds:
        for (scenario, _), motion, rows in draws[seed % len(draws)]:
            factor = dice.uniform(0.5, 2.0)
            shard.executemany("INSERT INTO draw_values VALUES (?, ?, ?, ?, '', 0.0)",
                              [(scenario, seed, m, v if v is None else v * factor) for m, v in motion])
            for row, scores in rows:
                outcome += 1
                scored = row[5] in ("ok", "diverged", "failed")
                shard.execute("INSERT INTO outcomes VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, '', 0.0)",
                              (outcome, scenario, seed, row[3], row[4], row[5], row[6], row[7],
                               DIGEST % (first_digest + outcome) if scored else ""))
                own = dice.uniform(0.5, 2.0)
                shard.executemany("INSERT INTO score_values VALUES (?, ?, ?)",
                                  [(outcome, m, v if v in (None, 0.0) else v * own) for m, v in scores])
    shard.execute("COMMIT")
    shard.close()
    return outcome


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("small", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--outcomes", type=int, required=True)
    parser.add_argument("--shards", type=int, default=1)
    arguments = parser.parse_args()
    small = sqlite3.connect(f"file:{arguments.small}?mode=ro", uri=True)
    # a new seed has the draws of one seed of SMALL.db, for all scenarios
    by_seed = {}
    for draw in read(small):
        by_seed.setdefault(draw[0][1], []).append(draw)
    draws = list(by_seed.values())
    each = sum(len(rows) for draw in draws for _, _, rows in draw) / len(draws)
    seeds = max(arguments.shards, round(arguments.outcomes / each))
    arguments.folder.mkdir(parents=True, exist_ok=True)
    total = 0
    for k in range(arguments.shards):
        part = range(1 + k * seeds // arguments.shards, 1 + (k + 1) * seeds // arguments.shards)
        path = arguments.folder / f"shard_{k + 1}.db"
        total += make_shard(path, small, draws, part, k << 40)
        print(f"{path}: seeds {part.start} to {part.stop - 1}")
    print(f"{total} outcomes in {arguments.shards} databases")


if __name__ == "__main__":
    main()
