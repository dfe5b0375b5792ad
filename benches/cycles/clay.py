"""Whether TRoVE and Cycles agree where they should: a street of grey clay under one sun and sky: `clay.py --help`."""

import argparse
import subprocess
from pathlib import Path

import numpy as np
from bench import run_job, side_by_side
from scenes import radiance

BOUNCES = 6  # as TRoVE's paths have
BLOCK_PX = 8
# Pixels are filtered differently, which shows where blocks have edges, and the exported sun has no darker limb.
WHOLE, NEAR_SHARE, NEAR = 0.002, 0.99, 0.05


def arguments():
    made = argparse.ArgumentParser(description=__doc__)
    made.add_argument("example", help="the program `clay` (crates/trove/examples), built with optimisations")
    made.add_argument("--scale", type=float, default=0.2, help="of 1600×900")
    made.add_argument("--spp", type=int, default=1024, help="samples a pixel")
    made.add_argument("--threads", type=int, default=2)
    default = Path(__file__).resolve().parent / ".cache" / "clay"
    made.add_argument("--out", type=Path, default=default, help="folder for scene and pictures")
    return made.parse_args()


def blocks(picture):
    """Mean brightness of squares of pixels."""
    height, width = (n // BLOCK_PX * BLOCK_PX for n in picture.shape[:2])
    grey = picture[:height, :width].mean(axis=-1, dtype=np.float64)
    return grey.reshape(height // BLOCK_PX, BLOCK_PX, width // BLOCK_PX, BLOCK_PX).mean(axis=(1, 3))


def sharpness(pair, least, most):
    """Mean product of two pictures' differences of neighbouring pixels, between two levels: noise is in one alone."""
    grey = [np.log(np.clip(picture.mean(axis=-1, dtype=np.float64), least, most)) for picture in pair]
    return sum(np.prod([np.diff(picture, axis=axis) for picture in grey], axis=0).mean() for axis in (0, 1))


def main():
    args = arguments()
    out = args.out.resolve()
    subprocess.run([args.example, out, str(args.scale), str(args.spp)], check=True)
    pictures = [{"name": str(i), "spp": args.spp, "adaptive": False, "denoise": False, "seed": i} for i in (1, 2)]
    job = {"glb": str(out / "scene.glb"), "environment": str(out / "sky.exr"), "view": "ego.CAM_FRONT"}
    run_job(out, {**job, "threads": args.threads, "pictures": pictures, "bounces": BOUNCES, "unbiased": True})
    theirs = [radiance(out / f"{i}.exr") for i in (1, 2)]
    ours = [np.fromfile(out / f"{i}.f32", np.float32).reshape(theirs[0].shape) for i in (1, 2)]
    mean_ours, mean_theirs = (sum(pair) / 2 for pair in (ours, theirs))
    gain = np.float32(0.18 / np.median(mean_ours))
    side_by_side(out / "clay.png", mean_ours * gain, mean_theirs * gain)

    a, b = blocks(mean_ours), blocks(mean_theirs)
    # The difference of two pictures has four times the variance of their mean.
    noise = np.sqrt(sum(((blocks(first) - blocks(second)) ** 2).mean() / 4 for first, second in (ours, theirs)))
    whole = a.mean() / b.mean()
    # Noise alone may be as large as a block's difference; what is more than that counts as far.
    near = np.abs(a - b) <= NEAR * b + 3.0 * noise
    print(f"ours / Cycles: whole picture {whole:.4f}, median of blocks {np.median(a / b):.4f}")
    print(f"noise of a block {noise / b.mean():.4f} of the mean; {near.mean():.1%} of blocks are within {NEAR:.0%}")
    for low, high in ((0, 0.1), (0.1, 0.3), (0.3, 0.6), (0.6, 1.0)):
        of = (b >= np.quantile(b, low)) & (b <= np.quantile(b, high))
        print(f"    {low:.0%} to {high:.0%} by brightness: {a[of].mean() / b[of].mean():.4f}")
    middle = np.median(mean_theirs)
    sharper = sharpness(ours, 0.05 * middle, 4 * middle) / sharpness(theirs, 0.05 * middle, 4 * middle)
    print(f"squared differences of neighbouring pixels {sharper:.3f}")
    if abs(whole - 1.0) > WHOLE or near.mean() < NEAR_SHARE:
        raise SystemExit(f"expected the whole within {WHOLE:.1%} and {NEAR_SHARE:.0%} of blocks within {NEAR:.0%}")


if __name__ == "__main__":
    main()
