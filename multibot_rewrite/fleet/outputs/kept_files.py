"""Files that nodes of a launch script read: there while the script runs."""

from __future__ import annotations

import os
from tempfile import TemporaryDirectory


class KeptFiles:
    """Files in a folder that is made with the first of them, and goes when the process ends."""

    def __init__(self) -> None:
        self._folder: TemporaryDirectory[str] | None = None

    def path(self, robot: str, file: str, text: str) -> str:
        """The path of a robot's file with this text; raises OSError where none can be written."""
        if self._folder is None:
            self._folder = TemporaryDirectory(prefix="multibot_")
        path = os.path.join(self._folder.name, robot, os.path.basename(file))
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as out:
            out.write(text.encode())
        return path
