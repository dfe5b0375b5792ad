"""Holds what is written, and the types that read it, to the schemas."""

import json
from pathlib import Path
from typing import get_type_hints

import jsonschema
import pytest
from conftest import trove
from trove import format as form

SCHEMAS = Path(__file__).parents[2] / "docs" / "schema"


def schema(name):
    return json.loads((SCHEMAS / f"{name}.schema.json").read_text())


def test_every_file_is_as_its_schema_says(finished, tmp_path):
    chosen = tmp_path / "curated.json"
    done = trove("curate", finished, "--min-classes", 2, "--out", chosen, "--page", tmp_path / "curated.html")
    assert done.returncode == 0, done.stderr
    found = {
        "manifest": [finished / "manifest.json"],
        "report": [finished / "report.json"],
        "site": sorted(finished.glob("*/v*/site.json")),
        "lanes": sorted(finished.glob("*/v*/lanes.json")),
        "trajectory": sorted(finished.glob("*/v*/trajectory.json")),
        "frame": sorted(finished.glob("*/v*/k*/*/frame.json")),
        "run": [finished / ".trove" / "run.json"],
        "curated": [chosen],
    }
    # The frames' journal is looked at below, masks in test_library.py, sweeps in test_lidar.py, radars' cycles in
    # test_radar.py, grids in test_grids.py, and what people write as a drive in test_plain_drive.py.
    assert set(found) | {"frames", "drive", "masks", "sweep", "radar", "grid"} == {
        path.name.split(".")[0] for path in SCHEMAS.iterdir()
    }
    for name, paths in found.items():
        validator = jsonschema.Draft202012Validator(schema(name))
        assert paths, name
        for path in paths:
            validator.validate(json.loads(path.read_text()))
    lines = [json.loads(line) for line in (finished / ".trove" / "frames.jsonl").read_text().splitlines() if line]
    assert sum("frame" in line for line in lines) == len(found["frame"])
    for line in lines:
        jsonschema.validate(line, schema("frames"))


@pytest.mark.parametrize(
    ("described", "typed"),
    [
        (schema("manifest"), form.Manifest),
        (schema("manifest")["$defs"]["FrameRow"], form.FrameRow),
        (schema("frame"), form.FrameTable),
        (schema("frame")["$defs"]["ObjectRow"], form.ObjectRow),
        (schema("grid"), form.GridTable),
        (schema("grid")["$defs"]["GridClass"], form.GridClass),
        (schema("grid")["$defs"]["GridObject"], form.GridObject),
        (schema("lanes"), form.LanesTable),
        (schema("lanes")["$defs"]["LaneRow"], form.LaneRow),
        (schema("lanes")["$defs"]["LineRow"], form.LineRow),
        (schema("lanes")["$defs"]["KerbRow"], form.KerbRow),
        (schema("trajectory"), form.TrajectoryTable),
        (schema("trajectory")["$defs"]["EgoMoment"], form.EgoMoment),
        (schema("trajectory")["$defs"]["EgoPose"], form.EgoPose),
        (schema("sweep"), form.SweepTable),
        (schema("radar"), form.RadarTable),
        (schema("sweep")["$defs"]["SweptObject"], form.SweptObject),
    ],
)
def test_the_types_have_the_fields_of_the_schemas(described, typed):
    assert sorted(get_type_hints(typed)) == sorted(described["required"])


def test_another_version_and_a_damaged_file_are_told(tmp_path):
    (tmp_path / "manifest.json").write_text('{"format": 1, "frames": []}')
    with pytest.raises(ValueError, match=r"manifest\.json: expected format 2, found 1"):
        form.read_manifest(tmp_path)
    (tmp_path / "frame.json").write_text('{"scene":')
    with pytest.raises(ValueError, match=r"frame\.json: expected JSON"):
        form.read_frame(tmp_path)
