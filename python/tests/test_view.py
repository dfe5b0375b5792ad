"""The page of `trove view`, in a real Chromium."""

import json
import re
import shutil
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

import numpy as np
import pytest
from conftest import trove
from trove import open as open_run

AXE = Path(__file__).parents[2] / ".tools/axe/node_modules/axe-core/axe.min.js"  # of `make chromium`
ON_CANVAS = "document.getElementById('picture').dataset.shows"


def view(source, out, *args):
    done = trove("view", source, "--out", out, "--json", *args)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def shown(finished, tmp_path_factory):
    """The page of the finished run, with its scene's shapes."""
    page = tmp_path_factory.mktemp("view") / "run.html"
    found = view(finished, page)
    assert (found["frames"], found["beside"], found["without_shapes"]) == (8, None, None)
    return page


@pytest.fixture
def opened(browser):
    """Opens pages and gathers what goes wrong in them."""
    faults = []

    def opened(page, anchor="", size=(1280, 800), **more):
        tab = browser.new_page(viewport={"width": size[0], "height": size[1]}, **more)
        tab.set_default_timeout(60_000)
        tab.on("console", lambda message: faults.append(message.text) if message.type == "error" else None)
        tab.on("pageerror", lambda error: faults.append(str(error)))
        tab.on(
            "request",
            lambda request: None if request.url.startswith(("file:", "data:")) else faults.append(request.url),
        )
        tab.goto((page.as_uri() if isinstance(page, Path) else page) + anchor)
        return tab

    opened.faults = faults
    yield opened
    assert faults == []


def waits_for(tab, frame):
    tab.wait_for_function(f"{ON_CANVAS} === {json.dumps(frame)}")


def told(tab):
    """What the page tells of the pixel that was picked."""
    rows = tab.evaluate(
        "[...document.querySelectorAll('#picked dt')].map((dt) => [dt.textContent, dt.nextSibling.textContent])"
    )
    return dict(rows)


def test_a_hundred_pixels_are_picked_right(shown, finished, opened):
    run = open_run(finished)
    frame = next(frame for frame in run if frame.name.endswith("k001/ego.CAM_FRONT"))
    classes = {id: name.replace("_", " ") for id, name in run.classes.items()}
    by_id = {row["id"]: row for row in frame.table["objects"]}
    tab = opened(shown)
    waits_for(tab, frame.name)
    canvas = tab.locator("#picture").bounding_box()
    height, width = frame.instance.shape
    chosen = np.random.default_rng(5)
    things = np.argwhere(frame.instance > 0)
    pixels = [*chosen.permutation(things)[:50], *chosen.integers(0, [height, width], (50, 2))]
    kinds = set()
    for y, x in pixels:
        tab.mouse.click(
            canvas["x"] + (x + 0.5) / width * canvas["width"], canvas["y"] + (y + 0.5) / height * canvas["height"]
        )
        tab.wait_for_function(f"trove.state.picked?.x === {x} && trove.state.picked?.y === {y}")
        rows = told(tab)
        assert rows["pixel"] == f"{x}, {y}"
        assert rows["class"] == classes[frame.class_[y, x]]
        depth_m = frame.depth_m[y, x]
        if np.isfinite(depth_m):
            # Half a step of the page's logarithm, and half a centimetre.
            exact_m = 1.06e-4 * float(depth_m) + 0.0051
            assert float(rows["depth"].removesuffix(" m")) == pytest.approx(depth_m, rel=0, abs=exact_m)
        else:
            assert rows["depth"] == "sky"
        number = int(frame.instance[y, x])
        assert int(rows.get("object", 0)) == number
        if number:
            row = by_id[number]
            assert rows.get("model", "") == row["asset"] and rows["kind"] == row["kind"].replace("_", " ")
            assert rows.get("box", "") == ", ".join(map(str, row["visible_box"] or []))
        kinds.add(rows["class"])
    assert len(kinds) > 3


