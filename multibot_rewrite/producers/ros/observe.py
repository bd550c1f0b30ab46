# SPDX-License-Identifier: Apache-2.0
"""Observing the live graph: ``python -m multibot_rewrite.producers.ros.observe``, a child process.

It sends one snapshot when the graph is settled or, when watching, one after each change.
"""

from __future__ import annotations

import gc
import os
import sys
import threading
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial

from multibot_rewrite.producers.ros import assemble, queries, ros
from multibot_rewrite.producers.ros.ask import ask_nodes
from multibot_rewrite.producers.ros.look import (
    HEADER_SECONDS,
    POLL_SECONDS,
    TF_SECONDS,
    GraphListeners,
    GraphSession,
    SecondParticipant,
    complete_view,
    overview,
    receive,
    view,
)
from multibot_rewrite.producers.ros.participants import (
    lost_by_us,
    lost_here,
    make_room,
    participants_here,
)
from multibot_rewrite.producers.ros.request import (
    ENDED,
    SO_FAR,
    Request,
    Send,
    from_text,
    run_worker,
)
from multibot_rewrite.system import environment
from multibot_rewrite.system.environment import LOCALHOST
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.parameters import (
    ANSWER_SECONDS,
    Answer,
    Question,
    questions,
    with_answers,
)
from multibot_rewrite.system.records import (
    CHANGING,
    EXPECTED,
    QUIET,
    Caveat,
    End,
    Environment,
    System,
)

# A pause between two polls is so many times as long as a poll took: a large fleet is polled less
# often, even less where the graph is not watched.
PAUSE_FACTOR, LONG_PAUSE_FACTOR = 10, 30
# The longest pause; a poll may only have been slow because the machine was busy.
LONGEST_PAUSE_SECONDS = 1.0
# After so long without a change there will probably be none; tf is received until that is known.
IDLE_SECONDS = assemble.QUIET_SECONDS - TF_SECONDS[0]
# The same where all participants are known.
SHORT_IDLE_SECONDS = 0.3
# When watching, a snapshot comes so long after the last change, because changes come in groups,
SETTLE_SECONDS = 0.15
# but it waits no longer than this while the graph goes on changing.
LONGEST_SETTLE_SECONDS = 1.0


def main(order: str, stop: threading.Event, send: Send) -> int:
    """Observe as ``order`` says; returns the exit code."""
    request = from_text(order)
    tell = lambda said: send(SO_FAR + said)  # noqa: E731
    with _open_session(request, stop, tell) as session:
        if request.watch:
            gc.enable()  # no short process any more
            for snapshot in watch(session):
                send(to_json(snapshot))
            return 0
        snapshot = take_snapshot(session)
        if stop.is_set():
            return ENDED
        # Read while this node leaves the graph.
        send(to_json(snapshot))
    return 0


@contextmanager
def _open_session(
    request: Request, stop: threading.Event, tell: Callable[[bytes], None]
) -> Iterator[GraphSession]:
    with ros.opened() as opened:
        lost = lost_here(opened.context.get_domain_id())
        node = ros.add_node(opened, f"_multibot_snapshot_{os.getpid()}")
        make_room()
        yield GraphSession(opened, node, request, stop, time.monotonic(), tell, lost)


def take_snapshot(session: GraphSession) -> System:
    """Return a snapshot, once the graph is settled; not usable if ``stop`` was set meanwhile."""
    cache: queries.TopicCache = {}
    ears = GraphListeners(session)
    with ExitStack() as stack:
        second = SecondParticipant(session, stack)
        why, clock, last, missed = _wait_until_settled(session, cache, ears, second)
    seconds = session.now()
    names, endpoints = complete_view(session, cache)
    # Who names what is expected does not wait for anything that may be late.
    late = () if why == EXPECTED else [*clock.starved(), *_unannounced(session, names, endpoints)]
    late = [*late, *assemble.seen_by_one(missed)]
    more = [*late, *(assemble.cut_short(names, endpoints) if session.over() else ())]
    ears.update(endpoints)
    while not session.over() and ears.keep_waiting():
        receive(session, POLL_SECONDS)
    if ears.keep_waiting():
        more += assemble.not_heard(ears.silent())
    return _snapshot(session, names, endpoints, ears, (why, seconds, last), more)


def _unannounced(
    session: GraphSession, names: Sequence[str], endpoints: Sequence[End]
) -> Iterator[Caveat]:
    """Yield a limitation if programs of this machine have ports of the domain, but no known nodes."""
    here, node = participants_here(session.domain()), session.node
    if not here:
        return
    found = queries.participants(node) - queries.without_nodes(node, endpoints)
    if here > len(queries.on_this_machine(node, found)):
        # What is no ROS program says on no topic of the middleware what it has, and may have topics.
        found |= queries.participants_with_topics(node)
        announced = len(queries.on_this_machine(node, found))
        lost = lost_here(session.domain()) - session.lost
        yield from assemble.unannounced(announced, here, len(names), lost)


