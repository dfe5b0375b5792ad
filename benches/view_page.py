"""The page of `trove view` in Chromium without a graphics card: a scene's size, first picture and motion, and how a run of 1,200
frames opens and pages; see benches/README.md."""

import argparse
import json
import os
import subprocess
import tempfile
import time
from pathlib import Path

import chromium
from playwright.sync_api import sync_playwright

RECIPE = """
seed = 7
[drive]
dataset = "nuscenes"
root = "{data}/nuscenes"
scenes = ["scene-0103"]
[map]
osm = "{data}/osm/boston-seaport.osm"
"""
# 40 keyframes, six cameras, five variations.
MANY = """
[render]
scale = 0.1
spp = 1
[variations]
count = 5
"""
SHAPES = "trove.three.scene.children[0].children[0].children.length > 0"
IMAGE = "document.getElementById('picture').dataset.shows"
HEAP = "performance.memory.usedJSHeapSize / 1e6"
# Turns around the vehicle for as long; images that were drawn, a second.
TURN = """async (seconds) => {
  const { camera, controls, renderer } = trove.three, render = renderer.render.bind(renderer);
  let drawn = 0;
  renderer.render = (...what) => (drawn++, render(...what));
  const begun = performance.now();
  while (performance.now() - begun < 1000 * seconds) {
    const from = camera.position.clone().sub(controls.target).applyAxisAngle(camera.up, 0.02);
    camera.position.copy(controls.target).add(from);
    controls.update();
    await new Promise(requestAnimationFrame);
  }
  return drawn / seconds;
}"""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trove", default=".venv/bin/trove")
    parser.add_argument("--seconds", type=float, default=10)
    options = parser.parse_args()
    data = os.environ.get("TROVE_TEST_DATA")
    if data is None:
        parser.error("TROVE_TEST_DATA: expected the folder with real data, found nothing set")
    recipe = RECIPE.format(data=Path(data).absolute())
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        a_scene(options, recipe, Path(folder), playwright)
        many_frames(options, recipe + MANY, Path(folder), playwright)


def made(trove, source, page):
    """Makes a page and tells how large it is."""
    begun = time.monotonic()
    done = subprocess.run([trove, "view", source, "--out", page, "--json"], check=True, capture_output=True)
    frames, taken_s = json.loads(done.stdout)["frames"], time.monotonic() - begun
    print(f"{frames} frames: made in {taken_s:.0f} s, {page.stat().st_size / 1e6:.1f} MB", flush=True)


def a_scene(options, text, folder, playwright):
    recipe, page = folder / "scene.toml", folder / "scene.html"
    recipe.write_text(text)
    made(options.trove, recipe, page)
    for width, height in [(1440, 900), (800, 600)]:
        browser = chromium.launch(playwright)
        tab = browser.new_page(viewport={"width": width, "height": height})
        begun = time.monotonic()
        tab.goto(page.as_uri())
        tab.wait_for_function(SHAPES)
        tab.evaluate("new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))")
        first_s = time.monotonic() - begun
        tab.wait_for_timeout(3000)
        moving = tab.evaluate(TURN, options.seconds)
        print(
            f"{width}×{height}: first picture after {first_s:.1f} s, moves at {moving:.0f} images a second", flush=True
        )
        browser.close()


def many_frames(options, text, folder, playwright):
    recipe, frames, page = folder / "many.toml", folder / "many", folder / "many.html"
    recipe.write_text(text)
    subprocess.run([options.trove, "generate", recipe, "--out", frames], check=True, capture_output=True)
    made(options.trove, frames, page)
    browser = chromium.launch(playwright, "--enable-precise-memory-info", "--js-flags=--expose-gc")
    tab = browser.new_page(viewport={"width": 1440, "height": 900})
    begun = time.monotonic()
    tab.goto(page.as_uri())
    tab.wait_for_function(IMAGE)
    first_s = time.monotonic() - begun
    # It opens with the camera that looks ahead.
    for _ in range(5):
        tab.keyboard.press("[")
    tab.wait_for_timeout(5000)

    def memory():
        tab.evaluate("gc()")
        return f"{tab.evaluate(HEAP):.1f} MB in the heap, {of_the_browser_mb():.0f} MB in Chromium"

    print(f"first image after {first_s:.1f} s; {memory()}", flush=True)
    # Through all moments of one camera, back through those of the next, and so on.
    there, back, camera = ["ArrowRight"] * 39, ["ArrowLeft"] * 39, ["]"]
    keys = (there + camera + back + camera) * 3
    begun = time.monotonic()
    for key in keys[:-1]:
        before = tab.evaluate(IMAGE)
        tab.keyboard.press(key)
        tab.wait_for_function(f"(before) => {IMAGE} !== before", arg=before)
    each_s = (time.monotonic() - begun) / len(keys)
    print(f"after {len(keys)} pages, {each_s:.2f} s each: {memory()}", flush=True)
    browser.close()


def of_the_browser_mb():
    """Memory of the Chromium that this benchmark started."""
    return sum(resident_mb(process) for process in Path("/proc").glob("[0-9]*"))


def resident_mb(process):
    try:
        if not process.joinpath("cmdline").read_bytes().startswith(str(chromium.program()).encode()):
            return 0
        fields = dict(line.split(":", 1) for line in process.joinpath("status").read_text().splitlines())
    except OSError:
        return 0  # it has ended
    return int(fields["VmRSS"].split()[0]) / 1e3 if "VmRSS" in fields else 0


if __name__ == "__main__":
    main()
