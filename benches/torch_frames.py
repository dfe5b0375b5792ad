"""Frames a second that trove.torch.Frames gives two workers, and what Pillow and OpenEXR reach on the same files.

    make bench-torch            # or: python benches/torch_frames.py [OUT]

Without OUT, labels and images of the demo's drive are generated in 480 × 360 first. Both sides give tensors of the
image, the classes and, with --depth, the depth, in batches of 8; epochs alternate, and the best of each side counts.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import torch
import trove
from PIL import Image
from torch.utils.data import DataLoader, Dataset
from trove.torch import Frames

WORKERS = 2
EPOCHS = 5


class Plain(Dataset[Any]):
    """The same files, read by Pillow and OpenEXR."""

    def __init__(self, folder: Path, depth: bool) -> None:
        self.folders, self.depth = [frame.path for frame in trove.open(folder)], depth

    def __len__(self) -> int:
        return len(self.folders)

    def __getitem__(self, index: int) -> Any:
        folder = self.folders[index]
        image = torch.from_numpy(np.array(Image.open(folder / "rgb.png"))).permute(2, 0, 1)
        target = {"class": torch.from_numpy(np.array(Image.open(folder / "class.png")))}
        if self.depth:
            with OpenEXR.File(str(folder / "depth.exr"), separate_channels=True) as file:
                target["depth"] = torch.from_numpy(file.channels()["Y"].pixels)
        return image, target


class Repeated(Dataset[Any]):
    """A dataset as often as makes an epoch of about so many frames, which starting workers does not decide."""

    def __init__(self, inner: Any, frames: int) -> None:
        self.inner, self.times = inner, max(1, frames // len(inner))

    def __len__(self) -> int:
        return self.times * len(self.inner)

    def __getitem__(self, index: int) -> Any:
        return self.inner[index % len(self.inner)]


def rate(loader: Any) -> float:
    """Frames a second in one epoch."""
    started = time.perf_counter()
    count = sum(len(image) for image, _ in loader)
    return count / (time.perf_counter() - started)


def generated(folder: Path) -> Path:
    """A run of the demo's drive in 480 × 360."""
    demo = subprocess.Popen(
        [sys.executable, "-m", "trove", "demo", "--out", folder / "demo"], stderr=subprocess.DEVNULL
    )
    source = folder / "demo" / ".trove" / "demo"
    while not (source / "recipe.toml").exists() and demo.poll() is None:
        time.sleep(0.05)
    demo.kill()
    demo.wait()
    recipe = source / "small.toml"
    text = (source / "recipe.toml").read_text().replace("keyframes = [2]", 'keyframes = "all"')
    recipe.write_text(text.replace("scale = 0.5\nspp = 16", "size = [480, 360]\nspp = 4"))
    trove.generate(recipe, folder / "out")
    return folder / "out"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path, nargs="?", help="output folder of trove generate")
    parser.add_argument("--frames", type=int, default=2000, help="frames in an epoch")
    parser.add_argument("--depth", action="store_true", help="read depth too")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.out or generated(Path(temporary))
        targets = ("class", "depth") if arguments.depth else ("class",)
        sides = {"trove.torch.Frames": Frames(folder, targets), "Pillow and OpenEXR": Plain(folder, arguments.depth)}
        loaders = {
            name: DataLoader(
                Repeated(side, arguments.frames), batch_size=8, num_workers=WORKERS, persistent_workers=True
            )
            for name, side in sides.items()
        }
        # The first epoch starts the workers.
        rates = [{name: rate(loader) for name, loader in loaders.items()} for _ in range(EPOCHS + 1)][1:]
    best = {name: max(row[name] for row in rates) for name in loaders}
    for name, value in best.items():
        print(f"{name:20} {value:7.0f} frames/s")
    ours, theirs = best.values()
    print(f"{100 * ours / theirs:.0f} % of what plain reads reach")


if __name__ == "__main__":
    main()
