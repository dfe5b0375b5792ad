"""Pages of HTML, as a browser shows them: on a phone and a desk, in light and dark, with the numbers that commands tell."""

import json
import re
import shutil

import numpy as np
import pytest
from conftest import trove
from PIL import Image

# Of each text: its contrast with what is behind it, as WCAG 2.2 defines it, and whether all of it can be
# seen: in the window, or in a part of the page that moves sideways.
TEXTS = """() => {
  const parsed = (color) => color.match(/[\\d.]+/g).map(Number);
  const luminance = ([r, g, b]) => [r, g, b].map((c) => c / 255)
    .map((c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)
    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const ground = (element) => {
    for (; element; element = element.parentElement) {
      const color = parsed(getComputedStyle(element).backgroundColor);
      if (color.length === 3 || color[3] === 1) return color;
    }
    return [255, 255, 255];
  };
  const paper = (element) => {
    const below = ground(element), cell = element.closest("svg g")?.querySelector("rect");
    if (!cell) return below;
    const { fill, fillOpacity } = getComputedStyle(cell);
    return parsed(fill).map((c, i) => c * fillOpacity + below[i] * (1 - fillOpacity));
  };
  const texts = [];
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const text = walk.currentNode.textContent.trim();
    const element = walk.currentNode.parentElement, style = getComputedStyle(element);
    if (!/[\\p{L}\\d]/u.test(text) || element.closest("script, style, title, [hidden]")) continue;
    const ink = luminance(parsed(element.closest("svg") ? style.fill : style.color));
    const behind = luminance(paper(element));
    const range = document.createRange();
    range.selectNodeContents(walk.currentNode);
    const box = range.getBoundingClientRect();
    texts.push({
      text, px: Math.min(box.height, parseFloat(style.fontSize)),
      contrast: (Math.max(ink, behind) + 0.05) / (Math.min(ink, behind) + 0.05),
      inside: element.closest(".wide") !== null || (box.left >= 0 && box.right <= innerWidth),
    });
  }
  return texts;
}"""
# What programs that read aloud need, and the page's language and title.
UNNAMED = """() => [
  ...document.querySelectorAll("html:not([lang]), th:not([scope]), img:not([alt]), img[alt=''], "
    + "svg:not([aria-hidden]):not([role=img][aria-label]), svg[aria-label=''], [tabindex]:not([aria-label]), "
    + "input:not([id]), a:not([href])"),
  ...[...document.querySelectorAll("input")].filter((input) => !input.labels.length),
  ...(document.title ? [] : [document.documentElement]),
].map((element) => element.outerHTML.slice(0, 200))"""


class Shown:
    """A page in the browser, which has been looked at in all widths and schemes."""

    def __init__(self, browser, path, tmp_path):
        source = path.read_text()
        assert not re.search(r"https?:|url\(|@import| on\w+=", source), "it needs nothing from elsewhere"
        said, asked = [], []
        self.page = page = browser.new_page(viewport={"width": 1280, "height": 800})
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("request", lambda request: asked.append(request.url))
        page.goto(path.as_uri())
        for image in page.locator("img").all():
            image.scroll_into_view_if_needed()  # pictures are loaded once they are near
        page.wait_for_function("[...document.images].every((image) => image.complete && image.naturalWidth)")
        assert page.evaluate(UNNAMED) == []
        self.pixels = {}
        for scheme in ("light", "dark"):
            page.emulate_media(color_scheme=scheme)
            for width in (1280, 390, 360):
                page.set_viewport_size({"width": width, "height": 800})
                beyond = page.evaluate("document.documentElement.scrollWidth - innerWidth")
                assert beyond <= 0, f"{beyond} px wider than a window of {width}"
                texts = page.evaluate(TEXTS)
                bad = [text for text in texts if text["contrast"] < 4.5 or not text["inside"] or text["px"] < 11]
                assert texts and not bad, (scheme, width, bad[:5])
            page.evaluate("scrollTo(0, 0)")
            page.screenshot(path=tmp_path / "page.png", full_page=True)
            self.pixels[scheme] = np.array(Image.open(tmp_path / "page.png").convert("RGB")).reshape(-1, 3)
            assert (self.pixels[scheme].mean() < 110) == (scheme == "dark")
        assert said == [] and [url for url in asked if not url.startswith(("file:", "data:"))] == []
        self.text = page.evaluate("document.body.innerText")

    def rows(self, label):
        """The cells of a table's rows."""
        script = "(rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent))"
        return self.page.locator(f"[aria-label={json.dumps(label)}] tbody tr").evaluate_all(script)

    def has(self, color, scheme="light", least=100):
        """Whether enough pixels have a colour."""
        return (self.pixels[scheme] == color).all(axis=1).sum() >= least

    def sources(self):
        """Size of each picture, by what it shows."""
        script = "(images) => Object.fromEntries(images.map((i) => [i.alt, [i.naturalWidth, i.naturalHeight]]))"
        return self.page.locator("img").evaluate_all(script)


