"""Compares a simulated LiDAR sweep with the recorded one of the same moment (the folder in TROVE_TEST_DATA).

`lidar.py nuscenes` makes keyframe 0 of scene-0061 with an HDL-32E, `lidar.py kitti` frame 0 of drive 0005 with an
HDL-64E, `lidar.py kitti-object` object frame 000001 likewise, to which nothing was fitted, and `lidar.py argoverse2` the
first recorded sweep of the log with two VLP-32Cs. It prints shares of beams that bring something back, ranges,
intensities and how near recorded points are to simulated surfaces (points of a second sweep of eight times as many rings
and four times as many columns), and draws both from above, coloured by height.
"""

import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

# Ranges whose histograms are compared, metres.
RANGES_M = [2, 5, 10, 15, 20, 30, 40, 60, 80, 100]
NEAR_M = 0.5
# Recorded returns nearer than this are the vehicle's own, or stand for none.
OWN_M = 2.5
# From above: half a side, metres, and pixels a metre.
HALF_M, SCALE = 50, 8

SCENES = {
    "nuscenes": {
        "recipe": 'dataset = "nuscenes"\nroot = "{data}/nuscenes"\nscenes = ["scene-0061"]\nkeyframes = [0]\n'
        '[map]\nosm = "{data}/osm/singapore-onenorth.osm"\n[views]\nrig = ["CAM_FRONT"]',
        "lidars": {"LIDAR_TOP": "hdl-32e"},
        "beams": 34_688,
        "file": "nuscenes/samples/LIDAR_TOP/*.pcd.bin",
        "columns": 5,
        "ahead": [0.0, 1.0, 0.0],
    },
    "kitti": {
        "recipe": 'dataset = "kitti"\nroot = "{data}/kitti/raw"\nscenes = ["2011_09_26_drive_0005_sync"]\n'
        'keyframes = [0]\n[views]\nrig = ["image_02"]',
        "lidars": {"velodyne": "hdl-64e"},
        "beams": 133_312,
        "file": "kitti/raw/2011_09_26/*0005*/velodyne_points/data/0000000000.bin",
        "columns": 4,
        "intensity": 255.0,
    },
    "kitti-object": {
        "recipe": 'dataset = "kitti"\nroot = "{data}/kitti/object"\nscenes = ["000001"]\n[views]\nrig = ["image_02"]',
        "lidars": {"velodyne": "hdl-64e"},
        "beams": 133_312,
        "file": "kitti/object/training/velodyne/000001.bin",
        "columns": 4,
        "intensity": 255.0,
    },
    "argoverse2": {
        "recipe": 'dataset = "argoverse2"\nroot = "{data}/argoverse2"\nkeyframes = [116]\n[map]\n'
        'geojson_frame = "dataset"\nosm = "{data}/argoverse2/osm_roads_PIT_cityframe.geojson"\n'
        '[views]\nrig = ["ring_front_center"]',
        "lidars": {"up_lidar": "vlp-32c", "down_lidar": "vlp-32c"},
        "beams": 115_712,
        "file": "argoverse2/*/sensors/lidar/315966265259836000.feather",
        "frame": "world_from_ego",
    },
}


def dense(folder):
    """A LiDAR without noise or drop-out that sees the simulated surfaces closely."""
    path = folder / "dense.toml"
    path.write_text(
        "elevations_deg = [{ from = -30.67, to = 10.67, count = 256 }]\nrate_hz = 20\ncolumns = 4336\n"
        "divergence_mrad = 0.1\nnearest_m = 0.05\nfarthest_m = 150\nreach_m = 2000\nnoise_m = 0\npulse_m = 0.8\n"
    )
    return path


def recorded(scene, data):
    """Rows of x, y, z and intensity (0 to 255) of a recorded sweep."""
    (file,) = data.glob(scene["file"])
    if file.suffix == ".feather":
        from pyarrow import feather

        table = feather.read_table(file)
        return np.stack([table[name].to_numpy().astype(np.float64) for name in ("x", "y", "z", "intensity")], axis=1)
    real = np.fromfile(file, "<f4").reshape(-1, scene["columns"])[:, :4].astype(np.float64)
    real[:, 3] *= scene.get("intensity", 1.0)
    return real


