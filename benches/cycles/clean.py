"""How long a frame takes that passes as clean (FLIP ≤ 0.05 against the reference), with all labels: `clean.py --help`."""

import metrics
import numpy as np
import scenes
from scenes import KEYFRAME, Scene

BAR_FLIP = 0.05
# The bar's reference of 4,096 samples a pixel would take hours at full size: it is made of a smaller picture, in which a pixel
# sees more detail than in the large one and is noisier. 2,048 samples that pixels share have less noise than 4,096 of
# their own. At full size the reference is coarser, and its own noise counts against the picture.
SMALL, FULL = 0.4, 1.0


def arguments():
    parser = scenes.parser(__doc__)
    parser.add_argument("--spp", type=int, nargs="+", default=[1, 2, 3, 4, 8], help="samples a pixel, denoised")
    parser.add_argument("--reference-small", type=int, default=2048, help="samples a pixel at 640×360")
    parser.add_argument("--reference-full", type=int, default=256, help="samples a pixel at 1600×900")
    return parser.parse_args()


def flips(scene, reference_spp, spps):
    """By samples a pixel: FLIP against the reference, seconds of rendering, and of the whole program."""
    scene.build()
    reference = scene.reference(reference_spp)
    gain = np.float32(2.0 ** reference["exposure_ev"])
    found = {}
    for spp in spps:
        picture, render_s, _ = scene.ours(spp, True)
        found[spp] = metrics.flip(picture * gain, reference["picture"] * gain), render_s, scene.seconds
    return found


def main():
    args = arguments()
    slowest = 0.0
    for name in args.scenes:
        scene = Scene(name, FULL, args)
        small = flips(Scene(name, SMALL, args), args.reference_small, args.spp)
        full = flips(scene, args.reference_full, args.spp)
        print(f"{name}, {scene.view} of keyframe {KEYFRAME}, denoised, {args.threads} threads; seconds with all labels")
        for spp in args.spp:
            print(
                f"  {spp:4} spp: FLIP {small[spp][0]:.4f} at 640×360 against {args.reference_small} spp, "
                f"{full[spp][0]:.4f} at 1600×900 against {args.reference_full} spp; at 1600×900 rendered in "
                f"{full[spp][1]:.1f} s, {full[spp][2]:.1f} s from start to end"
            )
        passing = [full[spp][2] for spp in args.spp if max(small[spp][0], full[spp][0]) <= BAR_FLIP]
        slowest = max(slowest, min(passing, default=float("inf")))
    print(f"clean {slowest:.1f} s")


if __name__ == "__main__":
    main()
