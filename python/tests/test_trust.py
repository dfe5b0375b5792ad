"""Whatever strangers' files say: nothing is written elsewhere, run, mixed or waited for."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time

import check_output
import pytest
from conftest import files, trove

ONE_VIEW = ('rig = ["CAM_FRONT", "CAM_BACK"]\nother_vehicles = 1', 'rig = "CAM_FRONT"')


@pytest.fixture
def labels(recipe, tmp_path):
    """The quick recipe with a drive and a map of its own and without light: its path, and how to change it."""
    shutil.copytree(recipe.parent / "demo" / ".trove" / "demo", tmp_path / "demo")
    text = recipe.read_text().replace(str(recipe.parent / "demo" / ".trove" / "demo"), str(tmp_path / "demo"))
    text = text.replace(*ONE_VIEW) + "light = false\n"
    path = tmp_path / "labels.toml"
    path.write_text(text)
    return path


def change(path, *replacements):
    text = path.read_text()
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)


def rendered(recipe, out):
    done = trove("generate", recipe, "--out", out, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["rendered"]


@pytest.mark.parametrize(
    ("key", "smaller"),
    [
        ("keyframes", ("keyframes = [1, 2]", "keyframes = [2]")),
        ("rig", ('rig = ["CAM_FRONT", "CAM_BACK"]', 'rig = ["CAM_BACK"]')),
        ("files", ("[render]", '[output]\nfiles = ["class", "depth"]\n[render]')),
    ],
)
def test_a_run_that_grows_ends_in_the_bytes_of_one_that_was_as_large_from_the_start(
    recipe, finished, tmp_path, key, smaller
):
    path = tmp_path / "small.toml"
    path.write_text(recipe.read_text())
    change(path, smaller)
    out = tmp_path / "out"
    few = rendered(path, out)
    path.write_text(recipe.read_text())
    all_of_them = len(check_output.check(finished))
    assert rendered(path, out) == (all_of_them if key == "files" else all_of_them - few)
    grown, whole = files(out), files(finished)
    assert grown.keys() == whole.keys()
    assert [name for name in whole if grown[name] != whole[name]] == []
    assert rendered(path, out) == 0


def test_more_variations_are_added_to_a_finished_run(labels, tmp_path):
    out = tmp_path / "out"
    few = rendered(labels, out)
    before = files(out)
    labels.write_text(labels.read_text() + "[variations]\ncount = 2\n")
    assert rendered(labels, out) == few
    assert all(data == before[name] for name, data in files(out).items() if "/v00/" in name and name in before)


def test_a_run_is_not_mixed_with_one_of_other_inputs(labels, tmp_path):
    out = tmp_path / "out"
    rendered(labels, out)
    crossing = tmp_path / "demo" / "crossing.osm"
    table = tmp_path / "demo" / "nuscenes" / "v1.0-demo" / "sample_annotation.json"
    before = files(out)
    for path, named in [(crossing, "map.osm"), (table, "v1.0-demo/sample_annotation.json")]:
        whole = path.read_bytes()
        path.write_bytes(whole + b"\n")
        done = trove("generate", labels, "--out", out)
        assert done.returncode == 1 and "the contents of" in done.stderr and named in done.stderr, done.stderr
        path.write_bytes(whole)
        assert rendered(labels, out) == 0
    # Of what one scene alone is made from, once more of it is to be made.
    [lanes] = (tmp_path / "demo" / "nuscenes" / "maps" / "expansion").glob("*.json")
    lanes.write_bytes(lanes.read_bytes() + b"\n")
    assert rendered(labels, out) == 0
    change(labels, ("keyframes = [1, 2]", "keyframes = [1, 2, 3]"))
    done = trove("generate", labels, "--out", out)
    assert done.returncode == 1 and "recorded files have changed" in done.stderr, done.stderr
    assert files(out) == before


def test_a_library_whose_texture_changed_is_another_one(labels, tmp_path):
    mine = tmp_path / "mine"
    mine.mkdir()
    (mine / "plans.toml").write_text("")
    (mine / "bark.png").write_bytes(b"1")
    labels.write_text(labels.read_text() + f'[assets]\nlibraries = ["procedural", "{mine}"]\n')
    out = tmp_path / "out"
    rendered(labels, out)
    (mine / "bark.png").write_bytes(b"2")
    done = trove("generate", labels, "--out", out)
    assert done.returncode == 1 and "asset library" in done.stderr, done.stderr


def test_frames_of_which_nobody_knows_what_they_were_made_from_are_not_added_to(labels, tmp_path):
    out = tmp_path / "out"
    rendered(labels, out)
    (out / ".trove" / "run.json").unlink()
    change(labels, ("seed = 3", "seed = 4"))
    done = trove("generate", labels, "--out", out)
    assert done.returncode == 1 and "run.json" in done.stderr, done.stderr


@pytest.mark.parametrize("name", ["../../outside", "/outside", "", ".trove", "manifest.json"])
def test_a_scenes_name_does_not_choose_where_files_go(labels, tmp_path, name):
    table = tmp_path / "demo" / "nuscenes" / "v1.0-demo" / "scene.json"
    scenes = json.loads(table.read_text())
    scenes[0]["name"] = name
    table.write_text(json.dumps(scenes))
    around = set(tmp_path.rglob("*"))
    out = tmp_path / "deep" / "out"
    done = trove("generate", labels, "--out", out)
    assert done.returncode == 1 and "panicked" not in done.stderr, done.stderr
    written = set(tmp_path.rglob("*")) - around
    assert all(path.is_relative_to(tmp_path / "deep") for path in written)
    assert not any(path.name == "frame.json" for path in written)


def test_verify_names_every_damaged_frame_and_a_further_run_mends_it(recipe, finished, tmp_path):
    out = tmp_path / "out"
    shutil.copytree(finished, out)
    assert trove("verify", out).returncode == 0
    flipped, removed, *_ = sorted(path.relative_to(out) for path in out.glob("*/v00/*/*/class.png"))
    data = bytearray((out / flipped).read_bytes())
    data[len(data) // 2] ^= 1
    (out / flipped).write_bytes(data)
    (out / removed).unlink()
    manifest = json.loads((out / "manifest.json").read_text())
    last = manifest["frames"][-1]
    last["files"]["class.png"] = "0" * 64
    (out / "manifest.json").write_text(json.dumps(manifest))
    damaged = trove("verify", out, "--json")
    assert damaged.returncode == 1, damaged.stdout
    found = json.loads(damaged.stdout)
    assert (found["damaged"], found["unlisted"]) == ([str(flipped), str(removed)], [last["path"]])
    assert rendered(recipe, out) == 2
    assert trove("verify", out).returncode == 0
    assert files(out) == files(finished)


def test_nothing_of_the_working_folder_is_run(tmp_path):
    packages = tmp_path / ".venv" / "lib" / "python3.11" / "site-packages"
    source = tmp_path / "evil.c"
    source.write_text(
        '#include <stdio.h>\n__attribute__((constructor)) static void run(void) { fclose(fopen("ran", "w")); }\n'
    )
    for library in ("embreex.libs/libembree4.so.4", "pyoidn/lib/libOpenImageDenoise.so.2"):
        path = packages / library
        path.parent.mkdir(parents=True)
        subprocess.run(["cc", "-shared", "-fPIC", "-o", path, source], check=True)
    program = "from trove._trove import main; main(['trove', 'doctor'], {})"
    environment = {k: v for k, v in os.environ.items() if not k.startswith("TROVE_")}
    found = f"{[str(packages)]!r}"
    for search, ran in [("[]", False), (found, True)]:
        environment["VIRTUAL_ENV"] = str(tmp_path / ".venv")
        subprocess.run([sys.executable, "-c", program.format(search)], cwd=tmp_path, env=environment, check=True)
        assert (tmp_path / "ran").exists() == ran


@pytest.mark.parametrize("key", ["crossing.osm", "labels.toml", "ego_pose.json"])
def test_a_pipe_in_place_of_a_file_is_not_waited_for(labels, tmp_path, key):
    [path] = tmp_path.rglob(key)
    path.unlink()
    os.mkfifo(path)
    done = trove("generate", labels, "--out", tmp_path / "out")
    assert done.returncode == 1 and "not a regular file" in done.stderr, done.stderr


def test_an_output_does_not_replace_what_is_no_file(labels, tmp_path):
    pipe = tmp_path / "scene.glb"
    os.mkfifo(pipe)
    done = trove("build", labels, "--out", pipe)
    assert done.returncode == 1 and pipe.is_fifo(), done.stderr


@pytest.mark.parametrize(("end", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("times", [1, 2])
def test_a_run_that_was_asked_to_end_says_so_by_its_status(recipe, tmp_path, end, status, times):
    out = tmp_path / "out"
    command = [sys.executable, "-m", "trove", "generate", str(recipe), "--out", str(out)]
    run = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    while not (out / ".trove").exists() and run.poll() is None:
        time.sleep(0.02)
    for _ in range(times):
        run.send_signal(end)
        time.sleep(0.1)
    _, said = run.communicate(timeout=60)
    assert run.returncode == status and "Traceback" not in said and "panicked" not in said, said


def test_a_closed_pipe_is_no_fault(tmp_path):
    run = subprocess.Popen(
        [sys.executable, "-m", "trove", "assets", "list"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    run.stdout.close()
    assert "panicked" not in run.stderr.read()
    assert run.wait(timeout=60) == -signal.SIGPIPE


def test_paths_need_not_be_utf_8(labels, tmp_path):
    folder = tmp_path / os.fsdecode(b"\xff")
    folder.mkdir()
    shutil.copy(labels, folder)
    command = [sys.executable, "-m", "trove", "generate", folder / "labels.toml", "--out", folder / "out"]
    done = subprocess.run(command, capture_output=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    assert (folder / "out" / "manifest.json").exists()
    for more in (["verify", folder / "out"], ["curate", folder / "out", "--json"]):
        done = subprocess.run([sys.executable, "-m", "trove", *more], capture_output=True, timeout=600, check=False)
        assert done.returncode == 0, done.stderr


def test_names_do_not_command_the_terminal(labels, tmp_path):
    done = trove("generate", labels, "--out", tmp_path / "out", "--frames", tmp_path / "\x1b]0;x\x07")
    assert done.returncode == 1 and "\x1b" not in done.stderr and "u{1b}" in done.stderr
    change(labels, ("root = ", 'scenes = ["\\u001b[2J"]\nroot = '))
    done = trove("generate", labels, "--out", tmp_path / "out")
    assert done.returncode == 1 and "\x1b" not in done.stderr and "u{1b}" in done.stderr


def test_absurd_numbers_of_threads_are_refused(labels, tmp_path):
    done = trove("generate", labels, "--out", tmp_path / "out", "--threads", 10**9)
    assert done.returncode == 2, done.stderr
    labels.write_text(labels.read_text() + "threads = 1000000000\n")
    done = trove("generate", labels, "--out", tmp_path / "out")
    assert done.returncode == 1 and "render.threads" in done.stderr, done.stderr
