"""Frames a second of two Ray nodes with a core each, against one run on two threads; see benches/README.md.

Both sides render the same recipe in the same run of this program, Ray's with the start of its driver and the merging.
"""

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

RECIPE = """
seed = 7
[drive]
dataset = "nuscenes"
root = "{data}/nuscenes"
scenes = ["scene-0103"]
keyframes = [10, 11, 12, 13]
[map]
osm = "{data}/osm/boston-seaport.osm"
[render]
scale = 0.25
spp = {spp}
"""


def nodes(folder):
    """Two nodes on the loopback; their address and processes."""
    program, port = shutil.which("ray"), 20_000 + os.getpid() % 10_000
    address, common = f"127.0.0.1:{port}", ["--num-cpus=1", "--disable-usage-stats", "--block"]
    head = [program, "start", "--head", f"--port={port}", "--include-dashboard=false", f"--temp-dir={folder}", *common]
    started = [subprocess.Popen(head, stdout=subprocess.DEVNULL, start_new_session=True)]
    time.sleep(15)
    second = [program, "start", f"--address={address}", *common]
    started.append(subprocess.Popen(second, stdout=subprocess.DEVNULL, start_new_session=True))
    import ray

    ray.init(address=address, log_to_driver=False)
    while sum(node["Alive"] for node in ray.nodes()) < 2:
        time.sleep(1)
    ray.shutdown()
    return address, started


def timed(command):
    begun = time.monotonic()
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.monotonic() - begun


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--parts", type=int, default=2, help="parts; each builds the scene")
    parser.add_argument("--spp", type=int, default=32)
    options = parser.parse_args()
    data = os.environ.get("TROVE_TEST_DATA")
    if data is None:
        parser.error("TROVE_TEST_DATA: expected the folder with real data, found nothing set")
    with tempfile.TemporaryDirectory(prefix="ray") as folder:
        recipe = Path(folder) / "recipe.toml"
        recipe.write_text(RECIPE.format(data=Path(data).absolute(), spp=options.spp))
        alone, spread = Path(folder) / "alone", Path(folder) / "spread"
        one_s = timed([sys.executable, "-m", "trove", "generate", recipe, "--out", alone, "--threads", 2])
        address, started = nodes(Path(folder) / "r")
        try:
            command = [sys.executable, "-m", "trove.ray", recipe, "--out", spread, "--address", address]
            two_s = timed([*command, "--parts", options.parts])
        finally:
            for node in started:
                os.killpg(node.pid, signal.SIGKILL)
                node.wait()
        frames = len(list(alone.glob("*/v*/k*/*/frame.json")))
        assert frames == len(list(spread.glob("*/v*/k*/*/frame.json")))
    print(f"two threads: {frames / one_s:.3f} frames/s ({one_s:.0f} s for {frames} frames)")
    print(f"two Ray nodes, {options.parts} parts: {frames / two_s:.3f} frames/s ({two_s:.0f} s)")
    print(f"ratio: {one_s / two_s:.2f}")


if __name__ == "__main__":
    main()
