"""The examples for users, run as they say."""

import subprocess
import sys
from pathlib import Path

import numpy as np
from PIL import Image
from trove.format import read_frame, read_manifest

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_the_example_in_python_tells_of_every_frame_and_draws_its_boxes(finished, tmp_path):
    command = [sys.executable, EXAMPLES / "read_frames.py", finished, "--out", tmp_path, "--min-px", "1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    changed = 0
    for frame in read_manifest(finished)["frames"]:
        assert f"{frame['path']}: " in done.stdout
        objects = read_frame(finished / frame["path"])["objects"]
        for row in objects:
            if row["visible_px"] > 0 and row["track_token"]:
                assert f"{row['kind']:24} {row['range_m']:6.1f} m" in done.stdout
        before = np.asarray(Image.open(finished / frame["path"] / "rgb.png").convert("RGB"))
        after = np.asarray(Image.open(tmp_path / (frame["path"].replace("/", "_") + ".png")))
        assert before.shape == after.shape
        changed += not np.array_equal(before, after)
    assert changed > 0, "no box was drawn"
