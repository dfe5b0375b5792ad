"""The program as tests call it, and a finished run of a quick recipe."""

import os
import subprocess
import sys
import time

import chromium
import pytest


def trove(*args, **more):
    """Runs the program and returns what it did."""
    command = [sys.executable, "-m", "trove", *map(str, args)]
    return subprocess.run(command, capture_output=True, text=True, timeout=600, **more)


@pytest.fixture(scope="session")
def recipe(tmp_path_factory):
    """A quick recipe on the demo's drive: two keyframes, three cameras, another vehicle."""
    folder = tmp_path_factory.mktemp("recipe")
    # The demo writes its drive before it renders; it is ended as soon as that is there.
    demo = subprocess.Popen([sys.executable, "-m", "trove", "demo", "--out", folder / "demo"])
    source = folder / "demo" / ".trove" / "demo"
    deadline = time.monotonic() + 60
    while not (source / "recipe.toml").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    demo.kill()
    demo.wait()
    text = f"""
seed = 3
[drive]
dataset = "nuscenes"
root = "{source / "nuscenes"}"
keyframes = [1, 2]
[map]
osm = "{source / "crossing.osm"}"
[views]
rig = ["CAM_FRONT", "CAM_BACK"]
other_vehicles = 1
[render]
scale = 0.1
spp = 4
"""
    path = folder / "recipe.toml"
    path.write_text(text)
    return path


@pytest.fixture(scope="session")
def finished(recipe):
    """What the recipe gives in one uninterrupted run on one thread."""
    out = recipe.parent / "finished"
    done = trove("generate", recipe, "--out", out, "--threads", 1)
    assert done.returncode == 0, done.stderr
    return out


@pytest.fixture
def browser():
    """A Chromium, driven by Playwright; as it is one process, it ends with its first page."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        sync_playwright = None
    if sync_playwright is None or chromium.program() is None:
        remedy = "needs Chromium and Playwright: make chromium"
        # Where everything is installed by the project itself, nothing is left out in silence.
        pytest.fail(remedy) if os.environ.get("CI") else pytest.skip(remedy)
    with sync_playwright() as playwright:
        started = chromium.launch(playwright)
        yield started
        started.close()


def files(root):
    """The public files of an output folder with their bytes."""
    paths = (path for path in root.rglob("*") if path.is_file() and ".trove" not in path.parts)
    return {str(path.relative_to(root)): path.read_bytes() for path in paths}
