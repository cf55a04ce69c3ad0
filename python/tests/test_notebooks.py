# SPDX-License-Identifier: BSD-3-Clause
"""Runs the notebooks of docs/notebooks from the first cell to the last. The notebooks are kept without outputs."""
import os
import pathlib
import shutil
import sys

import h5py
import numpy as np
import pytest
from conftest import run_script

nbclient = pytest.importorskip("nbclient", reason="the extra `notebooks`")
nbformat = pytest.importorskip("nbformat")

FOLDER = pathlib.Path(__file__).parents[2] / "docs/notebooks"
RECORDING = FOLDER / "twirl.h5"


def pictures(notebook):
    return [len(output["data"]["image/png"]) for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs
            if "image/png" in output.get("data", {})]


def ran(notebook, folder):
    shutil.copy(RECORDING, folder)
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
    return notebook


def test_the_first_needs_no_program(tmp_path, monkeypatch):
    """Runs as after `pip install`: no file of the tree is on the path."""
    for name in ("REPOIMU", "TUMBLE_PROGRAM", "TUMBLE_ROOT"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("PATH", f"{pathlib.Path(sys.executable).parent}:/usr/bin:/bin")
    drawn = pictures(ran(nbformat.read(FOLDER / "saturated_rate.ipynb", as_version=4), tmp_path))
    assert len(drawn) == 1 and drawn[0] > 10_000, drawn


def datasets(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


@pytest.mark.program
def test_the_kept_recording_is_what_its_command_makes(program, tmp_path):
    """If the simulation has changed, run `python docs/notebooks/keep_twirl.py` to write the recording again."""
    run_script(FOLDER / "keep_twirl.py", tmp_path, tmp_path / "rewritten.h5")
    kept, rewritten = datasets(RECORDING), datasets(tmp_path / "rewritten.h5")
    assert len(kept) > 20 and kept.keys() == rewritten.keys()
    assert [name for name in kept if not np.array_equal(kept[name], rewritten[name], equal_nan=kept[name].dtype.kind == "f")] == []


@pytest.mark.program
@pytest.mark.parametrize("name, figures", [("saturated_rate", 1), ("map_of_a_tumble", 2), ("own_rate_method", 1)])
def test_notebook(name, figures, tmp_path, monkeypatch):
    monkeypatch.delenv("REPOIMU", raising=False)
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "kept without outputs"
    drawn = pictures(ran(notebook, tmp_path))
    assert len(drawn) == figures and min(drawn) > 10_000, drawn
    if keep := os.environ.get("TUMBLE_KEEP_NOTEBOOKS"):
        nbformat.write(notebook, pathlib.Path(keep) / f"{name}.ipynb")


def test_all_are_run():
    assert {path.stem for path in FOLDER.glob("*.ipynb")} == {"saturated_rate", "map_of_a_tumble", "own_rate_method"}


@pytest.mark.program
def test_a_real_wand(tmp_path, monkeypatch, real_data):
    """The notebook runs if the recording is available."""
    if real_data is None:
        return
    monkeypatch.setenv("REPOIMU", str(real_data / "repoimu/TStick_Test05_Trial1.csv"))
    assert len(pictures(ran(nbformat.read(FOLDER / "saturated_rate.ipynb", as_version=4), tmp_path))) == 1


def test_a_cell_that_fails_is_seen(tmp_path):
    """A notebook with an error fails (negative control)."""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("assert 1 + 1 == 3")])
    with pytest.raises(nbclient.exceptions.CellExecutionError):
        ran(notebook, tmp_path)
