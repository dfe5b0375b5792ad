"""Images with labels, from each dataset's own layout."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from trove.format import read_curated
from trove.train.labels import CROWNS, lookup


@dataclass(frozen=True)
class Sample:
    """The files of an image and its labels."""

    picture: Path
    labels: Path


def native(root: Path, pictures: Path | None = None, frames: Path | None = None, split: str = "train") -> list[Sample]:
    """Frames of `trove generate`.

    `pictures` is a folder of `trove recolor` whose images replace the frames' own; `frames` is a list of
    `trove curate`, from which `split` is used.
    """
    if frames is None:
        folders = sorted(path.parent.relative_to(root) for path in root.rglob("rgb.png"))
    else:
        folders = [Path(path) for path in read_curated(frames)[split]]
    return [Sample((pictures or root) / folder / "rgb.png", root / folder / "class.png") for folder in folders]


def camvid(root: Path, split: str = "train") -> list[Sample]:
    """CamVid in its 12-class form: `images/SPLIT/NAME.png` (or .jpg) and `labels/SPLIT/NAME.png`."""
    pictures = sorted(path for path in (root / "images" / split).glob("*") if path.suffix in (".png", ".jpg"))
    return [Sample(path, root / "labels" / split / f"{path.stem}.png") for path in pictures]


def cityscapes(root: Path, split: str = "train") -> list[Sample]:
    """Cityscapes' fine annotations: `leftImg8bit/SPLIT/CITY/…` and `gtFine/SPLIT/CITY/…_labelIds.png`."""
    samples = []
    for path in sorted((root / "leftImg8bit" / split).glob("*/*_leftImg8bit.png")):
        name = path.name.replace("_leftImg8bit", "_gtFine_labelIds")
        samples.append(Sample(path, root / "gtFine" / split / path.parent.name / name))
    return samples


def kitti_step(root: Path, split: str = "train") -> list[Sample]:
    """KITTI-STEP: `image_02/SEQUENCE/FRAME.png` and `panoptic_maps/SPLIT/SEQUENCE/FRAME.png` (class in red)."""
    labels = sorted((root / "panoptic_maps" / split).glob("*/*.png"))
    return [Sample(root / "image_02" / path.parent.name / path.name, path) for path in labels]


FORMATS: dict[str, tuple[Callable[..., list[Sample]], str]] = {
    "native": (native, "native"),
    "camvid": (camvid, "camvid"),
    "cityscapes": (cityscapes, "cityscapes"),
    "kitti-step": (kitti_step, "cityscapes-train"),
}


# How much pictures may be enlarged before they are cut.
_ZOOM = 1.4


class Pictures:
    """Pairs of an image (H, W, 3) and its labels (H, W) in the target's ids, both `uint8`.

    Images are scaled to cover `size` (width, height) and cropped to it, at the centre, or with `augment` at random with
    a random scale of 1 to 1.4 and a random flip, all determined by `epoch` and the index.
    Up to 2 GiB of images are cached, as small as the largest of these scales allows.
    """

    KEPT_BYTES = 2 << 30

    def __init__(
        self, samples: list[Sample], numbering: str, target: str, size: tuple[int, int], augment: bool, seed: int
    ):
        self.samples, self.size, self.augment, self.seed = samples, size, augment, seed
        self.table = lookup(numbering, target)
        self.crowns: tuple[int, int, int] | None = CROWNS[target] if numbering == "native" else None
        self.epoch = 0
        self._kept: dict[int, tuple[Image.Image, Image.Image]] = {}
        self._kept_bytes = 0

    def __len__(self) -> int:
        return len(self.samples)

    def __getitem__(self, index: int) -> tuple[np.ndarray, np.ndarray]:
        picture, labels = self._pair(index)
        random = np.random.default_rng((self.seed, self.epoch, index))
        zoom, x, y, mirrored = (
            (random.uniform(1, _ZOOM), *random.random(2), random.random() < 0.5)
            if self.augment
            else (1, 0.5, 0.5, False)
        )
        scale = max(self.size[0] / picture.width, self.size[1] / picture.height) * zoom
        width, height = self.size[0] / scale, self.size[1] / scale
        left, top = x * (picture.width - width), y * (picture.height - height)
        box = (left, top, left + width, top + height)
        rgb = np.asarray(picture.resize(self.size, Image.Resampling.BILINEAR, box=box))
        ids = np.asarray(labels.resize(self.size, Image.Resampling.NEAREST, box=box))
        if mirrored:
            rgb, ids = rgb[:, ::-1], ids[:, ::-1]
        return rgb, ids

    def labels(self, index: int) -> np.ndarray:
        """All labels of an image, uncropped, in the target's ids."""
        return np.asarray(self._pair(index)[1])

    def _pair(self, index: int) -> tuple[Image.Image, Image.Image]:
        """The image and its labels in the target's ids, as large as the largest zoom needs."""
        if index in self._kept:
            return self._kept[index]
        sample = self.samples[index]
        picture: Image.Image = Image.open(sample.picture).convert("RGB")
        labels: Image.Image = Image.open(sample.labels)
        if labels.mode not in ("L", "P"):
            labels = labels.getchannel(0)
        if picture.size != labels.size:
            raise ValueError(f"{sample.labels}: expected {picture.size} pixels, like the image, found {labels.size}")
        labels = Image.fromarray(self.table[np.asarray(labels)])
        if self.crowns is not None:
            labels = _outlined_crowns(labels, *self.crowns)
        scale = max(self.size[0] / picture.width, self.size[1] / picture.height) * _ZOOM
        if scale < 1:
            size = (round(picture.width * scale), round(picture.height * scale))
            picture, labels = (
                picture.resize(size, Image.Resampling.BILINEAR),
                labels.resize(size, Image.Resampling.NEAREST),
            )
        size_bytes = 4 * picture.width * picture.height
        if self._kept_bytes + size_bytes <= self.KEPT_BYTES:
            self._kept[index] = (picture, labels)
            self._kept_bytes += size_bytes
        return picture, labels


def _outlined_crowns(labels: Image.Image, tree: int, sky: int, building: int) -> Image.Image:
    """Labels as annotators draw them: a crown is one surface, so sky and houses seen between twigs are tree.

    Trees are closed by a hundredth of the width on each side.
    """
    ids = np.asarray(labels)
    radius = labels.width // 100
    closed = ~_spread(~_spread(ids == tree, radius), radius)
    behind = (ids == sky) | (ids == building)
    return Image.fromarray(np.where(closed & behind, np.uint8(tree), ids))


def _spread(mask: np.ndarray, radius: int) -> np.ndarray:
    """Where the mask (H, W) is true within `radius` pixels along both axes."""
    for _ in range(2):
        wide = mask.copy()
        for shift in range(1, radius + 1):
            wide[shift:] |= mask[:-shift]
            wide[:-shift] |= mask[shift:]
        mask = wide.T
    return mask


def mixed_batches(lengths: list[int], batch: int, steps: int, seed: int) -> list[list[tuple[int, int]]]:
    """Batches of (set, index): each has equally many of every set, and each set cycles through all its images."""
    random = np.random.default_rng(seed)
    queues: list[list[int]] = [[] for _ in lengths]
    shares = [batch // len(lengths) + (i < batch % len(lengths)) for i in range(len(lengths))]
    batches = []
    for _ in range(steps):
        members = []
        for i, (share, length) in enumerate(zip(shares, lengths)):
            while len(queues[i]) < share:
                queues[i].extend(random.permutation(length).tolist())
            members += [(i, queues[i].pop(0)) for _ in range(share)]
        batches.append(members)
    return batches
