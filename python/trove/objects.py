"""What a frame shows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from trove.format import ObjectRow

Box = tuple[int, int, int, int]
"""Left, top, right and bottom pixel, all included."""


@dataclass(frozen=True, eq=False)
class Object:
    """An object that a frame shows, or would show if nothing else were there; docs/output.md has every field."""

    id: int
    """Its value in the instance image."""
    class_: str
    """Its class, as a word."""
    class_id: int
    """Its value in the class image."""
    kind: str
    origin: str
    """`recorded`, `carrier`, `added` or `scenery`."""
    category: str
    token: str
    track_token: str
    asset: str
    world_from_body: npt.NDArray[np.float64]
    """4 × 4, from Body (x forward, y left, z up, origin in the box's centre) to World, metres."""
    size_m: tuple[float, float, float]
    """Length, width and height of its box."""
    world_from_asset: npt.NDArray[np.float64] | None
    """4 × 4, from the model's own axes (x forward, y left, z up, origin on the ground in its middle) to World, with scale;
    `None` for what was built for the place alone."""
    paint: tuple[int, int, int] | None
    """sRGB of its largest painted part; `None` where it has none."""
    velocity_mps: tuple[float, float, float] | None
    """In World; `None` where it is not known."""
    yaw_rate_radps: float | None
    """How fast its heading turns, to the left; `None` where it is not known."""
    states: tuple[str, ...]
    """Of `moving`, `stopped`, `parked`, `braking`, `riding`, `walking`, `running`, `standing`, `sitting`."""
    visible_px: int
    amodal_px: int
    visible_box: Box | None
    amodal_box: Box | None
    truncation: float
    occlusion: float
    range_m: float
    """From the camera to the centre of its box."""
    keypoints: npt.NDArray[np.float64] | None
    """(17, 3): column, row and visibility of a person's points in COCO's order (2 visible, 1 hidden, 0 outside); `None`
    where they are not known."""
    keypoints_world_m: npt.NDArray[np.float64] | None
    """(17, 3): the same points in World."""

    @staticmethod
    def of(row: ObjectRow) -> Object:
        """The object of a row in `frame.json`."""
        import numpy as np

        velocity, asset, paint = row["velocity_mps"], row.get("world_from_asset"), row.get("paint")
        return Object(
            id=row["id"],
            class_=row["class"],
            class_id=row["class_id"],
            kind=row["kind"],
            origin=row["origin"],
            category=row["category"],
            token=row["token"],
            track_token=row["track_token"],
            asset=row["asset"],
            world_from_body=np.array(row["world_from_body"]),
            size_m=_three(row["size_m"]),
            world_from_asset=None if asset is None else np.array(asset),
            paint=None if paint is None else (paint[0], paint[1], paint[2]),
            velocity_mps=None if velocity is None else _three(velocity),
            yaw_rate_radps=row.get("yaw_rate_radps"),
            states=tuple(row.get("states", ())),
            visible_px=row["visible_px"],
            amodal_px=row["amodal_px"],
            visible_box=_box(row["visible_box"]),
            amodal_box=_box(row["amodal_box"]),
            truncation=row["truncation"],
            occlusion=row["occlusion"],
            range_m=row["range_m"],
            keypoints=_points(row["keypoints"]),
            keypoints_world_m=_points(row["keypoints_world_m"]),
        )

    @property
    def corners_world(self) -> npt.NDArray[np.float64]:
        """The eight corners of its box in World, (8, 3), metres: rear before front, right before left, low before high."""
        return self.corners(self.world_from_body)

    def corners(self, frame_from_body: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        """The same corners where a pose from Body puts them, such as `Frame.camera_from_body` or `Frame.ego_from_body`."""
        import numpy as np

        signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
        corners: npt.NDArray[np.float64] = signs * self.size_m @ frame_from_body[:3, :3].T
        return corners + frame_from_body[:3, 3]


def _three(numbers: list[float]) -> tuple[float, float, float]:
    x, y, z = numbers
    return x, y, z


def _points(rows: list[list[float]] | None) -> npt.NDArray[np.float64] | None:
    import numpy as np

    return None if rows is None else np.array(rows)


def _box(numbers: list[int] | None) -> Box | None:
    if numbers is None:
        return None
    left, top, right, bottom = numbers
    return left, top, right, bottom
