"""`trove export`: datasets that the tools of others open, and what they find in them."""

import json
import shutil
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import trove as library
from conftest import files, trove
from exports import exported
from PIL import Image, ImageDraw
from trove.format import read_frame


def frames(finished):
    """The frames' folders and tables, by their paths."""
    rows = json.loads((finished / "manifest.json").read_text())["frames"]
    return {row["path"]: (finished / row["path"], read_frame(finished / row["path"])) for row in rows}


def ordered(rows):
    """Rows of panoptic tables in the order of their images."""
    return sorted(rows, key=lambda row: row.get("image_id") or row["id"])


def picture(path):
    """A picture's values."""
    return np.array(Image.open(path))


@pytest.fixture(scope="module")
def cityscapes(finished, tmp_path_factory):
    """The finished run as Cityscapes."""
    return exported(finished, tmp_path_factory.mktemp("cityscapes") / "out", "cityscapes")[0]


def test_cityscapes_scripts_find_nothing_between_the_labels_and_themselves(cityscapes):
    pixels = pytest.importorskip("cityscapesscripts.evaluation.evalPixelLevelSemanticLabeling")
    pixels.args.evalInstLevelScore = pixels.args.JSONOutput = False
    pixels.args.quiet = True
    ids = [str(path) for path in sorted(cityscapes.glob("gtFine/train/*/*_labelIds.png"))]
    found = pixels.evaluateImgLists(ids, ids, pixels.args)
    assert ids and found["averageScoreClasses"] == 1 and found["averageScoreCategories"] == 1


def test_cityscapes_scripts_make_the_same_panoptic_files(cityscapes, tmp_path):
    theirs = pytest.importorskip("cityscapesscripts.preparation.createPanopticImgs")
    panoptic = pytest.importorskip("cityscapesscripts.evaluation.evalPanopticSemanticLabeling")
    for by_train_id, ending in [(False, ""), (True, "_trainId")]:
        theirs.convert2panoptic(str(cityscapes / "gtFine"), str(tmp_path), by_train_id, ["train"])
        name = f"cityscapes_panoptic_train{ending}"
        ours, expected = (json.loads((root / f"{name}.json").read_text()) for root in (cityscapes / "gtFine", tmp_path))
        for table in ("images", "annotations"):
            assert ordered(ours[table]) == ordered(expected[table])
        assert ours["categories"] == [row | {"color": list(row["color"])} for row in expected["categories"]]
        for path in (tmp_path / name).glob("*.png"):
            assert (picture(path) == picture(cityscapes / "gtFine" / name / path.name)).all()
    folder = cityscapes / "gtFine/cityscapes_panoptic_train"
    rows = json.loads(folder.with_suffix(".json").read_text())
    categories = {row["id"]: row for row in rows["categories"]}
    pairs = [(row, row) for row in rows["annotations"]]
    found = panoptic.average_pq(
        panoptic.pq_compute_single_core(0, pairs, str(folder), str(folder), categories), categories
    )
    assert found["All"]["pq"] == 1 and found["Things"]["n"] > 0


def test_cityscapes_scripts_rate_the_objects_against_themselves_as_perfect(cityscapes, tmp_path, monkeypatch):
    theirs = pytest.importorskip("cityscapesscripts.evaluation.evalInstanceLevelSemanticLabeling")
    truths = sorted(str(path) for path in cityscapes.glob("gtFine/train/*/*_instanceIds.png"))
    predictions = []
    for truth in truths:
        objects, lines = picture(truth), []
        for number in np.unique(objects[objects >= 1000]):
            mask = tmp_path / f"{len(predictions)}_{number}.png"
            Image.fromarray(np.where(objects == number, 255, 0).astype(np.uint8)).save(mask)
            lines.append(f"{mask.name} {number // 1000} 1.0")
        predictions.append(tmp_path / f"{len(predictions)}.txt")
        predictions[-1].write_text("\n".join(lines))
    monkeypatch.setattr(np, "in1d", np.isin, raising=False)  # NumPy has taken the name away since
    monkeypatch.setattr(theirs, "writeDict2JSON", lambda *_: None)  # it cannot write NumPy's numbers
    theirs.args.predictionPath = str(tmp_path)
    theirs.args.gtInstancesFile = str(tmp_path / "truth.json")
    theirs.args.JSONOutput = False
    theirs.args.quiet = True
    theirs.args.minRegionSizes = np.array([1, 1, 1])
    theirs.setInstanceLabels(theirs.args)
    found = theirs.evaluateImgLists([str(path) for path in predictions], truths, theirs.args)["averages"]
    aps = [row["ap"] for row in found["classes"].values() if not np.isnan(row["ap"])]
    assert aps and aps == pytest.approx([1.0] * len(aps))


