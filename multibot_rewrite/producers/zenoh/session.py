# SPDX-License-Identifier: Apache-2.0
"""The only module that imports zenoh, with the functions that the others need.

It comes with the extra ``zenoh`` (eclipse-zenoh on PyPI), and is imported when a router is asked.
"""

import json
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from multibot_rewrite.base.model import InputError, Unusable

INSTALL = "pip install 'multibot_rewrite[zenoh]' (or pip install eclipse-zenoh)"
# The router answers in milliseconds; over a slow network connecting takes some time.
CONNECT_SECONDS, ANSWER_SECONDS = 3.0, 5.0
# Not found by multicast: what is asked is the router that was named.
_SETTINGS = {"mode": "client", "scouting/multicast/enabled": False}


class NoRouter(Exception):
    """No router answers; the message says why."""


class RouterSession(NamedTuple):
    """An open session; ``inbox`` has what arrived on other threads: what to call, and with what.

    ``declared`` are its subscriptions: the session waits for some of them, so they end before it.
    """

    zenoh: Any
    session: Any
    inbox: deque[tuple[Callable[..., None], tuple[Any, ...]]]
    declared: list[Any]

    def deliver(self) -> None:
        """Call the receivers of what has arrived, on this thread."""
        while self.inbox:
            call, values = self.inbox.popleft()
            call(*values)

    def connected(self) -> bool:
        """Return whether the router, or the peer that was named, is still connected."""
        info = self.session.info
        return bool([*info.routers_zid(), *info.peers_zid()])

    def tokens(self, key: str) -> tuple[list[str], bool]:
        """Return the key expressions of all tokens that match, and whether the answer is complete."""
        found, complete = [], True
        for reply in self.session.liveliness().get(key, timeout=ANSWER_SECONDS):
            if reply.ok is None:
                complete = False
            else:
                found.append(str(reply.ok.key_expr))
        return found, complete

    def follow_tokens(self, key: str, changed: Callable[[str, bool], None]) -> Callable[[], None]:
        """Call ``changed`` with each token that comes or goes; returns what ends it."""

        def arrived(sample: Any) -> None:
            there = sample.kind == self.zenoh.SampleKind.PUT
            self.inbox.append((changed, (str(sample.key_expr), there)))

        return self._keep(self.session.liveliness().declare_subscriber(key, arrived))

    def subscribe(
        self, key: str, latched: bool, received: Callable[[bytes, bytes], None]
    ) -> Callable[[], None]:
        """Subscribe to a key, if ``latched`` with earlier messages; return what ends it."""
        from zenoh import ext

        def arrived(sample: Any) -> None:
            attachment = bytes(sample.attachment) if sample.attachment else b""
            self.inbox.append((received, (bytes(sample.payload), attachment)))

        if not latched:
            return self._keep(self.session.declare_subscriber(key, arrived))
        history = ext.HistoryConfig(detect_late_publishers=True)
        return self._keep(
            ext.declare_advanced_subscriber(self.session, key, arrived, history=history)
        )

    def _keep(self, subscription: Any) -> Callable[[], None]:
        """Keep a subscription, and return what ends it."""
        self.declared.append(subscription)

        def end() -> None:
            self.declared.remove(subscription)
            subscription.undeclare()

        return end


@contextmanager
def opened(router: str, seconds: float) -> Iterator[RouterSession]:
    """Yield a session as a client of the router; raises Unusable, NoRouter, InputError."""
    zenoh = _zenoh()
    config = _config(zenoh, router, min(seconds, CONNECT_SECONDS))
    declared: list[Any] = []
    try:
        session = zenoh.open(config)
    except zenoh.ZError as error:
        raise NoRouter(_reason(error)) from None
    try:
        yield RouterSession(zenoh, session, deque(), declared)
    finally:
        for subscription in declared:
            subscription.undeclare()
        session.close()


def _zenoh() -> Any:
    try:
        import zenoh
    except (ImportError, OSError) as error:
        raise Unusable(f"zenoh cannot be imported ({error}); {INSTALL}") from None
    return zenoh


def _config(zenoh: Any, router: str, seconds: float) -> Any:
    """Return the configuration of a client: its own, or that of the file."""
    named = router.endswith((".json5", ".json"))
    try:
        config = zenoh.Config.from_file(router) if named else zenoh.Config()
        if not named:
            config.insert_json5("connect/endpoints", json.dumps([router]))
        for key, value in _SETTINGS.items():
            config.insert_json5(key, json.dumps(value))
        config.insert_json5("connect/timeout_ms", str(int(seconds * 1000)))
    except zenoh.ZError as error:
        hint = "give one that zenoh can load, or tcp/HOST:7447"
        raise InputError(
            f"{router}: no session configuration of Zenoh: {_reason(error)}; {hint}"
        ) from None
    return config


def _reason(error: Exception) -> str:
    """Return what zenoh says, without the source locations behind it."""
    return str(error).partition(" at /")[0].strip().rstrip(".!")