@pytest.fixture
def shown(browser, tmp_path):
    """Opens a page and looks at it; one a test, as the browser ends with its first."""
    opened = []

    def show(path):
        opened.append(Shown(browser, path, tmp_path))
        return opened[0]

    yield show
    for one in opened:
        one.page.close()


def ran(*args, status=0):
    """What a command prints."""
    done = trove(*args)
    assert done.returncode == status, done.stderr
    return done.stdout


def save(path, array):
    """Writes an array as PNG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(array.astype(np.uint8)).save(path)


def test_what_was_curated_is_shown(finished, tmp_path, shown):
    out = ["--out", tmp_path / "list.json", "--page", tmp_path / "page.html"]
    # At this size few classes cover enough of a picture; and both places are one.
    found = json.loads(ran("curate", finished, "--count", 3, "--min-classes", 2, "--val-share", 0, "--json", *out))
    page = shown(tmp_path / "page.html")
    assert f"{found['frames']} frames; {found['kept']} kept: {found['train']} for training" in page.text
    sizes = page.sources().values()
    assert len(sizes) == found["kept"] == 3 and {width for width, _ in sizes} == {200}
    road = f"{found['shares_before']['road'] * 100:.3f} → {found['shares_after']['road'] * 100:.3f} %"
    assert road in page.page.locator("svg.rows").text_content()
    # Every class that fills some of the frames has a bar that is seen in its colour.
    for scheme in ("light", "dark"):
        assert page.has([70, 130, 180], scheme) and page.has([128, 64, 128], scheme)


def test_an_evaluation_is_shown_with_what_was_taken_for_what(tmp_path, shown):
    # Road to the left of an edge, sky to its right; one prediction's edge lies further right, the other's is right.
    edge = np.arange(400)[None] + np.zeros((200, 1), int)
    for side, x in [("truth", 200), ("<b>predicted", 250)]:
        for name, at in [("aachen", x), ("bonn", 200)]:
            save(tmp_path / side / f"{name}_000000_000019_gtFine_labelIds.png", np.where(edge < at, 7, 23))
    pair = [tmp_path / "<b>predicted", tmp_path / "truth"]
    args = [*pair, "--classes", "cityscapes", "--boundary", "--page", tmp_path / "page.html"]
    found = json.loads(ran("evaluate", *args, "--json"))
    page = shown(tmp_path / "page.html")
    assert "Evaluation of <b>predicted" in page.text
    scores = {name: f"{found[name] * 100:.2f} %" for name in ("miou", "accuracy", "boundary_miou")}
    assert [scores["miou"], scores["accuracy"]] == ["88.19 %", "93.75 %"]
    facts = page.page.locator(".facts").inner_text()
    assert all(score in facts for score in scores.values())
    rows = {row[0]: row[1:] for row in page.rows("Scores by class")}
    assert rows.keys() == {"road", "sky"} and [rows[name][:2] for name in rows] == [
        ["50.00", "88.89"],
        ["50.00", "87.50"],
    ]
    assert page.rows("Largest confusions") == [["sky", "road", "10000", "12.50", "100.00"]]
    cells = page.page.locator("svg[aria-label^=Confusion] g")
    assert [cell.split(" taken for ")[0] for cell in cells.locator("title").all_text_contents()] == [
        "road",
        "sky",
        "sky",
    ]
    assert cells.locator("text").all_text_contents() == ["100", "12", "88"]
    captions = page.page.locator("figcaption").all_inner_texts()
    assert [caption.split("_")[0] for caption in captions] == ["aachen", "bonn"], "the worst first"
    assert "12.50 % of it is sky taken for road" in captions[0]
    # Differences are magenta, up to JPEG.
    pixels = page.pixels["light"].astype(int)
    assert (np.abs(pixels - [255, 0, 255]).max(axis=1) < 30).sum() > 300
    assert page.has([128, 64, 128]), "bars have the colours of their classes"


def test_what_recolouring_did_is_shown(finished, tmp_path, shown):
    random = np.random.default_rng(3)
    for name in "abc":
        save(tmp_path / "photos" / f"{name}.png", random.normal([150, 120, 90], 25, (60, 80, 3)).clip(0, 255))
    args = [finished, "--to", tmp_path / "photos", "--out", tmp_path / "out", "--strength", 1]
    found = json.loads(ran("recolor", *args, "--page", tmp_path / "page.html", "--json"))
    page = shown(tmp_path / "page.html")
    assert f"{found['pictures']} images, towards the colours of 3 in photos" in page.text
    told = [
        [*(f"{m:.1f} ± {d:.1f}" for m, d in zip(s["mean"], s["deviation"])), "{:.2f}, {:.2f}".format(*s["sharpness"])]
        for s in (found["before"], found["target"], found["after"])
    ]
    rows = page.rows("Colours of all pixels")
    assert [row[1:] for row in rows] == told and [row[0] for row in rows] == ["before", "target", "after"]
    classes = {row[0]: row for row in page.rows("Mean colours by class")}
    assert "road" in classes and sum(float(row[1]) for row in classes.values()) == pytest.approx(100, abs=0.2)
    pixels = [np.array(Image.open(path)) for path in sorted(finished.rglob("class.png"))]
    assert float(classes["road"][1]) == pytest.approx(
        np.mean(np.concatenate([p.ravel() for p in pixels]) == 9) * 100, abs=0.3
    )
    assert page.page.locator("polyline").count() == 9
    alts = page.sources()
    assert (
        sum(alt.endswith(" before") for alt in alts) == sum(alt.endswith(" after") for alt in alts) == found["pictures"]
    )
    assert sum("of the target" in alt for alt in alts) == 3


def test_files_that_are_not_as_they_were_written_are_shown(finished, tmp_path, shown):
    copy = tmp_path / "copy"
    shutil.copytree(finished, copy)
    frame = next(path for path in sorted(copy.glob("*/*/*/ego.CAM_FRONT")))
    (frame / "depth.exr").write_bytes(b"other")
    (frame / "class.png").unlink()
    found = json.loads(ran("verify", copy, "--page", tmp_path / "page.html", "--json", status=1))
    page = shown(tmp_path / "page.html")
    where = frame.relative_to(copy).as_posix()
    assert sorted(page.rows("Findings")) == [
        [f"{where}/class.png", "no file"],
        [f"{where}/depth.exr", "other bytes than were written"],
    ]
    facts = page.page.locator(".facts div").all_inner_texts()
    assert [fact.split("\n")[:2] for fact in facts] == [
        ["Frames", str(found["frames"])], ["Files", str(found["files"])], ["Damaged", "2"], ["Unlisted", "0"],
    ]  # fmt: skip


def test_faults_of_labels_are_shown_where_they_are(finished, tmp_path, shown):
    copy = tmp_path / "copy"
    shutil.copytree(finished, copy)
    frame = next(path for path in sorted(copy.glob("*/*/*/ego.CAM_FRONT")))
    labels = np.array(Image.open(frame / "class.png"))
    save(frame / "class.png", np.roll(labels, 3, axis=1))
    found = json.loads(ran("verify", copy, "--labels", "--page", tmp_path / "page.html", "--json", status=1))
    page = shown(tmp_path / "page.html")
    assert page.rows("Findings") == [
        [f["check"], f["what"] + f["place"], f"{f['severity'] * 100:.1f}"] for f in found["findings"]
    ]
    # Under a check's name stands its rule.
    names = page.page.locator("[aria-label=Checks] tbody th").evaluate_all("(th) => th.map((th) => th.firstChild.data)")
    checks = {name: row[1:] for name, row in zip(names, page.rows("Checks"))}
    assert len(checks) == 20 and {name: counts for name, counts in checks.items() if counts[0] != "–"} == {
        name: [str(tally["looked_at"]), str(tally["findings"])] for name, tally in found["checks"].items()
    }
    where = frame.relative_to(copy).as_posix()
    assert any(alt.startswith(f"classes in {where}") for alt in page.sources())
    pixels = page.pixels["light"].astype(int)
    assert (np.abs(pixels - [255, 0, 255]).max(axis=1) < 60).sum() > 100


def test_assets_are_drawn_listed_and_searched(tmp_path, shown):
    (tmp_path / "mine").mkdir()
    plans = '[[car]]\nid = "kombi"\nlike = "car/estate"\n[[cone]]\nid = "small-cone"\nlike = "cone/tall"\n'
    (tmp_path / "mine/plans.toml").write_text(plans)
    ran(
        "assets",
        "sheet",
        "--library",
        tmp_path / "mine",
        "--size",
        "64x48",
        "--spp",
        1,
        "--out",
        tmp_path / "page.html",
    )
    listed = json.loads(ran("assets", "list", "--library", tmp_path / "mine", "--json"))["assets"]
    page = shown(tmp_path / "page.html")
    rows = {row[0]: row for row in page.rows("Models and materials")}
    assert rows.keys() == {asset["id"] for asset in listed} == page.sources().keys() and len(rows) >= 2
    for asset in listed:
        size = " × ".join(f"{side:.2f}" for side in asset["size_m"])
        assert rows[asset["id"]][1:4] == [asset["class"].replace("_", " "), asset["kind"].replace("_", " "), size]
        assert rows[asset["id"]][5] == asset["licence"]
    page.page.fill("input", "Kombi car")
    visible = "(elements) => elements.filter((e) => !e.hidden).map((e) => e.textContent)"
    assert len(page.page.locator("tbody tr").evaluate_all(visible)) == 1
    assert page.page.locator("figure").evaluate_all(visible) == ["mine/kombi"]
    assert page.page.locator("output").text_content() == f"1 of {len(rows)}"
