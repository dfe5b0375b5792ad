"""Exports as datumaro reads them; skipped where that is missing (`make test-loaders`)."""

import json
import logging

import numpy as np
import pytest
from exports import exported, sources

datumaro = pytest.importorskip("datumaro")


@pytest.fixture(autouse=True)
def no_warnings(caplog):
    """What datumaro has to say goes to the log."""
    yield
    assert [row.message for row in caplog.get_records("call") if row.levelno >= logging.WARNING] == []


def test_panoptic_segments_are_the_objects_and_stuff_of_the_labels(finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "coco-panoptic")
    # Where it looks for them.
    (out / "images").symlink_to(".")
    dataset = datumaro.Dataset.import_from(str(out), "coco_panoptic")
    frames = sources(finished)
    assert len(dataset) == len(frames)
    names = dataset.categories()[datumaro.AnnotationType.label]
    panoptic = json.loads((out / "annotations" / "panoptic_train.json").read_text())
    countable = {row["name"] for row in panoptic["categories"] if row["isthing"]}
    seen = 0
    for item, frame in zip(sorted(dataset, key=lambda item: item.attributes["id"]), frames, strict=True):
        instances = frame.picture("instance")
        masks = [(names[segment.label].name, segment.image.astype(bool)) for segment in item.annotations]
        things = [mask for name, mask in masks if name in countable]
        assert sum(mask.astype(int) for _, mask in masks).max() == 1
        assert all(len(np.unique(instances[mask])) == 1 for mask in things)
        for user in frame.users:
            shown = instances == user["id"]
            if user["class"] in ("car", "jeep", "van", "bus", "truck", "human") and shown.any():
                assert sum(np.array_equal(mask, shown) for mask in things) == 1, user
                seen += 1
    assert seen > 20


def test_people_and_points(finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "coco")
    (out / "images").symlink_to(".")
    (out / "annotations" / "instances_train.json").unlink()
    dataset = datumaro.Dataset.import_from(str(out), "coco_person_keypoints")
    points = [a for item in dataset for a in item.annotations if a.type == datumaro.AnnotationType.points]
    assert len(points) > 0
    for person in points:
        assert len(person.points) == 2 * len(person.visibility) == 34


def test_kitti_boxes_are_those_of_the_frames(finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "kitti")
    dataset = datumaro.Dataset.import_from(str(out), "kitti_detection")
    frames = sources(finished)
    assert len(dataset) == len(frames)
    names = dataset.categories()[datumaro.AnnotationType.label]
    cars = 0
    for item, frame in zip(sorted(dataset, key=lambda item: item.id), frames, strict=True):
        amodal = [user["amodal_box"] for user in frame.users if user["amodal_box"] is not None]
        for box in item.annotations:
            if names[box.label].name == "Car":
                found = np.array([box.x, box.y, box.x + box.w, box.y + box.h])
                assert any(np.abs(found - other).max() < 1.01 for other in amodal)
                cars += 1
    assert cars > 5
