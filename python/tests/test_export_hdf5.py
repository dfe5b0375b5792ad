"""`trove export --format hdf5`: h5py reads what BlenderProc would have written."""

import json

import numpy as np
import pytest
from exports import exported, sources


def test_h5py_reads_every_value(finished, tmp_path):
    h5py = pytest.importorskip("h5py")
    out, _ = exported(finished, tmp_path / "out", "hdf5")
    for number, frame in enumerate(sources(finished)):
        with h5py.File(out / f"train/{number}.hdf5") as file:
            values = {key: np.array(file[key]) for key in file}
        assert (values["colors"] == frame.picture("rgb")).all()
        assert (values["class_segmaps"] == frame.picture("class")).all()
        assert (values["instance_segmaps"] == frame.picture("instance")).all()
        assert values["instance_segmaps"].dtype == np.uint16 and values["depth"].dtype == np.float32
        depth_m = frame.depth_m()
        assert (values["depth"] == np.where(np.isinf(depth_m), np.float32(1e10), depth_m)).all()
        # Blender's camera: x right, y up, z backwards; from 0 to 1.
        normals = (2 * values["normals"] - 1) * [1, -1, -1]
        assert np.allclose(normals, frame.planes("normal", "RGB"), atol=1e-6)
        for key, name in [("forward_flow", "flow_forward"), ("backward_flow", "flow_backward")]:
            assert np.array_equal(values[key], frame.planes(name, "RG"), equal_nan=True)
        rows = json.loads(values["instance_attribute_maps"].item())
        assert {row["idx"] for row in rows} >= set(np.unique(values["instance_segmaps"]).tolist())
        classes = {row["idx"]: row["category_id"] for row in rows}
        assert all(classes[row["id"]] == row["class_id"] for row in frame.table["objects"])
        camera = json.loads(values["camera"].item())
        assert camera["world_from_camera"] == frame.table["world_from_camera"]
    assert number > 0
