"""What to train on what: a TOML file.

classes = "camvid"            # or "paper", the 12 classes
size    = [480, 360]          # width and height that networks see
rows    = ["R", "S", "S+R[F]", "S+R[M]"]     # [F]: fine-tuned on the last set; [M]: mixed batches
compare = { "S+R[M]" = "R" }  # rows whose gain is shown

[sets.R]
format = "camvid"             # native | camvid | idd-lite | cityscapes | kitti-step
root   = "data/camvid"        # relative to this file
split  = "train"              # or several: ["train", "val"]

[sets.P]
of    = "R"                   # a part of another set
count = 100                   # or several, such as [25, 100, "all"]: the sets P25, P100 and Pall
seed  = 1                     # what is drawn; "each": anew for every seed of [training]

[sets.S]
format = "native"
root   = "out/camvid-twin"
frames = "out/camvid-twin/curated.json"      # optional: a list of trove curate
drawn  = true                 # crowns of trees have outlines, and no part is too small to draw; false: as rendered

[sets.C]                      # S recoloured: a row with C uses it instead of S
format   = "native"
root     = "out/camvid-twin"
pictures = "out/camvid-twin-recolored"       # {fold} in it is the fold's name

[val]                         # what networks are measured on, or [folds]
format = "camvid"
root   = "data/camvid"
split  = "val"

[training]
model  = "small"              # or "unet", "deeplab"; "ssdlite" detects: boxes around the connected parts of classes
steps  = 600                  # of each stage of every row; or epochs = 30, of a row's own images
total  = 2000                 # instead: of all stages of a row; or a ladder such as [500, 2000, 8000]
averaged = true               # the rate stays as it is and weights are averaged, as ladders need; otherwise it falls
batch  = 10
rate   = 1e-3
seeds  = [1, 2, 3]
optimiser = "adamw"           # or "sgd", as DeepLab v2 has it, its classifier at ten times the rate
balanced = true               # rare classes weigh more in the loss
zoom = 1.4                    # cut at any place, from as large as can be to so many times smaller; 1 is none of that
mirrored = true               # half of the pictures
colour = 0.4                  # brightness, contrast, saturation and balance are drawn anew by up to ±40 %, for every row
norm_by_set = true            # batch normalisation of each set by itself; the network keeps the last set's statistics
class_mix = 0.5               # this share of pictures get half of the classes of another one in the batch, of the other set

Several counts are one line of a curve: a row `S+P*[M]` stands for `S+P25[M]`, `S+P100[M]` and so on, in `compare` too.

[folds] instead of [val] holds out each place of a set in turn, and measures on it:

[folds]
of    = "R"                   # nothing of the held-out place is in this set or its parts
count = 3                     # places are dealt out to so many folds; without it each place is one
inner = 0.2                   # this share of what remains, its last places or pictures, is for choices alone

A place is CamVid's drive, IDD-Lite's folder, Cityscapes' city, KITTI-STEP's sequence or a scene of ours.
A ladder is one run, which is measured at each rung as if it ended there; a row [F] has only those that its last stage
reaches. Every row has the rung on which the mean over seeds is best on the inner share, for each fold by itself; the
tables also show every rung.
"""

import itertools
import re
import sys
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from trove.train.data import FORMATS, ZOOM
from trove.train.folds import Folds, Pool, digest
from trove.train.labels import DETECTED, DETECTORS, TARGETS

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


class ExperimentError(ValueError):
    """The file asks for something impossible; the message names the place and what was expected."""


