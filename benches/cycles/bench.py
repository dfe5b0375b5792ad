"""TRoVE against Blender's Cycles on the same scenes, machine and run: `bench.py --help`."""

import json
import subprocess
import sys
from pathlib import Path

import curves
import metrics
import numpy as np
import scenes
from PIL import Image
from scenes import KEYFRAME, Scene, digest, radiance

IN_CYCLES = Path(__file__).resolve().parent / "in_cycles.py"


def arguments():
    parser = scenes.parser(__doc__)
    parser.add_argument("--scale", type=float, default=0.2, help="of 1600×900")
    parser.add_argument("--ours", type=int, nargs="+", default=[1, 4, 16, 64], help="samples a pixel")
    parser.add_argument("--cycles", type=int, nargs="+", default=[4, 16, 64], help="samples a pixel")
    parser.add_argument("--adaptive", type=int, nargs="+", default=[64, 256], help="most samples a pixel, adaptive")
    parser.add_argument("--reference", type=int, default=1024, help="samples a pixel of both references")
    parser.add_argument("--quick", action="store_true", help="tiny and rough: to see that it works")
    args = parser.parse_args()
    if args.quick:
        args.scale, args.reference = 0.1, 256
        args.ours, args.cycles, args.adaptive = [1, 4, 16], [4, 16], [16, 64]
    return args


def cycles(scene, pictures):
    """Renders pictures, by name, and returns times.json."""
    folder = scene.folder / "cycles"
    folder.mkdir(exist_ok=True)
    job = {"glb": str(scene.glb), "environment": str(scene.sky), "view": scene.view, "threads": scene.args.threads}
    return run_job(folder, {**job, "pictures": pictures})


def run_job(folder, job):
    """Has Cycles take a job's pictures (`in_cycles.py`) in a folder, and returns times.json."""
    (folder / "job.json").write_text(json.dumps({**job, "folder": str(folder)}))
    with (folder / "log.txt").open("w") as log:
        command = [sys.executable, IN_CYCLES, folder / "job.json"]
        subprocess.run(command, stdout=log, stderr=log, check=True)
    return json.loads((folder / "times.json").read_text())


def cycles_all(scene):
    """Pictures by (adaptive, most samples, denoised) and times; the reference comes from the cache if it is there."""
    kept = scene.folder / f"cycles-{scene.args.reference}-{scene.digest}-{digest([IN_CYCLES])}.exr"
    settings = [(False, spp) for spp in scene.args.cycles] + [(True, spp) for spp in scene.args.adaptive]
    keys = [(adaptive, spp, denoise) for denoise in (False, True) for adaptive, spp in settings]
    pictures = [
        {"name": str(i), "spp": spp, "adaptive": adaptive, "denoise": denoise}
        for i, (adaptive, spp, denoise) in enumerate(keys)
    ]
    # The first picture of a process also waits for the hierarchy to be built and for pages of memory.
    pictures.insert(0, {"name": "warm", "spp": 1, "adaptive": False, "denoise": True})
    if not kept.exists():
        pictures.append({"name": "reference", "spp": scene.args.reference, "adaptive": False, "denoise": False})
    times = cycles(scene, pictures)
    if not kept.exists():
        (scene.folder / "cycles" / "reference.exr").rename(kept)
    taken = {key: radiance(scene.folder / "cycles" / f"{i}.exr") for i, key in enumerate(keys)}
    seconds = {key: times["pictures"][str(i)] for i, key in enumerate(keys)}
    return radiance(kept), taken, seconds, times


def agreement(ours, theirs, classes, names):
    """Prints how the references' mean radiances compare, over the whole and by class."""
    a, b = ours.mean(axis=-1, dtype=np.float64), theirs.mean(axis=-1, dtype=np.float64)
    print(
        f"  references, ours / Cycles: whole picture {a.mean() / b.mean():.3f}, FLIP {metrics.flip(ours, theirs):.3f}"
    )
    for number, name in enumerate(names):
        mask = classes == number
        if mask.mean() > 0.002:
            median = np.median(a[mask] / np.maximum(b[mask], 1e-6))
            print(
                f"    {name:12} {mask.mean():6.1%} of the picture: means {a[mask].mean() / b[mask].mean():.3f}, "
                f"median of pixels {median:.3f}"
            )


