"""Frames, commands and scenes as Python meets them, held to the files and to the command line."""

import inspect
import json
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path

import check_output
import jsonschema
import numpy as np
import pytest
import trove as library
from conftest import trove
from PIL import Image
from trove.format import read_frame, read_manifest

SCHEMA = Path(__file__).parents[2] / "docs" / "schema" / "masks.schema.json"


@pytest.fixture(scope="session")
def scene(recipe):
    return library.build(recipe)


def test_the_package_loads_quickly_and_without_what_it_may_not_need():
    code = "import time; t = time.perf_counter(); import trove; s = time.perf_counter() - t; import sys; print(s, *sys.modules)"
    runs = [subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True) for _ in range(3)]
    seconds = min(float(run.stdout.split()[0]) for run in runs)
    assert seconds < 0.2
    assert not {"numpy", "torch", "PIL"} & set(runs[0].stdout.split()[1:])


def test_a_folder_is_a_sequence_of_frames_in_the_manifest_s_order(finished):
    frames = library.open(finished)
    rows = read_manifest(finished)["frames"]
    assert len(frames) == len(rows) > 3
    assert [frame.name for frame in frames] == [row["path"] for row in rows]
    assert frames[-1].path == finished / rows[-1]["path"]
    assert [frame.name for frame in frames[1:3]] == [row["path"] for row in rows[1:3]]
    assert frames.classes[9] == "road"
    with pytest.raises(IndexError):
        frames[len(rows)]


def test_every_image_is_what_other_libraries_read(finished):
    for frame in library.open(finished):
        folder = finished / frame.name
        assert set(frame.images) == {
            "rgb", "class", "instance", "depth", "normal", "flow_forward", "flow_backward",
            "occluded_forward", "occluded_backward",
        }  # fmt: skip
        for name, array in [
            ("rgb", frame.rgb),
            ("class", frame.class_),
            ("instance", frame.instance),
            ("occluded_forward", frame.occluded_forward),
            ("occluded_backward", frame.occluded_backward),
        ]:
            expected = np.asarray(Image.open(folder / f"{name}.png"))
            assert array.dtype == (np.uint16 if name == "instance" else np.uint8)
            assert np.array_equal(array, expected), name
        for name, array in [
            ("depth", frame.depth_m),
            ("normal", frame.normal),
            ("flow_forward", frame.flow_forward),
            ("flow_backward", frame.flow_backward),
        ]:
            expected = check_output.exr(folder / f"{name}.exr")
            assert array.dtype == np.float32 and np.array_equal(array, expected, equal_nan=True), name
            assert array.flags.writeable and array.flags.c_contiguous


def test_images_that_were_asked_for_are_what_other_libraries_read(recipe, tmp_path):
    scalars, vectors = ["range", "roughness"], ["normal_world", "albedo", "object_coordinates"]
    vectors += ["scene_flow_forward", "scene_flow_backward"]
    names = ["class", "instance", "depth", "panoptic", "coverage", "part", *scalars, *vectors]
    files = [*names, "masks"]
    asked = recipe.with_name("asked.toml")
    asked.write_text(f'{recipe.read_text()}[output]\nfiles = {json.dumps(files)}\n[labels]\nglass = "behind"\n')
    library.generate(asked, tmp_path / "asked")
    rendered = library.build(asked, keyframe=1).render("ego.CAM_FRONT")
    for frame in library.open(tmp_path / "asked"):
        assert sorted(frame.images) == sorted(names) and frame.table["glass"] == "behind"
        assert frame.panoptic.dtype == np.uint32
        assert np.array_equal(frame.panoptic, 65536 * frame.class_.astype(np.uint32) + frame.instance)
        for name in ("coverage", "part"):
            assert np.array_equal(getattr(frame, name), np.asarray(Image.open(frame.path / f"{name}.png")))
        for name in [*scalars, *vectors]:
            array = frame.range_m if name == "range" else getattr(frame, name)
            expected = check_output.exr(frame.path / f"{name}.exr")
            assert array.dtype == np.float32 and np.array_equal(array, expected, equal_nan=True), name
            assert array.ndim == (2 if name in scalars else 3)
        for label in ["panoptic", "coverage", "part", *scalars, *vectors]:
            assert np.asarray(frame.overlay(label)).shape == (*frame.class_.shape, 3), label
        check_masks(frame)
        if frame.name.endswith("k001/ego.CAM_FRONT"):
            assert rendered.masks == frame.masks and pickle.loads(pickle.dumps(rendered)).masks == frame.masks
            for name in ["panoptic", "range_m", "albedo", "scene_flow_forward", "coverage", "part"]:
                assert np.array_equal(getattr(rendered, name), getattr(frame, name), equal_nan=True), name
            return
    raise AssertionError("no frame of the front camera")


