"""Images and labels where the network is: on a GPU they are sent there once and cut there."""

from collections.abc import Iterator

import numpy as np
import torch
from torch.nn import functional as F

from trove.train.data import Pictures
from trove.train.labels import IGNORED

# The cut that shows as much of an image as there is: its zoom, where it lies from 0 to 1, and whether it is mirrored.
MIDDLE = (1.0, 0.5, 0.5, 0.0)
# Images whose labels are counted at once, and those that are measured at once.
_COUNTED, _MEASURED = 64, 20


class Stock:
    """The images of sets, one set after another, as (N, H, W, 3) and labels as (N, H, W), both `uint8`.

    Smaller images lie in the upper left corner. What is larger than `KEPT_BYTES`, or half of a GPU's free memory, is
    read where it is needed.
    """

    def __init__(self, sets: list[Pictures], device: torch.device):
        self._items = [(pictures, i) for pictures in sets for i in range(len(pictures))]
        self.device = device
        shapes = np.array([pictures[i][1].shape for pictures, i in self._items])
        self.sizes = torch.from_numpy(shapes[:, ::-1].astype(np.float32)).to(device)
        self._canvas = tuple(int(side) for side in shapes.max(0))
        room = torch.cuda.mem_get_info(device)[0] // 2 if device.type == "cuda" else Pictures.KEPT_BYTES
        self.resident = 4 * len(self._items) * self._canvas[0] * self._canvas[1] <= room
        if self.resident:
            self._pictures, self._labels = self._read(range(len(self._items)))

    def __len__(self) -> int:
        return len(self._items)

    def cut(self, chosen: torch.Tensor, cuts: torch.Tensor, size: tuple[int, int]) -> tuple[torch.Tensor, torch.Tensor]:
        """Images (B, 3, h, w), 0 to 1, and labels (B, h, w), of `size` (width, height).

        `cuts` (B, 4) are zooms from 1 on, places from 0 to 1 along both axes, and whether to mirror (above 0.5): the
        largest rectangle of that aspect ratio, divided by the zoom.
        """
        if self.resident:
            # Many times as fast as an index on a processor.
            pictures, labels = self._pictures.index_select(0, chosen), self._labels.index_select(0, chosen)
        else:
            pictures, labels = self._read(chosen.tolist())
        sides = self.sizes[chosen]
        scale = torch.minimum(sides[:, :1] / size[0], sides[:, 1:] / size[1]) / cuts[:, :1]
        box = torch.cat([scale * size[0], scale * size[1]], 1)
        corner = cuts[:, 1:3] * (sides - box)
        height, width = labels.shape[1:]
        across = torch.arange(size[0], device=self.device).add(0.5).div(size[0])[None]
        across = torch.where(cuts[:, 3:] > 0.5, 1 - across, across)
        down = torch.arange(size[1], device=self.device).add(0.5).div(size[1])[None]
        x = (corner[:, :1] + across * box[:, :1]) * (2 / width) - 1
        y = (corner[:, 1:] + down * box[:, 1:]) * (2 / height) - 1
        grid = torch.stack(torch.broadcast_tensors(x[:, None, :], y[:, :, None]), 3)
        rgb = F.grid_sample(
            pictures.permute(0, 3, 1, 2).float(), grid, "bilinear", padding_mode="border", align_corners=False
        )
        ids = F.grid_sample(labels[:, None].float(), grid, "nearest", padding_mode="border", align_corners=False)
        return rgb.contiguous() / 255, ids[:, 0].long()

    def whole(self, size: tuple[int, int]) -> Iterator[tuple[torch.Tensor, torch.Tensor]]:
        """All images in turn, some at once, as `cut` gives them: each cut in the middle, as large as it can be."""
        for start in range(0, len(self), _MEASURED):
            chosen = torch.arange(start, min(start + _MEASURED, len(self)), device=self.device)
            yield self.cut(chosen, torch.tensor(MIDDLE, device=self.device).expand(len(chosen), 4), size)

    def weights(self, lengths: list[int], classes: int) -> torch.Tensor:
        """1 / ln(1.02 + p) for every class with a share p of the pixels (Paszke et al. 2016), each set weighted equally.

        `lengths` are the sets' numbers of images.
        """
        shares, first = torch.zeros(classes, dtype=torch.float64, device=self.device), 0
        for length in lengths:
            counts = torch.zeros(256, dtype=torch.int64, device=self.device)
            for start in range(first, first + length, _COUNTED):
                some = range(start, min(start + _COUNTED, first + length))
                labels = self._labels[some.start : some.stop] if self.resident else self._read(some)[1]
                counts += torch.bincount(labels.flatten(), minlength=256)
            shares += counts[:classes] / counts[:classes].sum() / len(lengths)
            first += length
        return (1 / torch.log(1.02 + shares)).float()

    def _read(self, chosen: "range | list[int]") -> tuple[torch.Tensor, torch.Tensor]:
        pictures = np.zeros((len(chosen), *self._canvas, 3), np.uint8)
        labels = np.full((len(chosen), *self._canvas), IGNORED, np.uint8)
        for place, i in enumerate(chosen):
            rgb, ids = self._items[i][0][self._items[i][1]]
            pictures[place, : ids.shape[0], : ids.shape[1]] = rgb
            labels[place, : ids.shape[0], : ids.shape[1]] = ids
        return torch.from_numpy(pictures).to(self.device), torch.from_numpy(labels).to(self.device)


