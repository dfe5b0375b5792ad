"""Renders a recipe on a Ray cluster whose nodes share a file system or an object store.

    python -m trove.ray RECIPE --out DIR

It needs the extra `[ray]` on every node, and joins the cluster that `ray start` has made, or starts one of this machine
alone. Each part is a task, which is repeated where it or its node fails; finished frames are kept. Once all parts have
ended, the run that merges them renders what is missing.
"""

from __future__ import annotations

import argparse
import contextlib
import sys
import time
from pathlib import Path
from typing import Any

import ray

import trove

PARTS_A_SLOT = 4  # so that those that end early take more


def render(recipe: str, out: str, part: str, threads: int) -> int:
    """A part's new frames; runs on any node."""
    return trove.generate(recipe, out, part=part, threads=threads)["rendered"]


def slots(threads: int | None) -> tuple[int, int]:
    """Threads a task, by default all of the smallest node, and how many tasks the cluster has room for."""
    nodes = [int(node["Resources"].get("CPU", 0)) for node in ray.nodes() if node["Alive"]]
    cores = [count for count in nodes if count > 0]
    if not cores:
        raise SystemExit(
            "error: expected a Ray cluster with CPUs, found none; start it with ray start --head --num-cpus N"
        )
    each = threads or min(cores)
    return each, max(1, sum(count // each for count in cores))


def told(status: Any) -> str:
    left = status["seconds_left"]
    ends = "" if left is None else f", until {time.strftime('%H:%M', time.localtime(time.time() + left))}"
    return f"{status['finished']} of {status['frames']} frames{ends}"


def main(args: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m trove.ray", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("recipe", type=Path, help="recipe (TOML), at the same path on every node")
    parser.add_argument(
        "--out", required=True, help="output folder at the same path on every node, or s3://bucket/prefix"
    )
    parser.add_argument("--parts", type=int, help=f"number of parts [default: {PARTS_A_SLOT} for each task at once]")
    parser.add_argument("--threads", type=int, help="threads a task [default: the cores of the smallest node]")
    parser.add_argument("--retries", type=int, default=3, help="how often a part that fails is repeated [default: 3]")
    parser.add_argument(
        "--address", help="the cluster [default: that of RAY_ADDRESS or of this machine, else a new one]"
    )
    parser.add_argument("--every", type=float, default=60.0, help="seconds between two lines of progress [default: 60]")
    options = parser.parse_args(args)
    recipe = str(options.recipe.absolute())
    out = options.out if "://" in options.out else str(Path(options.out).absolute())

    ray.init(address=options.address, ignore_reinit_error=True, log_to_driver=False)
    threads, tasks = slots(options.threads)
    parts = options.parts or PARTS_A_SLOT * tasks
    task = ray.remote(num_cpus=threads, max_retries=options.retries, retry_exceptions=True)(render)
    pending = {task.remote(recipe, out, f"{part}/{parts}", threads): part for part in range(1, parts + 1)}
    print(f"{parts} parts, {tasks} at once with {threads} threads each", file=sys.stderr)
    line = time.monotonic()
    while pending:
        done, _ = ray.wait(list(pending), timeout=min(1.0, options.every))
        for reference in done:
            part = pending.pop(reference)
            try:
                ray.get(reference)
            except ray.exceptions.RayError as error:
                # The last run makes what is missing.
                print(f"part {part}/{parts} failed: {str(error).strip().splitlines()[-1]}", file=sys.stderr)
        if time.monotonic() - line > options.every:
            line = time.monotonic()
            with contextlib.suppress(trove.TroveError):  # before the first part has begun
                print(told(trove.status(out)), file=sys.stderr, flush=True)
    summary = trove.generate(recipe, out, threads=options.threads)
    print(f"{summary['frames']} frames, {summary['rendered']} of them made while merging; see {out}/contact_sheet.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
