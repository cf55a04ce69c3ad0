# SPDX-License-Identifier: BSD-3-Clause
"""The notebooks of docs/notebooks, run from the first cell to the last. They are kept without outputs."""
import os
import pathlib

import pytest

nbclient = pytest.importorskip("nbclient", reason="the extra `notebooks`")
nbformat = pytest.importorskip("nbformat")

FOLDER = pathlib.Path(__file__).parents[2] / "docs/notebooks"
pytestmark = pytest.mark.program


def pictures(notebook):
    return [len(output["data"]["image/png"]) for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs
            if "image/png" in output.get("data", {})]


def ran(notebook, folder):
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
    return notebook


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


def test_a_real_wand(tmp_path, monkeypatch, real_data):
    """Where the recording is at hand."""
    if real_data is None:
        return
    monkeypatch.setenv("REPOIMU", str(real_data / "repoimu/TStick_Test05_Trial1.csv"))
    assert len(pictures(ran(nbformat.read(FOLDER / "saturated_rate.ipynb", as_version=4), tmp_path))) == 1


def test_a_cell_that_fails_is_seen(tmp_path):
    """The negative control."""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("assert 1 + 1 == 3")])
    with pytest.raises(nbclient.exceptions.CellExecutionError):
        ran(notebook, tmp_path)
