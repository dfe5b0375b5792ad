"""Checks that flow of `trove generate` ends where it should: on the same object, and from there back.

As a program: `check_flow.py DIR`; it prints what it compared and fails where a bar is missed. Both ends of an arrow are
points, and pictures are samples of points: compared is where the four pixels around an arrow's end show one object, and
the way back where they show one surface of it: at depths within 5 %, and turned by less than 30° against each other,
which leaves and blades of grass that are thinner than a pixel are not.
"""

import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
from check_output import exr
from PIL import Image

PERSON, RIDERS = 7, (12, 16)
# Shares of the pixels that are not occluded, of so many.
ENOUGH = 1000
BARS = {"people": 0.99, "riders": 0.99, "everything else": 0.995}
# Forward and backward flow together, pixels.
MEDIAN_PX, MOST_PX = 0.05, 0.5


def read(folder):
    """A frame's labels by the names of their files."""
    pictures = {path.stem: np.asarray(Image.open(path)) for path in folder.glob("*.png")}
    return pictures | {path.stem: exr(path) for path in folder.glob("*.exr")}


def arrows(frame, neighbour, way, back):
    """Where a frame's arrows are compared, whether each ends on its own object, and forward and backward flow together
    (NaN where the way back is hidden or not on one surface)."""
    flow = frame[f"flow_{way}"]
    height, width = flow.shape[:2]
    x, y = flow[..., 0] + np.arange(width), flow[..., 1] + np.arange(height)[:, None]
    with np.errstate(invalid="ignore"):
        inside = (x >= 0) & (y >= 0) & (x <= width - 1) & (y <= height - 1)
    x, y = (np.where(inside, values, 0) for values in (x, y))
    left, top = np.minimum(x.astype(int), width - 2), np.minimum(y.astype(int), height - 2)
    u, v = x - left, y - top
    around = [(top, left), (top, left + 1), (top + 1, left), (top + 1, left + 1)]
    shares = [(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v]
    ids = np.stack([neighbour["instance"][place] for place in around])
    compared = inside & (frame[f"occluded_{way}"] == 0) & (ids == ids[0]).all(axis=0)
    is_same = ids[0] == frame["instance"]
    depths = np.stack([neighbour["depth"][place] for place in around])
    # Sky is infinitely far.
    with np.errstate(invalid="ignore"):
        is_one = np.isinf(depths).all(axis=0) | (np.ptp(depths, axis=0) <= 0.05 * depths.min(axis=0))
    normals = [neighbour["normal"][place] for place in around]
    is_one &= np.all([np.linalg.norm(normal - normals[0], axis=-1) < 0.5 for normal in normals], axis=0)
    hidden = np.any([neighbour[f"occluded_{back}"][place] != 0 for place in around], axis=0)
    returned = sum(s[..., None] * neighbour[f"flow_{back}"][place] for s, place in zip(shares, around, strict=True))
    together = np.where(hidden | ~is_same | ~is_one, np.nan, np.linalg.norm(flow + returned, axis=-1))
    return compared, is_same, together


def check(root):
    """Compares all pairs of neighbouring keyframes of an output folder."""
    tables = sorted(Path(root).glob("*/v*/k*/*/frame.json"))
    folders = {table.parent.relative_to(root).parts: table.parent for table in tables}
    counts, together = defaultdict(lambda: np.zeros(2, int)), []
    for (scene, variation, keyframe, view), folder in folders.items():
        after = folders.get((scene, variation, f"k{int(keyframe[1:]) + 1:03}", view))
        if after is None:
            continue
        pair = read(folder), read(after)
        for way, back in (("forward", "backward"), ("backward", "forward")):
            frame, neighbour = pair if way == "forward" else pair[::-1]
            compared, is_same, error = arrows(frame, neighbour, way, back)
            people, riders = frame["class"] == PERSON, np.isin(frame["class"], RIDERS)
            for name, mask in (("people", people), ("riders", riders), ("everything else", ~people & ~riders)):
                counts[name] += [(compared & mask).sum(), (compared & mask & is_same).sum()]
            together.append(error[compared & ~np.isnan(error)])
    for name, (all_, same) in counts.items():
        share = same / max(all_, 1)
        print(f"{name}: {share:.2%} of {all_} pixels end on the same object")
    error = np.concatenate(together)
    median, most = np.quantile(error, [0.5, 0.99])
    print(f"forward and backward: {median:.4f} px in the median, {most:.3f} px at 99 % of {len(error)} pixels")
    missed = [name for name, (all_, same) in counts.items() if all_ >= ENOUGH and same < BARS[name] * all_]
    assert not missed, f"less than {[BARS[name] for name in missed]} of {missed}"
    assert median <= MEDIAN_PX and most <= MOST_PX


if __name__ == "__main__":
    check(sys.argv[1])
