"""A sheet of photographs and renders in random order, for someone who says which are which; see benches/README.md.

`blind_sheet.py RENDERS SHEET` takes twenty of the `rgb.png` below RENDERS and twenty photographs of CamVid, KITTI and
nuScenes from the folder in TROVE_TEST_DATA, all cut to 480×360. The answers go beside the sheet, as SHEET with the suffix
`.json`: true for a photograph.
"""

import json
import os
import random
import sys
from pathlib import Path

from PIL import Image, ImageDraw

SIZE_PX = (480, 360)
COLUMNS = 5
# How many of which photographs.
PHOTOGRAPHS = {
    "camvid/images/*/*.jpg": 9,
    "kitti/semantics/image_2/*.png": 3,
    "kitti/object/training/image_2/*.png": 2,
    "nuscenes/samples/CAM_*/*.jpg": 6,
}


def spread(files, count):
    """So many files, evenly from a sorted list."""
    if len(files) < count:
        raise SystemExit(f"expected {count} pictures, found {len(files)}")
    return [files[i * len(files) // count] for i in range(count)]


def cut(file):
    """The middle of a picture, at the sheet's size."""
    image = Image.open(file).convert("RGB")
    scale = max(SIZE_PX[0] / image.width, SIZE_PX[1] / image.height)
    image = image.resize((round(image.width * scale), round(image.height * scale)), Image.Resampling.LANCZOS)
    left, top = (image.width - SIZE_PX[0]) // 2, (image.height - SIZE_PX[1]) // 2
    return image.crop((left, top, left + SIZE_PX[0], top + SIZE_PX[1]))


def main():
    """Makes the sheet and its answers."""
    renders, sheet = map(Path, sys.argv[1:])
    data = Path(os.environ["TROVE_TEST_DATA"])
    photographs = [file for glob, count in PHOTOGRAPHS.items() for file in spread(sorted(data.glob(glob)), count)]
    drawn = spread(sorted(renders.rglob("rgb.png")), len(photographs))
    pictures = [(file, True) for file in photographs] + [(file, False) for file in drawn]
    random.Random(2611).shuffle(pictures)
    rows = -(-len(pictures) // COLUMNS)
    page = Image.new("RGB", (COLUMNS * SIZE_PX[0], rows * SIZE_PX[1]))
    write = ImageDraw.Draw(page)
    for i, (file, _) in enumerate(pictures):
        at = (i % COLUMNS * SIZE_PX[0], i // COLUMNS * SIZE_PX[1])
        page.paste(cut(file), at)
        write.rectangle((at[0], at[1], at[0] + 34, at[1] + 22), fill="black")
        write.text((at[0] + 6, at[1] + 4), str(i + 1), fill="white", font_size=16)
    page.save(sheet)
    answers = {str(i + 1): is_photograph for i, (_, is_photograph) in enumerate(pictures)}
    sheet.with_suffix(".json").write_text(json.dumps(answers, indent=1) + "\n")


if __name__ == "__main__":
    main()
