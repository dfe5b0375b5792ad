"""Starts the Chromium of `make chromium`: what opens our pages in tests, benchmarks and pictures of the documentation."""

import os
import shutil
from pathlib import Path

INSTALLED = Path(__file__).parents[2] / ".tools/chromium/chromium"

# One process: Chromium's own sandbox refuses to start in containers and for root. WebGL is drawn by software.
_ARGUMENTS = [
    "--no-sandbox",
    "--no-zygote",
    "--single-process",
    "--in-process-gpu",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--no-first-run",
]


def program():
    """The browser to start, or None where there is none."""
    return str(INSTALLED) if INSTALLED.is_file() else shutil.which("chromium") or shutil.which("google-chrome")


def command(*arguments):
    """Starts it, with its environment for `subprocess.Popen`; it needs a folder for its profile among the arguments."""
    return [program(), *_ARGUMENTS, *arguments], _environment()


def launch(playwright, *arguments):
    """A Chromium, driven by Playwright; as it is one process, it ends with its first page."""
    return playwright.chromium.launch(
        executable_path=program(), args=[*_ARGUMENTS, *arguments], env=_environment(), timeout=60_000
    )


def _environment():
    return {**os.environ, "LD_LIBRARY_PATH": f"{INSTALLED.parent / 'lib'}:{os.environ.get('LD_LIBRARY_PATH', '')}"}
