"""TRoVE: recordings of real roads turned into photorealistic virtual scenes with perfect labels.

Example:

    import trove

    trove.demo("demo-out")
    for frame in trove.open("demo-out"):
        print(frame.name, [(thing.class_, thing.range_m) for thing in frame.objects[:3]])

docs/python.md describes every function. `trove.torch`, which needs PyTorch, is loaded when it is used.
"""

from typing import TYPE_CHECKING, Any

from trove._trove import TroveError, __version__
from trove.camera import Camera, look_at
from trove.commands import (
    curate,
    demo,
    estimate,
    evaluate,
    export,
    export_drives,
    generate,
    merge,
    recolor,
    status,
    verify,
    verify_labels,
    view,
)
from trove.frames import Frame, Frames, open
from trove.grids import Grid
from trove.objects import Object
from trove.overlay import Overlay
from trove.radars import RadarCycle
from trove.scene import Scene, build, render
from trove.sweeps import Sweep
from trove.trajectory import Trajectory

if TYPE_CHECKING:
    from trove import torch

__all__ = [
    "Camera",
    "Frame",
    "Frames",
    "Grid",
    "Object",
    "Overlay",
    "RadarCycle",
    "Scene",
    "Sweep",
    "Trajectory",
    "TroveError",
    "__version__",
    "build",
    "curate",
    "demo",
    "estimate",
    "evaluate",
    "export",
    "export_drives",
    "generate",
    "look_at",
    "merge",
    "open",
    "recolor",
    "render",
    "status",
    "torch",
    "verify",
    "verify_labels",
    "view",
]


def __getattr__(name: str) -> Any:
    # PyTorch takes seconds to load, and not everyone has it.
    if name == "torch":
        import importlib

        return importlib.import_module("trove.torch")
    raise AttributeError(f"module 'trove' has no attribute {name!r}")
