"""`trove verify --labels`: our frames and what is exported from them have no fault, and damage is found."""

import json
import shutil

import numpy as np
import pytest
import trove as library
from conftest import trove
from exports import exported
from PIL import Image

# Checks that find something to look at in each export.
EXPORTS = {
    "cityscapes": {"files", "image", "classes", "outlines", "panoptic"},
    "coco": {"files", "ids", "classes", "masks", "keypoints"},
    "coco-panoptic": {"files", "panoptic"},
    "kitti": {"files", "camera", "classes", "masks", "boxes"},
    "nuscenes": {"files", "camera", "ids", "boxes", "tracks"},
}


def test_our_frames_have_no_fault(finished):
    found = library.verify_labels(finished)
    assert found["findings"] == [] and found["sound"] and found["form"] == "trove"
    # Outlines and panoptic labels are those of others; this run has no LiDAR.
    assert set(found["checks"]) >= {"flow", "flow-ends", "flow-returns", "occlusion", "views", "tracks", "surfaces"}
    assert all(tally["looked_at"] > 0 for tally in found["checks"].values())


@pytest.mark.parametrize("form", EXPORTS)
def test_what_is_exported_has_no_fault(finished, tmp_path, form):
    root = exported(finished, tmp_path / "out", form)[0]
    found = library.verify_labels(root)
    assert found["findings"] == [], found["findings"]
    assert found["form"] == form.split("-")[0] and found["frames"] > 0
    assert set(found["checks"]) >= EXPORTS[form]


def test_damage_is_found_told_and_shown(finished, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(finished, copy)
    frame = next(path for path in sorted(copy.glob("*/*/*/ego.CAM_FRONT")))
    labels = np.array(Image.open(frame / "class.png"))
    Image.fromarray(np.roll(labels, 3, axis=1)).save(frame / "class.png")
    (frame / "depth.exr").write_bytes((frame / "depth.exr").read_bytes()[:-100])
    done = trove("verify", copy, "--labels", "--out", tmp_path / "faults")
    assert done.returncode == 1 and "classes: " in done.stdout and "depth.exr" in done.stdout
    told = json.loads((tmp_path / "faults/audit.json").read_text())
    assert not told["sound"] and told["checks"]["classes"]["findings"] > 0 and told["checks"]["files"]["findings"] == 1
    shown = np.array(Image.open(next((tmp_path / "faults").glob("worst-*-classes.png"))))
    assert shown.shape[:2] == labels.shape and (shown == [255, 0, 255]).all(axis=-1).any()


def test_a_folder_of_no_form_and_an_output_inside_are_refused(finished, tmp_path):
    done = trove("verify", tmp_path, "--labels")
    assert done.returncode != 0 and "--form" in done.stderr
    done = trove("verify", finished, "--labels", "--out", finished / "faults")
    assert done.returncode != 0 and "outside of the dataset" in done.stderr
