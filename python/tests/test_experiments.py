"""`experiments`: their files say nothing that trove or trove.train does not know, and changes change what they say."""

import importlib.util
import shutil
from pathlib import Path

import pytest
from conftest import trove
from trove.train.experiment import ExperimentError, read, tomllib

EXPERIMENTS = Path(__file__).resolve().parents[2] / "experiments"
TABLES = {path: tomllib.loads(path.read_text()) for path in sorted(EXPERIMENTS.glob("*/*.toml"))}
RECIPES = sorted(path for path in EXPERIMENTS.glob("unseen/*/*.toml") if path.parent.name in ("britain", "india"))


@pytest.fixture
def unseen(tmp_path):
    """`experiments/unseen/run.py` in a folder of its own."""
    shutil.copytree(EXPERIMENTS / "unseen", tmp_path / "unseen", ignore=shutil.ignore_patterns("out", "data"))
    spec = importlib.util.spec_from_file_location("unseen_run", tmp_path / "unseen/run.py")
    module = importlib.util.module_from_spec(spec)
    # Its data classes look for it there.
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(__import__("sys").modules, "unseen_run", module)
        patch.syspath_prepend(tmp_path / "unseen")
        spec.loader.exec_module(module)
        yield module


@pytest.mark.parametrize("path", [path for path, table in TABLES.items() if "training" in table], ids=lambda p: p.stem)
def test_an_experiment_lacks_nothing_but_its_data(path, tmp_path):
    copy = tmp_path / path.name
    copy.write_text(path.read_text())
    with pytest.raises(ExperimentError, match=r"expected images laid out as|training\.weights: expected the state of"):
        read(copy)


@pytest.mark.parametrize("path", [path for path in RECIPES if path.stem != "camera"], ids=lambda p: p.stem)
def test_a_recipe_lacks_nothing_but_its_map(path, tmp_path):
    shutil.copytree(path.parent, tmp_path / "recipes")
    done = trove("generate", tmp_path / "recipes" / path.name, "--dry-run")
    assert done.returncode != 0 and ".osm" in done.stderr and "expected one of" not in done.stderr, done.stderr


def test_every_experiment_of_unseen_places_has_its_files(unseen):
    files = {path.stem for path, table in TABLES.items() if path.parent.name == "unseen" and "training" in table}
    assert files == set(unseen.EXPERIMENTS)
    for name, frames in unseen.EXPERIMENTS.items():
        text = (unseen.HERE / f"{name}.toml").read_text()
        assert (unseen.HERE / frames.recipes).is_dir() and f'root   = "data/{frames.real}"' in text
        folders = [f"{frames.recipes}-{change}" for change in frames.changes] or [frames.recipes]
        assert all(f'"out/{folder}"' in text for folder in folders)
        assert all(f'"out/recolored/{{fold}}/{folder}"' in text for folder in folders)


def test_a_change_takes_the_place_of_what_every_recipe_says(unseen, tmp_path):
    (tmp_path / "unseen/data").mkdir()
    changes = {path.stem: tomllib.loads(path.read_text()) for path in (unseen.HERE / "changes").glob("*.toml")}
    for change, own in changes.items():
        folder = unseen.changed(unseen.HERE / "britain", change)
        wanted = unseen.merged(changes["none"], own)
        assert change == "none" or wanted != changes["none"]
        names = {path.name for path in (unseen.HERE / "britain").glob("*.toml")}
        assert {path.name for path in folder.glob("*.toml")} == names
        for name in names - {"camera.toml"}:
            before, after = (tomllib.loads((f / name).read_text()) for f in (unseen.HERE / "britain", folder))
            assert after == unseen.merged(before, wanted) != before
            assert after["variations"]["count"] == 2 and after["render"]["spp"] == 1
            done = trove("generate", folder / name, "--dry-run")
            if "map" in own:
                # A map that comes with the change.
                assert done.returncode == 0, done.stderr
                continue
            assert (folder / after["map"]["osm"]).parent == folder / "../data/osm"
            assert after["place"] == before["place"]
            assert ".osm" in done.stderr and "expected one of" not in done.stderr, done.stderr
    both = unseen.merged({"a": 1, "b": {"c": 2, "d": 3}}, {"b": {"c": 4}, "e": {"f": 5}})
    assert both == {"a": 1, "b": {"c": 4, "d": 3}, "e": {"f": 5}}
