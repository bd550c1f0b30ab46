# SPDX-License-Identifier: Apache-2.0
"""Public calls at once, a thread each, in a process that has made nothing yet: a list of jobs as JSON
in, what each gives out. Run by ``test_threads``.
"""

from __future__ import annotations

import json
import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import Any

# So short that threads are changed in the middle of everything.
SWITCH_SECONDS = 1e-6
# The name of a public call, a description and the options.
Job = tuple[str, str, dict[str, Any]]


def outcome(call: str, source: str, options: dict[str, Any]) -> list[str]:
    """Text and findings, or the error."""
    import multibot_rewrite as package

    try:
        made = getattr(package, call)(source.encode(), robot="robot1", **options)
    except package.MultibotError as error:
        return [type(error).__name__, str(error)]
    return [made.decode()] if call == "strip" else [made.text, *map(str, made.findings)]


def main(jobs: list[Job]) -> list[list[str]]:
    """All jobs at once: none starts before each has its thread."""
    start = Barrier(len(jobs))

    def work(job: Job) -> list[str]:
        start.wait()
        return outcome(*job)

    with ThreadPoolExecutor(len(jobs)) as pool:
        return list(pool.map(work, jobs))


if __name__ == "__main__":
    sys.setswitchinterval(SWITCH_SECONDS)
    json.dump(main(json.load(sys.stdin)), sys.stdout)