def check_masks(frame):
    """The masks of a frame, as pycocotools decodes them, are its pixels, boxes and counts."""
    mask = pytest.importorskip("pycocotools.mask")
    jsonschema.validate(json.loads((frame.path / "masks.json").read_text()), json.loads(SCHEMA.read_text()))
    assert list(frame.masks) == [thing.id for thing in frame.objects]
    for thing in frame.objects:
        visible, amodal = (mask.decode(frame.masks[thing.id][which]) > 0 for which in ("visible", "amodal"))
        assert np.array_equal(visible, frame.mask(thing)) and np.array_equal(amodal, frame.amodal_mask(thing))
        assert (visible <= amodal).all() and amodal.sum() == thing.amodal_px
        rows, columns = np.nonzero(amodal)
        assert (columns.min(), rows.min(), columns.max(), rows.max()) == thing.amodal_box


def test_camera_and_objects_are_those_of_the_table(finished):
    seen = 0
    for frame in library.open(finished):
        table = read_frame(frame.path)
        camera = frame.camera
        assert (camera.width_px, camera.height_px) == (table["width_px"], table["height_px"])
        assert camera.intrinsics.tolist() == table["intrinsics"]
        assert camera.world_from_camera.tolist() == table["world_from_camera"]
        assert camera.position_m.tolist() == table["world_from_camera_translation_m"]
        assert [thing.id for thing in frame.objects] == [row["id"] for row in table["objects"]]
        for thing, row in zip(frame.objects, table["objects"]):
            assert (thing.class_, thing.visible_px) == (row["class"], row["visible_px"])
            assert frame.mask(thing).sum() == thing.visible_px
            low, high = thing.corners_world[0], thing.corners_world[-1]
            assert np.isclose(np.linalg.norm(high - low), np.linalg.norm(thing.size_m))
            # The box's centre is as far as the table says.
            centre = thing.corners_world.mean(axis=0)
            assert np.isclose(np.linalg.norm(centre - camera.position_m), thing.range_m, rtol=1e-4)
            # Forward, left and up from the vehicle is forward, left and down in its front camera.
            in_camera, in_ego = frame.camera_from_body(thing), frame.ego_from_body(thing)
            assert np.isclose(np.linalg.norm(in_camera[:3, 3]), thing.range_m, rtol=1e-4)
            world = np.array(table["world_from_ego"]) @ np.vstack([thing.corners(in_ego).T, np.ones(8)])
            assert np.allclose(world[:3].T, thing.corners_world)
            if frame.name.endswith("ego.CAM_FRONT"):
                assert np.allclose(in_camera[[2, 0, 1], 3], in_ego[:3, 3] * [1, -1, -1], atol=2.5)
            if thing.asset and thing.origin == "recorded":
                # Its foot is the middle of its box's bottom.
                foot = np.linalg.inv(thing.world_from_body) @ thing.world_from_asset[:, 3]
                assert np.abs(foot[:3] + np.array([0, 0, thing.size_m[2] / 2])).max() < 0.3, thing
            seen += thing.visible_px > 0
    assert seen > 0


@pytest.mark.parametrize("label", ["class", "instance", "depth", "normal", "flow_forward", "occluded_forward", "boxes"])
def test_an_overlay_is_a_picture_that_notebooks_show(finished, tmp_path, label):
    frame = next(frame for frame in library.open(finished) if any(thing.visible_px for thing in frame.objects))
    overlay = frame.overlay(label)
    assert overlay._repr_png_().startswith(b"\x89PNG")
    overlay.save(tmp_path / "overlay.png")
    saved = np.asarray(Image.open(tmp_path / "overlay.png"))
    assert np.array_equal(saved, np.asarray(overlay)) and saved.shape == frame.rgb.shape
    assert not np.array_equal(saved, frame.rgb)


def test_an_overlay_shows_classes_in_their_colours_over_the_grey_picture(finished):
    frame = library.open(finished)[0]
    colors = {row["id"]: row["rgb"] for row in read_manifest(finished)["classes"]}
    expected = np.array([colors.get(i, (0, 0, 0)) for i in range(256)], np.uint8)[frame.class_]
    assert np.array_equal(frame.overlay("class", opacity=1).array, expected)
    bare = np.asarray(frame.overlay("class", opacity=0))
    assert np.ptp(bare.astype(int), axis=2).max() == 0, "grey"


