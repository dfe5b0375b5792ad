"""The drivers for several machines, as far as one machine can try them; `make test-cluster` installs what they need."""

import contextlib
import copy
import getpass
import importlib.util
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest
from conftest import files, trove

CLUSTER = Path(__file__).parents[2] / "examples" / "cluster"
KUBERNETES = "1.33"  # backoffLimitPerIndex is stable there
PROGRAM = Path(sys.executable).parent / "trove"

needs_ray = pytest.mark.skipif(importlib.util.find_spec("ray") is None, reason="needs Ray: make test-cluster")


@pytest.fixture(scope="module")
def labels(recipe):
    """A quick recipe of labels, and the files of one run of it."""
    text = recipe.read_text().replace('rig = ["CAM_FRONT", "CAM_BACK"]\nother_vehicles = 1', 'rig = "CAM_FRONT"')
    path = recipe.parent / "cluster.toml"
    text = text.replace("keyframes = [1, 2]", "keyframes = [1, 2, 3, 4]")
    path.write_text(text + "light = false\n[variations]\ncount = 2\n")
    out = recipe.parent / "cluster"
    done = trove("generate", path, "--out", out)
    assert done.returncode == 0, done.stderr
    return path, files(out)


@pytest.fixture
def machines(tmp_path):
    """A PATH on which ssh runs everything here and writes down for whom."""
    ssh = tmp_path / "bin" / "ssh"
    ssh.parent.mkdir()
    ssh.write_text(f'#!/bin/sh\n[ "$1" = -n ]\necho "$2" >> {tmp_path}/asked\nshift 2\nexec "$@"\n')
    ssh.chmod(0o755)
    return {**os.environ, "PATH": f"{ssh.parent}:{os.environ['PATH']}", "TROVE": str(PROGRAM)}


