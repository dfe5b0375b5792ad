"""`python -m trove.train EXPERIMENT.toml --out DIR`: trains every row of the table and writes it."""

import argparse
import sys
from pathlib import Path


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m trove.train", description="Measures what datasets are worth for training.", epilog="Example: python -m trove.train camvid.toml --out results")
    parser.add_argument("experiment", type=Path, help="the experiment, TOML")
    parser.add_argument("--out", type=Path, required=True, help="folder for runs and table; what is finished there is kept")
    parser.add_argument("--rows", nargs="*", help="only these rows of the experiment")
    parser.add_argument("--threads", type=int, default=0, help="threads on the CPU; 0 is all")
    options = parser.parse_args()
    try:
        import torch
    except ModuleNotFoundError:
        print("error: PyTorch is missing; pip install 'trove-scenes[train]'", file=sys.stderr)
        return 1
    from trove.train import table
    from trove.train.experiment import ExperimentError, read
    from trove.train.labels import TARGETS
    from trove.train.training import run

    if options.threads:
        torch.set_num_threads(options.threads)
    try:
        experiment = read(options.experiment)
        summaries, everything = {}, []
        for row in options.rows or experiment.rows:
            results = [run(experiment, row, seed, options.out, lambda text: print(text, flush=True)) for seed in experiment.training.seeds]
            everything += results
            summaries[row] = table.summary(results)
            classes = TARGETS[experiment.classes]
            # After every row, so that an interrupted experiment has a table too.
            (options.out / "table.md").write_text(table.markdown(classes, summaries, experiment.compare))
            (options.out / "table.tex").write_text(table.latex(classes, summaries))
            (options.out / "curves.svg").write_text(table.curves(everything))
    except (ExperimentError, ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted; the same command goes on from here", file=sys.stderr)
        return 1
    print((options.out / "table.md").read_text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