def simulated(trove, scene, data, folder):
    """The points of all LiDARs, and those of the dense ones, in the frame of the recorded sweep, and the run's timings."""
    lidars = scene["lidars"] | {"DENSE": dense(folder)}
    recipe = folder / "recipe.toml"
    recipe.write_text(
        "seed = 7\n[drive]\n"
        + scene["recipe"].format(data=data)
        + "\n[render]\nscale = 0.25\nlight = false\n"
        + "".join(f'[sensors.{name}]\nkind = "lidar"\npreset = "{preset}"\n' for name, preset in lidars.items())
    )
    command = [*trove, "generate", str(recipe), "--out", str(folder / "out"), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(done.stderr)
    timings = json.loads(done.stdout)["timings"]
    found = {}
    for path in (folder / "out").glob("*/v00/k*/ego.*/points.npy"):
        table = json.loads((path.parent / "sweep.json").read_text())
        points = np.load(path)
        points = points[points["instance"] != (table["carrier"] or -1)]
        own = np.linalg.inv(table[scene.get("frame", "world_from_lidar")]) @ table["world_from_lidar"]
        for axis, values in zip("xyz", (xyz(points) @ own[:3, :3].T + own[:3, 3]).T, strict=True):
            points[axis] = values
        found[path.parent.name.removeprefix("ego.")] = points
    dense_points = found.pop("DENSE")
    return np.concatenate(list(found.values())), dense_points, timings


def xyz(points):
    return np.stack([points[axis] for axis in "xyz"], axis=1).astype(np.float64)


def nearest_m(points, others):
    """Distance from each point to the nearest of others, at most NEAR_M, by cells of that size."""
    cells = {}
    for i, key in enumerate(map(tuple, np.floor(others / NEAR_M).astype(int))):
        cells.setdefault(key, []).append(i)
    around = [(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]
    found = np.full(len(points), np.inf)
    for i, (point, cell) in enumerate(zip(points, np.floor(points / NEAR_M).astype(int), strict=True)):
        beside = [j for step in around for j in cells.get(tuple(cell + step), ())]
        if beside:
            found[i] = np.sqrt(((others[beside] - point) ** 2).sum(1).min())
    return found


def from_above(points, forward):
    """A picture from above, ahead up, coloured by height."""
    side = 2 * HALF_M * SCALE
    picture = Image.new("RGB", (side, side), (12, 12, 16))
    pixels = picture.load()
    ahead = points @ forward
    left = points @ np.array([-forward[1], forward[0], 0.0])
    for a, b, z in zip(ahead, left, points[:, 2], strict=True):
        column, row = int((HALF_M - b) * SCALE), int((HALF_M - a) * SCALE)
        if 0 <= column < side and 0 <= row < side:
            share = min(max((z + 2.5) / 6, 0), 1)
            pixels[column, row] = (int(80 + 175 * share), int(220 - 120 * abs(2 * share - 1)), int(255 - 200 * share))
    return picture


def told(name, real, made, beams):
    """Prints shares and histograms of both."""
    print(f"{name:26} {'recorded':>9} {'simulated':>9}")
    print(f"{'beams that return':26} {len(real) / beams:9.3f} {len(made) / beams:9.3f}")
    ranges = [np.linalg.norm(points[:, :3], axis=1) for points in (real, made)]
    shares = [np.histogram(r, bins=RANGES_M)[0] / beams for r in ranges]
    for low, high, a, b in zip(RANGES_M, RANGES_M[1:], *shares, strict=False):
        print(f"{f'{low} to {high} m':26} {a:9.3f} {b:9.3f}")
    for percent in (5, 25, 50, 75, 95):
        both = [np.percentile(points[:, 3], percent) for points in (real, made)]
        print(f"{f'intensity, {percent} %':26} {both[0]:9.0f} {both[1]:9.0f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset", choices=SCENES)
    parser.add_argument("--trove", nargs="+", default=["trove"], help="the program")
    parser.add_argument("--picture", type=Path, help="where to draw both from above (PNG)")
    arguments = parser.parse_args()
    if "TROVE_TEST_DATA" not in os.environ:
        parser.error("TROVE_TEST_DATA: expected the folder with real data, found nothing set")
    data = Path(os.environ["TROVE_TEST_DATA"]).resolve()
    scene = SCENES[arguments.dataset]
    real = recorded(scene, data)
    with tempfile.TemporaryDirectory() as folder:
        points, surfaces, timings = simulated(arguments.trove, scene, data, Path(folder))
        classes = json.loads((Path(folder) / "out/manifest.json").read_text())["classes"]
    names = {row["id"]: row["name"] for row in classes}
    made = np.column_stack([xyz(points), points["intensity"]])
    real, own = (p[np.linalg.norm(p[:, :3], axis=1) > OWN_M] for p in (real, made))
    told(f"beyond {OWN_M} m", real, own, scene["beams"])
    for label, all_of in (("point", made[:, :3]), ("surface", xyz(surfaces))):
        near = nearest_m(real[:, :3], all_of) <= NEAR_M
        print(f"recorded points within {NEAR_M} m of a simulated {label}: {near.mean():.3f}")
    for value in np.unique(points["class"]):
        of = points["intensity"][points["class"] == value]
        low, middle, high = np.percentile(of, (25, 50, 75))
        print(f"simulated intensity on {names[value]:16} {low:5.0f} {middle:5.0f} {high:5.0f}  ({len(of)})")
    for row in timings:
        print(row)
    if arguments.picture:
        forward = np.array(scene.get("ahead", [1.0, 0.0, 0.0]))
        pictures = [from_above(p[:, :3], forward) for p in (real, own)]
        sheet = Image.new("RGB", (2 * pictures[0].width + 8, pictures[0].height + 16), (255, 255, 255))
        for i, (picture, title) in enumerate(zip(pictures, ("recorded", "simulated"), strict=True)):
            sheet.paste(picture, (i * (picture.width + 8), 16))
            ImageDraw.Draw(sheet).text((i * (picture.width + 8) + 4, 2), title, fill=(0, 0, 0))
        sheet.save(arguments.picture)


if __name__ == "__main__":
    main()
