"""``python -m multibot_rewrite.lint``: the page of rules."""

from __future__ import annotations

import sys

from multibot_rewrite.lint.words import page

if __name__ == "__main__":
    sys.stdout.write(page())
