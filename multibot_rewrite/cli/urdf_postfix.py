"""``urdf-postfix``: the command; ``rewrite`` does it."""

from __future__ import annotations

import gc
import sys
from collections.abc import Sequence
from functools import partial

from multibot_rewrite.cli.declared.description import POSTFIX
from multibot_rewrite.cli.process import guarded, start


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code."""
    if arguments is None:
        # A short process of its own: nothing it makes needs the collector of cycles.
        gc.disable()
    words = sys.argv[1:] if arguments is None else arguments
    return guarded(POSTFIX.name, partial(start, POSTFIX, words), own_process=arguments is None)


if __name__ == "__main__":
    sys.exit(main())
