"""Opens everything that `trove generate` wrote with other people's loaders and checks it against the contract.

As a program: `check_output.py DIR`; it prints what it looked at and fails on the first thing that is wrong.
"""

import hashlib
import json
import sys
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image
from trove.format import read_frame, read_manifest

LABELS = [
    "class.png",
    "instance.png",
    "depth.exr",
    "normal.exr",
    "flow_forward.exr",
    "flow_backward.exr",
    "occluded_forward.png",
    "occluded_backward.png",
    "frame.json",
]
SKY, CLASSES = 1, 20


def exr(path):
    """The channels of an EXR file as a float32 array, height × width (× channels where there are several)."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = {name: channel.pixels for name, channel in file.channels().items()}
    order = [name for name in ("R", "G", "B", "Y") if name in channels]
    assert len(order) == len(channels), f"{path}: unexpected channels {sorted(channels)}"
    planes = [channels[name] for name in order]
    assert all(plane.dtype == np.float32 for plane in planes), f"{path}: expected 32-bit float"
    return planes[0] if len(planes) == 1 else np.stack(planes, axis=-1)


def pixel_box(mask):
    """[x0, y0, x1, y1] of the true pixels, both ends included; None where there are none."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return [int(columns[0]), int(rows[0]), int(columns[-1]), int(rows[-1])] if len(rows) else None


def check_frame(folder, hashes):
    """Checks one frame's files, their hashes and what they say of each other; returns frame.json."""
    assert sorted(hashes) == sorted(p.name for p in folder.iterdir()), f"{folder}: files that the manifest lacks"
    assert set(LABELS) <= set(hashes), f"{folder}: {sorted(set(LABELS) - set(hashes))} missing"
    for name, expected in hashes.items():
        assert hashlib.sha256((folder / name).read_bytes()).hexdigest() == expected, f"{folder / name}: hash differs"

    frame = read_frame(folder)
    shape = (frame["height_px"], frame["width_px"])
    classes = np.asarray(Image.open(folder / "class.png"))
    instances = np.asarray(Image.open(folder / "instance.png"))
    assert classes.shape == shape and classes.dtype == np.uint8 and classes.max() < CLASSES
    assert instances.shape == shape and instances.dtype in (np.uint16, np.int32)
    if "rgb.png" in hashes:
        rgb = np.asarray(Image.open(folder / "rgb.png"))
        assert rgb.shape == (*shape, 3) and rgb.dtype == np.uint8 and rgb.std() > 5, f"{folder}: a flat picture"

    if "radiance.exr" in hashes:
        radiance = exr(folder / "radiance.exr")
        assert radiance.shape == (*shape, 3) and np.isfinite(radiance).all() and (radiance >= 0).all()
        brightness = (radiance * 2 ** frame["exposure_ev"]).mean(axis=-1)
        assert np.corrcoef(brightness.ravel(), rgb.mean(axis=-1).ravel())[0, 1] > 0.5, f"{folder}: another picture"

    depth, normal = exr(folder / "depth.exr"), exr(folder / "normal.exr")
    sky = classes == SKY
    assert depth.shape == shape and np.array_equal(np.isinf(depth), sky) and (depth > 0).all()
    assert normal.shape == (*shape, 3) and (normal[sky] == 0).all()
    assert np.abs(np.linalg.norm(normal[~sky], axis=-1) - 1).max(initial=0) < 1e-5, f"{folder}: normals are not unit"
    for way in ("forward", "backward"):
        flow, occluded = exr(folder / f"flow_{way}.exr"), np.asarray(Image.open(folder / f"occluded_{way}.png"))
        assert flow.shape == (*shape, 2)
        assert np.array_equal(np.isnan(flow[..., 0]), np.isnan(flow[..., 1]))
        assert occluded.shape == shape and set(np.unique(occluded)) <= {0, 128, 255}
        assert np.array_equal(occluded == 128, np.isnan(flow[..., 0]))
        x, y = flow[..., 0] + np.arange(shape[1]) + 0.5, flow[..., 1] + np.arange(shape[0])[:, None] + 0.5
        # Rounding may take a point across the picture's edge.
        outside = (x < -1e-3) | (y < -1e-3) | (x > shape[1] + 1e-3) | (y > shape[0] + 1e-3)
        assert (occluded[outside] == 255).all()

    check_extra(folder, hashes, frame, classes, instances, depth, normal)

    rows = {row["id"]: row for row in frame["objects"]}
    assert len(rows) == len(frame["objects"]), f"{folder}: an id twice"
    assert set(np.unique(instances)) - {0} <= set(rows), f"{folder}: pixels of an object without a row"
    for number, row in rows.items():
        mask = instances == number
        assert mask.sum() == row["visible_px"] <= row["amodal_px"], f"{folder}: object {number}"
        assert pixel_box(mask) == row["visible_box"], f"{folder}: object {number}"
        assert (classes[mask] == row["class_id"]).all(), f"{folder}: object {number}"
        assert 0 <= row["truncation"] <= 1 and 0 <= row["occlusion"] <= 1
        camera, middle = (np.array(m)[:3, 3] for m in (frame["world_from_camera"], row["world_from_body"]))
        assert abs(np.linalg.norm(middle - camera) - row["range_m"]) < 0.01, f"{folder}: object {number}"
    return frame


