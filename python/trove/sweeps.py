"""Finished LiDAR sweeps, read when they are asked for."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trove._trove import TroveError
from trove.format import SweepTable, read_sweep

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


class Sweep:
    """A LiDAR's points with its pose and its objects."""

    def __init__(self, path: Path, name: str) -> None:
        self.path = path
        """Its folder."""
        self.name = name
        """Its folder below the output folder (`scene-0103/v00/k005/ego.LIDAR_TOP`)."""

    def __repr__(self) -> str:
        return f"<trove.Sweep {self.name}>"

    @cached_property
    def table(self) -> SweepTable:
        """`sweep.json`."""
        return read_sweep(self.path)

    @cached_property
    def points(self) -> npt.NDArray[np.void]:
        """A structured array, one record a return.

        `x`, `y`, `z` (metres, the LiDAR's axes at the sweep's time), `time_s` (seconds after it), `instance` (0: none),
        `ring`, `intensity` (0 to 255), `class` (id), `return` (0, or 1 for the second of a beam).
        """
        import numpy as np

        path = self.path / "points.npy"
        try:
            points: npt.NDArray[Any] = np.load(path, allow_pickle=False)
        except (OSError, ValueError) as fault:
            raise TroveError(f"{path}: expected the points of a sweep, found an error ({fault})") from fault
        return points

    @cached_property
    def xyz(self) -> npt.NDArray[np.float64]:
        """Where the points are in World: N × 3, `float64`, metres."""
        import numpy as np

        own = np.stack([self.points[axis] for axis in "xyz"], axis=1).astype(np.float64)
        pose = np.array(self.table["world_from_lidar"])
        world: npt.NDArray[np.float64] = own @ pose[:3, :3].T + pose[:3, 3]
        return world
