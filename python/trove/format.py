"""The JSON files of an output folder, typed and read; `docs/schema` describes every field."""

import json
from pathlib import Path
from typing import Any, TypedDict

from trove._trove import TroveError

FORMAT = 2
"""Version of the format that this module reads."""

Matrix4 = list[list[float]]
"""A 4×4 matrix, row-major."""


class FrameRow(TypedDict):
    """A frame's row in the manifest; `counterfactual` is present only if it is compared with another frame."""

    path: str
    scene: str
    variation: int
    keyframe: int
    view: str
    factors: dict[str, Any]
    files: dict[str, str]


class Manifest(TypedDict):
    """`manifest.json`."""

    format: int
    seed: int
    recipe: dict[str, Any]
    versions: dict[str, Any]
    classes: list[dict[str, Any]]
    drives: list[dict[str, Any]]
    licences: list[dict[str, str]]
    frames: list[FrameRow]
    sweeps: list[FrameRow]


# In this form because `class` is a keyword.
ObjectRow = TypedDict(
    "ObjectRow",
    {
        "id": int,
        "class": str,
        "class_id": int,
        "kind": str,
        "origin": str,
        "category": str,
        "token": str,
        "track_token": str,
        "asset": str,
        "world_from_body": Matrix4,
        "size_m": list[float],
        "velocity_mps": list[float] | None,
        "visible_px": int,
        "amodal_px": int,
        "visible_box": list[int] | None,
        "amodal_box": list[int] | None,
        "truncation": float,
        "occlusion": float,
        "range_m": float,
        "keypoints": list[list[float]] | None,
        "keypoints_world_m": list[list[float]] | None,
    },
)
"""An object in `frame.json`."""


class FrameTable(TypedDict):
    """`frame.json`."""

    scene: str
    dataset: str
    place: str
    variation: int
    keyframe: int
    keyframe_token: str
    keyframe_time_ns: int
    recorded_keyframe: int | None
    view: str
    time_ns: int
    source_token: str
    source_image: str
    width_px: int
    height_px: int
    intrinsics: list[list[float]]
    lens_model: str
    distortion: list[float]
    exposure_s: float
    readout_s: float
    world_from_camera: Matrix4
    world_from_camera_rotation_wxyz: list[float]
    world_from_camera_translation_m: list[float]
    world_from_camera_previous: Matrix4 | None
    world_from_camera_next: Matrix4 | None
    world_from_ego: Matrix4 | None
    carrier: int | None
    carrier_track_token: str
    projection: dict[str, Any]
    glass: str
    exposure_ev: float | None
    spp: int
    denoised: bool
    seed: int
    objects: list[ObjectRow]


# In this form because `class` is a keyword.
SweptObject = TypedDict(
    "SweptObject",
    {
        "id": int,
        "class": str,
        "kind": str,
        "origin": str,
        "track_token": str,
        "world_from_body": Matrix4,
        "size_m": list[float],
        "points": int,
    },
)
"""An object in `sweep.json`."""


class SweepTable(TypedDict):
    """`sweep.json`."""

    scene: str
    dataset: str
    place: str
    variation: int
    keyframe: int
    keyframe_token: str
    keyframe_time_ns: int
    recorded_keyframe: int | None
    view: str
    time_ns: int
    begins_s: float
    sweep_s: float
    lidar: str
    elevations_deg: list[float]
    columns: int
    returns: str
    points: int
    world_from_lidar: Matrix4
    world_from_ego: Matrix4 | None
    carrier: int | None
    projection: dict[str, Any]
    seed: int
    objects: list[SweptObject]


def read_manifest(root: Path) -> Manifest:
    """The manifest of an output folder; another version of the format is an error."""
    path = root / "manifest.json"
    manifest: Manifest = _read(path)
    found = manifest.get("format", "none")
    if found != FORMAT:
        remedy = "generate the folder again, or use that version of trove"
        raise TroveError(f"{path}: expected format {FORMAT}, found {found}; {remedy}")
    return manifest


def read_frame(folder: Path) -> FrameTable:
    """The table of the frame in `folder`."""
    table: FrameTable = _read(folder / "frame.json")
    return table


def read_sweep(folder: Path) -> SweepTable:
    """The table of the LiDAR sweep in `folder`."""
    table: SweepTable = _read(folder / "sweep.json")
    return table


def read_curated(path: Path) -> dict[str, list[str]]:
    """A list of `trove curate`: the paths of frames for `train` and `val`, and those left out between them (`gap`)."""
    frames: dict[str, list[str]] = _read(path)
    return frames


def _read(path: Path) -> Any:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as fault:
        raise TroveError(f"{path}: expected a file that can be read: {fault.strerror}") from fault
    except ValueError as fault:
        raise TroveError(f"{path}: expected JSON that trove wrote, found an error ({fault})") from fault
