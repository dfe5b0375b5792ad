"""Measures the installed program on real data (the folder in TROVE_TEST_DATA).

`bench.py build` times the building of scene-0103, `bench.py frame` CAM_FRONT at 1600×900 with all labels at 64 spp,
denoised, of both scenes, `bench.py frames` 48 small frames for training a scene, and `bench.py memory` the peak memory over
100 frames. `bench.py city` makes up a city of 20,000
buildings and measures how it is read and built; it needs no data.
"""

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from city import LAT_DEG, LON_DEG, city

PLACES = {"scene-0103": "boston-seaport", "scene-0061": "singapore-onenorth"}


def recipe(folder, scene, keyframes, rig, render):
    """Writes a recipe on real data."""
    data = Path(os.environ["TROVE_TEST_DATA"]).resolve()
    path = folder / f"{scene}.toml"
    path.write_text(
        f'seed = 7\n[drive]\ndataset = "nuscenes"\nroot = "{data / "nuscenes"}"\nscenes = ["{scene}"]\n'
        f'keyframes = {keyframes}\n[map]\nosm = "{data / "osm" / PLACES[scene]}.osm"\n'
        f"[views]\nrig = {json.dumps(rig)}\n[render]\n{render}\n"
    )
    return path


def trove(*args):
    """Starts the program."""
    command = [sys.executable, "-m", "trove", *map(str, args)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)


def peak_mib(pid):
    """The largest resident size that a running process has had, MiB; 0 once it has ended."""
    try:
        status = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0.0
    lines = [line for line in status.splitlines() if line.startswith("VmHWM:")]
    return int(lines[0].split()[1]) / 1024 if lines else 0.0


def build(folder):
    """Time to make the library, cold and from the cache, and to build scene-0103 with its map."""
    os.environ["TROVE_CACHE"] = str(folder / "cache")
    path = recipe(folder, "scene-0103", "[0]", "all", "scale = 1.0")
    library, scene = [], []
    for _ in range(5):
        out, _ = trove("build", path, "--out", folder / "scene.glb", "--json").communicate()
        measured = json.loads(out)["report"]["measurements"]
        library.append(measured["library.seconds"])
        scene.append(measured["build.seconds"])
    middle = len(scene) // 2
    cached = sum(file.stat().st_size for file in (folder / "cache").rglob("*.library")) / 1e6
    print(
        f"scene-0103 is built in {sorted(scene)[middle]:.2f} s (median of {len(scene)}), the library in "
        f"{library[0]:.2f} s and from the cache in {sorted(library[1:])[middle - 1]:.2f} s, where it takes {cached:.0f} MB"
    )


def frame(folder):
    """Time of a frame at full size with all labels, denoised."""
    for scene in PLACES:
        path = recipe(folder, scene, "[1]", "CAM_FRONT", "spp = 64")
        started = time.monotonic()
        run = trove("generate", path, "--out", folder / scene, "--json")
        peak = 0.0
        while run.poll() is None:
            peak = max(peak, peak_mib(run.pid))
            time.sleep(0.2)
        seconds = time.monotonic() - started
        print(
            f"{scene}: a frame of 1600×900 at 64 spp with all labels in {seconds:.1f} s, "
            f"the start, reading and building included, peak {peak:.0f} MiB"
        )


def frames(folder):
    """Rate of small frames for training, denoised, with picture, classes, instances and objects, over whole runs."""
    render = 'size = [480, 360]\nspp = 2\ndenoise = "fast"\n[output]\nfiles = ["rgb", "class", "instance"]'
    for scene in PLACES:
        path = recipe(folder, scene, "{ every = 5 }", "all", render)
        command = [sys.executable, "-m", "trove", "generate", path, "--out", folder / scene]
        used, started, first = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic(), None
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as run:
            for line in run.stderr:
                if first is None and line.startswith(f"{scene}/"):
                    first = time.monotonic()
        ended, now = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
        count = sum(1 for _ in (folder / scene).glob("*/*/*/*/frame.json"))
        cores_s = now.ru_utime + now.ru_stime - used.ru_utime - used.ru_stime
        print(
            f"{scene}: {count} frames of 480×360, {count / (ended - first):.2f} a second from the first one on, "
            f"{count / (ended - started):.2f} with the start; {cores_s / count:.2f} s of a core each"
        )


def memory(folder):
    """Peak memory after 10 frames and after all of more than 100."""
    path = recipe(folder, "scene-0103", "{ every = 2 }", "all", "scale = 0.25\nspp = 4")
    out = folder / "memory"
    run = trove("generate", path, "--out", out)
    marks = {}
    while run.poll() is None:
        done = sum(1 for _ in out.glob("*/*/*/*/frame.json"))
        peak = peak_mib(run.pid)
        if peak:
            marks[done] = peak
        time.sleep(0.1)
    early = min((done for done in marks if done >= 10), default=max(marks))
    print(f"peak memory {marks[early]:.0f} MiB after {early} frames, {marks[max(marks)]:.0f} MiB after {max(marks)}")


def large(folder):
    """Time and peak memory of reading and building a city of 20,000 buildings."""
    made, side_m = city(20_000)
    with (folder / "city.osm").open("w", encoding="utf-8") as file:
        made.write(file)
    path = folder / "city.toml"
    place = f"lat_deg = {LAT_DEG}\nlon_deg = {LON_DEG}\nsize_m = {side_m - 120:.0f}"
    path.write_text(f'[place]\n{place}\n[map]\nosm = "{folder / "city.osm"}"\n')
    run, peak = trove("build", path, "--out", folder / "city.glb", "--json"), 0.0
    while run.poll() is None:
        peak = max(peak, peak_mib(run.pid))
        time.sleep(0.05)
    measured = json.loads(run.stdout.read())["report"]["measurements"]
    print(
        f"20,000 buildings are read in {measured['read.seconds']:.2f} s, built in {measured['build.seconds']:.1f} s, "
        f"peak {peak:.0f} MiB"
    )


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as temporary:
        {"build": build, "frame": frame, "frames": frames, "memory": memory, "city": large}[sys.argv[1]](
            Path(temporary)
        )
