"""``multibot``: the commands around the rewrite; ``dispatch`` runs them."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import partial

from multibot_rewrite.cli.dispatch import run
from multibot_rewrite.cli.process import PROGRAM, guarded


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command; returns the exit code."""
    words = sys.argv[1:] if arguments is None else arguments
    return guarded(PROGRAM, partial(run, words), own_process=arguments is None)


if __name__ == "__main__":
    sys.exit(main())
