"""How long merging takes, and how much memory, where many machines have rendered many frames; see benches/README.md.

Nothing is rendered but the frames of one scene, which stand for those of all others: their files are written as parts
would have written them, a part a scene, and merged by the program itself.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

FRAMES_A_SCENE = 100
DRIVE = {
    "trove_drive": 1,
    "georeference": {"local": {"origin_lat_deg": 49.0094, "origin_lon_deg": 8.4044}},
    "cameras": {
        "front": {"width_px": 32, "height_px": 18, "fx_px": 23.0, "ego_from_camera": {"translation_m": [1.7, 0.0, 1.5]}}
    },
    "keyframes": [
        {
            "time_ns": 1_600_000_000_000_000_000 + k * 500_000_000,
            "world_from_ego": {"translation_m": [0.5 * k, 0.0, 0.0]},
        }
        for k in range(FRAMES_A_SCENE)
    ],
}


def recipe(folder, scenes):
    path = folder / f"recipe-{scenes}.toml"
    names = json.dumps([f"scene-{scene:05}" for scene in range(scenes)])
    path.write_text(f'[drive]\ndataset = "trove"\nroot = "drives"\nscenes = {names}\n[render]\nlight = false\n')
    return path


def measured(command):
    """Runs a command; its answer, seconds, and its peak memory in MB."""
    started = time.perf_counter()
    run = subprocess.Popen([*map(str, command), "--json"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    answer = run.stdout.read()
    _, status, usage = os.wait4(run.pid, 0)
    run.returncode = os.waitstatus_to_exitcode(status)
    if run.returncode != 0:
        sys.exit(f"error: {' '.join(map(str, command))} ended with {run.returncode}")
    return json.loads(answer), time.perf_counter() - started, usage.ru_maxrss / 1024


def make_up(made, out, scenes):
    """Writes what parts would have written, a part a scene, from the one scene that was made."""
    [variation] = made.glob("scene-*/v00")
    plain = {path.name: path.read_bytes() for path in variation.iterdir() if path.is_file()}
    lines = [json.loads(line) for line in (made / ".trove/frames.jsonl").read_text().splitlines() if '"files"' in line]
    frames = {
        line["frame"].split("/", 1)[1]: (
            {file["name"]: (made / line["frame"] / file["name"]).read_bytes() for file in line["files"]},
            line["files"],
        )
        for line in lines
    }
    shutil.copytree(made / ".trove", out / ".trove", ignore=shutil.ignore_patterns("frames.jsonl"))
    for scene in range(scenes):
        name = f"scene-{scene:05}"
        journal = []
        (out / name / "v00").mkdir(parents=True)
        for file, data in plain.items():
            (out / name / "v00" / file).write_bytes(data)
        for frame, (files, rows) in frames.items():
            folder = out / name / frame
            folder.mkdir(parents=True)
            for file, data in files.items():
                (folder / file).write_bytes(data)
            journal.append(json.dumps({"frame": f"{name}/{frame}", "files": rows}))
        part = out / ".trove" / "parts" / f"{scene + 1}-of-{scenes}"
        part.mkdir(parents=True)
        (part / "frames.jsonl").write_text("\n".join(journal) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--trove", default="trove", help="the program")
    parser.add_argument("--parts", type=int, nargs="+", default=[125, 250, 500, 1000], help="parts of 100 frames each")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for scene in range(max(options.parts)):
            path = folder / "drives" / f"scene-{scene:05}" / "drive.json"
            path.parent.mkdir(parents=True)
            path.write_text(json.dumps(DRIVE))
        measured([options.trove, "generate", recipe(folder, 1), "--out", folder / "made"])
        print("| frames | parts | merged | resumed | peak memory |\n|---|---|---|---|---|")
        for parts in options.parts:
            out = folder / f"out-{parts}"
            make_up(folder / "made", out, parts)
            command = [options.trove, "generate", recipe(folder, parts), "--out", out]
            merged, merge_s, merge_mb = measured(command)
            again, again_s, again_mb = measured(command)
            rows = len(json.loads((out / "manifest.json").read_text())["frames"])
            assert merged["rendered"] == again["rendered"] == 0 and rows == merged["frames"] == parts * FRAMES_A_SCENE
            print(
                f"| {rows:,} | {parts:,} | {merge_s:.1f} s | {again_s:.1f} s | {max(merge_mb, again_mb):.0f} MB |",
                flush=True,
            )
            shutil.rmtree(out)


if __name__ == "__main__":
    main()
