"""Trains one network on one or two stages of sets, and measures it."""

import json
import os
from pathlib import Path

import numpy as np
import torch
from torch import nn

from trove.train.data import Pictures, mixed_batches
from trove.train.experiment import Experiment
from trove.train.labels import IGNORED, TARGETS
from trove.train.models import network

# Steps between two lines of the curve and between two checkpoints.
_LINE_EVERY, _SAVE_EVERY = 20, 100


def iou(confusion: np.ndarray) -> np.ndarray:
    """IoU of every class from counts (truth, prediction); NaN where a class is neither there nor predicted."""
    both = np.diag(confusion).astype(float)
    union = confusion.sum(0) + confusion.sum(1) - both
    return np.divide(both, union, out=np.full_like(both, np.nan), where=union > 0)


def measure(model: nn.Module, pictures: Pictures, classes: int, device: torch.device) -> np.ndarray:
    """Counts of pixels (truth, prediction) over all pictures."""
    model.eval()
    confusion = np.zeros((classes, classes), np.int64)
    with torch.no_grad():
        for start in range(0, len(pictures), 4):
            batch = [pictures[i] for i in range(start, min(start + 4, len(pictures)))]
            predicted = model(torch.stack([p for p, _ in batch]).to(device)).argmax(1).cpu().numpy()
            truth = np.stack([t.numpy() for _, t in batch])
            counted = truth != IGNORED
            pairs = truth[counted] * classes + predicted[counted]
            confusion += np.bincount(pairs, minlength=classes * classes).reshape(classes, classes)
    return confusion


def run(experiment: Experiment, row: str, seed: int, out: Path, say) -> dict:
    """Trains and measures one row with one seed; what is finished in `out` is not done again, what was begun goes on.

    Returns `{"row", "seed", "confusion", "curve"}`; `curve` holds (stage, step, loss).
    """
    folder = out / "runs" / row / str(seed)
    result = folder / "result.json"
    if result.exists():
        return json.loads(result.read_text())
    folder.mkdir(parents=True, exist_ok=True)
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    torch.manual_seed(seed)
    classes = len(TARGETS[experiment.classes])
    model = network(experiment.training.model, classes, experiment.training.weights).to(device)
    curve: list[list[float]] = []
    stages = experiment.stages(row)
    for number, names in enumerate(stages):
        # Rows that begin alike share their first stage: S and S+R[F].
        shared = out / "stages" / f"{'+'.join(names)}-{seed}.pt" if number == 0 else None
        if shared is not None and shared.exists():
            model.load_state_dict(torch.load(shared, map_location=device, weights_only=True))
            continue
        _stage(experiment, names, seed * 1000 + number, model, device, folder / f"stage{number}.pt", curve, number, lambda text: say(f"{row} seed {seed}: {text}"))
        if shared is not None and "R" not in names and "P" not in names:
            shared.parent.mkdir(parents=True, exist_ok=True)
            _save(shared, model.state_dict())
    val = Pictures(experiment.val.samples, experiment.val.numbering, experiment.classes, experiment.size, False, 0)
    confusion = measure(model, val, classes, device)
    found = {"row": row, "seed": seed, "confusion": confusion.tolist(), "curve": curve}
    _save(folder / "model.pt", model.state_dict())
    partial = result.with_suffix(".partial")
    partial.write_text(json.dumps(found))
    os.replace(partial, result)
    for checkpoint in folder.glob("stage*.pt"):
        checkpoint.unlink()
    say(f"{row} seed {seed}: mIoU {100 * np.nanmean(iou(confusion)):.2f}")
    return found


def _stage(experiment, names, seed, model, device, checkpoint, curve, number, say) -> None:
    training = experiment.training
    pools = [experiment.pools[name] for name in names]
    sets = [Pictures(p.samples, p.numbering, experiment.classes, experiment.size, True, seed + i) for i, p in enumerate(pools)]
    lengths = [len(s) for s in sets]
    steps = training.steps or max(1, training.epochs * sum(lengths) // training.batch)
    batches = mixed_batches(lengths, training.batch, steps, seed)
    decay = [p for p in model.parameters() if p.ndim > 1]
    plain = [p for p in model.parameters() if p.ndim <= 1]
    optimiser = torch.optim.AdamW([{"params": decay, "weight_decay": 1e-2}, {"params": plain, "weight_decay": 0.0}], lr=training.rate)
    # The polynomial schedule of DeepLab.
    schedule = torch.optim.lr_scheduler.LambdaLR(optimiser, lambda step: (1 - step / (steps + 1)) ** 0.9)
    scaler = torch.amp.GradScaler(device.type, enabled=device.type == "cuda")
    first = 0
    if checkpoint.exists():
        state = torch.load(checkpoint, map_location=device, weights_only=True)
        model.load_state_dict(state["model"])
        optimiser.load_state_dict(state["optimiser"])
        schedule.load_state_dict(state["schedule"])
        scaler.load_state_dict(state["scaler"])
        first = state["step"]
        curve[:] = state["curve"]
    loss_of = nn.CrossEntropyLoss(ignore_index=IGNORED)
    model.train()
    lost = []
    for step in range(first, steps):
        for s in sets:
            s.epoch = step
        items = [sets[i][index] for i, index in batches[step]]
        pictures, truth = (torch.stack(parts).to(device) for parts in zip(*items))
        with torch.autocast(device.type, enabled=device.type == "cuda"):
            loss = loss_of(model(pictures), truth)
        optimiser.zero_grad(set_to_none=True)
        scaler.scale(loss).backward()
        scaler.step(optimiser)
        scaler.update()
        schedule.step()
        lost.append(loss.item())
        if (step + 1) % _LINE_EVERY == 0 or step + 1 == steps:
            curve.append([number, step + 1, float(np.mean(lost))])
            say(f"stage {number + 1} on {'+'.join(names)}, step {step + 1} of {steps}, loss {np.mean(lost):.3f}")
            lost = []
        if (step + 1) % _SAVE_EVERY == 0:
            state = {"model": model.state_dict(), "optimiser": optimiser.state_dict(), "schedule": schedule.state_dict(), "scaler": scaler.state_dict(), "step": step + 1, "curve": curve}
            _save(checkpoint, state)


def _save(path: Path, state) -> None:
    partial = path.with_suffix(".partial")
    torch.save(state, partial)
    os.replace(partial, path)
