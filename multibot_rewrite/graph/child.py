"""Looking at the graph from a process that cannot be taken down by rcl: the looking is a child."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import IO

from multibot_rewrite.graph.request import ENDED, NO_RCLPY, RMW_MISMATCH, Request, to_text
from multibot_rewrite.graph.snapshot import Snapshot, from_json
from multibot_rewrite.model import MultibotError

INSTALL = (
    "source ROS 2 (. /opt/ros/jazzy/setup.bash) or, with Python 3.10 to 3.12,"
    " pip install 'multibot_rewrite[ros]'"
)
# For import and start, for the dear questions in a fleet of 500 nodes, and for tf.
SLACK_SECONDS = 45.0
_PATIENCE = 3.0


class RosUnusable(MultibotError):
    """There is no rclpy, or it does not start; the message says why and what to do."""


def observe(request: Request, environ: Mapping[str, str]) -> Snapshot:
    """A snapshot of the graph that ``environ`` leads to; raises RosUnusable.

    No process is left behind, whatever ends this call.
    """
    command = [sys.executable, "-m", "multibot_rewrite.graph.ros", to_text(request)]
    with tempfile.TemporaryFile() as errors:
        with _running(command, environ, errors, request.timeout + SLACK_SECONDS) as child:
            assert child.stdout is not None
            data = child.stdout.read()
            code = child.wait()
        if code == 0:
            return from_json(data, "the view of the graph")
        errors.seek(0)
        raise RosUnusable(_explained(code, errors.read().decode("utf-8", "replace"), environ))


@contextmanager
def _running(
    command: list[str], environ: Mapping[str, str], errors: IO[bytes], seconds: float
) -> Iterator[subprocess.Popen[bytes]]:
    """The child, which ends with the block and after ``seconds`` at the latest."""
    pipe = subprocess.PIPE
    child = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=errors, env=environ)
    limit = threading.Timer(seconds, child.kill)
    limit.daemon = True
    limit.start()
    try:
        yield child
    finally:
        limit.cancel()
        _end(child)


def _end(child: subprocess.Popen[bytes]) -> None:
    """Ask, insist, force: a clean end takes it out of everybody's view at once."""
    assert child.stdin is not None and child.stdout is not None
    child.stdin.close()
    for insist in (child.terminate, child.kill):
        try:
            child.wait(_PATIENCE)
            break
        except subprocess.TimeoutExpired:
            insist()
    child.wait()
    child.stdout.close()


def _explained(code: int, said: str, environ: Mapping[str, str]) -> str:
    """Why the child ended with ``code``, in one line with what to do."""
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    last = lines[-1] if lines else "it said nothing"
    if code == NO_RCLPY:
        return f"rclpy cannot be imported ({last}); {INSTALL}"
    if code == RMW_MISMATCH:
        wanted = environ.get("RMW_IMPLEMENTATION", "")
        remedy = "unset it, or install that RMW beside rclpy"
        return f"RMW_IMPLEMENTATION={wanted!r} is not what this rclpy comes with; {remedy}"
    if code == ENDED:
        return f"the look at the graph was ended from outside; start it again. It said: {last}"
    if code < 0:
        return f"rclpy was ended by signal {-code} or did not answer in time; it said: {last}"
    return f"rclpy does not start (exit code {code}): {last}; {INSTALL}"
