# SPDX-License-Identifier: Apache-2.0
"""Photographs the pages that the commands write: ``python docs/site/screenshots.py``, with chromium.

Four of the README's robots, the report of a check that finds something, and that of twenty robots.
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
ROVER = ROOT / "examples" / "launch_tutorial" / "rover.urdf"  # copied beside the page
GRAPHS = ROOT / "fixtures" / "graphs"
# A file of docs/pictures -> how large the window is, and commands; the last one writes the page.
PAGES = {
    "view.png": (
        (1200, 640),
        "init rover.urdf -n 4 -o four.yaml",
        "view four.yaml -o view.png.html",
    ),
    "report.png": (
        (1200, 900),
        f"check {GRAPHS}/plan.yaml --from {GRAPHS}/MG402.json --report report.png.html",
    ),
    "report-20.png": (
        (1200, 900),
        "init rover.urdf -n 20 -o fleet.yaml",
        "build fleet.yaml",
        "check-launch out/fleet.launch.py --plan fleet.yaml --report report-20.png.html",
    ),
}
BROWSERS = ("chromium", "google-chrome")
FLAGS = (
    "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--hide-scrollbars", "--virtual-time-budget=5000",
)  # fmt: skip


def photograph(browser: str, name: str, folder: Path) -> Path:
    """Write the page, and the picture of it with few colours."""
    size, *commands = PAGES[name]
    page, picture = folder / f"{name}.html", FOLDER / name
    for line in commands:
        command = [sys.executable, "-m", "multibot_rewrite", *line.split()]
        done = subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            sys.exit(f"multibot {line}: {done.stderr}")
    window = f"--window-size={size[0]},{size[1]}"
    shot = [browser, *FLAGS, window, f"--screenshot={picture}", page.as_uri()]
    subprocess.run(shot, check=True, capture_output=True)
    Image.open(picture).convert("RGB").quantize(200, dither=0).save(picture, optimize=True)
    return picture


def main() -> None:
    """Make them all."""
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        sys.exit("no chromium on the PATH")
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(ROVER, folder)
        for name in PAGES:
            made = photograph(browser, name, Path(folder))
            print(f"{made.relative_to(ROOT)}: {made.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
