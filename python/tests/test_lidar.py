"""LiDAR sweeps as a user meets them: from a recipe to files, Python and exports."""

import json
from pathlib import Path

import jsonschema
import laspy
import numpy as np
import pypcd4
import pytest
import trove as package
from conftest import files, trove

SCHEMA = Path(__file__).parents[2] / "docs" / "schema" / "sweep.schema.json"
LIDAR = '[sensors.LIDAR_TOP]\nkind = "lidar"\npreset = "vlp-16"\nreturns = "dual"\n'


@pytest.fixture(scope="module")
def lidar_recipe(recipe):
    path = recipe.parent / "lidar.toml"
    text = recipe.read_text().replace("other_vehicles = 1", "other_vehicles = 0").replace("spp = 4", "light = false")
    path.write_text(text + LIDAR)
    return path


@pytest.fixture(scope="module")
def swept(lidar_recipe, tmp_path_factory):
    out = tmp_path_factory.mktemp("lidar") / "out"
    done = trove("generate", lidar_recipe, "--out", out, "--threads", 1)
    assert done.returncode == 0, done.stderr
    return out


def test_a_sweep_is_an_array_and_a_table(swept):
    frames = package.open(swept)
    assert len(frames) == 4, "sweeps are no frames"
    names = [sweep.name.split("/", 2)[2] for sweep in frames.sweeps]
    assert names == ["k001/ego.LIDAR_TOP", "k002/ego.LIDAR_TOP"]
    for sweep in frames.sweeps:
        table, points = sweep.table, sweep.points
        jsonschema.validate(table, json.loads(SCHEMA.read_text()))
        assert table["points"] == len(points) > 5000
        assert points["ring"].max() < len(table["elevations_deg"]) == 16
        ids, counts = np.unique(points["instance"], return_counts=True)
        rows = {row["id"]: row["points"] for row in table["objects"]}
        assert rows == {int(i): int(n) for i, n in zip(ids, counts, strict=True) if i}
        assert set(np.unique(points["return"])) == {0, 1}
        assert points["time_s"].min() >= table["begins_s"] - 1e-6
        assert points["time_s"].max() <= table["begins_s"] + table["sweep_s"]
        assert np.isfinite(sweep.xyz).all()


def test_points_lie_on_what_the_depth_of_the_same_moment_shows(swept):
    frames = package.open(swept)
    compared, agree, alike = 0, 0, 0
    for frame in frames:
        (sweep,) = [s for s in frames.sweeps if s.name.split("/")[:3] == frame.name.split("/")[:3]]
        camera_from_world = np.linalg.inv(frame.table["world_from_camera"])
        camera = sweep.xyz @ camera_from_world[:3, :3].T + camera_from_world[:3, 3]
        ahead = camera[:, 2] > 1
        (fx, _, cx), (_, fy, cy), _ = frame.table["intrinsics"]
        column = np.floor(fx * camera[:, 0] / camera[:, 2] + cx)
        row = np.floor(fy * camera[:, 1] / camera[:, 2] + cy)
        height, width = frame.depth_m.shape
        # What moves is elsewhere when the camera looks, and what a LiDAR sees past an edge a camera may not.
        static = ~np.isin(sweep.points["class"], [2, 3, 4, 5, 6, 7, 12, 13, 16]) & (sweep.points["return"] == 0)
        seen = ahead & static & (column >= 0) & (column < width) & (row >= 0) & (row < height)
        at = row[seen].astype(int), column[seen].astype(int)
        apart = np.abs(frame.depth_m[at] - camera[seen, 2])
        near = apart < 0.1 + 0.1 * camera[seen, 2]
        compared += seen.sum()
        agree += near.sum()
        alike += (frame.class_[at] == sweep.points["class"][seen])[near].sum()
    assert compared > 1000
    assert agree / compared > 0.85, agree / compared
    assert alike / agree > 0.95, alike / agree


def test_threads_and_a_second_run_change_nothing_and_what_is_lost_is_made_again(lidar_recipe, swept, tmp_path):
    out = tmp_path / "out"
    assert trove("generate", lidar_recipe, "--out", out, "--threads", 2).returncode == 0
    assert files(out) == files(swept)
    (damaged,) = out.glob("*/v00/k001/ego.LIDAR_TOP/points.npy")
    damaged.write_bytes(damaged.read_bytes()[:-1] + b"x")
    verified = trove("verify", out)
    assert verified.returncode == 1
    assert "k001/ego.LIDAR_TOP/points.npy" in verified.stdout
    again = trove("generate", lidar_recipe, "--out", out, "--json")
    assert json.loads(again.stdout)["rendered"] == 1, again.stderr
    assert files(out) == files(swept)
    assert trove("verify", out).returncode == 0


