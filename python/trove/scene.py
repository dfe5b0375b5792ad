"""Scenes that pictures can be taken of from anywhere."""

from __future__ import annotations

import json
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, Any

from trove._trove import ReadyScene
from trove.camera import Camera
from trove.frames import Frame
from trove.packages import search

if TYPE_CHECKING:
    from collections.abc import Sequence

    from trove.camera import Matrix
    from trove.commands import Progress


class Scene:
    """A recipe's first scene at one keyframe, built, with the recipe's cameras, and ready to be photographed."""

    def __init__(self, ready: ReadyScene) -> None:
        self._ready = ready
        self.name, self.keyframe = ready.name()

    def __repr__(self) -> str:
        return f"<trove.Scene {self.name} at keyframe {self.keyframe}>"

    @cached_property
    def views(self) -> dict[str, Camera]:
        """The recipe's cameras by their names (`ego.CAM_FRONT`)."""
        import numpy as np

        return {
            name: Camera(size[0], size[1], np.array(intrinsics), np.array(pose), lens, tuple(distortion))
            for name, (size, intrinsics, lens, distortion), pose in self._ready.views()
        }

    @cached_property
    def report(self) -> dict[str, Any]:
        """What was dropped, guessed or substituted, and what was measured, as in `report.json`."""
        report: dict[str, Any] = json.loads(self._ready.report())
        return report

    def render(
        self,
        camera: str | Camera | None = None,
        pose: Matrix | Sequence[Sequence[float]] | None = None,
        *,
        spp: int | None = None,
        seed: int | None = None,
        labels_only: bool = False,
        progress: Progress | None = None,
    ) -> Frame:
        """Takes a picture with all labels; the frame is in memory and has no `path`.

        `camera` is a view's name (by default the first), which is then taken as the recipe has it, or a `Camera`. `pose`
        is another `world_from_camera`, 4 × 4; neighbouring keyframes, and so flow, are not defined then. `spp` are samples
        a pixel in place of the recipe's.
        """
        import numpy as np

        if isinstance(camera, Camera):
            pose = camera.world_from_camera if pose is None else pose
            lens = (
                [camera.width_px, camera.height_px],
                np.asarray(camera.intrinsics, float).tolist(),
                camera.lens_model,
                list(camera.distortion),
            )
            view = None
        else:
            lens, view = None, camera
        world_from_camera = None if pose is None else np.asarray(pose, float).tolist()
        table, images, masks = self._ready.picture(view, lens, world_from_camera, spp, seed, labels_only, progress)
        return Frame.rendered(table, images, masks)

    def write_glb(self, path: str | PathLike[str]) -> None:
        """Writes the scene with the recipe's cameras and the sun as binary glTF 2.0, as `trove build` does."""
        self._ready.write_glb(path)


def build(recipe: str | PathLike[str], *, keyframe: int | None = None) -> Scene:
    """Builds a recipe's first scene at a keyframe, by default the recipe's first; nothing is written."""
    return Scene(ReadyScene.build(recipe, keyframe, search()))


def render(
    recipe: str | PathLike[str],
    camera: str | Camera | None = None,
    pose: Matrix | Sequence[Sequence[float]] | None = None,
    *,
    keyframe: int | None = None,
    spp: int | None = None,
    seed: int | None = None,
    labels_only: bool = False,
    progress: Progress | None = None,
) -> Frame:
    """Builds a recipe's scene and takes one picture of it; `build` keeps the scene for more."""
    scene = build(recipe, keyframe=keyframe)
    return scene.render(camera, pose, spp=spp, seed=seed, labels_only=labels_only, progress=progress)