def test_a_frame_goes_to_another_process_and_comes_back(finished):
    frame = library.open(finished)[0]
    again = pickle.loads(pickle.dumps(frame))
    assert again.name == frame.name and np.array_equal(again.rgb, frame.rgb)


def test_what_is_missing_or_damaged_is_told_as_the_command_line_does(finished, tmp_path):
    with pytest.raises(library.TroveError, match="expected an output folder of trove generate"):
        library.open(tmp_path)
    copy = tmp_path / "out"
    shutil.copytree(finished, copy)
    frame = library.open(copy)[0]
    (frame.path / "rgb.png").unlink()
    with pytest.raises(library.TroveError, match=r"rgb\.png: expected a file that is needed, found none; name rgb"):
        _ = frame.rgb
    (frame.path / "depth.exr").write_bytes(b"no picture")
    with pytest.raises(library.TroveError, match=r"depth\.exr: expected a file that was written here"):
        _ = frame.depth_m
    with pytest.raises(library.TroveError, match="overlay: expected one of class"):
        frame.overlay("colour")
    shutil.rmtree(frame.path)
    with pytest.raises(library.TroveError, match=r"frame\.json: expected"):
        _ = library.open(copy)[0].objects
    (copy / "manifest.json").unlink()
    # What an unfinished run leaves.
    assert len(library.open(copy)) == len(library.open(finished)) - 1


def test_generate_does_what_the_command_does_and_tells_how_far_it_is(recipe, finished, tmp_path):
    told = []
    summary = library.generate(recipe, tmp_path / "out", progress=lambda *args: told.append(args))
    names = [frame.name for frame in library.open(finished)]
    assert summary["rendered"] == summary["frames"] == len(names) and not summary["interrupted"]
    assert [timing["path"] for timing in summary["timings"]] == names
    assert told[-1][:2] == (len(names), len(names))
    assert all(0 <= done <= total for done, total, _ in told) and any(doing in names for _, _, doing in told)
    for name in names:
        assert (tmp_path / "out" / name / "rgb.png").read_bytes() == (finished / name / "rgb.png").read_bytes()
    again = library.generate(recipe, tmp_path / "out")
    assert again["rendered"] == 0


def test_errors_have_the_words_of_the_command_line(tmp_path):
    with pytest.raises(library.TroveError) as raised:
        library.generate(tmp_path / "none.toml", tmp_path / "out")
    done = trove("generate", tmp_path / "none.toml", "--out", tmp_path / "out")
    assert done.stderr == f"error: {raised.value}\n"
    with pytest.raises(library.TroveError) as raised:
        library.evaluate(tmp_path, tmp_path, classes="camvd")
    done = trove("evaluate", tmp_path, tmp_path, "--classes", "camvd")
    assert str(raised.value) in done.stderr and "camvid" in str(raised.value)


def test_what_a_progress_callback_raises_ends_the_run_and_keeps_what_is_finished(recipe, tmp_path):
    class Enough(Exception):
        pass

    def stop(done, total, doing):
        if done >= 1:
            raise Enough

    with pytest.raises(Enough):
        library.generate(recipe, tmp_path / "out", progress=stop)
    kept = len(library.open(tmp_path / "out"))
    planned = len(library.open(tmp_path / "out").manifest["frames"]) if (tmp_path / "out/manifest.json").exists() else 0
    assert kept >= 1 and planned == 0, "the run has not ended"
    summary = library.generate(recipe, tmp_path / "out")
    assert summary["rendered"] == summary["frames"] - kept


def test_ctrl_c_is_keyboard_interrupt_and_finished_frames_are_kept(recipe, tmp_path):
    code = textwrap.dedent(f"""
        import sys, time, trove
        try:
            trove.generate({str(recipe)!r}, {str(tmp_path / "out")!r}, progress=lambda *_: print("on", flush=True))
        except KeyboardInterrupt:
            print("interrupted")
            sys.exit(7)
    """)
    run = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    while not any((tmp_path / "out").glob("*/v00/*/*/frame.json")) and run.poll() is None:
        time.sleep(0.02)
    os.kill(run.pid, signal.SIGINT)
    out, _ = run.communicate(timeout=60)
    if run.returncode != 0:  # it may have been done before
        assert run.returncode == 7 and out.endswith("interrupted\n")
    kept = library.open(tmp_path / "out")
    assert len(kept) >= 1 and library.verify(tmp_path / "out")["damaged"] == []
    before = {frame.path: (frame.path / "frame.json").stat().st_mtime_ns for frame in kept}
    library.generate(recipe, tmp_path / "out")
    assert all((path / "frame.json").stat().st_mtime_ns == time_ns for path, time_ns in before.items())


