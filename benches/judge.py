"""Measures `trove evaluate` and `trove recolor` on pictures that it makes up; it needs no data.

`judge.py [--trove PROGRAM]`: 500 pairs of labels of 2048×1024, then 100 pictures of 1600×900.
"""

import argparse
import os
import resource
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
from PIL import Image

DISTINCT = 10


def field(random, width, height, cells):
    """A smooth random field, 0 to 1."""
    coarse = Image.fromarray(random.random((cells // 2, cells)).astype(np.float32))
    return np.asarray(coarse.resize((width, height), Image.Resampling.BICUBIC))


def repeat(folder, name, made, count):
    """So many names for few files."""
    folder.mkdir(parents=True, exist_ok=True)
    for i in range(count):
        os.link(made[i % len(made)], folder / name.format(i))


def labels(folder):
    """500 pairs: the truth has patches of all of Cityscapes' classes, predictions have outlines that are a little off."""
    random = np.random.default_rng(1)
    ids = np.array([7, 8, 11, 12, 13, 17, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 31, 32, 33, 0], np.uint8)
    made = {"truth": [], "predicted": []}
    for i in range(DISTINCT):
        fields = [field(random, 2048, 1024, 24) for _ in ids]
        for side, off in [("truth", 0.0), ("predicted", 0.15)]:
            shown = np.stack([f + off * field(random, 2048, 1024, 40) for f in fields])
            path = folder / f"{side}{i}.png"
            Image.fromarray(ids[shown.argmax(0)]).save(path)
            made[side].append(path)
    for side, files in made.items():
        repeat(folder / side, "made_{:06}_000019_gtFine_labelIds.png", files, 500)


def pictures(folder):
    """100 pictures with the detail and the grain of rendered ones, and 20 in other colours."""
    random = np.random.default_rng(2)
    for side, size, count, low, high in [("source", (1600, 900), 100, 20, 200), ("target", (480, 360), 20, 60, 250)]:
        made = []
        for i in range(DISTINCT):
            planes = [field(random, *size, 12) + 0.4 * field(random, *size, 160) for _ in range(3)]
            grain = random.normal(0, 2, (size[1], size[0], 3))
            path = folder / f"{side}{i}.png"
            Image.fromarray(
                (low + (high - low) * np.stack(planes, -1) / 1.4 + grain).clip(0, 255).astype(np.uint8)
            ).save(path)
            made.append(path)
        repeat(folder / side, "{:06}.png", made, count)


def timed(*command):
    """How long a command takes, and its processors' time, which others on the machine change less."""
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])  # noqa: E731
    started, before = time.monotonic(), used()
    subprocess.run([str(part) for part in command], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return f"{time.monotonic() - started:.1f} s, {used() - before:.1f} s of processors' time"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trove", default="trove", help="the program")
    trove = parser.parse_args().trove
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        labels(folder)
        for extra in [[], ["--boundary"]]:
            taken = timed(trove, "evaluate", folder / "predicted", folder / "truth", "--classes", "cityscapes", *extra)
            print(f"500 pairs of 2048×1024 {' '.join(extra)}: {taken}")
        pictures(folder)
        for method in ["set", "picture"]:
            for space in ["lab", "l-alpha-beta"]:
                command = [
                    trove,
                    "recolor",
                    folder / "source",
                    "--to",
                    folder / "target",
                    "--method",
                    method,
                    "--space",
                    space,
                ]
                taken = timed(*command, "--out", folder / method / space)
                print(f"100 pictures of 1600×900, --method {method} --space {space}: {taken}")


if __name__ == "__main__":
    main()