def random_cuts(steps: int, batch: int, seed: int, zoom: float, mirrored: bool) -> np.ndarray:
    """Cuts (steps, batch, 4) at random: zooms from 1 to `zoom`, any place, and if `mirrored` half of them so."""
    cuts = np.random.default_rng((seed, 1)).random((steps, batch, 4), np.float32)
    cuts[..., 0] = 1 + cuts[..., 0] * (zoom - 1)
    cuts[..., 3] *= mirrored
    return cuts


def random_tints(steps: int, batch: int, seed: int, spread: float) -> np.ndarray:
    """What `tinted` takes, at random: (steps, batch, 6) factors up to `spread` above or below 1, balance half of it."""
    tints = np.random.default_rng((seed, 2)).uniform(-spread, spread, (steps, batch, 6)).astype(np.float32)
    tints[..., 3:] /= 2
    return 1 + tints


def random_classes(steps: int, batch: int, seed: int, share: float, classes: int) -> np.ndarray:
    """What `class_mixed` takes, at random: (steps, batch, classes), half of the classes for a share of the images."""
    random = np.random.default_rng((seed, 3))
    return (random.random((steps, batch, 1)) < share) & (random.random((steps, batch, classes)) < 0.5)


def class_mixed(rgb: torch.Tensor, truth: torch.Tensor, taken: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """Images (B, 3, h, w) and labels (B, h, w), each with the classes `taken` (B, classes) of the one that stands as far
    from the batch's end as it does from its beginning (ClassMix, Olsson et al. 2021)."""
    known = F.pad(taken, (0, IGNORED + 1 - taken.shape[1]))
    theirs = truth.flip(0)
    pasted = known.gather(1, theirs.flatten(1)).view_as(theirs)
    return torch.where(pasted[:, None], rgb.flip(0), rgb), torch.where(pasted, theirs, truth)


def tinted(rgb: torch.Tensor, tints: torch.Tensor) -> torch.Tensor:
    """Images (B, 3, h, w), 0 to 1, with other colours: `tints` (B, 6) are the factors of brightness, contrast about the
    image's mean, saturation about each pixel's mean, and of each channel."""
    brightness, contrast, saturation = (tints[:, i, None, None, None] for i in range(3))
    rgb = rgb * brightness * tints[:, 3:, None, None]
    mean = rgb.mean((1, 2, 3), keepdim=True)
    rgb = mean + (rgb - mean) * contrast
    grey = rgb.mean(1, keepdim=True)
    return (grey + (rgb - grey) * saturation).clamp(0, 1)
