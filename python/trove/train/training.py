"""Trains one network on one or two stages of sets, and measures it."""

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn
from torch.nn import functional as F

from trove.train.confusion import iou
from trove.train.data import Pictures, mixed_batches
from trove.train.experiment import Experiment, read
from trove.train.labels import IGNORED, TARGETS
from trove.train.models import network

# Steps between two lines of the curve and between two checkpoints.
_LINE_EVERY, _SAVE_EVERY = 20, 100


def measure(model: nn.Module, pictures: Pictures, classes: int, device: torch.device) -> np.ndarray:
    """Pixel counts (truth, prediction) over all images."""
    model.eval()
    confusion = np.zeros((classes, classes), np.int64)
    with torch.no_grad():
        for start in range(0, len(pictures), 4):
            batch = [pictures[i] for i in range(start, min(start + 4, len(pictures)))]
            truth = np.stack([labels for _, labels in batch]).astype(int)
            logits = model(_tensor(batch, device))
            logits = F.interpolate(logits, truth.shape[1:], mode="bilinear", align_corners=False)
            predicted = logits.argmax(1).cpu().numpy()
            counted = truth != IGNORED
            pairs = truth[counted] * classes + predicted[counted]
            confusion += np.bincount(pairs, minlength=classes * classes).reshape(classes, classes)
    return confusion


def run_rows(path: Path, out: Path, threads: int, seed: int, rows: list[str]) -> list[dict[str, Any]]:
    """Trains and measures rows of the experiment in the file `path` with one seed; `threads` 0 uses all."""
    if threads:
        torch.set_num_threads(threads)
    experiment = read(path)
    return [run(experiment, row, seed, out, lambda text: print(text, flush=True)) for row in rows]


def run(experiment: Experiment, row: str, seed: int, out: Path, say: Callable[[str], None]) -> dict[str, Any]:
    """Trains and measures one row with one seed.

    Finished work in `out` is not repeated, started work is resumed, and rows with the same first stage share it; a
    folder's name contains a hash of everything that went into it, so other data or settings get another folder.
    Returns `{"row", "seed", "confusion", "curve"}`; `curve` holds (stage, step, loss).
    """
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    torch.manual_seed(seed)
    classes = len(TARGETS[experiment.classes])
    model = network(experiment.training.model, classes, experiment.training.weights).to(device)
    curve: list[list[float]] = []
    for number, (folder, names) in enumerate(experiment.folders(row, seed, out)):
        trained = folder / "model.pt"
        if trained.exists():
            state = torch.load(trained, map_location=device, weights_only=True)
            model.load_state_dict(state["model"])
            curve = state["curve"]
            continue
        folder.mkdir(parents=True, exist_ok=True)
        stage = _Stage(experiment, names, number, seed * 1000 + number, folder / "checkpoint.pt")
        _train(stage, model, device, curve, lambda text: say(f"{row} seed {seed}: {text}"))
        _save(trained, {"model": model.state_dict(), "curve": curve})
        (folder / "checkpoint.pt").unlink(missing_ok=True)
    result = folder / "result.json"
    if not result.exists():
        val = Pictures(experiment.val.samples, experiment.val.numbering, experiment.classes, experiment.size, False, 0)
        confusion = measure(model, val, classes, device)
        partial = result.with_suffix(".partial")
        partial.write_text(json.dumps({"seed": seed, "confusion": confusion.tolist(), "curve": curve}))
        partial.replace(result)
    found = {"row": row, **json.loads(result.read_text())}
    say(f"{row} seed {seed}: mIoU {100 * np.nanmean(iou(np.array(found['confusion']))):.2f}")
    return found


@dataclass(frozen=True)
class _Stage:
    """What one stage of a row trains on, and the file it resumes from."""

    experiment: Experiment
    names: list[str]
    number: int
    seed: int
    checkpoint: Path


