"""Images with labels, from each dataset's own layout."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from PIL import Image

from trove._trove import StoredFrame
from trove.format import read_curated
from trove.train.labels import SETS, lookup


@dataclass(frozen=True)
class Sample:
    """The files of an image and its labels, and the name of the place or drive that it shows."""

    picture: Path
    labels: Path
    place: str = ""


def native(root: Path, pictures: Path | None = None, frames: Path | None = None, split: str = "train") -> list[Sample]:
    """Frames of `trove generate`.

    `pictures` is a folder of `trove recolor` whose images replace the frames' own; `frames` is a list of
    `trove curate`, from which `split` is used.
    """
    if frames is None:
        folders = sorted(path.parent.relative_to(root) for path in root.rglob("rgb.png"))
    else:
        folders = [Path(path) for path in read_curated(frames)[split]]
    return [
        Sample((pictures or root) / folder / "rgb.png", root / folder / "class.png", "/".join(folder.parts[:-3]))
        for folder in folders
    ]


def camvid(root: Path, split: str = "train") -> list[Sample]:
    """CamVid in its 12-class form: `images/SPLIT/DRIVE_FRAME.png` (or .jpg) and `labels/SPLIT/DRIVE_FRAME.png`."""
    pictures = sorted(path for path in (root / "images" / split).glob("*") if path.suffix in (".png", ".jpg"))
    return [Sample(path, root / "labels" / split / f"{path.stem}.png", path.stem.split("_")[0]) for path in pictures]


def cityscapes(root: Path, split: str = "train") -> list[Sample]:
    """Cityscapes' fine annotations: `leftImg8bit/SPLIT/CITY/…` and `gtFine/SPLIT/CITY/…_labelIds.png`."""
    samples = []
    for path in sorted((root / "leftImg8bit" / split).glob("*/*_leftImg8bit.png")):
        name = path.name.replace("_leftImg8bit", "_gtFine_labelIds")
        samples.append(Sample(path, root / "gtFine" / split / path.parent.name / name, path.parent.name))
    return samples


def idd_lite(root: Path, split: str = "train") -> list[Sample]:
    """IDD-Lite: `leftImg8bit/SPLIT/PLACE/FRAME_image.jpg` and `gtFine/SPLIT/PLACE/FRAME_label.png`."""
    samples = []
    for path in sorted((root / "leftImg8bit" / split).glob("*/*_image.jpg")):
        name = path.name.replace("_image.jpg", "_label.png")
        samples.append(Sample(path, root / "gtFine" / split / path.parent.name / name, path.parent.name))
    return samples


def kitti_step(root: Path, split: str = "train") -> list[Sample]:
    """KITTI-STEP: `image_02/SEQUENCE/FRAME.png` and `panoptic_maps/SPLIT/SEQUENCE/FRAME.png` (class in red)."""
    labels = sorted((root / "panoptic_maps" / split).glob("*/*.png"))
    return [Sample(root / "image_02" / path.parent.name / path.name, path, path.parent.name) for path in labels]


FORMATS: dict[str, tuple[Callable[..., list[Sample]], str]] = {
    "native": (native, "native"),
    "camvid": (camvid, "camvid"),
    "cityscapes": (cityscapes, "cityscapes"),
    "idd-lite": (idd_lite, "idd-lite"),
    "kitti-step": (kitti_step, "cityscapes-train"),
}


# How much pictures may be enlarged before they are cut, at most.
ZOOM = 1.4


class Pictures:
    """Pairs of an image (H, W, 3) and its labels (H, W) in the target's ids, both `uint8`.

    `drawn` gives labels that were rendered the look of drawn ones.
    They have their own size, or if that is more than a cut of `size` (width, height) enlarged by `zoom` needs, as much
    as that needs. Up to 2 GiB of them are kept, for all objects of this class together.
    """

    KEPT_BYTES = 2 << 30
    _kept: ClassVar[dict[tuple[Any, ...], tuple[np.ndarray, np.ndarray]]] = {}
    _kept_bytes: ClassVar[int] = 0

    def __init__(
        self,
        samples: list[Sample],
        numbering: str,
        target: str,
        size: tuple[int, int],
        zoom: float = ZOOM,
        drawn: bool = False,
    ):
        self.samples, self.numbering, self.target, self.size, self.zoom = samples, numbering, target, size, zoom
        self.drawn = drawn

    def __len__(self) -> int:
        return len(self.samples)

    def __getitem__(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        key = (self.samples[index], self.numbering, self.target, self.size, self.zoom, self.drawn)
        if key not in self._kept:
            pair = self._read(self.samples[index])
            size_bytes = sum(array.nbytes for array in pair)
            if Pictures._kept_bytes + size_bytes > self.KEPT_BYTES:
                return pair
            self._kept[key] = pair
            Pictures._kept_bytes += size_bytes
        return self._kept[key]

    def _read(self, sample: Sample) -> tuple[np.ndarray, np.ndarray]:
        picture: Image.Image = Image.open(sample.picture).convert("RGB")
        labels, numbering = _labels(sample, self.numbering, self.target)
        if picture.size != labels.size:
            raise ValueError(f"{sample.labels}: expected {picture.size} pixels, like the image, found {labels.size}")
        ids = lookup(numbering, self.target)[np.asarray(labels)]
        if self.drawn:
            # An experiment is read without the extra that SciPy comes with.
            from trove.train.drawn import as_drawn

            ids = as_drawn(ids, self.target)
        labels = Image.fromarray(ids)
        scale = max(self.size[0] / picture.width, self.size[1] / picture.height) * self.zoom
        if scale < 1:
            size = (round(picture.width * scale), round(picture.height * scale))
            picture, labels = (
                picture.resize(size, Image.Resampling.BILINEAR),
                labels.resize(size, Image.Resampling.NEAREST),
            )
        return np.asarray(picture), np.asarray(labels)


def _labels(sample: Sample, numbering: str, target: str) -> tuple[Image.Image, str]:
    """The picture of the labels, and how it is numbered: frames that have objects or parts tell more than classes."""
    finer = [sample.labels.with_name(name) for name in ("instance.png", "part.png")]
    if numbering == "native" and any(path.exists() for path in finer):
        return Image.fromarray(StoredFrame(sample.labels.parent).labels(SETS[target])), SETS[target]
    labels: Image.Image = Image.open(sample.labels)
    return labels if labels.mode in ("L", "P") else labels.getchannel(0), numbering


def shares_of(batch: int, sets: int) -> list[int]:
    """How many images of each set a batch has."""
    return [batch // sets + (i < batch % sets) for i in range(sets)]


def mixed_batches(lengths: list[int], batch: int, steps: int, seed: int) -> list[list[tuple[int, int]]]:
    """Batches of (set, index): each has equally many of every set, and each set cycles through all its images."""
    random = np.random.default_rng(seed)
    queues: list[list[int]] = [[] for _ in lengths]
    shares = shares_of(batch, len(lengths))
    batches = []
    for _ in range(steps):
        members = []
        for i, (share, length) in enumerate(zip(shares, lengths)):
            while len(queues[i]) < share:
                queues[i].extend(random.permutation(length).tolist())
            members += [(i, queues[i].pop(0)) for _ in range(share)]
        batches.append(members)
    return batches
