"""Finished frames as another dataset, and the frames that it was made from, for the tests of every form."""

import json

import numpy as np
import OpenEXR
from conftest import trove
from PIL import Image


def exported(finished, out, form, *args):
    """The folder of an export and what the program printed of it."""
    done = trove("export", finished, "--format", form, "--out", out, "--json", *args)
    assert done.returncode == 0, done.stderr
    return out, json.loads(done.stdout)


class Source:
    """A finished frame as it was written."""

    def __init__(self, folder):
        self.folder = folder
        self.table = json.loads((folder / "frame.json").read_text())
        self.users = [row for row in self.table["objects"] if row["origin"] != "scenery"]

    def picture(self, name):
        """Values of a PNG."""
        return np.array(Image.open(self.folder / f"{name}.png"))

    def planes(self, name, channels):
        """The named channels of an OpenEXR file, along the last axis."""
        found = OpenEXR.File(str(self.folder / f"{name}.exr"), separate_channels=True).channels()
        return np.stack([found[channel].pixels for channel in channels], axis=-1)

    def depth_m(self):
        """Depth, with +inf in the sky."""
        return self.planes("depth", "Y")[..., 0]

    def camera_from_body(self, row):
        """From an object's Body to the Camera."""
        return np.linalg.inv(self.table["world_from_camera"]) @ np.array(row["world_from_body"])


def sources(finished):
    """Frames in the order of an export: by scene, variation, view and keyframe."""
    rows = json.loads((finished / "manifest.json").read_text())["frames"]
    rows.sort(key=lambda row: [row[key] for key in ("scene", "variation", "view", "keyframe")])
    return [Source(finished / row["path"]) for row in rows]


def projected(camera_from_body, size_m, intrinsics):
    """The corners of a box in pixels, and the least depth among them."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners = camera_from_body[:3, :3] @ (signs * np.array(size_m) / 2).T + camera_from_body[:3, 3:]
    pixels = np.array(intrinsics) @ corners
    return (pixels[:2] / pixels[2]).T, corners[2].min()


def surrounds(corners, box, margin_px=2.0):
    """Whether projected corners lie around the pixels of a box (first and last column and row)."""
    low, high = np.array(box[:2]), np.array(box[2:]) + 1
    return bool((corners.min(0) <= low + margin_px).all() and (corners.max(0) >= high - margin_px).all())
