# SPDX-License-Identifier: Apache-2.0
"""A Zenoh router's view of the graph: its liveliness tokens, and the tf that it hears meanwhile.

The tokens are all there at once, so there is nothing to wait for but samples of tf.
"""

import time
from collections import Counter, defaultdict
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from contextlib import ExitStack, closing
from itertools import zip_longest
from typing import NamedTuple

from multibot_rewrite.base.wording import FEW, SEVERAL, plural, shorten
from multibot_rewrite.producers.ros.assemble import TF_TYPES
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.producers.ros.tf_subscriptions import Callback, TfSubscriptions
from multibot_rewrite.producers.zenoh import SPACE, tokens
from multibot_rewrite.producers.zenoh.cdr import read_tf
from multibot_rewrite.producers.zenoh.session import NoRouter, RouterSession, opened
from multibot_rewrite.producers.zenoh.tokens import Token, read_token
from multibot_rewrite.system.records import (
    CHANGING,
    EXPECTED,
    PUBLISHES,
    QUIET,
    TIMEOUT,
    WAITED_FOR,
    ZENOH,
    Caveat,
    End,
    Environment,
    System,
)

POLL_SECONDS = 0.05
# A watched graph is shown so long after a change, because changes come in groups, but not later.
SETTLE_SECONDS, LONGEST_SETTLE_SECONDS = 0.15, 1.0


class Router(NamedTuple):
    """Where to ask: an endpoint or a session configuration, and the ROS_DOMAIN_ID to look in."""

    address: str
    domain: int

    def key(self) -> str:
        """Return what the tokens of the domain match: rmw_zenoh ``subscription_token``."""
        return f"{SPACE}/{self.domain}/**"


def look(request: Request, router: Router) -> System:
    """Return a snapshot of what the router knows now, or once all of ``request.expected`` exists.

    Raises Unusable without zenoh, InputError for a bad configuration; empty if no router answers."""
    started = time.monotonic()
    try:
        with opened(router.address, request.timeout) as session:
            return _look_in(session, request, router, started)
    except NoRouter as error:
        return _snapshot(router, _Seen(), time.monotonic() - started, [_no_router(router, error)])


def watch(
    request: Request, routers: Mapping[int, Router]
) -> Generator[tuple[int, System], None, None]:
    """Yield numbered snapshots after each change, for ``timeout`` seconds; raises as ``look``."""
    with ExitStack() as stack:
        views = [stack.enter_context(closing(_views(request, it))) for it in routers.values()]
        for seen in zip_longest(*views):
            yield from ((at, it) for at, it in zip(routers, seen, strict=True) if it)
            time.sleep(POLL_SECONDS)


def _views(request: Request, router: Router) -> Generator[System | None, None, None]:
    """Yield at each poll a snapshot, or None if there is nothing new."""
    started = time.monotonic()
    try:
        with opened(router.address, request.timeout) as session:
            yield from _views_in(session, request, router, started)
    except NoRouter as error:
        yield _snapshot(router, _Seen(), time.monotonic() - started, [_no_router(router, error)])


class _Seen(NamedTuple):
    """What was read: the tokens, the keys that are none, and the tf heard."""

    tokens: tuple[Token, ...] = ()
    strange: tuple[str, ...] = ()
    tf: TfSubscriptions | None = None
    settled: str = QUIET


