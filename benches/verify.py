"""How many frames a second `trove verify --labels` looks at, and how fast OpenEXR and Pillow read the same files.

    make bench-verify            # or: python benches/verify.py --trove .venv/bin/trove [OUT]

Without OUT, the labels of the demo's drive are generated at 1600×900 first. Both sides take turns, and the best round of
each counts. Frames a second of both cores come from processor time: those of wall time depend on what else runs.
"""

import argparse
import resource
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

ROUNDS = 5
CORES = 2
# The demo of demo/mod.rs, larger, at all its moments, without light.
OLD, NEW = "keyframes = [2]", 'keyframes = "all"'
OLD_RENDER, NEW_RENDER = "scale = 0.5\nspp = 16", "light = false"


def generated(trove, folder):
    """A run of the demo's drive at full size."""
    demo = subprocess.Popen([trove, "demo", "--out", folder / "demo"], stderr=subprocess.DEVNULL)
    source = folder / "demo" / ".trove" / "demo"
    while not (source / "recipe.toml").exists() and demo.poll() is None:
        time.sleep(0.05)
    demo.kill()
    demo.wait()
    text = (source / "recipe.toml").read_text()
    assert OLD in text and OLD_RENDER in text, "the demo's recipe is another now"
    recipe = source / "large.toml"
    recipe.write_text(text.replace(OLD, NEW).replace(OLD_RENDER, NEW_RENDER))
    subprocess.run([trove, "generate", recipe, "--out", folder / "out"], check=True, stderr=subprocess.DEVNULL)
    return folder / "out"


def read(path):
    """All values of a file."""
    if path.suffix == ".png":
        return np.asarray(Image.open(path))
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return [channel.pixels for channel in file.channels().values()]


def plain(files):
    """Seconds of wall and of processor time that reading files takes."""
    started, before = time.perf_counter(), time.process_time()
    for path in files:
        read(path)
    return time.perf_counter() - started, time.process_time() - before


def ours(trove, folder):
    """The same of `trove verify --labels`."""
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [trove, "verify", folder, "--labels"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall_s, after = time.perf_counter() - started, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall_s, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main():
    """Makes frames where none are given, and prints both sides' rates."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trove", type=Path, required=True)
    parser.add_argument("out", type=Path, nargs="?", help="output folder of trove generate")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.out or generated(options.trove.resolve(), Path(temporary))
        frames = sorted(table.parent for table in folder.rglob("frame.json"))
        files = [path for frame in frames for path in sorted(frame.iterdir()) if path.suffix in (".png", ".exr")]
        rounds = [(ours(options.trove, folder), plain(files)) for _ in range(ROUNDS)]
    count = len(frames)
    print(f"{count} frames, {len(files)} files")
    for i, name in enumerate(["trove verify --labels", "OpenEXR and Pillow, one thread"]):
        wall_s, cpu_s = (min(sides[i][part] for sides in rounds) for part in range(2))
        print(
            f"{name:31} {count / wall_s:6.1f} frames/s, {1000 * cpu_s / count:6.1f} ms of processor time a frame:"
            f" {CORES * count / cpu_s:5.1f} frames/s of {CORES} idle cores"
        )


if __name__ == "__main__":
    main()
