#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests tools/reproduce without the program: scores of a small database, numbers of a page, and the check for stale
numbers.

    reproducing_test.py TOOLS_FOLDER
"""
import pathlib
import sqlite3
import sys
import tempfile
import types
import unittest

import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, sys.argv.pop(1))
from reproducing import ablation, doctor, figures, page, rig, runs, saturation, sphere  # noqa: E402

SCHEMA = """
CREATE TABLE scores (scenario TEXT, seed INTEGER, kind TEXT, method TEXT, status TEXT, metric TEXT, value REAL);
CREATE TABLE curves (varied TEXT, setting REAL, scenario TEXT, seed INTEGER, kind TEXT, method TEXT, status TEXT, metric TEXT, value REAL);
INSERT INTO curves VALUES ('slam/published.saturation_point_rad_s', 10.0, 'hill', 1, 'slam', 'published', 'ok', 'ate_m', 0.5);
"""


class Case(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)

    def scores(self, *rows: tuple) -> runs.Scores:
        """Creates a database from rows of seed, kind, method, status, metric and value."""
        path = self.root / "scores.db"
        path.unlink(missing_ok=True)
        with sqlite3.connect(path) as database:
            database.executescript(SCHEMA)
            database.executemany("INSERT INTO scores VALUES ('hill', ?, ?, ?, ?, ?, ?)", rows)
        return runs.Scores(path)


class ReadingScores(Case):
    def test_a_failed_draw_counts_as_the_worst(self):
        scores = self.scores((1, "slam", "icp_raw", "ok", "ate_m", 2.0), (2, "slam", "icp_raw", "crashed", None, None),
                             (3, "slam", "icp_raw", "ok", "ate_m", 1.0))
        self.assertEqual(scores.values("slam/icp_raw", "ate_m"), [2.0, float("inf"), 1.0])
        self.assertEqual(scores.values("slam/icp_raw", "ate_m", seeds=[2, 3], failed=9.0), [9.0, 1.0])

    def test_a_method_with_a_varied_parameter_has_a_name_of_its_own(self):
        scores = self.scores((1, "slam", "published", "ok", "ate_m", 2.0))
        self.assertEqual(scores.of("slam/published", "ate_m"), {1: 2.0})
        self.assertEqual(scores.of(rig.MAPS[rig.TUNED], "ate_m"), {1: 0.5})


class Ablation(unittest.TestCase):
    METRIC = {"rate/tumble": "error"}

    def compared(self, on: list, off: list) -> dict:
        """Returns the row of a mechanism with these errors by seed; None: the run failed."""
        path = self.folder / "rates.db"
        path.unlink(missing_ok=True)
        rows = [("scores", "", on), ("curves", "rate/tumble.gain", off)]
        with sqlite3.connect(path) as database:
            database.executescript(SCHEMA)
            for table, varied, errors in rows:
                for seed, error in enumerate(errors):
                    run = ("hill", seed, "rate", "tumble", "failed" if error is None else "ok", "error", error)
                    values = run if table == "scores" else (varied, 0.0, *run)
                    database.execute(f"INSERT INTO {table} VALUES ({','.join('?' * len(values))})", values)
        sweep = {"scenarios": ["hill"], "metrics": self.METRIC}
        return ablation.compared("gain", {"without": {"rate/tumble.gain": 0}}, sweep, self.folder, figures.read_scores(self.folder))[0]

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def test_a_mechanism_that_halves_the_error_of_each_run_changes_median_and_tail_by_100_percent(self):
        row = self.compared([1.0, 2.0, 3.0, 4.0], [2.0, 4.0, 6.0, 8.0])
        self.assertEqual([row[key] for key in ("median", "median_low", "median_high", "tail")], [100.0] * 4)
        self.assertTrue(ablation.matters(row) and not ablation.is_small(row))

    def test_a_mechanism_without_effect_is_small(self):
        row = self.compared([1.0, 2.0, 3.0], [1.0, 2.0, 3.0])
        self.assertTrue(ablation.is_small(row) and not ablation.matters(row))
        self.assertEqual(row["equal"], 3)

    def test_a_failed_run_counts(self):
        row = self.compared([1.0, 2.0, 3.0], [1.0, 2.0, None])
        self.assertEqual((row["failed_on"], row["failed_off"], row["tail"]), (0, 1, float("inf")))
        self.assertTrue(ablation.matters(row))

    def test_one_method_cannot_have_two_values(self):
        with self.assertRaises(SystemExit):
            ablation.keys_of("rate/tumble", {"rate/tumble.a": 0, "rate/tumble.b": 1})

    def test_the_description_names_known_sweeps_and_existing_files(self):
        described = ablation.yaml.safe_load(ablation.FILE.read_text())
        for mechanism in described["mechanisms"].values():
            metrics = described["sweeps"][mechanism["sweep"]]["metrics"]
            self.assertTrue(any(ablation.keys_of(method, mechanism["without"]) for method in metrics))
            self.assertGreaterEqual(ablation.lines_of(mechanism), 0)


class SaturatedSpin(unittest.TestCase):
    PLACES = np.array([[0.001, -0.006, 0.0], [-0.001, -0.012, 0.0005]])

    def imus(self, bend: float = 0.0) -> tuple[dict, np.ndarray]:
        """Returns the readings of three IMUs on a body that spins about x beyond the saturation limit, and the true rate. `bend` moves the second IMU, m."""
        rng = np.random.default_rng(3)
        time = np.arange(48.0, 68.0, 0.01)
        spin = 10.0 + 42.0 * np.clip((time - 48.0) / 18.0, 0.0, 1.0) + np.sin(time)
        rate = np.stack([spin, 2.0 * np.cos(3.0 * time), 1.5 * np.sin(2.0 * time)], axis=1)
        w = saturation.cross_matrices(rate)
        rows = saturation.cross_matrices(np.gradient(rate, time, axis=0)) + w @ w
        saturated = rate.copy()
        saturated[:, 0] = np.minimum(spin, 34.87)
        forces = [np.array([1.0, 2.0, 9.0])] + [np.array([1.1, 2.0, 8.8]) + rows @ place for place in self.PLACES]
        late = (time > 60.0)[:, None]
        forces[1] = forces[1] + bend * late * (rows @ np.array([0.0, 1.0, 0.0]))
        return {name: saturation.Imu(time, saturated, force + rng.normal(0.0, 0.05, rate.shape)) for name, force in zip("ABC", forces)}, spin

    def test_the_accelerometers_measure_the_rate(self):
        imus, spin = self.imus()
        truth = saturation.reference(imus)
        self.assertLess(np.abs(np.array(truth.positions) - self.PLACES).max(), 1e-4)
        self.assertGreater(truth.used.sum(), 600)
        error = (truth.rate - spin)[truth.used]
        self.assertGreater(np.mean(np.abs(error) < 3.0 * truth.sigma), 0.97)
        # a body that bends gives two different rates
        self.assertGreater(saturation.reference(self.imus(bend=0.0005)[0]).sigma, 3.0 * truth.sigma)


class DoctorCounts(unittest.TestCase):
    def test_each_fault_is_in_each_format(self):
        cases = [doctor.Case(name, number) for name in doctor.FORMATS for number in range(doctor.CARRIED + doctor.TUMBLING)]
        self.assertEqual(len({case.seed for case in cases}), len(cases))
        for name, fault in doctor.FAULTS.items():
            formats = [case.format for case in cases if name in case.faults() and case.kind == "carried"]
            used = [key for key, each in doctor.FORMATS.items() if not (fault.without_times and each.needs_times)]
            self.assertEqual(formats, used if "carried" in fault.kinds else [], name)

    def test_a_repair_must_name_the_correct_pose(self):
        T_BL = np.eye(4)
        T_BL[:3, :3] = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
        row = {"fault": True, "evidence": "turned (set '--T-body-lidar 0 0 0.1 0.003 0 -0.709 0.705')", "repair": ""}
        expected = doctor.Expected("turned", "--T-body-lidar", T_BL)
        self.assertEqual(doctor.judged([row], expected), (True, True))
        row["evidence"] = row["evidence"].replace("-0.709", "0.709")
        self.assertEqual(doctor.judged([row], expected), (True, False))
        self.assertEqual(doctor.judged([row | {"fault": False}], expected), (False, False))

    def test_a_quarter_turn_is_a_rotation_by_90_degrees(self):
        R = doctor.quarter_turn(np.random.default_rng(1))
        np.testing.assert_allclose(R @ R.T, np.eye(3))
        self.assertAlmostEqual(doctor.angle_deg(R), 90.0)

    def test_the_interval_of_a_share(self):
        np.testing.assert_allclose(doctor.wilson(0, 108), (0.0, 0.0343), atol=1e-4)
        np.testing.assert_allclose(doctor.wilson(95, 100), (0.8882, 0.9785), atol=1e-4)


class Numbers(unittest.TestCase):
    def test_significant_digits(self):
        self.assertEqual([page.number(v) for v in (0.012345, 12.345, 1234.5, 0.0, float("inf"), float("nan"))],
                         ["0.0123", "12.3", "1234", "0", "lost", "-"])

    def test_a_change_has_its_sign(self):
        self.assertEqual(page.change(0.166, 1.0), "−83.4 %")
        self.assertEqual(page.change(1.5, 1.0), "+50.0 %")
        self.assertEqual(page.change(float("inf"), 1.0), "-")

    def test_a_row_has_a_cell_for_each_column(self):
        self.assertRaises(ValueError, page.Table(["a", "b"]).add, "only one")


class StalePages(Case):
    def test_a_stale_number_is_found_and_a_fresh_one_is_not(self):
        path = self.root / "rig.md"
        self.assertEqual(page.finish(path, "| error | 1.25 m |\n", check=False), [])
        self.assertEqual(page.finish(path, "| error | 1.25 m |\n", check=True), [])
        found = page.finish(path, "| error | 1.26 m |\n", check=True)
        self.assertEqual(len(found), 1)
        self.assertIn("page has '| error | 1.25 m |', results give '| error | 1.26 m |'", found[0])
        self.assertIn("1.25", path.read_text())

    def test_a_page_that_lacks_lines_or_is_not_there_is_stale(self):
        self.assertEqual(len(page.stale("a\n", "a\nb\n")), 1)
        self.assertEqual(len(page.finish(self.root / "none.md", "a\n", check=True)), 1)


class RigPage(Case):
    def recording(self, elements: int) -> types.SimpleNamespace:
        clipped = np.array([0, 1, elements, 0])
        return types.SimpleNamespace(gyro_rad_s=np.full((4, 3), 10.5), true_rate_rad_s=np.full((4, 3), 5.0), true_force_m_s2=np.full((4, 3), 20.0),
                                     clipped=clipped > 0, clipped_elements=clipped)

    def text(self, overlap: float) -> str:
        """Tests the page of two draws."""
        rows = []
        for seed in (1, 2):
            for name in rig.SWEPT:
                method, ours = rig.MAPS[name], name in (rig.BATCH, rig.LAG)
                values = {rig.TRANSLATION: 0.1 if ours else 1.0, rig.ROTATION: 0.01, rig.OVERLAP: 0.99 if ours else overlap, rig.FAILED: 0.0}
                rows += [(seed, "slam", method.split("/")[1], "ok", metric, value) for metric, value in values.items()]
        maps = self.scores(*rows)
        errors = {(m, e): np.array([1.0, 2.0, 3.0]) if m == rig.RAW else np.array([0.1, 0.5, 0.9])
                  for m in rig.RATES for e in (rig.ANY, rig.ONE, rig.MORE)}
        return rig.page(runs.Runs(pathlib.Path("tumble"), self.root, (1, 2)), {1: self.recording(1), 2: self.recording(2)}, errors,
                        errors, maps)

    def test_it_holds_the_results(self):
        text = self.text(overlap=0.8)
        for expected in ("−75.0 %", "2.00 rad/s", "80.0 %", "−90.0 %", "2 simulated runs of", "8.66 rad/s"):
            self.assertIn(expected, text)

    def test_another_result_makes_it_stale(self):
        found = page.stale(self.text(overlap=0.8), self.text(overlap=0.7))
        self.assertEqual(len(found), 2)  # values of all draws, and of the draws in which one element clips at a time
        self.assertIn("map overlap", found[0])

    def test_draws_that_clip_two_elements_are_told_apart(self):
        self.assertEqual(rig.draws_with_one({1: self.recording(1), 2: self.recording(2), 3: self.recording(3)}), [1])
        self.assertIn("1 of 2 simulated runs that are most similar to the ICRA paper", self.text(overlap=0.8))


class Legs(unittest.TestCase):
    def test_the_corner_parts_the_legs(self):
        there = np.linspace(0, 1, 11)[:, None]
        path = np.vstack([there * [1.0, 0.0], [1.0, 0.0] + there[1:] * [0.0, 0.5]])
        corner = sphere.corner_of(path)
        self.assertEqual(corner, 10)
        np.testing.assert_allclose(sphere.legs_of(path, corner), (1.0, 0.5))


class Running(Case):
    def program(self, *lines: str) -> runs.Runs:
        path = self.root / "tumble"
        path.write_text("#!/bin/sh\n" + "\n".join(lines) + "\n")
        path.chmod(0o755)
        return runs.Runs(path, self.root / "work", (5, 8))

    def test_a_failure_names_the_command_and_its_error(self):
        with self.assertRaisesRegex(runs.ProgramFailed, "tumble sweep hill.*exit status 2: no such suite"):
            self.program("echo no such suite >&2; exit 2").sweep("a", "hill")

    def test_an_estimate_that_is_complete_is_not_made_again(self):
        program = self.program('while [ "$1" != -o ]; do shift; done; mkdir "$2" && echo {} > "$2/estimate.json"')
        folder = program.folder / "one"
        program.estimate(self.root / "r.h5", "attitude/vqf", folder)
        program.estimate(self.root / "r.h5", "attitude/vqf", folder)  # mkdir would fail
        self.assertEqual(len(program.commands), 1)
        (folder / "estimate.json").unlink()  # stopped half-way
        program.estimate(self.root / "r.h5", "attitude/vqf", folder)
        self.assertTrue((folder / "estimate.json").is_file())


class Figures(unittest.TestCase):
    """Tests the tables of docs/figures.yaml."""

    GROUP = {"sweep": "s", "by": "scenario", "rows": {"hill": "grassy hill"},
             "columns": [{"text": "end error [cm]"}, {"method": "slam/a", "metric": "end_m", "statistic": "median", "scale": 100},
                         {"method": "slam/a", "statistic": "failures"}]}
    TABLE = {"page": "page.md", "titles": ["scenario", "measure", "end error", "failed"], "text": "Medians.", "tolerance": 0.02, "groups": [GROUP]}
    SCORES = {("hill", 1, "slam/a"): ("ok", {"end_m": 0.01}), ("hill", 2, "slam/a"): ("ok", {"end_m": 0.03}),
              ("hill", 3, "slam/a"): ("diverged", {"end_m": 0.001}), ("hill", 3, "slam/b"): ("ok", {"end_m": 9.0})}

    def test_a_failed_draw_counts_as_infinite(self):
        self.assertEqual(figures.computed(self.GROUP, self.SCORES), {"hill": [[3.0, 3], [1, 3]]})

    def test_a_mean_omits_a_failed_draw(self):
        column = {"method": "slam/a", "metric": "end_m", "statistic": "mean", "scale": 100}
        self.assertEqual(figures.cell(self.SCORES, "hill", column, "slam/a"), (2.0, 3))

    def test_a_verdict_is_counted(self):
        column = {"method": "slam/a", "metric": "wrong", "statistic": "count"}
        scores = {("hill", seed, "slam/a"): ("ok", {"wrong": wrong}) for seed, wrong in enumerate((0.0, 1.0, 1.0))} | {("hill", 3, "slam/a"): ("failed", {})}
        self.assertEqual(figures.cell(scores, "hill", column, "slam/a"), (2, 4))
        self.assertEqual(figures.shown(2.0, 4, column), "2 of 4")
        self.assertEqual(figures.cell(scores, "hill", column | {"metric": "renamed"}, "slam/a"), (None, 4))

    def test_a_row_can_show_the_runs_with_a_varied_parameter(self):
        with tempfile.TemporaryDirectory() as folder:
            with sqlite3.connect(pathlib.Path(folder) / "s.db") as database:
                database.executescript(SCHEMA)
                database.execute("INSERT INTO scores VALUES ('hill', 1, 'slam', 'a', 'ok', 'end_m', 0.01)")
                for keys, setting, value in (("a.delay_s+b.delay_s", 2.5, 0.02), ("a.delay_s+b.delay_s", 4.0, 0.04), ("c", 2.5, 0.9)):
                    database.execute("INSERT INTO curves VALUES (?, ?, 'hill', 1, 'slam', 'a', 'ok', 'end_m', ?)", (keys, setting, value))
            scores = figures.read_sweep(pathlib.Path(folder), {"vary": {"a.delay_s+b.delay_s": [2.5, 4]}})
        rows = {"hill": "", "hill@2.5": "", "hill@4": ""}
        self.assertEqual([cells[0][0] for cells in figures.computed(self.GROUP | {"rows": rows}, scores).values()], [1.0, 2.0, 4.0])

    def test_a_cell_beyond_the_tolerance_is_stale(self):
        found = figures.computed(self.GROUP, self.SCORES)
        self.assertEqual(figures.stale("t", 0.02, {"hill": [[3.05, 3], [1, 3]]}, found), [])
        self.assertIn("value 1", figures.stale("t", 0.02, {"hill": [[3.1, 3], [1, 3]]}, found)[0])
        self.assertIn("value 2", figures.stale("t", 0.02, {"hill": [[3.0, 3], [0, 3]]}, found)[0])
        self.assertEqual(len(figures.stale("t", 0.02, {"hill": [[3.0, 4], [1, 4]]}, found)), 2, "another number of draws")

    def test_a_page_that_differs_from_the_values_is_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            marks = "before\n<!-- t: written by tools/reproduce figures -->\n<!-- end of t -->\nafter\n"
            (root / "page.md").write_text(marks)
            described = {"tables": {"t": self.TABLE}, "values": {"t": {"hill": [[3.0, 3], [1, 3]]}}}
            self.assertEqual(len(figures.stale_pages(described, root)), 1)
            figures.write_pages(described, root)
            self.assertEqual(figures.stale_pages(described, root), [])
            self.assertIn("| grassy hill | end error [cm] | 3 | 1 of 3 |", (root / "page.md").read_text())
            described["values"]["t"]["hill"][0][0] = 4.0
            self.assertEqual(len(figures.stale_pages(described, root)), 1)

    def test_the_pages_of_the_tree_show_the_values_of_figures_yaml(self):
        self.assertEqual(figures.stale_pages(figures.load()), [])


if __name__ == "__main__":
    unittest.main()
