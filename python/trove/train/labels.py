"""Maps the label ids of every dataset, using the tables that the program itself reads.

A target is a list of classes; a network predicts their indices, and `IGNORED` is left out of loss and metrics.
"""

import csv
from functools import cache

import numpy as np

from trove._trove import label_table

IGNORED = 255

# CamVid's poles and signs are one, as in the native classes and the paper's.
_MERGED = {"sign": "pole"}


def _rows(label_set: str) -> list[dict[str, str]]:
    table = label_table(label_set) or ""
    return list(csv.DictReader(table.splitlines(), delimiter="\t", quoting=csv.QUOTE_NONE))


def _counted(label_set: str) -> list[str]:
    """The names of the classes that count, ordered by training id."""
    rows = [row for row in _rows(label_set) if int(row["train_id"]) != IGNORED]
    return [row["name"] for row in sorted(rows, key=lambda row: int(row["train_id"]))]


CAMVID = list(dict.fromkeys(_MERGED.get(name, name) for name in _counted("camvid")))
PAPER = _counted("trove13")
IDD_LITE = _counted("idd-lite")

TARGETS = {"camvid": CAMVID, "paper": PAPER, "idd-lite": IDD_LITE}
# Networks that find boxes, and what they find of a target's classes.
DETECTED = {
    "camvid": {"vehicle": ["car"], "person": ["pedestrian"], "cyclist": ["bicyclist"]},
    "paper": {"vehicle": ["car", "bus", "truck"], "person": ["person"], "rider": ["rider"]},
    "idd-lite": {"vehicle": ["vehicle"], "living thing": ["living thing"]},
}
DETECTORS = ("ssdlite",)
# The label set whose names a target's are.
SETS = {"camvid": "camvid", "paper": "trove13", "idd-lite": "idd-lite"}
# The classes of trees, and of what is seen between their twigs.
CROWNS = {
    "camvid": (CAMVID.index("tree"), CAMVID.index("sky"), CAMVID.index("building")),
    "paper": (PAPER.index("vegetation"), PAPER.index("sky"), PAPER.index("building")),
    "idd-lite": (IDD_LITE.index("far object"), IDD_LITE.index("sky"), IDD_LITE.index("far object")),
}
# The table of each numbering and the column that holds its numbers.
_NUMBERINGS = {
    "native": ("trove20", "id"),
    "trove13": ("trove13", "id"),
    "camvid": ("camvid", "id"),
    "idd-lite": ("idd-lite", "id"),
    "cityscapes": ("cityscapes", "id"),
    "cityscapes-train": ("cityscapes", "train_id"),
}


@cache
def lookup(numbering: str, target: str) -> np.ndarray:
    """The target's index for each of 256 ids, `uint8`; `IGNORED` if it has none.

    `numbering` is `native` (class.png), `trove13`, `camvid`, `idd-lite`, `cityscapes` (ids) or `cityscapes-train` (trainIds, which KITTI-STEP
    shares). Raises `ValueError` for a numbering that has no counterpart in the target.
    """
    label_set, column = _NUMBERINGS.get(numbering, ("", ""))
    rows = _rows(label_set) if label_set else []
    # A set names its classes in a column for each other set that it has a counterpart in.
    names = "name" if label_set == SETS[target] else SETS[target]
    if not rows or names not in rows[0]:
        raise ValueError(f"labels numbered as {numbering} cannot be converted to the classes {target}")
    classes = TARGETS[target]
    table = np.full(256, IGNORED, np.uint8)
    for row in rows:
        name = _MERGED.get(row[names], row[names]) if target == "camvid" else row[names]
        if name in classes and int(row[column]) != IGNORED:
            table[int(row[column])] = classes.index(name)
    return table
