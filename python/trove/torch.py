"""Frames as a PyTorch dataset; needs torch and torchvision."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from torch.utils.data import Dataset
from torchvision import tv_tensors

from trove import frames
from trove._trove import TroveError

if TYPE_CHECKING:
    from trove.frames import Frame
    from trove.objects import Object

    Target = dict[str, Any]

# What a target can hold. Vectors would have to be turned with the image, which transforms do not do.
_VECTORS = ("normal", "flow_forward", "flow_backward")
_TARGETS = ("class", "instance", "depth", "boxes", "masks", *_VECTORS)


class Frames(Dataset[tuple[Any, "Target"]]):
    """The frames of an output folder as pairs of an image and a target.

    The image is a `tv_tensors.Image` (3 × H × W, `uint8`). The target is a dict with what `targets` names:

    - `class`: `tv_tensors.Mask`, H × W, `uint8`, ids of the class table
    - `instance`: `tv_tensors.Mask`, H × W, `int32`, ids of objects, 0: none
    - `depth`: `tv_tensors.Mask`, H × W, `float32`, metres along the camera's z axis, +inf: sky; as a mask it is never
      interpolated
    - `boxes`: `boxes`, `tv_tensors.BoundingBoxes` in XYXY around the pixels that show each object, with `labels` (N,
      `int64`: class ids) and `ids` (N, `int64`)
    - `masks`: `tv_tensors.Mask`, N × H × W, `bool`, of the same objects, with `labels` and `ids`
    - `normal`, `flow_forward`, `flow_backward`: tensors, C × H × W, `float32`; not together with `transforms`

    `transforms` is called with both, as transforms of torchvision's v2 are. `classes` keeps the objects of some classes
    (ids), `min_px` those with as many visible pixels. `curated` and `split` choose frames as in `trove.open`.
    """

    def __init__(
        self,
        folder: str | PathLike[str],
        targets: Sequence[str] = ("class",),
        *,
        transforms: Callable[[Any, Target], Any] | None = None,
        curated: str | PathLike[str] | None = None,
        split: str | None = None,
        classes: Sequence[int] | None = None,
        min_px: int = 1,
    ) -> None:
        unknown = [name for name in targets if name not in _TARGETS]
        if unknown:
            raise TroveError(f"targets: expected some of {', '.join(_TARGETS)}, found {unknown[0]!r}")
        turned = [name for name in targets if name in _VECTORS]
        if transforms is not None and turned:
            raise TroveError(
                f"targets: {turned[0]} holds vectors, which transforms would not turn; leave one of both out"
            )
        self.frames = frames.open(folder, curated=curated, split=split)
        self.targets, self.transforms = tuple(targets), transforms
        self.classes, self.min_px = None if classes is None else frozenset(classes), min_px

    def __len__(self) -> int:
        return len(self.frames)

    def __getitem__(self, index: int) -> Any:
        frame = self.frames[index]
        image = tv_tensors.Image(torch.from_numpy(frame.rgb).permute(2, 0, 1))
        target: Target = {}
        for name in self.targets:
            if name == "class":
                target[name] = tv_tensors.Mask(torch.from_numpy(frame.class_))
            elif name == "instance":
                target[name] = tv_tensors.Mask(torch.from_numpy(frame.instance.astype(np.int32)))
            elif name == "depth":
                target[name] = tv_tensors.Mask(torch.from_numpy(frame.depth_m))
            elif name in _VECTORS:
                target[name] = torch.from_numpy(getattr(frame, name)).permute(2, 0, 1)
        if "boxes" in self.targets or "masks" in self.targets:
            target.update(self._things(frame))
        return (image, target) if self.transforms is None else self.transforms(image, target)

    def _things(self, frame: Frame) -> Target:
        things = [thing for thing in frame.objects if self._counts(thing)]
        target: Target = {
            "labels": torch.tensor([thing.class_id for thing in things], dtype=torch.int64),
            "ids": torch.tensor([thing.id for thing in things], dtype=torch.int64),
        }
        size = (frame.table["height_px"], frame.table["width_px"])
        if "boxes" in self.targets:
            # Our boxes name their last pixel, torchvision's end behind it.
            edges = [(box[0], box[1], box[2] + 1, box[3] + 1) for thing in things if (box := thing.visible_box)]
            boxes = torch.tensor(edges, dtype=torch.float32).reshape(-1, 4)
            target["boxes"] = tv_tensors.BoundingBoxes(boxes, format="XYXY", canvas_size=size)
        if "masks" in self.targets:
            ids = np.array([thing.id for thing in things], np.uint16)
            target["masks"] = tv_tensors.Mask(torch.from_numpy(frame.instance == ids[:, None, None]))
        return target

    def _counts(self, thing: Object) -> bool:
        wanted = self.classes is None or thing.class_id in self.classes
        return wanted and thing.visible_box is not None and thing.visible_px >= self.min_px
