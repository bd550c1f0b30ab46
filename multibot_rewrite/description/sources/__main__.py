# SPDX-License-Identifier: Apache-2.0
"""Print which fences this system has for xacro files.

``python -I -m multibot_rewrite.description.sources``
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from multibot_rewrite.description.sources.access import BOUNDED, Access
from multibot_rewrite.description.sources.child.frames import FENCES
from multibot_rewrite.description.sources.conversation import Sources, converse

_FILE = b'<robot name="r"/>'


def main() -> None:
    """Expand a file, and print what its process had around it."""
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "r.xacro")
        held = converse({}, Sources(Access(path, BOUNDED, None), {path: _FILE}), False).fences
    for name in FENCES:
        sys.stdout.write(f"{name}: {'yes' if name in held else 'no'}\n")


if __name__ == "__main__":
    main()