def test_other_threads_run_while_a_command_does(recipe, tmp_path):
    beats, done = [], threading.Event()

    def beat():
        while not done.wait(0.01):
            beats.append(time.monotonic())

    thread = threading.Thread(target=beat)
    thread.start()
    started = time.monotonic()
    library.generate(recipe, tmp_path / "out")
    seconds = time.monotonic() - started
    done.set()
    thread.join()
    gaps = np.diff(beats)
    assert len(beats) > 5 * seconds and gaps.max() < 1, "the lock was held"


def test_verify_finds_what_the_command_finds(finished, tmp_path):
    sound = library.verify(finished)
    assert sound["damaged"] == [] and sound["frames"] == len(library.open(finished))
    shutil.copytree(finished, tmp_path / "out")
    frame = library.open(tmp_path / "out")[0]
    (frame.path / "class.png").write_bytes(b"")
    findings = library.verify(tmp_path / "out")
    assert findings["damaged"] == [f"{frame.name}/class.png"]
    assert findings == json.loads(trove("verify", tmp_path / "out", "--json").stdout)


def test_judging_commands_answer_what_they_print(finished, tmp_path):
    evaluation = library.evaluate(finished, finished, classes="trove20", boundary=True)
    printed = trove("evaluate", finished, finished, "--classes", "trove20", "--boundary", "--json")
    assert evaluation == json.loads(printed.stdout) and evaluation["miou"] == 1
    told = []
    curation = library.curate(
        finished, count=3, min_classes=2, out=tmp_path / "list.json", page=tmp_path / "page.html",
        progress=lambda *args: told.append(args),
    )  # fmt: skip
    assert curation["kept"] == 3 and told[-1][0] == told[-1][1] == len(library.open(finished))
    chosen = library.open(finished, curated=tmp_path / "list.json")
    assert len(chosen) == curation["train"] + curation["val"]
    recoloring = library.recolor(finished, finished, out=tmp_path / "recolored", strength=0.5, detail=True)
    assert recoloring["pictures"] == len(library.open(finished)) and (tmp_path / "recolored/before_after.png").exists()
    # Towards itself nothing becomes sharper than 8 bits leave it.
    assert recoloring["after"]["sharpness"] == pytest.approx(recoloring["before"]["sharpness"], rel=0.02)


def test_every_option_of_a_command_is_one_of_its_function():
    functions = {name: [getattr(library, name)] for name in ("demo", "generate", "curate", "recolor", "evaluate")}
    functions["verify"] = [library.verify, library.verify_labels]
    functions["generate"].append(library.estimate)
    # What a function's name says.
    said = {"verify": {"labels"}, "generate": {"dry-run"}}
    for command, ours in functions.items():
        options = re.findall(r"^ +(?:-\w, )?--([a-z-]+)", trove(command, "--help").stdout, re.MULTILINE)
        known = {name.replace("_", "-") for function in ours for name in inspect.signature(function).parameters}
        known |= said.get(command, set())
        assert "help" in options and set(options) - known == {"json", "help"}, command


def test_export_writes_drives_in_the_plain_form(recipe, tmp_path):
    root = recipe.parent / "demo" / ".trove" / "demo" / "nuscenes"
    done = library.export_drives(root, tmp_path / "plain", scenes=["demo-0001"])
    assert done["drives"] == ["demo-0001"] and (tmp_path / "plain" / "demo-0001").is_dir()


def test_export_says_what_it_wrote(finished, tmp_path):
    told = []
    done = library.export(finished, tmp_path / "coco", "coco", progress=lambda *step: told.append(step[:2]))
    count = len(library.open(finished))
    assert done["frames"] == {"train": count} and done["classes"] == "coco" and done["licences"]
    assert told[-1] == (count, count) and (tmp_path / "coco/annotations/instances_train.json").is_file()
    with pytest.raises(library.TroveError, match="did you mean `coco`"):
        library.export(finished, tmp_path / "other", "cocoo")


def test_a_built_scene_gives_the_pictures_of_the_run(scene, finished):
    assert "ego.CAM_FRONT" in scene.views and "map.path_to_road_median_m" in scene.report["measurements"]
    frame = scene.render("ego.CAM_FRONT")
    name = next(f.name for f in library.open(finished) if f"k{scene.keyframe:03}/ego.CAM_FRONT" in f.name)
    stored = library.Frame.stored(finished / name, name)
    for image in ["rgb", "class_", "instance", "depth_m", "normal"]:
        assert np.array_equal(getattr(frame, image), getattr(stored, image)), image
    assert np.array_equal(frame.flow_forward, stored.flow_forward, equal_nan=True)
    assert [thing.id for thing in frame.objects] == [thing.id for thing in stored.objects]
    assert frame.path is None and set(stored.images) <= set(frame.images)
    assert frame.overlay("class")._repr_png_() == stored.overlay("class")._repr_png_()


