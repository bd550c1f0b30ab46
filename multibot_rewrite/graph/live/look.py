"""Looking at the live graph: ``python -m multibot_rewrite.graph.live.look``, a child of the command.

It tells one snapshot when the graph is settled or, watching, one whenever something changed.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any, NamedTuple

from multibot_rewrite.graph import environment as surroundings
from multibot_rewrite.graph.live import ask, gather, ros
from multibot_rewrite.graph.live.ears import Ears, Take
from multibot_rewrite.graph.live.request import ENDED, Request, from_text
from multibot_rewrite.graph.live.worker import Tell, work
from multibot_rewrite.graph.snapshot import (
    CHANGING,
    QUIET,
    UNKNOWN_NODE,
    Environment,
    GraphEndpoint,
    Snapshot,
    to_json,
)
from multibot_rewrite.remap.records import ACTION, CALLS, SERVES

# How long to wait between two looks, and at least so many times as long as one took: a fleet of 100
# robots is not looked at as often as one of two, and less often where nobody watches.
POLL_SECONDS, REST, LONG_REST = 0.1, 10, 30
# No longer than this, since a look may only have been slow because the machine was.
LONGEST_REST_SECONDS = 1.0
# After so long without change it is likely that there is none to come.
IDLE_SECONDS = 1.0
# tf comes ten times a second or more; a shared topic of 100 robots took 1.3 s to be heard whole.
TF_SECONDS = (1.5, 3.0)
# Who watches is told this soon, since more may be told later,
GLANCE_SECONDS = 0.15
# and no later than this, however long the graph goes on changing.
PATIENCE_SECONDS = 1.0


class _Eye(NamedTuple):
    """An open view of the graph; ``stop`` is set when somebody wants the looking to end."""

    session: ros.Session
    node: Any
    request: Request
    stop: threading.Event
    started: float

    def now(self) -> float:
        """Seconds since the looking began."""
        return time.monotonic() - self.started


def main(order: str, stop: threading.Event, tell: Tell) -> int:
    """Look as ``order`` says; returns the exit code."""
    request = from_text(order)
    with _opened(request, stop) as eye:
        if request.watch:
            for snapshot in watch(eye):
                tell(to_json(snapshot))
            return 0
        snapshot = look(eye)
    if stop.is_set():
        return ENDED
    tell(to_json(snapshot))
    return 0


@contextmanager
def _opened(request: Request, stop: threading.Event) -> Iterator[_Eye]:
    with ros.opened() as session:
        node = ros.add_node(session, f"_multibot_snapshot_{os.getpid()}")
        yield _Eye(session, node, request, stop, time.monotonic())


def look(eye: _Eye) -> Snapshot:
    """A snapshot, once the graph is settled; of no use where ``stop`` was set meanwhile."""
    memory: ask.Memory = {}
    why = _settle(eye, memory)
    seconds = eye.now()
    names, endpoints = _taken(eye, memory)
    ears = Ears(partial(_subscribe, eye))
    ears.attend(endpoints, eye.request.stand_ins)
    while not eye.stop.is_set() and ears.waiting(*TF_SECONDS):
        ros.spin(eye.session, POLL_SECONDS)
    return _snapshot(eye, names, endpoints, ears, (why, seconds))


def watch(eye: _Eye) -> Iterator[Snapshot]:
    """A snapshot whenever something changed, and one when nothing did for a while."""
    ears = Ears(partial(_subscribe, eye))
    memory: ask.Memory = {}
    before: object = None
    told: object = None
    changed = told_at = 0.0
    pause, clock = POLL_SECONDS, gather.Clock()
    while not eye.stop.is_set():
        ros.spin(eye.session, pause)
        began = time.thread_time()
        state = (*_overview(eye), ears.edges())
        clock = clock.after(eye.now(), pause)
        now = clock.looked
        pause = _rest(time.thread_time() - began, REST)
        if state != before:
            before, changed = state, now
        quiet = now - changed >= gather.QUIET_SECONDS
        due = now - changed >= GLANCE_SECONDS or now - told_at >= PATIENCE_SECONDS
        if due and told != (state, quiet):
            told, told_at = (state, quiet), now
            if quiet:
                memory.clear()
            names, endpoints = _view(eye, memory)
            ears.attend(endpoints, eye.request.stand_ins)
            why = QUIET if quiet else CHANGING
            yield _snapshot(eye, names, endpoints, ears, (why, eye.now()))


def _overview(eye: _Eye) -> tuple[list[str], list[GraphEndpoint]]:
    """The nodes and what each has: enough to see whether anything changed."""
    names = ask.names_in(eye.node)
    return names, sorted(ask.by_node(eye.node, names, ask.QUESTIONS, ros.gone()))


def _settle(eye: _Eye, memory: ask.Memory) -> str:
    """Wait until the graph is settled; why it is, empty where the looking was stopped.

    The dear questions are asked while there is nothing to do but to wait; ``memory`` grows.
    """
    request = eye.request
    since = _Since()
    asked: object = None
    pause, spent, clock = POLL_SECONDS, 0.0, gather.Clock()
    while not eye.stop.wait(pause):
        began = time.thread_time()
        view = _overview(eye)
        clock = clock.after(eye.now(), pause + spent)
        now = clock.looked
        pause = _rest(time.thread_time() - began, LONG_REST)
        changed = since.seen(now, view, request.expected)
        seen = {end.node for end in view[1]}
        why = gather.settled(now, changed, seen, request.expected, request.timeout)
        if why:
            return why
        began = eye.now()
        if asked != view and now - changed.all >= IDLE_SECONDS:
            asked = view
            _view(eye, memory)
        spent = eye.now() - began
    return ""


class _Since:
    """When the view last changed, all of it and that of the expected nodes."""

    def __init__(self) -> None:
        self._before: tuple[object, object] = (None, None)
        self._changed = gather.Changes(0.0, 0.0)

    def seen(
        self, now: float, view: tuple[list[str], list[GraphEndpoint]], expected: Collection[str]
    ) -> gather.Changes:
        """What holds after a look at ``now``."""
        parts = (view, [end for end in view[1] if end.node in expected])
        times = zip(self._changed, self._before, parts, strict=True)
        self._changed = gather.Changes(*(old if was == is_ else now for old, was, is_ in times))
        self._before = parts
        return self._changed


def _rest(took: float, times: int) -> float:
    """How long to wait after a look that took so many seconds."""
    return min(max(POLL_SECONDS, times * took), LONGEST_REST_SECONDS)


def _taken(eye: _Eye, memory: ask.Memory) -> tuple[list[str], list[GraphEndpoint]]:
    """Names and endpoints, again for a while where they have not found one another."""
    limit = min(eye.request.timeout, eye.now() + gather.QUIET_SECONDS)
    while True:
        names, endpoints = _view(eye, memory)
        owners = {end.node for end in endpoints}
        whole = owners.issuperset(names) and f"/{UNKNOWN_NODE}" not in owners
        if whole or eye.now() >= limit or eye.stop.wait(POLL_SECONDS):
            return names, endpoints


def _view(eye: _Eye, memory: ask.Memory) -> tuple[list[str], list[GraphEndpoint]]:
    """Names and endpoints, with QoS and process where they are worth asking for."""
    names = ask.names_in(eye.node)
    found = list(ask.by_node(eye.node, names, (*ask.QUESTIONS, *_ACTIONS), ros.gone()))
    return names, ask.endpoints_of(eye.node, names, found, eye.request.topics, memory)


_ACTIONS: tuple[ask.Question, ...] = (
    (ACTION, SERVES, ros.action_servers),
    (ACTION, CALLS, ros.action_clients),
)


def _subscribe(
    eye: _Eye, topic: str, word: str, latched: bool, take: Take
) -> Callable[[], None] | str:
    """A subscription for the ears: what ends it, or why the type cannot be had."""
    type_, reason = ros.type_of(word)
    return ros.subscribe(eye.node, type_, topic, latched, take) if type_ else reason


def _snapshot(
    eye: _Eye,
    names: list[str],
    endpoints: list[GraphEndpoint],
    ears: Ears,
    settled: tuple[str, float],
) -> Snapshot:
    groups = gather.processes(endpoints)
    nodes = gather.placed_nodes(names, groups)
    placed = tuple(gather.placed_endpoints(endpoints, groups))
    asked = surroundings.settings(os.environ)
    why, seconds = settled
    caveats = [
        *surroundings.setting_caveats(os.environ),
        *surroundings.view_caveats(nodes, placed, asked, why, eye.request.expected),
        *ears.caveats(),
    ]
    around = Environment(
        eye.session.context.get_domain_id(),
        asked.range,
        asked.static_peers,
        ros.middleware(),
        asked.discovery_server,
        asked.super_client,
        surroundings.participants(placed),
        why,
        round(seconds, 2),
        tuple(caveats),
    )
    return Snapshot(tuple(nodes), placed, tuple(gather.frames(ears.edges(), placed)), around)


if __name__ == "__main__":
    sys.exit(work(main))
