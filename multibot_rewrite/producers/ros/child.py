# SPDX-License-Identifier: Apache-2.0
"""The command's side of the child processes that use rclpy.

rcl may end its process, so the command never loads it.
"""

import json
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from queue import SimpleQueue
from typing import IO, NamedTuple

from multibot_rewrite.base.child import python, variables
from multibot_rewrite.base.model import Unusable
from multibot_rewrite.producers.ros.request import (
    ENDED,
    NO_RCLPY,
    RMW_MISMATCH,
    SO_FAR,
    Request,
    to_text,
)
from multibot_rewrite.system.json import from_json
from multibot_rewrite.system.parameters import Answer, Question
from multibot_rewrite.system.record_values import record_from
from multibot_rewrite.system.records import UNKNOWN_NODE, ZENOH, Caveat, System

INSTALL = (
    "source ROS 2 (. /opt/ros/jazzy/setup.bash) or, on Linux, pip install 'multibot_rewrite[ros]'"
)
OBSERVE, RUN_STUBS = "multibot_rewrite.producers.ros.observe", "multibot_rewrite.live.stub_nodes"
ASK = "multibot_rewrite.producers.ros.ask"
# For import and start, and for an end on a busy machine: the child keeps to the timeout by itself.
SLACK_SECONDS = 30.0
NO_SECOND_LOOK = (
    "two nodes have one name, or a node has none: one of them may be dead, and there was no time for a"
    " second look; give a longer --timeout"
)
_EXIT_SECONDS = 3.0


class RosProcess(NamedTuple):
    """A child process that uses rclpy; ``errors`` is its standard error."""

    process: subprocess.Popen[bytes]
    errors: IO[bytes]
    environ: Mapping[str, str]

    def next_message(self) -> bytes | None:
        """Return the next message, or None at the end; raises Unusable if the process failed."""
        assert self.process.stdout is not None
        length = self.process.stdout.readline()
        data = self.process.stdout.read(int(length)) if length else b""
        if length and len(data) == int(length):
            return data
        code = self.process.wait()
        if code == 0:
            return None
        self.errors.seek(0)
        output = self.errors.read().decode("utf-8", "replace")
        raise Unusable(_explain(code, output, self.environ))


def observe(
    request: Request,
    environ: Mapping[str, str],
    tell: Callable[[str | System], None] = lambda _: None,
) -> System:
    """Return a snapshot of the graph with the variables of ``environ``; raises Unusable.

    ``tell`` gets what is seen while the graph is waited for, in words, and as a view that may be
    incomplete. No process is left running, however this call ends."""
    began = time.monotonic()
    seen = _observe_once(request, environ, tell)
    names = [node.name for node in seen.nodes]
    # There may be dead nodes where a name occurs twice, or one is unknown.
    nameless = any(UNKNOWN_NODE in end.node for end in seen.ends)
    doubtful = nameless or len(set(names)) < len(names)
    # On a busy machine the first messages of the discovery may be lost: an empty view is doubted, too.
    if seen.nodes and not doubtful:
        return seen
    # A node that was killed meanwhile stays visible for 20 s, but not for a new participant.
    left = request.timeout - (time.monotonic() - began)
    if left >= seen.environment.seconds:
        return _observe_once(request._replace(timeout=left), environ, tell)
    caveats = [Caveat("no-second-look", True, NO_SECOND_LOOK)] if doubtful else []
    around = seen.environment
    return seen._replace(environment=around._replace(caveats=(*around.caveats, *caveats)))


def _observe_once(
    request: Request, environ: Mapping[str, str], tell: Callable[[str | System], None]
) -> System:
    limit = request.timeout + SLACK_SECONDS
    with running(OBSERVE, to_text(request), environ, limit) as child:
        while (data := child.next_message()) and data.startswith(SO_FAR):
            said = data.removeprefix(SO_FAR)
            is_view = said.startswith(b"{")
            tell(from_json(said, "the view so far") if is_view else said.decode())
        assert data is not None
        return from_json(data, "the view of the graph")


