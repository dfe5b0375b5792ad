"""Reads the frames of an output folder: prints every visible object with its range and draws its 2D box.

    python examples/read_frames.py demo-out --out boxes

Needs numpy, Pillow and OpenEXR (`pip install 'trove-scenes[test]'` brings them).
"""

import argparse
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image, ImageDraw
from trove.format import ObjectRow, read_frame, read_manifest


def read_depth(path: Path) -> np.ndarray:
    """Metres along the camera's z axis, height × width; infinite where the sky is."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        depth: np.ndarray = file.channels()["Y"].pixels
    return depth


def describe(row: ObjectRow, instances: np.ndarray, depth_m: np.ndarray) -> str:
    """One line on an object of which pixels are seen; `range_m` goes to its box's centre, depth to what is seen of it."""
    nearest_m = depth_m[instances == row["id"]].min()
    return (
        f"  {row['id']:5} {row['kind']:24} {row['range_m']:6.1f} m, nearest pixel at depth {nearest_m:6.1f} m, "
        f"{row['visible_px']:6} px, {row['occlusion']:4.0%} hidden"
    )


def draw_boxes(picture: Image.Image, rows: list[ObjectRow]) -> None:
    """Draws the boxes of what is seen, the nearest last."""
    draw = ImageDraw.Draw(picture)
    for row in sorted(rows, key=lambda row: -row["range_m"]):
        box = row["visible_box"]
        if box is not None:
            draw.rectangle(tuple(box), outline=(255, 200, 0))
            draw.text((box[0] + 2, box[1] + 1), f"{row['class']} {row['range_m']:.0f} m", fill=(255, 200, 0))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="output folder of trove demo or trove generate")
    parser.add_argument("--out", type=Path, default=Path("boxes"), help="folder for the pictures with boxes")
    parser.add_argument("--min-px", type=int, default=20, help="leave out objects of which fewer pixels are seen")
    arguments = parser.parse_args()

    manifest = read_manifest(arguments.folder)
    names = {row["id"]: row["name"] for row in manifest["classes"]}
    for frame in manifest["frames"]:
        folder = arguments.folder / frame["path"]
        table = read_frame(folder)
        classes = np.asarray(Image.open(folder / "class.png"))
        instances = np.asarray(Image.open(folder / "instance.png"))
        depth_m = read_depth(folder / "depth.exr")

        ids, counts = np.unique(classes, return_counts=True)
        shares = sorted(zip(counts / classes.size, (names[i] for i in ids)), reverse=True)
        print(f"{frame['path']}: " + ", ".join(f"{name} {share:.0%}" for share, name in shares[:4]))
        rows = [row for row in table["objects"] if row["visible_px"] >= arguments.min_px and row["track_token"]]
        for row in sorted(rows, key=lambda row: row["range_m"]):
            print(describe(row, instances, depth_m))

        if "rgb.png" in frame["files"]:
            picture = Image.open(folder / "rgb.png").convert("RGB")
            draw_boxes(picture, rows)
            path = arguments.out / (frame["path"].replace("/", "_") + ".png")
            path.parent.mkdir(parents=True, exist_ok=True)
            picture.save(path)


if __name__ == "__main__":
    main()
