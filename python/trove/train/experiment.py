"""What to train on what: a TOML file.

classes = "camvid"            # or "paper", the 12 classes
size    = [480, 360]          # width and height that networks see
rows    = ["R", "S", "S+R[F]", "S+R[M]"]     # [F]: fine-tuned on the last set; [M]: mixed batches
compare = { "S+R[M]" = "R" }  # rows whose gain is shown

[sets.R]
format = "camvid"             # native | camvid | cityscapes | kitti-step
root   = "data/camvid"        # relative to this file
split  = "train"

[sets.P]
of    = "R"                   # a part of another set
count = 100

[sets.S]
format = "native"
root   = "out/camvid-twin"
frames = "out/camvid-twin/curated.json"      # optional: a list of trove curate

[sets.C]                      # S recoloured: a row with C uses it instead of S
format   = "native"
root     = "out/camvid-twin"
pictures = "out/camvid-twin-recolored"

[val]
format = "camvid"
root   = "data/camvid"
split  = "val"

[training]
model  = "small"              # or "deeplab"
steps  = 600                  # the same for every row; or epochs = 30, of a row's own images
batch  = 10
rate   = 1e-3
seeds  = [1, 2, 3]
balanced = true               # rare classes weigh more in the loss
"""

import hashlib
import itertools
import os
import re
import sys
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from trove.train.data import FORMATS, Sample
from trove.train.labels import TARGETS

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
    epochs: int = 30
    batch: int = 10
    rate: float = 1e-4
    seeds: tuple[int, ...] = (1, 2, 3)
    weights: Path | None = None
    balanced: bool = False

    def settings(self) -> list[Any]:
        """Everything that affects the result of a run except its seed."""
        weights = self.weights and [self.weights.name, self.weights.stat().st_size]
        return [self.model, self.steps, self.epochs, self.batch, self.rate, weights, self.balanced]


@dataclass(frozen=True)
class Pool:
    """A set of samples and the numbering of their labels."""

    samples: list[Sample]
    numbering: str

    def digest(self, base: Path) -> str:
        """A hash of the numbering and of all file sizes and paths relative to `base`, wherever `base` is."""
        files = [
            (os.path.relpath(f, base), f.stat().st_size)
            for sample in self.samples
            for f in (sample.picture, sample.labels)
        ]
        return _digest(self.numbering, files)


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
    training: Training = field(default_factory=Training)

    def stages(self, row: str) -> list[list[str]]:
        """The sets of each stage of a row: `S+R[F]` is trained on S, then on R; `S+C+R[M]` on C and R at once.

        C is S recoloured, so it replaces S.
        """
        names = re.sub(r"\[.\]$", "", row).split("+")
        names = [name for name in names if not (name == "S" and "C" in names)]
        if row.endswith("[F]"):
            return [names[:-1], names[-1:]]
        return [names]

    def alike(self, rows: list[str]) -> list[list[str]]:
        """Rows grouped by their first stage: groups can be trained in parallel, the rows of a group one after another."""
        groups: dict[tuple[str, ...], list[str]] = {}
        for row in rows:
            groups.setdefault(tuple(self.stages(row)[0]), []).append(row)
        return list(groups.values())

    def folders(self, row: str, seed: int, out: Path) -> list[tuple[Path, list[str]]]:
        """The folder and the sets of each stage of a row."""
        folders, name, key = (
            [],
            "",
            _digest(self.classes, self.size, self.training.settings(), self.val.digest(self.folder)),
        )
        for names in self.stages(row):
            key = _digest(key, seed, [self.digests[n] for n in names])
            name += (" then " if name else "") + "+".join(names)
            folders.append((out / "runs" / f"{name}, seed {seed}, {key}", names))
        return folders

    @cached_property
    def digests(self) -> dict[str, str]:
        """A digest of every set."""
        return {name: pool.digest(self.folder) for name, pool in self.pools.items()}


def read(path: Path) -> Experiment:
    """Reads an experiment and finds its images; raises `ExperimentError`."""
    try:
        table = tomllib.loads(path.read_text())
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise ExperimentError(f"{path}: {error}") from error
    _known(path, "", table, {"classes", "size", "rows", "compare", "sets", "val", "training"})
    classes = table.get("classes", "paper")
    if classes not in TARGETS:
        raise ExperimentError(f"{path}: classes: expected one of {', '.join(TARGETS)}, found {classes}")
    sets = table.get("sets", {})
    pools: dict[str, Pool] = {}
    for name, entry in sets.items():
        if "of" not in entry:
            pools[name] = _pool(path, f"sets.{name}", entry)
    for name, entry in sets.items():
        if "of" in entry:
            _known(path, f"sets.{name}.", entry, {"of", "count", "seed"})
            whole = pools.get(entry["of"])
            if whole is None:
                raise ExperimentError(f"{path}: sets.{name}.of: expected another set, found {entry['of']}")
            pools[name] = _part(whole, entry.get("count", 100), entry.get("seed", 1))
    if "val" not in table:
        raise ExperimentError(f"{path}: expected a section [val], found none")
    entry = dict(table.get("training", {}))
    _known(path, "training.", entry, {"model", "steps", "epochs", "batch", "rate", "seeds", "weights", "balanced"})
    if "seeds" in entry:
        entry["seeds"] = tuple(entry["seeds"])
    if "weights" in entry:
        entry["weights"] = path.parent / entry["weights"]
    size = table.get("size", [512, 256])
    experiment = Experiment(
        path.parent,
        classes,
        (size[0], size[1]),
        table.get("rows", []),
        table.get("compare", {}),
        pools,
        _pool(path, "val", table["val"]),
        Training(**entry),
    )
    for row in experiment.rows:
        for name in itertools.chain.from_iterable(experiment.stages(row)):
            if name not in pools:
                raise ExperimentError(f"{path}: rows: {row} asks for the set {name}, which is not under [sets]")
    return experiment


def _pool(path: Path, place: str, entry: dict[str, Any]) -> Pool:
    _known(path, f"{place}.", entry, {"format", "root", "split", "pictures", "frames"})
    if entry.get("format") not in FORMATS:
        raise ExperimentError(
            f"{path}: {place}.format: expected one of {', '.join(FORMATS)}, found {entry.get('format')}"
        )
    find, numbering = FORMATS[entry["format"]]
    options = {key: path.parent / entry[key] for key in ("pictures", "frames") if key in entry}
    root = path.parent / entry.get("root", "")
    samples = find(root, split=entry.get("split", "train"), **options)
    if not samples:
        raise ExperimentError(
            f"{path}: {place}.root: expected images laid out as {entry['format']} in {root}, found none"
        )
    return Pool(samples, numbering)


def _part(whole: Pool, count: int, seed: int) -> Pool:
    chosen = np.random.default_rng(seed).permutation(len(whole.samples))[:count]
    return Pool([whole.samples[i] for i in sorted(chosen)], whole.numbering)


def _digest(*parts: Any) -> str:
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:12]


def _known(path: Path, place: str, table: dict[str, Any], keys: set[str]) -> None:
    unknown = sorted(set(table) - keys)
    if unknown:
        raise ExperimentError(f"{path}: {place}{unknown[0]} is not known; expected {', '.join(sorted(keys))}")
