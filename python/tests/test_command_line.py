"""The installed program, as a user meets it."""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import check_output
import numpy as np
import pytest
from conftest import files, trove
from PIL import Image
from trove.format import read_manifest

# Cars, buses, jeeps, trucks, vans, construction machines, bicycles and motorcycles with their riders.
VEHICLES = {2, 3, 4, 5, 6, 12, 13, 16}


def test_every_file_of_the_contract_opens_and_agrees_with_the_others(finished):
    frames = check_output.check(finished)
    views = {path.rsplit("/", 1)[1] for path in frames}
    assert {"ego.CAM_FRONT", "ego.CAM_BACK"} <= views
    assert any(view.startswith("v1.") for view in views)


def test_two_threads_give_the_same_bytes_as_one(recipe, finished, tmp_path):
    done = trove("generate", recipe, "--out", tmp_path / "out", "--threads", 2)
    assert done.returncode == 0, done.stderr
    assert files(tmp_path / "out") == files(finished)


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGKILL])
def test_a_run_that_is_ended_and_started_again_gives_the_same_bytes(recipe, finished, tmp_path, end):
    out = tmp_path / "out"
    command = [sys.executable, "-m", "trove", "generate", str(recipe), "--out", str(out)]
    run = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    while not any(out.glob("*/v00/*/*/frame.json")) and run.poll() is None:
        time.sleep(0.02)
    time.sleep(random.uniform(0, 1))
    os.kill(run.pid, end)
    assert run.wait(timeout=60) != 0 or (out / "manifest.json").exists()
    # What is being written is hidden.
    kept = {path: path.stat().st_mtime_ns for path in out.glob("*/v00/*/[!.]*/frame.json")}
    again = trove("generate", recipe, "--out", out)
    assert again.returncode == 0, again.stderr
    assert files(out) == files(finished)
    assert all(path.stat().st_mtime_ns == time_ns for path, time_ns in kept.items()), "a finished frame was redone"


def test_a_second_run_redoes_nothing(recipe, finished):
    before = {name: (finished / name).stat().st_mtime_ns for name in files(finished) if name.count("/") > 1}
    done = trove("generate", recipe, "--out", finished, "--json")
    assert json.loads(done.stdout)["rendered"] == 0
    assert before == {name: (finished / name).stat().st_mtime_ns for name in before}