def watch(session: GraphSession) -> Iterator[System]:
    """Yield a snapshot after each change, and one when nothing has changed for a while."""
    ears = GraphListeners(session)
    cache: queries.TopicCache = {}
    before: object = None
    sent: object = None
    changed = sent_at = 0.0
    heard, known, endpoints = ears.heard(), None, list[End]()
    answers = Answers(partial(_ask, session), session.request.asks)
    pause, spent, clock = POLL_SECONDS, 0.0, assemble.ObservationClock()
    since, late = clock, tuple[Caveat, ...]()
    while not session.stop.is_set():
        receive(session, pause)
        clock = clock.after(session.now(), pause + spent)
        now, began = clock.observed, time.thread_time()
        listened, graph = session.now() - ears.began, overview(session)
        if graph != known:
            # Who sends a topic may be another one, or is new and had no time yet.
            known, since, late = graph, clock, (assemble.LISTENING,)
            ears.listen_again(())
        elif listened >= HEADER_SECONDS and not ears.headers.keep_waiting(HEADER_SECONDS):
            heard, late = ears.heard(), (*clock.since(since).starved(),)
            if listened >= AGAIN_SECONDS:
                since = clock
                ears.listen_again(endpoints)
        # A rate is another one each time: whether it is low counts.
        named = [(it.topic, it.frame, it.child, it.joints, 0 < it.rate < 1) for it in heard[0]]
        state = (*graph, ears.tf.transforms(), named, heard[1])
        pause = _pause_after(time.thread_time() - began, PAUSE_FACTOR)
        if state != before:
            before, changed = state, now
        quiet = now - changed >= assemble.QUIET_SECONDS
        due = now - changed >= SETTLE_SECONDS or now - sent_at >= LONGEST_SETTLE_SECONDS
        new, again = sent != (state, quiet), quiet and answers.old(session.now())
        if due and (new or again):
            sent, sent_at = (state, quiet), now
            if quiet:
                cache.clear()
            names, endpoints = view(session, cache)
            ears.update(endpoints)
            why = QUIET if quiet else CHANGING
            seen = _snapshot(session, names, endpoints, ears, (why, session.now(), ()), late)
            seen = seen._replace(heard=heard[0], descriptions=heard[1])
            other = answers.update(seen, quiet, session.now())
            if new or other:
                yield with_answers(seen, answers.states, answers.asked)
        spent = time.thread_time() - began


def _ask(session: GraphSession, asked: Iterable[Question]) -> Iterable[Answer]:
    return ask_nodes(session.ros, session.node, asked, ANSWER_SECONDS, session.stop)


def _wait_until_settled(
    session: GraphSession,
    cache: queries.TopicCache,
    ears: GraphListeners,
    second: SecondParticipant,
) -> tuple[str, assemble.ObservationClock, Sequence[str], Sequence[str]]:
    """Wait until the graph is settled; return why it is, empty if the observation was stopped.

    Also returns the time since the last change (what is late on a busy machine has had the time
    before), the names that came or went with it, and nodes that a second participant sees
    otherwise.

    The slow queries are made while there is only waiting to do, and tf is received; the cache
    grows."""
    request = session.request
    times, last_change = _ChangeTimes(), assemble.ObservationClock()
    queried: object = None
    pause, spent, clock = POLL_SECONDS, 0.0, assemble.ObservationClock(last=session.now())
    while not session.stop.is_set():
        receive(session, pause)
        clock = clock.after(session.now(), pause + spent)
        now, began = clock.observed, time.thread_time()
        seen = overview(session)
        changed = times.update(now, seen, request)
        # While it changes the moment of the last change is wanted.
        if changed.all == now:
            last_change = clock
            session.tell(assemble.so_far(seen[0]).encode())
        factor = PAUSE_FACTOR if changed.all == now else LONG_PAUSE_FACTOR
        pause = _pause_after(time.thread_time() - began, factor)
        missed = second.missed(seen) if changed.all < now else ()
        quiet = _quiet_seconds(session)
        if second.lossy:
            quiet = assemble.LOSSY_QUIET_SECONDS
        # Not later than the moment at which it is quiet.
        pause = min(pause, max(POLL_SECONDS, changed.all + quiet - now))
        # Its timeout is of real time.
        timeout = request.timeout - (session.now() - now)
        unchanged = clock.since(last_change)
        met, starved = request.is_met(seen[1]), any(unchanged.starved())
        unsure = starved or bool(missed)
        why = assemble.why_settled(now, changed, met, timeout, quiet, unsure=unsure)
        if why:
            return why, unchanged, times.last, () if why == EXPECTED else missed
        still = SHORT_IDLE_SECONDS if quiet < assemble.QUIET_SECONDS else IDLE_SECONDS
        idle = now - changed.all >= still or now >= timeout - TF_SECONDS[1]
        if idle and queried != seen:
            queried = seen
            known, ends = view(session, cache)
            ears.update(ends)
            if request.shows:
                shown = _snapshot(session, known, ends, ears, (CHANGING, now, ()))
                session.tell(to_json(shown))
        spent = time.thread_time() - began
    return "", clock, (), ()


