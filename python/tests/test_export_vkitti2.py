"""`trove export --format vkitti2`: files decoded as Virtual KITTI 2's page says."""

import csv

import numpy as np
import pytest
from exports import exported, projected, sources, surrounds
from PIL import Image


@pytest.fixture(scope="module")
def virtual_kitti(finished, tmp_path_factory):
    return exported(finished, tmp_path_factory.mktemp("vkitti2") / "out", "vkitti2")


def rows(path):
    """A text file's rows by the names of its columns."""
    with path.open() as file:
        names = file.readline().split()
        return [dict(zip(names, row)) for row in csv.reader(file, delimiter=" ")]


def numbered(out, finished):
    """The frames with their folder, frame number and camera number."""
    folder = out / "Scene01/v00"
    cameras = dict(line.split()[::-1] for line in (folder / "cameras.txt").read_text().splitlines())
    keyframes = sorted({frame.table["keyframe"] for frame in sources(finished)})
    for frame in sources(finished):
        camera = cameras[frame.table["view"]]
        yield folder, frame, keyframes.index(frame.table["keyframe"]), camera


def flow_png(path):
    """A 16-bit RGB PNG, which Pillow would read with 8 bits."""
    png = pytest.importorskip("png")
    width, height, lines, _ = png.Reader(str(path)).read()
    return np.array([np.array(line) for line in lines], float).reshape(height, width, 3)


def test_pictures_decode_to_what_the_frames_hold(virtual_kitti, finished):
    out, _ = virtual_kitti
    colors = {tuple(int(row[c]) for c in "rgb"): row["Category"] for row in rows(out / "Scene01/v00/colors.txt")}
    for folder, frame, index, camera in numbered(out, finished):
        place = lambda what, name, end="png": folder / f"frames/{what}/{camera}/{name}_{index:05}.{end}"  # noqa: B023, E731
        apart = np.array(Image.open(place("rgb", "rgb", "jpg"))).astype(float) - frame.picture("rgb")
        assert np.abs(apart).mean() < 4
        depth, expected = np.array(Image.open(place("depth", "depth"))), frame.depth_m()
        sky = np.isinf(expected)
        assert (depth[sky] == 65535).all()
        assert np.abs(depth / 100.0 - expected)[~sky].max() <= 0.0051
        shown = np.array(Image.open(place("classSegmentation", "classgt")))
        assert {tuple(color) for color in np.unique(shown.reshape(-1, 3), axis=0)} <= set(colors)
        assert (np.all(shown == [90, 200, 255], axis=-1) == (frame.picture("class") == 1)).all()


def test_flow_decodes_to_pixels(virtual_kitti, finished):
    out, _ = virtual_kitti
    checked = 0
    for folder, frame, index, camera in numbered(out, finished):
        flows = [("forwardFlow", "flow", "flow_forward"), ("backwardFlow", "backwardFlow", "flow_backward")]
        for what, name, source in flows:
            found = flow_png(folder / f"frames/{what}/{camera}/{name}_{index:05}.png")
            expected = frame.planes(source, "RG")
            most = np.array([expected.shape[1] - 1, expected.shape[0] - 1])
            decoded = (2 * found[..., :2] / 65535 - 1) * most
            valid = found[..., 2] > 0
            fits = (np.abs(expected) <= most).all(-1)
            assert (valid == fits).all()
            assert np.abs(decoded - expected)[valid].max(initial=0) < 0.01
            checked += valid.sum()
    assert checked > 1000


def test_poses_and_boxes_agree_with_each_other(virtual_kitti, finished):
    out, _ = virtual_kitti
    folder = out / "Scene01/v00"
    key = lambda row: (int(row["frame"]), f"Camera_{row['cameraID']}")  # noqa: E731
    extrinsics = {key(row): row for row in rows(folder / "extrinsic.txt")}
    intrinsics = {key(row): row for row in rows(folder / "intrinsic.txt")}
    boxes = {(*key(row), row["trackID"]): row for row in rows(folder / "bbox.txt")}
    poses = {(*key(row), row["trackID"]): row for row in rows(folder / "pose.txt")}
    info = {row["trackID"]: row for row in rows(folder / "info.txt")}
    assert set(boxes) == set(poses) and boxes
    frames = {(index, camera): frame for _, frame, index, camera in numbered(out, finished)}
    assert set(frames) == set(extrinsics) == set(intrinsics)
    checked = 0
    for (index, camera, track), row in poses.items():
        number = lambda name: float(row[name])  # noqa: B023, E731
        angle, pitch, roll = (number(f"rotation_camera_space_{axis}") for axis in "yxz")
        turn_y = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
        turn_x = np.array([[1, 0, 0], [0, np.cos(pitch), -np.sin(pitch)], [0, np.sin(pitch), np.cos(pitch)]])
        turn_z = np.array([[np.cos(roll), -np.sin(roll), 0], [np.sin(roll), np.cos(roll), 0], [0, 0, 1]])
        length, width, height = number("length"), number("width"), number("height")
        to_camera = np.eye(4)
        to_camera[:3, :3] = turn_y @ turn_x @ turn_z
        foot = np.array([number(f"camera_space_{axis}") for axis in "XYZ"])
        # y points down, and the place is the middle of the lower side.
        to_camera[:3, 3] = foot + to_camera[:3, :3] @ [0, -height / 2, 0]
        k = intrinsics[index, camera]
        fx, fy, cx, cy = (float(k[name]) for name in ("K[0,0]", "K[1,1]", "K[0,2]", "K[1,2]"))
        corners, near_m = projected(to_camera, (length, height, width), [[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
        box = boxes[index, camera, track]
        whole = float(box["truncation_ratio"]) == 0 and float(box["occupancy_ratio"]) == 1
        if near_m > 0.5 and whole:
            assert surrounds(corners, [int(box[side]) for side in ("left", "top", "right", "bottom")])
            checked += 1
        matrix = np.array([float(v) for v in list(extrinsics[index, camera].values())[2:]])
        world = np.array([number(f"world_space_{axis}") for axis in "XYZ"])
        rotation = np.array([[float(extrinsics[index, camera][f"r{i},{j}"]) for j in (1, 2, 3)] for i in (1, 2, 3)])
        shift = np.array([float(extrinsics[index, camera][f"t{i}"]) for i in (1, 2, 3)])
        assert np.allclose(rotation @ world + shift, foot, atol=1e-6) and np.isfinite(matrix).all()
        ids = np.array(Image.open(folder / f"frames/instanceSegmentation/{camera}/instancegt_{index:05}.png"))
        assert (ids == int(track) + 1).sum() == int(box["number_pixels"])
        assert info[track]["label"] in {"Car", "Van", "Truck"}
    assert checked > 5


def test_flows_that_do_not_fit_are_counted(virtual_kitti, finished):
    _, summary = virtual_kitti
    too_long = 0
    for frame in sources(finished):
        for name in ("flow_forward", "flow_backward"):
            flow = frame.planes(name, "RG")
            too_long += (np.abs(flow) > [flow.shape[1] - 1, flow.shape[0] - 1]).any(-1).sum()
    assert summary["clipped"].get("flows longer than the picture, written as not valid", 0) == too_long
