"""The notebooks for users, run cell by cell."""

import ast
import json
import shutil
from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "examples").glob("*.ipynb"))


def run(cells, name):
    """Runs the cells in one namespace and returns what each shows: the value of a last line that is an expression."""
    namespace, shown = {"__name__": "__main__"}, []
    for i, source in enumerate(cells):
        tree = ast.parse(source, f"{name}, cell {i}")
        last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, f"{name}, cell {i}", "exec"), namespace)
        shown.append(
            eval(compile(ast.Expression(last.value), f"{name}, cell {i}", "eval"), namespace) if last else None
        )
    return shown


@pytest.fixture
def demo_out(recipe, finished, tmp_path, monkeypatch):
    """A working folder with a small run where the notebooks expect the demo."""
    shutil.copytree(finished, tmp_path / "demo-out")
    shutil.copytree(recipe.parent / "demo" / ".trove" / "demo", tmp_path / "demo-out" / ".trove" / "demo")
    monkeypatch.chdir(tmp_path)


def test_there_are_notebooks():
    assert len(NOTEBOOKS) == 3


@pytest.mark.usefixtures("demo_out")
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_shows_pictures(path):
    notebook = json.loads(path.read_text(encoding="utf-8"))
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code), "outputs are not committed"
    shown = run(["".join(cell["source"]) for cell in code], path.name)
    pictures = [value._repr_png_() for value in shown if hasattr(value, "_repr_png_")]
    assert pictures and all(picture.startswith(b"\x89PNG") for picture in pictures)
