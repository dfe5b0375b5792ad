"""A run in Rerun's form, read back by Rerun's own reader; skipped where it is missing (`make test-rerun`)."""

import numpy as np
import pytest
import trove as package
from conftest import trove

pytest.importorskip("rerun")

from rerun.chunk import RrdReader
from trove import rerun as bridge

SENSORS = """
[sensors.LIDAR_TOP]
kind = "lidar"
preset = "vlp-16"
[sensors.RADAR_FRONT]
kind = "radar"
preset = "ars408"
position_m = [3.4, 0.0, 0.5]
"""


@pytest.fixture(scope="module")
def run(recipe):
    path = recipe.parent / "rerun.toml"
    path.write_text(recipe.read_text() + SENSORS)
    out = recipe.parent / "rerun"
    done = trove("generate", path, "--out", out)
    assert done.returncode == 0, done.stderr
    return out


def logged(path):
    """What a file has of each entity's components: rows with the keyframe, `None` where it always holds."""
    found = {}
    for chunk in RrdReader(path).stream().to_chunks():
        batch = chunk.to_record_batch().to_pydict()
        keyframes = batch.get("keyframe") or [None] * len(batch["rerun.controls.RowId"])
        for name, rows in batch.items():
            if ":" in name:
                found.setdefault((chunk.entity_path, name), {}).update(zip(keyframes, rows))
    return found


def test_rerun_reads_back_what_the_frames_hold(run, tmp_path):
    assert bridge.main([str(run), "--save", str(tmp_path), "--images", "rgb,class,instance,depth,normal"]) == 0
    (path,) = tmp_path.iterdir()
    assert path.name == "demo-0001-v00.rrd"
    of, frames = logged(path), package.open(run)
    for frame in frames:
        keyframe, entity = frame.table["keyframe"], f"/world/{frame.table['view']}"

        def value(component, below="", keyframe=keyframe, entity=entity):
            return of[entity + below, component][keyframe]

        assert bytes(value("EncodedImage:blob", "/rgb")[0]) == (frame.path / "rgb.png").read_bytes()
        assert bytes(value("SegmentationImage:buffer", "/class")[0]) == frame.class_.tobytes()
        assert bytes(value("SegmentationImage:buffer", "/instance")[0]) == frame.instance.tobytes()
        depth = np.frombuffer(bytes(value("DepthImage:buffer", "/depth")[0]), np.float32).reshape(frame.depth_m.shape)
        sky = np.isinf(frame.depth_m)
        assert np.array_equal(depth[~sky], frame.depth_m[~sky]) and (depth[sky] == 0).all() and sky.any()
        assert value("EncodedImage:media_type", "/normal") == ["image/png"]
        pose = frame.camera.world_from_camera
        assert np.allclose(value("Transform3D:translation")[0], pose[:3, 3], atol=1e-5)
        # Rerun's matrices are column by column.
        assert np.allclose(np.reshape(value("Transform3D:mat3x3")[0], (3, 3)).T, pose[:3, :3], atol=1e-6)
        k = np.reshape(value("Pinhole:image_from_camera")[0], (3, 3)).T
        assert np.allclose(k, frame.camera.intrinsics, rtol=1e-6)
        seen = [thing for thing in frame.objects if thing.visible_box is not None]
        assert value("Boxes2D:class_ids", "/boxes") == [thing.class_id for thing in seen]
        halves = [((r - x + 1) / 2, (b - y + 1) / 2) for x, y, r, b in (thing.visible_box for thing in seen)]
        assert np.allclose(value("Boxes2D:half_sizes", "/boxes"), halves)
        boxes = dict(
            zip(of["/world/objects", "Boxes3D:labels"][keyframe], of["/world/objects", "Boxes3D:half_sizes"][keyframe])
        )
        for thing in frame.objects:
            if thing.origin != "scenery":
                assert np.allclose(boxes[f"{thing.class_} {thing.id}"], np.array(thing.size_m) / 2, atol=1e-5)
    way = frames.trajectory("demo-0001").world_from_ego
    for chunk in RrdReader(path).stream().to_chunks():
        if chunk.entity_path == "/world/ego":
            rows = chunk.to_record_batch().to_pydict()
            for keyframe, (at,) in zip(rows["keyframe"], rows["Transform3D:translation"]):
                assert np.allclose(at, way[keyframe, :3, 3], atol=1e-4), "the recording vehicle, not another one"
    assert len(of["/world/objects", "Boxes3D:labels"]) == 2, "both keyframes have their own boxes"
    for kind in (frames.sweeps, frames.radars):
        for looked in kind:
            points = of[f"/world/{looked.table['view']}", "Points3D:positions"][looked.table["keyframe"]]
            assert np.allclose(points, looked.xyz, atol=1e-4) and len(points) > 5
    ((context,),) = of["/world/objects", "AnnotationContext:context"].values()
    names = {row["class_id"]: row["class_description"]["info"]["label"] for row in context}
    assert names == frames.classes


def test_what_is_not_there_is_told(run, tmp_path, capsys):
    assert bridge.main([str(run), "--save", str(tmp_path), "--scene", "elsewhere"]) == 1
    assert "expected one of demo-0001, found elsewhere" in capsys.readouterr().err
    assert bridge.main([str(run), "--save", str(tmp_path), "--images", "rgb,heat"]) == 1
    assert "found heat" in capsys.readouterr().err
    assert bridge.main([str(tmp_path / "none"), "--save", str(tmp_path)]) == 1
    assert not list(tmp_path.iterdir())