def test_keys_links_layers_and_classes(shown, finished, opened):
    tab = opened(shown)
    waits_for(tab, "demo-0001/v00/k001/ego.CAM_FRONT")
    pixels = "(() => { const c = document.getElementById('picture'); return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data]; })()"

    def seen():
        return np.array(tab.evaluate(pixels)).reshape(-1, 4)[:, :3]

    tab.keyboard.press("ArrowRight")
    waits_for(tab, "demo-0001/v00/k002/ego.CAM_FRONT")
    tab.keyboard.press("ArrowLeft")
    waits_for(tab, "demo-0001/v00/k001/ego.CAM_FRONT")
    tab.keyboard.press("[")
    waits_for(tab, "demo-0001/v00/k001/ego.CAM_BACK")
    link = tab.evaluate("location.hash")
    tab.goto("about:blank")
    tab.goto(shown.as_uri() + link)
    waits_for(tab, "demo-0001/v00/k001/ego.CAM_BACK")
    frame = next(frame for frame in open_run(finished) if frame.name == "demo-0001/v00/k001/ego.CAM_BACK")
    palette = {row["id"]: row["rgb"] for row in open_run(finished).manifest["classes"]}
    tab.locator("#opacity").fill("100")
    tab.wait_for_function(f"({pixels})[0] === {palette[frame.class_[0, 0]][0]}")
    assert (seen() == [palette[id] for id in frame.class_.ravel()]).all(), "classes in their colours"
    tab.get_by_label("Opacity").fill("0")
    photograph = f"Math.abs(({pixels})[0] - {frame.rgb[0, 0, 0]}) < 12"
    tab.wait_for_function(photograph)
    assert np.abs(seen() - frame.rgb.reshape(-1, 3)).mean() < 4, "the image without a label"
    for layer in tab.locator("#layers button").all():
        layer.click()
        assert layer.get_attribute("aria-pressed") == "true"
    # A class that is switched off is not laid over the image.
    tab.locator("#layers button", has_text="class").click()
    tab.locator("#opacity").fill("100")
    tab.wait_for_function(f"({pixels})[0] === {palette[frame.class_[0, 0]][0]}")
    tab.get_by_role("button", name="none", exact=True).last.click()
    tab.wait_for_function(photograph)
    assert np.abs(seen() - frame.rgb.reshape(-1, 3)).mean() < 4
    tab.close()


def test_the_scene_has_its_shapes_and_cameras_that_jump_to_their_frames(shown, opened):
    tab = opened(shown)
    waits_for(tab, "demo-0001/v00/k001/ego.CAM_FRONT")
    tab.wait_for_function("trove.three.scene.children[0].children[0].children.length > 0")
    # From the camera the scene has the colours of what the image shows: sky above, road below.
    tab.keyboard.press("c")
    at = tab.evaluate("trove.three.camera.position.toArray()")
    pose = tab.evaluate("trove.shown().pose")
    assert at == pytest.approx([pose[3], pose[7], pose[11]], abs=1e-3)
    # Seen from above, a click on the frustum of another camera jumps to its frame.
    tab.keyboard.press("o")
    where = tab.evaluate(
        """() => {
          const { three } = trove, run = JSON.parse(document.getElementById("run").textContent);
          const frame = run.scenes[0].moments[0].frames.find((frame) => frame.view === "ego.CAM_BACK");
          const [x, y, z] = three.apply(frame.pose, [0, 0, 0.96]);
          three.camera.updateMatrixWorld();
          const seen = three.camera.position.clone().set(x, y, z).project(three.camera), box = three.canvas.getBoundingClientRect();
          return [box.left + ((seen.x + 1) / 2) * box.width, box.top + ((1 - seen.y) / 2) * box.height];
        }"""
    )
    tab.mouse.click(*where)
    waits_for(tab, "demo-0001/v00/k001/ego.CAM_BACK")
    tab.close()


