"""Trains one network on one or two stages of sets, and measures it."""

import copy
import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn

from trove.train.average import Average
from trove.train.data import Pictures, mixed_batches, shares_of
from trove.train.detection import Detection
from trove.train.experiment import Experiment, Trial, read
from trove.train.folds import Pool
from trove.train.labels import DETECTORS, TARGETS
from trove.train.memory import keep_freed
from trove.train.models import classifier_of, network
from trove.train.segmentation import Segmentation
from trove.train.stock import Stock, class_mixed, random_classes, random_cuts, random_tints, tinted
from trove.train.table import mean

# Steps between two lines of the curve, and before a GPU's steps are recorded.
_LINE_EVERY, _WARM_UP = 20, 5
# Steps between two checkpoints, and seconds that lie between them at least.
_SAVE_EVERY, _SAVE_AFTER_S = 100, 30.0


def run_rows(path: Path, out: Path, threads: int, trial: Trial, rows: list[str]) -> list[dict[str, Any]]:
    """Trains and measures rows of the experiment in the file `path` in one trial; `threads` 0 uses all."""
    if threads:
        torch.set_num_threads(threads)
    experiment = read(path, trial)
    return [found for row in rows for found in run(experiment, row, out, lambda text: print(text, flush=True))]


def run(experiment: Experiment, row: str, out: Path, say: Callable[[str], None]) -> list[dict[str, Any]]:
    """Trains and measures one row in the experiment's trial.

    Finished work in `out` is not repeated, started work is resumed, and rows with the same first stage share it; a
    folder's name contains a hash of everything that went into it, so other data or settings get another folder.
    Returns `{"row", "fold", "seed", "total", "outer", "inner", "images", "curve", "seconds"}` for each rung:
    `total` is its steps (0 without `total` in the file), `outer` what is measured on what is reported and `inner` on what
    choices are made by or `None`: pixel counts (truth, prediction) or the average precision of each class in percent.
    `images` is how many each set has, `curve` holds (stage, step, loss), and `seconds` is the time that the whole run
    spent on what no other row had trained.
    """
    trial, folders = experiment.trial, experiment.folders(row, out)
    name = f"{row} {trial}"
    result = folders[-1][0] / "result.json"
    if not result.exists():
        found = _found(experiment, row, folders, lambda text: say(f"{name}: {text}"))
        partial = result.with_suffix(".partial")
        partial.write_text(json.dumps(found))
        partial.replace(result)
    found = json.loads(result.read_text())
    rungs = found.pop("rungs")
    means = [f"{mean(rung['outer']):.2f}" for rung in rungs]
    say(f"{name}: {experiment.measure} {', '.join(means)}, {found['seconds']:.0f} s")
    return [{"row": row, "fold": trial.fold, "seed": trial.seed, **rung, **found} for rung in rungs]


def trained(experiment: Experiment, row: str, out: Path, say: Callable[[str], None]) -> tuple[nn.Module, torch.device]:
    """The network of a row in the experiment's trial, which is trained like `run` does unless it is finished."""
    run(experiment, row, out, say)
    device = _device()
    model = network(experiment.training.model, experiment.classes, None).to(device)
    state = torch.load(experiment.folders(row, out)[-1][0] / "model.pt", map_location=device, weights_only=True)
    model.load_state_dict(state["model"])
    return model, device


def _device() -> torch.device:
    return torch.device("cuda" if torch.cuda.is_available() else "cpu")


def _found(
    experiment: Experiment, row: str, folders: list[tuple[Path, list[str]]], say: Callable[[str], None]
) -> dict[str, Any]:
    """What the network that is trained in `folders`, one a stage, has learnt at each rung, its curve and time."""
    device = _device()
    keep_freed()
    # Images have one size, so that the fastest convolutions are worth finding.
    torch.backends.cudnn.benchmark = True
    trial, training = experiment.trial, experiment.training
    torch.manual_seed(trial.seed)
    began = time.perf_counter()
    model = network(training.model, experiment.classes, training.weights).to(device)
    task = _task(experiment)
    told: dict[str, list[Any]] = {"curve": [], "rungs": [], "seconds": []}

    def measured(learnt: nn.Module, total: int) -> dict[str, Any]:
        pools = {"outer": experiment.val, "inner": experiment.inner}
        return {"total": total} | {
            name: pool and task.measure(learnt, stock_of(experiment, pool, device), experiment.size).tolist()
            for name, pool in pools.items()
        }

    rungs = experiment.rungs(row)
    for number, ((folder, names), steps) in enumerate(zip(folders, experiment.steps(row))):
        trained, last = folder / "model.pt", number == len(folders) - 1
        if trained.exists():
            state = torch.load(trained, map_location=device, weights_only=True)
            model.load_state_dict(state["model"])
            told = state["told"] | {"seconds": told["seconds"]}
            continue
        folder.mkdir(parents=True, exist_ok=True)
        before = {step: total for step, total in rungs.items() if last and step < steps}
        stage = _Stage(experiment, names, number, steps, before, trial.seed * 1000 + number, folder / "checkpoint.pt")
        _train(stage, model, device, told, measured, say)
        told["seconds"].append(time.perf_counter() - began)
        began = time.perf_counter()
        _save(trained, {"model": model.state_dict(), "told": told})
        stage.checkpoint.unlink(missing_ok=True)
    told["rungs"].append(measured(model, rungs[steps]))
    images = {name: len(experiment.pools[name].samples) for _, names in folders for name in names}
    told["seconds"].append(time.perf_counter() - began)
    return {**told, "images": images, "seconds": sum(told["seconds"])}


