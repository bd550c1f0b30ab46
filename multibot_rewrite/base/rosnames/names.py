# SPDX-License-Identifier: Apache-2.0
"""What a ROS 2 name may look like, and how it becomes a fully qualified one.

Every check gives the fault that rcl 9.2 (Jazzy) would give first, at the same character. Sources:
rcl ``validate_topic_name.c`` and ``expand_topic_name.c``; rmw ``validate_full_topic_name.c``,
``validate_namespace.c``, ``validate_node_name.c`` and their headers (the limits).
"""

from collections.abc import Iterable
from itertools import pairwise
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError

# rmw: 255 less 8 for the rt/, rq/ and rr/ ... Reply of the wire; a namespace leaves room for "/x".
MAX_TOPIC = 247
MAX_NAMESPACE = MAX_TOKEN = 245
MAX_NODE = 255
# The most robots that a number may ask for.
MOST = 10_000
_DIGITS = frozenset("0123456789")
_LETTERS = frozenset("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_")
_TOKEN = _LETTERS | _DIGITS
# Nearly every name there is; what does not match is looked at letter by letter.
_PLAIN = lazy_compile(r"(?:~?/)?[A-Za-z_][A-Za-z0-9_]*(?:/[A-Za-z_][A-Za-z0-9_]*)*")
_FULL = lazy_compile(r"(?:/[A-Za-z_][A-Za-z0-9_]*)+")
_SUBSTITUTION = lazy_compile(r"\{(node|ns|namespace)\}")


class NameFault(NamedTuple):
    """Why a name or rule is not valid, and the index of the wrong character."""

    reason: str
    at: int


def check_topic_name(name: str) -> NameFault | None:
    """Return the fault of a topic or service name in code, before expansion, or None.

    ``~`` and ``{node}`` are allowed here. Doubled slashes and any length pass too, as in rcl: those are
    faults of the expanded name (``check_full_name``).
    """
    if _PLAIN.fullmatch(name):
        return None
    if not name:
        return NameFault("it is empty", 0)
    if name[0] in _DIGITS:
        return _digit_first_fault(name, 0)
    if name.endswith("/"):
        return _slash_last_fault(name)
    return _brace_or_letter_fault(name) or _part_start_fault(name)


def check_name_in_code(name: str) -> NameFault | None:
    """Return the fault of a topic or service name in code, or of its expansion, or None."""
    return check_topic_name(name) or check_full_name(expand(name, "/", "node"))


def check_full_name(name: str) -> NameFault | None:
    """Return the fault of a fully qualified topic or service name, or None."""
    return _full_name_fault(name) or _length_fault(name, MAX_TOPIC)


def check_namespace(namespace: str) -> NameFault | None:
    """Return the fault of a namespace, or None: ``/``, or absolute without a slash at the end."""
    if namespace == "/":
        return None
    return _full_name_fault(namespace) or _length_fault(namespace, MAX_NAMESPACE)


def check_node_name(name: str) -> NameFault | None:
    """Return the fault of a node's name, or None: it is one token of at most 255 characters."""
    if name.isascii() and name.isidentifier():
        return _length_fault(name, MAX_NODE)
    if not name:
        return NameFault("it is empty", 0)
    fault = _letter_fault(name, _TOKEN, "a letter, a digit or an underscore")
    return fault or _digit_first_fault(name, 0)


def _brace_or_letter_fault(name: str) -> NameFault | None:
    """Return the fault of a name with wrong braces or letters, or ``~`` within it; else None."""
    opened = -1
    for at, letter in enumerate(name):
        if opened >= 0:
            if letter == "}":
                opened = -1
            elif letter not in _TOKEN:
                reason = "does not belong in a {substitution}: letters, digits and underscores do"
                return _fault_at(name, at, reason)
            elif letter in _DIGITS and at == opened + 1:
                return _fault_at(name, at, "is a digit, with which no substitution starts")
        elif letter == "{":
            opened = at
        elif letter == "}":
            return _fault_at(name, at, "closes what was not opened")
        elif letter == "~" and at:
            return _fault_at(name, at, "may only be the first character")
        elif letter not in _TOKEN and letter not in "/~":
            return _fault_at(name, at, "is not a letter, a digit, or one of _ / ~ { }")
    return _fault_at(name, opened, "is not closed") if opened >= 0 else None


def _part_start_fault(name: str) -> NameFault | None:
    """Return the fault of ``~`` without a slash behind it, or of a part that begins with a digit."""
    # Two characters, as "~a", pass: rcl never looks at the last one here.
    if name[0] == "~" and len(name) > 2 and name[1] != "/":
        return _fault_at(name, 1, "follows '~', which only a slash may follow")
    for at, (letter, following) in enumerate(pairwise(name), 1):
        if letter == "/" and following in _DIGITS:
            return _digit_first_fault(name, at)
    return None


