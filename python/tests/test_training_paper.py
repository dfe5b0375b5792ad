"""`python -m trove.train` by the paper's protocol: DeepLab v2 on ResNet-50, cut at random and nothing else."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from exports import exported
from PIL import Image
from trove.train import labels
from trove.train.data import Pictures
from trove.train.experiment import ExperimentError, read

EXPERIMENTS = Path(__file__).resolve().parents[2] / "experiments/paper"
# The sizes that the paper's networks see, so small that a processor makes steps of DeepLab in seconds.
SMALL = {"[512, 256]": "[128, 64]", "[620, 188]": "[156, 48]"}


def made_up(name, finished, root):
    """Frames of ours as the files of Cityscapes or KITTI-STEP, some to train on and some to measure on."""
    frames = sorted(path.parent for path in finished.rglob("rgb.png"))
    assert len(frames) >= 4
    if name == "cityscapes":
        out = root / "exported"
        exported(finished, out, "cityscapes")
        for kind in ("leftImg8bit", "gtFine"):
            for split in ("train", "val"):
                shutil.copytree(out / kind / "train", root / "cityscapes" / kind / split)
        return
    ids = np.full(256, 255, np.uint8)
    train_ids = {row["name"]: int(row["train_id"]) for row in labels._rows("cityscapes")}
    for row in labels._rows("trove20"):
        ids[int(row["id"])] = train_ids.get(row["cityscapes"], 255)
    for i, frame in enumerate(frames):
        split, sequence = ("val", "0002") if i % 2 else ("train", "0000")
        picture = root / f"kitti-step/image_02/{sequence}/{i:06}.png"
        panoptic = root / f"kitti-step/panoptic_maps/{split}/{sequence}/{i:06}.png"
        for path in (picture, panoptic):
            path.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(frame / "rgb.png", picture)
        classes = ids[np.asarray(Image.open(frame / "class.png"))]
        # Red is the class, green and blue are the instance's number.
        Image.fromarray(np.stack([classes, np.zeros_like(classes), classes], 2)).save(panoptic)


@pytest.fixture(params=["cityscapes", "kitti-step"])
def protocol(request, finished, tmp_path):
    """The paper's experiment on made-up files in the datasets' exact form, for a few steps."""
    name = request.param
    made_up(name, finished, tmp_path / "data")
    text = (EXPERIMENTS / f"{name}.toml").read_text()
    for large, small in SMALL.items():
        text = text.replace(large, small)
    text = text.replace(f"out/{name}/frames", str(finished)).replace(f"out/{name}/recolored", str(finished))
    text = "".join(line for line in text.splitlines(True) if not line.startswith(("frames ", "weights", "# ImageNet")))
    path = tmp_path / "experiment.toml"
    path.write_text(text.replace("count = 1000", "count = 1").replace("epochs    = 30", "steps = 2"))
    return path


def test_the_files_ask_for_the_papers_protocol(protocol):
    found = read(protocol)
    training = found.training
    assert (training.model, training.optimiser, training.rate, training.batch) == ("deeplab", "sgd", 1e-4, 10)
    assert (training.zoom, training.mirrored, training.colour, training.balanced, training.averaged) == (
        1,
        False,
        0,
        False,
        False,
    )
    assert len(found.rows) == 12 and set(found.compare.values()) == {"R", "P"}
    for pool in (*found.pools.values(), found.val):
        pictures = Pictures(pool.samples, pool.numbering, found.classes, found.size, training.zoom)
        rgb, ids = pictures[0]
        assert rgb.shape[:2] == ids.shape and min(ids.shape[0] / found.size[1], ids.shape[1] / found.size[0]) == 1
        known = ids[ids != labels.IGNORED]
        assert len(known) > 0.5 * ids.size and known.max() < len(labels.PAPER)


def test_the_paper_s_rows_train_by_its_protocol(protocol, tmp_path):
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train import training

    torch.set_num_threads(1)
    found = read(protocol)
    (first,) = training.run(found, "S+P[F]", tmp_path / "out", lambda line: None)
    assert [point[:2] for point in first["curve"]] == [[0, 2], [1, 2]]
    assert np.sum(first["outer"]) > 0 and np.shape(first["outer"]) == (len(labels.PAPER),) * 2
    assert first["curve"][1][2] < first["curve"][0][2]


def test_deeplab_learns_by_its_own_optimiser(protocol):
    torch = pytest.importorskip("torch", reason="the optional extra [train] is not installed")
    from trove.train.models import classifier_of, network
    from trove.train.training import optimiser

    model = network("deeplab", "paper", None)
    groups = optimiser(model, "sgd", 1e-4, torch.device("cpu")).param_groups
    others, classifier = groups
    assert {id(p) for p in classifier["params"]} == {id(p) for p in classifier_of(model).parameters()}
    assert len(others["params"]) + len(classifier["params"]) == len(list(model.parameters()))
    assert (others["times"], classifier["times"], others["momentum"], others["weight_decay"]) == (1, 10, 0.9, 5e-4)


def test_missing_weights_are_named(protocol):
    protocol.write_text(protocol.read_text().replace("[training]", '[training]\nweights = "resnet50.pth"'))
    with pytest.raises(ExperimentError, match=r"training.weights: .*resnet50.pth"):
        read(protocol)


@pytest.mark.skipif("TROVE_TEST_DATA" not in os.environ, reason="TROVE_TEST_DATA is not set")
def test_a_real_frame_of_cityscapes_has_its_classes(tmp_path):
    root = Path(os.environ["TROVE_TEST_DATA"]) / "cityscapes-sample/tests/data/pseudo_cityscapes_dataset"
    for kind, ending in (("leftImg8bit", "leftImg8bit"), ("gtFine", "gtFine_labelIds")):
        folder = tmp_path / kind / "train/frankfurt"
        folder.mkdir(parents=True)
        shutil.copy(root / kind / f"frankfurt_000000_000294_{ending}.png", folder)
    path = tmp_path / "experiment.toml"
    path.write_text(
        'classes = "paper"\nrows = ["R"]\n[sets.R]\nformat = "cityscapes"\nroot = "."\n[val]\nformat = "cityscapes"\nroot = "."\n'
    )
    found = read(path)
    ids = Pictures(found.val.samples, found.val.numbering, "paper", found.size)[0][1]
    by_train_id = np.asarray(Image.open(root / "gtFine/frankfurt_000000_000294_gtFine_labelTrainIds.png"))
    # Their own training ids, by name; ours also have classes for some that they leave out.
    theirs = {int(row["train_id"]): row["trove13"] for row in labels._rows("cityscapes") if row["train_id"] != "255"}
    seen = [number for number in np.unique(by_train_id) if number != 255 and np.sum(by_train_id == number) > 100]
    for number in seen:
        # The two were made smaller in different ways, so that they differ along outlines.
        most = int(np.bincount(ids[by_train_id == number]).argmax())
        assert (labels.PAPER[most] if most != labels.IGNORED else "void") == theirs[int(number)]
    assert len(seen) > 6