@pytest.fixture(scope="module")
def lit(lidar_recipe, tmp_path_factory):
    """Frames whose images an export can take, and their sweeps."""
    folder = tmp_path_factory.mktemp("lit")
    (folder / "lit.toml").write_text(lidar_recipe.read_text().replace("light = false", "spp = 1"))
    done = trove("generate", folder / "lit.toml", "--out", folder / "out")
    assert done.returncode == 0, done.stderr
    return folder / "out"


def test_pcd_and_las_hold_every_point(lit, tmp_path):
    sweeps = {sweep.name.split("/")[2]: sweep for sweep in package.open(lit).sweeps}
    for form in ("pcd", "las"):
        done = trove("export", lit, "--format", form, "--out", tmp_path / form)
        assert done.returncode == 0, done.stderr
        assert len(list((tmp_path / form / "train").iterdir())) == len(sweeps) == 2
    for keyframe, sweep in sweeps.items():
        points = sweep.points
        (path,) = (tmp_path / "pcd/train").glob(f"*_{keyframe}_ego.LIDAR_TOP.pcd")
        cloud = pypcd4.PointCloud.from_path(path)
        told = dict(zip(cloud.fields, cloud.numpy(cloud.fields).T))
        same = {"return": "return", "label": "class", "time": "time_s"}
        for field in ("x", "y", "z", "intensity", "ring", "time", "return", "label", "instance"):
            assert np.array_equal(told[field], points[same.get(field, field)].astype("<f4")), field
        pose = np.asarray(sweep.table["world_from_lidar"])
        place, (w, x, y, z) = cloud.metadata.viewpoint[:3], cloud.metadata.viewpoint[3:]
        assert np.allclose(place, pose[:3, 3])
        left = [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)]
        assert np.allclose(left, pose[:3, 1])

        (path,) = (tmp_path / "las/train").glob(f"*_{keyframe}_ego.LIDAR_TOP.las")
        las = laspy.read(path)
        assert np.abs(las.xyz - sweep.xyz).max() <= 0.0005 + 1e-9
        assert {axis.unit_name for axis in las.header.parse_crs().axis_info} == {"metre"}
        for field, expected in {
            "ring": points["ring"],
            "instance": points["instance"],
            "intensity": points["intensity"].astype(int) * 257,
            "return_number": points["return"] + 1,
        }.items():
            assert np.array_equal(las[field], expected), field
        seconds = las.gps_time + 1e9 + 315964800 - 18 - sweep.table["time_ns"] * 1e-9
        assert np.abs(seconds - points["time_s"]).max() < 1e-5
        assert set(las.classification[points["class"] == 9]) == {11}
        assert (np.asarray(las.number_of_returns)[points["return"] == 1] == 2).all()
        assert (las.number_of_returns == 2).sum() == 2 * (points["return"] == 1).sum()


def test_a_run_without_a_lidar_has_no_point_clouds(finished, tmp_path):
    done = trove("export", finished, "--format", "las", "--out", tmp_path / "las")
    assert done.returncode != 0
    assert "[sensors.NAME]" in done.stderr


def test_nuscenes_and_kitti_have_the_points(lit, tmp_path):
    out = lit
    sweep = package.open(out).sweeps[0]
    for form in ("nuscenes", "kitti"):
        done = trove("export", out, "--format", form, "--out", tmp_path / form)
        assert done.returncode == 0, done.stderr
    pcd = sorted((tmp_path / "nuscenes/samples/LIDAR_TOP").iterdir())[0]
    records = np.fromfile(pcd, "<f4").reshape(-1, 5)
    for i, field in enumerate(["x", "y", "z", "intensity", "ring"]):
        assert np.array_equal(records[:, i], sweep.points[field].astype("<f4")), field
    tables = tmp_path / "nuscenes/v1.0-trove"
    rows = json.loads((tables / "lidarseg.json").read_text())
    assert len(rows) == 2
    labels = np.fromfile(tmp_path / "nuscenes" / rows[0]["filename"], np.uint8)
    (archive, _) = [row["filename"] for row in json.loads((tables / "panoptic.json").read_text())]
    panoptic = np.load(tmp_path / "nuscenes" / archive)["data"]
    assert len(labels) == len(panoptic) == len(records)
    assert np.array_equal(panoptic // 1000, labels)
    assert (labels[sweep.points["class"] == 9] == 24).all()
    velodyne = np.fromfile(tmp_path / "kitti/training/velodyne/000000.bin", "<f4").reshape(-1, 4)
    assert len(velodyne) in {len(s.points) for s in package.open(out).sweeps}
    # KITTI's calibration takes them to where the camera sees them.
    lines = (tmp_path / "kitti/training/calib/000000.txt").read_text().splitlines()
    (line,) = [line for line in lines if line.startswith("Tr_velo_to_cam:")]
    camera_from_velodyne = np.array(line.split()[1:], float).reshape(3, 4)
    assert abs(np.linalg.det(camera_from_velodyne[:, :3]) - 1) < 1e-6
    assert np.linalg.norm(camera_from_velodyne[:, 3]) > 0.1