def test_polygons_give_the_labels_back(cityscapes):
    annotation = pytest.importorskip("cityscapesscripts.helpers.annotation")
    drawing = pytest.importorskip("cityscapesscripts.preparation.json2labelImg")
    for path in cityscapes.glob("gtFine/train/*/*_polygons.json"):
        found = annotation.Annotation()
        found.fromJsonFile(str(path))
        drawn = np.array(drawing.createLabelImage(found, "ids"))
        same = drawn == picture(str(path).replace("_polygons.json", "_labelIds.png"))
        assert same.mean() > 0.97, f"{path.name}: {same.mean()}"


def test_cityscapes_boxes_are_where_the_objects_are(cityscapes):
    annotation = pytest.importorskip("cityscapesscripts.helpers.annotation")
    transform = pytest.importorskip("cityscapesscripts.helpers.box3dImageTransform")
    seen = 0
    for path in cityscapes.glob("gtBbox3d/train/*/*_gtBbox3d.json"):
        found = annotation.Annotation(annotation.CsObjectType.BBOX3D)
        found.fromJsonFile(str(path))
        for box in found.objects:
            projected = transform.Box3dImageTransform(found.camera)
            projected.initialize_box_from_annotation(box, coordinate_system=transform.CRS_V)
            corners = np.array(list(projected.get_vertices_2d().values()))
            x, y, width, height = box.bbox_2d.bbox_amodal_xywh
            inside = x > 0 and y > 0 and x + width < found.imgWidth and y + height < found.imgHeight
            if inside and box.center[0] > 5:
                # A model fills its box up to a little.
                assert np.abs(corners.min(0) - (x, y)).max() < 3 + 0.15 * max(width, height)
                assert np.abs(corners.max(0) - (x + width, y + height)).max() < 3 + 0.15 * max(width, height)
                seen += 1
    assert seen > 5


def test_pycocotools_finds_our_masks_and_rates_them_as_perfect(finished, tmp_path):
    coco = pytest.importorskip("pycocotools.coco")
    evaluation = pytest.importorskip("pycocotools.cocoeval")
    out, _ = exported(finished, tmp_path / "out", "coco")
    truth = coco.COCO(str(out / "annotations/instances_train.json"))
    tables = frames(finished)
    assert len(truth.imgs) == len(tables)
    for image in truth.imgs.values():
        folder, table = tables[image["trove_path"]]
        assert (picture(out / "train" / image["file_name"]) == picture(folder / "rgb.png")).all()
        instance = picture(folder / "instance.png")
        objects = {row["id"]: row for row in table["objects"]}
        for annotation in truth.loadAnns(truth.getAnnIds(image["id"])):
            mask = truth.annToMask(annotation).astype(bool)
            assert (mask == (instance == annotation["track_id"])).all()
            assert annotation["area"] == mask.sum() == objects[annotation["track_id"]]["visible_px"]
            ys, xs = np.nonzero(mask)
            assert annotation["bbox"] == [xs.min(), ys.min(), np.ptp(xs) + 1, np.ptp(ys) + 1]
    perfect = truth.loadRes([row | {"score": 1.0} for row in truth.anns.values()])
    for kind in ("bbox", "segm"):
        judge = evaluation.COCOeval(truth, perfect, kind)
        judge.evaluate(), judge.accumulate(), judge.summarize()
        assert judge.stats[0] == pytest.approx(1.0)


