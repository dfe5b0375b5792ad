"""Grids around the vehicle as a user meets them, and as the benchmarks' loaders read them."""

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest
import trove as package
from conftest import files, trove

SCHEMA = Path(__file__).parents[2] / "docs" / "schema" / "grid.schema.json"
GRIDS = """
[sensors.LIDAR_TOP]
kind = "lidar"
preset = "vlp-16"
[grids.OCC3D]
preset = "occ3d-nuscenes"
[grids.OPENOCC]
preset = "openoccupancy"
[grids.MINE]
preset = "mine.toml"
"""
MINE = """
low_m = [0, -10, -1]
voxel_m = 0.5
cells = [60, 40, 8]
classes = "map.toml"
solid = false
"""
MAP = """
unlabelled = 9
[[class]]
id = 1
name = "ground"
trove = ["road", "sidewalk", "ground"]
[[class]]
id = 2
name = "vehicle"
thing = true
trove = ["car", "jeep", "van", "bus", "truck"]
"""


@pytest.fixture(scope="module")
def grid_recipe(recipe):
    path = recipe.parent / "grids.toml"
    text = recipe.read_text().replace("other_vehicles = 1", "other_vehicles = 0").replace("spp = 4", "light = false")
    path.write_text(text.replace("keyframes = [1, 2]", "keyframes = [1]") + GRIDS)
    (recipe.parent / "mine.toml").write_text(MINE)
    (recipe.parent / "map.toml").write_text(MAP)
    return path


@pytest.fixture(scope="module")
def gridded(grid_recipe, tmp_path_factory):
    out = tmp_path_factory.mktemp("grids") / "out"
    done = trove("generate", grid_recipe, "--out", out, "--threads", 1)
    assert done.returncode == 0, done.stderr
    return out


def by_name(out):
    grids = package.open(out).grids
    assert [grid.name.split("/", 2)[2] for grid in grids] == ["k001/ego.MINE", "k001/ego.OCC3D", "k001/ego.OPENOCC"]
    for grid in grids:
        jsonschema.validate(grid.table, json.loads(SCHEMA.read_text()))
        assert list(grid.semantics.shape) == grid.table["cells"] == list(grid.mask_camera.shape)
    return {grid.table["view"]: grid for grid in grids}


def cells_of(grid, world):
    """The cells of points in World, and which of them lie in the grid."""
    grid_from_world = np.linalg.inv(grid.table["world_from_grid"])
    own = world @ grid_from_world[:3, :3].T + grid_from_world[:3, 3]
    cells = np.floor((own - grid.table["low_m"]) / grid.table["voxel_m"]).astype(int)
    return cells, ((cells >= 0) & (cells < grid.table["cells"])).all(axis=1)


def test_occ3d_s_loaders_read_it(gridded):
    folder = by_name(gridded)["ego.OCC3D"].path
    # As BEVDet's LoadOccGTFromFile does.
    labels = np.load(folder / "labels.npz")
    semantics, masks = labels["semantics"], [labels["mask_lidar"], labels["mask_camera"]]
    assert semantics.shape == (200, 200, 16) and semantics.dtype == np.uint8
    assert set(np.unique(semantics)) <= set(range(18)) and {4, 11, 13, 17} <= set(np.unique(semantics))
    for mask in masks:
        assert mask.shape == semantics.shape and set(np.unique(mask)) == {0, 1}
    assert labels["bev"].shape == (200, 200) and (labels["bev"][105:110, 98:102] == 11).all()
    # Around the vehicle is road, and the vehicle is not there.
    assert (semantics[105:110, 98:102, 5] == 17).all() and 11 in semantics[105:110, 98:102]


