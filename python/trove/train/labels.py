"""What the label numbers of every dataset become, in one table.

A target is a list of classes; a network predicts their indices, and `IGNORED` is left out of loss and metrics.
"""

import numpy as np

IGNORED = 255

# CamVid's 11, with pole and sign as one as in the native classes and the paper's.
_CAMVID_IDS = ["sky", "building", "pole", "road", "pavement", "tree", "pole", "fence", "car", "pedestrian", "bicyclist"]
CAMVID = list(dict.fromkeys(_CAMVID_IDS))
PAPER = [
    "car", "bus", "truck", "person", "rider", "road", "sidewalk", "building", "traffic_pole", "vegetation", "terrain", "sky",
]  # fmt: skip

TARGETS = {"camvid": CAMVID, "paper": PAPER}
# The classes of trees, and of what is seen between their twigs.
CROWNS = {
    "camvid": (CAMVID.index("tree"), CAMVID.index("sky"), CAMVID.index("building")),
    "paper": (PAPER.index("vegetation"), PAPER.index("sky"), PAPER.index("building")),
}

# Native class id -> (CamVid class, paper's class); "" is ignored. The same rows as `CLASSES` in trove-model.
_NATIVE = {
    1: ("sky", "sky"), 2: ("car", "car"), 3: ("car", "bus"), 4: ("car", "car"), 5: ("car", "truck"), 6: ("car", "car"),
    7: ("pedestrian", "person"), 8: ("building", "building"), 9: ("road", "road"), 10: ("fence", ""),
    11: ("tree", "terrain"), 12: ("bicyclist", "rider"), 13: ("car", "truck"), 14: ("tree", "vegetation"),
    15: ("tree", "vegetation"), 16: ("", "rider"), 17: ("", "traffic_pole"),
    18: ("pole", "traffic_pole"), 19: ("pavement", "sidewalk"),
}  # fmt: skip

# Cityscapes id -> paper's class; two-wheelers belong to their riders, as in our own labels.
_CITYSCAPES = {
    7: "road", 8: "sidewalk", 11: "building", 17: "traffic_pole", 19: "traffic_pole", 20: "traffic_pole",
    21: "vegetation", 22: "terrain", 23: "sky", 24: "person", 25: "rider", 26: "car", 27: "truck", 28: "bus",
    32: "rider", 33: "rider",
}  # fmt: skip
_CITYSCAPES_TRAIN = {
    0: "road", 1: "sidewalk", 2: "building", 5: "traffic_pole", 6: "traffic_pole", 7: "traffic_pole", 8: "vegetation",
    9: "terrain", 10: "sky", 11: "person", 12: "rider", 13: "car", 14: "truck", 15: "bus", 17: "rider", 18: "rider",
}  # fmt: skip


def lookup(numbering: str, target: str) -> np.ndarray:
    """The target's index for each of 256 numbers, `uint8`; `IGNORED` where it has none.

    `numbering` is `native` (class.png), `camvid`, `cityscapes` (ids) or `cityscapes-train` (trainIds, which KITTI-STEP
    shares). Raises `ValueError` for a numbering that has no counterpart in the target.
    """
    classes = TARGETS[target]
    if numbering == "native":
        names = {number: row[0 if target == "camvid" else 1] for number, row in _NATIVE.items()}
    elif numbering == "camvid" and target == "camvid":
        names = dict(enumerate(_CAMVID_IDS))
    elif numbering in ("cityscapes", "cityscapes-train") and target == "paper":
        names = _CITYSCAPES if numbering == "cityscapes" else _CITYSCAPES_TRAIN
    else:
        raise ValueError(f"labels numbered as {numbering} cannot be turned into the classes {target}")
    table = np.full(256, IGNORED, np.uint8)
    for number, name in names.items():
        if name:
            table[number] = classes.index(name)
    return table
