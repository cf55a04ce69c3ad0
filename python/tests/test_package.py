# SPDX-License-Identifier: BSD-3-Clause
"""Every public name of the package exists, is documented, and is in the stubs."""
import ast
import inspect
import pathlib

import tumble

TYPES = pathlib.Path(tumble.__file__).parent / "_tumble.pyi"


def compiled():
    return [name for name in tumble.__all__ if getattr(getattr(tumble, name), "__module__", "") == "tumble._tumble"]


def test_names_are_there_and_explained():
    assert len(tumble.__all__) == len(set(tumble.__all__)) > 50 and len(compiled()) > 25
    for name in tumble.__all__:
        thing = getattr(tumble, name)
        if not (inspect.isclass(thing) and issubclass(thing, Exception)):
            assert inspect.getdoc(thing), name
    for name in compiled():
        if inspect.isclass(getattr(tumble, name)):
            for member, value in vars(getattr(tumble, name)).items():
                if not member.startswith("_") and callable(value) and member not in ("parameters", "calibration", "map"):
                    assert inspect.getdoc(value), f"{name}.{member}"


def test_arrays_of_records_are_explained():
    """Each array member documents its shape and unit, in its comment or in the docstring of its class."""
    seen = 0
    for module in ("recordings", "estimates", "truth"):
        text = (TYPES.parent / f"{module}.py").read_text(encoding="utf-8")
        for record in (node for node in ast.parse(text).body if isinstance(node, ast.ClassDef) and not node.name.startswith("_")):
            for member in (node for node in record.body if isinstance(node, ast.AnnAssign)):
                if any(word in ast.unparse(member.annotation) for word in ("Array", "Trajectory", "RateTable", "Truth")):
                    seen += 1
                    documented = ast.unparse(member.target) in (ast.get_docstring(record) or "") or "#: " in text.splitlines()[member.lineno - 1]
                    assert documented, f"{module}.{record.name}: {ast.unparse(member)}"
    assert seen > 50


def test_stubs_have_what_the_module_has():
    tree = ast.parse(TYPES.read_text(encoding="utf-8"))
    known = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    assert set(compiled()) <= set(known)
    stream = {node.name for node in known["MotionRegimeStream"].body if isinstance(node, ast.FunctionDef)}
    assert {"add_imu", "flush", "newest", "body_imu_calibration", "__copy__"} <= stream
    assert (TYPES.parent / "py.typed").exists()
    untyped = {argument.arg for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) for argument in node.args.args
               if argument.annotation is not None and ast.unparse(argument.annotation) == "object"}
    assert untyped == {"memo"}, "arguments that may be anything"
    assert "NoSuchClass" not in known, "the negative control"


def test_module_is_one_file_beside_python():
    modules = [path for path in TYPES.parent.iterdir() if path.suffix == ".so"]
    assert len(modules) == 1 and modules[0].stat().st_size < 6e6
