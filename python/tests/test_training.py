"""`python -m trove.train`: what goes in, what comes out, and a small run on generated frames."""

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import trove
from PIL import Image
from trove.train import labels, table
from trove.train.confusion import iou
from trove.train.data import Pictures, Sample, mixed_batches
from trove.train.experiment import ExperimentError, Trial, read

EXPERIMENT = """
classes = "camvid"
size = [64, 36]
rows = ["S", "S+R[F]", "S+C+R[M]"]
[sets.S]
format = "native"
root = "{root}"
[sets.C]
format = "native"
root = "{root}"
pictures = "{root}"
[sets.R]
of = "S"
count = 2
[val]
format = "native"
root = "{root}"
[training]
epochs = 1
batch = 2
seeds = [1]
"""


@pytest.fixture
def experiment(finished, tmp_path):
    path = tmp_path / "experiment.toml"
    path.write_text(EXPERIMENT.format(root=finished))
    return path


def test_every_class_of_ours_has_a_place_or_is_left_out_on_purpose():
    paper, camvid = labels.lookup("native", "paper"), labels.lookup("native", "camvid")
    left_out = {
        name: [i for i in range(20) if labels.lookup("native", name)[i] == labels.IGNORED] for name in labels.TARGETS
    }
    assert left_out == {"paper": [0, 10], "camvid": [0, 16, 17], "idd-lite": [0, 12, 16]}
    assert labels.CAMVID[camvid[18]] == "pole" and labels.PAPER[paper[13]] == "truck"
    with pytest.raises(ValueError, match="numbered as camvid"):
        labels.lookup("camvid", "paper")


def test_signs_and_poles_of_camvid_are_one_class():
    table = labels.lookup("camvid", "camvid")
    assert table[2] == table[6] and table[11] == labels.IGNORED and len(labels.CAMVID) == 10


def test_a_row_is_trained_in_the_stages_of_its_name(experiment):
    found = read(experiment)
    assert found.stages("S+R[F]") == [["S"], ["R"]]
    assert found.stages("S+C+R[M]") == [["C", "R"]]
    assert found.stages("R") == [["R"]]


def test_rows_that_begin_alike_are_trained_in_turn(experiment):
    rows = ["R", "S", "S+R[F]", "S+R[M]", "S+C", "S+C+R[F]"]
    assert read(experiment).alike(rows) == [["R"], ["S", "S+R[F]"], ["S+R[M]"], ["S+C", "S+C+R[F]"]]


def test_other_data_or_settings_have_another_folder(experiment, tmp_path, monkeypatch):
    before = read(experiment).folders("S+R[F]", tmp_path)
    monkeypatch.chdir(experiment.parent)
    assert before == read(Path(experiment.name)).folders("S+R[F]", tmp_path)
    assert before[0] == read(experiment).folders("S", tmp_path)[0]
    assert before[0] != read(experiment, Trial(seed=2)).folders("S", tmp_path)[0]
    experiment.write_text(experiment.read_text().replace("count = 2", "count = 1"))
    after = read(experiment).folders("S+R[F]", tmp_path)
    assert after[0] == before[0] and after[1] != before[1]
    experiment.write_text(experiment.read_text().replace("epochs = 1", "epochs = 2"))
    assert read(experiment).folders("S", tmp_path)[0] != before[0]
    # The set whose labels are as rendered, and what is measured on.
    drawn = [read(experiment).folders(row, tmp_path)[0] for row in ("S", "S+C")]
    experiment.write_text(experiment.read_text().replace("pictures =", "drawn = false\npictures ="))
    rendered = [read(experiment).folders(row, tmp_path)[0] for row in ("S", "S+C")]
    assert rendered[0] == drawn[0] and rendered[1] != drawn[1]
    # Where there is one set alone nothing is normalised otherwise.
    rows = ("S", "S+C+R[M]")
    together = [read(experiment).folders(row, tmp_path)[0] for row in rows]
    experiment.write_text(experiment.read_text().replace("batch = 2", "batch = 2\nnorm_by_set = true"))
    apart = [read(experiment).folders(row, tmp_path)[0] for row in rows]
    assert apart[0] == together[0] and apart[1] != together[1]


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("epochs", "epoch"), "training.epoch is not known"),
        (('"S+R[F]"', '"S+X"'), "rows: S+X asks for the set X"),
        (('classes = "camvid"', 'classes = "coco"'), "classes: expected one of"),
        (('format = "native"', 'format = "kitti"'), "format: expected one of"),
        (('of = "S"', 'of = "T"'), "sets.R.of"),
        (("[val]", "[test]"), "test is not known"),
        (("count = 2", "drawn = true"), "sets.R.drawn is not known"),
        (
            ("epochs = 1", 'epochs = 1\nmodel = "ssdlite"\nnorm_by_set = true'),
            "training.norm_by_set: expected a network",
        ),
        (("epochs = 1", "total = [2, 4]"), "training.total: a ladder needs averaged = true"),
    ],
)
def test_a_wrong_experiment_names_the_place(experiment, change, expected):
    experiment.write_text(experiment.read_text().replace(*change))
    with pytest.raises(ExperimentError, match=re.escape(expected)) as caught:
        read(experiment)
    assert str(experiment) in str(caught.value)