def check_extra(folder, names, frame, classes, instances, depth, normal):
    """Checks the files that a recipe has to name against those that every frame has."""
    shape, sky = classes.shape, classes == SKY
    if "panoptic.png" in names:
        # COCO's ids.
        red, green, blue = np.moveaxis(np.asarray(Image.open(folder / "panoptic.png")).astype(np.uint32), -1, 0)
        assert np.array_equal(red + 256 * green + 65536 * blue, 65536 * classes.astype(np.uint32) + instances)
    world_from_camera = np.array(frame["world_from_camera"])[:3, :3]
    if "range.exr" in names:
        distance = exr(folder / "range.exr")
        assert distance.shape == shape and np.array_equal(np.isinf(distance), sky)
        assert (distance[~sky] >= np.abs(depth[~sky]) * (1 - 1e-6)).all(), f"{folder}: nearer than its depth"
    if "normal_world.exr" in names:
        turned = normal @ world_from_camera.T
        assert np.abs(exr(folder / "normal_world.exr") - turned).max() < 1e-5, f"{folder}: not the same normals"
    for name, channels in (("albedo", 3), ("roughness", 1)):
        if f"{name}.exr" in names:
            values = exr(folder / f"{name}.exr").reshape(*shape, channels)
            assert np.array_equal(np.isnan(values[..., 0]), sky) and np.nanmin(values) >= 0 and np.nanmax(values) <= 1
    for way in ("forward", "backward"):
        if f"scene_flow_{way}.exr" in names:
            flow, pixels = exr(folder / f"scene_flow_{way}.exr"), exr(folder / f"flow_{way}.exr")
            assert flow.shape == (*shape, 3) and np.isnan(flow[sky]).all()
            # Flow can be undefined where the point is behind the other camera.
            assert not np.isnan(flow[..., 0][~sky & ~np.isnan(pixels[..., 0])]).any()
    if "object_coordinates.exr" in names:
        inside = exr(folder / "object_coordinates.exr")
        assert np.array_equal(np.isnan(inside[..., 0]), instances == 0)
        axes = np.linalg.inv(frame["intrinsics"]) if frame["lens_model"] == "pinhole" else None
        for row in frame["objects"] if axes is not None else []:
            y, x = np.nonzero(instances == row["id"])
            body = (inside[y, x] - 0.5) * row["size_m"]
            world = np.column_stack([body, np.ones(len(body))]) @ np.array(row["world_from_body"])[:3].T
            seen = np.column_stack([x + 0.5, y + 0.5, np.ones(len(x))]) @ axes.T * depth[y, x, None]
            seen = seen @ world_from_camera.T + np.array(frame["world_from_camera"])[:3, 3]
            off = np.linalg.norm(world - seen, axis=1)
            assert off.max(initial=0) < 1e-3 + 1e-5 * depth[y, x].max(initial=0), f"{folder}: object {row['id']}"
    if "coverage.png" in names:
        coverage = np.asarray(Image.open(folder / "coverage.png"))
        assert coverage.shape == shape and coverage.dtype == np.uint8 and coverage.mean() > 128


def check(root):
    """Checks a whole output folder and returns the frames' tables by their path."""
    root = Path(root)
    manifest = read_manifest(root)
    json.loads((root / "report.json").read_text())
    assert Image.open(root / "contact_sheet.png").size[0] > 0
    assert [row["id"] for row in manifest["classes"]] == list(range(CLASSES))
    assert manifest["frames"] and manifest["licences"] and manifest["drives"]
    frames = {row["path"]: check_frame(root / row["path"], row["files"]) for row in manifest["frames"]}
    identities = {}
    for path, frame in frames.items():
        scene = "/".join(path.split("/")[:2])
        for row in frame["objects"]:
            # People on foot are one person in other postures.
            asset = "" if row["class"] == "human" else row["asset"]
            known = identities.setdefault((scene, row["id"]), (row["track_token"], asset))
            assert known == (row["track_token"], asset), f"{path}: id {row['id']} names another object elsewhere"
    return frames


if __name__ == "__main__":
    print(f"{len(check(sys.argv[1]))} frames are as they should be")
