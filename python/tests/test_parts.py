"""Parts of one recipe that several machines render are, once merged, the bytes of one run."""

import json
import random
import signal
import subprocess
import sys
import time

import pytest
import trove as package
from conftest import files, trove

MORE = """
[sensors.LIDAR_TOP]
kind = "lidar"
preset = "vlp-16"
[sensors.RADAR_FRONT]
kind = "radar"
preset = "ars408"
position_m = [3.4, 0.0, 0.5]
[grids.NEAR]
preset = "near.toml"
[variations]
count = 2
"""
GRID = """
low_m = [0, -10, -1]
voxel_m = 0.5
cells = [40, 40, 4]
classes = "occ3d"
"""


@pytest.fixture(scope="module")
def mixed(recipe):
    """A recipe with everything that a folder can hold: frames, sweeps, cycles and grids of two variations."""
    text = recipe.read_text().replace('rig = ["CAM_FRONT", "CAM_BACK"]\nother_vehicles = 1', 'rig = "CAM_FRONT"')
    path = recipe.parent / "mixed.toml"
    (recipe.parent / "near.toml").write_text(GRID)
    path.write_text(text.replace("keyframes = [1, 2]", "keyframes = [1, 2, 3]") + MORE)
    return path


@pytest.fixture(scope="module")
def whole(mixed):
    """The files of one run of it."""
    out = mixed.parent / "whole"
    done = trove("generate", mixed, "--out", out)
    assert done.returncode == 0, done.stderr
    return files(out)


