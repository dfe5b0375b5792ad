"""Holds rendered frames against the recording, with the code of nuscenes-devkit.

    python -m venv .venv-devkit && .venv-devkit/bin/pip install -r tests/devkit/requirements.txt
    .venv-devkit/bin/python tests/devkit/check_boxes.py OUT --root data/nuscenes --version v1.0-mini

OUT is what `trove generate` wrote. For every frame of a recorded camera the devkit projects the annotated boxes; those
within 40 m and in the image are looked up in frame.json by their annotation's token, and in instance.png by its id.

A box counts as hit where the instance has pixels in the middle half of the box's projection (as far as that lies in
the image), and at least four fifths of the instance's pixels lie inside the projection. Left out, and counted, are boxes
of which other things hide more than half. Further: the median depth of the instance lies between the box's near and
far end, forward flow of all that stands still is the reprojection of its depth, and normals are unit.

The exit status is 1 where fewer than 90 % are hit or another check fails.
"""

import argparse
import json
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import OpenEXR
from matplotlib.path import Path as Outline
from nuscenes.nuscenes import NuScenes
from nuscenes.utils.geometry_utils import view_points
from PIL import Image
from scipy.spatial import ConvexHull

REACH_M = 40.0
HIDDEN_SHARE = 0.5
INSIDE_SHARE = 0.8
HIT_SHARE = 0.9
DEPTH_SHARE = 0.95
DEPTH_MARGIN_M = 0.3
FLOW_PX = 0.1
NORMAL_LENGTH = 1e-3


def planes(path, names):
    """The named channels of an OpenEXR file, along the last axis."""
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    return np.stack([channels[name].pixels for name in names], axis=-1)


class Frame:
    """One frame's folder."""

    def __init__(self, folder):
        self.folder = folder
        self.table = json.loads((folder / "frame.json").read_text())
        self.rows = {row["token"]: row for row in self.table["objects"] if row["token"]}
        self.instance = np.array(Image.open(folder / "instance.png"))
        self.depth_m = planes(folder / "depth.exr", "Y")[..., 0]
        self.size = (self.table["width_px"], self.table["height_px"])
        assert self.instance.shape == self.depth_m.shape == self.size[::-1], f"{folder}: sizes differ"

    def scaled(self, intrinsic, record):
        """The recorded camera's matrix at this frame's resolution."""
        scale = np.diag([self.size[0] / record["width"], self.size[1] / record["height"], 1.0])
        return scale @ intrinsic


def pixels_inside(corners_px, size):
    """Which pixels' centres lie in the hull of some points, and the hull's bounds cut to the image."""
    low = np.clip(np.floor(corners_px.min(0)), 0, size).astype(int)
    high = np.clip(np.ceil(corners_px.max(0)), 0, size).astype(int)
    u, v = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
    outline = Outline(corners_px[ConvexHull(corners_px).vertices])
    # A pixel's width on every side: the models touch their boxes. The sign depends on the outline's sense.
    points = np.column_stack([u.ravel(), v.ravel()])
    inside = outline.contains_points(points, radius=1.0) | outline.contains_points(points, radius=-1.0)
    mask = np.zeros(size[::-1], bool)
    mask[low[1] : high[1], low[0] : high[0]] = inside.reshape(u.shape)
    return mask


def middle_half(mask, corners_px):
    """The part of a projection in the middle half of its rectangle; all of it where that is outside the image."""
    low, high = corners_px.min(0), corners_px.max(0)
    centre, quarter = (low + high) / 2, np.maximum((high - low) / 4, 1.0)
    v, u = np.indices(mask.shape) + 0.5
    core = mask & (abs(u - centre[0]) <= quarter[0]) & (abs(v - centre[1]) <= quarter[1])
    return core if core.any() else mask


def judge(frame, box, intrinsic):
    """Whether a box is hit, missed, hidden or too small; and whether its depth is right (None: not to be told)."""
    corners_camera = box.corners()
    corners_px = view_points(corners_camera, intrinsic, normalize=True)[:2].T
    mask = pixels_inside(corners_px, np.array(frame.size))
    near_m, far_m = corners_camera[2].min(), corners_camera[2].max()
    if not mask.any():
        return "smaller than a pixel", None
    row = frame.rows.get(box.token)
    if row is None or row["amodal_px"] == 0:
        is_behind = np.median(frame.depth_m[mask]) < near_m - DEPTH_MARGIN_M
        return ("hidden" if is_behind else "missed: not in frame.json"), None
    if row["visible_px"] < (1 - HIDDEN_SHARE) * row["amodal_px"]:
        return "hidden", None
    shown = frame.instance == row["id"]
    if shown.sum() != row["visible_px"]:
        return "missed: visible_px is wrong", None
    depth_m = np.median(frame.depth_m[shown])
    is_deep = near_m - DEPTH_MARGIN_M <= depth_m <= far_m + DEPTH_MARGIN_M
    if (shown & mask).sum() < INSIDE_SHARE * shown.sum():
        return "missed: elsewhere", is_deep
    return ("hit" if (shown & middle_half(mask, corners_px)).any() else "missed: not in the middle"), is_deep