@dataclass(frozen=True)
class Training:
    """How networks are trained."""

    model: str = "small"
    steps: int = 0
    total: tuple[int, ...] = ()
    epochs: int = 30
    batch: int = 10
    rate: float = 1e-4
    seeds: tuple[int, ...] = (1, 2, 3)
    weights: Path | None = None
    balanced: bool = False
    colour: float = 0.0
    averaged: bool = False
    optimiser: str = "adamw"
    zoom: float = 1.4
    mirrored: bool = True
    class_mix: float = 0.0
    norm_by_set: bool = False

    def settings(self) -> dict[str, Any]:
        """Everything that affects the result of a run, except its seed and what is as by default."""
        chosen = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "seeds"}
        chosen = {name: value for name, value in chosen.items() if value != getattr(Training, name)}
        if self.weights:
            chosen["weights"] = [self.weights.name, self.weights.stat().st_size]
        return chosen


@dataclass(frozen=True)
class Trial:
    """What a network is trained for: a fold ("" without [folds]) and a seed."""

    fold: str = ""
    seed: int = 1

    def __str__(self) -> str:
        return (f"fold {self.fold}, " if self.fold else "") + f"seed {self.seed}"


@dataclass(frozen=True)
class Experiment:
    """An experiment with its sets resolved."""

    folder: Path
    classes: str
    size: tuple[int, int]
    rows: list[str]
    compare: dict[str, str]
    pools: dict[str, Pool]
    val: Pool
    # Rows with a star: those that it stands for, each with the set that takes its place; and those that are compared.
    lines: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    compare_lines: dict[str, str] = field(default_factory=dict)
    inner: Pool | None = None
    folds: tuple[str, ...] = ("",)
    trial: Trial = field(default_factory=Trial)
    training: Training = field(default_factory=Training)

    @property
    def measure(self) -> str:
        """What the mean over classes is called."""
        return "AP50" if self.training.model in DETECTORS else "mIoU"

    @property
    def names(self) -> list[str]:
        """The classes that results are by."""
        return list(DETECTED[self.classes]) if self.training.model in DETECTORS else TARGETS[self.classes]

    def trials(self) -> list[Trial]:
        """Every seed with every fold, so that what is cut short has whole seeds."""
        return [Trial(fold, seed) for seed, fold in itertools.product(self.training.seeds, self.folds)]

    def stages(self, row: str) -> list[list[str]]:
        """The sets of each stage of a row: `S+R[F]` is trained on S, then on R; `S+C+R[M]` on C and R at once.

        C is S recoloured, so it replaces S.
        """
        names = re.sub(r"\[.\]$", "", row).split("+")
        names = [name for name in names if not (name == "S" and "C" in names)]
        if row.endswith("[F]"):
            return [names[:-1], names[-1:]]
        return [names]

    def steps(self, row: str) -> list[int]:
        """How many steps each stage of a row has."""
        stages, training = self.stages(row), self.training
        if training.total:
            each, over = divmod(training.total[-1], len(stages))
            return [each + (number < over) for number in range(len(stages))]
        if training.steps:
            return [training.steps] * len(stages)
        images = [sum(len(self.pools[name].samples) for name in names) for names in stages]
        return [max(1, training.epochs * count // training.batch) for count in images]

    def rungs(self, row: str) -> dict[int, int]:
        """After which steps of its last stage a row is measured, and how many it then has altogether (0: by `epochs` or
        `steps`)."""
        *before, last = self.steps(row)
        if not self.training.total:
            return {last: 0}
        return {total - sum(before): total for total in self.training.total if total > sum(before)}

    def alike(self, rows: list[str]) -> list[list[str]]:
        """Rows grouped by their first stage: groups can be trained in parallel, the rows of a group one after another."""
        groups: dict[tuple[str, ...], list[str]] = {}
        for row in rows:
            groups.setdefault(tuple(self.stages(row)[0]), []).append(row)
        return list(groups.values())

    def folders(self, row: str, out: Path) -> list[tuple[Path, list[str]]]:
        """The folder and the sets of each stage of a row in the experiment's trial."""
        measured = [pool.digest(self.folder) for pool in (self.val, self.inner) if pool]
        folders, name = [], ""
        settings = self.training.settings()
        if all(len(names) == 1 for names in self.stages(row)):
            settings.pop("norm_by_set", None)
        key = digest(self.classes, self.size, settings, measured)
        for names, steps in zip(self.stages(row), self.steps(row)):
            key = digest(key, self.trial.seed, steps, [self.pools[name].digest(self.folder) for name in names])
            name += (" then " if name else "") + "+".join(names)
            folders.append((out / "runs" / f"{name}, {self.trial}, {key}", names))
        return folders


def read(path: Path, trial: Trial | None = None) -> Experiment:
    """Reads an experiment and finds the images of a trial, of the first one if none is given.

    Raises `ExperimentError`.
    """
    try:
        table = tomllib.loads(path.read_text())
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise ExperimentError(f"{path}: {error}") from error
    _known(path, "", table, {"classes", "size", "rows", "compare", "sets", "val", "folds", "training"})
    classes = table.get("classes", "paper")
    if classes not in TARGETS:
        raise ExperimentError(f"{path}: classes: expected one of {', '.join(TARGETS)}, found {classes}")
    training = _training(path, dict(table.get("training", {})))
    sets = table.get("sets", {})
    if ("val" in table) == ("folds" in table):
        raise ExperimentError(
            f"{path}: expected a section [val] or [folds], found {'both' if 'val' in table else 'none'}"
        )
    split = _folds(path, table["folds"], sets) if "folds" in table else None
    names = tuple(split.names) if split else ("",)
    trial = trial or Trial(names[0], training.seeds[0])
    if trial.fold not in names:
        raise ExperimentError(f"{path}: expected a fold of {', '.join(names)}, found {trial.fold}")
    pools: dict[str, Pool] = {}
    for name, entry in sets.items():
        if "of" not in entry:
            held = split is not None and name == split.of
            pools[name] = (
                split.training(trial.fold) if split and held else _pool(path, f"sets.{name}", entry, trial.fold)
            )
    counts: dict[str, list[str]] = {}
    for name, entry in sets.items():
        if "of" in entry:
            _known(path, f"sets.{name}.", entry, {"of", "count", "seed"})
            whole = pools.get(entry["of"])
            if whole is None:
                raise ExperimentError(f"{path}: sets.{name}.of: expected another set, found {entry['of']}")
            seed = trial.seed if entry.get("seed") == "each" else entry.get("seed", 1)
            count = entry.get("count", 100)
            if not isinstance(count, list):
                pools[name] = _part(whole, count, seed)
                continue
            counts[name] = [str(one) for one in count]
            for one in count:
                pools[f"{name}{one}"] = whole if one == "all" else _part(whole, one, seed)
    size = table.get("size", [512, 256])
    experiment = Experiment(
        path.parent,
        classes,
        (size[0], size[1]),
        [one for row in table.get("rows", []) for one, _ in _spelt_out(row, counts)],
        {
            one: _spelt_out(than, counts)[i if "*" in than else 0][0]
            for row, than in table.get("compare", {}).items()
            for i, (one, _) in enumerate(_spelt_out(row, counts))
        },
        pools,
        split.val(trial.fold) if split else _pool(path, "val", table["val"], ""),
        {row: _spelt_out(row, counts) for row in table.get("rows", []) if "*" in row},
        {row: than for row, than in table.get("compare", {}).items() if "*" in row and "*" in than},
        split.inner(trial.fold) if split else None,
        names,
        trial,
        training,
    )
    for row in experiment.rows:
        for name in itertools.chain.from_iterable(experiment.stages(row)):
            if name not in pools:
                raise ExperimentError(f"{path}: rows: {row} asks for the set {name}, which is not under [sets]")
    return experiment


def _training(path: Path, entry: dict[str, Any]) -> Training:
    _known(path, "training.", entry, {field.name for field in fields(Training)})
    total = entry.get("total", [])
    entry["total"] = tuple(sorted(total)) if isinstance(total, list) else (total,)
    if len(entry["total"]) > 1 and not entry.get("averaged"):
        raise ExperimentError(f"{path}: training.total: a ladder needs averaged = true; expected that or one number")
    if not 0 <= entry.get("colour", 0) < 1:
        raise ExperimentError(f"{path}: training.colour: expected 0 to below 1, found {entry['colour']}")
    if not 0 <= entry.get("class_mix", 0) <= 1:
        raise ExperimentError(f"{path}: training.class_mix: expected 0 to 1, found {entry['class_mix']}")
    if not 1 <= entry.get("zoom", 1) <= ZOOM:
        raise ExperimentError(f"{path}: training.zoom: expected 1 to {ZOOM}, found {entry['zoom']}")
    if entry.get("optimiser", "adamw") not in ("adamw", "sgd"):
        raise ExperimentError(f"{path}: training.optimiser: expected adamw or sgd, found {entry['optimiser']}")
    if entry.get("norm_by_set") and entry.get("model") in DETECTORS:
        raise ExperimentError(f"{path}: training.norm_by_set: expected a network that segments, found {entry['model']}")
    if "seeds" in entry:
        entry["seeds"] = tuple(entry["seeds"])
    if "weights" in entry:
        entry["weights"] = path.parent / entry["weights"]
        if not entry["weights"].is_file():
            expected = "expected the state of torchvision's resnet50"
            raise ExperimentError(f"{path}: training.weights: {expected}, found no file {entry['weights']}")
    return Training(**entry)


def _spelt_out(row: str, counts: dict[str, list[str]]) -> list[tuple[str, str]]:
    """The rows that a row with `P*` stands for, one for every count of the set P, and the set in each; else itself."""
    star = re.search(r"(\w+)\*", row)
    if star is None:
        return [(row, "")]
    return [(row.replace(star[0], star[1] + count), star[1] + count) for count in counts.get(star[1], [])]


def _folds(path: Path, entry: dict[str, Any], sets: dict[str, Any]) -> Folds:
    _known(path, "folds.", entry, {"of", "count", "inner"})
    name = entry.get("of")
    if name not in sets or "of" in sets[name]:
        raise ExperimentError(f"{path}: folds.of: expected a set with a format of its own, found {name}")
    whole = _pool(path, f"sets.{name}", sets[name], "")
    try:
        return Folds(name, whole, entry.get("count"), entry.get("inner", 0.2))
    except ValueError as error:
        raise ExperimentError(f"{path}: folds: {error}") from error


def _pool(path: Path, place: str, entry: dict[str, Any], fold: str) -> Pool:
    own = {"pictures", "frames", "drawn"} if entry.get("format") == "native" else set()
    _known(path, f"{place}.", entry, {"format", "root", "split", *own})
    if entry.get("format") not in FORMATS:
        raise ExperimentError(
            f"{path}: {place}.format: expected one of {', '.join(FORMATS)}, found {entry.get('format')}"
        )
    find, numbering = FORMATS[entry["format"]]
    options = {key: path.parent / entry[key].replace("{fold}", fold) for key in ("pictures", "frames") if key in entry}
    root = path.parent / entry.get("root", "")
    splits = entry.get("split", "train")
    samples = []
    for split in splits if isinstance(splits, list) else [splits]:
        samples += find(root, split=split, **options)
    if not samples:
        raise ExperimentError(
            f"{path}: {place}.root: expected images laid out as {entry['format']} in {root}, found none"
        )
    return Pool(samples, numbering, entry["format"] == "native" and entry.get("drawn", True))


def _part(whole: Pool, count: int, seed: int) -> Pool:
    chosen = np.random.default_rng(seed).permutation(len(whole.samples))[:count]
    return replace(whole, samples=[whole.samples[i] for i in sorted(chosen)])


def _known(path: Path, place: str, table: dict[str, Any], keys: set[str]) -> None:
    unknown = sorted(set(table) - keys)
    if unknown:
        raise ExperimentError(f"{path}: {place}{unknown[0]} is not known; expected {', '.join(sorted(keys))}")
