"""Shows an output folder in Rerun's viewer: images, labels, boxes, LiDAR, radars and the rig, on a timeline.

    python -m trove.rerun DIR

It needs the extra `[rerun]`. Each variation of a scene is a recording of its own, since each scene has its own World.
With `--save FOLDER` it writes `<scene>-v00.rrd` and so on there, and starts no viewer.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import rerun as rr

import trove
from trove._trove import image_names, label_colors

if TYPE_CHECKING:
    from trove.format import FrameTable, LanesTable, RadarTable, SweepTable

IMAGES = ("rgb", "class", "instance", "depth")
NAME = "trove"
LINES = {"lanes": (110, 160, 230), "lines": (235, 235, 235), "kerbs": (150, 150, 150)}


def context(names: dict[int, str], colors: str) -> Any:
    """What Rerun is to call ids, in the colours that overlays have."""
    ids = np.array([list(names)], np.uint8 if colors == "class" else np.uint16)
    painted = label_colors(colors, ids)[0]
    return rr.AnnotationContext([(i, name, tuple(rgb)) for (i, name), rgb in zip(names.items(), painted)])


def pose(matrix: Any) -> Any:
    matrix = np.asarray(matrix, float)
    return rr.Transform3D(translation=matrix[:3, 3], mat3x3=matrix[:3, :3])


def called(thing: trove.Object) -> str:
    return f"{thing.class_} {thing.id}"


class Recording:
    """A variation of a scene, as Rerun gets it."""

    def __init__(self, frames: trove.Frames, scene: str, variation: int) -> None:
        self.name = f"{scene}-v{variation:02}"
        self.stream = rr.RecordingStream(NAME, recording_id=f"{frames.root.absolute()}/{self.name}")
        self.classes = context(frames.classes, "class")
        self.named: set[str] = set()
        self.stream.set_log_time_enabled(False)
        self.stream.set_log_tick_enabled(False)
        self.stream.send_recording_name(self.name)
        self.always("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        self.way = frames.trajectory(scene, variation).world_from_ego
        self.always("world/trajectory", rr.LineStrips3D([self.way[:, :3, 3]], radii=0.05))
        self.lanes(frames.lanes(scene, variation))

    def always(self, entity: str, *what: Any) -> None:
        self.stream.log(entity, *what, static=True)

    def log(self, entity: str, *what: Any) -> None:
        self.stream.log(entity, *what)

    def name_classes(self, entity: str) -> None:
        """Below this entity, ids are classes."""
        if entity not in self.named:
            self.named.add(entity)
            self.always(entity, self.classes)

    def at(self, table: FrameTable | SweepTable | RadarTable) -> None:
        """What comes next belongs to this moment, and the recording vehicle is where it was then."""
        self.stream.set_time("keyframe", sequence=table["keyframe"])
        self.stream.set_time("time", timestamp=np.datetime64(table["keyframe_time_ns"], "ns"))
        self.log("world/ego", pose(self.way[table["keyframe"]]), rr.TransformAxes3D(2.0))

    def lanes(self, table: LanesTable) -> None:
        strips = {
            "lanes": [row["centreline_m"] for row in table["lanes"]],
            "lines": [row["points_m"] for row in table["lines"]],
            "kerbs": [row["points_m"] for row in table["kerbs"]],
        }
        for kind, points in strips.items():
            self.always(f"world/{kind}", rr.LineStrips3D(points, radii=0.03, colors=LINES[kind]))

    def frame(self, frame: trove.Frame, images: Iterable[str]) -> None:
        table, camera = frame.table, frame.camera
        entity = f"world/{table['view']}"
        self.at(table)
        self.log(entity, pose(camera.world_from_camera))
        if camera.lens_model != "equirectangular":  # of which Rerun has no frustum
            self.log(
                entity,
                rr.Pinhole(image_from_camera=camera.intrinsics, resolution=[camera.width_px, camera.height_px]),
            )
        present = frame.images
        for name in images:
            if name in present:
                self.image(f"{entity}/{name}", frame, name)
        self.name_classes(f"{entity}/boxes")
        seen = [thing for thing in frame.objects if thing.visible_box is not None]
        boxes = np.array([thing.visible_box for thing in seen], float).reshape(-1, 4)
        boxes[:, 2:] += 1  # the last pixel is included
        self.log(
            f"{entity}/boxes",
            rr.Boxes2D(
                array=boxes,
                array_format=rr.Box2DFormat.XYXY,
                class_ids=[thing.class_id for thing in seen],
                labels=[called(thing) for thing in seen],
                show_labels=False,
            ),
        )

    def image(self, entity: str, frame: trove.Frame, name: str) -> None:
        if name == "rgb" and frame.path is not None:
            # As it is on the disk, so that nothing is packed again.
            self.log(entity, rr.EncodedImage(path=frame.path / "rgb.png"))
        elif name == "class":
            self.name_classes(entity)
            self.log(entity, rr.SegmentationImage(frame.class_))
        elif name == "instance":
            self.log(entity, context({0: "none", **{o.id: called(o) for o in frame.objects}}, "instance"))
            self.log(entity, rr.SegmentationImage(frame.instance))
        elif name in ("depth", "range"):
            # Rerun's own word for "nothing measured" is 0.
            metres = frame.depth_m if name == "depth" else frame.range_m
            self.log(entity, rr.DepthImage(np.where(np.isfinite(metres), metres, 0), meter=1.0))
        elif name == "radiance":
            self.log(entity, rr.Image(frame.radiance))
        else:
            picture = frame.overlay(name, opacity=1.0)
            self.log(entity, rr.EncodedImage(contents=picture._repr_png_(), media_type="image/png"))

    def objects(self, frames: Sequence[trove.Frame]) -> None:
        """The boxes of all road users that the cameras of a moment have in their images."""
        things = {thing.id: thing for frame in frames for thing in frame.objects if thing.origin != "scenery"}
        rows = list(things.values())
        self.name_classes("world/objects")
        self.at(frames[0].table)
        self.log(
            "world/objects",
            rr.InstancePoses3D(
                translations=[thing.world_from_body[:3, 3] for thing in rows],
                mat3x3=[thing.world_from_body[:3, :3] for thing in rows],
            ),
            rr.Boxes3D(
                half_sizes=[np.array(thing.size_m) / 2 for thing in rows],
                class_ids=[thing.class_id for thing in rows],
                labels=[called(thing) for thing in rows],
                show_labels=False,
            ),
        )

    def points(self, view: str, xyz: Any, ids: Any, radius_m: float) -> None:
        entity = f"world/{view}"
        self.name_classes(entity)
        self.log(entity, rr.Points3D(xyz, class_ids=ids, radii=radius_m))

    def sweep(self, sweep: trove.Sweep) -> None:
        self.at(sweep.table)
        self.points(sweep.table["view"], sweep.xyz, sweep.points["class"], 0.03)

    def radar(self, cycle: trove.RadarCycle) -> None:
        self.at(cycle.table)
        self.points(cycle.table["view"], cycle.xyz, cycle.detections["class"], 0.15)


def recordings(frames: trove.Frames, scenes: Sequence[str]) -> Iterator[tuple[str, int]]:
    """The scenes and their variations of what a folder holds."""
    names = [*frames.names, *(sweep.name for sweep in frames.sweeps), *(cycle.name for cycle in frames.radars)]
    found = sorted({tuple(name.split("/")[:2]) for name in names})
    held = {scene for scene, _ in found}
    for scene in scenes:
        if scene not in held:
            raise trove.TroveError(f"--scene: expected one of {', '.join(sorted(held))}, found {scene}")
    for scene, variation in found:
        if not scenes or scene in scenes:
            yield scene, int(variation[1:])


def moment(frame: trove.Frame) -> str:
    return frame.name.rsplit("/", 1)[0]


def show(frames: trove.Frames, recording: Recording, folder: str, images: Iterable[str]) -> None:
    """Logs what a variation's folder holds."""
    own = (frame for frame in frames if frame.name.startswith(folder))
    for _, group in groupby(own, key=moment):
        beside = list(group)
        for frame in beside:
            recording.frame(frame, images)
        recording.objects(beside)
    for sweep in frames.sweeps:
        if sweep.name.startswith(folder):
            recording.sweep(sweep)
    for cycle in frames.radars:
        if cycle.name.startswith(folder):
            recording.radar(cycle)


