"""Speaking to the graph from a process that cannot be taken down by rcl: the speaking is a child."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import threading
from collections.abc import Generator, Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import IO, NamedTuple

from multibot_rewrite.graph.live.request import ENDED, NO_RCLPY, RMW_MISMATCH, Request, to_text
from multibot_rewrite.graph.snapshot import UNKNOWN_NODE, Snapshot, from_json
from multibot_rewrite.model import MultibotError

INSTALL = (
    "source ROS 2 (. /opt/ros/jazzy/setup.bash) or, with Python 3.10 to 3.12,"
    " pip install 'multibot_rewrite[ros]'"
)
LOOK, PLAY = "multibot_rewrite.graph.live.look", "multibot_rewrite.graph.live.play"
# For import and start, for the dear questions in a fleet of 500 nodes, and for tf.
SLACK_SECONDS = 45.0
_PATIENCE = 3.0


class RosUnusable(MultibotError):
    """There is no rclpy, or it does not start; the message says why and what to do."""


class Child(NamedTuple):
    """A process of ours that speaks to the graph, and what it says besides its messages."""

    process: subprocess.Popen[bytes]
    errors: IO[bytes]
    environ: Mapping[str, str]

    def next(self) -> bytes | None:
        """Its next message, or None where it ended well; raises RosUnusable where it did not."""
        assert self.process.stdout is not None
        length = self.process.stdout.readline()
        data = self.process.stdout.read(int(length)) if length else b""
        if length and len(data) == int(length):
            return data
        code = self.process.wait()
        if code == 0:
            return None
        self.errors.seek(0)
        said = self.errors.read().decode("utf-8", "replace")
        raise RosUnusable(_explained(code, said, self.environ))


def observe(request: Request, environ: Mapping[str, str]) -> Snapshot:
    """A snapshot of the graph that ``environ`` leads to; raises RosUnusable.

    No process is left behind, whatever ends this call.
    """
    seen = _observe(request, environ)
    # A node killed while it was looked at stays for 20 s; who looks anew does not see it.
    return _observe(request, environ) if _haunted(seen) else seen


def _haunted(seen: Snapshot) -> bool:
    """Whether a dead node may be in the view: under a name that is there again, or without one."""
    names = [node.name for node in seen.nodes]
    nameless = any(UNKNOWN_NODE in end.node for end in seen.endpoints)
    return nameless or len(set(names)) < len(names)


def _observe(request: Request, environ: Mapping[str, str]) -> Snapshot:
    limit = request.timeout + SLACK_SECONDS
    with running(LOOK, to_text(request), environ, limit) as child:
        data = child.next()
    assert data is not None
    return from_json(data, "the view of the graph")


def watch(request: Request, environ: Mapping[str, str]) -> Generator[Snapshot, None, None]:
    """Snapshots of the graph for ``request.timeout`` seconds, one whenever something changed.

    Raises RosUnusable. No process is left behind once the iterator is closed.
    """
    order = to_text(request._replace(watch=True))
    with running(LOOK, order, environ) as child:
        seconds = min(request.timeout, threading.TIMEOUT_MAX)
        end = threading.Timer(seconds, child.process.terminate)
        end.daemon = True
        end.start()
        while (data := child.next()) is not None:
            yield from_json(data, "the view of the graph")
        end.cancel()


@contextmanager
def running(
    module: str, order: str, environ: Mapping[str, str], seconds: float | None = None
) -> Iterator[Child]:
    """The child, told its order; ends with the block, and after ``seconds`` at the latest."""
    command = [sys.executable, "-m", module]
    pipe = subprocess.PIPE
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=errors, env=environ)
        limit = threading.Timer(seconds or threading.TIMEOUT_MAX, process.kill)
        limit.daemon = True
        limit.start()
        try:
            _tell(process, order)
            yield Child(process, errors, environ)
        finally:
            limit.cancel()
            _end(process)


def _tell(process: subprocess.Popen[bytes], order: str) -> None:
    assert process.stdin is not None
    try:
        process.stdin.write(f"{order}\n".encode())
        process.stdin.flush()
    except BrokenPipeError:
        # It ended before it read: its exit code says why.
        return


def _end(process: subprocess.Popen[bytes]) -> None:
    """Ask, insist, force: a clean end takes it out of everybody's view at once."""
    assert process.stdin is not None and process.stdout is not None
    # What was not sent to a process that is gone does not matter.
    with suppress(BrokenPipeError):
        process.stdin.close()
    for insist in (process.terminate, process.kill):
        try:
            process.wait(_PATIENCE)
            break
        except subprocess.TimeoutExpired:
            insist()
    process.wait()
    process.stdout.close()


def _explained(code: int, said: str, environ: Mapping[str, str]) -> str:
    """Why the child ended with ``code``, in one line with what to do."""
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    # rclpy ends its reason with lines of places.
    last = next((line for line in reversed(lines) if not line.startswith(",")), "it said nothing")
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