def _task(
    experiment: Experiment, weights: torch.Tensor | None = None, shares: list[int] | None = None
) -> Segmentation | Detection:
    """What networks of the experiment's model learn; `weights` and `shares` are as `Segmentation` has them."""
    if experiment.training.model in DETECTORS:
        return Detection(experiment.classes)
    return Segmentation(len(experiment.names), weights, shares)


def stock_of(experiment: Experiment, pool: Pool, device: torch.device) -> Stock:
    """What networks are shown as it is, kept since many are measured on the same."""
    of = pool.numbering, experiment.classes, experiment.size, experiment.training.zoom, pool.drawn
    return _kept(tuple(pool.samples), of, device)


@lru_cache(maxsize=8)
def _kept(samples: tuple[Any, ...], of: tuple[str, str, tuple[int, int], float, bool], device: torch.device) -> Stock:
    return Stock([Pictures(list(samples), *of)], device)


@dataclass(frozen=True)
class _Stage:
    """What one stage of a row trains on, the rungs before its end, and the file it resumes from."""

    experiment: Experiment
    names: list[str]
    number: int
    steps: int
    rungs: dict[int, int]
    seed: int
    checkpoint: Path


def _train(
    stage: _Stage,
    model: nn.Module,
    device: torch.device,
    told: dict[str, list[Any]],
    measured: Callable[[nn.Module, int], dict[str, Any]],
    say: Callable[[str], None],
) -> None:
    """Trains on all `names` in mixed batches; an interrupted stage resumes from the checkpoint.

    Adds to what is told, the curve and what each rung has learnt. Where weights are averaged `model` ends with these.
    """
    experiment, names, checkpoint, steps = stage.experiment, stage.names, stage.checkpoint, stage.steps
    pools = [experiment.pools[name] for name in names]
    how = experiment.classes, experiment.size, experiment.training.zoom
    sets = [Pictures(p.samples, p.numbering, *how, p.drawn) for p in pools]
    stock, lengths = Stock(sets, device), [len(s) for s in sets]
    model.train().to(memory_format=torch.channels_last)
    average = Average(model, steps, device) if experiment.training.averaged else None
    step = _Step(stage, model, average, stock, lengths)
    resumed = {"model": model, "optimiser": step.optimiser} | ({"average": average} if average else {})
    first = 0
    if checkpoint.exists():
        state = torch.load(checkpoint, map_location=device, weights_only=True)
        for name, part in resumed.items():
            part.load_state_dict(state[name])
        first = state["step"]
        told.update(state["told"], seconds=[*state["told"]["seconds"], state["seconds"]])
    step.at.fill_(first)
    began = saved = time.perf_counter()
    line = first
    for done in range(first + 1, steps + 1):
        step()
        if done % _LINE_EVERY == 0 or done == steps:
            loss = float(step.losses[line:done].mean())
            line = done
            told["curve"].append([stage.number, done, loss])
            say(f"stage {stage.number + 1} on {'+'.join(names)}, step {done} of {steps}, loss {loss:.3f}")
        if average and done in stage.rungs:
            told["rungs"].append(measured(average.put_into(copy.deepcopy(model)), stage.rungs[done]))
        if done % _SAVE_EVERY == 0 and done < steps and time.perf_counter() - saved >= _SAVE_AFTER_S:
            state = {name: part.state_dict() for name, part in resumed.items()}
            _save(checkpoint, state | {"step": done, "told": told, "seconds": time.perf_counter() - began})
            saved = time.perf_counter()
    if average:
        average.put_into(model)


