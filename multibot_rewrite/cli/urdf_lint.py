# SPDX-License-Identifier: Apache-2.0
"""``urdf-lint``: the command; ``lint`` does it."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from multibot_rewrite.cli.declared.commands import read_command
from multibot_rewrite.cli.process import run_alone


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code."""
    return run_alone(read_command("urdf-lint"), arguments)


if __name__ == "__main__":
    sys.exit(main())
