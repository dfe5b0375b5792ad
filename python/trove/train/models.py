"""Segmentation networks: (N, 3, H, W), 0 to 1 → logits (N, classes, h, w) of a smaller size."""

from pathlib import Path

import torch
from torch import nn
from torch.nn import functional as F

from trove.train.detection import detector
from trove.train.labels import DETECTORS, TARGETS

MEAN, DEVIATION = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)


class Normalised(nn.Module):
    """Normalises images to the mean and deviation that ImageNet networks expect."""

    def __init__(self, body: nn.Module):
        super().__init__()
        self.body = body
        self.register_buffer("mean", torch.tensor(MEAN).view(1, 3, 1, 1), persistent=False)
        self.register_buffer("deviation", torch.tensor(DEVIATION).view(1, 3, 1, 1), persistent=False)

    def forward(self, pictures: torch.Tensor) -> torch.Tensor:
        return self.body((pictures - self.mean) / self.deviation)


class DeepLabV2(nn.Module):
    """DeepLab v2 (Chen et al. 2017) on ResNet-50: output stride 8, a sum of 3 × 3 convolutions at rates 6, 12, 18, 24."""

    def __init__(self, classes: int, weights: Path | None):
        super().__init__()
        from torchvision.models import resnet50

        backbone = resnet50(weights=None, replace_stride_with_dilation=[False, True, True])
        if weights is not None:
            backbone.load_state_dict(torch.load(weights, map_location="cpu", weights_only=True))
        self.backbone = nn.Sequential(*list(backbone.children())[:-2])
        self.branches = nn.ModuleList(nn.Conv2d(2048, classes, 3, padding=r, dilation=r) for r in (6, 12, 18, 24))

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        features = self.backbone(x)
        return sum(branch(features) for branch in self.branches)


def _convolution(inside: int, outside: int, stride: int = 1) -> nn.Sequential:
    return nn.Sequential(
        nn.Conv2d(inside, outside, 3, stride, 1, bias=False), nn.BatchNorm2d(outside), nn.ReLU(inplace=True)
    )


class _Pointwise(nn.Conv2d):
    """A 1 × 1 convolution as one matrix product: PyTorch's own is slow for few images on one thread."""

    def __init__(self, inside: int, outside: int):
        super().__init__(inside, outside, 1)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return F.linear(x.permute(0, 2, 3, 1), self.weight.flatten(1), self.bias).permute(0, 3, 1, 2)


class _Residual(nn.Module):
    """Two convolutions with a projection shortcut (He et al. 2016)."""

    def __init__(self, inside: int, outside: int, stride: int):
        super().__init__()
        self.body = nn.Sequential(
            _convolution(inside, outside, stride),
            nn.Conv2d(outside, outside, 3, 1, 1, bias=False),
            nn.BatchNorm2d(outside),
        )
        self.side = nn.Sequential(nn.Conv2d(inside, outside, 1, stride, bias=False), nn.BatchNorm2d(outside))

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return F.relu(self.body(x) + self.side(x), inplace=True)


class UNet(nn.Module):
    """A U-Net (Ronneberger et al. 2015) of residual blocks with `widths` channels, each level half as large.

    Logits have half the picture's size.
    """

    def __init__(self, classes: int, widths: tuple[int, ...]):
        super().__init__()
        first, *wider = widths
        self.stem = _convolution(3, first, 2)
        self.down = nn.ModuleList(_Residual(inside, outside, 2) for inside, outside in zip(widths, wider))
        self.side = nn.ModuleList(_Pointwise(width, width) for width in widths[:-1])
        self.up = nn.ModuleList(_convolution(inside, outside) for inside, outside in zip(wider, widths))
        self.head = _Pointwise(first, classes)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        levels = [self.stem(x)]
        for block in self.down:
            levels.append(block(levels[-1]))
        x = levels.pop()
        for up, side, level in zip(reversed(self.up), reversed(self.side), reversed(levels)):
            x = F.interpolate(up(x), level.shape[-2:], mode="bilinear", align_corners=False) + side(level)
        return self.head(x)


# Parameters: 0.8 million, trained on a processor in minutes, and 10 million, for a GPU.
_WIDTHS = {"small": (24, 48, 96, 160), "unet": (48, 96, 192, 384, 512)}


def network(name: str, target: str, weights: Path | None) -> nn.Module:
    """`deeplab`, `small`, `unet` or `ssdlite` for a target's classes; `weights` is a file of torchvision's ResNet-50 for
    `deeplab`, `None` trains from scratch."""
    classes = len(TARGETS[target])
    if name == "deeplab":
        return Normalised(DeepLabV2(classes, weights))
    if weights is not None:
        raise ValueError(f"weights: {name} has no pretrained weights; remove the key")
    if name in DETECTORS:
        return detector(target)
    if name in _WIDTHS:
        return Normalised(UNet(classes, _WIDTHS[name]))
    raise ValueError(f"model: expected deeplab, {', '.join(_WIDTHS)} or {', '.join(DETECTORS)}, found {name}")


def classifier_of(network: nn.Module) -> nn.Module:
    """The layers of a network that make its classes out of features."""
    body = getattr(network, "body", network)
    return body.branches if isinstance(body, DeepLabV2) else body.head
