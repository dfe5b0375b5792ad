"""`trove export --format openlabel`: the rules of OpenLABEL 1.0, and boxes around their pixels."""

import json

import numpy as np
import pytest
from exports import exported, projected, sources, surrounds

# The parts of the published schema that these files use.
NAMED = {"type": "object", "required": ["name", "val"]}
INTERVALS = {
    "type": "array",
    "items": {
        "type": "object",
        "required": ["frame_start", "frame_end"],
        "properties": {"frame_start": {"type": "integer"}, "frame_end": {"type": "integer"}},
        "additionalProperties": False,
    },
}


def numbers(count):
    """A named list of so many numbers."""
    val = {"type": "array", "items": {"type": "number"}, "minItems": count, "maxItems": count}
    return {"type": "array", "items": NAMED | {"properties": {"val": val}}}


OBJECT_DATA = {
    "type": "object",
    "properties": {
        "bbox": numbers(4),
        "cuboid": numbers(10),
        "num": {"type": "array", "items": NAMED | {"properties": {"val": {"type": "number"}}}},
        "text": {"type": "array", "items": NAMED | {"properties": {"val": {"type": "string"}}}},
    },
    "additionalProperties": False,
}
SCHEMA = {
    "type": "object",
    "required": ["openlabel"],
    "additionalProperties": False,
    "properties": {
        "openlabel": {
            "type": "object",
            "required": ["metadata"],
            "additionalProperties": False,
            "properties": {
                "metadata": {
                    "type": "object",
                    "required": ["schema_version"],
                    "properties": {"schema_version": {"enum": ["1.0.0"]}},
                },
                "coordinate_systems": {
                    "type": "object",
                    "additionalProperties": {
                        "type": "object",
                        "required": ["type", "parent"],
                        "properties": {
                            "type": {"enum": ["sensor_cs", "local_cs", "scene_cs", "geo_cs", "custom"]},
                            "children": {"type": "array", "items": {"type": "string"}},
                        },
                    },
                },
                "streams": {
                    "type": "object",
                    "additionalProperties": {
                        "type": "object",
                        "required": ["type"],
                        "properties": {"type": {"enum": ["camera", "lidar", "radar", "gps_imu", "other"]}},
                    },
                },
                "objects": {
                    "type": "object",
                    "additionalProperties": {
                        "type": "object",
                        "required": ["name", "type"],
                        "properties": {"frame_intervals": INTERVALS, "object_data": OBJECT_DATA},
                    },
                },
                "frames": {
                    "type": "object",
                    "patternProperties": {
                        "^[0-9]+$": {
                            "type": "object",
                            "properties": {
                                "objects": {
                                    "type": "object",
                                    "additionalProperties": {
                                        "type": "object",
                                        "properties": {"object_data": OBJECT_DATA},
                                    },
                                },
                                "frame_properties": {
                                    "type": "object",
                                    "properties": {
                                        "timestamp": {"type": ["string", "number"]},
                                        "transforms": {
                                            "type": "object",
                                            "additionalProperties": {
                                                "type": "object",
                                                "required": ["src", "dst", "transform_src_to_dst"],
                                            },
                                        },
                                    },
                                },
                            },
                        }
                    },
                    "additionalProperties": False,
                },
                "frame_intervals": INTERVALS,
            },
        }
    },
}


def rotation(qx, qy, qz, qw):
    """A rotation matrix of a unit quaternion."""
    return np.array(
        [
            [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw)],
            [2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw)],
            [2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy)],
        ]
    )


def test_cuboids_lie_around_the_pixels_of_their_boxes(finished, tmp_path):
    jsonschema = pytest.importorskip("jsonschema")
    out, _ = exported(finished, tmp_path / "out", "openlabel")
    frames, checked = iter(sources(finished)), 0
    paths = sorted(out.glob("train/*.json"))
    for path in paths:
        file = json.loads(path.read_text())
        jsonschema.validate(file, SCHEMA)
        label = file["openlabel"]
        for index, row in label["frames"].items():
            frame = next(frames)
            properties, camera = row["frame_properties"], frame.table["view"]
            (stream,) = properties["streams"].values()
            picture = path.parent / stream["uri"]
            assert picture.read_bytes() == (frame.folder / "rgb.png").read_bytes()
            (transform,) = properties["transforms"].values()
            assert (transform["src"], transform["dst"]) == (camera, "world")
            world_from_camera = np.reshape(transform["transform_src_to_dst"]["matrix4x4"], (4, 4))
            matrix = stream["stream_properties"]["intrinsics_pinhole"]["camera_matrix_3x4"]
            intrinsics = np.reshape(matrix, (3, 4))[:, :3]
            assert set(row["objects"]) == {str(user["id"]) for user in frame.users}
            for user in frame.users:
                data = row["objects"][str(user["id"])]["object_data"]
                named = label["objects"][str(user["id"])]
                assert named["type"] == user["kind"]
                spans = named["frame_intervals"]
                assert any(span["frame_start"] <= int(index) <= span["frame_end"] for span in spans)
                x, y, z, *quaternion, length, width, height = data["cuboid"][0]["val"]
                world_from_body = np.eye(4)
                world_from_body[:3, :3], world_from_body[:3, 3] = rotation(*quaternion), (x, y, z)
                assert np.allclose(world_from_body, user["world_from_body"], atol=1e-9)
                boxes = {box["name"]: box["val"] for box in data.get("bbox", [])}
                corners, near_m = projected(
                    np.linalg.inv(world_from_camera) @ world_from_body, (length, width, height), intrinsics
                )
                if near_m > 0.5 and user["truncation"] == 0:
                    cx, cy, w, h = boxes["amodal"]
                    box = [cx - w / 2, cy - h / 2, cx + w / 2 - 1, cy + h / 2 - 1]
                    assert box == user["amodal_box"] and surrounds(corners, box)
                    checked += 1
    assert checked > 10 and next(frames, None) is None
