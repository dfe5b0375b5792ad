"""What frames are worth on places that nothing of was seen, from nothing: frames, colours of each fold, training, tables.

Every step finishes what is missing and redoes nothing, so that the same command goes on after an interruption.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

from trove.train.experiment import Experiment, Trial, read

HERE = Path(__file__).resolve().parent
OUT = HERE / "out"


def targets(experiment: Experiment) -> Path:
    """A folder of links to what a fold trains on, and to nothing that it is measured on or chooses by."""
    folder = OUT / "targets" / experiment.trial.fold
    folder.mkdir(parents=True, exist_ok=True)
    for sample in experiment.pools["R"].samples:
        link = folder / sample.picture.name
        link.unlink(missing_ok=True)
        link.symlink_to(sample.picture.resolve())
    return folder


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], epilog="Example: run.py --data ~/datasets --only camvid"
    )
    parser.add_argument("--data", type=Path, required=True, help="folder with osm, camvid and idd-lite in it")
    parser.add_argument("--only", choices=["camvid", "idd-lite"], help="one of the two experiments")
    parser.add_argument("--rows", nargs="*", default=[], help="only these rows of the tables")
    parser.add_argument("--threads", type=int, default=1, help="threads on the CPU for each network; 0 is all")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="groups of rows that are trained at once")
    options = parser.parse_args()
    experiments = {"camvid": "britain", "idd-lite": "india"}
    chosen = [options.only] if options.only else list(experiments)
    for name in ("osm", *chosen):
        if not (options.data / name).is_dir():
            print(
                f"error: {options.data}: expected a folder {name}, found none; see docs/experiment.md", file=sys.stderr
            )
            return 1
    link = HERE / "data"
    link.unlink(missing_ok=True)
    link.symlink_to(options.data.resolve())

    def run(*step: object) -> bool:
        print("+", *step, flush=True)
        return subprocess.run([str(part) for part in step]).returncode == 0

    trove = [sys.executable, "-m", "trove"]
    for name in chosen:
        places = [path for path in sorted((HERE / experiments[name]).glob("*.toml")) if path.stem != "camera"]
        frames = OUT / experiments[name]
        file = HERE / f"{name}.toml"
        if not all(run(*trove, "generate", place, "--out", frames / place.stem) for place in places):
            return 1
        for fold in read(file).folds if name == "camvid" else ():
            to = ["--to", targets(read(file, Trial(fold))), "--method", "paired", "--strength", 1]
            colours = OUT / "recolored" / fold
            if not all(run(*trove, "recolor", frames / p.stem, *to, "--out", colours / p.stem) for p in places):
                return 1
        how = ["--threads", options.threads, "--jobs", options.jobs]
        rows = ["--rows", *options.rows] if options.rows else []
        if not run(sys.executable, "-m", "trove.train", file, "--out", OUT / "results" / name, *how, *rows):
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
