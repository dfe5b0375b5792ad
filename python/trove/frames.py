"""Finished frames, read when they are asked for."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from trove._trove import StoredFrame, TroveError, image_names, painted
from trove.camera import Camera
from trove.format import (
    FrameRow,
    FrameTable,
    LanesTable,
    Manifest,
    MaskRow,
    MaskTable,
    read_curated,
    read_frame,
    read_lanes,
    read_manifest,
    read_masks,
)
from trove.grids import Grid
from trove.objects import Object
from trove.overlay import Overlay, laid_over, with_boxes
from trove.radars import RadarCycle
from trove.sweeps import Sweep
from trove.trajectory import Trajectory

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Bytes = npt.NDArray[np.uint8]
    Floats = npt.NDArray[np.float32]

# The images of each overlay, and the colours that it has.
_OVERLAYS = {
    "class": "class",
    "instance": "instance",
    "depth": "depth",
    "normal": "normal",
    "flow_forward": "flow",
    "flow_backward": "flow",
    "occluded_forward": "occluded",
    "occluded_backward": "occluded",
    "change": "change",
    "panoptic": "panoptic",
    "range": "depth",
    "normal_world": "normal_world",
    "albedo": "albedo",
    "roughness": "roughness",
    "scene_flow_forward": "scene_flow",
    "scene_flow_backward": "scene_flow",
    "object_coordinates": "object_coordinates",
    "coverage": "coverage",
    "part": "part",
}


class Frame:
    """An image with its labels, its camera and its objects.

    Images are NumPy arrays of height × width (× channels) that are read when they are first asked for; a `TroveError`
    says which file is missing or damaged.
    """

    def __init__(
        self,
        read: Callable[[str], npt.NDArray[Any]],
        table: Callable[[], FrameTable],
        masks: Callable[[], MaskTable],
        path: Path | None,
        name: str,
    ) -> None:
        self._read, self._table, self._masks = read, table, masks
        self.path = path
        """Its folder; `None` where it was rendered in memory."""
        self.name = name
        """Its folder below the output folder (`scene-0103/v00/k005/ego.CAM_FRONT`), or the view."""

    @staticmethod
    def stored(path: Path, name: str) -> Frame:
        """The frame in a folder."""
        return Frame(_Folder(path).read, lambda: read_frame(path), lambda: read_masks(path), path, name)

    @staticmethod
    def rendered(table: str, images: dict[str, npt.NDArray[Any]], masks: str | None = None) -> Frame:
        """A frame that has no folder."""
        parsed: FrameTable = json.loads(table)

        def read(image: str) -> npt.NDArray[Any]:
            if image not in images:
                raise TroveError(f"{image}: expected one of {', '.join(images)}, which this frame was rendered with")
            return images[image]

        def read_masks() -> MaskTable:
            if masks is None:
                raise TroveError(
                    "masks: expected masks in output.files of the recipe, which this frame was rendered with"
                )
            rows: MaskTable = json.loads(masks)
            return rows

        return Frame(read, lambda: parsed, read_masks, None, parsed["view"])

    def __repr__(self) -> str:
        return f"<trove.Frame {self.name}>"

    def __reduce__(self) -> tuple[Any, ...]:
        if self.path is None:
            images = {name: self._read(name) for name in self.images}
            try:
                masks = json.dumps(self._masks())
            except TroveError:
                masks = None
            return Frame.rendered, (json.dumps(self.table), images, masks)
        return Frame.stored, (self.path, self.name)

    @cached_property
    def table(self) -> FrameTable:
        """`frame.json`."""
        return self._table()

    @cached_property
    def camera(self) -> Camera:
        """Lens and pose."""
        return Camera.of(self.table)

    @cached_property
    def objects(self) -> list[Object]:
        """Every object that would cover a pixel if nothing else were there, ordered by id."""
        return [Object.of(row) for row in self.table["objects"]]

    @property
    def images(self) -> list[str]:
        """The names of the images that it has (`rgb`, `class`, `flow_forward`, …)."""
        if self.path is not None:
            present = {file.name.split(".")[0] for file in self.path.iterdir()}
            return [name for name in image_names() if name in present]
        return [name for name in image_names() if self._has(name)]

    @cached_property
    def rgb(self) -> Bytes:
        """The picture: H × W × 3, `uint8`, sRGB."""
        return self._read("rgb")

    @cached_property
    def radiance(self) -> Floats:
        """Linear Rec. 709 radiance before exposure: H × W × 3, `float32`; only with `radiance = true` in the recipe."""
        return self._read("radiance")

    @cached_property
    def class_(self) -> Bytes:
        """Ids of the class table: H × W, `uint8`; 0: void."""
        return self._read("class")

    @cached_property
    def instance(self) -> npt.NDArray[np.uint16]:
        """Ids of objects: H × W, `uint16`; 0: none."""
        return self._read("instance")

    @cached_property
    def depth_m(self) -> Floats:
        """Metres along the camera's z axis: H × W, `float32`; +inf: sky."""
        return self._read("depth")

    @cached_property
    def normal(self) -> Floats:
        """Unit normals in Camera: H × W × 3, `float32`; 0: sky."""
        return self._read("normal")

    @cached_property
    def flow_forward(self) -> Floats:
        """Pixels to the next keyframe, right and down: H × W × 2, `float32`; NaN: not defined."""
        return self._read("flow_forward")

    @cached_property
    def flow_backward(self) -> Floats:
        """Pixels to the previous keyframe, right and down: H × W × 2, `float32`; NaN: not defined."""
        return self._read("flow_backward")

    @cached_property
    def occluded_forward(self) -> Bytes:
        """Whether the next keyframe's picture hides what a pixel shows: H × W, `uint8`.

        255: hidden there or out of the picture; 128: flow is not defined; 0: seen.
        """
        return self._read("occluded_forward")

    @cached_property
    def occluded_backward(self) -> Bytes:
        """The same of the previous keyframe's picture."""
        return self._read("occluded_backward")

    @cached_property
    def change(self) -> npt.NDArray[np.bool_]:
        """Whether a pixel shows another surface than the counterfactual's base: H × W, `bool`."""
        return self._read("change")

    @cached_property
    def panoptic(self) -> npt.NDArray[np.uint32]:
        """Class and object in one id: H × W, `uint32`; 65536 · class + object, 0: void."""
        return self._read("panoptic")

    @cached_property
    def range_m(self) -> Floats:
        """Metres from the camera's centre along the ray: H × W, `float32`; +inf: sky."""
        return self._read("range")

    @cached_property
    def normal_world(self) -> Floats:
        """Unit normals in World: H × W × 3, `float32`; 0: sky."""
        return self._read("normal_world")

    @cached_property
    def albedo(self) -> Floats:
        """Share of linear red, green and blue that is scattered diffusely: H × W × 3, `float32`; NaN: sky."""
        return self._read("albedo")

    @cached_property
    def roughness(self) -> Floats:
        """Perceptual roughness, 0 to 1: H × W, `float32`; NaN: sky."""
        return self._read("roughness")

    @cached_property
    def scene_flow_forward(self) -> Floats:
        """Metres in World to where the point is at the next keyframe: H × W × 3, `float32`; NaN: not defined."""
        return self._read("scene_flow_forward")

    @cached_property
    def scene_flow_backward(self) -> Floats:
        """Metres in World to where the point was at the previous keyframe: H × W × 3, `float32`; NaN: not defined."""
        return self._read("scene_flow_backward")

    @cached_property
    def object_coordinates(self) -> Floats:
        """The point in its object's box, 0 to 1 along Body's axes: H × W × 3, `float32`; NaN: no object."""
        return self._read("object_coordinates")

    @cached_property
    def coverage(self) -> Bytes:
        """Share of the pixel, in 255ths, that shows what its centre shows: H × W, `uint8`."""
        return self._read("coverage")

    @cached_property
    def part(self) -> Bytes:
        """The part of its object that the pixel shows, by the manifest's `parts`: H × W, `uint8`; 0: none of them."""
        return self._read("part")

    def labels(self, classes: str | PathLike[str]) -> Bytes:
        """What each pixel shows, in the numbers of a class map: H × W, `uint8`.

        `classes` is the name of one (`cityscapes`, `coco`, …) or a file, as for `trove export`. Objects' kinds count
        where there is `instance.png`, and parts, such as riders, where there is `part.png`. Only for frames in folders.
        """
        if self.path is None:
            raise TroveError("labels: expected a frame of trove.open, found one that was rendered in memory")
        return StoredFrame(self.path).labels(str(classes))

    def mask(self, thing: Object) -> npt.NDArray[np.bool_]:
        """The pixels that show an object: H × W, `bool`."""
        mask: npt.NDArray[np.bool_] = self.instance == thing.id
        return mask

    @cached_property
    def masks(self) -> dict[int, MaskRow]:
        """`masks.json` by ids: of each object the `visible` and the `amodal` mask as pycocotools takes them."""
        return {row["id"]: row for row in self._masks()["objects"]}

    def amodal_mask(self, thing: Object) -> npt.NDArray[np.bool_]:
        """The pixels that would show an object if nothing else were there: H × W, `bool`."""
        amodal = self.masks[thing.id]["amodal"]
        return painted(amodal["size"], amodal["counts"])

    def camera_from_body(self, thing: Object) -> npt.NDArray[np.float64]:
        """4 × 4, from the middle of an object's box (x forward, y left, z up) to Camera (x right, y down, z forward)."""
        import numpy as np

        pose: npt.NDArray[np.float64] = np.linalg.inv(self.table["world_from_camera"]) @ thing.world_from_body
        return pose

    def ego_from_body(self, thing: Object) -> npt.NDArray[np.float64] | None:
        """4 × 4, from the middle of an object's box to Ego (both x forward, y left, z up); `None` where nothing drives.

        Ego is where it is at `time_ns`, in the middle of the exposure, as the camera is.
        """
        import numpy as np

        ego = self.table["world_from_ego"]
        return None if ego is None else np.linalg.inv(ego) @ thing.world_from_body

    def overlay(self, label: str = "class", opacity: float = 2 / 3) -> Overlay:
        """A label in colours over the grey picture (alone where there is none), which notebooks show.

        `label` is the name of any image but the picture's own (`class`, `instance`, `flow_forward`, …), or `boxes` for
        the picture with the 2D boxes of what is seen.
        """
        if label == "boxes":
            return with_boxes(self.rgb, self.objects)
        if label not in _OVERLAYS:
            raise TroveError(f"overlay: expected one of {', '.join([*_OVERLAYS, 'boxes'])}, found {label!r}")
        return laid_over(self.rgb if self._has("rgb") else None, _OVERLAYS[label], self._read(label), opacity)

    def _repr_png_(self) -> bytes | None:
        return Overlay(self.rgb)._repr_png_() if self._has("rgb") else None

    def _has(self, name: str) -> bool:
        if self.path is not None:
            return name in self.images
        try:
            self._read(name)
        except TroveError:
            return False
        return True


