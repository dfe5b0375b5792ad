"""Output to an object store and data from there: moto's server, an S3 in a process of its own, and faults on the way.

`make test-stores` installs moto and builds the program with object stores.
"""

import contextlib
import importlib.util
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import files
from faults import Faults, host_of

PROGRAM = Path(os.environ.get("TROVE_WITH_STORES", "no program"))
BUCKET = "frames"
FAULTS = 1000

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("moto") is None or not PROGRAM.is_file(), reason="needs moto: make test-stores"
)


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """The address of an S3 server with one bucket."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    log = (tmp_path_factory.mktemp("server") / "log").open("w")
    command = [sys.executable, "-m", "moto.server", "-H", "127.0.0.1", "-p", str(port)]
    running = subprocess.Popen(command, stdout=log, stderr=log)
    deadline = time.monotonic() + 60
    while time.monotonic() < deadline:
        with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1):
            break
        time.sleep(0.1)
    address = f"http://127.0.0.1:{port}"
    client(address).create_bucket(Bucket=BUCKET)
    yield address
    running.terminate()
    running.wait()


def client(address):
    import boto3

    names = {"aws_access_key_id": "somebody", "aws_secret_access_key": "secret", "region_name": "us-east-1"}
    return boto3.client("s3", endpoint_url=address, **names)


@pytest.fixture
def bucket(server):
    """The server's bucket, empty."""
    s3 = client(server)
    for name in keys(s3):
        s3.delete_object(Bucket=BUCKET, Key=name)
    return s3


def keys(s3, prefix=""):
    pages = s3.get_paginator("list_objects_v2").paginate(Bucket=BUCKET, Prefix=prefix)
    return [found["Key"] for page in pages for found in page.get("Contents", [])]


def public(s3, prefix):
    """What lies below a prefix, as `files` gives a folder's."""
    named = [key for key in keys(s3, prefix + "/") if "/.trove/" not in key]
    return {key.removeprefix(prefix + "/"): s3.get_object(Bucket=BUCKET, Key=key)["Body"].read() for key in named}


def variables(address, cache):
    return {
        **os.environ,
        "AWS_ENDPOINT_URL": address,
        "AWS_ALLOW_HTTP": "true",
        "AWS_ACCESS_KEY_ID": "somebody",
        "AWS_SECRET_ACCESS_KEY": "secret",
        "AWS_REGION": "us-east-1",
        "TROVE_CACHE": str(cache),
    }


@pytest.fixture(scope="module")
def models(tmp_path_factory):
    """The cache of built-in models."""
    folder = tmp_path_factory.mktemp("cache") / "assets"
    folder.mkdir()
    return folder


@pytest.fixture
def start(server, models, tmp_path):
    """Starts the program, a machine with a cache of its own unless one is named."""

    def start(*args, address=server, machine="a", **more):
        command = [str(PROGRAM), *map(str, args)]
        cache = tmp_path / f"cache-{machine}"
        if not cache.exists():  # but for the models, which would be made anew each time
            cache.mkdir()
            (cache / "assets").symlink_to(models)
        env = variables(address, cache)
        return subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)

    return start


@pytest.fixture
def run(start):
    def run(*args, status=0, **more):
        running = start(*args, "--json", **more)
        out, said = running.communicate(timeout=900)
        assert running.returncode == status, said
        return json.loads(out) if status == 0 else said

    return run


