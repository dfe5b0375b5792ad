"""What frames are worth on places that nothing of was seen, from nothing: frames, colours of each fold, training, tables.

Every step finishes what is missing and redoes nothing, so that the same command goes on after an interruption.
`out/times.json` has the seconds that each step took altogether.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import town
from trove.train.experiment import Trial, read, tomllib

HERE = Path(__file__).resolve().parent
OUT = HERE / "out"


@dataclass(frozen=True)
class Frames:
    """What frames an experiment has: real pictures, a folder of recipes, and files of changes to all of them."""

    real: str
    recipes: str
    changes: tuple[str, ...] = ()
    # Whether its networks are small enough for a processor.
    small: bool = True


EXPERIMENTS = {
    "camvid": Frames("camvid", "britain", small=False),
    "idd-lite": Frames("idd-lite", "india", small=False),
    "camvid-small": Frames("camvid", "britain"),
    "idd-lite-small": Frames("idd-lite", "india"),
    "ablation-small": Frames(
        "camvid", "britain", ("none", "light", "traffic", "models", "textures", "sensor", "layout")
    ),
    "detection-small": Frames("camvid", "britain"),
}


def changed(recipes: Path, change: str) -> Path:
    """A folder of recipes like those in `recipes`, with what `changes/none.toml` and `changes/CHANGE.toml` say."""
    folder = OUT / "recipes" / f"{recipes.name}-{change}"
    folder.mkdir(parents=True, exist_ok=True)
    link(OUT / "recipes/data", HERE / "data")
    changes, own = (tomllib.loads((HERE / f"changes/{name}.toml").read_text()) for name in ("none", change))
    if "map" in own:
        middle = own["place"]["lat_deg"], own["place"]["lon_deg"]
        (folder / own["map"]["osm"]).write_text(town.osm(*middle))
    changes = merged(changes, own)
    for path in recipes.glob("*.toml"):
        if path.stem == "camera":
            shutil.copy(path, folder)
        else:
            (folder / path.name).write_text("".join(toml(merged(tomllib.loads(path.read_text()), changes))))
    return folder


def merged(table: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """A table with other values, those of its own tables merged likewise."""
    both = {key: merged(table.get(key, {}), value) for key, value in changes.items() if isinstance(value, dict)}
    return {**table, **changes, **both}


def toml(table: dict[str, Any], name: str = "") -> list[str]:
    """Lines of TOML: numbers, strings and lists are written as in JSON."""
    lines = [f"[{name}]\n"] if name else []
    lines += [f"{key} = {json.dumps(value)}\n" for key, value in table.items() if not isinstance(value, dict)]
    for key, value in table.items():
        if isinstance(value, dict):
            lines += toml(value, f"{name}.{key}" if name else key)
    return lines


def link(path: Path, to: Path) -> None:
    path.unlink(missing_ok=True)
    path.symlink_to(to.resolve())


def run(title: str, *step: object) -> bool:
    """Whether a step succeeds; the time it takes is added to that of all steps with its title."""
    print("+", *step, flush=True)
    began = time.monotonic()
    done = subprocess.run([str(part) for part in step]).returncode == 0
    file = OUT / "times.json"
    times = json.loads(file.read_text()) if file.exists() else {}
    times[title] = round(times.get(title, 0) + time.monotonic() - began, 1)
    OUT.mkdir(exist_ok=True)
    file.write_text(json.dumps(times, indent=2) + "\n")
    return done


def prepared(name: str) -> bool:
    """Whether the frames of an experiment are there, also in each fold's colours."""
    what = EXPERIMENTS[name]
    trove = [sys.executable, "-m", "trove"]
    folders = [changed(HERE / what.recipes, change) for change in what.changes] or [HERE / what.recipes]
    places = [path for folder in folders for path in sorted(folder.glob("*.toml")) if path.stem != "camera"]
    for place in places:
        frames = OUT / place.parent.name / place.stem
        if not run(f"frames of {frames.parent.name}", *trove, "generate", place, "--out", frames):
            return False
    for fold in read(HERE / f"{name}.toml").folds:
        # What the fold trains on, and nothing that it is measured on or chooses by.
        real = read(HERE / f"{name}.toml", Trial(fold)).pools["R"].linked(OUT / "targets" / fold)
        to = ["--to", real, "--method", "paired", "--strength", 1]
        for place in places:
            frames = Path(place.parent.name, place.stem)
            out = OUT / "recolored" / fold / frames
            if not run(f"colours of {frames.parent}", *trove, "recolor", OUT / frames, *to, "--out", out):
                return False
    return True


def chosen_of(name: str, options: argparse.Namespace) -> list[str] | None:
    """What of an experiment is asked for, as options of `trove.train`; None if it has nothing of that."""
    experiment, asked = read(HERE / f"{name}.toml"), []
    has = {"rows": experiment.rows, "folds": experiment.folds, "seeds": map(str, experiment.training.seeds)}
    for of, known in has.items():
        wanted = getattr(options, of)
        found = [one for one in known if one in wanted]
        if wanted and not found:
            return None
        asked += [f"--{of}", *found] if found else []
    return asked


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__.splitlines()[0], epilog="Example: run.py --data ~/datasets --only camvid"
    )
    parser.add_argument("--data", type=Path, required=True, help="folder with osm, camvid and idd-lite in it")
    parser.add_argument("--only", choices=EXPERIMENTS, help="one of the experiments")
    parser.add_argument("--small", action="store_true", help="all that a processor can train, in place of the others")
    for name in ("rows", "folds", "seeds"):
        parser.add_argument(f"--{name}", nargs="+", default=[], help=f"only these {name}, in tables that have them")
    parser.add_argument("--threads", type=int, default=1, help="threads on the CPU for each network; 0 is all")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="groups of rows that are trained at once")
    options = parser.parse_args()
    alike = [name for name, frames in EXPERIMENTS.items() if frames.small == options.small]
    chosen = [options.only] if options.only else alike
    for folder in ("osm", *dict.fromkeys(EXPERIMENTS[name].real for name in chosen)):
        if not (options.data / folder).is_dir():
            expected = f"expected a folder {folder}, found none; see docs/experiment.md"
            print(f"error: {options.data}: {expected}", file=sys.stderr)
            return 1
    link(HERE / "data", options.data)
    for name in chosen:
        if not prepared(name):
            return 1
        asked = chosen_of(name, options)
        train = [sys.executable, "-m", "trove.train", HERE / f"{name}.toml", "--out", OUT / "results" / name]
        how = ["--threads", options.threads, "--jobs", options.jobs]
        if asked is not None and not run(f"training of {name}", *train, *how, *asked):
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