def test_pycocotools_finds_the_points_of_people_where_they_are_seen(finished, tmp_path):
    coco = pytest.importorskip("pycocotools.coco")
    evaluation = pytest.importorskip("pycocotools.cocoeval")
    out, _ = exported(finished, tmp_path / "out", "coco")
    truth = coco.COCO(str(out / "annotations/person_keypoints_train.json"))
    assert truth.cats[1]["keypoints"][0] == "nose" and len(truth.cats[1]["keypoints"]) == 17
    tables = frames(finished)
    shown, on_them = 0, 0
    for annotation in truth.anns.values():
        folder, table = tables[truth.imgs[annotation["image_id"]]["trove_path"]]
        instance = picture(folder / "instance.png")
        row = next(row for row in table["objects"] if row["id"] == annotation["track_id"])
        points = np.array(annotation["keypoints"]).reshape(17, 3)
        assert annotation["num_keypoints"] == (points[:, 2] > 0).sum()
        # Hidden or not, a point is where the camera of the frame sees its place in World.
        world = np.c_[row["keypoints_world_m"], np.ones(17)]
        camera = (np.linalg.inv(table["world_from_camera"]) @ world.T)[:3]
        expected = (np.array(table["intrinsics"]) @ camera / camera[2])[:2].T
        inside = points[:, 2] > 0
        assert np.abs(points[inside, :2] - expected[inside]).max(initial=0) < 0.01
        # Left is the person's left, and heads are above hips.
        body = (np.linalg.inv(row["world_from_body"]) @ world.T)[:3].T
        assert body[5, 1] > body[6, 1] and body[11, 1] > body[12, 1]
        assert body[0, 2] > body[[11, 12], 2].max()
        for column, line, visibility in points:
            # Who is a few pixels high may be seen between the pixels' middles alone, and an arm beside the middle of its own.
            if visibility == 2 and annotation["area"] >= 10:
                shown += 1
                x, y = int(column), int(line)
                on_them += (instance[max(0, y - 1) : y + 2, max(0, x - 1) : x + 2] == row["id"]).any()
    assert shown > 30 and on_them > 0.98 * shown
    perfect = truth.loadRes([row | {"score": 1.0} for row in truth.anns.values()])
    judge = evaluation.COCOeval(truth, perfect, "keypoints")
    judge.evaluate(), judge.accumulate(), judge.summarize()
    assert judge.stats[0] == pytest.approx(1.0)


def test_a_panoptic_picture_and_its_segments_say_the_same(finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "coco-panoptic")
    rows = json.loads((out / "annotations/panoptic_train.json").read_text())
    images = {row["id"]: row for row in rows["images"]}
    categories = {row["id"]: row for row in rows["categories"]}
    for row in rows["annotations"]:
        colors = picture(out / "annotations/panoptic_train" / row["file_name"]).astype(int)
        ids = colors @ (1, 256, 256**2)
        segments = {segment["id"]: segment for segment in row["segments_info"]}
        assert set(np.unique(ids)) - {0} == set(segments)
        for number, segment in segments.items():
            ys, xs = np.nonzero(ids == number)
            assert segment["area"] == len(xs)
            assert segment["bbox"] == [xs.min(), ys.min(), np.ptp(xs) + 1, np.ptp(ys) + 1]
            assert categories[segment["category_id"]]["isthing"] or number == segment["category_id"]
        assert images[row["image_id"]]["file_name"] == row["file_name"]


