"""Frames as a PyTorch dataset; skipped where PyTorch is missing (`make test-train`)."""

import numpy as np
import pytest
import trove as library

torch = pytest.importorskip("torch")
pytest.importorskip("torchvision")

from torch.utils.data import DataLoader  # noqa: E402
from torchvision import tv_tensors  # noqa: E402
from torchvision.transforms import v2  # noqa: E402
from trove.torch import Frames  # noqa: E402

EVERYTHING = ("class", "instance", "depth", "boxes", "masks", "normal", "flow_forward", "flow_backward")


def test_a_pair_holds_what_the_frame_does(finished):
    pairs, frames = Frames(finished, EVERYTHING), library.open(finished)
    assert len(pairs) == len(frames)
    objects = 0
    for (image, target), frame in zip(pairs, frames):
        assert isinstance(image, tv_tensors.Image) and image.dtype == torch.uint8
        assert np.array_equal(image.permute(1, 2, 0).numpy(), frame.rgb)
        for name, expected in [("class", frame.class_), ("instance", frame.instance), ("depth", frame.depth_m)]:
            assert isinstance(target[name], tv_tensors.Mask) and np.array_equal(target[name].numpy(), expected)
        assert np.array_equal(target["normal"].permute(1, 2, 0).numpy(), frame.normal)
        flow = target["flow_forward"].permute(1, 2, 0).numpy()
        assert np.array_equal(flow, frame.flow_forward, equal_nan=True)
        assert target["boxes"].canvas_size == frame.rgb.shape[:2] and target["boxes"].shape == (len(target["ids"]), 4)
        for i, mask, label, box in zip(*(target[name] for name in ("ids", "masks", "labels", "boxes"))):
            thing = next(thing for thing in frame.objects if thing.id == int(i))
            assert int(label) == thing.class_id and int(mask.sum()) == thing.visible_px
            rows, columns = torch.nonzero(mask, as_tuple=True)
            edges = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
            assert box.tolist() == [float(edge) for edge in edges]
            objects += 1
    assert objects > 0


def test_transforms_move_the_image_its_labels_and_boxes_alike(finished):
    plain = Frames(finished, ("class", "depth", "boxes", "masks"))
    flipped = Frames(finished, ("class", "depth", "boxes", "masks"), transforms=v2.RandomHorizontalFlip(1))
    index = next(i for i in range(len(plain)) if len(plain[i][1]["ids"]))
    (image, target), (mirrored, moved) = plain[index], flipped[index]
    assert torch.equal(mirrored, image.flip(-1))
    for name in ("class", "depth", "masks"):
        assert torch.equal(moved[name], target[name].flip(-1))
    width = image.shape[-1]
    assert torch.equal(moved["boxes"][:, [2, 1, 0, 3]].tensor_split(1)[0] * torch.tensor([-1.0, 1, -1, 1]),
                       target["boxes"] - torch.tensor([width, 0.0, width, 0]))  # fmt: skip
    smaller = Frames(finished, ("class",), transforms=v2.Resize((20, 30)))[index][1]["class"]
    assert smaller.shape == (20, 30) and set(smaller.unique().tolist()) <= set(target["class"].unique().tolist())


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_workers_give_what_one_process_gives(finished, method):
    pairs = Frames(finished, ("class", "instance"))
    loader = DataLoader(pairs, batch_size=2, num_workers=2, multiprocessing_context=method)
    images, labels = [], []
    for image, target in loader:
        images.append(image)
        labels.append(target["class"])
    assert torch.equal(torch.cat(images), torch.stack([image for image, _ in pairs]))
    assert torch.equal(torch.cat(labels), torch.stack([target["class"] for _, target in pairs]))


def test_objects_are_chosen_by_class_and_size(finished):
    car = 2
    for _, target in Frames(finished, ("boxes", "masks"), classes=[car], min_px=10):
        assert set(target["labels"].tolist()) <= {car}
        assert all(int(mask.sum()) >= 10 for mask in target["masks"])


def test_targets_that_are_unknown_or_cannot_be_transformed_are_refused(finished):
    with pytest.raises(library.TroveError, match="targets: expected some of class"):
        Frames(finished, ("klass",))
    with pytest.raises(library.TroveError, match="flow_forward holds vectors"):
        Frames(finished, ("class", "flow_forward"), transforms=v2.RandomHorizontalFlip())


def test_the_package_loads_it_when_it_is_used(finished):
    assert library.torch.Frames is Frames
