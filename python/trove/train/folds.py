"""Sets of images, and their division by places into what is trained on, chosen by and measured on."""

import hashlib
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from trove.train.data import Sample


@dataclass(frozen=True)
class Pool:
    """A set of samples, the numbering of their labels, and whether those of frames are made as people draw them."""

    samples: list[Sample]
    numbering: str
    drawn: bool = False

    def digest(self, base: Path) -> str:
        """A hash of the numbering and of all file sizes and paths relative to `base`, wherever `base` is."""
        files = [
            (os.path.relpath(f, base), f.stat().st_size)
            for sample in self.samples
            for f in (sample.picture, sample.labels)
        ]
        return digest(self.numbering, files, *([self.drawn] if self.numbering == "native" else []))

    def linked(self, folder: Path) -> Path:
        """Fills a folder with links to the set's pictures and nothing else, for `trove recolor --to`, and returns it."""
        folder.mkdir(parents=True, exist_ok=True)
        wanted = {f"{s.place}_{s.picture.name}".replace("/", "_"): s.picture.resolve() for s in self.samples}
        for link in folder.iterdir():
            if link.readlink() == wanted.get(link.name):
                del wanted[link.name]
            else:
                link.unlink()
        for name, picture in wanted.items():
            (folder / name).symlink_to(picture)
        return folder


def digest(*parts: Any) -> str:
    """Twelve hexadecimal digits that depend on all parts."""
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:12]


class Folds:
    """A set divided by its places: each fold in turn is held out, and a share of every other one is for choices.

    That share are the last places of a fold, or if it has one place alone, which was driven through once, its last
    pictures: neighbours look alike, so that a random share would tell what has been learnt by heart.
    Raises `ValueError` for fewer than two folds, more than there are places, or a share that leaves nothing.
    """

    def __init__(self, of: str, whole: Pool, count: int | None, inner: float):
        self.of, self._whole = of, whole
        places = sorted({sample.place for sample in whole.samples})
        count = count or len(places)
        if not 2 <= count <= len(places):
            raise ValueError(f"count: expected 2 to {len(places)}, the number of places, found {count}")
        if not 0 < inner < 1:
            raise ValueError(f"inner: expected a share between 0 and 1, found {inner}")
        self.names = places if count == len(places) else [str(i + 1) for i in range(count)]
        dealt = places if count == len(places) else np.random.default_rng(1).permutation(places).tolist()
        self._parts: dict[str, tuple[list[Sample], list[Sample]]] = {}
        for i, name in enumerate(self.names):
            order = {place: n for n, place in enumerate(dealt[i::count])}
            samples = sorted(
                (s for s in whole.samples if s.place in order), key=lambda s: (order[s.place], s.picture.name)
            )
            cut = round(len(samples) * (1 - inner))
            if len(order) > 1:
                cut = next((n for n in range(cut, 0, -1) if samples[n].place != samples[n - 1].place), 0)
            self._parts[name] = (samples[:cut], samples[cut:])

    def training(self, held_out: str) -> Pool:
        """What is trained on while one fold is held out."""
        return self._pool(held_out, 0)

    def inner(self, held_out: str) -> Pool:
        """What choices are made by while one fold is held out."""
        return self._pool(held_out, 1)

    def val(self, held_out: str) -> Pool:
        """What is measured on: all of the fold that is held out."""
        return replace(self._whole, samples=[*self._parts[held_out][0], *self._parts[held_out][1]])

    def _pool(self, held_out: str, part: int) -> Pool:
        others = [parts[part] for name, parts in self._parts.items() if name != held_out]
        return replace(self._whole, samples=[sample for samples in others for sample in samples])