def run(*args):
    done = trove(*args, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def same(out, whole):
    found = files(out)
    assert found.keys() == whole.keys()
    assert [name for name in whole if found[name] != whole[name]] == []


@pytest.mark.parametrize("count", [1, 7])
def test_parts_of_a_common_folder_are_the_bytes_of_one_run(mixed, whole, tmp_path, count):
    out = tmp_path / "out"
    parts = [f"{number}/{count}" for number in range(1, count + 1)]
    random.Random(count).shuffle(parts)
    made = [run("generate", mixed, "--part", part, "--out", out) for part in parts]
    frames = len(list(out.glob("*/v*/k*/*")))
    assert sum(part["rendered"] for part in made) == sum(part["frames"] for part in made) == frames == 24
    assert not (out / "manifest.json").exists() and not (out / "contact_sheet.png").exists()
    status = package.status(out)
    assert (status["finished"], status["merged"], status["not_begun"]) == (frames, False, [])
    assert [part["seconds_left"] for part in status["parts"]] == [0.0] * count
    assert run("generate", mixed, "--out", out)["rendered"] == 0
    same(out, whole)
    assert package.status(out)["merged"]
    assert run("generate", mixed, "--part", parts[0], "--out", out)["rendered"] == 0
    assert trove("verify", out).returncode == 0


def test_parts_in_folders_of_their_own_are_merged_in_any_order(mixed, whole, tmp_path):
    folders = [tmp_path / f"part-{number}" for number in (2, 3, 1)]
    for folder in folders:
        run("generate", mixed, "--part", f"{folder.name[-1]}/3", "--out", folder)
    # A frame that was damaged on its way is not taken over.
    damaged = next(folders[0].glob("*/*/*/*/class.png"))
    damaged.write_bytes(damaged.read_bytes()[:-1] + b"\0")
    summary = run("merge", *folders, "--out", tmp_path / "out")
    assert summary["rendered"] == 1
    same(tmp_path / "out", whole)
    assert sorted(file for folder in folders for file in files(folder) if file.endswith("manifest.json")) == []
    # One of the parts missing, and the output being one of them.
    assert run("merge", *folders[:2], "--out", folders[1])["rendered"] > 0
    same(folders[1], whole)


def test_a_part_that_was_killed_is_repeated(mixed, whole, tmp_path):
    out = tmp_path / "out"
    command = [sys.executable, "-m", "trove", "generate", str(mixed), "--part", "2/2", "--out", str(out)]
    killed = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    journal = out / ".trove" / "parts" / "2-of-2" / "frames.jsonl"
    while not (journal.exists() and b'"files"' in journal.read_bytes()) and killed.poll() is None:
        time.sleep(0.005)
    killed.send_signal(signal.SIGKILL)
    assert killed.wait() == -signal.SIGKILL, "the part had ended before it could be killed"
    first = run("generate", mixed, "--part", "1/2", "--out", out)
    again = run("generate", mixed, "--part", "2/2", "--out", out)
    assert again["rendered"] < again["frames"] and first["rendered"] == first["frames"]
    assert run("generate", mixed, "--out", out)["rendered"] == 0
    same(out, whole)


def test_a_part_that_never_ran_is_made_by_the_run_that_merges(mixed, whole, tmp_path):
    out = tmp_path / "out"
    run("generate", mixed, "--part", "5/7", "--out", out)
    status = package.status(out)
    assert status["not_begun"] == ["1/7", "2/7", "3/7", "4/7", "6/7", "7/7"]
    assert status["frames"] == 24
    run("generate", mixed, "--out", out)
    same(out, whole)


def test_two_workers_on_one_part_do_no_harm(mixed, whole, tmp_path):
    out = tmp_path / "out"
    command = [sys.executable, "-m", "trove", "generate", str(mixed), "--part", "1/1", "--out", str(out)]
    workers = [subprocess.Popen(command, stderr=subprocess.PIPE, text=True) for _ in range(2)]
    said = [worker.communicate(timeout=600)[1] for worker in workers]
    ended = sorted(zip((worker.returncode for worker in workers), said))
    assert ended[0][0] == 0 and (ended[1][0] == 0 or "another worker on part 1/1" in ended[1][1]), ended
    assert run("generate", mixed, "--out", out)["rendered"] == 0
    same(out, whole)


def test_machines_that_differ_are_told_and_not_mixed(mixed, tmp_path):
    out, other = tmp_path / "out", tmp_path / "other"
    run("generate", mixed, "--part", "1/2", "--out", out)
    for path in (out, other):
        if path == other:
            run("generate", mixed, "--part", "2/2", "--out", other)
        identity = path / ".trove" / "run.json"
        changed = json.loads(identity.read_text())
        changed["versions"]["kernel"] = "Embree 4.0.0"
        identity.write_text(json.dumps(changed))
    before = files(out)
    done = trove("generate", mixed, "--part", "2/2", "--out", out)
    assert done.returncode == 1 and 'kernel was "Embree 4.0.0"' in done.stderr, done.stderr
    done = trove("merge", other, "--out", tmp_path / "merged")
    assert done.returncode == 1 and "other: expected frames of this recipe" in done.stderr, done.stderr
    assert files(out) == before and files(tmp_path / "merged") == {}


def test_a_dry_run_tells_what_a_recipe_will_take(mixed, whole, tmp_path):
    before = set(tmp_path.iterdir())
    all_of_it = package.estimate(mixed, machines=7)
    assert all_of_it["frames"] == 24
    written = sum(len(data) for data in whole.values())
    assert all_of_it["bytes"] == pytest.approx(written, rel=0.25)
    assert all_of_it["last_machine_seconds"] < all_of_it["seconds"]
    parts = [package.estimate(mixed, part=f"{number}/2")["frames"] for number in (1, 2)]
    assert sum(parts) == 24
    assert set(tmp_path.iterdir()) == before
    done = trove("generate", mixed, "--dry-run", "--out", tmp_path / "out")
    assert done.returncode == 2, done.stderr


CAMERA = """
[[camera]]
name = "{name}"
size_px = [320, 180]
position_m = [1.6, 0.0, 1.5]
pitch_deg = {pitch_deg}
horizontal_fov_deg = 60
"""


def test_a_dry_run_of_labels_tries_cameras_that_differ_at_their_full_size(recipe, tmp_path):
    (tmp_path / "rig.toml").write_text(
        "".join(CAMERA.format(name=name, pitch_deg=pitch) for name, pitch in [("street", 0), ("sky", 89)])
    )
    text = recipe.read_text().replace("keyframes = [1, 2]", "keyframes = [1]").replace("other_vehicles = 1\n", "")
    text = text.replace('["CAM_FRONT", "CAM_BACK"]', '"rig.toml"').replace("scale = 0.1\nspp = 4", "light = false")
    labels = tmp_path / "labels.toml"
    labels.write_text(text)
    told, done = package.estimate(labels), run("generate", labels, "--out", tmp_path / "out")
    sizes = {name: len(data) for name, data in files(tmp_path / "out").items()}
    of_the_sky = sum(size for name, size in sizes.items() if "sky" in name)
    assert told["frames"] == done["frames"] == 2 and of_the_sky < sum(sizes.values()) / 6
    assert told["bytes"] == pytest.approx(sum(sizes.values()), rel=0.02)


@pytest.mark.parametrize("part", ["0/2", "3/2", "2", "a/b"])
def test_a_part_that_is_none_is_refused(mixed, tmp_path, part):
    done = trove("generate", mixed, "--part", part, "--out", tmp_path / "out")
    assert done.returncode == 2 and "such as 3/8" in done.stderr, done.stderr