def watch(
    request: Request, environs: Mapping[int, Mapping[str, str]]
) -> Generator[tuple[int, System], None, None]:
    """Yield numbered snapshots of the graph in each environment, after each change; raises Unusable.

    They come for ``request.timeout`` seconds. No process is left running once the iterator is
    closed."""
    order = to_text(request._replace(watch=True))
    came: SimpleQueue[tuple[int, bytes | Unusable | None]] = SimpleQueue()
    with ExitStack() as stack:
        for at, environ in environs.items():
            child = stack.enter_context(running(OBSERVE, order, environ))
            end = threading.Timer(
                min(request.timeout, threading.TIMEOUT_MAX), child.process.terminate
            )
            reader = threading.Thread(target=_pass_on, args=(child, at, came.put), daemon=True)
            end.daemon = True
            stack.callback(end.cancel)
            end.start()
            reader.start()
        left = len(environs)
        while left:
            at, said = came.get()
            if isinstance(said, Unusable):
                raise said
            if said is None:
                left -= 1
            else:
                yield at, from_json(said, "the view of the graph")


def _pass_on(
    child: RosProcess, at: int, put: Callable[[tuple[int, bytes | Unusable | None]], None]
) -> None:
    """Hand on what a process sends, with its number; None at its end."""
    try:
        while (data := child.next_message()) is not None:
            put((at, data))
        put((at, None))
    except Unusable as error:
        put((at, error))


def ask(
    asked: Iterable[Question], seconds: float, environ: Mapping[str, str]
) -> tuple[Answer, ...]:
    """Return what nodes answer within ``seconds``, all asked at once; raises Unusable."""
    order = json.dumps((seconds, list(asked)))
    with running(ASK, order, environ, seconds + SLACK_SECONDS) as child:
        data = child.next_message()
    assert data is not None
    states: tuple[Answer, ...]
    states = record_from(tuple[Answer, ...], json.loads(data), "the answers of nodes")
    return states


@contextmanager
def running(
    module: str, order: str, environ: Mapping[str, str], seconds: float | None = None
) -> Iterator[RosProcess]:
    """Run the child with its order; it ends with the block, and after ``seconds`` at the latest."""
    command, environ = python(module), variables(environ)
    pipe = subprocess.PIPE
    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=errors, env=environ)
        limit = threading.Timer(seconds or threading.TIMEOUT_MAX, process.kill)
        limit.daemon = True
        limit.start()
        try:
            assert process.stdin is not None
            # Where the child ended before it read the order, its exit code says why.
            with suppress(BrokenPipeError):
                process.stdin.write(f"{order}\n".encode())
                process.stdin.flush()
            yield RosProcess(process, errors, environ)
        finally:
            limit.cancel()
            _stop(process)


def _stop(process: subprocess.Popen[bytes]) -> None:
    """Close its input, then terminate, then kill; only a clean exit leaves the graph at once."""
    assert process.stdin is not None and process.stdout is not None
    # The process may be gone already.
    with suppress(BrokenPipeError):
        process.stdin.close()
    for force in (process.terminate, process.kill):
        try:
            process.wait(_EXIT_SECONDS)
            break
        except subprocess.TimeoutExpired:
            force()
    process.wait()
    process.stdout.close()


def _explain(code: int, output: str, environ: Mapping[str, str]) -> str:
    """Return why the child ended with ``code``, and what to do, in one line."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    # rclpy puts lines with source locations after its reason.
    last = next((line for line in reversed(lines) if not line.startswith(",")), "no output")
    if code == NO_RCLPY:
        return f"rclpy cannot be imported ({last}); {INSTALL}"
    if code == RMW_MISMATCH:
        wanted = environ.get("RMW_IMPLEMENTATION", "")
        remedy = "unset it, or install that RMW"
        if wanted == ZENOH:
            remedy += ", or ask its router: --from tcp/localhost:7447"
        return f"RMW_IMPLEMENTATION={wanted!r} is not available to this rclpy; {remedy}"
    if code == ENDED:
        return (
            f"the process that reads the graph was stopped; start the command again. Output: {last}"
        )
    if code < 0:
        return f"rclpy was stopped by signal {-code}, or it took too long; output: {last}"
    return f"rclpy does not start (exit code {code}): {last}; {INSTALL}"
