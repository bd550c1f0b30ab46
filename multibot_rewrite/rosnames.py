"""ROS 2 names and remap rules, as rcl reads them. Pure text, no ROS needed.

Sources: rcl ``validate_topic_name.c``, ``remap.c``, ``arguments.c`` (9.2.0); rmw
``validate_namespace.c`` (245 characters), ``validate_node_name.c``.
"""

from __future__ import annotations

from typing import NamedTuple

from multibot_rewrite.model import UsageError

MAX_TOKEN = 245
SCHEMES = ("rostopic://", "rosservice://")
_LETTERS = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_")
_TOKEN = _LETTERS | frozenset("0123456789")


class RemapRule(NamedTuple):
    """A parsed remap rule with the position of each part in its text.

    ``node`` is the empty string for a rule that holds for every node of the process; ``source`` is
    ``__ns`` or ``__node`` for the two special rules.
    """

    node: str
    source: str
    target: str
    source_at: int
    target_at: int
    scheme: str


def parse_remap(text: str) -> RemapRule | None:
    """Split ``[node:][rostopic://]from:=[rostopic://]to``; None where it is not a remap rule."""
    left, found, right = text.partition(":=")
    node, at = _node_part(left)
    scheme = next((s for s in SCHEMES if left.startswith(s, at)), "")
    source_at = at + len(scheme)
    target_at = len(left) + 2 + next((len(s) for s in SCHEMES if right.startswith(s)), 0)
    source, target = left[source_at:], text[target_at:]
    if not found or not source.strip() or not target.strip() or ":" in source or ":=" in target:
        return None
    return RemapRule(node, source, target, source_at, target_at, scheme)


def _node_part(left: str) -> tuple[str, int]:
    """The ``node:`` part of a rule's left side and where the name after it starts."""
    colon = left.find(":")
    if colon <= 0 or left.startswith("://", colon):
        return "", 0
    return left[:colon], colon + 1


def expand(name: str, namespace: str, node: str) -> str:
    """The fully qualified name of ``name`` used by ``node`` in ``namespace``."""
    namespace = "/" + namespace.strip("/")
    if name.startswith("/"):
        return name
    root = namespace.rstrip("/")
    if name == "~" or name.startswith("~/"):
        return f"{root}/{node}{name[1:]}"
    return f"{root}/{name}"


def check_robot_name(name: str) -> str:
    """Return ``name`` if it is one ROS 2 name token, else raise UsageError with a proposal.

    A token is a letter or underscore followed by letters, digits and underscores: the name has to
    serve as node name, namespace and topic segment alike.
    """
    problem = _token_problem(name)
    if not problem:
        return name
    raise UsageError(f"robot name {name!r}: {problem}; use for example {propose_token(name)!r}")


def _token_problem(name: str) -> str:
    if not name:
        return "it is empty"
    if len(name) > MAX_TOKEN:
        return f"it has {len(name)} characters, ROS 2 allows {MAX_TOKEN}"
    if name[0] not in _LETTERS and name[0] in _TOKEN:
        return f"it starts with the digit {name[0]!r}, which no ROS 2 name may"
    for place, letter in enumerate(name, 1):
        if letter not in _TOKEN:
            return f"character {place}, {letter!r}, is not a letter, a digit or an underscore"
    return ""


def propose_token(name: str) -> str:
    """A valid token as near to ``name`` as can be."""
    kept = "".join(c if c in _TOKEN else "_" for c in name)
    while "__" in kept:
        kept = kept.replace("__", "_")
    kept = kept.strip("_")
    if not kept:
        return "robot1"
    return (kept if kept[0] in _LETTERS else f"robot_{kept}")[:MAX_TOKEN]
