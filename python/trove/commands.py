"""The program's commands as functions.

Each runs like its command, with the same defaults and messages, and returns what the command prints with `--json`.
`progress(done, total, doing)` is called on the calling thread: `done` of `total` pictures are finished, counting the
share of the one in work. What it raises, and Ctrl-C, end the command early; what is finished is kept. A second Ctrl-C
does not wait. Other threads run meanwhile.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

from trove._trove import call
from trove.packages import search

if TYPE_CHECKING:
    from trove.results import (
        Curation,
        Estimate,
        Evaluation,
        Exported,
        ExportedDrives,
        Findings,
        LabelFindings,
        Recoloring,
        Status,
        Summary,
        Viewed,
    )

Progress = Callable[[float, int, str], object]
AnyPath = str | PathLike[str]


def demo(
    out: AnyPath = "demo-out",
    *,
    threads: int | None = None,
    kernel: str = "auto",
    device: str = "cpu",
    progress: Progress | None = None,
) -> Summary:
    """Runs the whole pipeline on a built-in drive; its recipe is then `OUT/.trove/demo/recipe.toml`."""
    summary: Summary = _run("demo", [], progress, out=out, threads=threads, kernel=kernel, device=device)
    return summary


def generate(
    recipe: AnyPath,
    out: AnyPath,
    progress: Progress | None = None,
    *,
    part: str | None = None,
    frames: AnyPath | None = None,
    labels_only: bool = False,
    threads: int | None = None,
    kernel: str = "auto",
    device: str = "cpu",
) -> Summary:
    """Generates the dataset of a recipe in `out`; finished frames are kept, so a second call resumes.

    `part`, such as `"3/8"`, is one of several shares of the frames, which a call without it merges; `frames` is a list of
    `curate`, which alone are rendered; `labels_only` leaves images out.
    """
    summary: Summary = _run(
        "generate",
        [recipe],
        progress,
        out=out,
        part=part,
        frames=frames,
        labels_only=labels_only,
        threads=threads,
        kernel=kernel,
        device=device,
    )
    return summary


def estimate(
    recipe: AnyPath,
    *,
    part: str | None = None,
    machines: int | None = None,
    frames: AnyPath | None = None,
    labels_only: bool = False,
    threads: int | None = None,
    kernel: str = "auto",
    device: str = "cpu",
    progress: Progress | None = None,
) -> Estimate:
    """Tells how many frames a recipe, or a part of it, has, and what they will take, after frames of one moment.

    With `machines` also when the last of so many like this one will have ended.
    """
    estimate: Estimate = _run(
        "generate",
        [recipe],
        progress,
        dry_run=True,
        part=part,
        machines=machines,
        frames=frames,
        labels_only=labels_only,
        threads=threads,
        kernel=kernel,
        device=device,
    )
    return estimate


def merge(
    folders: Sequence[AnyPath],
    out: AnyPath,
    progress: Progress | None = None,
    *,
    recipe: AnyPath | None = None,
    frames: AnyPath | None = None,
    labels_only: bool = False,
    threads: int | None = None,
    kernel: str = "auto",
    device: str = "cpu",
) -> Summary:
    """Merges folders that parts of a recipe were rendered in into `out`, and renders what is missing.

    Without `recipe` it is the one that the first folder was begun with.
    """
    summary: Summary = _run(
        "merge",
        list(folders),
        progress,
        out=out,
        recipe=recipe,
        frames=frames,
        labels_only=labels_only,
        threads=threads,
        kernel=kernel,
        device=device,
    )
    return summary


def status(folder: AnyPath) -> Status:
    """Tells how far a folder is that runs, or parts of one on other machines, are writing to, from their journals alone."""
    status: Status = _run("status", [folder], None)
    return status


def verify(folder: AnyPath, *, page: AnyPath | None = None, progress: Progress | None = None) -> Findings:
    """Checks every file of an output folder against its hash; nothing is changed. `page` gets a page about it."""
    findings: Findings = _run("verify", [folder], progress, page=page)
    return findings


def verify_labels(
    folder: AnyPath,
    *,
    form: str | None = None,
    out: AnyPath | None = None,
    page: AnyPath | None = None,
    progress: Progress | None = None,
) -> LabelFindings:
    """Checks what labels say of each other, the image and the cameras' poses, over views and times; nothing is changed.

    `folder` is an output folder or a root of Cityscapes, KITTI, COCO, nuScenes or CamVid, in a `form` that is found out
    where it is not given. `out` gets `audit.json` and images of the ten worst findings, `page` a page about all of them.
    """
    findings: LabelFindings = _run("verify", [folder], progress, labels=True, form=form, out=out, page=page)
    return findings


def view(
    source: AnyPath, out: AnyPath, *, embed: int = 25, shapes: int = 2, progress: Progress | None = None
) -> Viewed:
    """Writes one page that shows an output folder, a recipe's scene or a `.glb` file.

    `embed` is how many megabytes the page itself holds, `shapes` how many scenes of a folder are built again for theirs.
    """
    viewed: Viewed = _run("view", [source], progress, out=out, embed=embed, shapes=shapes)
    return viewed


def curate(
    folder: AnyPath,
    *,
    count: int = 5000,
    classes: AnyPath = "trove20",
    weights: AnyPath | None = None,
    min_classes: int = 6,
    duplicate_bits: int = 2,
    val_share: float = 0.1,
    seed: int = 7,
    out: AnyPath | None = None,
    page: AnyPath | None = None,
    progress: Progress | None = None,
) -> Curation:
    """Selects the frames of `folder` most worth training on and writes their list, `out`, and a page about them.

    `weights` is a file of what each of the `classes` is worth (TOML, `class = weight`), as `python -m trove.train.doubt`
    writes it.
    """
    curation: Curation = _run(
        "curate",
        [folder],
        progress,
        count=count,
        classes=classes,
        weights=weights,
        min_classes=min_classes,
        duplicate_bits=duplicate_bits,
        val_share=val_share,
        seed=seed,
        out=out,
        page=page,
    )
    return curation


def recolor(
    folder: AnyPath,
    to: AnyPath,
    *,
    out: AnyPath | None = None,
    method: str = "set",
    space: str = "lab",
    strength: float = 0.75,
    detail: bool = False,
    to_labels: AnyPath | None = None,
    to_classes: AnyPath = "trove20",
    page: AnyPath | None = None,
    progress: Progress | None = None,
) -> Recoloring:
    """Matches the colours of the images below `folder` to those below `to` and writes them below `out`.

    With `detail` they become as sharp, too.
    `page` gets a page with images before and after, mean colours by class, and histograms.
    """
    recoloring: Recoloring = _run(
        "recolor",
        [folder],
        progress,
        to=to,
        out=out,
        method=method,
        space=space,
        strength=strength,
        detail=detail,
        to_labels=to_labels,
        to_classes=to_classes,
        page=page,
    )
    return recoloring


def evaluate(
    predicted: AnyPath,
    truth: AnyPath,
    *,
    classes: AnyPath | None = None,
    predicted_classes: AnyPath | None = None,
    truth_classes: AnyPath | None = None,
    boundary: bool = False,
    panoptic: bool = False,
    seed: int = 7,
    page: AnyPath | None = None,
    progress: Progress | None = None,
) -> Evaluation:
    """Scores predicted labels, one PNG or a folder of them, against ground truth.

    Without `classes`, and those of either side, class maps are found out from the files; the answer names them. `page`
    gets a page with scores by class, the confusion matrix and the worst images.
    """
    evaluation: Evaluation = _run(
        "evaluate",
        [predicted, truth],
        progress,
        classes=classes,
        predicted_classes=predicted_classes,
        truth_classes=truth_classes,
        boundary=boundary,
        panoptic=panoptic,
        seed=seed,
        page=page,
    )
    return evaluation


def export(
    source: AnyPath,
    out: AnyPath,
    format: str,
    *,
    split: AnyPath | None = None,
    classes: AnyPath | None = None,
    progress: Progress | None = None,
) -> Exported:
    """Writes the finished frames in `source` for other tools, in the splits of a list of `curate`; goes on where it ended."""
    exported: Exported = _run("export", [source], progress, out=out, format=format, split=split, classes=classes)
    return exported


def export_drives(
    source: AnyPath,
    out: AnyPath,
    *,
    scenes: Sequence[str] = (),
    lidar: bool = False,
    pictures: bool = False,
    progress: Progress | None = None,
) -> ExportedDrives:
    """Writes the drives of the dataset at `source` in the plain form, all or those of some names."""
    exported: ExportedDrives = _run(
        "export", [source], progress, out=out, format="trove", scene=list(scenes), lidar=lidar, pictures=pictures
    )
    return exported


def _run(command: str, arguments: list[AnyPath], progress: Progress | None, **options: Any) -> Any:
    """Runs a command; an option that is `None` or `False` is left out, a list is given once an item."""
    args = ["trove", command, "--json"]
    for name, value in options.items():
        option = f"--{name.replace('_', '-')}"
        if value is True:
            args.append(option)
        elif value is not None and value is not False:
            # A path's text is the path itself.
            args += [f"{option}={item}" for item in (value if isinstance(value, list | tuple) else [value])]
    args += ["--", *(fspath(path) for path in arguments)]
    return json.loads(call(args, search(), progress))
