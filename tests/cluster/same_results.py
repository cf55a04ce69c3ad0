"""Checks that two results databases have the same rows and scores, except for time and memory: same_results.py WHOLE.db
OTHER.db SEEDS"""
import sqlite3
import sys


def rows(path):
    costs = "'estimate_cpu_s', 'simulate_cpu_s', 'estimate_peak_mib'"
    return sqlite3.connect(path).execute(
        "SELECT o.scenario, o.seed, o.kind, o.method, o.status, o.recording_digest, o.estimate_digest, s.metric, s.value "
        f"FROM outcomes o JOIN score_values s ON s.outcome = o.id WHERE s.metric NOT IN ({costs}) "
        "ORDER BY 1, 2, 3, 4, 8").fetchall()


whole, other = rows(sys.argv[1]), rows(sys.argv[2])
assert len({row[1] for row in whole}) == int(sys.argv[3]), "the undisturbed sweep is not complete"
if whole != other:
    sys.exit(f"{len(whole)} rows undisturbed, {len(other)} in the other; they differ")
print(f"{len(other)} scores, as undisturbed")
