"""Radars as a user meets them: from a recipe to files, Python and nuScenes' PCD."""

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest
import trove as package
from conftest import files, trove

SCHEMA = Path(__file__).parents[2] / "docs" / "schema" / "radar.schema.json"
RADAR = (
    '[sensors.RADAR_FRONT]\nkind = "radar"\npreset = "ars408"\n'
    '[sensors.RADAR_BACK_LEFT]\nkind = "radar"\npreset = "ars408"\nposition_m = [-0.6, 0.6, 0.5]\nyaw_deg = 180\n'
)


@pytest.fixture(scope="module")
def radar_recipe(recipe):
    path = recipe.parent / "radar.toml"
    text = recipe.read_text().replace("other_vehicles = 1", "other_vehicles = 0").replace("spp = 4", "spp = 1")
    path.write_text(text + RADAR)
    return path


@pytest.fixture(scope="module")
def looked(radar_recipe, tmp_path_factory):
    out = tmp_path_factory.mktemp("radar") / "out"
    done = trove("generate", radar_recipe, "--out", out, "--threads", 1)
    assert done.returncode == 0, done.stderr
    return out


def test_a_cycle_is_an_array_and_a_table(looked):
    radars = package.open(looked).radars
    names = [radar.name.split("/", 2)[2] for radar in radars]
    assert sorted(names) == [f"k00{k}/ego.RADAR_{side}" for k in (1, 2) for side in ("BACK_LEFT", "FRONT")]
    for radar in radars:
        table, told = radar.table, radar.detections
        jsonschema.validate(table, json.loads(SCHEMA.read_text()))
        assert table["detections"] == len(told) > 5
        ids, counts = np.unique(told["instance"], return_counts=True)
        rows = {row["id"]: row["points"] for row in table["objects"]}
        assert rows == {int(i): int(n) for i, n in zip(ids, counts, strict=True) if i}
        assert (np.diff(told["range_m"]) >= 0).all(), "the nearest first"
        assert np.allclose(np.hypot(told["x"], told["y"]), told["range_m"], rtol=1e-5)
        assert (np.abs(told["azimuth_rad"]) <= np.radians(60)).all()
        # What stands is still over ground, whatever the vehicle does: houses, road, trees.
        stands = np.isin(told["class"], [8, 9, 10, 11, 15, 19]) & (told["surfaces"] == 1)
        assert np.abs(told["ground_mps"][stands]).max(initial=0) < 1.0
        assert np.isfinite(radar.xyz).all()


def pcd(path):
    """A PCD file by its own header, as PCL's readers take it."""
    head, _, data = path.read_bytes().partition(b"DATA binary\n")
    rows = dict(line.split(" ", 1) for line in head.decode().splitlines() if not line.startswith("#"))
    kinds = zip(rows["FIELDS"].split(), rows["TYPE"].lower().split(), rows["SIZE"].split(), strict=True)
    count = int(rows["POINTS"])
    assert count == int(rows["WIDTH"]) * int(rows["HEIGHT"])
    records = np.frombuffer(data, np.dtype([(name, f"<{kind}{size}") for name, kind, size in kinds]), count)
    assert len(data) == records.nbytes + 1, "the devkit asks that something follows the last record"
    return records


def test_nuscenes_has_them_in_eighteen_fields(looked, tmp_path):
    done = trove("export", looked, "--format", "nuscenes", "--out", tmp_path / "nuscenes")
    assert done.returncode == 0, done.stderr
    tables = tmp_path / "nuscenes" / "v1.0-trove"
    sensors = {row["channel"]: row["modality"] for row in json.loads((tables / "sensor.json").read_text())}
    assert sensors["RADAR_FRONT"] == sensors["RADAR_BACK_LEFT"] == "radar"
    data = [row for row in json.loads((tables / "sample_data.json").read_text()) if "RADAR_FRONT" in row["filename"]]
    radars = [radar for radar in package.open(looked).radars if radar.name.endswith("FRONT")]
    assert len(data) == len(radars) == 2
    for row, radar in zip(sorted(data, key=lambda row: row["timestamp"]), radars, strict=True):
        records, told = pcd(tmp_path / "nuscenes" / row["filename"]), radar.detections
        assert len(records.dtype) == 18
        assert np.allclose(records["x"], told["x"], atol=1e-4)
        assert np.allclose(records["y"], told["y"], atol=1e-4)
        assert (records["rcs"] == told["rcs_dbsm"]).all()
        assert np.allclose(np.hypot(records["vx_comp"], records["vy_comp"]), np.abs(told["ground_mps"]), atol=1e-4)
        assert (records["dyn_prop"][np.abs(told["ground_mps"]) < radar.table["stands_mps"]] == 1).all()


def test_a_run_is_the_same_by_any_number_of_threads_and_is_verified(radar_recipe, looked, tmp_path):
    done = trove("generate", radar_recipe, "--out", tmp_path / "out", "--threads", 2)
    assert done.returncode == 0, done.stderr
    one, two = ({n: b for n, b in files(folder).items() if "RADAR" in str(n)} for folder in (looked, tmp_path / "out"))
    assert one and one == two
    assert trove("verify", looked).returncode == 0
    next(looked.glob("*/v00/k001/ego.RADAR_FRONT/detections.npy")).write_bytes(b"")
    assert trove("verify", looked).returncode == 1