class _Folder:
    """Reads the images of a folder, which it opens with the first of them."""

    def __init__(self, path: Path) -> None:
        self.path = path

    @cached_property
    def frame(self) -> StoredFrame:
        return StoredFrame(self.path)

    def read(self, name: str) -> npt.NDArray[Any]:
        return self.frame.read(name)


class Frames(Sequence[Frame]):
    """The frames of an output folder; none is read before it is asked for."""

    def __init__(self, root: Path, names: Sequence[str]) -> None:
        self.root = root
        """The output folder."""
        self.names = names
        """The frames' folders below it."""

    def __len__(self) -> int:
        return len(self.names)

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> Frames: ...
    def __getitem__(self, index: int | slice) -> Frame | Frames:
        if isinstance(index, slice):
            return Frames(self.root, self.names[index])
        name = self.names[index]
        return Frame.stored(self.root / name, name)

    def __iter__(self) -> Iterator[Frame]:
        return (Frame.stored(self.root / name, name) for name in self.names)

    def __repr__(self) -> str:
        return f"<trove.Frames: {len(self)} of {self.root}>"

    @cached_property
    def manifest(self) -> Manifest:
        """`manifest.json`."""
        return read_manifest(self.root)

    @cached_property
    def sweeps(self) -> list[Sweep]:
        """The LiDAR sweeps of the same output folder, of an unfinished run those that are finished."""
        return [Sweep(self.root / name, name) for name in self._beside("sweeps", "sweep.json")]

    @cached_property
    def radars(self) -> list[RadarCycle]:
        """The radars' cycles of the same output folder, of an unfinished run those that are finished."""
        return [RadarCycle(self.root / name, name) for name in self._beside("radars", "radar.json")]

    @cached_property
    def grids(self) -> list[Grid]:
        """The grids around the vehicle of the same output folder, of an unfinished run those that are finished."""
        return [Grid(self.root / name, name) for name in self._beside("grids", "grid.json")]

    def _beside(self, kind: str, table: str) -> list[str]:
        """Folders beside the frames' own, by the manifest, or of an unfinished run by their table."""
        if not (self.root / "manifest.json").is_file():
            return _finished(self.root, table)
        rows: list[FrameRow] = self.manifest.get(kind, [])  # type: ignore[assignment]
        return [row["path"] for row in rows]

    def trajectory(self, scene: str, variation: int = 0) -> Trajectory:
        """The way of the recording vehicle through a scene, at its moments that are rendered and those that are not."""
        return Trajectory(self.root / scene / f"v{variation:02}")

    def lanes(self, scene: str, variation: int = 0) -> LanesTable:
        """The lanes and painted lines of a scene, in World."""
        return read_lanes(self.root / scene / f"v{variation:02}")

    @cached_property
    def classes(self) -> dict[int, str]:
        """The names of the classes by their ids."""
        return {row["id"]: row["name"] for row in self.manifest["classes"]}


