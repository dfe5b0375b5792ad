"""`python -m trove.train EXPERIMENT.toml --out DIR`: trains every row of the table and writes it."""

import argparse
import signal
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from trove.train.command import lacks_torch


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m trove.train",
        description="Measure what datasets are worth for training.",
        epilog="Example: python -m trove.train camvid.toml --out results",
    )
    parser.add_argument("experiment", type=Path, help="experiment file (TOML)")
    parser.add_argument(
        "--out", type=Path, required=True, help="output folder for runs and table; finished runs are kept"
    )
    parser.add_argument("--rows", nargs="+", help="train only these rows")
    parser.add_argument("--folds", nargs="+", help="train only while these folds are held out")
    parser.add_argument("--seeds", nargs="+", type=int, help="train only with these seeds")
    parser.add_argument("--threads", type=int, default=0, help="CPU threads per job; 0 uses all")
    parser.add_argument(
        "--jobs",
        type=int,
        default=1,
        help="seeds and rows to train in parallel, each in its own process",
    )
    options = parser.parse_args()
    if lacks_torch():
        return 1
    from trove.train.experiment import ExperimentError, read
    from trove.train.report import write
    from trove.train.training import run_rows

    try:
        experiment = read(options.experiment)
        rows = _chosen("rows", options.rows, experiment.rows)
        folds = _chosen("folds", options.folds, experiment.folds)
        seeds = _chosen("seeds", options.seeds, experiment.training.seeds)
        trials = [trial for trial in experiment.trials() if trial.fold in folds and trial.seed in seeds]
        results: list[dict[str, Any]] = []
        train = partial(run_rows, options.experiment, options.out, options.threads)
        groups = [(trial, group) for trial in trials for group in experiment.alike(rows)]
        failed = False
        # Workers end at once when interrupted, instead of taking the next rows.
        ends = signal.signal, (signal.SIGINT, signal.SIG_DFL)
        with ProcessPoolExecutor(options.jobs, get_context("spawn"), *ends) as jobs:
            calls: list[Callable[[], list[dict[str, Any]]]] = [partial(train, *group) for group in groups]
            if options.jobs > 1:
                calls = [jobs.submit(call).result for call in calls]
            try:
                for (trial, group), call in zip(groups, calls):
                    try:
                        results += call()
                    except Exception as error:
                        # The others are worth having.
                        failed = True
                        print(f"error: {', '.join(group)}, {trial}: {type(error).__name__}: {error}", file=sys.stderr)
                        continue
                    # After every group, so that an interrupted experiment has a table too.
                    write(experiment, rows, results, options.out)
            finally:
                jobs.shutdown(cancel_futures=True)
    except (ExperimentError, ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted; run the same command to resume", file=sys.stderr)
        return 1
    if results:
        print((options.out / "table.md").read_text())
    return int(failed)


def _chosen(option: str, wanted: list[Any] | None, known: Sequence[Any]) -> list[Any]:
    """What is asked for of what the experiment has, or all of it."""
    unknown = [str(one) for one in wanted or [] if one not in known]
    if unknown:
        names = ", ".join(str(one) for one in known if one != "")
        expected = f"expected some of {names}" if names else "expected none: the file has no [folds]"
        raise ValueError(f"--{option}: {expected}, found {', '.join(unknown)}")
    return list(wanted or known)


if __name__ == "__main__":
    sys.exit(main())