@pytest.fixture(scope="module")
def labels(recipe, models):
    """A quick recipe of labels, sweeps and cycles of two variations, and the files of one run of it into a folder."""
    text = recipe.read_text().replace("other_vehicles = 1", "other_vehicles = 0")
    path = recipe.parent / "stores.toml"
    sensors = '[sensors.LIDAR_TOP]\nkind = "lidar"\npreset = "vlp-16"\n'
    path.write_text(text + "light = false\n" + sensors + "[variations]\ncount = 2\n")
    out = recipe.parent / "stores"
    env = variables("http://127.0.0.1:9", models.parent)
    done = subprocess.run([PROGRAM, "generate", path, "--out", out], env=env, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return path, files(out)


def same(found, whole):
    assert found.keys() == whole.keys()
    assert [name for name in whole if found[name] != whole[name]] == []


def test_a_run_into_a_bucket_is_the_run_into_a_folder(labels, bucket, run, tmp_path):
    recipe, whole = labels
    out = f"s3://{BUCKET}/a/run"
    first = run("generate", recipe, "--out", out)
    assert first["rendered"] == first["frames"] == 12 and first["out"] == out
    same(public(bucket, "a/run"), whole)
    own = [key.removeprefix("a/run/") for key in keys(bucket, "a/run/.trove/")]
    assert own == [".trove/frames.jsonl", ".trove/run.json"], "and no claim is left"
    # What lies in the cache is of no use once it is in the bucket.
    assert [
        path for path in (tmp_path / "cache-a" / "stored").rglob("*") if path.is_file() and path.suffix != ".lock"
    ] == []
    # On another machine, nothing is made anew, and what is gone is.
    assert run("generate", recipe, "--out", out, machine="b")["rendered"] == 0
    gone = next(key for key in keys(bucket, "a/run") if key.endswith("class.png"))
    bucket.delete_object(Bucket=BUCKET, Key=gone)
    assert run("generate", recipe, "--out", out, machine="b")["rendered"] == 1
    same(public(bucket, "a/run"), whole)
    status = run("status", out)
    assert (status["frames"], status["finished"], status["merged"]) == (12, 12, True)


def test_parts_claim_what_they_make_and_a_killed_one_is_repeated(labels, bucket, start, run):
    recipe, whole = labels
    out = f"s3://{BUCKET}/parts"
    killed = start("generate", recipe, "--part", "1/2", "--out", out, machine="a")
    while not any(key.endswith("frame.json") for key in keys(bucket, "parts")):
        assert killed.poll() is None, killed.communicate()[1]
    killed.send_signal(signal.SIGKILL)
    killed.communicate()
    assert killed.returncode == -signal.SIGKILL, "the part had ended before it could be killed"
    # Its claim holds for a while.
    said = run("generate", recipe, "--part", "1/2", "--out", out, machine="b", status=1)
    assert "parts/1-of-2/lock: process" in said and "is at work there" in said, said
    said = run("generate", recipe, "--out", out, machine="b", status=1)
    assert "is at work there" in said, said
    assert run("generate", recipe, "--part", "2/2", "--out", out, machine="c")["rendered"] == 6
    assert run("status", out)["merged"] is False
    bucket.delete_object(Bucket=BUCKET, Key="parts/.trove/parts/1-of-2/lock")
    again = run("generate", recipe, "--part", "1/2", "--out", out, machine="b")
    assert again["rendered"] < again["frames"] == 6, "what had arrived is kept, though no journal tells of it"
    assert run("generate", recipe, "--out", out, machine="c")["rendered"] == 0
    same(public(bucket, "parts"), whole)
    assert [key for key in keys(bucket, "parts/.trove/") if "/parts/1" in key or "/parts/2" in key] == []


def test_folders_are_merged_into_a_bucket(labels, bucket, run, tmp_path):
    recipe, whole = labels
    for part in "12":
        run("generate", recipe, "--part", f"{part}/2", "--out", tmp_path / part)
    merged = run("merge", tmp_path / "1", tmp_path / "2", "--out", f"s3://{BUCKET}/merged")
    assert merged["rendered"] == 0
    same(public(bucket, "merged"), whole)


def test_nothing_is_lost_and_nothing_twice_where_a_thousand_requests_fail(labels, server, bucket, run):
    recipe, whole = labels
    proxy = Faults(host_of(server), 0.55, seed=22)
    try:
        for round in range(20):
            out = f"faults/{round}"
            # Once rendered, then the same frames from a folder, which takes less of a computer's time.
            command = ["merge", recipe.parent / "stores", "--recipe"] if round else ["generate"]
            run(*command, recipe, "--out", f"s3://{BUCKET}/{out}", address=proxy.address)
            same(public(bucket, out), whole)
            assert keys(bucket, f"{out}/.trove/") == [
                f"{out}/.trove/frames.jsonl",
                f"{out}/.trove/run.json",
            ]
            if sum(proxy.count.values()) >= FAULTS:
                break
        print(f"{sum(proxy.count.values())} faults in {round + 1} runs: {proxy.count}")
        assert sum(proxy.count.values()) >= FAULTS and min(proxy.count.values()) > 0, proxy.count
    finally:
        proxy.close()


def test_data_and_maps_are_read_from_a_bucket_once(labels, server, bucket, run, tmp_path):
    recipe, whole = labels
    text = recipe.read_text()
    root, osm = (Path(text.split(f'{key} = "')[1].split('"')[0]) for key in ("root", "osm"))
    for path in [path for path in root.rglob("*") if path.is_file()]:
        bucket.upload_file(str(path), BUCKET, f"data/nuscenes/{path.relative_to(root)}")
    bucket.upload_file(str(osm), BUCKET, "data/map.osm")
    text = text.replace(str(root), f"s3://{BUCKET}/data/nuscenes").replace(str(osm), f"s3://{BUCKET}/data/map.osm")
    (tmp_path / "stored.toml").write_text(text)
    run("generate", tmp_path / "stored.toml", "--out", tmp_path / "out")
    found = files(tmp_path / "out")
    labels = [name for name in whole if name.endswith((".png", ".exr", ".npy")) and name != "contact_sheet.png"]
    assert labels and [name for name in labels if found[name] != whole[name]] == []
    # What has not changed is not fetched again: the next run gets on with a server that only tells what there is.
    log = tmp_path / "cache-a" / "fetched"
    before = {path: path.stat().st_mtime_ns for path in log.rglob("*") if path.is_file() and path.name != ".known.json"}
    assert run("generate", tmp_path / "stored.toml", "--out", tmp_path / "out")["rendered"] == 0
    after = {path: path.stat().st_mtime_ns for path in log.rglob("*") if path.is_file() and path.name != ".known.json"}
    assert before == after and before
    # Another map is fetched, and the folder that was made from the old one refuses it.
    bucket.put_object(
        Bucket=BUCKET, Key="data/map.osm", Body=osm.read_bytes().replace(b"</osm>", b"<!-- new --></osm>")
    )
    said = run("generate", tmp_path / "stored.toml", "--out", tmp_path / "out", status=1)
    assert "map.osm" in said and "choose another --out" in said, said


def test_what_cannot_be_reached_or_is_another_s_is_told(labels, server, bucket, run, tmp_path):
    recipe, _ = labels
    said = run("generate", recipe, "--out", "s3://nobody-s/run", status=1)
    assert "s3://nobody-s/run/" in said and "cannot be" in said and "check credentials" in said, said
    bucket.put_object(Bucket=BUCKET, Key="foreign/note.txt", Body=b"mine")
    said = run("generate", recipe, "--out", f"s3://{BUCKET}/foreign", status=1)
    assert "found other objects; choose another --out" in said, said
    assert keys(bucket, "foreign") == ["foreign/note.txt"]
    exports = tmp_path / "exports.toml"
    exports.write_text(recipe.read_text() + '[output]\nformats = ["coco"]\n')
    said = run("generate", exports, "--out", f"s3://{BUCKET}/exports", status=1)
    assert "run trove export on a copy" in said, said
    missing = tmp_path / "missing.toml"
    missing.write_text(recipe.read_text().replace('osm = "', f'osm = "s3://{BUCKET}/none.osm"\n#'))
    said = run("generate", missing, "--out", tmp_path / "out", status=1)
    assert "none.osm: expected an object, or objects below it, found none" in said, said


def test_a_program_without_object_stores_says_so(labels, tmp_path):
    recipe, _ = labels
    plain = shutil.which("trove", path=Path(sys.executable).parent)
    command = [plain, "generate", recipe, "--out", f"s3://{BUCKET}/run"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 1 and "--features object-store" in done.stderr, done.stderr
    assert list(tmp_path.iterdir()) == []
