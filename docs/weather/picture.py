"""Makes a picture of docs/weather from its recipe; see the Makefile."""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

HERE = Path(__file__).resolve().parent


def main():
    recipe, data, picture = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        text = Path(recipe).read_text().replace('"../../data/', f'"{Path(data).resolve()}/')
        moved = Path(folder) / "recipe.toml"
        moved.write_text(text.replace('"camera.toml"', f'"{HERE / "camera.toml"}"'))
        out = Path(folder) / "out"
        command = [sys.executable, "-m", "trove", "generate", moved, "--out", out, "--frames", HERE / "view.json"]
        subprocess.run(command, check=True)
        (rgb,) = out.rglob("rgb.png")
        Image.open(rgb).save(picture, quality=88)


if __name__ == "__main__":
    main()
