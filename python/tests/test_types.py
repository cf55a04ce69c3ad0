# SPDX-License-Identifier: BSD-3-Clause
"""mypy --strict reports no error for the package: stubs of the compiled module and Python sources."""
import pathlib
import sys

import pytest

import tumble

api = pytest.importorskip("mypy.api")
FOLDER = pathlib.Path(tumble.__file__).parent
SETTINGS = pathlib.Path(__file__).parents[1] / "pyproject.toml"


@pytest.fixture
def check(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if FOLDER.parent.name not in ("site-packages", "dist-packages"):  # mypy searches these folders automatically
        monkeypatch.setenv("MYPYPATH", str(FOLDER.parent))

    def run(*what):
        said, broken, status = api.run(["--strict", "--config-file", str(SETTINGS), "--python-executable", sys.executable,
                                        "--cache-dir", str(tmp_path / "cache"), *what])
        assert not broken, broken
        return said, status
    return run


def test_the_package(check):
    said, status = check("-p", "tumble")
    assert status == 0, said
    assert "no issues found in" in said


def test_who_calls_it(check, tmp_path):
    """Checks a valid user script, and a script with a type error."""
    good, bad = tmp_path / "good.py", tmp_path / "bad.py"
    good.write_text("""import tumble

def speed(stream: tumble.AngularRateStream, odometry: tumble.RollingOdometry, imu: tumble.Imu) -> float:
    rates = stream.add_imu(*imu.samples)
    state: bytes = odometry.save()
    odometry.load(state)
    return float(rates.rate[0, 0])
""")
    bad.write_text("""import tumble

state: str = tumble.Vqf().add_imu(0, None, None)
tumble.AngularRateStream(lever_arm_m=(0, 0, 0)).laod(b"")
""")
    said, status = check(str(good))
    assert status == 0, said
    said, status = check(str(bad))
    assert status == 1 and "Incompatible types" in said and "laod" in said, said
