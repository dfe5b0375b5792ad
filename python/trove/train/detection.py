"""Training to detect: boxes around what touches, of a few classes, in the image.

Boxes come from the same class labels as segmentation's, so that real and generated pictures have the same ones: a box is
around every connected part of a class, as CamVid has no instances.
"""

import contextlib
import io
from typing import Any

import numpy as np
import torch
from torch import nn

from trove.train.labels import DETECTED, TARGETS
from trove.train.stock import Stock

# Parts that are narrower or lower than so many pixels have no box.
LEAST_PX = 6


def detector(classes: str) -> nn.Module:
    """torchvision's SSDlite on MobileNetV3 for the boxes of a target's classes, from scratch."""
    from torchvision.models.detection import ssdlite320_mobilenet_v3_large

    return ssdlite320_mobilenet_v3_large(weights=None, weights_backbone=None, num_classes=1 + len(DETECTED[classes]))


def boxes_of(ids: np.ndarray, classes: str) -> tuple[np.ndarray, np.ndarray]:
    """Boxes (N, 4) as left, top, right, bottom in pixels, and classes (N,) from 0, of labels (H, W) in a target's ids."""
    from scipy.ndimage import find_objects, label

    boxes, kinds = [], []
    for kind, names in enumerate(DETECTED[classes].values()):
        members = [TARGETS[classes].index(name) for name in names]
        parts, _ = label(np.isin(ids, members), np.ones((3, 3)))
        for down, across in find_objects(parts):
            box = (across.start, down.start, across.stop, down.stop)
            if min(box[2] - box[0], box[3] - box[1]) >= LEAST_PX:
                boxes.append(box)
                kinds.append(kind)
    return np.array(boxes, np.float32).reshape(-1, 4), np.array(kinds, np.int64)


class Detection:
    """The loss and the measure of torchvision's detectors."""

    # Boxes are found on the processor.
    recordable = False

    def __init__(self, classes: str):
        self._classes = classes

    def loss(self, model: nn.Module, rgb: torch.Tensor, truth: torch.Tensor) -> torch.Tensor:
        """The detector's loss for images (B, 3, h, w) with labels (B, h, w)."""
        targets = []
        for ids in truth.cpu().numpy():
            boxes, kinds = boxes_of(ids, self._classes)
            # Class 0 of a detector is the background.
            found = {"boxes": torch.from_numpy(boxes), "labels": torch.from_numpy(kinds + 1)}
            targets.append({name: value.to(rgb.device) for name, value in found.items()})
        loss: torch.Tensor = sum(model(list(rgb), targets).values())
        return loss

    def measure(self, model: nn.Module, stock: Stock, size: tuple[int, int]) -> np.ndarray:
        """Average precision at an IoU of 0.5 of each class, percent, over images cut to `size` (width, height); NaN for
        classes that none has."""
        model.eval()
        truths, found = [], []
        with torch.no_grad():
            for rgb, truth in stock.whole(size):
                truths += [boxes_of(ids, self._classes) for ids in truth.cpu().numpy()]
                for one in model(list(rgb)):
                    boxes, kinds, scores = (one[name].cpu().numpy() for name in ("boxes", "labels", "scores"))
                    found.append((boxes, kinds - 1, scores))
        return average_precision(truths, found, len(DETECTED[self._classes]))


def average_precision(
    truths: list[tuple[np.ndarray, np.ndarray]], found: list[tuple[np.ndarray, np.ndarray, np.ndarray]], classes: int
) -> np.ndarray:
    """pycocotools' average precision at an IoU of 0.5 of each class, percent, NaN where an image has none of it.

    For every image boxes (N, 4) as left, top, right, bottom and classes (N,), and of those found their scores (N,) too.
    """
    from pycocotools.coco import COCO
    from pycocotools.cocoeval import COCOeval

    def rows(image: int, boxes: np.ndarray, kinds: np.ndarray) -> list[dict[str, Any]]:
        sides = boxes[:, 2:] - boxes[:, :2]
        return [
            {"image_id": image, "category_id": int(kind), "bbox": [*map(float, box[:2]), *map(float, side)]}
            for box, side, kind in zip(boxes, sides, kinds)
        ]

    annotations = [row for i, (boxes, kinds) in enumerate(truths) for row in rows(i, boxes, kinds)]
    for number, row in enumerate(annotations):
        row.update(id=number + 1, area=row["bbox"][2] * row["bbox"][3], iscrowd=0)
    detections = [
        {**row, "score": float(score)}
        for i, (boxes, kinds, scores) in enumerate(found)
        for row, score in zip(rows(i, boxes, kinds), scores)
    ]
    has = {row["category_id"] for row in annotations}
    none = np.array([0.0 if kind in has else np.nan for kind in range(classes)])
    if not detections:
        return none
    with contextlib.redirect_stdout(io.StringIO()):
        truth = COCO()
        truth.dataset = {
            "images": [{"id": i} for i in range(len(truths))],
            "categories": [{"id": kind} for kind in range(classes)],
            "annotations": annotations,
        }
        truth.createIndex()
        evaluation = COCOeval(truth, truth.loadRes(detections), "bbox")
        evaluation.params.iouThrs = np.array([0.5])
        evaluation.evaluate()
        evaluation.accumulate()
    # By IoU, recall, class, area (the first is all) and the most detections in an image (the last is 100).
    precision = evaluation.eval["precision"][0, :, :, 0, -1].mean(0)
    return np.where(precision >= 0, 100 * precision, none)
