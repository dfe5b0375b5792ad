"""`trove export --format bop`: what the numbers of BOP say is what the frames say."""

import json

import numpy as np
import pytest
from exports import exported, projected, sources, surrounds
from PIL import Image


@pytest.fixture(scope="module")
def bop(finished, tmp_path_factory):
    return exported(finished, tmp_path_factory.mktemp("bop") / "out", "bop")[0]


def scenes(bop):
    return sorted(path for path in (bop / "train").iterdir())


def test_poses_project_the_models_around_their_pixels(bop, finished):
    models = json.loads((bop / "models/models_info.json").read_text())
    frames, checked = iter(sources(finished)), 0
    for scene in scenes(bop):
        cameras, poses, infos = (
            json.loads((scene / f"scene_{name}.json").read_text()) for name in ("camera", "gt", "gt_info")
        )
        assert list(cameras) == list(poses) == list(infos) == [str(i) for i in range(len(cameras))]
        for image, camera in cameras.items():
            frame = next(frames)
            intrinsics = np.reshape(camera["cam_K"], (3, 3))
            assert np.allclose(intrinsics, frame.table["intrinsics"])
            world_to_camera = np.column_stack([np.reshape(camera["cam_R_w2c"], (3, 3)), camera["cam_t_w2c"]])
            expected = np.linalg.inv(frame.table["world_from_camera"])[:3]
            assert np.allclose(world_to_camera / [1, 1, 1, 1000], expected)
            rows = [row for row in frame.users if row["asset"]]
            assert len(poses[image]) == len(infos[image]) == len(rows)
            for number, (pose, info, row) in enumerate(zip(poses[image], infos[image], rows)):
                model = models[str(pose["obj_id"])]
                size_m = np.array([model[f"size_{axis}"] for axis in "xyz"]) / 1000
                assert np.allclose(size_m, row["size_m"], atol=0.001)
                assert model["diameter"] == pytest.approx(1000 * np.linalg.norm(size_m))
                assert model["min_x"] == -model["size_x"] / 2
                to_camera = np.eye(4)
                to_camera[:3, :3] = np.reshape(pose["cam_R_m2c"], (3, 3))
                to_camera[:3, 3] = np.array(pose["cam_t_m2c"]) / 1000
                corners, near_m = projected(to_camera, size_m, intrinsics)
                if near_m > 0.5 and row["truncation"] == 0:
                    x, y, w, h = info["bbox_obj"]
                    assert surrounds(corners, [x, y, x + w - 1, y + h - 1]), row
                    checked += 1
                mask = np.array(Image.open(scene / f"mask_visib/{int(image):06}_{number:06}.png"))
                assert set(np.unique(mask)) <= {0, 255}
                assert ((mask > 0) == (frame.picture("instance") == row["id"])).all()
                assert (mask > 0).sum() == info["px_count_visib"] == row["visible_px"]
                assert info["visib_fract"] == pytest.approx(row["visible_px"] / row["amodal_px"])
    assert checked > 10 and next(frames, None) is None


def test_depth_is_in_steps_of_its_scale_and_0_in_the_sky(bop, finished):
    frames = iter(sources(finished))
    for scene in scenes(bop):
        for image, camera in json.loads((scene / "scene_camera.json").read_text()).items():
            depth = np.array(Image.open(scene / f"depth/{int(image):06}.png")).astype(float)
            expected = next(frames).depth_m()
            sky = np.isinf(expected)
            assert (depth[sky] == 0).all()
            apart = np.abs(depth * camera["depth_scale"] / 1000 - expected)[~sky]
            assert apart.max() <= 0.5 * camera["depth_scale"] / 1000 + 1e-4


def test_pycocotools_reads_the_masks_of_the_coco_files(bop):
    coco = pytest.importorskip("pycocotools.coco")
    found = 0
    for scene in scenes(bop):
        table = coco.COCO(str(scene / "scene_gt_coco.json"))
        for image in table.loadImgs(table.getImgIds()):
            for number, row in enumerate(table.loadAnns(table.getAnnIds(image["id"]))):
                mask = np.array(Image.open(scene / f"mask_visib/{image['id']:06}_{number:06}.png"))
                assert (table.annToMask(row) == (mask > 0)).all() and row["area"] == (mask > 0).sum()
                assert row["category_id"] in table.cats
                found += 1
    assert found > 10