def test_cuts_keep_picture_and_labels_together(tmp_path):
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train.stock import MIDDLE, Stock, random_cuts

    # Every pixel tells where it is, in the image as in the labels; the second image is wider.
    sets = []
    for name, (width, height) in {"a": (80, 60), "b": (100, 60)}.items():
        x, y = np.meshgrid(np.arange(width), np.arange(height))
        Image.fromarray(np.stack([2 * x, 4 * y, 0 * x], 2).astype(np.uint8)).save(tmp_path / f"{name}.png")
        Image.fromarray((x // 10).astype(np.uint8)).save(tmp_path / f"{name}-ids.png")
        sample = Sample(tmp_path / f"{name}.png", tmp_path / f"{name}-ids.png")
        sets.append(Pictures([sample], "camvid", "camvid", (80, 60)))
    stock, chosen = Stock(sets, torch.device("cpu")), torch.tensor([0, 1])
    rgb, ids = stock.cut(chosen, torch.tensor([MIDDLE, MIDDLE]), (80, 60))
    table = labels.lookup("camvid", "camvid").astype(int)
    assert torch.equal((rgb[0, 0] * 255).round().int(), (2 * torch.arange(80)).int().expand(60, 80))
    assert (ids[1] == torch.from_numpy(table[(np.arange(80) + 10) // 10])).all()
    cuts = torch.from_numpy(random_cuts(1, 2, 5, 1.4, True)[0])
    assert torch.equal(stock.cut(chosen, cuts, (64, 48))[0], stock.cut(chosen, cuts, (64, 48))[0])
    for mirrored in (0.0, 1.0):
        cuts[:, 3] = mirrored
        rgb, ids = stock.cut(chosen, cuts, (64, 48))
        at = rgb[:, 0] * 255 / 2
        away = (at + 0.5) % 10
        told = torch.from_numpy(table)[((at + 0.5) // 10).long()]
        assert ((ids == told) | (away < 1) | (away > 9)).all() and rgb.shape == (2, 3, 48, 64)
        assert (at[:, 0, -1] > at[:, 0, 0]).all() == (mirrored == 0.0)
        # As much of the image as the zoom leaves.
        spans = (at[:, 0, -1] - at[:, 0, 0]).abs() * 64 / 63
        assert torch.allclose(spans, 80 / cuts[:, 0], atol=1.1)


def test_images_that_do_not_fit_are_read_where_they_are_needed(experiment, monkeypatch):
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train.stock import MIDDLE, Stock

    pool, device = read(experiment).pools["S"], torch.device("cpu")
    sets = [Pictures(pool.samples, pool.numbering, "camvid", (64, 36))]
    whole = Stock(sets, device)
    monkeypatch.setattr(Pictures, "KEPT_BYTES", 0)
    parts = Stock(sets, device)
    assert whole.resident and not parts.resident
    chosen, cuts = torch.tensor([2, 0]), torch.tensor([MIDDLE, MIDDLE])
    for a, b in zip(whole.cut(chosen, cuts, (64, 36)), parts.cut(chosen, cuts, (64, 36))):
        assert torch.equal(a, b)
    assert torch.equal(whole.weights([len(pool.samples)], 10), parts.weights([len(pool.samples)], 10))


def test_rare_classes_weigh_more_and_sets_count_alike(tmp_path):
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train.stock import Stock

    def alone(name, ids):
        Image.new("RGB", ids.shape[::-1]).save(tmp_path / f"{name}.png")
        Image.fromarray(ids).save(tmp_path / f"{name}-ids.png")
        return Pictures([Sample(tmp_path / f"{name}.png", tmp_path / f"{name}-ids.png")], "camvid", "camvid", (8, 6))

    sky, house = np.zeros((6, 8), np.uint8), np.ones((12, 16), np.uint8)
    house[0] = 11  # unlabelled
    found = Stock([alone("a", sky), alone("b", house)], torch.device("cpu")).weights([1, 1], 10)
    assert found[:3].tolist() == pytest.approx([1 / np.log(1.52), 1 / np.log(1.52), 1 / np.log(1.02)])


def test_tints_change_colours_and_nothing_else():
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train.stock import random_tints, tinted

    rgb = torch.rand(2, 3, 4, 5, generator=torch.Generator().manual_seed(1)) / 2 + 0.25
    assert torch.allclose(tinted(rgb, torch.ones(2, 6)), rgb, atol=1e-6)
    for factor, expected in [
        (0, rgb * 0.8),
        (1, rgb.mean((1, 2, 3), keepdim=True) + 0.8 * (rgb - rgb.mean((1, 2, 3), keepdim=True))),
        (2, rgb.mean(1, keepdim=True) + 0.8 * (rgb - rgb.mean(1, keepdim=True))),
        (4, rgb * torch.tensor([1, 0.8, 1])[:, None, None]),
    ]:
        tints = torch.ones(2, 6)
        tints[:, factor] = 0.8
        assert torch.allclose(tinted(rgb, tints), expected, atol=1e-5), factor
    drawn = random_tints(50, 4, 1, 0.4)
    assert 0.6 <= drawn.min() < 0.62 and abs(drawn[..., 3:] - 1).max() <= 0.2 and len(np.unique(drawn)) == drawn.size


def test_class_mix_pastes_classes_of_the_other_set_with_their_labels():
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train.stock import class_mixed, random_classes

    rgb = torch.arange(4.0)[:, None, None, None].expand(4, 3, 2, 3)
    truth = torch.tensor([[0, 1, 255], [2, 2, 255]]).expand(4, 2, 3)
    taken = torch.zeros(4, 3, dtype=torch.bool)
    taken[1, 0] = taken[3, 2] = taken[3, 1] = True
    mixed, ids = class_mixed(rgb, truth, taken)
    # The second gets class 0 of the third, the fourth classes 1 and 2 of the first; what is ignored is never taken.
    assert mixed[0].unique().tolist() == [0] and mixed[2].unique().tolist() == [2]
    assert mixed[1, 0].tolist() == [[2, 1, 1], [1, 1, 1]] and mixed[3, 2].tolist() == [[3, 0, 3], [0, 0, 3]]
    assert (ids == truth).all()
    other = truth.clone()
    other[0] = 1
    assert class_mixed(rgb, other, taken)[1][3].tolist() == [[1, 1, 1], [1, 1, 1]]
    drawn = random_classes(500, 4, 1, 0.5, 10)
    assert drawn.any(2).mean() == pytest.approx(0.5, abs=0.05) and drawn.mean() == pytest.approx(0.25, abs=0.03)


def test_crowns_are_one_surface_as_annotators_draw_them(tmp_path):
    pytest.importorskip("scipy", reason="the optional extra [train] is not installed")
    ids = np.full((240, 320), 1, np.uint8)  # sky
    ids[100:200, 100:200:3] = 15  # twigs
    ids[150:200, 140:150] = 7  # someone before them
    Image.new("RGB", (320, 240)).save(tmp_path / "a.png"), Image.fromarray(ids).save(tmp_path / "b.png")
    sample = [Sample(tmp_path / "a.png", tmp_path / "b.png")]
    found = Pictures(sample, "native", "camvid", (320, 240), drawn=True)[0][1]
    tree, someone, sky = (labels.CAMVID.index(name) for name in ("tree", "pedestrian", "sky"))
    assert (found[100:150, 100:200] == tree).all() and (found[150:200, 140:150] == someone).all()
    assert (found[:95] == sky).all() and (found[:, :90] == sky).all()
    rendered = Pictures(sample, "native", "camvid", (320, 240))[0][1]
    assert (rendered == labels.lookup("native", "camvid")[ids]).all()


def test_what_is_too_small_to_draw_is_what_is_around_it():
    pytest.importorskip("scipy", reason="the optional extra [train] is not installed")
    from trove.train.drawn import as_drawn

    sky, road, someone, pole = (labels.CAMVID.index(name) for name in ("sky", "road", "pedestrian", "pole"))
    ids = np.full((180, 240), sky, np.uint8)
    ids[90:] = road
    ids[100:103, 50:53] = someone  # nine pixels
    ids[120, 50:60] = someone  # ten
    ids[85:95, 100] = pole  # one part of ten, aslant
    ids[[30, 31, 32], [30, 31, 32]] = labels.IGNORED
    expected = ids.copy()
    expected[100:103, 50:53] = road
    expected[[30, 31, 32], [30, 31, 32]] = sky
    assert (as_drawn(ids, "camvid") == expected).all()
    # Twice as large pictures have four times as many pixels of the same thing.
    twice = ids.repeat(2, 0).repeat(2, 1)
    assert (as_drawn(twice, "camvid") == expected.repeat(2, 0).repeat(2, 1)).all()
    # Nothing that is large enough: all stays.
    specks = np.arange(5 * 7, dtype=np.uint8).reshape(5, 7).repeat(3, 0).repeat(3, 1)
    large = np.zeros((240, 320), np.uint8)
    large[:15, :21] = specks
    assert (as_drawn(large, "camvid") == 0).all() and (as_drawn(large[:15, :15] + 100, "camvid") >= 100).all()


def test_frames_are_learnt_as_people_draw_them_unless_a_set_says_otherwise(experiment, tmp_path, monkeypatch):
    pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train import training

    asked = []

    class Told(Pictures):
        def __init__(self, samples, *how):
            super().__init__(samples, *how)
            asked.append(self.drawn)

    monkeypatch.setattr(training, "Pictures", Told)
    text = experiment.read_text().replace("epochs = 1", 'steps = 1\nmodel = "small"')
    for drawn in (True, False):
        asked.clear()
        changed = text.replace("[sets.C]", "[sets.C]\n" + ("" if drawn else "drawn = false"))
        experiment.write_text(changed.replace('"S+C+R[M]"', '"S+C"'))
        training.run(read(experiment), "S+C", tmp_path, lambda _: None)
        # The first is what is trained on.
        assert asked[0] is drawn


def test_sets_are_normalised_each_by_itself_and_the_last_one_s_statistics_are_kept():
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train.segmentation import Segmentation

    torch.manual_seed(1)
    model = torch.nn.Sequential(torch.nn.BatchNorm2d(3), torch.nn.Conv2d(3, 4, 1))
    batches = []
    model.register_forward_hook(lambda _, given, __: batches.append(len(given[0])))
    bright, dark = 5 + torch.rand(3, 3, 8, 8), torch.rand(2, 3, 8, 8)
    truth = torch.randint(0, 4, (5, 8, 8))
    task = Segmentation(4, None, [3, 2])
    loss = task.loss(model, torch.cat([bright, dark]), truth)
    assert model[0].momentum == 0.1
    assert torch.allclose(model[0].running_mean, 0.1 * dark.mean((0, 2, 3)), atol=1e-6)
    assert torch.isfinite(loss) and batches == [3, 2]


def test_a_network_doubts_what_it_finds_hard_to_tell(experiment, tmp_path):
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train.doubt import doubts

    class Halves(torch.nn.Module):
        """Sure of class 0 where a picture is dark, undecided between 1 and 2 where it is bright."""

        def forward(self, rgb):
            bright = rgb[:, :1] > 0.5
            return torch.cat([20.0 * ~bright, 20.0 * bright, 20.0 * bright, torch.full_like(rgb[:, :1], -20)], 1)

    rgb = torch.zeros(2, 3, 4, 6)
    rgb[..., 3:] = 1
    stock = SimpleNamespace(whole=lambda size: iter([(rgb, None)]))
    found = doubts(Halves(), stock, (6, 4))
    # Entropies 0, ln 2 and ln 2; nobody has seen the last.
    assert found == pytest.approx([0, 1.5, 1.5, 1], abs=1e-4)


def test_weights_of_doubt_choose_frames(finished, experiment, tmp_path):
    pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    experiment.write_text(experiment.read_text().replace("epochs = 1", 'epochs = 1\nmodel = "small"'))
    weights = tmp_path / "doubt.toml"
    ask = [sys.executable, "-m", "trove.train.doubt", experiment, "--out", tmp_path / "runs", "--weights", weights]
    done = subprocess.run([*ask, "--row", "S", "--of", "S"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert weights.read_text().endswith(done.stdout) and done.stdout.count("\n") == len(labels.CAMVID)
    out, page = tmp_path / "list.json", tmp_path / "page.html"
    choose = ["--count", 3, "--min-classes", 2, "--out", out, "--page", page]
    chosen = trove("curate", finished, "--classes", "camvid", "--weights", weights, *choose)
    assert chosen.returncode == 0, chosen.stderr
    refused = trove("curate", finished, "--weights", weights, *choose)
    assert refused.returncode == 1 and "expected a class of trove20 that counts" in refused.stderr
    for wrong, expected in (
        (["--row", "X", "--of", "S"], "--row: expected one of S, "),
        (["--row", "S", "--of", "X"], "--of: "),
    ):
        refused = subprocess.run([*ask, *wrong], capture_output=True, text=True)
        assert refused.returncode == 1 and expected in refused.stderr


def test_picture_and_labels_of_other_sizes_are_refused(tmp_path):
    Image.new("RGB", (8, 6)).save(tmp_path / "a.png")
    Image.new("L", (8, 5)).save(tmp_path / "b.png")
    with pytest.raises(ValueError, match=r"b\.png: expected"):
        Pictures([Sample(tmp_path / "a.png", tmp_path / "b.png")], "native", "camvid", (4, 3))[0]


def test_mixed_batches_hold_as_many_of_each_set_and_leave_none_out():
    batches = mixed_batches([100, 7], 10, 14, 3)
    assert all([i for i, _ in batch].count(0) == 5 for batch in batches)
    seen = [index for batch in batches for i, index in batch if i == 1]
    assert np.bincount(seen).tolist() == [10] * 7


def test_the_table_agrees_with_trove_evaluate(finished, tmp_path):
    truth, predicted = tmp_path / "truth", tmp_path / "predicted"
    truth.mkdir(), predicted.mkdir()
    random, confusion = np.random.default_rng(1), np.zeros((20, 20), int)
    for i, path in enumerate(sorted(finished.rglob("class.png"))):
        a = np.array(Image.open(path))
        b = np.where(random.random(a.shape) < 0.2, random.integers(1, 20, a.shape), a).astype(np.uint8)
        Image.fromarray(a).save(truth / f"{i}.png"), Image.fromarray(b).save(predicted / f"{i}.png")
        confusion += np.bincount(a.ravel().astype(int) * 20 + b.ravel(), minlength=400).reshape(20, 20)
    done = trove("evaluate", predicted, truth, "--classes", "trove20", "--json")
    assert done.returncode == 0, done.stderr
    confusion[0] = 0
    assert json.loads(done.stdout)["miou"] == pytest.approx(np.nanmean(iou(confusion)[1:]), abs=1e-12)


def test_the_table_has_the_papers_form():
    a = {"row": "P", "seed": 1, "outer": [[8, 2], [0, 10]], "curve": [[0, 20, 1.0]]}
    b = {"row": "S+P[M]", "seed": 1, "outer": [[10, 0], [0, 10]], "curve": [[0, 20, 0.5]]}
    rows = {r["row"]: table.summary([r, {**r, "seed": 2}]) for r in (a, b)}
    text = table.markdown(["road", "car"], "mIoU", rows, {"S+P[M]": "P"})
    assert "| P | 80.00 | 83.33 | 81.67 ± 0.00 | 90.00 |" in text
    assert text.endswith("\nS+P[M] against P: +18.33 (95 % interval +18.33 to +18.33) mIoU\n")
    assert r"S+P[M] & 100.00 & 100.00 & 100.00 $\pm$ 0.00 & 100.00 \\" in table.latex(["road", "car"], "mIoU", rows)
    assert table.curves([a, b]).count("<polyline") == 2


def test_a_small_network_learns_generated_frames_and_goes_on_where_it_was_stopped(experiment, tmp_path, monkeypatch):
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train import training

    monkeypatch.setattr(training, "_SAVE_AFTER_S", 0)
    lines = []
    # A clock that goes on by a second with every line.
    monkeypatch.setattr(training, "time", SimpleNamespace(perf_counter=lambda: len(lines)))
    torch.set_num_threads(1)
    text = (
        experiment.read_text()
        .replace("epochs = 1", "steps = 120\nrate = 3e-3")
        .replace("[64, 36]", "[160, 90]")
        .replace("batch = 2", "batch = 6")
    )
    experiment.write_text(text)
    found = read(experiment)

    class Stopped(Exception):
        pass

    def stop(line):
        lines.append(line)
        if "step 120" in line:
            raise Stopped

    with pytest.raises(Stopped):
        training.run(found, "S", tmp_path / "stopped", stop)
    (whole,) = training.run(found, "S", tmp_path / "whole", lines.append)
    assert len(list((tmp_path / "stopped").rglob("checkpoint.pt"))) == 1
    (resumed,) = training.run(found, "S", tmp_path / "stopped", lines.append)
    assert resumed == whole and whole["seconds"] == 6
    accuracy = np.trace(whole["outer"]) / np.sum(whole["outer"])
    assert accuracy > 0.85, f"{accuracy}, {whole['curve']}"
    assert not list((tmp_path / "whole").rglob("checkpoint.pt"))


def test_a_row_that_fails_is_told_and_the_others_are_trained(finished, experiment, tmp_path):
    pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    text = experiment.read_text().replace("epochs = 1", "steps = 2")
    experiment.write_text(text.replace(f'pictures = "{finished}"', 'pictures = "missing"'))
    for jobs in (1, 2):
        out = tmp_path / str(jobs)
        command = [sys.executable, "-m", "trove.train", experiment, "--threads", 1, "--jobs", jobs, "--out", out]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True)
        assert done.returncode == 1
        (error,) = done.stderr.splitlines()
        assert error.startswith("error: S+C+R[M], seed 1: FileNotFoundError") and "missing" in error
        rows = [line.split("|")[1].strip() for line in done.stdout.splitlines() if line.startswith("|")]
        assert rows == ["trained on", "---", "S", "S+R[F]"]


def test_what_is_asked_for_alone_is_trained_and_must_be_there(experiment, tmp_path):
    pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    experiment.write_text(
        experiment.read_text()
        .replace("epochs = 1", 'steps = 1\nmodel = "small"')
        .replace("seeds = [1]", "seeds = [1, 2]")
    )
    command = [sys.executable, "-m", "trove.train", experiment, "--out", tmp_path / "out"]
    done = subprocess.run([*command, "--rows", "S", "--seeds", "2"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert [path.name.split(", ")[:2] for path in (tmp_path / "out/runs").iterdir()] == [["S", "seed 2"]]
    for wrong, expected in (
        (["--rows", "S", "T"], "--rows: expected some of S, S+R[F], S+C+R[M], found T"),
        (["--seeds", "3"], "--seeds: expected some of 1, 2, found 3"),
        (["--folds", "1"], "--folds: expected none: the file has no [folds], found 1"),
    ):
        refused = subprocess.run([*command, *wrong], capture_output=True, text=True)
        assert refused.returncode == 1 and f"error: {expected}" in refused.stderr, refused.stderr


def test_an_interruption_ends_all_rows_at_once(experiment, tmp_path):
    pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    # Longer than anybody waits.
    experiment.write_text(experiment.read_text().replace("epochs = 1", "steps = 100000"))
    command = [sys.executable, "-m", "trove.train", experiment, "--threads", 1, "--jobs", 2, "--out", tmp_path / "out"]
    with subprocess.Popen(
        list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as running:
        try:
            assert "step" in running.stdout.readline()
            os.killpg(running.pid, signal.SIGINT)
            _, errors = running.communicate(timeout=60)
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(running.pid, signal.SIGKILL)
    assert running.returncode == 1 and errors.endswith("interrupted; run the same command to resume\n")


def test_rows_trained_at_the_same_time_find_what_they_find_alone(finished, experiment, tmp_path):
    pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    experiment.write_text(
        experiment.read_text().replace("epochs = 1", "steps = 3").replace("seeds = [1]", "seeds = [1, 2]")
    )
    command = [sys.executable, "-m", "trove.train", experiment, "--rows", "S", "--threads", "1", "--out"]
    for out, jobs in ((tmp_path / "a", 1), (tmp_path / "b", 2)):
        done = subprocess.run([*map(str, command), str(out), "--jobs", str(jobs)], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "a/table.md").read_text() == (tmp_path / "b/table.md").read_text()
    assert len(list((tmp_path / "b/runs").iterdir())) == 2
