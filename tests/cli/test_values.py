# SPDX-License-Identifier: Apache-2.0
"""What the values of options are read as."""

from __future__ import annotations

import argparse
from collections.abc import Callable

import pytest

from multibot_rewrite.cli import values

KNOWN = ("text", "json", "sarif")


@pytest.mark.parametrize(
    ("read", "text", "value"),
    [
        (values.names, "a, b,c", ["a", "b", "c"]),
        (values.names, "", []),
        (values.full_names, "/a,/b", ["/a", "/b"]),
        (values.full_name, "/a/b", "/a/b"),
        (values.path, "a b", "a b"),
        (values.zenoh_router, "session.json5", "session.json5"),
        (values.zenoh_router, "session.json", "session.json"),
        (values.zenoh_router, "tcp/localhost:7447", "tcp/localhost:7447"),
        *(
            (values.zenoh_endpoint, it, it)
            for it in (
                "udp/[::1]:7447", "tls/a.b:1", "quic/a:12345", "ws/a:80?x=1", "tcp/a:1#iface=lo",
                "unixsock-stream//tmp/z",
            )
        ),
        *(
            (values.source, it, (kind, it))
            for kind, it in (
                ("snapshot", "graph.json"), ("snapshot", "a/graph.yaml"), ("snapshot", "tcp.json"),
                ("snapshot", "/dev/fd/63"), ("bag", "a.mcap"), ("bag", "a.db3"), ("bag", "bag/"),
                ("bag", "."), ("zenoh", "tcp/localhost:7447"), ("zenoh", "operator.json5"),
            )
        ),
        (values.one_of(KNOWN), "json", "json"),
        (values.some_of(KNOWN), "json,text", ["json", "text"]),
        (values.word, "my.node_set_2-a", "my.node_set_2-a"),
        (values.seconds, "0.5", 0.5),
        (values.seconds, "3600", 3600.0),
        (values.domain, "0", 0),
        (values.domain, "232", 232),
        (values.count, "0", 0),
        (values.count, "12", 12),
    ],
)  # fmt: skip
def test_a_value_is_read(read: Callable[[str], object], text: str, value: object) -> None:
    assert read(text) == value


@pytest.mark.parametrize(
    ("read", "text", "said"),
    [
        (values.names, "a,,b", "'a,,b' has an empty part, write A,B"),
        (values.names, ",", "',' has an empty part, write A,B"),
        (values.full_names, "/a,b", "'b' is not a full name, give for example /b"),
        (values.path, "", "the name is empty, give the name of a file"),
        (values.source, "", "the name is empty, give the name of a file"),
        *(
            (
                values.source, it,
                f"'{it}' is no Zenoh router; write PROTOCOL/HOST:PORT, such as tcp/localhost:7447",
            )
            for it in ("host:7447", "tcp/host", "udp/host:x")
        ),
        *(
            (
                values.zenoh_router, it,
                f"'{it}' is no Zenoh router; write PROTOCOL/HOST:PORT, such as tcp/localhost:7447",
            )
            for it in ("tcp/a", "tcp/a:123456", "ftp/a:1", "tcp/a b:1", "tcp/:1", "tcp/a:1x", "json")
        ),
        (
            values.one_of(KNOWN), "jsn",
            "'jsn' is not known, use one of text, json, sarif; did you mean 'json'?",
        ),
        (values.one_of(KNOWN), "xyz", "'xyz' is not known, use one of text, json, sarif"),
        (values.some_of(KNOWN), "text,xyz", "'xyz' is not known, use one of text, json, sarif"),
        (values.word, "a b", "'a b' is not a name of a node set, give one word"),
        (values.word, "", "'' is not a name of a node set, give one word"),
        *(
            (values.seconds, it, f"'{it}' is not a time, give seconds up to 3600")
            for it in ("0", "-1", "3600.5", "nan", "x", "inf")
        ),
        *(
            (values.domain, it, f"'{it}' is not a domain, give 0 to 232")
            for it in ("233", "-1", "x", "1.0")
        ),
        *(
            (values.count, it, f"'{it}' is not a number, give 0 or more")
            for it in ("-1", "x", "1.0")
        ),
    ],
)  # fmt: skip
def test_what_is_no_value_is_said(read: Callable[[str], object], text: str, said: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError) as caught:
        read(text)
    assert str(caught.value) == said