class _Step:
    """One step of training, whose number and everything drawn for it are on the device.

    On a GPU with its images there the step is recorded once and replayed: to launch its kernels one by one takes longer
    than they do.
    """

    def __init__(self, stage: _Stage, model: nn.Module, average: Average | None, stock: Stock, lengths: list[int]):
        training, steps, device = stage.experiment.training, stage.steps, stock.device
        self._size, self._model, self._average, self._stock = stage.experiment.size, model, average, stock
        starts = np.cumsum([0, *lengths])
        batches = mixed_batches(lengths, training.batch, steps, stage.seed)
        members = np.array([[starts[s] + i for s, i in batch] for batch in batches])
        draws = steps, training.batch, stage.seed
        # The polynomial schedule of DeepLab, unless an average of the weights stands in for its end.
        rates = training.rate * (1 - np.arange(steps) / (steps + 1)) ** (0 if average else 0.9)
        self._members = torch.from_numpy(members).to(device)
        self._cuts = torch.from_numpy(random_cuts(*draws, training.zoom, training.mirrored)).to(device)
        tints = random_tints(*draws, training.colour) if training.colour else None
        self._tints = None if tints is None else torch.from_numpy(tints).to(device)
        classes = len(TARGETS[stage.experiment.classes])
        weights = stock.weights(lengths, classes) if training.balanced else None
        shares = shares_of(training.batch, len(lengths)) if training.norm_by_set else None
        self._task = _task(stage.experiment, weights, shares)
        taken = random_classes(*draws, training.class_mix, classes) if training.class_mix else None
        self._taken = None if taken is None else torch.from_numpy(taken).to(device)
        self._rates = torch.from_numpy(rates.astype(np.float32)).to(device)
        self.at = torch.zeros(1, dtype=torch.int64, device=device)
        self.losses = torch.zeros(steps, device=device)
        self.optimiser = optimiser(model, training.optimiser, training.rate, device)
        self._recorded: Any = None
        self._stream = (
            torch.cuda.Stream(device) if device.type == "cuda" and stock.resident and self._task.recordable else None
        )
        self._before = _WARM_UP

    def __call__(self) -> None:
        if self._stream is None:
            self._once()
        elif self._recorded is not None:
            self._recorded.replay()
        elif self._before:
            # On the stream that it is recorded on, once what was sent to the device is there.
            self._before -= 1
            torch.cuda.synchronize()
            with torch.cuda.stream(self._stream):
                self._once()
            torch.cuda.synchronize()
        else:
            self.optimiser.zero_grad(set_to_none=True)
            self._recorded = torch.cuda.CUDAGraph()
            with torch.cuda.graph(self._recorded, stream=self._stream):
                self._once()
            self._recorded.replay()

    def _once(self) -> None:
        self.optimiser.zero_grad(set_to_none=True)
        rgb, truth = self._stock.cut(self._members[self.at][0], self._cuts[self.at][0], self._size)
        if self._tints is not None:
            rgb = tinted(rgb, self._tints[self.at][0])
        if self._taken is not None:
            rgb, truth = class_mixed(rgb, truth, self._taken[self.at][0])
        rgb = rgb.contiguous(memory_format=torch.channels_last)
        loss = self._task.loss(self._model, rgb, truth)
        loss.backward()
        for group in self.optimiser.param_groups:
            group["lr"].copy_(self._rates[self.at][0] * group["times"])
        self.optimiser.step()
        if self._average:
            self._average.add(self.at)
        self.losses.index_copy_(0, self.at, loss.detach()[None])
        self.at += 1


def optimiser(model: nn.Module, kind: str, rate: float, device: torch.device) -> torch.optim.Optimizer:
    """AdamW that decays weights, but not biases or normalisation, or DeepLab v2's SGD; its rates are tensors."""
    if kind == "sgd":
        classifier = list(classifier_of(model).parameters())
        others = [p for p in model.parameters() if not any(p is own for own in classifier)]
        groups = [{"params": others, "times": 1.0}, {"params": classifier, "times": 10.0}]
        options: dict[str, Any] = {"momentum": 0.9, "weight_decay": 5e-4}
    else:
        decayed = [p for p in model.parameters() if p.ndim > 1]
        plain = [p for p in model.parameters() if p.ndim <= 1]
        groups = [{"params": decayed, "weight_decay": 1e-2}, {"params": plain, "weight_decay": 0.0}]
        groups = [{**group, "times": 1.0} for group in groups]
        options = {"capturable": device.type == "cuda"}
    for group in groups:
        group["lr"] = torch.tensor(rate, device=device)
    return {"adamw": torch.optim.AdamW, "sgd": torch.optim.SGD}[kind](groups, fused=True, **options)


def _save(path: Path, state: dict[str, Any]) -> None:
    partial = path.with_suffix(".partial")
    torch.save(state, partial)
    partial.replace(path)
