"""Opens what `trove export --format nuscenes` wrote, with the code of nuscenes-devkit.

    python -m venv .venv-devkit && .venv-devkit/bin/pip install -r tests/devkit/requirements.txt
    .venv-devkit/bin/python tests/devkit/check_nuscenes.py EXPORTED --frames OUT

OUT is the folder that was exported. All tables load and all tokens lead somewhere; every camera's boxes, as the devkit
projects them, are those that frame.json tells, and lie around the pixels that show their objects; and nuScenes' own
evaluation gives the boxes, judged against themselves, a mean average precision and a detection score of 1 over the
classes that there are. Where there are LiDAR sweeps, their points load with their labels, which agree with the boxes.

The exit status is 1 where a check fails.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

import numpy as np
from nuscenes.eval.common.config import config_factory
from nuscenes.eval.detection.evaluate import DetectionEval
from nuscenes.eval.detection.utils import category_to_detection_name
from nuscenes.nuscenes import NuScenes
from nuscenes.utils.data_classes import LidarPointCloud, RadarPointCloud
from nuscenes.utils.data_io import load_bin_file
from nuscenes.utils.geometry_utils import BoxVisibility, box_in_image, points_in_box, view_points
from PIL import Image

VERSION = "v1.0-trove"
CORNER_PX = 0.01
# A model may stick out of its box a little, and labels are whole pixels.
MARGIN_PX = 2.0
# A walker's stride is longer than the box that annotators draw around the body, metres on either side.
STRIDE_M = 0.25


def check_tokens(dataset):
    """Every token in every table leads to a row, and lists of rows that follow each other are whole."""
    for name in dataset.table_names:
        for row in getattr(dataset, name):
            for key, value in row.items():
                if value and key in ("prev", "next"):
                    dataset.get(name, value)
                elif key.endswith("_token"):
                    table = key.removesuffix("_token").removeprefix("first_").removeprefix("last_")
                    dataset.get("sample_annotation" if table == "annotation" else table, value)
            if row.get("next"):
                assert dataset.get(name, row["next"])["prev"] == row["token"], (name, row)
    for scene in dataset.scene:
        token, samples = scene["first_sample_token"], 0
        while token:
            sample = dataset.get("sample", token)
            assert "LIDAR_TOP" in sample["data"] and len(sample["data"]) > 1, sample
            token, samples, last = sample["next"], samples + 1, token
        assert (samples, last) == (scene["nbr_samples"], scene["last_sample_token"]), scene


def frames_by_picture(folder):
    """Folders of frames by the bytes of their pictures, which an export does not change."""
    return {path.read_bytes(): path.parent for path in folder.glob("*/v*/k*/*/rgb.png")}


def check_boxes(dataset, frames):
    """Compares every camera's boxes with frame.json; returns how many."""
    checked = 0
    for data in dataset.sample_data:
        if data["sensor_modality"] != "camera":
            continue
        path, boxes, intrinsic = dataset.get_sample_data(data["token"], box_vis_level=BoxVisibility.NONE)
        folder = frames[Path(path).read_bytes()]
        table = json.loads((folder / "frame.json").read_text())
        assert Image.open(path).size == (data["width"], data["height"]) == (table["width_px"], table["height_px"])
        assert data["timestamp"] == table["time_ns"] // 1000
        by_place = {}
        camera_from_world = np.linalg.inv(table["world_from_camera"])
        for row in table["objects"]:
            centre = (camera_from_world @ np.array(row["world_from_body"])[:, 3])[:3]
            by_place[tuple(np.round(centre, 3))] = row
        for box in boxes:
            row = by_place.get(tuple(np.round(box.center, 3)))
            if row is None:
                # In another view of the moment only.
                assert not box_in_image(box, intrinsic, (data["width"], data["height"]), BoxVisibility.ALL), box
                continue
            length, width, height = row["size_m"]
            assert np.allclose(box.wlh, [width, length, height])
            signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
            corners = np.column_stack([signs * np.array(row["size_m"]) / 2, np.ones(8)])
            camera = (camera_from_world @ np.array(row["world_from_body"]) @ corners.T)[:3]
            if camera[2].min() < 0.5:
                continue
            expected = view_points(camera, np.array(table["intrinsics"]), normalize=True)[:2]
            found = view_points(box.corners(), intrinsic, normalize=True)[:2]
            apart = np.abs(expected[:, :, None] - found[:, None, :]).max(0).min(1)
            assert apart.max() < CORNER_PX, (folder, row["id"], apart.max())
            if row["amodal_box"] and row["truncation"] == 0:
                low, high = np.array(row["amodal_box"][:2]), np.array(row["amodal_box"][2:]) + 1
                stride_px = STRIDE_M * table["intrinsics"][0][0] / row["range_m"] if row["class"] == "human" else 0
                margin_px = MARGIN_PX + stride_px
                assert (found.min(1) <= low + margin_px).all() and (found.max(1) >= high - margin_px).all(), row
                checked += 1
    return checked