def stands(dataset, token):
    """Whether an annotated object is annotated at the same pose at the next keyframe."""
    record = dataset.get("sample_annotation", token)
    if not record["next"]:
        return False
    following = dataset.get("sample_annotation", record["next"])
    return all(record[key] == following[key] for key in ("translation", "rotation"))


def flow_error_px(dataset, frame):
    """Largest error of forward flow over what stands still; None where the frame has no next."""
    table = frame.table
    if table["world_from_camera_next"] is None:
        return None
    moving = [row["id"] for row in frame.rows.values() if not stands(dataset, row["token"])]
    intrinsic = np.array(table["intrinsics"])
    next_from_camera = np.linalg.inv(table["world_from_camera_next"]) @ np.array(table["world_from_camera"])
    v, u = np.indices(frame.depth_m.shape) + 0.5
    with np.errstate(invalid="ignore", divide="ignore"):
        rays = np.linalg.inv(intrinsic) @ np.stack([u, v, np.ones_like(u)]).reshape(3, -1)
        points = rays * frame.depth_m.ravel().astype(float)
        there = next_from_camera[:3, :3] @ points + next_from_camera[:3, 3:]
        expected = view_points(there, intrinsic, normalize=True)[:2] - np.stack([u.ravel(), v.ravel()])
        flow = planes(frame.folder / "flow_forward.exr", "RG").reshape(-1, 2).T
        error = np.abs(flow - expected).max(0)
    # Near the next camera's own plane a float of depth is worth many pixels.
    judged = np.isfinite(frame.depth_m.ravel()) & (there[2] > 0.5) & np.isfinite(flow).all(0)
    judged &= ~np.isin(frame.instance.ravel(), moving)
    return float(error[judged].max()) if judged.any() else float("inf")


def normal_error(frame):
    """Largest difference of a normal's length from 1, or from 0 in the sky."""
    length = np.linalg.norm(planes(frame.folder / "normal.exr", "RGB").astype(float), axis=-1)
    return float(np.abs(length - np.isfinite(frame.depth_m)).max())


def check(out, dataset):
    """Checks all frames of recorded cameras; returns what was found."""
    verdicts, depths, flows, normals = Counter(), Counter(), [], []
    for folder in sorted(out.glob("*/v*/k*/ego.CAM_*")):
        frame = Frame(folder)
        record = dataset.get("sample_data", frame.table["source_token"])
        _, boxes, intrinsic = dataset.get_sample_data(record["token"])
        intrinsic = frame.scaled(intrinsic, record)
        for box in boxes:
            if np.linalg.norm(box.center) > REACH_M:
                continue
            verdict, is_deep = judge(frame, box, intrinsic)
            verdicts[box.name, verdict] += 1
            if is_deep is not None:
                depths[is_deep] += 1
            if verdict.startswith("missed"):
                print(f"{verdict}: {box.name} {box.token} in {folder.relative_to(out)}")
        error = flow_error_px(dataset, frame)
        if error is not None:
            flows.append((error, str(folder.relative_to(out))))
        normals.append((normal_error(frame), str(folder.relative_to(out))))
    return verdicts, depths, flows, normals


def share(part, whole):
    return part / whole if whole else 0.0


def print_table(verdicts):
    """One line a category; returns hits and judged boxes of all."""
    print(f"{'category':40} {'boxes':>6} {'hidden':>7} {'small':>6} {'judged':>7} {'hit':>6} {'share':>7}")
    totals = np.zeros(5, int)
    for name in [*sorted({name for name, _ in verdicts}), "all"]:
        of = {verdict: n for (other, verdict), n in verdicts.items() if other == name}
        row = np.array([sum(of.values()), of.get("hidden", 0), of.get("smaller than a pixel", 0), 0, of.get("hit", 0)])
        row[3] = row[0] - row[1] - row[2]
        row, totals = (totals, totals) if name == "all" else (row, totals + row)
        print(f"{name:40} {row[0]:6} {row[1]:7} {row[2]:6} {row[3]:7} {row[4]:6} {share(row[4], row[3]):7.1%}")
    return totals[4], totals[3]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, help="folder that `trove generate` wrote")
    parser.add_argument("--root", required=True, help="root of the dataset")
    parser.add_argument("--version", default="v1.0-mini")
    options = parser.parse_args()
    dataset = NuScenes(options.version, options.root, verbose=False)
    verdicts, depths, flows, normals = check(options.out, dataset)
    if not verdicts:
        sys.exit(f"{options.out}: expected frames <scene>/v<nn>/k<nnn>/ego.CAM_*, found none with boxes")

    hits, judged = print_table(verdicts)
    deep = share(depths[True], depths[True] + depths[False])
    flow_px, flow_frame = max(flows, default=(0.0, "no frame with a next one"))
    normal, normal_frame = max(normals)
    print(f"median depth within the box ± {DEPTH_MARGIN_M} m: {deep:.1%}")
    print(f"forward flow of what stands: at most {flow_px:.4f} px from the reprojected depth ({flow_frame})")
    print(f"normals: at most {normal:.2g} from unit ({normal_frame})")
    is_good = share(hits, judged) >= HIT_SHARE and deep >= DEPTH_SHARE
    is_good &= flow_px <= FLOW_PX and normal <= NORMAL_LENGTH
    print("passed" if is_good else "failed")
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