def _train(
    stage: _Stage, model: nn.Module, device: torch.device, curve: list[list[float]], say: Callable[[str], None]
) -> None:
    """Trains on all `names` in mixed batches; an interrupted stage resumes from the checkpoint."""
    experiment, names, seed, checkpoint = stage.experiment, stage.names, stage.seed, stage.checkpoint
    training = experiment.training
    pools = [experiment.pools[name] for name in names]
    sets = [
        Pictures(p.samples, p.numbering, experiment.classes, experiment.size, True, seed + i)
        for i, p in enumerate(pools)
    ]
    lengths = [len(s) for s in sets]
    steps = training.steps or max(1, training.epochs * sum(lengths) // training.batch)
    batches = mixed_batches(lengths, training.batch, steps, seed)
    optimiser = _optimiser(model, training.rate)
    # The polynomial schedule of DeepLab.
    schedule = torch.optim.lr_scheduler.LambdaLR(optimiser, lambda step: (1 - step / (steps + 1)) ** 0.9)
    mixed = device.type == "cuda" or _fast_bfloat16()
    scaler = torch.amp.GradScaler(device.type, enabled=device.type == "cuda")
    resumed = {"model": model, "optimiser": optimiser, "schedule": schedule, "scaler": scaler}
    first = 0
    if checkpoint.exists():
        state = torch.load(checkpoint, map_location=device, weights_only=True)
        for name, part in resumed.items():
            part.load_state_dict(state[name])
        first = state["step"]
        curve[:] = state["curve"]
    weight = (
        torch.from_numpy(_weights(sets, len(TARGETS[experiment.classes]))).to(device) if training.balanced else None
    )
    loss_of = nn.CrossEntropyLoss(weight, ignore_index=IGNORED)
    model.train().to(memory_format=torch.channels_last)
    lost = []
    for step in range(first, steps):
        for s in sets:
            s.epoch = step
        items = [sets[i][index] for i, index in batches[step]]
        truth = torch.from_numpy(np.stack([labels for _, labels in items])).to(device)
        with torch.autocast(device.type, enabled=mixed):
            logits = model(_tensor(items, device))
        # As in DeepLab v2 the loss is taken at the logits' size.
        truth = F.interpolate(truth[:, None].float(), logits.shape[-2:], mode="nearest")[:, 0].long()
        loss = loss_of(logits.float(), truth)
        optimiser.zero_grad(set_to_none=True)
        scaler.scale(loss).backward()
        scaler.step(optimiser)
        scaler.update()
        schedule.step()
        lost.append(loss.item())
        if (step + 1) % _LINE_EVERY == 0 or step + 1 == steps:
            curve.append([stage.number, step + 1, float(np.mean(lost))])
            say(f"stage {stage.number + 1} on {'+'.join(names)}, step {step + 1} of {steps}, loss {np.mean(lost):.3f}")
            lost = []
        if (step + 1) % _SAVE_EVERY == 0:
            _save(
                checkpoint,
                {name: part.state_dict() for name, part in resumed.items()} | {"step": step + 1, "curve": curve},
            )


def _weights(sets: list[Pictures], classes: int) -> np.ndarray:
    """1 / ln(1.02 + p) for every class with a share p of the pixels (Paszke et al. 2016), each set weighted equally."""
    shares = np.zeros(classes)
    for pictures in sets:
        counts = np.zeros(classes)
        for i in range(len(pictures)):
            counts += np.bincount(pictures.labels(i).ravel(), minlength=256)[:classes]
        shares += counts / counts.sum() / len(sets)
    return (1 / np.log(1.02 + shares)).astype(np.float32)


def _optimiser(model: nn.Module, rate: float) -> torch.optim.Optimizer:
    """AdamW that decays weights, but not biases or normalisation."""
    decayed = [p for p in model.parameters() if p.ndim > 1]
    plain = [p for p in model.parameters() if p.ndim <= 1]
    return torch.optim.AdamW(
        [{"params": decayed, "weight_decay": 1e-2}, {"params": plain, "weight_decay": 0.0}], lr=rate
    )


def _tensor(items: list[tuple[np.ndarray, np.ndarray]], device: torch.device) -> torch.Tensor:
    """The images of pairs as (N, 3, H, W), 0 to 1, channels last."""
    pictures = torch.from_numpy(np.stack([picture for picture, _ in items])).to(device)
    return pictures.permute(0, 3, 1, 2).float() / 255


def _fast_bfloat16() -> bool:
    """Whether the CPU has matrix units for bfloat16 (AMX); without them bfloat16 is slower than float32."""
    return getattr(torch.cpu, "_is_amx_tile_supported", lambda: False)()


def _save(path: Path, state: dict[str, Any]) -> None:
    partial = path.with_suffix(".partial")
    torch.save(state, partial)
    partial.replace(path)
