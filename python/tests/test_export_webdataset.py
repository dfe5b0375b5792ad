"""`trove export --format webdataset`: webdataset iterates over the frames."""

import pytest
from exports import exported, sources


def test_webdataset_iterates_over_every_frame(finished, tmp_path):
    webdataset = pytest.importorskip("webdataset")
    out, summary = exported(finished, tmp_path / "out", "webdataset")
    shards = sorted(str(path) for path in out.glob("*.tar"))
    samples = list(webdataset.WebDataset(shards, shardshuffle=False).decode("pil"))
    frames = sources(finished)
    assert len(samples) == len(frames) == summary["frames"]["train"]
    for number, (sample, frame) in enumerate(zip(samples, frames)):
        assert sample["__key__"] == f"{number:08}"
        assert sample["json"] == frame.table
        for name in ("rgb", "class", "instance"):
            assert sample[f"{name}.png"].size == (frame.table["width_px"], frame.table["height_px"])
        assert sample["depth.exr"] == (frame.folder / "depth.exr").read_bytes()
    plain = {sample["__key__"]: sample for sample in webdataset.WebDataset(shards, shardshuffle=False)}
    assert plain["00000000"]["rgb.png"] == (frames[0].folder / "rgb.png").read_bytes()
