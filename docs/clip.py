"""Makes docs/clip.webp, what README shows of a drive with its labels, from the demo's recording; see the Makefile."""

import subprocess
import sys
import tempfile
from pathlib import Path

import trove
from PIL import Image, ImageDraw

RECIPE = """seed = 7
[drive]
dataset = "nuscenes"
root = "{demo}/nuscenes"
scenes = ["demo-0001"]
keyframes = "all"
[time]
rate_hz = {rate_hz}
[map]
osm = "{demo}/crossing.osm"
[views]
rig = "CAM_FRONT"
[render]
size = [432, 243]
spp = 16
"""
RATE_HZ = 12


def main():
    demo, clip = Path(sys.argv[1]) / ".trove/demo", sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        recipe, out = Path(folder) / "clip.toml", Path(folder) / "out"
        recipe.write_text(RECIPE.format(demo=demo.absolute(), rate_hz=RATE_HZ))
        subprocess.run([sys.executable, "-m", "trove", "generate", recipe, "--out", out], check=True)
        # The last moment has no flow.
        pictures = [of(frame) for frame in list(trove.open(out))[:-1]]
    # There and back, so that it does not jump.
    pictures += pictures[-2:0:-1]
    first, *others = pictures
    first.save(clip, save_all=True, append_images=others, duration=1000 // RATE_HZ, loop=0, quality=70, method=6)


def of(frame):
    """The picture of a moment beside its labels."""
    height, width, _ = frame.rgb.shape
    page = Image.new("RGB", (2 * width + 4, 2 * height + 4), "white")
    draw = ImageDraw.Draw(page)
    tiles = [("RGB", frame.rgb), ("class", frame.overlay("class").array)]
    tiles += [("depth", frame.overlay("depth", 1).array), ("optical flow", frame.overlay("flow_forward", 1).array)]
    for k, (name, tile) in enumerate(tiles):
        at = (k % 2 * (width + 4), k // 2 * (height + 4))
        page.paste(Image.fromarray(tile), at)
        draw.text((at[0] + 8, at[1] + 6), name, fill="white", stroke_fill="black", stroke_width=1, font_size=14)
    return page


if __name__ == "__main__":
    main()