def test_kitti_s_boxes_are_where_the_objects_are(finished, tmp_path):
    out, printed = exported(finished, tmp_path / "out", "kitti")
    tables, numbers = frames(finished), (out / "ImageSets/train.txt").read_text().split()
    assert printed["frames"] == {"train": len(tables)} and len(numbers) == len(tables)
    seen = 0
    for number in numbers:
        calibration = dict(
            line.split(":", 1) for line in (out / f"training/calib/{number}.txt").read_text().splitlines()
        )
        projection = np.array(calibration["P2"].split(), float).reshape(3, 4)
        height, width = picture(out / f"training/image_2/{number}.png").shape[:2]
        for line in (out / f"training/label_2/{number}.txt").read_text().splitlines():
            kind, *values = line.split()
            values = np.array(values, float)
            assert kind in {"Car", "Van", "Truck", "Pedestrian", "Person_sitting", "Cyclist", "Tram", "Misc"}
            truncated, occluded, alpha, left, top, right, bottom, h, w, length, x, y, z, rotation = values
            assert 0 <= truncated <= 1 and occluded in (0, 1, 2) and abs(alpha) <= np.pi + 0.01
            assert np.cos(alpha - rotation + np.arctan2(x, z)) == pytest.approx(1, abs=1e-3)
            # The devkit's own way from a line to corners.
            c, s = np.cos(rotation), np.sin(rotation)
            turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
            corners = np.array([(i * length / 2, j * h, k * w / 2) for i in (1, -1) for j in (0, -1) for k in (1, -1)])
            corners = corners @ turn.T + (x, y, z)
            if corners[:, 2].min() < 1 or left <= 0 or top <= 0 or right >= width - 1 or bottom >= height - 1:
                continue
            u, v, depth = projection @ np.c_[corners, np.ones(8)].T
            low, high = (u / depth).min(), (u / depth).max()
            slack = 3 + 0.15 * max(right - left, bottom - top)
            assert abs(low - left) < slack and abs(high - right - 1) < slack, line
            assert abs((v / depth).max() - bottom - 1) < slack, line
            seen += 1
    assert seen > 5


def test_kitti_tracking_keeps_an_object_s_number(finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "kitti-tracking")
    sequences = [line.split() for line in (out / "evaluate_tracking.seqmap.train").read_text().splitlines()]
    assert len(sequences) == len({(table["view"]) for _, table in frames(finished).values()})
    repeated = 0
    for name, _, _, last in sequences:
        rows = [line.split() for line in (out / f"training/label_02/{name}.txt").read_text().splitlines()]
        assert {int(row[0]) for row in rows} <= set(range(int(last)))
        kinds = {}
        for row in rows:
            repeated += kinds.setdefault(row[1], row[2]) == row[2] and int(row[0]) > 0
            assert kinds[row[1]] == row[2] and len(row) == 17
        assert len(list((out / f"training/image_02/{name}").iterdir())) == int(last)
    assert repeated > 3


