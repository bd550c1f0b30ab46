"""Photographs the pages that the commands write: ``python docs/site/screenshots.py``, with chromium.

The view of the launch tutorial's fleet, and the report of a check that finds something.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "pictures"
FLEET = "examples/launch_tutorial/fleet.yaml"
CHECK = ("check", "fixtures/graphs/plan.yaml", "--snapshot", "fixtures/graphs/MG402.json")
# A file of docs/pictures -> the command that writes the page, and how large the window is.
PAGES = {
    "view.png": (("view", FLEET, "-o"), (1200, 640)),
    "report.png": ((*CHECK, "--report"), (1200, 900)),
}
BROWSERS = ("chromium", "google-chrome")
FLAGS = (
    "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--hide-scrollbars", "--virtual-time-budget=5000",
)  # fmt: skip


def photograph(browser: str, name: str, folder: Path) -> Path:
    """Write the page, and the picture of it with few colours."""
    words, size = PAGES[name]
    page, picture = folder / f"{name}.html", FOLDER / name
    command = [sys.executable, "-m", "multibot_rewrite.cli.multibot", *words, str(page)]
    subprocess.run(command, cwd=ROOT, check=words[0] == "view", capture_output=True)
    window = f"--window-size={size[0]},{size[1]}"
    shot = [browser, *FLAGS, window, f"--screenshot={picture}", page.as_uri()]
    subprocess.run(shot, check=True, capture_output=True)
    Image.open(picture).convert("RGB").quantize(64, dither=0).save(picture, optimize=True)
    return picture


def main() -> None:
    """Make them all."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        sys.exit("no chromium on the PATH")
    with tempfile.TemporaryDirectory() as folder:
        for name in PAGES:
            made = photograph(browser, name, Path(folder))
            print(f"{made.relative_to(ROOT)}: {made.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