def _look_in(session: RouterSession, request: Request, router: Router, started: float) -> System:
    """Return a snapshot by the router's tokens and tf, once all that is expected is there."""
    keys, complete = session.tokens(router.key())
    seen, expected = _read_tokens(keys), {*request.expected}
    while expected - _names(seen.tokens) and time.monotonic() - started < request.timeout:
        time.sleep(POLL_SECONDS)
        keys, complete = session.tokens(router.key())
        seen = _read_tokens(keys)
    tf = ZenohTf(session, router.domain)
    tf.listen(tokens.endpoints(seen.tokens), request.timeout - (time.monotonic() - started))
    text = f"the router at {router.address} did not answer in full; look again"
    cut = Caveat("not-settled", True, text)
    caveats = [*(_strays(session, seen.tokens, router) if complete else [cut]), *tf.caveats()]
    absent = sorted(expected - _names(seen.tokens))
    if absent and seen.tokens:
        text = f"expected names not in the graph: {shorten(absent, SEVERAL)}"
        caveats.append(Caveat(WAITED_FOR, True, f"{text}; is all started, are the names right?"))
    settled = TIMEOUT if absent else EXPECTED if expected else QUIET
    seen = seen._replace(tf=tf.subscriptions, settled=settled)
    return _snapshot(router, seen, time.monotonic() - started, caveats)


def _read_tokens(keys: Iterable[str]) -> _Seen:
    """Return the tokens of these keys, and the keys that are none."""
    read = {key: read_token(key) for key in sorted(set(keys))}
    found = tuple(token for token in read.values() if token)
    return _Seen(found, tuple(key for key, token in read.items() if token is None))


def _names(found: Iterable[Token]) -> set[str]:
    """Return the nodes, and the names of their ends."""
    return {name for it in found for name in (it.node, it.end.name if it.end else it.node)}


def _strays(session: RouterSession, found: Iterable[Token], router: Router) -> Iterator[Caveat]:
    """Report, if nothing is seen, which domains the router has nodes of."""
    if any(found):
        return
    keys, _ = session.tokens(f"{SPACE}/**")
    domains = Counter(token.domain for token in _read_tokens(keys).tokens)
    where = ", ".join(map(str, sorted(domains)))
    remedy = "do the robots use RMW_IMPLEMENTATION=rmw_zenoh_cpp and connect to this router?"
    if domains:
        remedy = f"it has nodes of domain {where}; give one with --domain"
    text = f"the router at {router.address} knows no node of domain {router.domain}; {remedy}"
    yield Caveat("nothing-seen", True, text)


def _no_router(router: Router, error: NoRouter) -> Caveat:
    remedy = "is one running there (ros2 run rmw_zenoh_cpp rmw_zenohd), and does it let us in?"
    why = "" if "Unable to connect" in str(error) else f" ({error})"
    text = f"no Zenoh router answers at {router.address}{why}; {remedy}"
    return Caveat("no-router", True, text)


def _views_in(
    session: RouterSession, request: Request, router: Router, started: float
) -> Iterator[System | None]:
    there: set[str] = set()
    tf = ZenohTf(session, router.domain)
    before: object = None
    changed = sent = 0.0
    end = session.follow_tokens(
        router.key(), lambda key, up: there.add(key) if up else there.discard(key)
    )
    # At once, so that the first view is whole.
    there.update(session.tokens(router.key())[0])
    shown: object = None
    text = f"the connection to the router at {router.address} is lost; is it still running?"
    lost = Caveat("no-router", True, text)
    while (now := time.monotonic() - started) < request.timeout:
        session.deliver()
        connected = session.connected()
        state = (frozenset(there), connected, tf.subscriptions.transforms())
        if state != before:
            before, changed = state, now
        quiet = now - changed >= SETTLE_SECONDS
        if (quiet or now - sent >= LONGEST_SETTLE_SECONDS) and shown != (state, quiet):
            shown, sent = (state, quiet), now
            seen = _read_tokens(there)
            tf.update(tokens.endpoints(seen.tokens))
            seen = seen._replace(tf=tf.subscriptions, settled=QUIET if quiet else CHANGING)
            caveats = list(tf.caveats()) if connected else [lost]
            yield _snapshot(router, seen, now, caveats)
        yield None
    end()