def test_kitti_step_and_our_labels_are_judged_as_equal(finished, tmp_path):
    out, _ = exported(finished, tmp_path / "out", "kitti-step")
    maps = out / "panoptic_maps/train"
    done = trove("evaluate", maps, maps, "--panoptic", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["miou"] == found["pq"] == 1 and found["pictures"] == len(frames(finished))


def test_flow_and_depth_come_back_from_kitti_s_numbers(finished, tmp_path):
    exr, png = pytest.importorskip("OpenEXR"), pytest.importorskip("png")
    values = lambda path: exr.File(str(path)).channels()  # noqa: E731
    tables = {(t["view"], t["keyframe"]): folder for folder, t in frames(finished).values()}
    out, printed = exported(finished, tmp_path / "flow", "kitti-flow")
    pairs = sorted((out / "training/flow_occ").iterdir())
    assert pairs and printed["clipped"]["frames without a next one, to which flow would lead"] == len(tables) // 2
    first = sorted(view for view, keyframe in tables if keyframe == 1)
    for view, path in zip(first, pairs, strict=True):
        width, height, rows, _ = png.Reader(str(path)).read()
        v16 = np.array([list(row) for row in rows], float).reshape(height, width, 3)
        channels = values(tables[view, 1] / "flow_forward.exr")
        flow = np.stack([channels["R"].pixels, channels["G"].pixels], -1)
        valid = v16[..., 2] == 1
        assert (valid == (~np.isnan(flow).any(-1) & (np.abs(flow) < 512).all(-1))).all()
        assert np.abs((v16[..., :2] - 2**15) / 64 - flow)[valid].max() <= 1 / 128 + 1e-6
        rows = png.Reader(str(out / "training/flow_noc" / path.name)).read()[2]
        seen = np.array([list(row) for row in rows]).reshape(height, width, 3)
        occluded = picture(tables[view, 1] / "occluded_forward.png")
        assert (seen == np.where((occluded == 0)[..., None], v16, 0)).all()
    out, _ = exported(finished, tmp_path / "depth", "kitti-depth")
    depths = sorted(out.glob("train/*/proj_depth/groundtruth/image_02/*.png"))
    assert len(depths) == len(tables)
    for (_, folder), path in zip(sorted(tables.items()), depths, strict=True):
        steps, depth = picture(path).astype(float), values(folder / "depth.exr")["Y"].pixels
        near = np.isfinite(depth) & (depth < 255.9)
        assert ((steps > 0) == near).mean() > 0.999
        assert np.abs(steps / 256 - depth)[near].max() <= 1 / 512 + 1e-4


def test_mmsegmentation_and_the_paper_s_pictures_hold_what_class_png_says(finished, tmp_path):
    classes = {row["id"]: row for row in json.loads((finished / "manifest.json").read_text())["classes"]}
    tables = frames(finished)
    out, _ = exported(finished, tmp_path / "paper", "paper13")
    of_13 = np.array([classes[i]["class13"] for i in range(20)])
    for folder, t in tables.values():
        name = f"{t['scene']}_v{t['variation']:02}_k{t['keyframe']:03}_{t['view']}.png"
        assert (picture(out / "labels/train" / name) == of_13[picture(folder / "class.png")]).all()
    mmseg, _ = exported(finished, tmp_path / "mmseg", "mmseg")
    known = json.loads((mmseg / "metainfo.json").read_text())
    assert known["classes"][0] == "road" and len(known["classes"]) == len(known["palette"]) == 19
    # mmseg's BaseSegDataset pairs files by their names.
    pictures, labels = ({p.name for p in (mmseg / side / "train").iterdir()} for side in ("img_dir", "ann_dir"))
    assert pictures == labels and len(labels) == len(tables)
    for folder, t in tables.values():
        name = f"{t['scene']}_v{t['variation']:02}_k{t['keyframe']:03}_{t['view']}.png"
        road = picture(mmseg / "ann_dir/train" / name) == 0
        assert (road == (picture(folder / "class.png") == 9)).all()


def test_yolo_s_lines_are_the_boxes_and_outlines_of_the_masks(finished, tmp_path):
    boxes, _ = exported(finished, tmp_path / "boxes", "yolo")
    outlines, _ = exported(finished, tmp_path / "outlines", "yolo-seg")
    names = [
        line.split(": ")[1].strip('"') for line in (boxes / "data.yaml").read_text().splitlines() if line[:1] == " "
    ]
    assert names[:3] == ["person", "rider", "car"]
    shares = []
    for folder, t in frames(finished).values():
        name = f"labels/train/{t['scene']}_v{t['variation']:02}_k{t['keyframe']:03}_{t['view']}.txt"
        lines, polygons = ((root / name).read_text().splitlines() for root in (boxes, outlines))
        assert len(lines) == len(polygons)
        instance = picture(folder / "instance.png")
        height, width = instance.shape
        by_box = {tuple(row["visible_box"]): row["id"] for row in t["objects"] if row["visible_px"]}
        for line, polygon in zip(lines, polygons, strict=True):
            number, x, y, w, h = map(float, line.split())
            x0, y0 = (x - w / 2) * width, (y - h / 2) * height
            box = np.round((x0, y0, x0 + w * width - 1, y0 + h * height - 1)).astype(int)
            corners = np.array(polygon.split()[1:], float).reshape(-1, 2) * (width, height)
            assert polygon.split()[0] == str(int(number)) and int(number) < len(names)
            if len(corners) > 2 and tuple(box) in by_box:
                drawn = Image.new("L", (width, height))
                ImageDraw.Draw(drawn).polygon([tuple(c - 0.5) for c in corners], fill=1, outline=1)
                mask = instance == by_box[tuple(box)]
                shares.append(((mask & (np.array(drawn) > 0)).sum(), (mask | (np.array(drawn) > 0)).sum()))
    both, either = np.sum(shares, 0)
    # What is missing are holes, small parts, and the lines between parts.
    assert len(shares) > 10 and both / either > 0.9


def test_an_export_goes_on_where_it_was_killed_and_gives_the_same(finished, tmp_path):
    whole, _ = exported(finished, tmp_path / "whole", "cityscapes")
    for moment in (0.05, 0.15, 0.3):
        out = tmp_path / f"killed{moment}"
        command = [sys.executable, "-m", "trove", "export", finished, "--format", "cityscapes", "--out", out]
        process = subprocess.Popen(list(map(str, command)), stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        time.sleep(moment)
        process.send_signal(signal.SIGKILL)
        process.wait()
        exported(finished, out, "cityscapes")
        assert files(out) == files(whole)


def test_equal_bytes_are_linked_and_the_source_stays_as_it_was(finished, tmp_path):
    before = files(finished)
    out, _ = exported(finished, tmp_path / "out", "kitti")
    rgb = next(finished.rglob("rgb.png"))
    assert rgb.stat().st_nlink > 1
    exported(finished, out, "kitti")
    assert files(finished) == before


def test_splits_come_from_a_list_and_never_part_a_moment(finished, tmp_path):
    rows = list(frames(finished).items())
    by_keyframe = {k: [path for path, (_, t) in rows if t["keyframe"] == k] for k in (1, 2)}
    lists = tmp_path / "split.json"
    lists.write_text(json.dumps({"train": by_keyframe[1], "val": by_keyframe[2][:2]}))
    out, printed = exported(finished, tmp_path / "out", "coco", "--split", lists)
    assert printed["frames"] == {"train": len(by_keyframe[1]), "val": 2}
    assert len(json.loads((out / "annotations/instances_val.json").read_text())["images"]) == 2
    lists.write_text(json.dumps({"train": by_keyframe[1][:1], "val": by_keyframe[1][1:]}))
    done = trove("export", finished, "--format", "coco", "--out", tmp_path / "parted", "--split", lists)
    assert done.returncode == 1 and "all views of one moment in one split" in done.stderr
    lists.write_text(json.dumps({"train": ["no/such/frame"], "val": []}))
    done = trove("export", finished, "--format", "coco", "--out", tmp_path / "unknown", "--split", lists)
    assert done.returncode == 1 and "no/such/frame" in done.stderr


def test_what_cannot_be_exported_is_told_with_a_remedy(finished, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/notes.txt").write_text("mine")
    (tmp_path / "empty").mkdir()
    for source, out, more, expected in [
        (tmp_path / "empty", "a", [], "run trove generate"),
        (finished, "mine", [], "choose another --out"),
        (finished, "b", ["--classes", "citiscapes"], "cityscapes"),
    ]:
        done = trove("export", source, "--format", "coco", "--out", tmp_path / out, *more)
        assert done.returncode in (1, 2) and expected in done.stderr, done.stderr
    exported(finished, tmp_path / "coco", "coco")
    done = trove("export", finished, "--format", "kitti", "--out", tmp_path / "coco")
    assert done.returncode == 1 and "choose another --out" in done.stderr
    done = trove("export", finished, "--format", "kitti", "--out", tmp_path / "c", "--classes", "coco")
    assert done.returncode == 1 and "--classes" in done.stderr
    # A frame without a file that the form needs.
    broken = tmp_path / "broken"
    shutil.copytree(finished, broken)
    next(broken.rglob("instance.png")).unlink()
    done = trove("export", broken, "--format", "coco", "--out", tmp_path / "d")
    assert done.returncode == 1 and "instance.png" in done.stderr


def test_a_film_shows_the_frames(finished, tmp_path, monkeypatch):
    program = shutil.which("ffmpeg")
    if program is None:
        program = pytest.importorskip("imageio_ffmpeg").get_ffmpeg_exe()
    monkeypatch.setenv("TROVE_FFMPEG", str(program))
    out, _ = exported(finished, tmp_path / "out", "video")
    films = sorted(out.glob("train/*.mp4"))
    assert len(films) == len({t["view"] for _, t in frames(finished).values()})
    decode = [program, "-loglevel", "error", "-i", films[0], "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    raw = subprocess.run(list(map(str, decode)), capture_output=True, check=True).stdout
    shown = sorted((t["view"], t["keyframe"], folder) for folder, t in frames(finished).values())
    expected = [picture(folder / "rgb.png") for view, _, folder in shown if view in films[0].name]
    height, width = (side // 2 * 2 for side in expected[0].shape[:2])
    found = np.frombuffer(raw, np.uint8).reshape(-1, height, width, 3).astype(float)
    assert len(found) == len(expected) == 2
    for seen, true in zip(found, expected, strict=True):
        assert np.abs(seen - true[:height, :width]).mean() < 8
    monkeypatch.setenv("TROVE_FFMPEG", "no-such-program")
    done = trove("export", finished, "--format", "video", "--out", tmp_path / "none")
    assert done.returncode == 1 and "install ffmpeg" in done.stderr


def test_disparity_leads_to_the_same_thing_in_the_right_eye(recipe, tmp_path):
    pair = recipe.parent / "pair.toml"
    text = recipe.read_text().replace('rig = ["CAM_FRONT", "CAM_BACK"]\nother_vehicles = 1', 'rig = "stereo"')
    pair.write_text(text.replace("keyframes = [1, 2]", "keyframes = [1]"))
    done = trove("generate", pair, "--out", tmp_path / "run")
    assert done.returncode == 0, done.stderr
    out, _ = exported(tmp_path / "run", tmp_path / "out", "cityscapes")
    (path,) = out.glob("disparity/train/*/*_disparity.png")
    steps = picture(path).astype(float)
    camera = json.loads(next((out / "camera").rglob(path.name.replace("disparity.png", "camera.json"))).read_text())
    eyes = sorted(
        (table["world_from_camera_translation_m"], folder) for folder, table in frames(tmp_path / "run").values()
    )
    assert camera["extrinsic"]["baseline"] == pytest.approx(
        np.linalg.norm(np.subtract(eyes[0][0], eyes[1][0])), abs=1e-6
    )
    name = path.name.replace("disparity.png", "rightImg8bit.png")
    right = picture(next((out / "rightImg8bit").rglob(name)))
    left = picture(next((out / "leftImg8bit").rglob(name.replace("right", "left"))))
    folders = {tuple(picture(folder / "rgb.png").ravel()[:999]): folder for _, folder in eyes}
    ids = [picture(folders[tuple(eye.ravel()[:999])] / "class.png") for eye in (left, right)]
    rows, columns = np.nonzero(steps)
    moved = np.round(columns - (steps[rows, columns] - 1) / 256).astype(int)
    seen = moved >= 0
    same = ids[0][rows, columns][seen] == ids[1][rows[seen], moved[seen]]
    assert (steps > 0).mean() > 0.3 and same.mean() > 0.95


def test_a_recipe_names_what_a_run_is_exported_as(recipe, finished, tmp_path):
    text = recipe.read_text()
    named = recipe.parent / "named.toml"
    named.write_text(text + '[output]\nformats = ["coco", "kitti-step"]\n')
    # The finished run goes on: formats do not make it another one.
    run = tmp_path / "run"
    shutil.copytree(finished, run)
    done = trove("generate", named, "--out", run, "--json")
    assert done.returncode == 0 and '"rendered": 0' in done.stdout, done.stderr
    expected = files(exported(finished, tmp_path / "coco", "coco")[0])
    assert files(run / "exports/coco") == expected
    assert (run / "exports/kitti-step/panoptic_maps").is_dir()
    assert trove("verify", run).returncode == 0
    # The manifest holds the recipe.
    others = {name for name, data in files(finished).items() if files(run)[name] != data}
    assert others == {"manifest.json"}
    named.write_text(text + '[output]\nformats = ["cocoo"]\n')
    done = trove("generate", named, "--out", run)
    assert done.returncode == 1 and "did you mean `coco`?" in done.stderr


@pytest.fixture(scope="module")
def parted(recipe, tmp_path_factory):
    """The quick recipe with parts of objects, larger, so that riders have pixels."""
    path = recipe.with_name("parted.toml")
    path.write_text(
        recipe.read_text().replace("scale = 0.1", "scale = 0.3").replace("spp = 4", "spp = 1")
        + '[output]\nfiles = ["rgb", "class", "instance", "part", "masks"]\n'
    )
    out = tmp_path_factory.mktemp("parted") / "out"
    assert trove("generate", path, "--out", out).returncode == 0
    done = trove("verify", out, "--labels")
    assert done.returncode == 0, done.stdout
    return out


def test_riders_are_apart_from_what_they_ride_where_frames_tell_parts(parted, tmp_path):
    coco = pytest.importorskip("pycocotools.coco")
    parts = {row["name"]: row["id"] for row in json.loads((parted / "manifest.json").read_text())["parts"]}
    truth = coco.COCO(str(exported(parted, tmp_path / "coco", "coco")[0] / "annotations/instances_train.json"))
    points = coco.COCO(str(tmp_path / "coco/annotations/person_keypoints_train.json"))
    cityscapes, _ = exported(parted, tmp_path / "cityscapes", "cityscapes")
    tables, riders = frames(parted), 0
    for image in truth.imgs.values():
        folder, table = tables[image["trove_path"]]
        instance, part = picture(folder / "instance.png"), picture(folder / "part.png")
        rows = truth.loadAnns(truth.getAnnIds(image["id"]))
        for row in table["objects"]:
            rider = {"bicycle_with_rider": "cyclist", "motorcycle_with_rider": "motorcyclist"}.get(row["kind"])
            if rider is None or not (instance == row["id"]).any():
                continue
            riders += 1
            person = (instance == row["id"]) & (part == parts[rider])
            masks = {truth.cats[a["category_id"]]["name"]: a for a in rows if a["track_id"] == row["id"]}
            cycle = row["kind"].split("_")[0]
            for name, pixels in [("person", person), (cycle, (instance == row["id"]) & ~person)]:
                assert (name in masks) == pixels.any()
                assert not pixels.any() or (truth.annToMask(masks[name]).astype(bool) == pixels).all()
            # Both have points and whole outlines of one person alone.
            assert sum(a["track_id"] == row["id"] for a in points.loadAnns(points.getAnnIds(image["id"]))) == 1
            assert all(("a_segm" in mask) == (len(masks) == 1) for mask in masks.values())
    assert riders > 1
    # Whoever reads frames in Python sees what the export has, where a rider is 25 and a bicycle 33.
    seen = set()
    for frame in library.open(parted):
        labels = frame.labels("cityscapes")
        paths = [path for path in cityscapes.rglob("*_labelIds.png") if (picture(path) == labels).all()]
        assert len(paths) == 1
        ids, numbers = labels, picture(str(paths[0]).replace("labelIds", "instanceIds"))
        assert (numbers[ids == 25] // 1000 == 25).all() and (numbers[ids == 33] // 1000 == 33).all()
        seen |= set(np.unique(ids)) & {25, 32, 33}
        with pytest.raises(library.TroveError, match=r"expected one of .*cityscapes"):
            frame.labels("cityscape")
    assert {25, 33} <= seen
