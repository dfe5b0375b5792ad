"""Faults of machines: whatever happens to a run, the next one ends in the same bytes."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import files, trove

KILLS = 10


def start(recipe, out, **more):
    command = [sys.executable, "-m", "trove", "generate", str(recipe), "--out", str(out)]
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True, **more)


@pytest.fixture
def disk(tmp_path):
    """Mounts a disk of so many kilobytes; needs root, as CI is."""
    folder = tmp_path / "disk"
    folder.mkdir()

    def mount(options):
        done = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", options, "tmpfs", folder], capture_output=True, text=True, check=False
        )
        if done.returncode != 0 and not os.environ.get("CI"):
            pytest.skip(f"no disk can be mounted: {done.stderr.strip()}")
        assert done.returncode == 0, done.stderr
        return folder

    yield mount
    subprocess.run(["umount", folder], capture_output=True, check=False)


def test_a_run_that_is_killed_again_and_again_ends_in_the_same_bytes(recipe, finished, tmp_path):
    out = tmp_path / "out"
    draw = random.Random(20)
    started = time.monotonic()
    assert trove("generate", recipe, "--out", tmp_path / "whole").returncode == 0
    whole_s = time.monotonic() - started
    for _ in range(KILLS):
        run = start(recipe, out)
        time.sleep(draw.uniform(0, whole_s))
        run.send_signal(signal.SIGKILL)
        run.communicate()
        if (out / "manifest.json").exists():
            # It was done; it goes on from half of its frames, of which one is damaged.
            frames = sorted(path.parent for path in out.glob("*/v00/*/*/frame.json"))
            for frame in frames[::2]:
                shutil.rmtree(frame)
            (frames[1] / "class.png").write_bytes(b"")
            (out / "manifest.json").unlink()
    done = trove("generate", recipe, "--out", out)
    assert done.returncode == 0, done.stderr
    assert files(out) == files(finished)


def test_a_full_disk_is_told_and_a_run_goes_on_once_there_is_room(recipe, finished, disk):
    folder = disk("size=220k")
    out = folder / "out"
    done = trove("generate", recipe, "--out", out)
    assert done.returncode == 1 and "free some space" in done.stderr and "panicked" not in done.stderr, done.stderr
    whole = {name: data for name, data in files(finished).items() if name.count("/") > 1}
    assert all(data == whole[name] for name, data in files(out).items() if name in whole), "no finished frame is torn"
    subprocess.run(["mount", "-o", "remount,size=64m", folder], check=True)
    done = trove("generate", recipe, "--out", out)
    assert done.returncode == 0, done.stderr
    assert files(out) == files(finished)


def test_a_disk_that_became_read_only_is_told_and_keeps_what_is_there(recipe, finished, disk):
    folder = disk("size=64m")
    out = folder / "out"
    shutil.copytree(finished, out)
    (out / "manifest.json").unlink()
    shutil.rmtree(next(out.glob("*/v00/*/*")))
    before = files(out)
    subprocess.run(["mount", "-o", "remount,ro", folder], check=True)
    done = trove("generate", recipe, "--out", out)
    assert done.returncode == 1 and "panicked" not in done.stderr, done.stderr
    assert files(out) == before
    subprocess.run(["mount", "-o", "remount,rw", folder], check=True)
    done = trove("generate", recipe, "--out", out)
    assert done.returncode == 0, done.stderr
    assert files(out) == files(finished)


def test_of_two_runs_at_once_one_is_refused(recipe, finished, tmp_path):
    out = tmp_path / "out"
    runs = [start(recipe, out) for _ in range(2)]
    said = [run.communicate()[1] for run in runs]
    assert sorted(run.returncode for run in runs) == [0, 1], said
    assert any("another run, or a part of one, is writing" in text for text in said)
    assert files(out) == files(finished)


@pytest.fixture(scope="module")
def filled(recipe, tmp_path_factory):
    """A cache that a run has filled."""
    cache = tmp_path_factory.mktemp("filled")
    usual = Path(os.environ.get("TROVE_CACHE") or Path.home() / ".cache" / "trove")
    # The generated library takes long to make.
    (cache / "assets").mkdir()
    libraries = sorted(usual.glob("assets/*.library"), key=lambda path: path.stat().st_mtime)
    shutil.copy(libraries[-1], cache / "assets")
    environment = {**os.environ, "TROVE_CACHE": str(cache)}
    assert trove("inspect", recipe.parent / "demo/.trove/demo/nuscenes", env=environment).returncode == 0
    out = tmp_path_factory.mktemp("first")
    assert trove("generate", recipe, "--out", out, env=environment).returncode == 0
    return cache


@pytest.mark.parametrize("damage", ["cut", "flipped", "empty", "garbage"])
def test_a_damaged_cache_is_made_anew(recipe, finished, filled, tmp_path, damage):
    cache = shutil.copytree(filled, tmp_path / "cache")
    environment = {**os.environ, "TROVE_CACHE": str(cache)}
    kept = [path for path in cache.rglob("*") if path.is_file()]
    assert {path.suffix for path in kept} == {".index", "", ".library"}
    for path in kept:
        # It is damaged once.
        if path.suffix == ".library" and damage != "flipped":
            continue
        data = bytearray(path.read_bytes())
        data[len(data) // 2] ^= 16
        damaged = {"cut": data[: len(data) // 2], "flipped": data, "empty": b"", "garbage": b"\xff" * 1000}[damage]
        path.write_bytes(damaged)
    out = tmp_path / "out"
    done = trove("generate", recipe, "--out", out, env=environment)
    assert done.returncode == 0, done.stderr
    ours, theirs = files(out), files(finished)
    # That the library had to be made again is said in the report.
    assert {name for name in theirs if ours[name] != theirs[name]} <= {"report.json"}
