"""Labels as pictures."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trove._trove import encode_png, label_colors

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from trove.objects import Object

    Picture = npt.NDArray[np.uint8]


class Overlay:
    """A picture (H, W, 3; `uint8`, sRGB) that notebooks show; `numpy.asarray` gives its pixels."""

    def __init__(self, array: Picture) -> None:
        self.array = array

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Any:
        import numpy as np

        if copy is False and dtype not in (None, self.array.dtype):
            raise ValueError("expected uint8, which can be given without a copy")
        return np.array(self.array, dtype) if copy else np.asarray(self.array, dtype)

    def _repr_png_(self) -> bytes:
        return encode_png(self.array)

    def save(self, path: str | PathLike[str]) -> None:
        """Writes it as PNG."""
        Path(path).write_bytes(self._repr_png_())


def laid_over(picture: Picture | None, label: str, values: npt.NDArray[Any], opacity: float) -> Overlay:
    """A label's colours over the grey picture; the colours alone where there is no picture."""
    import numpy as np

    colors = label_colors(label, values)
    if picture is None:
        return Overlay(colors)
    grey = (picture @ np.array([2, 5, 1])) / 8
    mixed = opacity * colors + (1 - opacity) * grey[..., None]
    return Overlay(mixed.round().astype(np.uint8))


def with_boxes(picture: Picture, objects: list[Object]) -> Overlay:
    """The picture with the 2D boxes of what is seen in the colours of their classes, the nearest last."""
    import numpy as np

    drawn = picture.copy()
    for thing in sorted(objects, key=lambda thing: -thing.range_m):
        if thing.visible_box is not None:
            left, top, right, bottom = thing.visible_box
            color = label_colors("class", np.full((1, 1), thing.class_id, np.uint8))[0, 0]
            drawn[[top, bottom], left : right + 1] = color
            drawn[top : bottom + 1, [left, right]] = color
    return Overlay(drawn)
