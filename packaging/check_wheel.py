"""Installs a wheel into a fresh environment, as a user would, and runs it: what is in it, and how soon there is a picture.

python packaging/check_wheel.py dist/trove_scenes-*.whl
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
import venv
import zipfile
from pathlib import Path

# From the beginning of the installation to the demo's first picture.
MOST_SECONDS = 120
HELD = (
    "trove/_trove.abi3.so",
    "trove/_trove.pyi",
    "trove/py.typed",
    "trove/torch.py",
    "trove/human_body/LICENSE.md",
    "trove/human_body/3dobjs/base.obj",
    "trove/schema/frame.schema.json",
    "trove/LICENCES-OF-OTHERS.txt",
)
LICENCES = ("LICENSE-MIT", "LICENSE-APACHE")
USE = """
import sys, trove
frames = trove.open(sys.argv[1])
frame = frames[0]
assert frame.rgb.shape == frame.class_.shape + (3,) and frame.objects and trove.verify(sys.argv[1])["damaged"] == []
"""


def contents(wheel: Path) -> None:
    """Checks which files are in it."""
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    missing = [name for name in HELD if name not in names]
    missing += [name for name in LICENCES if not any(held.endswith(f".dist-info/licenses/{name}") for held in names)]
    if missing:
        raise SystemExit(f"{wheel}: expected {', '.join(missing)} in it; build it by make wheel")
    if any("/tests/" in name for name in names):
        raise SystemExit(f"{wheel}: expected no tests in it")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wheel", type=Path)
    wheel = parser.parse_args().wheel
    contents(wheel)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        venv.create(folder / "venv", with_pip=True)
        python = folder / "venv" / "bin" / "python"
        # Nothing of this machine's: no cache of the library, no body or kernel from elsewhere.
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("TROVE_", "PYTHON"))}
        environment["TROVE_CACHE"] = str(folder / "cache")

        def run(*command: object) -> str:
            done = subprocess.run([*map(str, command)], capture_output=True, text=True, env=environment, cwd=folder)
            if done.returncode != 0:
                raise SystemExit(f"{' '.join(map(str, command))}:\n{done.stdout}{done.stderr}")
            return done.stdout

        started = time.monotonic()
        run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", wheel.resolve())
        installed_s = time.monotonic() - started
        out = folder / "demo-out"
        demo = subprocess.Popen([folder / "venv/bin/trove", "demo", "--out", out], env=environment, stderr=sys.stderr)
        while demo.poll() is None and not any(out.glob("*/v00/*/*/rgb.png")):
            time.sleep(0.1)
        first_s = time.monotonic() - started
        if demo.wait() != 0:
            raise SystemExit("trove demo has failed")
        doctor = json.loads(run(folder / "venv/bin/trove", "doctor", "--json"))
        if not str(doctor["human_body"]).startswith(str(folder)) or doctor["denoiser"] is None:
            raise SystemExit(f"trove doctor: expected the wheel's body and a denoiser, found {doctor}")
        report = json.loads((out / "report.json").read_text(encoding="utf-8"))
        tables = [report["run"], *report["scenes"]]
        plainer = [row for table in tables for row in table["entries"] if "plainer figures" in row["what"]]
        if plainer:
            raise SystemExit(f"trove demo: expected people made from the body, found {plainer}")
        run(python, "-c", USE, out)
    print(
        f"{wheel.name}, {wheel.stat().st_size / 1e6:.0f} MB: installed after {installed_s:.0f} s, first picture after {first_s:.0f} s"
    )
    if first_s > MOST_SECONDS:
        raise SystemExit(f"expected the first picture after {MOST_SECONDS} s at most")


if __name__ == "__main__":
    main()
