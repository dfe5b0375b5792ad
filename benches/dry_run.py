"""What `trove generate --dry-run` tells of a recipe, and what the run then takes; see benches/README.md."""

import argparse
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

RECIPE = """
seed = 7
[drive]
dataset = "nuscenes"
root = "{data}/nuscenes"
scenes = ["{scene}"]
keyframes = {keyframes}
[map]
osm = "{data}/osm/{place}.osm"
[render]
{render}
"""
RECIPES = {
    "scene-0103, 24 frames, 800×450, 16 spp": (
        "scene-0103",
        "boston-seaport",
        "[10, 11, 12, 13]",
        "scale = 0.5\nspp = 16",
    ),
    "scene-0061, 12 frames, 400×225, 16 spp": ("scene-0061", "singapore-onenorth", "[0, 13]", "scale = 0.25\nspp = 16"),
    "scene-0061, 24 frames, 1600×900, labels": ("scene-0061", "singapore-onenorth", "[0, 9, 18, 27]", "light = false"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trove", default=".venv/bin/trove")
    parser.add_argument("--only", default="", help="recipes whose name has this in it")
    options = parser.parse_args()
    data = os.environ.get("TROVE_TEST_DATA")
    if data is None:
        parser.error("TROVE_TEST_DATA: expected the folder with real data, found nothing set")
    for name, (scene, place, keyframes, render) in RECIPES.items():
        if options.only not in name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            recipe, out = Path(folder) / "recipe.toml", Path(folder) / "out"
            recipe.write_text(
                RECIPE.format(data=Path(data).absolute(), scene=scene, place=place, keyframes=keyframes, render=render)
            )
            generate = [options.trove, "generate", recipe]
            told = json.loads(subprocess.check_output([*generate, "--dry-run", "--json"], stderr=subprocess.DEVNULL))
            begun = time.monotonic()
            subprocess.run([*generate, "--out", out], check=True, capture_output=True)
            seconds = time.monotonic() - begun
            paths = (path for path in out.rglob("*") if path.is_file() and ".trove" not in path.parts)
            written = sum(path.stat().st_size for path in paths)
        print(
            f"{name}: {told['seconds']:.0f} s told, {seconds:.0f} s taken ({told['seconds'] / seconds - 1:+.0%}); "
            f"{told['bytes'] / 1e6:.1f} MB told, {written / 1e6:.1f} MB written ({told['bytes'] / written - 1:+.0%})",
            flush=True,
        )


if __name__ == "__main__":
    main()
