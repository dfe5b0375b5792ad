"""Turns a CSV of vehicle poses and one of boxes into a drive that `trove` reads (docs/plain-drive.md).

    python examples/convert_csv.py poses.csv boxes.csv --origin 49.0094 8.4044 --out my-recordings/monday

poses.csv has the columns time_s, x_m, y_m, z_m, yaw_rad: the middle of the rear axle, on the ground, in metres east and
north of the origin, one row a keyframe. boxes.csv has time_s (that of a keyframe), track, kind, x_m, y_m, z_m (the box's
centre), yaw_rad, length_m, width_m, height_m. Change `read_*` to what your recordings look like. Needs nothing but Python.
"""

import argparse
import csv
import json
from collections import defaultdict
from pathlib import Path
from typing import Any


def read_rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def read_pose(row: dict[str, str]) -> dict[str, object]:
    return {"translation_m": [float(row[key]) for key in ("x_m", "y_m", "z_m")], "yaw_rad": float(row["yaw_rad"])}


def read_box(row: dict[str, str]) -> dict[str, object]:
    return {
        "track": row["track"],
        "kind": row["kind"],
        "size_m": [float(row[key]) for key in ("length_m", "width_m", "height_m")],
        "world_from_body": read_pose(row),
    }


def time_ns(row: dict[str, str]) -> int:
    """Nanoseconds, without the rounding of a float that counts seconds since 1970."""
    seconds, _, fraction = row["time_s"].partition(".")
    return int(seconds) * 1_000_000_000 + int(fraction.ljust(9, "0")[:9] or 0)


def convert(poses: list[dict[str, str]], boxes: list[dict[str, str]], origin: tuple[float, float]) -> dict[str, Any]:
    """The drive as `drive.json` has it."""
    boxes_at = defaultdict(list)
    for row in boxes:
        boxes_at[time_ns(row)].append(read_box(row))
    keyframes = [
        {"time_ns": time_ns(row), "world_from_ego": read_pose(row), "boxes": boxes_at.pop(time_ns(row), [])}
        for row in sorted(poses, key=time_ns)
    ]
    if boxes_at:
        raise SystemExit(f"{sum(map(len, boxes_at.values()))} boxes at times at which there is no pose")
    # One camera behind the windscreen that looks ahead; put your own calibration here.
    front = {"width_px": 1600, "height_px": 900, "fx_px": 1142.5, "ego_from_camera": {"translation_m": [1.7, 0.0, 1.5]}}
    return {
        "trove_drive": 1,
        "georeference": {"local": {"origin_lat_deg": origin[0], "origin_lon_deg": origin[1]}},
        "cameras": {"front": front},
        "keyframes": keyframes,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("poses", type=Path)
    parser.add_argument("boxes", type=Path)
    parser.add_argument("--origin", type=float, nargs=2, required=True, metavar=("LAT", "LON"), help="degrees, WGS84")
    parser.add_argument("--out", type=Path, required=True, help="the drive's folder")
    arguments = parser.parse_args()
    drive = convert(read_rows(arguments.poses), read_rows(arguments.boxes), tuple(arguments.origin))
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / "drive.json").write_text(json.dumps(drive, indent=1) + "\n")
    print(f"{len(drive['keyframes'])} keyframes in {arguments.out}; check them with: trove inspect {arguments.out}")


if __name__ == "__main__":
    main()
