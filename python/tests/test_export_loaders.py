"""Exports as the datasets of ultralytics and mmsegmentation; skipped where those are missing (`make test-loaders`)."""

import json
import sys
import types
from pathlib import Path

import numpy as np
import pytest
from exports import exported, sources
from PIL import Image, ImageDraw


@pytest.fixture(scope="module")
def ultralytics(tmp_path_factory):
    """Its way from data.yaml to samples; settings stay out of the user's home."""
    patch = pytest.MonkeyPatch()
    patch.setenv("YOLO_CONFIG_DIR", str(tmp_path_factory.mktemp("ultralytics")))
    patch.setenv("YOLO_OFFLINE", "true")
    pytest.importorskip("ultralytics")
    from ultralytics.data import YOLODataset
    from ultralytics.data.utils import check_det_dataset

    def samples(out, task):
        data = check_det_dataset(str(out / "data.yaml"), autodownload=False)
        dataset = YOLODataset(data["train"], data=data, task=task, augment=False, rect=False, imgsz=640)
        return data["names"], dataset.get_labels()

    yield samples
    patch.undo()


@pytest.fixture(scope="module")
def segmentation():
    """mmsegmentation's datasets, without the compiled kernels of mmcv, which loading does not use."""
    pytest.importorskip("mmseg")
    kernels = types.ModuleType("mmcv.ops")

    def absent(name):
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *_, **__: pytest.fail(f"mmcv.ops.{name} is used")

    kernels.__getattr__ = absent
    patch = pytest.MonkeyPatch()
    patch.setitem(sys.modules, "mmcv.ops", kernels)
    import mmseg.datasets

    yield mmseg.datasets
    patch.undo()


PIPELINE = [{"type": "LoadImageFromFile"}, {"type": "mmseg.LoadAnnotations"}]


def test_ultralytics_boxes(ultralytics, finished, tmp_path, capfd):
    out, _ = exported(finished, tmp_path / "out", "yolo")
    names, rows = ultralytics(out, "detect")
    frames = {"_".join(frame.folder.parts[-4:]): frame for frame in sources(finished)}
    assert len(rows) == len(frames)
    cars = 0
    for row in rows:
        frame = frames[Path(row["im_file"]).stem]
        height, width = row["shape"]
        assert (width, height) == Image.open(row["im_file"]).size
        shown = [user["visible_box"] for user in frame.users if user["visible_box"] is not None]
        for name, (x, y, wide, high) in zip(row["cls"][:, 0], row["bboxes"] * [width, height, width, height]):
            around = np.array([x - wide / 2, y - high / 2, x + wide / 2 - 1, y + high / 2 - 1])
            if names[int(name)] == "car":
                assert any(np.abs(around - box).max() < 0.01 for box in shown)
                cars += 1
    assert cars > 5
    assert "WARNING" not in "".join(capfd.readouterr())


def test_ultralytics_outlines(ultralytics, finished, tmp_path, capfd):
    out, _ = exported(finished, tmp_path / "out", "yolo-seg")
    _, rows = ultralytics(out, "segment")
    shares = []
    for row in rows:
        size = Image.open(row["im_file"]).size
        assert all(len(outline) >= 3 for outline in row["segments"])
        painted = Image.new("L", size)
        for outline in row["segments"]:
            ImageDraw.Draw(painted).polygon([tuple(point) for point in outline * size], fill=255)
        shares.append((np.array(painted) > 0).mean())
    assert max(shares) > 0.01
    assert "WARNING" not in "".join(capfd.readouterr())


def test_mmsegmentation_cityscapes(segmentation, finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "cityscapes")
    folders = {"img_path": "leftImg8bit/train", "seg_map_path": "gtFine/train"}
    dataset = segmentation.CityscapesDataset(data_root=str(out), data_prefix=folders, pipeline=PIPELINE)
    assert len(dataset) == len(sources(finished))
    for sample in dataset:
        ids = set(np.unique(sample["gt_seg_map"]).tolist())
        assert sample["img"].shape[:2] == sample["gt_seg_map"].shape
        assert ids <= {*range(19), 255} and len(ids) > 3


def test_mmsegmentation(segmentation, finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "mmseg")
    metainfo = json.loads((out / "metainfo.json").read_text())
    folders = {"img_path": "img_dir/train", "seg_map_path": "ann_dir/train"}
    dataset = segmentation.BaseSegDataset(
        data_root=str(out), data_prefix=folders, pipeline=PIPELINE, metainfo=metainfo, img_suffix=".png"
    )
    assert len(dataset) == len(sources(finished))
    assert len(metainfo["classes"]) == len(metainfo["palette"])
    for sample in dataset:
        image = np.array(Image.open(sample["img_path"]))[..., ::-1]
        assert (sample["img"] == image).all()
        assert set(np.unique(sample["gt_seg_map"]).tolist()) <= {*range(len(metainfo["classes"])), 255}
