"""Opens what `trove export --format nuimages` wrote, with the code of nuscenes-devkit.

    .venv-devkit/bin/python tests/devkit/check_nuimages.py EXPORTED --frames OUT

OUT is the folder that was exported. All tables load and all tokens lead somewhere; masks and boxes, as the devkit
decodes them, are the pixels of instance.png, and the drivable surface is that of class.png.

The exit status is 1 where a check fails.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from nuimages import NuImages
from nuimages.utils.utils import mask_decode
from PIL import Image

VERSION = "v1.0-trove"
ROAD = 9


def check_tokens(dataset):
    """Every token in every table leads to a row."""
    for name in dataset.table_names:
        for row in getattr(dataset, name):
            for key, value in row.items():
                if value and key.endswith("_token"):
                    table = key.removesuffix("_token")
                    dataset.get("sample_data" if table == "key_camera" else table, value)
            for token in row.get("attribute_tokens", []):
                dataset.get("attribute", token)


def check_masks(dataset, frames):
    """Compares all masks with the frames' labels; returns how many objects there are."""
    checked = 0
    for data in dataset.sample_data:
        folder = frames[(Path(dataset.dataroot) / data["filename"]).read_bytes()]
        instance, classes = (np.array(Image.open(folder / f"{name}.png")) for name in ("instance", "class"))
        road = np.zeros(classes.shape, bool)
        for row in dataset.surface_ann:
            if row["sample_data_token"] == data["token"]:
                road |= mask_decode(row["mask"]) > 0
        assert (road == (classes == ROAD)).all(), folder
        for row in dataset.object_ann:
            if row["sample_data_token"] != data["token"]:
                continue
            mask = mask_decode(row["mask"]) > 0
            (number,) = np.unique(instance[mask])
            assert number > 0 and (mask == (instance == number)).all(), (folder, number)
            y, x = np.nonzero(mask)
            assert row["bbox"] == [x.min(), y.min(), x.max() + 1, y.max() + 1], (folder, number)
            checked += 1
        # The devkit's own pictures of classes and objects, which draw the masks one over another.
        semantic, objects = dataset.get_segmentation(data["token"])
        assert (objects > 0).sum() == sum((instance == n).sum() for n in np.unique(instance[objects > 0]))
        assert semantic.shape == instance.shape
    return checked


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("exported", type=Path, help="folder that `trove export --format nuimages` wrote")
    parser.add_argument("--frames", type=Path, required=True, help="folder that was exported")
    options = parser.parse_args()
    dataset = NuImages(VERSION, str(options.exported), lazy=False, verbose=False)
    check_tokens(dataset)
    frames = {path.read_bytes(): path.parent for path in options.frames.glob("*/v*/k*/*/rgb.png")}
    checked = check_masks(dataset, frames)
    print(f"{len(dataset.sample)} pictures, {checked} objects")
    if not checked:
        sys.exit(f"{options.exported}: expected objects in view, found none")


if __name__ == "__main__":
    main()