def main(args: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m trove.rerun", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("dir", type=Path, help="output folder of trove generate")
    parser.add_argument("--scene", action="append", default=[], help="a scene; may be repeated [default: all]")
    parser.add_argument(
        "--images", default=",".join(IMAGES), help=f"images by name, separated by commas [default: {','.join(IMAGES)}]"
    )
    parser.add_argument("--save", type=Path, metavar="FOLDER", help="write .rrd files there and start no viewer")
    parser.add_argument(
        "--connect", metavar="URL", help="a viewer that runs already, such as rerun+http://host:9876/proxy"
    )
    options = parser.parse_args(args)
    images = options.images.split(",")
    try:
        unknown = set(images) - set(image_names())
        if unknown:
            raise trove.TroveError(
                f"--images: expected some of {', '.join(image_names())}, found {', '.join(sorted(unknown))}"
            )
        frames = trove.open(options.dir)
        if options.save:
            options.save.mkdir(parents=True, exist_ok=True)
        elif options.connect is None:
            rr.spawn(connect=False)
        for scene, variation in recordings(frames, options.scene):
            recording = Recording(frames, scene, variation)
            folder = f"{scene}/v{variation:02}/"
            if options.save is None:
                recording.stream.connect_grpc(options.connect)
                show(frames, recording, folder, images)
                recording.stream.flush()
                continue
            path = options.save / f"{recording.name}.rrd"
            unfinished = path.with_name(f".{path.name}.partial")
            recording.stream.save(unfinished)
            show(frames, recording, folder, images)
            recording.stream.disconnect()
            unfinished.replace(path)
            print(path)
    except trove.TroveError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