def open(
    folder: str | PathLike[str], *, curated: str | PathLike[str] | None = None, split: str | None = None
) -> Frames:
    """The frames of an output folder of `trove generate`, of an unfinished run those that are finished.

    `curated` is a list of `trove curate`, of which `split` (`train` or `val`) is taken, or both without it.
    """
    root = Path(folder)
    if curated is not None:
        lists = read_curated(Path(curated))
        splits = ["train", "val"] if split is None else [split]
        unknown = [name for name in splits if name not in lists]
        if unknown:
            raise TroveError(f"{curated}: expected a split of {', '.join(lists)}, found {unknown[0]!r}")
        return Frames(root, [name for part in splits for name in lists[part]])
    if split is not None:
        raise TroveError("split: expected curated too, the list that has it")
    if (root / "manifest.json").is_file():
        return Frames(root, [row["path"] for row in read_manifest(root)["frames"]])
    if not (root / ".trove").is_dir():
        raise TroveError(f"{root}: expected an output folder of trove generate, found no manifest.json in it")
    return Frames(root, _finished(root, "frame.json"))


def _finished(root: Path, table: str) -> list[str]:
    """What an unfinished run leaves: a folder has its name once it is complete."""
    found = root.glob(f"*/v[0-9]*/k[0-9]*/*/{table}")
    return sorted(path.parent.relative_to(root).as_posix() for path in found)