def side_by_side(path, *pictures):
    """Tone-mapped pictures above each other, to be looked at."""
    linear = metrics.tone_mapped(np.concatenate(pictures))
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    Image.fromarray((srgb * 255 + 0.5).astype(np.uint8)).save(path)


def measure(scene, args):
    """Measures one scene, prints its tables, and returns its two ratios by name."""
    scene.build()
    reference = scene.reference(args.reference)
    gain = np.float32(2.0 ** reference["exposure_ev"])
    cycles_reference, taken, seconds, times = cycles_all(scene)
    ours_reference, cycles_reference = reference["picture"] * gain, cycles_reference * gain
    height, width = ours_reference.shape[:2]
    warm = times["pictures"]["warm"]
    print(f"{scene.name}, {scene.view} of keyframe {KEYFRAME}, {width}×{height}, {args.threads} threads")
    agreement(ours_reference, cycles_reference, reference["classes"], reference["names"])
    side_by_side(scene.folder / "references.png", ours_reference, cycles_reference)

    curve = {}
    rows = []
    for denoise in (False, True):
        for spp in args.ours:
            picture, render_s, prepare_s = scene.ours(spp, denoise)
            rows.append(("TRoVE", spp, denoise, render_s, picture * gain, ours_reference))
    for (adaptive, spp, denoise), time in seconds.items():
        name = "Cycles adaptive" if adaptive else "Cycles"
        rows.append((name, spp, denoise, time["render_s"], taken[adaptive, spp, denoise] * gain, cycles_reference))
    print(f"  before the first picture: TRoVE prepares {prepare_s:.1f} s; ", end="")
    print(f"Cycles imports {times['import_s']:.1f} s and prepares {warm['total_s'] - warm['render_s']:.1f} s")
    print(f"    {'':16} {'spp':>4} {'':9} {'seconds':>8} {'relMSE':>9} {'FLIP':>7}")
    for name, spp, denoise, render_s, picture, against in rows:
        rel_mse, flip = metrics.rel_mse(picture, against), metrics.flip(picture, against)
        print(f"    {name:16} {spp:4} {'denoised' if denoise else '':9} {render_s:8.2f} {rel_mse:9.5f} {flip:7.4f}")
        for measure_name, value in (("relMSE", rel_mse), ("FLIP", flip)):
            curve.setdefault((measure_name, denoise, name), []).append((render_s, value))
    return ratios(scene.name, curve)


def ratios(scene, curve):
    """Prints how many times faster we are at equal error and returns the two that count."""
    counted = {}
    for measure_name, denoise in [("relMSE", False), ("FLIP", False), ("relMSE", True), ("FLIP", True)]:
        name = f"{scene} {'denoised' if denoise else 'noisy'} {measure_name}"
        others = [curve[measure_name, denoise, other] for other in ("Cycles", "Cycles adaptive")]
        found = curves.ratio(curve[measure_name, denoise, "TRoVE"], others)
        print(f"  {name}: {found[0]:.1f} times as fast ({found[1]:.1f} to {found[2]:.1f})")
        if (measure_name == "FLIP") == denoise:
            counted[name] = found[0]
    return counted


def main():
    args = arguments()
    print(
        "Seconds are those of rendering alone; TRoVE's include all labels. Errors are against each renderer's own "
        f"reference of {args.reference} samples a pixel, undenoised. relMSE: ε = {metrics.RELATIVE_EPSILON} (exposed, a "
        f"grey card has 0.18), without the worst {metrics.TRIMMED_SHARE:.1%} of the pixels. FLIP: Andersson et al. 2020, "
        f"{metrics.PIXELS_PER_DEGREE:.0f} pixels a degree, both tone-mapped alike. At each error the faster of Cycles' "
        "settings counts; ratios are means over the errors that both reach."
    )
    counted = {}
    for name in args.scenes:
        counted |= measure(Scene(name, args.scale, args), args)
    for name, value in counted.items():
        print(f"{name}: {value:.2f}")
    print(f"ratio {min(counted.values()):.1f}")


if __name__ == "__main__":
    main()
