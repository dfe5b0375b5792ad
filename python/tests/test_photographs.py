"""What recorded photographs tell of how a place looks; ours of another variation stand for them."""

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import trove
from PIL import Image


def measured(out):
    scene = json.loads((out / "report.json").read_text())["scenes"][0]
    return scene["measurements"], {entry["what"]: entry for entry in scene["entries"]}


def paints(out, variation):
    """sRGB paint of every recorded vehicle that is well seen."""
    tables = (json.loads(path.read_text()) for path in out.glob(f"*/{variation}/k002/*/frame.json"))
    rows = (row for table in tables for row in table["objects"] if row["visible_px"] > 300)
    return {
        row["id"]: np.array(row["paint"]) for row in rows if row["class"] in ("car", "jeep", "van") and row["paint"]
    }


def brightness(out):
    return np.mean([np.asarray(Image.open(path)).mean() for path in out.glob("*/v00/k002/*/rgb.png")])


@pytest.fixture(scope="module")
def photographed(recipe, tmp_path_factory):
    """A copy of the demo's dataset and a recipe; other paint, less light and less contrast are what was photographed."""
    folder = tmp_path_factory.mktemp("photographs")
    source = Path(recipe.read_text().split('root = "')[1].split('"')[0])
    root = folder / "nuscenes"
    for path in source.rglob("*"):
        if path.is_file():
            (root / path.relative_to(source)).parent.mkdir(parents=True, exist_ok=True)
            (root / path.relative_to(source)).write_bytes(path.read_bytes())
    text = recipe.read_text().replace(str(source), str(root)).replace("other_vehicles = 1\n", "")
    text = text.replace("keyframes = [1, 2]", "keyframes = [2]").replace("scale = 0.1", "scale = 0.2")
    other = folder / "other.toml"
    other.write_text(
        text.replace("seed = 3", "seed = 3\n[variations]\nfirst_as_recorded = false\ncount = 2")
        + "[camera]\ncompensation_ev = -0.7\ncontrast = 1.0\n"
    )
    done = trove("generate", other, "--out", folder / "other")
    assert done.returncode == 0, done.stderr
    tables = json.loads((root / "v1.0-demo" / "sample_data.json").read_text())
    files = {row["token"]: row["filename"] for row in tables}
    for name in ("CAM_FRONT", "CAM_BACK"):
        frame = next((folder / "other").glob(f"*/v01/k002/ego.{name}"))
        image = files[json.loads((frame / "frame.json").read_text())["source_token"]]
        (root / image).parent.mkdir(parents=True, exist_ok=True)
        Image.open(frame / "rgb.png").convert("RGB").save(root / image, quality=95)
    matched = folder / "matched.toml"
    matched.write_text(text.replace("[views]\n", "[views]\nmatch_photographs = true\n"))
    return folder, root, matched


def test_a_place_comes_to_look_like_its_photographs(photographed):
    folder, _, matched = photographed
    out = folder / "out"
    done = trove("generate", matched, "--out", out)
    assert done.returncode == 0, done.stderr
    found, _ = measured(out)
    assert found["photographs.matched"] == 2
    assert found["photographs.distance"] < 0.7 * found["photographs.distance_before"], found
    assert abs(found["photographs.contrast"] - 1.0) < 0.1, found

    plain = folder / "plain.toml"
    plain.write_text(matched.read_text().replace("match_photographs = true\n", ""))
    done = trove("generate", plain, "--out", folder / "plain")
    assert done.returncode == 0, done.stderr
    recorded = paints(folder / "other", "v01")
    before, after = paints(folder / "plain", "v00"), paints(out, "v00")
    assert before
    for i, paint in before.items():
        assert np.abs(after[i] - recorded[i]).sum() < 0.95 * np.abs(paint - recorded[i]).sum(), (i, paint, after[i])
    assert brightness(out) < 0.95 * brightness(folder / "plain")

    again = folder / "again"
    done = trove("generate", matched, "--out", again, "--threads", 1)
    assert done.returncode == 0, done.stderr
    for path in out.rglob("rgb.png"):
        assert path.read_bytes() == (again / path.relative_to(out)).read_bytes()


def test_photographs_that_are_not_there_or_damaged_are_reported_and_belong_to_the_run(photographed):
    folder, root, matched = photographed
    pictures = sorted(root.rglob("*.jpg"))
    whole = pictures[0].read_bytes()
    done = trove("generate", matched, "--out", folder / "out")
    assert done.returncode == 0, done.stderr
    try:
        pictures[0].write_bytes(whole[:100])
        done = trove("generate", matched, "--out", folder / "damaged")
        assert done.returncode == 0, done.stderr
        found, entries = measured(folder / "damaged")
        assert found["photographs.matched"] == 1
        assert pictures[0].name in entries["photograph that cannot be read"]["examples"][0]
        Image.new("RGB", (300, 300)).save(pictures[0])
        done = trove("generate", matched, "--out", folder / "square")
        assert "photograph that has not the shape of its camera's pictures" in measured(folder / "square")[1]
        # More of a run that began with other photographs.
        more = folder / "more.toml"
        more.write_text(matched.read_text().replace("keyframes = [2]", "keyframes = [1, 2]"))
        other = trove("generate", more, "--out", folder / "damaged")
        assert other.returncode == 1 and "recorded files have changed" in other.stderr, other.stderr
        for path in pictures:
            path.unlink()
        done = trove("generate", matched, "--out", folder / "none")
        assert done.returncode == 0, done.stderr
        assert "no recorded photographs that could be matched" in measured(folder / "none")[1]
    finally:
        pictures[0].write_bytes(whole)