@pytest.mark.parametrize("hosts", [[], ["one", "two"]])
def test_the_shell_loop_makes_the_bytes_of_one_run(labels, machines, tmp_path, hosts):
    recipe, whole = labels
    command = [CLUSTER / "shell.sh", recipe, tmp_path / "out", *hosts]
    done = subprocess.run(
        command, env={**machines, "PARTS": "3"}, capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0, done.stderr
    assert files(tmp_path / "out") == whole
    if hosts:
        assert sorted((tmp_path / "asked").read_text().split()) == ["one", "one", "two"]


def test_the_container_counts_parts_from_one(tmp_path):
    entry = (CLUSTER / "Dockerfile").read_text().split("ENTRYPOINT ", 1)[1]
    program = tmp_path / "trove"
    program.write_text('#!/bin/sh\necho "$@"\n')
    program.chmod(0o755)
    common = {"PATH": f"{tmp_path}:{os.environ['PATH']}", "RECIPE": "/data/r.toml", "OUT": "/data/out"}

    def said(**environment):
        return subprocess.run(json.loads(entry), env={**common, **environment}, capture_output=True, text=True).stdout

    assert said() == "generate /data/r.toml --out /data/out\n"
    expected = "generate /data/r.toml --out /data/out --part {}/64\n"
    assert said(PARTS="64", JOB_COMPLETION_INDEX="0") == expected.format(1)
    assert said(PARTS="64", AWS_BATCH_JOB_ARRAY_INDEX="63") == expected.format(64)


def test_the_kubernetes_jobs_are_valid():
    yaml = pytest.importorskip("yaml")
    validate = pytest.importorskip("kubernetes_validate", reason="make test-cluster").validate
    parts, merge = yaml.safe_load_all((CLUSTER / "kubernetes.yaml").read_text())
    for job in (parts, merge):
        validate(job, KUBERNETES, strict=True)
    wrong = copy.deepcopy(parts)
    wrong["spec"]["completion"] = wrong["spec"].pop("completions")
    with pytest.raises(Exception, match="completion"):
        validate(wrong, KUBERNETES, strict=True)

    def environment(job):
        [container] = job["spec"]["template"]["spec"]["containers"]
        return {entry["name"]: entry["value"] for entry in container["env"]}

    assert environment(parts).pop("PARTS") == str(parts["spec"]["completions"])
    assert environment(merge) == {name: value for name, value in environment(parts).items() if name != "PARTS"}


def test_the_jobs_for_aws_batch_are_valid():
    session = pytest.importorskip("botocore.session", reason="make test-cluster").get_session()
    from botocore.validate import validate_parameters

    jobs = json.loads((CLUSTER / "aws-batch.json").read_text())
    batch = session.get_service_model("batch")
    for name, operation in [("definition", "RegisterJobDefinition"), ("parts", "SubmitJob"), ("merge", "SubmitJob")]:
        validate_parameters(jobs[name], batch.operation_model(operation).input_shape)
    assert [entry["value"] for entry in jobs["parts"]["containerOverrides"]["environment"]] == [
        str(jobs["parts"]["arrayProperties"]["size"])
    ]


@pytest.fixture
def cluster():
    """A Ray cluster of two nodes on the loopback, each a core; its address."""
    import ray

    port = 20_000 + os.getpid() % 10_000
    program, common = shutil.which("ray"), ["--num-cpus=1", "--disable-usage-stats", "--block"]
    # What a node of its own has: names of files, and ports. Names of sockets may not be long.
    folder = Path(tempfile.mkdtemp(prefix="ray"))
    head = ["start", "--head", f"--port={port}", "--include-dashboard=false", f"--temp-dir={folder}"]
    nodes = [subprocess.Popen([program, *head, *common], stdout=subprocess.DEVNULL, start_new_session=True)]
    address = f"127.0.0.1:{port}"
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline:
        try:
            ray.init(address=address, log_to_driver=False)
            break
        except Exception:
            assert nodes[0].poll() is None, "the head has ended"
            time.sleep(1)
    second = [program, "start", f"--address={address}", *common]
    nodes.append(subprocess.Popen(second, stdout=subprocess.DEVNULL, start_new_session=True))
    while sum(node["Alive"] for node in ray.nodes()) < 2 and time.monotonic() < deadline:
        time.sleep(1)
    assert sum(node["Alive"] for node in ray.nodes()) == 2
    ray.shutdown()
    yield address
    for node in nodes:
        os.killpg(node.pid, signal.SIGKILL)
        node.wait()
    shutil.rmtree(folder, ignore_errors=True)


@needs_ray
def test_two_ray_nodes_make_the_bytes_of_one_run_though_a_task_is_killed(labels, cluster, tmp_path):
    recipe, whole = labels
    out = tmp_path / "out"
    command = [sys.executable, "-m", "trove.ray", recipe, "--out", out, "--address", cluster, "--parts", "4"]
    driver = subprocess.Popen(
        [*command, "--every", "0.1"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    killed = None
    while killed is None and driver.poll() is None:
        locks = [lock for lock in out.glob(".trove/parts/*/lock") if lock.parent.joinpath("frames.jsonl").exists()]
        killed = next((pid for lock in locks for pid in holding(lock)), None)
        time.sleep(0.01)
    os.kill(killed, signal.SIGKILL)
    said, told = driver.communicate(timeout=600)
    assert driver.returncode == 0, told
    assert "4 parts, 2 at once with 1 threads each" in told and "8 frames" in said and " frames" in told
    assert files(out) == whole


def holding(path):
    """Processes that hold a file open."""
    for descriptor in Path("/proc").glob("[0-9]*/fd/*"):
        with contextlib.suppress(OSError):
            if descriptor.readlink() == path:
                yield int(descriptor.parts[2])


SLURM = ("slurmctld", "slurmd", "munged", "sbatch")


@contextlib.contextmanager
def slurm(folder):
    """A controller and a node of Slurm on the loopback; their configuration."""
    host, port = socket.gethostname().split(".")[0], 30_000 + os.getpid() % 10_000
    configuration, munge = folder / "slurm.conf", folder / "munge"
    munge.mkdir(mode=0o711)
    (munge / "key").write_bytes(os.urandom(128))
    (munge / "key").chmod(0o400)
    configuration.write_text(f"""
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmdPort={port + 1}
SlurmUser={getpass.getuser()}
AuthType=auth/munge
AuthInfo=socket={munge}/socket
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
MpiDefault=none
MailProg=/bin/true
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
""")
    for name in ("state", "spool"):
        (folder / name).mkdir()
    paths = [
        f"--{what}={munge}/{what.split('-')[0]}" for what in ("key-file", "socket", "pid-file", "log-file", "seed-file")
    ]
    daemons = [["munged", "--foreground", "--force", *paths], ["slurmctld", "-D", "-c", "-f", configuration]]
    daemons.append(["slurmd", "-D", "-f", configuration])
    running = []
    try:
        for daemon in daemons:
            log = (folder / f"{daemon[0]}.log").open("w")
            running.append(subprocess.Popen(daemon, stdout=log, stderr=log, start_new_session=True))
            time.sleep(1)
        yield configuration
    finally:
        for daemon in reversed(running):
            os.killpg(daemon.pid, signal.SIGTERM)
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                os.killpg(daemon.pid, signal.SIGKILL)


@pytest.mark.skipif(not all(shutil.which(name) for name in SLURM), reason="needs Slurm: apt install slurm-wlm")
def test_a_slurm_job_array_makes_the_bytes_of_one_run(labels, tmp_path):
    recipe, whole = labels
    environment = {**os.environ, "TROVE": str(PROGRAM)}
    with slurm(tmp_path) as configuration:
        environment["SLURM_CONF"] = str(configuration)
        command = [CLUSTER / "slurm.sh", recipe, tmp_path / "out", "3"]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 0, done.stderr
        deadline = time.monotonic() + 500
        while not (tmp_path / "out" / "manifest.json").exists() and time.monotonic() < deadline:
            time.sleep(1)
    logs = "".join(path.read_text() for path in tmp_path.glob("out-*.log"))
    assert (tmp_path / "out" / "manifest.json").exists(), logs
    assert len(list(tmp_path.glob("out-[0-9].log"))) == 3
    assert files(tmp_path / "out") == whole
