"""Finished grids of cells around the vehicle, read when they are asked for."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trove._trove import TroveError
from trove.format import GridTable, read_grid

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Bytes = npt.NDArray[np.uint8]


class Grid:
    """What fills the cells around the vehicle, and which of them are seen."""

    def __init__(self, path: Path, name: str) -> None:
        self.path = path
        """Its folder."""
        self.name = name
        """Its folder below the output folder (`scene-0103/v00/k005/ego.OCC3D`)."""

    def __repr__(self) -> str:
        return f"<trove.Grid {self.name}>"

    @cached_property
    def table(self) -> GridTable:
        """`grid.json`."""
        return read_grid(self.path)

    @cached_property
    def semantics(self) -> Bytes:
        """Numbers of the table's `classes`: X × Y × Z, `uint8`; `free` of the table where nothing is."""
        import numpy as np

        if self.table["form"] == "dense":
            return self._array("labels.npz", "semantics")
        cells = np.full(self.table["cells"], self.table["free"], np.uint8)
        z, y, x, number = self._array("occupancy.npy").T
        cells[x, y, z] = number
        return cells

    @cached_property
    def mask_camera(self) -> npt.NDArray[np.bool_]:
        """Whether a camera of the vehicle sees into a cell: X × Y × Z, `bool`."""
        return self._mask("mask_camera")

    @cached_property
    def mask_lidar(self) -> npt.NDArray[np.bool_]:
        """Whether a beam of a LiDAR passes or meets something in a cell: X × Y × Z, `bool`."""
        return self._mask("mask_lidar")

    @cached_property
    def bev(self) -> Bytes:
        """The classes from above: X × Y, `uint8`; of each column the highest thing, else what stands on the ground, else the ground."""
        return self._packed("bev")

    @cached_property
    def map(self) -> dict[str, npt.NDArray[np.bool_]]:
        """What the roads are below each column: X × Y, `bool`, for each of the table's `map_layers`."""
        bits = self._packed("map")
        return {name: bits & (1 << bit) != 0 for bit, name in enumerate(self.table["map_layers"])}

    @cached_property
    def instance(self) -> npt.NDArray[np.uint32]:
        """Ids of objects: X × Y × Z, `uint32`; 0: none. Dense grids alone have them."""
        return self._array("labels.npz", "instance")

    def _mask(self, name: str) -> npt.NDArray[np.bool_]:
        import numpy as np

        return self._packed(name).astype(np.bool_)

    def _packed(self, name: str) -> npt.NDArray[Any]:
        """An array that both forms have, each in an archive of its own."""
        return self._array("labels.npz" if self.table["form"] == "dense" else "masks.npz", name)

    def _array(self, file: str, name: str | None = None) -> npt.NDArray[Any]:
        import numpy as np

        path = self.path / file
        try:
            array: npt.NDArray[Any] = np.load(path, allow_pickle=False)
            return array if name is None else array[name]
        except (OSError, ValueError, KeyError) as fault:
            raise TroveError(f"{path}: expected cells of a grid, found an error ({fault})") from fault
