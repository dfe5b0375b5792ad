"""Holds the 2D boxes of rendered cars against those that KITTI's annotators drew.

    python tests/kitti/check_boxes.py LABELS OUT…

OUT is what `trove generate` wrote from KITTI's object or tracking benchmark, and LABELS the folder of its label files
(`label_2`, `label_02`). Every car that the annotators call whole and unhidden is looked up by its token in
`ego.image_02` of frames in the recording's size; compared are their rectangle and that of the rendered model's pixels
as if nothing hid it.

The exit status is 1 where the mean of their IoU is below 0.75, or nothing was compared.
"""

import json
import sys
from pathlib import Path

BAR = 0.75
FROM = ("type", "truncated", "occluded", "alpha", "left", "top", "right", "bottom")


def whole_cars(path):
    """The rectangles of a label file's whole, unhidden cars, by the numbers of their lines from 1."""
    cars = {}
    for number, line in enumerate(path.read_text().splitlines(), 1):
        words = line.split()
        row = dict(zip(FROM, words[2:] if words[0].isdigit() else words, strict=False))
        if row["type"] == "Car" and float(row["truncated"]) == 0 and int(row["occluded"]) == 0:
            # The centres of their pixels are at whole numbers.
            cars[number] = [float(row[side]) + 0.5 for side in FROM[4:]]
    return cars


def iou(a, b):
    """IoU of two boxes (x0, y0, x1, y1)."""
    both = max(0, min(a[2], b[2]) - max(a[0], b[0])) * max(0, min(a[3], b[3]) - max(a[1], b[1]))
    area = [(r[2] - r[0]) * (r[3] - r[1]) for r in (a, b)]
    return both / (sum(area) - both)


def compare(folder, labels):
    """The IoU of each car in a frame's folder, with its row in frame.json."""
    frame = json.loads((folder / "frame.json").read_text())
    cars = whole_cars(labels / f"{frame['scene']}.txt")
    for row in frame["objects"]:
        scene, _, number = row["token"].rpartition(":")
        if scene == frame["scene"] and int(number) in cars:
            x0, y0, x1, y1 = row["amodal_box"]
            yield iou([x0, y0, x1 + 1, y1 + 1], cars[int(number)]), row


def main():
    """Prints every car's IoU, and their mean."""
    labels, *outputs = map(Path, sys.argv[1:])
    found = []
    for folder in sorted(path for out in outputs for path in out.glob("*/v*/k*/ego.image_02")):
        for value, row in compare(folder, labels):
            print(f"{value:.3f} {row['token']} {row['asset']} at {row['range_m']:.0f} m")
            found.append(value)
    mean = sum(found) / max(len(found), 1)
    print(f"IoU {mean:.3f} in the mean of {len(found)} cars; expected at least {BAR}")
    return 0 if found and mean >= BAR else 1


if __name__ == "__main__":
    sys.exit(main())
