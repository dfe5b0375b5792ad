"""Drives of one's own: the example that converts them, what inspect says of them, and scenes from them."""

import json
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest
from conftest import trove
from trove.format import read_frame, read_manifest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def converted(tmp_path_factory):
    """The example's drive: three keyframes through a street in Karlsruhe, a car ahead and a person beside."""
    folder = tmp_path_factory.mktemp("plain")
    poses = ["time_s,x_m,y_m,z_m,yaw_rad"]
    boxes = ["time_s,track,kind,x_m,y_m,z_m,yaw_rad,length_m,width_m,height_m"]
    for i in range(3):
        time_s = f"1600000000.{500000 * i:06}" if i < 2 else "1600000001"
        poses.append(f"{time_s},{100 + 4 * i},{50 + i},0,0.245")
        boxes.append(f"{time_s},a,car,{118 + 5 * i},{54 + i},0.8,0.245,4.5,1.9,1.6")
        boxes.append(f"{time_s},b,adult,{112},{60},0.9,-1.2,0.6,0.7,1.75")
    (folder / "poses.csv").write_text("\n".join(poses))
    (folder / "boxes.csv").write_text("\n".join(boxes))
    command = [sys.executable, ROOT / "examples" / "convert_csv.py", folder / "poses.csv", folder / "boxes.csv"]
    command += ["--origin", "49.0094", "8.4044", "--out", folder / "drives" / "monday"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return folder / "drives"


def test_the_converted_drive_keeps_to_the_schema_and_inspect_tells_what_is_in_it(converted):
    drive = json.loads((converted / "monday" / "drive.json").read_text())
    jsonschema.validate(drive, json.loads((ROOT / "docs" / "schema" / "drive.schema.json").read_text()))
    done = trove("inspect", converted, "--json")
    assert done.returncode == 0, done.stderr
    [found] = json.loads(done.stdout)["drives"]
    assert (found["scene"], found["dataset"], found["keyframes"], found["tracks"]) == ("monday", "trove", 3, 2)
    assert found["boxes"] == {"car": 3, "human": 3}
    assert found["duration_s"] == pytest.approx(1.0)
    assert found["path_m"] == pytest.approx(2 * 17**0.5)


def test_inspect_tells_everything_that_is_wrong(converted, tmp_path):
    drive = json.loads((converted / "monday" / "drive.json").read_text())
    drive["keyframes"][1]["boxes"][0]["kind"] = "caar"
    drive["keyframes"][2]["boxes"][1]["sise_m"] = drive["keyframes"][2]["boxes"][1].pop("size_m")
    (tmp_path / "drive.json").write_text(json.dumps(drive, indent=1))
    done = trove("inspect", tmp_path)
    assert done.returncode == 1
    for expected in ["2 faults", 'did you mean "car"?', "did you mean `size_m`?", "keyframes[2].boxes[1]", "line "]:
        assert expected in done.stderr


def test_a_scene_is_generated_from_it_and_from_what_export_makes_of_it(converted, tmp_path):
    done = trove("export", converted, "--format", "trove", "--out", tmp_path / "exported")
    assert done.returncode == 0, done.stderr
    objects = {}
    for name, root in {"first": converted, "again": tmp_path / "exported"}.items():
        recipe = tmp_path / f"{name}.toml"
        recipe.write_text(
            f'[drive]\ndataset = "trove"\nroot = "{root}"\nkeyframes = [0]\n[render]\nscale = 0.1\nlight = false\n'
        )
        done = trove("generate", recipe, "--out", tmp_path / name)
        assert done.returncode == 0, done.stderr
        [frame] = read_manifest(tmp_path / name)["frames"]
        assert frame["path"] == "monday/v00/k000/ego.front"
        rows = read_frame(tmp_path / name / frame["path"])["objects"]
        objects[name] = [row for row in rows if row["origin"] == "recorded"]
        assert {(row["track_token"], row["kind"]) for row in objects[name]} == {("a", "car"), ("b", "adult")}
        assert all(row["visible_px"] > 0 for row in objects[name])
    for first, again in zip(objects["first"], objects["again"], strict=True):
        assert first["visible_box"] == again["visible_box"]
        for row, again_row in zip(first["world_from_body"], again["world_from_body"], strict=True):
            assert row == pytest.approx(again_row, abs=1e-3)
