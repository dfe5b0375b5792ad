"""`python -m trove.train.doubt EXPERIMENT.toml --row P100 --of R …`: what a network is unsure of, class by class.

`trove curate --weights` takes what it writes, so that frames are chosen for what the network has yet to learn. The
pictures' labels are not looked at.
"""

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from trove.train.command import lacks_torch

if TYPE_CHECKING:
    from torch import nn

    from trove.train.stock import Stock


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m trove.train.doubt",
        description="Tell what a network of an experiment is unsure of on pictures whose labels it does not see.",
        epilog="Example: python -m trove.train.doubt camvid.toml --row P100 --of R --out results --weights doubt.toml",
    )
    parser.add_argument("experiment", type=Path, help="experiment file (TOML)")
    parser.add_argument("--row", required=True, help="row of the network, which is trained if it is not yet")
    parser.add_argument("--of", required=True, help="set of the pictures")
    parser.add_argument("--fold", help="fold that is held out; the first, if left out")
    parser.add_argument("--seed", type=int, help="seed of the network; the experiment's first, if left out")
    parser.add_argument("--out", type=Path, required=True, help="folder of the experiment's runs")
    parser.add_argument("--weights", type=Path, required=True, help="file to write (TOML)")
    options = parser.parse_args()
    if lacks_torch():
        return 1
    from trove.train.experiment import ExperimentError, Trial, read
    from trove.train.labels import DETECTORS
    from trove.train.training import stock_of, trained

    try:
        first = read(options.experiment).trial
        trial = Trial(options.fold or first.fold, options.seed or first.seed)
        experiment = read(options.experiment, trial)
        for option, found, known in (("row", options.row, experiment.rows), ("of", options.of, experiment.pools)):
            if found not in known:
                expected = f"expected one of {', '.join(known)}"
                raise ExperimentError(f"{options.experiment}: --{option}: {expected}, found {found}")
        if experiment.training.model in DETECTORS:
            model = experiment.training.model
            raise ExperimentError(f"{options.experiment}: training.model: expected one that segments, found {model}")
        network, device = trained(experiment, options.row, options.out, lambda text: print(text, file=sys.stderr))
        weights = doubts(network, stock_of(experiment, experiment.pools[options.of], device), experiment.size)
        lines = [f'"{name}" = {doubt:.4f}\n' for name, doubt in zip(experiment.names, weights)]
        partial = options.weights.with_name(f"{options.weights.name}.partial")
        partial.write_text(f"# What {options.row} ({trial}) is unsure of on {options.of}.\n" + "".join(lines))
        partial.replace(options.weights)
    except (ExperimentError, ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print("".join(lines), end="")
    return 0


def doubts(network: "nn.Module", stock: "Stock", size: tuple[int, int]) -> np.ndarray:
    """How unsure a network is of each class: the mean entropy of its pixels, each as much as it is likely to be of the
    class, over that of all classes on average. 1 for a class that is nowhere likely.

    `stock` has the images, which are cut to `size` (width, height).
    """
    import torch
    from torch.nn import functional as F

    network.eval()
    unsure = likely = torch.zeros(())
    with torch.no_grad():
        for rgb, _ in stock.whole(size):
            odds = F.log_softmax(network(rgb).float(), 1)
            shares = odds.exp()
            entropy = -(shares * odds).sum(1, keepdim=True)
            unsure, likely = unsure + (shares * entropy).sum((0, 2, 3)), likely + shares.sum((0, 2, 3))
    seen = likely > 1
    found = torch.where(seen, unsure / likely.clamp(min=1), 0)
    weights: np.ndarray = torch.where(seen, found / found[seen].mean(), 1).cpu().numpy()
    return weights


if __name__ == "__main__":
    sys.exit(main())
