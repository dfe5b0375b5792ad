"""What commands answer: the JSON of their `--json`, typed."""

from typing import Any, TypedDict


class FrameTime(TypedDict):
    """How long a frame took, seconds, without writing it."""

    path: str
    prepare_seconds: float
    render_seconds: float


class Summary(TypedDict):
    """What a run did: `frames` that the recipe asks for, of which `rendered` are new."""

    out: str
    frames: int
    rendered: int
    timings: list[FrameTime]
    interrupted: bool
    seconds: float


class _Estimate(TypedDict):
    frames: int
    bytes: int
    seconds: float


class Estimate(_Estimate, total=False):
    """What a recipe will take: frames, sweeps, cycles and grids, their bytes, and seconds on this machine.

    What is below is there where it was asked for.
    """

    machines: int
    last_machine_seconds: float


class PartStatus(TypedDict):
    """How far a part is, or a run of all frames, whose `part` is `None`.

    `silent_s` is since it last wrote something down; `frame_s` is `None` before the first frame, `seconds_left` 0 once it
    has ended and `None` where that is not known or it seems to have stopped.
    """

    part: str | None
    frames: int
    finished: int
    silent_s: float
    frame_s: float | None
    seconds_left: float | None


class Status(TypedDict):
    """How far a folder is; `seconds_left` is `None` where nobody is at work, `merged` tells of the manifest."""

    frames: int
    finished: int
    seconds_left: float | None
    merged: bool
    parts: list[PartStatus]
    not_begun: list[str]


class Findings(TypedDict):
    """What was read, and what is not as it was written; the lists are empty where all is well."""

    frames: int
    files: int
    damaged: list[str]
    unlisted: list[str]


class LabelTally(TypedDict):
    """How often a check was made, and how many findings it had."""

    looked_at: int
    findings: int


class LabelFinding(TypedDict):
    """What is wrong: the check, the file or folder, what was expected and found, the wrong share, the image that shows it."""

    check: str
    place: str
    what: str
    severity: float
    image: str | None


class LabelFindings(TypedDict):
    """What was found in labels of a `form`; `checks` has those that could be made, by name."""

    form: str
    frames: int
    sound: bool
    checks: dict[str, LabelTally]
    findings: list[LabelFinding]


class Viewed(TypedDict):
    """A page, what it shows, where the rest of it lies, and why it has no shapes, where it should."""

    page: str
    bytes: int
    scenes: int
    frames: int
    beside: str | None
    without_shapes: str | None


class Curation(TypedDict):
    """How many frames were kept and why others were not, and where the list and its page lie."""

    frames: int
    kept: int
    train: int
    val: int
    gap: int
    too_few_classes: int
    near_duplicates: int
    shares_before: dict[str, float]
    shares_after: dict[str, float]
    list: str
    page: str


class ColorStatistics(TypedDict):
    """Mean and standard deviation of the three channels, and how strong fine detail is in coarser detail's amplitude.

    `sharpness` is of periods of 2 to 4 and 4 to 8 pixels beside 8 to 16, `None` for images that show nothing.
    """

    mean: list[float]
    deviation: list[float]
    sharpness: list[float] | None


class Recoloring(TypedDict):
    """How many pictures there are now, of which `kept` were there before, and how colours changed."""

    out: str
    pictures: int
    kept: int
    before: ColorStatistics
    target: ColorStatistics
    after: ColorStatistics
    page: str


class Numbering(TypedDict):
    """The class map of a side's pictures, and how it is known."""

    classes: str
    known_by: str


class _Scores(TypedDict):
    pictures: int
    unused_predictions: int
    classes: str
    predicted: Numbering
    truth: Numbering
    miou: float | None
    miou_interval95: list[float] | None
    accuracy: float | None
    accuracy_interval95: list[float] | None
    iou: dict[str, float]
    iou_interval95: dict[str, list[float]]
    confusion: dict[str, Any]


class Evaluation(_Scores, total=False):
    """Scores as shares of 1, with 95 % intervals over images; docs/judge.md has every field.

    What is below is there where it was asked for.
    """

    boundary_miou: float | None
    boundary_miou_interval95: list[float] | None
    boundary_iou: dict[str, float]
    boundary_iou_interval95: dict[str, list[float]]
    pq: float | None
    pq_interval95: list[float] | None
    panoptic: dict[str, Any]


class Licence(TypedDict):
    """Where something came from, and its licence."""

    source: str
    licence: str


class Exported(TypedDict):
    """A dataset: frames by split, values that its form cannot hold by what happened to them, and every source."""

    format: str
    classes: str | None
    trove: str
    frames: dict[str, int]
    clipped: dict[str, int]
    licences: list[Licence]


class ExportedDrives(TypedDict):
    """Drives in the plain form: their names, label pictures written, and what was dropped or guessed."""

    out: str
    drives: list[str]
    labels: int
    report: list[dict[str, Any]]