def test_frames_beside_the_page_are_loaded_when_they_are_looked_at(finished, opened, tmp_path):
    page = tmp_path / "large.html"
    found = view(finished, page, "--embed", "0", "--shapes", "0")
    beside = Path(found["beside"])
    assert beside == tmp_path / "large.frames" and found["bytes"] < 1e6
    assert len(list(beside.rglob("*.js"))) == found["frames"] + 1
    tab = opened(page)
    waits_for(tab, "demo-0001/v00/k001/ego.CAM_FRONT")
    asked = []
    tab.on("request", lambda request: asked.append(Path(request.url).name))
    for _ in range(3):
        for key, frame in (
            ("ArrowRight", "k002/ego.CAM_FRONT"),
            ("]", "k002/v1.CAM_BACK"),
            ("[", "k002/ego.CAM_FRONT"),
            ("ArrowLeft", "k001/ego.CAM_FRONT"),
        ):
            tab.keyboard.press(key)
            waits_for(tab, f"demo-0001/v00/{frame}")
    assert asked.count("ego.CAM_FRONT.js") == 1, "what is kept is not loaded again"
    for k in (1, 2):
        for camera in ("ego.CAM_BACK", "ego.CAM_FRONT", "v1.CAM_BACK", "v1.CAM_FRONT"):
            tab.evaluate(f"location.hash = 'frame=demo-0001/v00/k00{k}/{camera}'")
            waits_for(tab, f"demo-0001/v00/k00{k}/{camera}")
    assert tab.evaluate("trove.kept.size") == 6, "of nine chunks"
    shutil.rmtree(beside / "demo-0001" / "v00" / "k001")
    tab.goto("about:blank")
    tab.goto(page.as_uri())
    tab.wait_for_function("document.getElementById('fault').textContent.includes('keep that folder beside the page')")
    assert set(opened.faults) == {"Failed to load resource: net::ERR_FILE_NOT_FOUND"}
    opened.faults.clear()
    tab.close()


def test_variations_are_compared(recipe, opened, tmp_path):
    two = tmp_path / "two.toml"
    text = (
        recipe.read_text()
        .replace("keyframes = [1, 2]", "keyframes = [1]")
        .replace('"CAM_BACK"', "")
        .replace("other_vehicles = 1", "")
    )
    two.write_text(text + '[variations]\ncount = 2\nfactors = ["paint", "facades"]\n')
    out = tmp_path / "two"
    done = trove("generate", two, "--out", out)
    assert done.returncode == 0, done.stderr
    page = tmp_path / "two.html"
    assert view(out, page, "--shapes", "0")["scenes"] == 2
    tab = opened(page, "#frame=demo-0001/v00/k001/ego.CAM_FRONT&layer=none")
    waits_for(tab, "demo-0001/v00/k001/ego.CAM_FRONT")
    pixels = "(() => { const c = document.getElementById('picture'); return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data]; })()"

    def seen():
        return np.array(tab.evaluate(pixels)).reshape(90, 160, 4)[:, :, :3].astype(int)

    def shows(name):
        rgb = next(frame for frame in open_run(out) if frame.name == name).rgb.astype(int)
        return np.abs(seen() - rgb).mean(axis=(0, 2)) < 6

    tab.locator("#other").select_option("demo-0001/v01")
    tab.locator("#split").fill("25")
    tab.wait_for_function("trove.state.split === 25")
    tab.wait_for_timeout(300)
    assert shows("demo-0001/v00/k001/ego.CAM_FRONT")[:38].all() and shows("demo-0001/v01/k001/ego.CAM_FRONT")[44:].all()
    tab.locator("#picture").press("v")
    waits_for(tab, "demo-0001/v01/k001/ego.CAM_FRONT")
    tab.close()


def test_a_recipes_scene_is_shown_without_images(recipe, opened, tmp_path):
    page = tmp_path / "scene.html"
    found = view(recipe, page)
    assert found["frames"] == 8
    tab = opened(page)
    tab.wait_for_function("trove.three.scene.children[0].children[0].children.length > 0")
    assert tab.get_by_text("made without images").is_visible() and not tab.locator("#picture").is_visible()
    tab.close()


@pytest.mark.parametrize("width", [1440, 800, 390])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nobody_is_kept_out(shown, opened, scheme, width):
    tab = opened(shown, size=(width, 800), color_scheme=scheme)
    waits_for(tab, "demo-0001/v00/k001/ego.CAM_FRONT")
    assert tab.evaluate("document.documentElement.scrollWidth <= innerWidth"), "wider than the window"
    tab.add_script_tag(path=AXE)
    found = tab.evaluate(
        "axe.run().then(({ violations }) => violations.map(({ id, nodes }) => [id, nodes.map((n) => n.html)]))"
    )
    assert found == []
    # Everything is reached by Tab, and shows that it is.
    reached = set()
    for _ in range(120):
        tab.keyboard.press("Tab")
        reached.add(tab.evaluate("document.activeElement.id || document.activeElement.textContent.trim()"))
    assert {"world", "moment", "picture", "opacity", "overview", "class", "back"} <= reached
    tab.close()


