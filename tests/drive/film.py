# SPDX-License-Identifier: Apache-2.0
"""A short film: two robots of an example in one MuJoCo scene, each driven by its own cmd_vel.

``python tests/drive/film.py``, with rclpy, mujoco and pillow, writes docs/pictures/two-robots.gif.
It is the scene of ``test_live_physics.py``: the folder is built by the command, and what moves a robot
is a message on the topic that is written in the picture.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
FILM = ROOT / "docs" / "pictures" / "two-robots.gif"
WIDTH, HEIGHT = 480, 270
# One picture for so many turns of the scene, which are 0.04 s each.
EVERY = 4
# The rover is four times as heavy as the base of the tests.
STRONG = 0.15
COLOURS = ((0.30, 0.47, 0.70, 1), (0.90, 0.52, 0.20, 1))
GROUND = (0.62, 0.66, 0.72, 1)
BLACK = (0.12, 0.12, 0.13, 1)


class Film:
    """Pictures of a scene, with the topic that is sent on."""

    def __init__(self, model: Any, robots: Sequence[str]) -> None:
        import mujoco

        self.renderer = mujoco.Renderer(model, HEIGHT, WIDTH)
        self.camera = mujoco.MjvCamera()
        self.camera.lookat[:], self.camera.distance = (0.6, 0, 0), 2.7
        self.camera.azimuth, self.camera.elevation = 140, -38
        model.vis.headlight.ambient[:], model.vis.headlight.diffuse[:] = 0.45, 0.6
        self.pictures: list[Any] = []
        for at in range(model.ngeom):
            body = model.body(model.geom_bodyid[at]).name
            robot, _, link = body.partition(":")
            if not link:
                model.geom_rgba[at] = GROUND
            else:
                dark = "wheel" in link or model.geom_type[at] != mujoco.mjtGeom.mjGEOM_BOX
                model.geom_rgba[at] = BLACK if dark else COLOURS[robots.index(robot)]

    def take(self, data: Any, words: str) -> None:
        from PIL import Image, ImageDraw

        self.renderer.update_scene(data, self.camera)
        picture = Image.fromarray(self.renderer.render())
        ImageDraw.Draw(picture).text((12, 10), words, fill="black", font_size=17)
        self.pictures.append(picture)

    def write(self, path: str) -> None:
        first, *others = (it.quantize(48, dither=0) for it in self.pictures)
        first.save(path, save_all=True, append_images=others, duration=120, loop=0, optimize=True)


def main() -> None:
    """Build, drive one robot and then the other, write the film."""
    sys.path[:0] = [str(ROOT / "tests" / "support"), str(Path(__file__).parent)]
    os.environ.setdefault("MUJOCO_GL", "egl")
    import scenes

    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        found = scenes.built("launch_tutorial", out)
        robots = [
            scenes.base(found, it, out / it / "rover.urdf", at)
            for it, at in (("robot1", 0.0), ("robot2", 0.0))
        ]
        robots[0]["at"], robots[1]["at"] = [0, -0.4], [0, 0.4]
        for it in robots:
            it["motor"] = STRONG
        one, two = (it["commands"] for it in robots)
        turns = ((one, [0.22, -0.2]), (one, [0, 0]), (two, [0.22, 0.2]), (two, [0, 0]))
        send = [(topic, "Twist", values) for topic, values in turns]
        scenes.played(120, robots, *send, film=str(FILM))
    print(f"{FILM.relative_to(ROOT)}: {FILM.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
