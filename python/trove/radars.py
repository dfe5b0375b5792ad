"""Finished cycles of radars, read when they are asked for."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trove._trove import TroveError
from trove.format import RadarTable, read_radar

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


class RadarCycle:
    """A radar's detections with its pose and the objects that it found."""

    def __init__(self, path: Path, name: str) -> None:
        self.path = path
        """Its folder."""
        self.name = name
        """Its folder below the output folder (`scene-0103/v00/k005/ego.RADAR_FRONT`)."""

    def __repr__(self) -> str:
        return f"<trove.RadarCycle {self.name}>"

    @cached_property
    def table(self) -> RadarTable:
        """`radar.json`."""
        return read_radar(self.path)

    @cached_property
    def detections(self) -> npt.NDArray[np.void]:
        """A structured array, one record a detection, the nearest first.

        `x`, `y`, `range_m` (metres, x ahead of the radar, y to its left), `azimuth_rad` (from x towards y), `radial_mps`
        (away from the radar), `ground_mps` (without the radar's own motion), `rcs_dbsm`, `range_error_m`,
        `azimuth_error_rad`, `speed_error_mps` (standard deviations), and as truth `instance` (0: none), `class` (id) and
        `surfaces` (1: where it is told, more: by mirrors, 0: a false alarm).
        """
        import numpy as np

        path = self.path / "detections.npy"
        try:
            detections: npt.NDArray[Any] = np.load(path, allow_pickle=False)
        except (OSError, ValueError) as fault:
            raise TroveError(f"{path}: expected a radar's detections, found an error ({fault})") from fault
        return detections

    @cached_property
    def xyz(self) -> npt.NDArray[np.float64]:
        """Where the detections are in World, at the height of the radar's plane: N × 3, `float64`, metres."""
        import numpy as np

        flat = [self.detections["x"], self.detections["y"], np.zeros(len(self.detections))]
        pose = np.array(self.table["world_from_radar"])
        world: npt.NDArray[np.float64] = np.stack(flat, axis=1).astype(np.float64) @ pose[:3, :3].T + pose[:3, 3]
        return world
