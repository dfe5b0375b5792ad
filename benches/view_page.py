"""The page of `trove view` in Chromium without a graphics card: a scene's size, first picture and motion, and how a run of 1,200
frames opens and pages; see benches/README.md."""

import argparse
import http.server
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
# Presses the keys of somebody who looks at all moments of one camera, back through those of the next, and so on, and tells
# PORT every so often how many pages there were, milliseconds since the page began to load, and megabytes of its heap.
PAGING = """<script>(async () => {
  const shows = () => document.getElementById("picture").dataset.shows;
  const rest = (milliseconds) => new Promise((then) => setTimeout(then, milliseconds));
  async function page(key) {
    const before = shows();
    document.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
    for (let tries = 0; tries < 500 && shows() === before; tries++) await rest(5);
  }
  const tell = (pages) => {
    gc();
    const told = [pages, performance.now(), performance.memory.usedJSHeapSize / 1e6];
    return fetch(`http://127.0.0.1:PORT/${told.join("/")}`, { mode: "no-cors" });
  };
  while (!shows()) await rest(5);
  await tell(0);
  const [there, back] = ["ArrowRight", "ArrowLeft"].map((key) => Array(39).fill(key));
  for (let pages = 240; ; pages += 240) {
    for (let camera = 0; camera < 6; camera++) await page("[");
    for (let camera = 0; camera < 6; camera++) {
      for (const key of camera % 2 ? back : there) await page(key);
      await page("]");
    }
    await tell(pages);
  }
})();</script>"""
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
        many_frames(options, recipe + MANY, Path(folder))


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


def many_frames(options, text, folder):
    """Without a debugger, whose side of the browser keeps what a page has loaded."""
    recipe, frames, page = folder / "many.toml", folder / "many", folder / "many.html"
    recipe.write_text(text)
    subprocess.run([options.trove, "generate", recipe, "--out", frames], check=True, capture_output=True)
    made(options.trove, frames, page)
    told = []

    class Told(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            pages, since_ms, heap_mb = (float(word) for word in self.path[1:].split("/"))
            each = f", {(since_ms - told[-1]) / 240:.0f} ms each" if told else ""
            told.append(since_ms)
            memory = f"{heap_mb:.1f} MB in the heap, {of_the_browser_mb():.0f} MB in Chromium"
            print(f"{pages:.0f} pages after {since_ms / 1e3:.1f} s{each}: {memory}", flush=True)
            self.send_response(204)
            self.end_headers()

        def log_message(self, *_):
            pass

    with http.server.HTTPServer(("127.0.0.1", 0), Told) as server:
        page.write_text(page.read_text() + PAGING.replace("PORT", str(server.server_port)))
        flags = ["--enable-precise-memory-info", "--js-flags=--expose-gc", f"--user-data-dir={folder / 'profile'}"]
        command, env = chromium.command("--headless", "--window-size=1440,900", *flags, page.as_uri())
        browser = subprocess.Popen(command, env=env, stderr=subprocess.DEVNULL)
        try:
            while len(told) < 9:
                server.handle_request()
        finally:
            browser.kill()
            browser.wait()


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
