"""Training to segment: every pixel of an image has a class."""

import contextlib
from collections.abc import Iterator

import numpy as np
import torch
from torch import nn
from torch.nn import functional as F

from trove.train.labels import IGNORED
from trove.train.precision import autocast
from trove.train.stock import Stock


class Segmentation:
    """The loss and the measure of networks that give logits (N, classes, h, w) of images (N, 3, H, W)."""

    # Whether a GPU can record a step: all that it needs is on the device.
    recordable = True

    def __init__(self, classes: int, weights: torch.Tensor | None, shares: list[int] | None = None):
        """`weights` are those of each class in the loss; `shares`, images of each set in a batch, has every set
        normalised by its own statistics, of which the network keeps those of the last set."""
        self._classes, self._shares = classes, shares
        self._loss = nn.CrossEntropyLoss(weights, ignore_index=IGNORED)

    def loss(self, model: nn.Module, rgb: torch.Tensor, truth: torch.Tensor) -> torch.Tensor:
        """The mean loss over labelled pixels of images (B, 3, h, w) with labels (B, h, w)."""
        with autocast(rgb.device):
            logits = self._logits(model, rgb)
        # As in DeepLab v2 the loss is taken at the logits' size.
        truth = F.interpolate(truth[:, None].float(), logits.shape[-2:], mode="nearest")[:, 0].long()
        loss: torch.Tensor = self._loss(logits.float(), truth)
        return loss

    def _logits(self, model: nn.Module, rgb: torch.Tensor) -> torch.Tensor:
        if self._shares is None:
            logits: torch.Tensor = model(rgb)
            return logits
        *others, last = rgb.split(self._shares)
        with _statistics_kept(model):
            parts = [model(part) for part in others]
        return torch.cat([*parts, model(last)])

    def measure(self, model: nn.Module, stock: Stock, size: tuple[int, int]) -> np.ndarray:
        """Pixel counts (truth, prediction) over all images, each cut in the middle to `size` (width, height)."""
        model.eval()
        classes = self._classes
        confusion = torch.zeros(classes * classes, dtype=torch.int64, device=stock.device)
        with torch.no_grad(), autocast(stock.device):
            for rgb, truth in stock.whole(size):
                logits = F.interpolate(model(rgb).float(), truth.shape[1:], mode="bilinear", align_corners=False)
                counted = truth != IGNORED
                pairs = truth[counted] * classes + logits.argmax(1)[counted]
                confusion += torch.bincount(pairs, minlength=classes * classes)
        counts: np.ndarray = confusion.cpu().numpy().reshape(classes, classes)
        return counts


@contextlib.contextmanager
def _statistics_kept(model: nn.Module) -> Iterator[None]:
    """Batches are normalised by their own statistics, and those that the network keeps stay as they are."""
    norms = [module for module in model.modules() if isinstance(module, nn.BatchNorm2d)]
    momenta = [norm.momentum for norm in norms]
    for norm in norms:
        norm.momentum = 0.0
    yield
    for norm, momentum in zip(norms, momenta):
        norm.momentum = momentum
