"""`trove evaluate`, `trove recolor` and `trove curate`, as a user meets them."""

import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from conftest import trove
from PIL import Image
from trove.format import read_curated

WIDTH, HEIGHT = 2048, 1024


def save(path, array):
    """Writes an array as PNG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(array).save(path)
    return path


def evaluated(*args):
    """What `trove evaluate` says of two folders."""
    done = trove("evaluate", *args, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def blobs(random, ids):
    """Labels of Cityscapes' size: patches of random ids with ragged outlines."""
    patches = np.kron(random.choice(ids, (16, 32)), np.ones((HEIGHT // 16, WIDTH // 32), np.uint8))
    rows = np.arange(HEIGHT)[:, None] + random.integers(-9, 10, (HEIGHT, WIDTH))
    columns = np.arange(WIDTH)[None] + random.integers(-9, 10, (HEIGHT, WIDTH))
    return patches[rows.clip(0, HEIGHT - 1), columns.clip(0, WIDTH - 1)].astype(np.uint8)


def cityscapes_pairs(folder, wrong_share=0.2):
    """Folders of predictions and truths, with instances, in Cityscapes' names; all 34 ids are among them."""
    random = np.random.default_rng(5)
    sample = (
        Path(os.environ.get("TROVE_TEST_DATA", "none"))
        / "cityscapes-sample/tests/data/pseudo_cityscapes_dataset/gtFine"
    )
    truths = {f"made_{i:06}_000019": blobs(random, np.arange(34)) for i in range(2)}
    truths |= {path.name.split("_gtFine")[0]: np.array(Image.open(path)) for path in sample.glob("*_labelIds.png")}
    for name, truth in truths.items():
        predicted = np.where(random.random(truth.shape) < wrong_share, random.integers(0, 34, truth.shape), truth)
        for side, ids in [("truth", truth), ("predicted", predicted.astype(np.uint8))]:
            save(folder / side / f"{name}_gtFine_labelIds.png", ids)
            # Every column of 256 pixels has its own object; a quarter of them are crowds.
            column = np.arange(ids.shape[1])[None] // 256 + np.zeros(ids.shape, int)
            objects = np.where((ids >= 24) & (column % 4 > 0), ids.astype(int) * 1000 + column, ids)
            save(folder / side / f"{name}_gtFine_instanceIds.png", objects.astype(np.uint16))
    return folder / "predicted", folder / "truth"


def test_ious_are_those_of_cityscapes_scripts_to_the_last_digit(tmp_path):
    theirs = pytest.importorskip("cityscapesscripts.evaluation.evalPixelLevelSemanticLabeling")
    predicted, truth = cityscapes_pairs(tmp_path)
    ours = evaluated(predicted, truth, "--classes", "cityscapes")
    theirs.args.evalInstLevelScore = theirs.args.JSONOutput = False
    theirs.args.quiet = True
    pairs = [[str(path) for path in sorted(side.glob("*_labelIds.png"))] for side in (predicted, truth)]
    expected = theirs.evaluateImgLists(*pairs, theirs.args)
    assert ours["iou"] == {name: iou for name, iou in expected["classScores"].items() if not np.isnan(iou)}
    assert ours["miou"] == expected["averageScoreClasses"]
    ids = [label.id for label in theirs.labels if label.trainId not in (255, -1)]
    assert [row[:-1] for row in ours["confusion"]["pixels"]] == np.array(expected["confMatrix"])[
        np.ix_(ids, ids)
    ].tolist()


def test_panoptic_quality_is_that_of_cityscapes_scripts(tmp_path):
    theirs = pytest.importorskip("cityscapesscripts.evaluation.evalPanopticSemanticLabeling")
    predicted, truth = cityscapes_pairs(tmp_path, wrong_share=0.05)
    ours = evaluated(predicted, truth, "--classes", "cityscapes", "--panoptic")
    categories = {label.id: {"isthing": label.hasInstances} for label in theirs.csLabels if not label.ignoreInEval}
    sides = {}
    for side in (predicted, truth):
        sides[side] = []
        for path in sorted(side.glob("*_instanceIds.png")):
            objects = np.array(Image.open(path)).astype(int)
            ids = np.where(objects >= 1000, objects // 1000, objects)
            segments = np.where(np.isin(ids, list(categories)), objects, 0)
            name = path.name.replace("_instanceIds", "_panoptic")
            save(side / name, np.stack([segments % 256, segments // 256, segments * 0], -1).astype(np.uint8))
            crowd = lambda s: int(s < 1000 and categories[s]["isthing"])  # noqa: E731
            rows = [
                {"id": int(s), "category_id": int(s if s < 1000 else s // 1000), "iscrowd": crowd(s)}
                for s in np.unique(segments)
                if s
            ]
            areas = {row["id"]: int((segments == row["id"]).sum()) for row in rows}
            sides[side].append(
                {
                    "image_id": name,
                    "file_name": name,
                    "segments_info": [row | {"area": areas[row["id"]]} for row in rows],
                }
            )
    stat = theirs.pq_compute_single_core(
        0, list(zip(sides[truth], sides[predicted])), str(truth), str(predicted), categories
    )
    expected = theirs.average_pq(stat, categories)
    assert ours["pq"] == pytest.approx(expected["All"]["pq"], rel=1e-12)
    names = {label.id: label.name for label in theirs.csLabels}
    for category, row in expected["per_class"].items():
        assert {key: ours["panoptic"][names[category]][key] for key in row} == pytest.approx(row, rel=1e-12)


def test_halves_that_are_moved_have_the_values_of_their_areas(tmp_path):
    # Road to the left of an edge, sky to its right; the prediction's edge lies 256 pixels further right.
    edge = np.arange(WIDTH)[None] + np.zeros((HEIGHT, 1), int)
    for side, x in [("truth", 1024), ("predicted", 1280)]:
        save(tmp_path / side / "aachen_000000_000019_gtFine_labelIds.png", np.where(edge < x, 7, 23).astype(np.uint8))
    found = evaluated(tmp_path / "predicted", tmp_path / "truth", "--classes", "cityscapes", "--boundary")
    assert found["iou"] == {"road": 1024 / 1280, "sky": 768 / 1024}
    assert (found["miou"], found["accuracy"]) == ((1024 / 1280 + 768 / 1024) / 2, 1792 / 2048)
    # 2 % of the diagonal are 46 pixels; a band is what lies within them of a half's outline.
    band = 46
    inner = HEIGHT - 2 * band
    truth, predicted = (w * HEIGHT - (w - 2 * band) * inner for w in (1024, 1280))
    both = 1024 * HEIGHT - (1024 - band) * inner
    assert found["boundary_iou"]["road"] == both / (truth + predicted - both)


def test_the_thirteen_classes_are_the_default_and_void_is_left_out(tmp_path):
    truth = np.array([[0, 1, 1, 6], [6, 6, 12, 0]], np.uint8)
    predicted = np.array([[5, 1, 6, 6], [6, 0, 12, 3]], np.uint8)
    found = evaluated(save(tmp_path / "p.png", predicted), save(tmp_path / "t.png", truth))
    assert found["iou"] == {"car": 1 / 2, "road": 2 / 4, "sky": 1.0}
    assert found["miou"] == pytest.approx(2 / 3) and found["accuracy"] == 4 / 6


def test_our_own_frames_are_judged_in_the_thirteen_classes_without_options(finished):
    found = evaluated(finished, finished)
    assert found["classes"] == "paper13" and found["miou"] == found["accuracy"] == 1
    assert {side: found[side]["classes"] for side in ("predicted", "truth")} == {
        "predicted": "trove20",
        "truth": "trove20",
    }
    paper = {"car", "bus", "truck", "person", "rider", "road", "sidewalk", "building"}
    assert {"road", "sky"} <= found["iou"].keys() <= paper | {"traffic_pole", "vegetation", "terrain", "sky"}
    told = trove("evaluate", finished, finished).stdout
    assert "classes: paper13; predicted: trove20 (class.png beside frame.json); truth: trove20" in told


def test_a_class_map_of_ones_own_judges_our_frames_against_ids_of_its_own(finished, tmp_path):
    ours = {"drivable": [9], "green": [14, 15], "vehicle": [2, 3, 4, 5, 6, 13]}
    rows = {"drivable": 'id = 4\ntrove = ["road"]', "green": 'id = 7\ntrove = ["bush", "tree"]'}
    rows["vehicle"] = 'id = 9\ntrove = ["car", "bus", "jeep", "truck", "van", "construction"]'
    file = tmp_path / "mine.toml"
    file.write_text("".join(f'[[class]]\nname = "{name}"\n{row}\n' for name, row in rows.items()))
    numbers = np.full(20, 255, np.uint8)
    for name, row in rows.items():
        numbers[ours[name]] = int(row[5])
    for path in finished.rglob("class.png"):
        save(
            tmp_path / "p" / path.parent.relative_to(finished).with_suffix(f"{path.parent.suffix}.png"),
            numbers[np.array(Image.open(path))],
        )
    found = evaluated(tmp_path / "p", finished, "--classes", file)
    assert found["classes"] == "mine" and found["miou"] == 1 and found["iou"].keys() <= rows.keys()
    file.write_text(file.read_text().replace("bush", "bsh"))
    done = trove("evaluate", tmp_path / "p", finished, "--classes", file)
    assert done.returncode == 1 and "mine.toml: class" in done.stderr and 'did you mean "bush"?' in done.stderr


def crc32c(data):
    """Masked as in a TFRecord."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    crc ^= 0xFFFFFFFF
    return ((crc >> 15 | crc << 17) + 0xA282EAD8 & 0xFFFFFFFF).to_bytes(4, "little")


def varint(value):
    return bytes([value & 127 | 128]) + varint(value >> 7) if value > 127 else bytes([value])


def field(number, value):
    """A field of a protobuf message."""
    if isinstance(value, int):
        return varint(number << 3) + varint(value)
    return varint(number << 3 | 2) + varint(len(value)) + value


def test_waymos_panoptic_labels_are_ground_truth(tmp_path):
    random = np.random.default_rng(2)
    # Road, lane marker, sky, pedestrians 1 and 2; a frame without labels is between two with.
    truths = {k: random.choice(np.array([20000, 21000, 25000, 9001, 9002], np.uint16), (8, 12)) for k in (0, 2)}
    records = b""
    for k in range(3):
        pose = field(1, np.eye(4).tobytes())
        calibration = field(1, 1) + field(2, np.array([9, 9, 6, 4, 0, 0, 0, 0, 0], float).tobytes())
        calibration += field(3, pose) + field(4, 12) + field(5, 8)
        picture = field(1, 1) + field(3, pose)
        if k in truths:
            png = save(tmp_path / "label.png", truths[k]).read_bytes()
            picture += field(10, field(1, 1000) + field(2, png))
        frame = field(1, field(1, b"made") + field(2, calibration)) + field(2, 1_600_000_000_000_000 + k * 100_000)
        frame += field(3, pose) + field(4, picture)
        length = len(frame).to_bytes(8, "little")
        records += length + crc32c(length) + frame + crc32c(frame)
    (tmp_path / "waymo").mkdir()
    (tmp_path / "waymo/segment-made.tfrecord").write_bytes(records)
    out = tmp_path / "drives"
    done = trove(
        "export", tmp_path / "waymo", "--dataset", "waymo", "--format", "trove", "--pictures", "--out", out, "--json"
    )
    assert done.returncode == 0 and json.loads(done.stdout)["labels"] == 2, done.stderr
    labels = out / "made/labels"
    assert sorted(path.name for path in labels.rglob("*.*")) == ["000000.png", "000002.png", "class_map.toml"]
    found = evaluated(labels, labels, "--panoptic")
    assert (found["miou"], found["pq"], found["classes"]) == (1, 1, "waymo")
    # In Waymo's own ids: a prediction of road wherever there is a lane marker.
    pixels = np.stack(list(truths.values()))
    for k, truth in truths.items():
        ids = (truth // 1000).astype(np.uint8)
        save(tmp_path / f"p/FRONT/{k:06}.png", np.where(ids == 21, 20, ids).astype(np.uint8))
        save(
            tmp_path / f"p13/FRONT/{k:06}.png",
            np.array([6, 12, 4, 6], np.uint8)[[[20, 25, 9, 21].index(i) for i in ids.flat]].reshape(8, 12),
        )
    found = evaluated(tmp_path / "p", labels, "--classes", "waymo")
    road, markers = (pixels == 20000).sum(), (pixels == 21000).sum()
    assert found["iou"] == {"road": road / (road + markers), "lane marker": 0, "sky": 1, "pedestrian": 1}
    # In the paper's classes lane markers are road.
    found = evaluated(tmp_path / "p13", labels, "--classes", "paper13")
    assert found["iou"] == {"road": 1, "sky": 1, "person": 1}
    unnamed = trove("evaluate", tmp_path / "p", labels)
    assert unnamed.returncode == 1 and "(waymo)" in unnamed.stderr and "--classes" in unnamed.stderr


@pytest.mark.parametrize(
    ("spoil", "expected"),
    [
        (lambda p: shutil.rmtree(p), ["predicted", "check its name"]),
        (lambda p: [file.unlink() for file in p.iterdir()], ["label images", "none"]),
        (lambda p: (p / "a.png").rename(p / "b.png"), ["a prediction of", "a.png"]),
        (lambda p: (p / "a.png").write_text("no picture"), ["a.png", "write the file again"]),
        (lambda p: save(p / "a.png", np.zeros((3, 3), np.uint8)), ["4×2", "3×3"]),
        (lambda p: save(p / "a.png", np.full((2, 4), 99, np.uint8)), ["99 at x 0, y 0", "--classes"]),
        (lambda p: save(p / "a.png", np.zeros((2, 4), np.uint16)), ["16 bits", "8-bit"]),
        (lambda p: save(p / "a.png", np.zeros((2, 4, 3), np.uint8)), ["Rgb", "instead of colours"]),
    ],
)
def test_wrong_predictions_are_named_with_a_remedy(tmp_path, spoil, expected):
    for side in ("predicted", "truth"):
        save(tmp_path / side / "a.png", np.ones((2, 4), np.uint8))
    spoil(tmp_path / "predicted")
    done = trove("evaluate", tmp_path / "predicted", tmp_path / "truth")
    assert done.returncode == 1 and "panicked" not in done.stderr, done.stderr
    assert all(part in done.stderr for part in expected), done.stderr


def photographs(folder, names, mean, deviation):
    """Noise of some brightness and contrast."""
    random = np.random.default_rng(len(names))
    for name in names:
        save(folder / name, random.normal(mean, deviation, (60, 80, 3)).clip(0, 255).astype(np.uint8))
    return folder


def test_recoloured_pictures_lie_under_the_same_paths_and_a_second_run_keeps_them(tmp_path):
    source = photographs(tmp_path / "s", ["k0/ego.A/rgb.png", "k1/ego.A/rgb.png"], 90, 12)
    target = photographs(tmp_path / "t", ["x.png", "y.jpg"], 150, 25)
    first = json.loads(trove("recolor", source, "--to", target, "--strength", 1, "--json").stdout)
    out = tmp_path / "s-recolored"
    assert Path(first["out"]) == out and (first["pictures"], first["kept"]) == (2, 0)
    assert sorted(path.relative_to(out).as_posix() for path in out.rglob("rgb.png")) == [
        "k0/ego.A/rgb.png",
        "k1/ego.A/rgb.png",
    ]
    assert first["after"]["mean"] == pytest.approx(first["target"]["mean"], abs=0.5)
    assert first["after"]["deviation"] == pytest.approx(first["target"]["deviation"], abs=0.5)
    assert Image.open(first["page"]).width > 800
    again = json.loads(trove("recolor", source, "--to", target, "--strength", 1, "--json").stdout)
    assert again | {"kept": 0} == first and again["kept"] == 2
    other = trove("recolor", source, "--to", target, "--strength", 0.5)
    assert other.returncode == 1 and "strength" in other.stderr and "another --out" in other.stderr


@pytest.mark.parametrize(
    ("args", "status", "expected"),
    [
        (["recolor", "empty", "--to", "t"], 1, ["empty", "PNG or JPEG images", "none"]),
        (["recolor", "none", "--to", "t"], 1, ["none", "check its name"]),
        (["recolor", "text", "--to", "t"], 1, ["a.png", "write the file again"]),
        (["recolor", "t", "--to", "t", "--out", "t/within"], 1, ["outside", "another --out"]),
        (["recolor", "t", "--to", "t", "--out", "text"], 1, ["other files", "another --out"]),
        (["recolor", "t", "--to", "t", "--method", "classes"], 2, ["--to-labels"]),
        (["recolor", "t", "--to", "t", "--method", "classes", "--to-labels", "t"], 1, ["class.png", "trove generate"]),
        (["recolor", "t", "--to", "t", "--strength", "2"], 2, ["from 0 to 1"]),
        (["curate", "empty"], 1, ["frames of trove generate", "none"]),
        (["curate", "text"], 1, ["frames of trove generate", "none"]),
        (["curate", "text/a.png"], 1, ["a.png", "check its path"]),
        (["evaluate", "t", "t", "--classes", "pascal"], 2, ["expected one of paper13", "FILE.toml"]),
        (["evaluate", "t", "t", "--classes", "none.toml"], 1, ["none.toml", "check the path"]),
    ],
)
def test_wrong_folders_are_named_with_a_remedy(tmp_path, args, status, expected):
    (tmp_path / "empty").mkdir()
    (tmp_path / "text").mkdir()
    (tmp_path / "text" / "a.png").write_text("no picture")
    photographs(tmp_path / "t", ["x.png"], 150, 25)
    done = trove(*args, cwd=tmp_path)
    assert done.returncode == status and "panicked" not in done.stderr, done.stderr
    assert all(part in done.stderr for part in expected), done.stderr


@pytest.fixture(scope="module")
def labels(recipe):
    """Labels alone of all frames, and what `trove curate` chose of them."""
    out = recipe.with_name("labels")
    done = trove("generate", recipe, "--labels-only", "--out", out)
    assert done.returncode == 0, done.stderr
    # At this size few classes cover enough of a picture; and both places are one.
    done = trove("curate", out, "--count", 3, "--min-classes", 2, "--val-share", 0, "--json")
    assert done.returncode == 0, done.stderr
    return out, json.loads(done.stdout)


def test_light_is_rendered_for_the_chosen_frames_alone(recipe, labels, tmp_path):
    folder, found = labels
    chosen = read_curated(Path(found["list"]))["train"]
    assert found["frames"] > found["kept"] == len(chosen) == 3
    out = tmp_path / "chosen"
    for new in (3, 0):
        done = trove("generate", recipe, "--out", out, "--frames", found["list"], "--json")
        assert done.returncode == 0, done.stderr
        assert (json.loads(done.stdout)["frames"], json.loads(done.stdout)["rendered"]) == (3, new)
    assert sorted(path.parent.relative_to(out).as_posix() for path in out.rglob("rgb.png")) == sorted(chosen)
    for frame in chosen:
        assert (out / frame / "class.png").read_bytes() == (folder / frame / "class.png").read_bytes()
        assert not (folder / frame / "rgb.png").exists()
    # Once light is there the same command takes the pictures' looks into account.
    assert trove("curate", out, "--count", 3, "--min-classes", 2).returncode == 0
    strange = tmp_path / "strange.json"
    strange.write_text(json.dumps({"train": ["scene-9999/v00/k000/ego.CAM_FRONT"], "val": []}))
    done = trove("generate", recipe, "--out", tmp_path / "none", "--frames", strange)
    assert done.returncode == 1 and "scene-9999" in done.stderr, done.stderr
