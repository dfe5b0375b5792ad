"""What weather and night cost beside a clear day, at equal error: `weather.py --help`."""

import curves
import metrics
import numpy as np
import scenes
from scenes import KEYFRAME, Scene

# Evenings; all three are seen by day otherwise.
NIGHT = {
    "scene-0103": "2018-08-01T22:30:00-04:00",
    "scene-0061": "2018-07-24T22:30:00+08:00",
    "monaco": "2018-07-24T22:30:00+02:00",
}
WEATHER = {
    "day": "",
    "haze": "[weather]\nvisibility_m = 2000\n",
    "fog": "[weather]\nvisibility_m = 200\n",
    "rain": "[weather]\nrain_mm_h = 10\n",
    "snow": "[weather]\nsnow = 1.0\nsnowfall_mm_h = 1.0\n",
    "night": '[light]\ntime = "{night}"\n',
}


def arguments():
    parser = scenes.parser(__doc__)
    parser.add_argument("--scale", type=float, default=0.2, help="of 1600×900")
    parser.add_argument("--spp", type=int, nargs="+", default=[4, 16, 64], help="samples a pixel")
    parser.add_argument(
        "--reference", type=int, default=1024, help="samples a pixel of each half of a weather's reference"
    )
    parser.add_argument(
        "--read", action="store_true", help="light that fog scatters often is read from a field; references follow it"
    )
    parser.add_argument("--weather", nargs="+", default=list(WEATHER), choices=list(WEATHER), help="beside the day")
    return parser.parse_args()


def measured(scene, reference, args):
    """By (measure, denoised): the curve of (seconds, error) over samples a pixel; prints a row for each picture."""
    reference.build()
    halves = reference.halves(args.reference)
    gain = np.float32(2.0 ** halves["exposure_ev"])
    first, second = halves["first"] * gain, halves["second"] * gain
    against = (first + second) / 2
    # Of the noise of both halves, which are apart by twice its square, a quarter is left in their mean.
    own = metrics.rel_mse(against + (first - second) / 2, against)
    print(f"    the reference's own relMSE, taken off: {own:.5f}")
    found = {}
    for denoise in (False, True):
        for spp in args.spp:
            picture, seconds, _ = scene.ours(spp, denoise)
            rel_mse = metrics.rel_mse(picture * gain, against) - own
            errors = {"relMSE": rel_mse, "FLIP": metrics.flip(picture * gain, against)}
            row = f"{spp:4} {'denoised' if denoise else '':9} {seconds:8.2f}"
            print(f"    {row} {errors['relMSE']:9.5f} {errors['FLIP']:7.4f}", flush=True)
            for measure, error in errors.items():
                found.setdefault((measure, denoise), []).append((seconds, error))
    return found


def main():
    args = arguments()
    print(
        f"Seconds are those of rendering, with all labels; errors are against twice {args.reference} samples a pixel of the "
        f"same weather, undenoised and exposed as the camera does. relMSE: ε = {metrics.RELATIVE_EPSILON}."
    )
    for name in args.scenes:
        print(f"{name}, keyframe {KEYFRAME}, {args.scale:g} of 1600×900, {args.threads} threads")
        day = None
        for weather in dict.fromkeys(["day", *args.weather]):
            print(f"  {weather}\n    {'spp':>4} {'':9} {'seconds':>8} {'relMSE':>9} {'FLIP':>7}")
            tables = WEATHER[weather].format(night=NIGHT[name])
            scene = reference = Scene(name, args.scale, args, f"-{weather}", tables)
            if args.read:
                # They follow the recipe's `[render]`.
                scene = Scene(name, args.scale, args, f"-{weather}-read", "cache = true\n" + tables)
            found = measured(scene, reference, args)
            day = day or found
            for measure, denoise in found if found is not day else ():
                mean, least, most = curves.ratio(day[measure, denoise], [found[measure, denoise]])
                kind = "denoised" if denoise else "noisy"
                print(f"    {kind} {measure}: {mean:.2f} times the day's time ({least:.2f} to {most:.2f})")


if __name__ == "__main__":
    main()