def check_lidar(dataset):
    """Points, their labels and the boxes around them agree; returns how many points there are."""
    checked = 0
    for row in getattr(dataset, "lidarseg", []):
        path, boxes, _ = dataset.get_sample_data(row["sample_data_token"])
        points = LidarPointCloud.from_file(path).points[:3]
        labels = load_bin_file(str(Path(dataset.dataroot) / row["filename"]))
        things = dataset.get("panoptic", row["token"])["filename"]
        things = load_bin_file(str(Path(dataset.dataroot) / things), type="panoptic")
        assert len(labels) == len(things) == points.shape[1], row
        assert (things // 1000 == labels).all(), row
        for box in boxes:
            category = dataset.lidarseg_name2idx_mapping[box.name]
            # What moves was elsewhere at the beginning of the sweep.
            inside = points_in_box(box, points, wlh_factor=1.5)
            found = (labels[inside] == category).sum()
            expected = dataset.get("sample_annotation", box.token)["num_lidar_pts"]
            assert found >= 0.8 * expected - 2, (box, found, expected)
        checked += len(labels)
    return checked


def check_radar(dataset):
    """The devkit reads every radar's file, and objects' rows count its detections; returns how many there are."""
    checked = 0
    RadarPointCloud.disable_filters()
    for data in dataset.sample_data:
        if data["sensor_modality"] != "radar":
            continue
        points = RadarPointCloud.from_file(str(Path(dataset.dataroot) / data["filename"])).points
        x, y, z, *_, vx_comp, vy_comp = points[[0, 1, 2, 6, 7, 8, 9]]
        assert (z == 0).all() and (x > 0).all(), data
        # Along the line of sight.
        assert np.allclose(x * vy_comp, y * vx_comp, atol=0.01 * (1 + np.hypot(x, y).max(initial=0))), data
        checked += points.shape[1]
    assert sum(row["num_radar_pts"] for row in dataset.sample_annotation) <= checked
    RadarPointCloud.default_filters()
    return checked


def detections(dataset):
    """The annotations as a detector would hand them in."""
    results = {}
    for sample in dataset.sample:
        boxes = []
        for token in sample["anns"]:
            annotation = dataset.get("sample_annotation", token)
            name = category_to_detection_name(annotation["category_name"])
            # The devkit judges what LiDAR or radar has met.
            if name is None or annotation["num_lidar_pts"] + annotation["num_radar_pts"] == 0:
                continue
            velocity = dataset.box_velocity(token)[:2]
            attributes = [dataset.get("attribute", token)["name"] for token in annotation["attribute_tokens"]]
            boxes.append(
                {
                    "sample_token": sample["token"],
                    "translation": annotation["translation"],
                    "size": annotation["size"],
                    "rotation": annotation["rotation"],
                    "velocity": [0.0 if np.isnan(v) else float(v) for v in velocity],
                    "detection_name": name,
                    "detection_score": 1.0,
                    "attribute_name": "".join(attributes),
                }
            )
        results[sample["token"]] = boxes
    meta = {f"use_{sensor}": sensor == "camera" for sensor in ("camera", "lidar", "radar", "map", "external")}
    return {"meta": meta, "results": results}


def check_evaluation(dataset, split):
    """nuScenes' evaluation of the boxes against themselves; returns the classes that there are."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "results.json"
        path.write_text(json.dumps(detections(dataset)))
        config = config_factory("detection_cvpr_2019")
        judge = DetectionEval(dataset, config, str(path), split, folder, verbose=False)
        present = {box.detection_name for box in judge.gt_boxes.all}
        # Of classes that are not there nuScenes takes an AP of 0 and errors of 1.
        judge.cfg.class_names = sorted(present)
        metrics, _ = judge.evaluate()
    print(f"{split}: mAP {metrics.mean_ap:.4f}, NDS {metrics.nd_score:.4f}")
    assert metrics.mean_ap > 0.9999 and metrics.nd_score > 0.9999, metrics.serialize()
    return present


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("exported", type=Path, help="folder that `trove export --format nuscenes` wrote")
    parser.add_argument("--frames", type=Path, required=True, help="folder that was exported")
    options = parser.parse_args()
    dataset = NuScenes(VERSION, str(options.exported), verbose=False)
    dataset.list_scenes()
    check_tokens(dataset)
    checked = check_boxes(dataset, frames_by_picture(options.frames))
    points, echoes = check_lidar(dataset), check_radar(dataset)
    splits = json.loads((options.exported / VERSION / "splits.json").read_text())
    present = set.union(*(check_evaluation(dataset, split) for split in splits))
    print(f"{len(dataset.scene)} scenes, {len(dataset.sample_annotation)} boxes, {checked} of them held to pixels")
    print(f"{points} LiDAR points with their labels, {echoes} radar detections")
    print(f"classes judged: {', '.join(sorted(present))}")
    if not checked or not present:
        sys.exit(f"{options.exported}: expected boxes in view, found none")


if __name__ == "__main__":
    main()
