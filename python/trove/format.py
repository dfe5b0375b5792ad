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
    parts: list[dict[str, Any]]
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
        "world_from_asset": Matrix4 | None,
        "paint": list[int] | None,
        "velocity_mps": list[float] | None,
        "yaw_rate_radps": float | None,
        "states": list[str],
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


class RunLengths(TypedDict):
    """A mask of the whole image in COCO's compressed form, as `pycocotools.mask.decode` takes it."""

    size: list[int]
    counts: str


class MaskRow(TypedDict):
    """The masks of an object."""

    id: int
    visible: RunLengths
    amodal: RunLengths


class MaskTable(TypedDict):
    """`masks.json`."""

    objects: list[MaskRow]


class FrameTable(TypedDict):
    """`frame.json`; `drops` is present only if there are drops on the glass before the lens."""

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


class RadarTable(TypedDict):
    """`radar.json`."""

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
    cycle_s: float
    radar: str
    stands_mps: float
    detections: int
    world_from_radar: Matrix4
    world_from_ego: Matrix4
    velocity_mps: list[float]
    carrier: int | None
    projection: dict[str, Any]
    seed: int
    objects: list[SweptObject]


class GridClass(TypedDict):
    """What a number of cells means, in `grid.json`."""

    id: int
    name: str
    thing: bool
    rgb: list[int]


# In this form because `class` is a keyword.
GridObject = TypedDict(
    "GridObject",
    {
        "id": int,
        "class": str,
        "kind": str,
        "origin": str,
        "track_token": str,
        "world_from_body": Matrix4,
        "size_m": list[float],
        "velocity_mps": list[float] | None,
        "cells": int,
    },
)
"""An object in `grid.json`."""


class GridTable(TypedDict):
    """`grid.json`."""

    scene: str
    dataset: str
    place: str
    variation: int
    keyframe: int
    keyframe_token: str
    recorded_keyframe: int | None
    view: str
    time_ns: int
    preset: str
    form: str
    solid: bool
    low_m: list[float]
    voxel_m: float
    cells: list[int]
    world_from_grid: Matrix4
    world_from_ego: Matrix4
    carrier: int | None
    cameras: list[str]
    lidars: list[str]
    free: int
    classes: list[GridClass]
    map_layers: list[str]
    projection: dict[str, Any]
    objects: list[GridObject]


class EgoPose(TypedDict):
    """Where the vehicle is at a time, in `trajectory.json`."""

    time_ns: int
    world_from_ego_rotation_wxyz: list[float]
    world_from_ego_translation_m: list[float]


class EgoMoment(EgoPose):
    """The vehicle at a moment of its drive, in `trajectory.json`."""

    keyframe: int
    recorded_keyframe: int | None
    velocity_mps: list[float] | None
    yaw_rate_radps: float | None


class LaneRow(TypedDict):
    """A lane, in `lanes.json`."""

    id: int
    usage: str
    width_m: float
    centreline_m: list[list[float]]


class LineRow(TypedDict):
    """A painted line, in `lanes.json`."""

    id: int
    paint: str
    pattern: str
    width_m: float
    points_m: list[list[float]]


class KerbRow(TypedDict):
    """A kerb, in `lanes.json`."""

    id: int
    points_m: list[list[float]]


class LanesTable(TypedDict):
    """`lanes.json`."""

    scene: str
    dataset: str
    projection: dict[str, Any]
    lanes: list[LaneRow]
    lines: list[LineRow]
    kerbs: list[KerbRow]


class TrajectoryTable(TypedDict):
    """`trajectory.json`."""

    scene: str
    dataset: str
    projection: dict[str, Any]
    moments: list[EgoMoment]
    path: list[EgoPose]


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


def read_masks(folder: Path) -> MaskTable:
    """The masks of the frame in `folder`."""
    table: MaskTable = _read(folder / "masks.json")
    return table


def read_sweep(folder: Path) -> SweepTable:
    """The table of the LiDAR sweep in `folder`."""
    table: SweepTable = _read(folder / "sweep.json")
    return table


def read_grid(folder: Path) -> GridTable:
    """The table of the grid in `folder`."""
    table: GridTable = _read(folder / "grid.json")
    return table


def read_lanes(folder: Path) -> LanesTable:
    """The lanes and painted lines of the variation in `folder`."""
    table: LanesTable = _read(folder / "lanes.json")
    return table


def read_trajectory(folder: Path) -> TrajectoryTable:
    """The way of the vehicle in the variation's `folder`."""
    table: TrajectoryTable = _read(folder / "trajectory.json")
    return table


def read_radar(folder: Path) -> RadarTable:
    """The table of the radar's cycle in `folder`."""
    table: RadarTable = _read(folder / "radar.json")
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
