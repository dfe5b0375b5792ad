"""How fast finished frames become other datasets.

    python benches/export.py --trove .venv/bin/trove

Exports the demo's frames, 800×450, sixteen times over, in every form with labels, and prints frames a second of
wall time, and what they would be if both of two cores did nothing else.
"""

import argparse
import json
import os
import resource
import subprocess
import tempfile
import time
from pathlib import Path

FORMS = [
    "cityscapes",
    "coco",
    "coco-panoptic",
    "kitti",
    "kitti-step",
    "mmseg",
    "nuscenes",
    "openlabel",
    "yolo",
    "yolo-seg",
]
COPIES = 16
CORES = 2


def many(demo, out):
    """A finished folder with the demo's frames under several names of scenes; their files are links."""
    manifest = json.loads((demo / "manifest.json").read_text())
    rows = []
    for i in range(COPIES):
        for row in manifest["frames"]:
            path = row["path"].replace(row["scene"], f"copy-{i:02}")
            (out / path).mkdir(parents=True)
            for file in (demo / row["path"]).iterdir():
                os.link(file, out / path / file.name)
            rows.append(row | {"scene": f"copy-{i:02}", "path": path})
    (out / "manifest.json").write_text(json.dumps(manifest | {"frames": rows}))
    return len(rows)


def main():
    """Makes the demo where it is missing, and times every form."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--trove", type=Path, required=True)
    parser.add_argument("--demo", type=Path, default=Path("demo-out"))
    options = parser.parse_args()
    subprocess.run([options.trove, "demo", "--out", options.demo], check=True)
    # Beside the demo: links do not cross file systems.
    with tempfile.TemporaryDirectory(dir=options.demo.parent) as folder:
        count = many(options.demo, Path(folder, "run"))
        for form in FORMS:
            before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
            command = [options.trove, "export", Path(folder, "run"), "--format", form, "--out", Path(folder, form)]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            wall_s, after = time.monotonic() - started, resource.getrusage(resource.RUSAGE_CHILDREN)
            cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            print(f"{form:14} {count / wall_s:6.1f} frames/s, {CORES * count / cpu_s:6.1f} on {CORES} busy cores")


if __name__ == "__main__":
    main()
