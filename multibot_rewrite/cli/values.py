# SPDX-License-Identifier: Apache-2.0
"""What the values of options are read as: functions for ``type=`` of argparse."""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Callable, Collection

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.nearest import did_you_mean_one_of

MAX_SECONDS = 3600
# The highest ROS_DOMAIN_ID that rcl takes.
MAX_DOMAIN = 232
# zenoh-protocol endpoint.rs: PROTOCOL/ADDRESS, then metadata behind ? and configuration behind #.
_ENDPOINT = lazy_compile(r"(tcp|udp|tls|quic|ws)/[^\s/?#]+:\d{1,5}([?#]\S*)?|unixsock-stream/\S+")
# What is meant as one: a protocol in front, or a port behind.
_ADDRESS = lazy_compile(r"(?:tcp|udp|tls|quic|ws|unixsock-stream)/.*|[^/]*:\d+")
SOURCES = SAVED, RECORDING, ROUTER = ("snapshot", "bag", "zenoh")
_WORD = lazy_compile(r"[A-Za-z0-9_.-]+")


def names(text: str) -> list[str]:
    """Return ``a,b`` as two names; an empty text is none."""
    found = [part.strip() for part in text.split(",")] if text else []
    if "" in found:
        raise argparse.ArgumentTypeError(f"{text!r} has an empty part, write A,B")
    return found


def full_names(text: str) -> list[str]:
    """Return ``/a,/b`` as two names of nodes or topics."""
    return [full_name(it) for it in names(text)]


def full_name(text: str) -> str:
    """Return the full name of a node or topic; raises ArgumentTypeError for another text."""
    if not text.startswith("/"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a full name, give for example /{text}")
    return text


def path(text: str) -> str:
    """Return the name of a file or folder; raises ArgumentTypeError for an empty one."""
    if not text:
        raise argparse.ArgumentTypeError("the name is empty, give the name of a file")
    return text


def folders(text: str) -> list[str]:
    """Return ``a,b`` as two folders that exist."""
    found = names(text)
    if gone := next((it for it in found if not os.path.isdir(it)), ""):
        raise argparse.ArgumentTypeError(f"{gone!r} is no folder, name one that is there")
    return found


def source(text: str) -> tuple[str, str]:
    """Return the kind of a graph's source, one of ``SOURCES``, and the source."""
    if text.endswith(".json5") or (_ADDRESS.fullmatch(text) and not os.path.exists(text)):
        return ROUTER, zenoh_router(text)
    if text.endswith((".mcap", ".db3", "/")) or os.path.isdir(text):
        return RECORDING, text
    return SAVED, path(text)


def zenoh_router(text: str) -> str:
    """Return an endpoint as Zenoh writes it, or the name of a session configuration."""
    return text if text.endswith((".json5", ".json")) else zenoh_endpoint(text)


def zenoh_endpoint(text: str) -> str:
    """Return the endpoint of a Zenoh router, checked."""
    if not _ENDPOINT.fullmatch(text):
        hint = "write PROTOCOL/HOST:PORT, such as tcp/localhost:7447"
        raise argparse.ArgumentTypeError(f"{text!r} is no Zenoh router; {hint}")
    return text


def one_of(known: Collection[str]) -> Callable[[str], str]:
    """Return a function that reads a known value, and refuses others with the nearest one."""

    def read(text: str) -> str:
        if text in known:
            return text
        near = did_you_mean_one_of(text, known)
        hint = f"; {near}" if near else ""
        raise argparse.ArgumentTypeError(
            f"{text!r} is not known, use one of {', '.join(known)}{hint}"
        )

    return read


def some_of(known: Collection[str]) -> Callable[[str], list[str]]:
    """Return a function that reads known values, separated by commas."""
    read = one_of(known)
    return lambda text: [read(it) for it in names(text)]


def word(text: str) -> str:
    """Return a single name, as that of a node set."""
    if not _WORD.fullmatch(text):
        raise argparse.ArgumentTypeError(f"{text!r} is not a name of a node set, give one word")
    return text


def seconds(text: str) -> float:
    """Return a time in seconds; raises ArgumentTypeError for another text."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value <= MAX_SECONDS:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a time, give seconds up to {MAX_SECONDS}"
        )
    return value


def domain(text: str) -> int:
    """Return a ROS_DOMAIN_ID; raises ArgumentTypeError for another text."""
    if not text.isdecimal() or int(text) > MAX_DOMAIN:
        raise argparse.ArgumentTypeError(f"{text!r} is not a domain, give 0 to {MAX_DOMAIN}")
    return int(text)


def domains(text: str) -> list[int]:
    """Return ``1,2`` as two domains."""
    return [domain(it) for it in names(text)]


def count(text: str) -> int:
    """Return a number, 0 or more; raises ArgumentTypeError for another text."""
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is not a number, give 0 or more")
    return int(text)
