"""The recording vehicle's way through a scene."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from trove._trove import TroveError
from trove.format import EgoPose, TrajectoryTable, read_trajectory

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    import numpy.typing as npt

    Doubles = npt.NDArray[np.float64]


class Trajectory:
    """Where the vehicle is at every moment of its drive, rendered or not; row i is the moment that frames call `keyframe` i."""

    def __init__(self, path: Path) -> None:
        self.path = path
        """The folder of the variation (`scene-0103/v00`)."""

    def __repr__(self) -> str:
        return f"<trove.Trajectory {self.path}>"

    @cached_property
    def table(self) -> TrajectoryTable:
        """`trajectory.json`."""
        return read_trajectory(self.path)

    @cached_property
    def times_ns(self) -> npt.NDArray[np.int64]:
        """When: N, `int64`, nanoseconds since 1970 UTC."""
        import numpy as np

        return np.array([row["time_ns"] for row in self.table["moments"]], np.int64)

    @cached_property
    def world_from_ego(self) -> Doubles:
        """Poses: N × 4 × 4, `float64`."""
        return _matrices(self.table["moments"])

    @cached_property
    def velocity_mps(self) -> Doubles:
        """Velocities in World: N × 3, `float64`; NaN: not known."""
        import numpy as np

        unknown = [np.nan] * 3
        return np.array([row["velocity_mps"] or unknown for row in self.table["moments"]], np.float64)

    def waypoints(self, keyframe: int, seconds: Sequence[float]) -> Doubles:
        """Where the vehicle is some seconds after a moment, in Ego as it is at that moment: N × 3, `float64`, metres.

        Straight between the moments; NaN where the drive has not begun or has ended.
        """
        import numpy as np

        if not 0 <= keyframe < len(self.times_ns):
            raise TroveError(f"keyframe: expected 0 to {len(self.times_ns) - 1}, found {keyframe}")
        after_s = (self.times_ns - self.times_ns[keyframe]) * 1e-9
        ego_from_world = np.linalg.inv(self.world_from_ego[keyframe])
        way = self.world_from_ego[:, :3, 3] @ ego_from_world[:3, :3].T + ego_from_world[:3, 3]
        axes = [np.interp(seconds, after_s, way[:, axis], left=np.nan, right=np.nan) for axis in range(3)]
        return np.stack(axes, axis=1)


def _matrices(rows: Sequence[EgoPose]) -> Doubles:
    import numpy as np

    q = np.array([row["world_from_ego_rotation_wxyz"] for row in rows], np.float64).reshape(-1, 4)
    w, x, y, z = q.T
    poses = np.zeros((len(rows), 4, 4))
    poses[:, 0, :3] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], 1)
    poses[:, 1, :3] = np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], 1)
    poses[:, 2, :3] = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], 1)
    poses[:, :3, 3] = [row["world_from_ego_translation_m"] for row in rows]
    poses[:, 3, 3] = 1
    return poses
