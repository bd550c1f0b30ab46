# SPDX-License-Identifier: Apache-2.0
"""``python -m multibot_rewrite`` is ``multibot``."""

from __future__ import annotations

import sys

from multibot_rewrite.cli.entry import multibot

if __name__ == "__main__":
    sys.exit(multibot())