def test_the_page_is_served_to_this_machine_alone(finished, tmp_path):
    page = tmp_path / "my page.html"
    (tmp_path / "secret").write_text("secret")
    command = [
        sys.executable,
        "-m",
        "trove",
        "view",
        str(finished),
        "--out",
        str(page),
        "--embed",
        "0",
        "--shapes",
        "0",
        "--serve",
    ]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        try:
            address = server.stdout.readline().split()[0]
            assert address.startswith("http://127.0.0.1:") and address.endswith("/my%20page.html")
            assert urllib.request.urlopen(address).read() == page.read_bytes()
            root = address.removesuffix("my%20page.html")
            script = "my%20page.frames/demo-0001/v00/k001/ego.CAM_FRONT.js"
            assert urllib.request.urlopen(root + script).read().startswith(b'chunk("demo-0001/v00/k001/ego.CAM_FRONT"')
            for outside in ("secret", "my%20page.frames/..%2fsecret", "..%2f..%2fetc/passwd"):
                with pytest.raises(urllib.error.HTTPError, match="404"):
                    urllib.request.urlopen(root + outside)
        finally:
            server.terminate()
            server.communicate(timeout=60)
    assert server.returncode == 0


def test_wrong_input_is_told(tmp_path, finished):
    for source, out, said in [
        (tmp_path, tmp_path / "p.html", "expected a finished folder of trove generate"),
        (tmp_path / "none", tmp_path / "p.html", "found neither"),
        (finished, tmp_path, "found a folder"),
        (finished, tmp_path / "none" / "p.html", "none"),
    ]:
        done = trove("view", source, "--out", out)
        assert done.returncode == 1 and said in done.stderr, done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_page_is_made_of_a_copied_folder_though_its_scene_cannot_be_built_again(finished, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(finished, copy, ignore=shutil.ignore_patterns(".trove"))
    found = view(copy, tmp_path / "copy.html")
    assert found["frames"] == 8 and "no record of its recipe" in found["without_shapes"]


def scene_of(page):
    """What a page holds of its scene: the row of the table, and the chunk."""
    scripts = dict(re.findall(r'<script type="application/json" id="([^"]*)">(.*?)</script>', page.read_text()))
    table = json.loads(re.search(r'<script id="run" type="application/json">(.*?)</script>', page.read_text())[1])
    return table["scenes"][0], json.loads(scripts[table["scenes"][0]["id"]])


def test_a_glb_file_shows_what_its_recipe_does(recipe, tmp_path):
    glb = tmp_path / "scene.glb"
    done = trove("build", recipe, "--out", glb)
    assert done.returncode == 0, done.stderr
    assert view(glb, tmp_path / "glb.html")["frames"] == 4
    view(recipe, tmp_path / "recipe.html")
    of_file, there = scene_of(tmp_path / "glb.html")
    of_recipe, wanted = scene_of(tmp_path / "recipe.html")
    cameras = [{frame["view"]: frame for frame in row["moments"][0]["frames"]} for row in (of_file, of_recipe)]
    assert cameras[0].keys() == cameras[1].keys()
    for name, camera in cameras[0].items():
        assert camera["k"] == pytest.approx(cameras[1][name]["k"])
        assert camera["pose"] == pytest.approx(cameras[1][name]["pose"], abs=2e-3)
    boxes = [{box["id"]: box for box in chunk["moments"][0] + chunk["scenery"]} for chunk in (there, wanted)]
    assert len(boxes[0]) > 20 and boxes[0].keys() == boxes[1].keys()
    for number, box in boxes[0].items():
        other = boxes[1][number]
        assert [box[key] for key in ("class_id", "kind", "origin", "asset", "size")] == [
            other[key] for key in ("class_id", "kind", "origin", "asset", "size")
        ]
        assert box["pose"] == pytest.approx(other["pose"], abs=1e-3)
    assert set(there["shapes"]["bodies"]) <= set(wanted["shapes"]["bodies"])
    assert len(there["shapes"]["bodies"]) == len(there["moments"][0])
