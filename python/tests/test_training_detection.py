"""`python -m trove.train` with a detector: boxes around connected parts, and average precision."""

import numpy as np
import pytest
from trove.train import labels, report
from trove.train.experiment import read

pytest.importorskip("torch", reason="the optional extra [train] is not installed")
from trove.train import detection

EXPERIMENT = """
classes = "camvid"
size = [160, 90]
rows = ["S"]
[sets.S]
format = "native"
root = "{root}"
[val]
format = "native"
root = "{root}"
[training]
model = "ssdlite"
steps = 4
batch = 2
rate = 1e-3
seeds = [1]
"""


def test_a_box_is_around_every_connected_part_that_is_large_enough():
    car, bicyclist = (labels.CAMVID.index(name) for name in ("car", "bicyclist"))
    ids = np.full((40, 60), labels.CAMVID.index("road"), np.uint8)
    ids[10:20, 5:25] = car
    # Parts that touch at a corner are one.
    ids[20:30, 25:30] = car
    ids[30:38, 40:50] = bicyclist
    # Too narrow, and too low.
    ids[2:20, 50:55] = car
    ids[0:5, 0:30] = bicyclist
    boxes, kinds = detection.boxes_of(ids, "camvid")
    assert boxes.tolist() == [[5, 10, 30, 30], [40, 30, 50, 38]] and kinds.tolist() == [0, 2]
    assert list(labels.DETECTED["camvid"]) == ["vehicle", "person", "cyclist"]
    boxes, kinds = detection.boxes_of(np.zeros((8, 8), np.uint8), "camvid")
    assert boxes.shape == (0, 4) and kinds.shape == (0,)


def test_average_precision_is_that_of_its_definition():
    box = np.array([[0, 0, 10, 10], [20, 0, 30, 10], [0, 20, 10, 30]], np.float32)
    truths = [(box[:2], np.array([0, 0])), (box[2:], np.array([1]))]
    # The first two by score are right and wrong, the third is right; the second class is found in another place.
    found = [
        (
            np.array([[0, 0, 10, 9], [50, 50, 60, 60], [20, 0, 30, 10]], np.float32),
            np.zeros(3, int),
            np.array([0.9, 0.8, 0.7]),
        ),
        (box[:1], np.array([1]), np.array([0.9])),
    ]
    # Of 101 levels of recall the first 51 have a precision of 1, the others of 2/3.
    first, second, third = detection.average_precision(truths, found, 3)
    assert first == pytest.approx(100 * (51 + 50 * 2 / 3) / 101) and second == 0 and np.isnan(third)
    nothing = (np.zeros((0, 4), np.float32), np.zeros(0, int), np.zeros(0))
    assert detection.average_precision(truths, [nothing] * 2, 2).tolist() == [0, 0]


def test_classes_of_a_detector_count_from_one():
    import torch

    ids = torch.full((1, 40, 60), labels.CAMVID.index("road"))
    ids[:, 10:20, 5:25], ids[:, 30:38, 40:50] = (labels.CAMVID.index(name) for name in ("car", "bicyclist"))
    boxes = torch.tensor([[5.0, 10, 25, 20], [40, 30, 50, 38]])

    class Knows(torch.nn.Module):
        def forward(self, images, targets=None):
            if targets is None:
                return [{"boxes": boxes, "labels": torch.tensor([1, 3]), "scores": torch.ones(2)} for _ in images]
            assert targets[0]["boxes"].tolist() == boxes.tolist() and targets[0]["labels"].tolist() == [1, 3]
            return {"classes": torch.tensor(2.0), "boxes": torch.tensor(1.0)}

    class One:
        def whole(self, size):
            yield torch.zeros(1, 3, 40, 60), ids

    task = detection.Detection("camvid")
    assert task.loss(Knows(), torch.zeros(1, 3, 40, 60), ids).item() == 3
    vehicle, person, cyclist = task.measure(Knows(), One(), (60, 40))
    assert vehicle == cyclist == pytest.approx(100) and np.isnan(person)


def test_every_target_s_detected_classes_are_its_own():
    for target, kinds in labels.DETECTED.items():
        assert all(name in labels.TARGETS[target] for names in kinds.values() for name in names)
    assert set(labels.DETECTED) == set(labels.TARGETS)


def test_a_detector_is_trained_and_told_as_networks_that_segment(finished, tmp_path):
    import torch
    from trove.train import training

    torch.set_num_threads(1)
    path = tmp_path / "experiment.toml"
    path.write_text(EXPERIMENT.format(root=finished))
    found = read(path)
    results = training.run(found, "S", tmp_path / "out", lambda line: None)
    assert np.shape(results[0]["outer"]) == (3,) and results[0]["inner"] is None
    report.write(found, found.rows, results, tmp_path)
    head = (tmp_path / "table.md").read_text().splitlines()[0]
    assert head == "| trained on | vehicle | person | cyclist | AP50 | accuracy |"


def test_the_loss_of_a_detector_falls_when_it_is_shown_one_image_again_and_again():
    import torch

    torch.manual_seed(1)
    ids = np.full((1, 90, 160), labels.CAMVID.index("road"), np.uint8)
    ids[:, 30:60, 40:90] = labels.CAMVID.index("car")
    rgb = torch.from_numpy((ids == labels.CAMVID.index("car")).astype(np.float32))[:, None].repeat(2, 3, 1, 1)
    truth = torch.from_numpy(ids).repeat(2, 1, 1).long()
    model, task = detection.detector("camvid").train(), detection.Detection("camvid")
    optimiser = torch.optim.AdamW(model.parameters(), 1e-3)
    losses = []
    for _ in range(12):
        optimiser.zero_grad()
        loss = task.loss(model, rgb, truth)
        loss.backward()
        optimiser.step()
        losses.append(loss.item())
    assert losses[-1] < 0.7 * losses[0], losses
