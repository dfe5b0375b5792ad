"""Exports as torchvision's datasets; skipped where PyTorch is missing (`make test-train`)."""

import numpy as np
import pytest
from exports import exported, sources

datasets = pytest.importorskip("torchvision.datasets")


def test_cityscapes(finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "cityscapes")
    found = datasets.Cityscapes(str(out), split="train", mode="fine", target_type=["instance", "semantic", "polygon"])
    assert len(found) == len(sources(finished))
    for image, (instance, semantic, polygons) in found:
        ids, objects = np.array(semantic), np.array(instance)
        assert image.size == semantic.size == (polygons["imgWidth"], polygons["imgHeight"])
        assert (np.where(objects >= 1000, objects // 1000, objects) == ids).all()


def test_coco_for_transforms(finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "coco")
    plain = datasets.CocoDetection(str(out / "train"), str(out / "annotations/instances_train.json"))
    wrapped = datasets.wrap_dataset_for_transforms_v2(plain, target_keys=["boxes", "labels", "masks"])
    assert len(wrapped) == len(sources(finished))
    shown = 0
    for _, target in wrapped:
        for box, mask in zip(target.get("boxes", []), target.get("masks", [])):
            ys, xs = np.nonzero(mask.numpy())
            assert box.tolist() == [xs.min(), ys.min(), xs.max() + 1, ys.max() + 1]
            shown += 1
    assert shown > 5


def test_kitti(finished, tmp_path):
    exported(finished, tmp_path / "Kitti/raw", "kitti")
    found = datasets.Kitti(str(tmp_path), train=True, download=False)
    assert len(found) == len(sources(finished))
    kinds = {row["type"] for _, target in found for row in target}
    assert "Car" in kinds and all(len(row["bbox"]) == 4 for _, target in found for row in target)


def test_kitti_flow(finished, tmp_path):
    exported(finished, tmp_path / "KittiFlow", "kitti-flow")
    found = datasets.KittiFlow(str(tmp_path), split="train")
    firsts = [source for source in sources(finished) if source.table["keyframe"] == 1]
    assert len(found) == len(firsts)
    for (_, _, flow, valid), source in zip(found, firsts):
        expected = source.planes("flow_forward", "RG")
        assert np.abs(flow - expected.transpose(2, 0, 1))[:, valid].max() <= 1 / 128 + 1e-5
