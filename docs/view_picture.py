"""Makes docs/view.jpg, what README shows of the page of `trove view`, from the demo's frames; see the Makefile."""

import subprocess
import sys
import tempfile
from pathlib import Path

import chromium
from playwright.sync_api import sync_playwright


def main():
    frames, picture = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        page = Path(folder) / "demo.html"
        subprocess.run([sys.executable, "-m", "trove", "view", frames, "--out", page], check=True)
        browser = chromium.launch(playwright)
        tab = browser.new_page(viewport={"width": 1440, "height": 810}, color_scheme="light")
        tab.goto(page.as_uri())
        tab.wait_for_function("trove.three.scene.children[0].children[0].children.length > 0")
        # The largest vehicle is picked.
        tab.evaluate("""async () => {
          const { objects } = await (await trove.kept.get(trove.shown().id));
          const cars = objects.filter((thing) => thing.box && ["car", "van", "jeep"].some((k) => thing.kind.includes(k)));
          const [x0, y0, x1, y1] = cars.sort((a, b) => b.visible_px - a.visible_px)[0].box;
          await trove.pick((x0 + x1) >> 1, (y0 + y1) >> 1);
        }""")
        tab.wait_for_timeout(3000)  # the scene is drawn finely once nothing moves
        tab.screenshot(path=picture, type="jpeg", quality=85)
        browser.close()


if __name__ == "__main__":
    main()