def test_labels_alone_cost_no_light(recipe, finished, tmp_path):
    labels = tmp_path / "labels.toml"
    labels.write_text(recipe.read_text() + "light = false\n")
    done = trove("generate", labels, "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    frames = check_output.check(tmp_path / "out")
    for path in frames:
        assert not (tmp_path / "out" / path / "rgb.png").exists()
        for name in ("class.png", "depth.exr", "flow_forward.exr"):
            assert (tmp_path / "out" / path / name).read_bytes() == (finished / path / name).read_bytes()


def test_the_radiance_behind_a_picture_is_written_where_it_is_asked_for(recipe, finished, tmp_path):
    wanted = tmp_path / "radiance.toml"
    wanted.write_text(recipe.read_text() + "radiance = true\n")
    done = trove("generate", wanted, "--out", tmp_path / "out", "--json")
    assert done.returncode == 0, done.stderr
    frames = check_output.check(tmp_path / "out")
    for path in frames:
        assert (tmp_path / "out" / path / "radiance.exr").exists() and not (finished / path / "radiance.exr").exists()
        assert (tmp_path / "out" / path / "rgb.png").read_bytes() == (finished / path / "rgb.png").read_bytes()
    timings = json.loads(done.stdout)["timings"]
    assert {row["path"] for row in timings} == set(frames) and all(row["render_seconds"] > 0 for row in timings)


def test_a_counterfactual_of_paint_differs_in_vehicles_alone_and_a_run_goes_on_with_it(recipe, tmp_path):
    repainted = tmp_path / "repainted.toml"
    text = recipe.read_text().replace("other_vehicles = 1\n", "") + "light = false\n"
    repainted.write_text(text + '[variations]\ncount = 2\ncounterfactual = "paint"\n')
    done = trove("generate", repainted, "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    rows = read_manifest(tmp_path / "out")["frames"]
    changed = [row for row in rows if row["variation"] == 1]
    assert changed and not any("change.png" in row["files"] for row in rows if row["variation"] == 0)
    marked = 0
    for row in changed:
        base, frame = tmp_path / "out" / row["counterfactual"]["base"], tmp_path / "out" / row["path"]
        assert row["counterfactual"]["factor"] == "paint" and (base / "frame.json").exists()
        change = np.asarray(Image.open(frame / "change.png"))
        classes = np.asarray(Image.open(frame / "class.png"))
        assert change.dtype == np.uint8 and change.shape == classes.shape and set(np.unique(change)) <= {0, 255}
        assert set(classes[change > 0]) <= VEHICLES, "paint is on vehicles alone"
        for name in ("class.png", "instance.png"):
            assert (base / name).read_bytes() == (frame / name).read_bytes()
        marked += int((change > 0).sum())
    assert marked > 0
    # One frame is lost; the run goes on without v00's having to be there twice.
    lost = tmp_path / "out" / changed[0]["path"]
    kept = (lost / "change.png").read_bytes()
    shutil.rmtree(lost)
    done = trove("generate", repainted, "--out", tmp_path / "out", "--json")
    assert json.loads(done.stdout)["rendered"] == 1 and (lost / "change.png").read_bytes() == kept


def test_a_place_without_a_drive_is_photographed_from_its_streets(recipe, tmp_path):
    source = recipe.parent / "demo" / ".trove" / "demo"
    place = tmp_path / "place.toml"
    place.write_text(
        f'[place]\nlat_deg = 47.37449\nlon_deg = 8.54664\nsize_m = 300\n[map]\nosm = "{source / "crossing.osm"}"\n'
        '[views]\nrig = "CAM_FRONT"\n[render]\nscale = 0.05\nspp = 1\n'
    )
    done = trove("generate", place, "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert len(check_output.check(tmp_path / "out")) > 3


def test_the_virtual_scene_is_a_binary_gltf(recipe, tmp_path):
    sky = tmp_path / "sky.exr"
    done = trove("build", recipe, "--out", tmp_path / "scene.glb", "--environment", sky, "--json")
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    data = (tmp_path / "scene.glb").read_bytes()
    assert data[:4] == b"glTF" and int.from_bytes(data[8:12], "little") == len(data) == report["bytes"]
    root = gltf(data)
    picture = check_output.exr(sky)
    assert picture.shape[1] == 2 * picture.shape[0] and picture[0].mean() > 0
    assert {camera["name"] for camera in root["cameras"]} >= {"ego.CAM_FRONT", "ego.CAM_BACK"}
    assert root["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] == "directional"
    assert "map.path_to_road_median_m" in report["report"]["measurements"]


def gltf(data):
    """The JSON of a binary glTF file."""
    return json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])


def test_without_textures_a_scene_has_its_outlines_alone(recipe, tmp_path):
    flat = tmp_path / "flat.toml"
    flat.write_text(recipe.read_text() + "[assets]\ntextures = false\n")
    roots = []
    for path in (recipe, flat):
        done = trove("build", path, "--out", tmp_path / "scene.glb")
        assert done.returncode == 0, done.stderr
        roots.append(gltf((tmp_path / "scene.glb").read_bytes()))
    textured, plain = roots
    assert plain["nodes"] == textured["nodes"] and len(plain["materials"]) == len(textured["materials"])
    pairs = list(zip(textured["materials"], plain["materials"]))
    assert any("normalTexture" in before for before, _ in pairs)
    for before, after in pairs:
        shades = after["pbrMetallicRoughness"]
        is_cut_out = before.get("alphaMode") == "MASK"
        assert after["name"] == before["name"] and ("baseColorTexture" in shades) <= is_cut_out
        assert not {"normalTexture", "emissiveTexture"} & set(after) and "metallicRoughnessTexture" not in shades


def test_what_a_card_runs_makes_the_processor_s_pictures(recipe, tmp_path):
    quick = tmp_path / "quick.toml"
    quick.write_text(recipe.read_text().replace("keyframes = [1, 2]", "keyframes = [1]"))
    outs = {device: tmp_path / device for device in ("cpu", "emulated")}
    for device, out in outs.items():
        done = trove("generate", quick, "--out", out, "--kernel", "obvhs", "--device", device)
        assert done.returncode == 0, done.stderr
    assert [read_manifest(out)["versions"]["card"] for out in outs.values()] == [None, "emulated"]
    report = json.loads((outs["emulated"] / "report.json").read_text())
    assert not any("card" in row["what"] for row in report["run"]["entries"]), "it was the processor after all"
    ours, theirs = [files(out) for out in outs.values()]
    assert ours.keys() == theirs.keys()
    pictures = [name for name in ours if name.endswith("/rgb.png")]
    for name in ours.keys() - {*pictures, "manifest.json", "contact_sheet.png"}:
        assert ours[name] == theirs[name], name
    for name in pictures:
        here, there = (np.asarray(Image.open(out / name), int) for out in outs.values())
        # Light through several panes is rounded otherwise.
        assert np.abs(here - there).max() <= 1 and (here != there).mean() < 0.01, name
    mixed = trove("generate", quick, "--out", outs["emulated"], "--kernel", "obvhs")
    assert mixed.returncode == 1 and 'card was "emulated"' in mixed.stderr, mixed.stderr
    absent = trove("generate", quick, "--out", tmp_path / "out", "--device", "cuda:99")
    assert absent.returncode == 1 and "cuda:99: " in absent.stderr and "--device cpu" in absent.stderr, absent.stderr
    labels = trove("generate", quick, "--out", tmp_path / "labels", "--device", "cuda:99", "--labels-only")
    assert labels.returncode == 0, labels.stderr
    wrong = trove("generate", quick, "--out", tmp_path / "out", "--device", "gpu")
    assert wrong.returncode == 2 and "expected auto, cpu, emulated, or cuda:0" in wrong.stderr, wrong.stderr


def test_doctor_and_inspect_speak_json(recipe):
    doctor = json.loads(trove("doctor", "--json").stdout)
    assert doctor["kernel"] and doctor["threads"] >= 1
    root = recipe.parent / "demo" / ".trove" / "demo" / "nuscenes"
    drives = json.loads(trove("inspect", root, "--json").stdout)["drives"]
    assert drives[0]["scene"] == "demo-0001" and drives[0]["boxes"]["car"] > 10


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (('"CAM_FRONT"', '"CAM_FORNT"'), "CAM_FRONT"),
        (("spp = 4", "ssp = 4"), "did you mean `spp`?"),
        (("crossing.osm", "nowhere.osm"), "nowhere.osm"),
        (("keyframes = [1, 2]", "keyframes = [99]"), "99"),
        (("keyframes = [1, 2]", 'scenes = ["demo-0002"]'), "demo-0001"),
    ],
)
def test_wrong_input_is_named_with_a_remedy(recipe, tmp_path, change, expected):
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(recipe.read_text().replace(*change))
    done = trove("generate", wrong, "--out", tmp_path / "out")
    assert done.returncode == 1
    assert expected in done.stderr and "panicked" not in done.stderr, done.stderr


def test_an_unwritable_folder_and_another_recipe_are_refused(recipe, finished, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("")
    done = trove("generate", recipe, "--out", blocked / "out")
    assert done.returncode == 1 and str(blocked) in done.stderr
    other = tmp_path / "other.toml"
    other.write_text(recipe.read_text().replace("seed = 3", "seed = 4"))
    done = trove("generate", other, "--out", finished)
    assert done.returncode == 1 and "choose another --out" in done.stderr
    assert Path(finished / "manifest.json").exists()