@pytest.mark.parametrize("view", ["ego.OCC3D", "ego.OPENOCC"])
def test_the_map_is_of_the_road_that_cells_show(gridded, view):
    grid = by_name(gridded)[view]
    layers = grid.map
    assert list(layers) == ["drivable", "walkway", "crossing", "line", "kerb"]
    assert all(layer.shape == grid.bev.shape and layer.dtype == bool and layer.any() for layer in layers.values())
    # Of what shows road or sidewalk from above, but for cells that their edge crosses.
    for number, name in ((11, "drivable"), (13, "walkway")):
        shown = grid.bev == number
        assert shown.sum() > 500 and layers[name][shown].mean() > 0.9
    assert not (layers["drivable"] & layers["walkway"]).any()
    assert (layers["crossing"] & ~layers["drivable"]).sum() < 0.05 * layers["crossing"].sum()
    # Kerbs run where carriageway ends.
    edge = np.zeros_like(layers["kerb"])
    for axis in (0, 1):
        for step in (-1, 1):
            edge |= layers["drivable"] != np.roll(layers["drivable"], step, axis)
    inner = np.s_[1:-1, 1:-1]
    assert edge[inner][layers["kerb"][inner]].mean() > 0.95


def test_openoccupancy_s_loader_reads_it(gridded):
    grid = by_name(gridded)["ego.OPENOCC"]
    # As its LoadOccupancy does.
    rows = np.load(grid.path / "occupancy.npy")
    assert rows.ndim == 2 and rows.shape[1] == 4 and len(rows) > 10_000
    low, voxel = np.array([-51.2, -51.2, -5.0]), 0.2
    centres = (rows[:, [2, 1, 0]] + 0.5) * voxel + low
    assert (centres > low).all() and (centres < [51.2, 51.2, 3.0]).all()
    assert set(rows[:, 3]) <= set(range(17))
    assert (grid.semantics != 17).sum() == len(rows)


@pytest.mark.parametrize("view", ["ego.OCC3D", "ego.OPENOCC"])
def test_what_cameras_and_lidars_see_is_in_filled_cells_that_are_seen(gridded, view):
    frames, grid = package.open(gridded), by_name(gridded)[view]
    own = grid.table["carrier"]
    (sweep,) = frames.sweeps
    cells, inside = cells_of(grid, sweep.xyz)
    met = tuple(cells[inside & (sweep.points["instance"] != own)].T)
    # Noise of 3 cm takes some points into the next cell.
    assert len(met[0]) > 1000 and (grid.semantics[met] != 17).mean() > 0.85
    for frame in frames:
        rows, columns = np.indices(frame.depth_m.shape) + 0.5
        (fx, _, cx), (_, fy, cy), _ = frame.table["intrinsics"]
        seen = np.isfinite(frame.depth_m)
        rays = np.stack([(columns - cx) / fx, (rows - cy) / fy, np.ones_like(rows)], axis=-1)[seen]
        pose = np.array(frame.table["world_from_camera"])
        # A millimetre on, behind the surface.
        camera = rays * frame.depth_m[seen][:, None].astype(float) + 1e-3 * rays / np.linalg.norm(rays, axis=1)[:, None]
        cells, inside = cells_of(grid, camera @ pose[:3, :3].T + pose[:3, 3])
        at = tuple(cells[inside].T)
        assert len(at[0]) > 500
        # The demo has no LiDAR, so its flat ground at height 0 lies on the border of two layers, where rounding decides.
        least = 0.95 if view == "ego.OPENOCC" else 0.999
        assert grid.mask_camera[at].mean() > 0.999 and (grid.semantics[at] != 17).mean() > least
        things = frame.instance[seen][inside]
        if view == "ego.OCC3D":
            found = grid.instance[at]
            assert (found == things)[things > 0].mean() > 0.85


def test_cells_and_classes_of_one_s_own(gridded):
    grid = by_name(gridded)["ego.MINE"]
    assert grid.table["preset"] == "mine" and grid.table["solid"] is False
    assert set(np.unique(grid.semantics)) == {1, 2, 9}
    with pytest.raises(package.TroveError, match=r"occupancy\.npy"):
        grid._array("occupancy.npy")


def test_threads_and_a_second_run_change_nothing_and_what_is_lost_is_made_again(grid_recipe, gridded, tmp_path):
    out = tmp_path / "out"
    assert trove("generate", grid_recipe, "--out", out, "--threads", 2).returncode == 0
    assert files(out) == files(gridded)
    assert trove("verify", out).returncode == 0
    grid = package.open(out).grids[1]
    (grid.path / "labels.npz").write_bytes(b"lost")
    assert trove("verify", out).returncode == 1
    assert trove("generate", grid_recipe, "--out", out).returncode == 0
    assert files(out) == files(gridded)
