# SPDX-License-Identifier: BSD-3-Clause
"""The examples run and give the documented results."""
import pathlib
import re

import pytest
from conftest import run_script

EXAMPLES = pathlib.Path(__file__).parents[1] / "examples"


def errors(text):
    """Returns the median speed error by name."""
    found = {name: float(error) for name, error in re.findall(r"^(\w+) +at \d+ clipped samples: median error of the speed ([\d.]+)", text, re.M)}
    assert set(found) == {"gyro", "tumble"}, text
    return found


def test_saturated_rate_in_closed_form(tmp_path):
    found = errors(run_script(EXAMPLES / "saturated_rate.py", tmp_path))
    assert found["gyro"] > 1.0 and found["tumble"] < 0.5 * found["gyro"]


def test_saturated_rate_of_a_real_wand(tmp_path, real_data):
    """Runs if the recording is available. The speed error is at most half that of the gyro; see docs/real_gyros.md for the rate."""
    if real_data is None:
        return
    found = errors(run_script(EXAMPLES / "saturated_rate.py", tmp_path, real_data / "repoimu" / "TStick_Test05_Trial1.csv"))
    assert found["gyro"] > 1.0 and found["tumble"] < 0.5 * found["gyro"]


@pytest.mark.program
def test_map_of_a_tumble(recordings, tmp_path):
    text = run_script(EXAMPLES / "map_of_a_tumble.py", tmp_path, recordings["hill"])
    assert float(re.search(r"ate ([\d.]+) m", text).group(1)) < 0.3, text
    assert int(re.search(r"a map of (\d+) points", text).group(1)) > 10000
    assert (tmp_path / "map.xyz").stat().st_size > 10000


@pytest.mark.program
def test_own_method(tmp_path):
    """The example method is better than the gyro and worse than rate/tumble."""
    pytest.importorskip("pandas", reason="the extra `tables`")
    lines = run_script(EXAMPLES / "own_method.py", tmp_path).splitlines()
    names = lines[0].split()[1:]
    rows = [dict(zip(names, map(float, line.split()[1:]), strict=True)) for line in lines[2:]]
    assert names == ["mine", "raw", "tumble"] and len(rows) == 3
    assert all(row["tumble"] < row["mine"] <= row["raw"] for row in rows) and rows[0]["mine"] < 0.5 * rows[0]["raw"], lines
