"""Cameras and where they stand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from trove.format import FrameTable

    Matrix = npt.NDArray[np.float64]
    """Rows × columns; what takes one, takes nested lists too."""


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera: its lens, as OpenCV has it, and its pose."""

    width_px: int
    """Columns of the image."""
    height_px: int
    """Rows of the image."""
    intrinsics: Matrix
    """K, 3 × 3, pixels; pixel centres are at .5."""
    world_from_camera: Matrix
    """4 × 4, from Camera (x right, y down, z forward) to World (x east, y north, z up), metres."""
    lens_model: str = "pinhole"
    """`pinhole`, `brown-conrady`, `kannala-brandt` or `equirectangular`."""
    distortion: tuple[float, ...] = ()
    """The model's coefficients, as `frame.json` has them."""

    @staticmethod
    def pinhole(width_px: int, height_px: int, horizontal_fov_rad: float, world_from_camera: Matrix) -> Camera:
        """A camera without distortion that sees an angle from the left edge to the right one, its axis in the middle."""
        import numpy as np

        if not 0 < horizontal_fov_rad < math.pi:
            raise ValueError(f"horizontal_fov_rad: expected more than 0 and less than pi, found {horizontal_fov_rad}")
        focal_px = width_px / 2 / math.tan(horizontal_fov_rad / 2)
        intrinsics = np.array([[focal_px, 0, width_px / 2], [0, focal_px, height_px / 2], [0, 0, 1]])
        return Camera(width_px, height_px, intrinsics, np.asarray(world_from_camera, float))

    @staticmethod
    def of(table: FrameTable) -> Camera:
        """The camera of a `frame.json`."""
        import numpy as np

        return Camera(
            table["width_px"],
            table["height_px"],
            np.array(table["intrinsics"]),
            np.array(table["world_from_camera"]),
            table["lens_model"],
            tuple(table["distortion"]),
        )

    @property
    def position_m(self) -> Matrix:
        """Where it stands in World, (3,)."""
        return self.world_from_camera[:3, 3]

    def at(self, world_from_camera: Matrix) -> Camera:
        """The same camera at another pose."""
        import numpy as np

        return replace(self, world_from_camera=np.asarray(world_from_camera, float))

    def scaled(self, factor: float) -> Camera:
        """The same view with `factor` times as many columns and rows."""
        import numpy as np

        width_px, height_px = max(1, round(self.width_px * factor)), max(1, round(self.height_px * factor))
        scale = np.diag([width_px / self.width_px, height_px / self.height_px, 1.0])
        return replace(self, width_px=width_px, height_px=height_px, intrinsics=scale @ self.intrinsics)


def look_at(eye_m: Sequence[float], target_m: Sequence[float], up: Sequence[float] = (0.0, 0.0, 1.0)) -> Matrix:
    """`world_from_camera` (4 × 4) of a camera at `eye_m` in World that looks at `target_m` with `up` upwards."""
    import numpy as np

    eye, target, upwards = (np.asarray(vector, float) for vector in (eye_m, target_m, up))
    forward = target - eye
    right = np.cross(forward, upwards)
    if not np.linalg.norm(right) > 1e-9 * max(1.0, float(np.linalg.norm(forward))):
        raise ValueError(f"look_at: expected a target away from {list(eye_m)} and not along up, found {list(target_m)}")
    forward, right = forward / np.linalg.norm(forward), right / np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = right, np.cross(forward, right), forward, eye
    return pose