def _snapshot(router: Router, seen: _Seen, seconds: float, caveats: Iterable[Caveat]) -> System:
    nodes = tuple(tokens.nodes(seen.tokens))
    ends = tuple(tokens.endpoints(seen.tokens))
    tf, caveats = seen.tf, [*caveats]
    heard = tf.edges(ends) if tf else ()
    if seen.strange:
        text = f"{plural(len(seen.strange), 'token')} left out, not as rmw_zenoh writes them"
        caveats.append(Caveat("strange-token", False, f"{text}: {shorten(seen.strange, FEW)}"))
    twins = [name for name, times in Counter(it.name for it in nodes).items() if times > 1]
    if twins:
        text = f"several nodes have the name {shorten(twins, SEVERAL)}"
        caveats.append(Caveat("same-name", False, text))
    around = Environment(
        router.domain,
        "",
        (),
        ZENOH,
        router.address,
        False,
        len({token.session for token in seen.tokens}),
        seen.settled,
        round(seconds, 2),
        tuple(caveats),
    )
    return System(nodes, ends, tuple(heard), around)


# tf has 10 Hz or more: all that a publisher sends has come twice. A silent one is waited for longer.
TF_SECONDS, TF_LONGEST_SECONDS = 0.5, 3.0
# The type part of a topic's key expression (rmw_zenoh design.md), the hash left open.
_TF_KEY = "tf2_msgs::msg::dds_::TFMessage_/*"
_GID_BYTES = 16


class ZenohTf:
    """The tf topics of a session: who publishes there, and who has spoken."""

    def __init__(self, session: RouterSession, domain: int) -> None:
        self._session, self._domain = session, domain
        self._publishers: Counter[str] = Counter()
        self._spoken: dict[str, set[bytes]] = defaultdict(set)
        self._unread: set[str] = set()
        self.subscriptions = TfSubscriptions(self._subscribe)

    def update(self, endpoints: Iterable[End]) -> None:
        """Subscribe to the tf topics among these, and to no other."""
        ends = [it for it in endpoints if it.type == TF_TYPES[0] and it.role == PUBLISHES]
        self._publishers = Counter(end.name for end in ends)
        self.subscriptions.update(ends, False)

    def listen(self, endpoints: Iterable[End], seconds: float) -> None:
        """Subscribe, and wait until every publisher has spoken, ``seconds`` at the longest."""
        self.update(endpoints)
        began = time.monotonic()
        while self._publishers and self._waiting(time.monotonic() - began, seconds):
            time.sleep(POLL_SECONDS)
            self._session.deliver()

    def _waiting(self, passed: float, seconds: float) -> bool:
        """Return whether a publisher of tf may still be heard."""
        silent = any(len(self._spoken[it]) < many for it, many in self._publishers.items())
        return passed < min(seconds, TF_LONGEST_SECONDS if silent else TF_SECONDS)

    def _subscribe(
        self, topic: str, type_: str, latched: bool, callback: Callback
    ) -> Callable[[], None]:
        def received(payload: bytes, attachment: bytes) -> None:
            message = read_tf(payload)
            # rmw_zenoh design.md: the sender's gid is at the end of the attachment.
            sender = attachment[-_GID_BYTES:]
            self._spoken[topic].add(sender)
            if message is None:
                self._unread.add(topic)
            else:
                callback(message, sender)

        key = f"{self._domain}/{topic.strip('/')}/{_TF_KEY}"
        return self._session.subscribe(key, latched, received)

    def caveats(self) -> Iterator[Caveat]:
        """Yield a limitation for what was not heard, or is no TFMessage."""
        if self._unread:
            topics = shorten(sorted(self._unread), SEVERAL)
            yield Caveat("frames-not-read", True, f"messages on {topics} are no TFMessage in CDR")
        silent = sorted(it for it in self._publishers if not self._spoken[it])
        if silent:
            # One silent publisher is usual; nothing at all rather is a door that is shut.
            deaf = len(silent) == len(self._publishers)
            text = f"no transform was heard on {shorten(silent, SEVERAL)}"
            remedy = "the publishers are silent, or access control keeps us from listening"
            yield Caveat("frames-not-heard", deaf, f"{text}: {remedy}")
