"""The page of a scene in Chromium without a graphics card: its size, its first picture, and how it moves; see benches/README.md."""

import argparse
import os
import subprocess
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

ROOT = Path(__file__).parents[1]
CHROMIUM = ROOT / ".tools/chromium/chromium"
ARGUMENTS = ["--no-sandbox", "--no-zygote", "--single-process", "--in-process-gpu", "--use-gl=angle"]
ARGUMENTS += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
RECIPE = """
seed = 7
[drive]
dataset = "nuscenes"
root = "{data}/nuscenes"
scenes = ["scene-0103"]
[map]
osm = "{data}/osm/boston-seaport.osm"
"""
SHAPES = "trove.three.scene.children[0].children[0].children.length > 0"
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
    libraries = f"{CHROMIUM.parent / 'lib'}:{os.environ.get('LD_LIBRARY_PATH', '')}"
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        recipe, page = Path(folder) / "recipe.toml", Path(folder) / "page.html"
        recipe.write_text(RECIPE.format(data=Path(data).absolute()))
        begun = time.monotonic()
        subprocess.run([options.trove, "view", recipe, "--out", page], check=True, capture_output=True)
        print(f"made in {time.monotonic() - begun:.0f} s, {page.stat().st_size / 1e6:.1f} MB", flush=True)
        for width, height in [(1440, 900), (800, 600)]:
            browser = playwright.chromium.launch(
                executable_path=CHROMIUM, args=ARGUMENTS, env={**os.environ, "LD_LIBRARY_PATH": libraries}
            )
            tab = browser.new_page(viewport={"width": width, "height": height})
            begun = time.monotonic()
            tab.goto(page.as_uri())
            tab.wait_for_function(SHAPES)
            tab.evaluate("new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))")
            first_s = time.monotonic() - begun
            tab.wait_for_timeout(3000)
            moving = tab.evaluate(TURN, options.seconds)
            print(
                f"{width}×{height}: first picture after {first_s:.1f} s, moves at {moving:.0f} images a second",
                flush=True,
            )
            browser.close()


if __name__ == "__main__":
    main()
