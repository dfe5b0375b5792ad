"""The paper's experiment from nothing, on CamVid, Cityscapes or KITTI-STEP: labels, choice, pictures, colours, training, table.

Every step finishes what is missing and redoes nothing, so that the same command goes on after an interruption.
"""

import argparse
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from trove.train.experiment import read

HERE = Path(__file__).resolve().parent


@dataclass(frozen=True)
class Choice:
    """How many frames experiments train on, and by which classes they are chosen."""

    recipe: str
    count: int
    classes: str
    experiments: tuple[str, ...]
    # What it cannot do without, in the data's folder.
    needs: tuple[str, ...]


CHOICES = {
    "camvid": Choice("camvid-frames", 640, "camvid", ("camvid", "camvid-longer"), ("camvid",)),
    "cityscapes": Choice("frames", 5000, "trove13", ("cityscapes",), ("cityscapes", "resnet50.pth")),
    "kitti-step": Choice("frames", 5000, "trove13", ("kitti-step",), ("kitti-step", "resnet50.pth")),
}


def steps(name: str, options: argparse.Namespace) -> Iterator[list[object]]:
    """The commands of an experiment, in order; each is asked for once those before it are done."""
    choice, out = CHOICES[name], HERE / "out" / name
    recipe, labels, frames, chosen = (
        HERE / f"{choice.recipe}.toml",
        out / "labels",
        out / "frames",
        out / "curated.json",
    )
    trove = [sys.executable, "-m", "trove"]
    by = ["--count", choice.count, "--classes", choice.classes, "--val-share", 0]
    yield [*trove, "generate", recipe, "--labels-only", "--out", labels]
    yield [*trove, "curate", labels, *by, "--out", chosen, "--page", out / "curated.html"]
    yield [*trove, "generate", recipe, "--frames", chosen, "--out", frames]
    real = read(HERE / f"{choice.experiments[0]}.toml").pools["R"].linked(out / "targets")
    to = ["--to", real, "--method", "paired", "--strength", 1]
    yield [*trove, "recolor", frames, *to, "--out", out / "recolored"]
    how = ["--threads", options.threads, "--jobs", options.jobs]
    for file in choice.experiments:
        rows = [row for row in options.rows if row in read(HERE / f"{file}.toml").rows]
        if options.rows and not rows:
            continue
        only = ["--rows", *rows] if rows else []
        train = [sys.executable, "-m", "trove.train", HERE / f"{file}.toml", "--out", out / "results" / file]
        yield [*train, *how, *only]


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], epilog="Example: run.py --data ~/datasets --rows P 'S+P[M]'"
    )
    parser.add_argument(
        "--data", type=Path, required=True, help="folder with nuscenes, osm and the real pictures in it"
    )
    parser.add_argument("--only", choices=CHOICES, default="camvid", help="what real pictures [default: camvid]")
    parser.add_argument("--rows", nargs="*", default=[], help="only these rows of the table")
    parser.add_argument("--threads", type=int, default=1, help="threads on the CPU for each network; 0 is all")
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count(), help="seeds and rows that are trained at the same time; 1 for a GPU"
    )
    options = parser.parse_args()
    for name in ("nuscenes", "osm", *CHOICES[options.only].needs):
        if not (options.data / name).exists():
            print(f"error: {options.data}: expected {name}, found none; see docs/experiment.md", file=sys.stderr)
            return 1
    link = HERE / "data"
    link.unlink(missing_ok=True)
    link.symlink_to(options.data.resolve())
    for step in steps(options.only, options):
        print("+", *step, flush=True)
        done = subprocess.run([str(part) for part in step]).returncode
        if done:
            return done
    return 0


if __name__ == "__main__":
    sys.exit(main())