def test_a_camera_flies_through_a_built_scene(scene):
    front = scene.views["ego.CAM_FRONT"].scaled(0.5)
    x, y, z = front.position_m
    camera = front.at(library.look_at([x, y, z + 12], [x + 5, y + 5, z - 1]))
    frame = scene.render(camera, spp=2)
    assert frame.rgb.shape == (camera.height_px, camera.width_px, 3)
    assert np.allclose(frame.camera.world_from_camera, camera.world_from_camera)
    assert np.allclose(frame.camera.intrinsics, camera.intrinsics)
    assert np.isnan(frame.flow_forward).all(), "no neighbouring keyframe"
    # The ray of the middle pixel meets the ground about where the camera looks.
    middle = frame.depth_m[camera.height_px // 2, camera.width_px // 2]
    assert 5 < middle < 20
    again = scene.render(camera, camera.world_from_camera, spp=2)
    assert np.array_equal(again.rgb, frame.rgb), "the same noise"
    assert not np.array_equal(scene.render(camera, spp=2, seed=5).rgb, frame.rgb)
    labels = scene.render(camera, labels_only=True)
    assert "rgb" not in labels.images and np.array_equal(labels.class_, frame.class_)
    with pytest.raises(library.TroveError, match="expected one of class"):
        _ = labels.rgb


def test_what_is_no_view_or_camera_is_refused(scene, recipe):
    with pytest.raises(library.TroveError, match=r"view: expected one of .*ego\.CAM_FRONT"):
        scene.render("CAM_FORNT")
    with pytest.raises(library.TroveError, match="world_from_camera: expected a rotation"):
        scene.render("ego.CAM_FRONT", np.zeros((4, 4)))
    with pytest.raises(ValueError, match="look_at: expected a target away"):
        library.look_at([0, 0, 5], [0, 0, 0])
    with pytest.raises(library.TroveError, match=r"keyframe: .* has keyframes 0 to"):
        library.build(recipe, keyframe=99)


def test_a_built_scene_is_written_as_the_command_does(scene, recipe, tmp_path):
    scene.write_glb(tmp_path / "ours.glb")
    done = trove("build", recipe, "--out", tmp_path / "theirs.glb")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "ours.glb").read_bytes() == (tmp_path / "theirs.glb").read_bytes()


def test_the_labels_of_a_panorama_are_those_of_its_directions(scene):
    front = scene.views["ego.CAM_FRONT"]
    width, height = 128, 64
    intrinsics = np.array([[width / (2 * np.pi), 0, width / 2], [0, height / np.pi, height / 2], [0, 0, 1]])
    panorama = library.Camera(width, height, intrinsics, front.world_from_camera, "equirectangular")
    frame = scene.render(panorama, labels_only=True)
    sky = 1
    assert frame.class_[2, 0] == sky and np.isinf(frame.depth_m[2, 0])
    assert frame.class_[-2, width // 2] != sky


def test_the_trajectory_goes_where_the_frames_are(finished):
    frames = library.open(finished)
    scene = frames[0].table["scene"]
    way = frames.trajectory(scene)
    assert len(way.times_ns) == len(way.world_from_ego) > 2, "moments that are not rendered are in it too"
    for frame in frames:
        if frame.table["view"].startswith("ego."):
            k = frame.table["keyframe"]
            assert way.times_ns[k] == frame.table["keyframe_time_ns"]
            apart_s = (frame.table["time_ns"] - way.times_ns[k]) * 1e-9
            then = way.world_from_ego[k, :3, 3] + way.velocity_mps[k] * apart_s
            assert np.allclose(np.array(frame.table["world_from_ego"])[:3, 3], then, atol=0.05)
            assert np.allclose(
                np.array(frame.table["world_from_ego"])[:3, :3], way.world_from_ego[k, :3, :3], atol=0.02
            )
    step_s = (way.times_ns[2] - way.times_ns[1]) * 1e-9
    ahead = way.waypoints(1, [0, step_s, 1e4])
    assert np.allclose(ahead[0], 0, atol=1e-9)
    assert np.allclose((way.world_from_ego[1] @ [*ahead[1], 1])[:3], way.world_from_ego[2, :3, 3])
    assert np.isnan(ahead[2]).all(), "beyond the drive's end"
    with pytest.raises(library.TroveError, match="keyframe: expected 0 to"):
        way.waypoints(len(way.times_ns), [1.0])