def _quiet_seconds(session: GraphSession) -> float:
    """Return how many seconds without a change are enough.

    Fewer are if every participant of this machine has announced itself, no other machine can be
    seen, and this process lost nothing that Fast DDS sends again after its heartbeat of 3 s."""
    asked = environment.settings(os.environ)
    if asked.range != LOCALHOST or asked.static_peers or asked.discovery_server:
        return assemble.QUIET_SECONDS
    announced = queries.participants(session.node)
    # One that was killed meanwhile is still announced, and would hide one that is not yet.
    here = participants_here(session.domain())
    sure = announced and len(announced) == here and not lost_by_us()
    return assemble.ALL_KNOWN_SECONDS if sure else assemble.QUIET_SECONDS


class _ChangeTimes:
    """When the graph, and what is expected of it, last changed; ``last``: names that came or went."""

    def __init__(self) -> None:
        self._before: tuple[object, object] = (None, None)
        self._changed = assemble.LastChange(0.0, 0.0)
        self._seen: frozenset[str] = frozenset()
        self.last: tuple[str, ...] = ()

    def update(
        self, now: float, view: tuple[list[str], list[End]], request: Request
    ) -> assemble.LastChange:
        """Return when the graph last changed, after a poll at ``now``."""
        parts = (view, [end for end in view[1] if request.expects(end)])
        times = zip(self._changed, self._before, parts, strict=True)
        self._changed = assemble.LastChange(
            *(old if was == is_ else now for old, was, is_ in times)
        )
        self._before = parts
        there = frozenset((*view[0], *(it.name for it in view[1])))
        if there != self._seen:
            self._seen, self.last = there, tuple(sorted(there ^ self._seen))
        return self._changed


def _pause_after(took: float, factor: int) -> float:
    """Return how long to wait after a poll that took so many seconds."""
    return min(max(POLL_SECONDS, factor * took), LONGEST_PAUSE_SECONDS)


def _snapshot(
    session: GraphSession,
    names: list[str],
    endpoints: list[End],
    ears: GraphListeners,
    settled: tuple[str, float, Sequence[str]],
    more: Iterable[Caveat] = (),
) -> System:
    processes = assemble.processes_by_node(endpoints)
    enclaves = queries.enclaves(session.node)
    nodes = assemble.nodes_with_process(names, processes, enclaves)
    placed = tuple(assemble.endpoints_with_process(endpoints, processes))
    asked = environment.settings(os.environ)
    why, seconds, last = settled
    caveats = [
        *environment.setting_caveats(os.environ),
        *environment.view_caveats(nodes, placed, asked, why, session.request.expected, last),
        *ears.tf.caveats(),
        *ears.headers.caveats(),
        *more,
    ]
    heard, descriptions = ears.heard()
    around = Environment(
        session.domain(),
        asked.range,
        asked.static_peers,
        ros.middleware(),
        asked.discovery_server,
        asked.super_client,
        environment.participants(placed),
        why,
        round(seconds, 2),
        tuple(caveats),
    )
    return System(
        tuple(nodes),
        placed,
        tuple(ears.tf.edges(placed)),
        around,
        heard,
        descriptions=descriptions,
    )


# States and parameters change without the graph: nodes are asked for them again after so long.
AGAIN_SECONDS = 10.0
Ask = Callable[[Iterable[Question]], Iterable[Answer]]


class Answers:
    """The last answers. ``parameters`` are what nodes are asked for besides; None asks nobody."""

    def __init__(self, ask: Ask, parameters: Mapping[str, Collection[str]] | None) -> None:
        self._ask, self._parameters = ask, parameters
        self._asked = -AGAIN_SECONDS
        self.states: tuple[Answer, ...] = ()
        self.asked: tuple[Question, ...] = ()

    def old(self, now: float) -> bool:
        """Return whether the nodes should be asked again."""
        return self._parameters is not None and now - self._asked >= AGAIN_SECONDS

    def update(self, seen: System, quiet: bool, now: float) -> bool:
        """Ask the nodes of a quiet graph; return whether the answers changed.

        One that does not answer now keeps what it said before, until it leaves."""
        there = {node.name for node in seen.nodes}
        found = {it.node: it for it in self.states if it.node in there}
        self.asked = tuple(it for it in self.asked if it.node in there)
        if quiet and self._parameters is not None:
            self.asked = tuple(questions(seen, self._parameters))
            found |= {it.node: it for it in self._ask(self.asked)}
            self._asked = now
        before, self.states = self.states, tuple(found[it] for it in sorted(found))
        return before != self.states


if __name__ == "__main__":
    sys.exit(run_worker(main))
