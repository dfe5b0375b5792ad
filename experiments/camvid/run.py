"""The paper's experiment on CamVid from nothing: labels, choice, pictures, colours, training, table.

Every step finishes what is missing and redoes nothing, so that the same command goes on after an interruption.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
# Frames to train on, of those that the recipe offers.
COUNT = 640


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], epilog="Example: run.py --data ~/datasets --rows P 'S+P[M]'"
    )
    parser.add_argument("--data", type=Path, required=True, help="folder with nuscenes, osm and camvid in it")
    parser.add_argument("--rows", nargs="*", default=[], help="only these rows of the table")
    parser.add_argument("--threads", type=int, default=1, help="threads on the CPU for each network; 0 is all")
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count(), help="seeds and rows that are trained at the same time; 1 for a GPU"
    )
    options = parser.parse_args()
    for name in ("nuscenes", "osm", "camvid"):
        if not (options.data / name).is_dir():
            print(
                f"error: {options.data}: expected a folder {name}, found none; see docs/experiment.md", file=sys.stderr
            )
            return 1
    link = HERE / "data"
    link.unlink(missing_ok=True)
    link.symlink_to(options.data.resolve())
    out = HERE / "out"
    recipe, labels, twin, chosen = HERE / "recipe.toml", out / "labels", out / "twin", out / "curated.json"
    trove = [sys.executable, "-m", "trove"]
    train = [sys.executable, "-m", "trove.train", "--threads", options.threads, "--jobs", options.jobs]
    rows = ["--rows", *options.rows] if options.rows else []
    steps = [
        [*trove, "generate", recipe, "--labels-only", "--out", labels],
        [
            *trove,
            "curate",
            labels,
            "--count",
            COUNT,
            "--classes",
            "camvid",
            "--val-share",
            0,
            "--out",
            chosen,
            "--page",
            out / "curated.html",
        ],
        [*trove, "generate", recipe, "--frames", chosen, "--out", twin],
        [
            *trove,
            "recolor",
            twin,
            "--to",
            link / "camvid/images/train",
            "--method",
            "paired",
            "--strength",
            1,
            "--out",
            out / "recolored",
        ],
        [*train, HERE / "experiment.toml", "--out", out / "results", *rows],
        [*train, HERE / "control.toml", "--out", out / "control"],
    ]
    for step in steps:
        print("+", *step, flush=True)
        done = subprocess.run([str(part) for part in step]).returncode
        if done:
            return done
    return 0


if __name__ == "__main__":
    sys.exit(main())