def _full_name_fault(name: str) -> NameFault | None:
    """Return the fault of a fully qualified name, its length aside."""
    if _FULL.fullmatch(name):
        return None
    if not name:
        return NameFault("it is empty", 0)
    if name[0] != "/":
        return _fault_at(name, 0, "is not the slash that a fully qualified name starts with")
    if name.endswith("/"):
        return _slash_last_fault(name)
    return _letter_fault(name, _TOKEN | {"/"}, "a letter, a digit, an underscore or a slash") or (
        _slash_or_digit_fault(name)
    )


def _slash_or_digit_fault(name: str) -> NameFault | None:
    for at, (letter, following) in enumerate(pairwise(name), 1):
        if letter == following == "/":
            return _fault_at(name, at, "is a slash right after a slash")
        if letter == "/" and following in _DIGITS:
            return _digit_first_fault(name, at)
    return None


def _letter_fault(name: str, allowed: frozenset[str], words: str) -> NameFault | None:
    for at, letter in enumerate(name):
        if letter not in allowed:
            return _fault_at(name, at, f"is not {words}")
    return None


def _fault_at(name: str, at: int, reason: str) -> NameFault:
    return NameFault(f"character {at + 1}, {name[at]!r}, {reason}", at)


def _digit_first_fault(name: str, at: int) -> NameFault:
    return _fault_at(name, at, "is a digit, with which no part of a name starts")


def _slash_last_fault(name: str) -> NameFault:
    return _fault_at(name, len(name) - 1, "is a slash at the end")


def _length_fault(name: str, limit: int) -> NameFault | None:
    if len(name) <= limit:
        return None
    # rcl points at the last character that is allowed.
    return NameFault(f"it has {len(name)} characters, ROS 2 allows {limit}", limit - 1)


def expand(name: str, namespace: str, node: str) -> str:
    """Return the fully qualified name of ``name`` used by ``node`` in ``namespace``, before any rule.

    ``{node}``, ``{ns}`` and ``{namespace}`` are filled in, other substitutions stay: rcl knows no
    other. The namespace may lack its leading slash. Nothing is checked here.
    """
    bare = namespace.strip("/")
    root = f"/{bare}" if bare else ""
    if name.startswith("~"):
        name = f"{root}/{node}{name[1:]}"
    if "{" in name:
        words = {"node": node, "ns": root or "/", "namespace": root or "/"}
        name = _SUBSTITUTION.sub(lambda found: words[found[1]], name)
    return name if name.startswith("/") else f"{root}/{name}"


def check_robot_name(name: str) -> str:
    """Return ``name`` if it is one ROS 2 name token, else raise UsageError with a proposal.

    A token is a letter or underscore followed by letters, digits and underscores: the name has to
    serve as node name, namespace and topic segment alike.
    """
    other = next((it for it in enumerate(name, 1) if it[1] not in _TOKEN), None)
    if not name:
        problem = "it is empty"
    elif len(name) > MAX_TOKEN:
        problem = f"it has {len(name)} characters, ROS 2 allows {MAX_TOKEN}"
    elif name[0] in _DIGITS:
        problem = f"it starts with the digit {name[0]!r}, which no ROS 2 name may"
    elif other:
        problem = f"character {other[0]}, {other[1]!r}, is not a letter, a digit or an underscore"
    elif "__" in name:
        problem = "it has two underscores in a row, which no remap rule can hold"
    else:
        return name
    raise UsageError(f"robot name {name!r}: {problem}; use for example {propose_token(name)!r}")


def numbered_names(count: int, stem: str = "robot") -> tuple[str, ...]:
    """Return the names of robots that only have a number: robot1, robot2 and so on."""
    return tuple(f"{stem}{number}" for number in range(1, count + 1))


def check_robot_names(names: Iterable[str]) -> tuple[str, ...]:
    """Return the names of several robots; raises UsageError for an invalid or repeated one."""
    seen: dict[str, str] = {}
    for name in names:
        if check_robot_name(name) in seen:
            raise UsageError(f"robot name {name!r} is given twice; every robot needs its own")
        seen[name] = name
    return tuple(seen)


def propose_token(name: str) -> str:
    """Return a valid token that is similar to ``name``."""
    kept = "".join(c if c in _TOKEN else "_" for c in name)
    while "__" in kept:
        kept = kept.replace("__", "_")
    kept = kept.strip("_")
    if not kept:
        return "robot1"
    return (kept if kept[0] in _LETTERS else f"robot_{kept}")[:MAX_TOKEN]
