"""Keyframes of the real data (TROVE_TEST_DATA), and a view of a place on its maps, rendered by TRoVE."""

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
import OpenEXR
from PIL import Image

KEYFRAME = 1


class Source(NamedTuple):
    """What a scene is made of: the recipe's first tables, with the folder of data to be put in, and what is seen of it."""

    tables: str
    osm: str
    rig: str
    view: str
    folder: str


def recorded(name, osm):
    tables = f'[drive]\ndataset = "nuscenes"\nroot = "{{data}}/nuscenes"\nscenes = ["{name}"]\n'
    return Source(tables, osm, "CAM_FRONT", "ego.CAM_FRONT", name)


def place(lat_deg, lon_deg, osm):
    tables = f"[place]\nlat_deg = {lat_deg}\nlon_deg = {lon_deg}\nsize_m = 300\n"
    return Source(tables, osm, "dashcam", "ego.front", "place")


SCENES = {
    "scene-0103": recorded("scene-0103", "boston-seaport.osm"),
    "scene-0061": recorded("scene-0061", "singapore-onenorth.osm"),
    "monaco": place(43.7396, 7.4275, "monaco-latest.osm.pbf"),
}


def parser(description):
    """The options that all measurements share."""
    made = argparse.ArgumentParser(description=description)
    made.add_argument("--trove", default="trove", help="the program to measure")
    made.add_argument("--threads", type=int, default=2)
    made.add_argument("--scenes", nargs="+", default=list(SCENES), choices=list(SCENES))
    default = Path(__file__).resolve().parent / ".cache"
    made.add_argument("--cache", type=Path, default=default, help="folder for references and pictures")
    return made


def data():
    """The folder of real data."""
    if "TROVE_TEST_DATA" not in os.environ:
        raise SystemExit("TROVE_TEST_DATA: expected the folder of real data, found nothing; set it")
    return Path(os.environ["TROVE_TEST_DATA"]).resolve()


class Scene:
    """One keyframe, one camera, at `scale` times 1600×900, in the weather that `tables` add to its recipe."""

    def __init__(self, name, scale, args, weather="", tables=""):
        self.name, self.scale, self.args, self.tables = name, scale, args, tables
        self.source = SCENES[name]
        self.view = self.source.view
        self.folder = (args.cache / f"{name}{weather}-{scale:g}").resolve()
        self.folder.mkdir(parents=True, exist_ok=True)

    def recipe(self, spp, denoise):
        path = self.folder / "recipe.toml"
        source = self.source
        path.write_text(
            f'seed = 7\n{source.tables.format(data=data())}[map]\nosm = "{data() / "osm" / source.osm}"\n'
            f'[views]\nrig = "{source.rig}"\n[render]\nscale = {self.scale}\nspp = {spp}\n'
            f"denoise = {str(denoise).lower()}\nradiance = true\nthreads = {self.args.threads}\n{self.tables}"
        )
        return path

    def frames(self, variations):
        """The file that says which frames are rendered."""
        path = self.folder / "frames.json"
        frames = [f"{self.source.folder}/v{v:02}/k{KEYFRAME:03}/{self.view}" for v in range(variations)]
        path.write_text(json.dumps({"train": frames, "val": []}))
        return path

    def generate(self, recipe, out, variations=1):
        """The run's report; `seconds` are then those that the whole program took."""
        shutil.rmtree(out, ignore_errors=True)
        frames = self.frames(variations)
        started = time.monotonic()
        report = trove(self.args, "generate", recipe, "--out", out, "--frames", frames, "--json")
        self.seconds = time.monotonic() - started
        return json.loads(report)

    def build(self):
        """The scene as files for others."""
        self.glb, self.sky = self.folder / "scene.glb", self.folder / "sky.exr"
        recipe = self.recipe(1, False)
        trove(self.args, "build", recipe, "--out", self.glb, "--keyframe", KEYFRAME, "--environment", self.sky)
        self.digest = digest([recipe, self.glb, self.sky])

    def ours(self, spp, denoise):
        """Radiance, seconds of rendering with all labels, seconds of preparing."""
        out = self.folder / "ours"
        report = self.generate(self.recipe(spp, denoise), out)
        (timing,) = report["timings"]
        frame = out / timing["path"]
        table = json.loads((frame / "frame.json").read_text())
        assert table["denoised"] == denoise, "the denoiser is missing: see trove doctor"
        self.exposure_ev = table["exposure_ev"]
        self.classes = np.asarray(Image.open(frame / "class.png"))
        self.names = [row["name"] for row in json.loads((out / "manifest.json").read_text())["classes"]]
        return radiance(frame / "radiance.exr"), timing["render_seconds"], timing["prepare_seconds"]

    def halves(self, spp):
        """Two undenoised references that differ by their noise alone, and the exposure; kept as one is."""
        program = digest(programs(self.args.trove))
        kept = self.folder / f"halves-{spp}-{self.digest}-{program}.npz"
        if not kept.exists():
            out = self.folder / "halves"
            recipe = self.recipe(spp, False)
            recipe.write_text(recipe.read_text() + "[variations]\ncount = 2\nfactors = []\n")
            report = self.generate(recipe, out, 2)
            frames = [out / timing["path"] for timing in report["timings"]]
            exposure_ev = json.loads((frames[0] / "frame.json").read_text())["exposure_ev"]
            first, second = (radiance(frame / "radiance.exr") for frame in frames)
            np.savez(kept, first=first, second=second, exposure_ev=exposure_ev)
        return np.load(kept)

    def reference(self, spp):
        """The undenoised reference with its exposure and classes, kept as long as scene and program stay the same."""
        program = digest(programs(self.args.trove))
        kept = self.folder / f"ours-{spp}-{self.digest}-{program}.npz"
        if not kept.exists():
            picture, *_ = self.ours(spp, False)
            np.savez(kept, picture=picture, exposure_ev=self.exposure_ev, classes=self.classes, names=self.names)
        return np.load(kept)


def trove(args, *words):
    """Runs the program and returns what it printed."""
    done = subprocess.run([args.trove, *map(str, words)], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(done.stderr)
    return done.stdout


def programs(trove_command):
    """The files that a trove program consists of: the Python module beside it, or itself."""
    command = Path(shutil.which(trove_command) or trove_command).resolve()
    return sorted(command.parent.parent.glob("lib/python*/site-packages/trove/_trove*")) or [command]


def digest(paths):
    hashed = hashlib.sha256()
    for path in paths:
        hashed.update(Path(path).read_bytes())
    return hashed.hexdigest()[:12]


def radiance(path):
    """The R, G, B channels of an EXR file, height × width × 3."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        ending = {name.rsplit(".", 1)[-1]: channel.pixels for name, channel in channels.items()}
        return np.stack([ending[name] for name in "RGB"], axis=-1).astype(np.float32)
