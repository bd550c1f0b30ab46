# SPDX-License-Identifier: Apache-2.0
"""ROS 2 names and remap rules, as rcl 9.2 (Jazzy) reads and applies them. Pure text, no ROS needed.

Sources: rcl ``arguments.c`` (``_rcl_parse_remap_begin_remap_rule`` and what it calls) and
``lexer.c`` for the form of a rule, ``node.c`` for the node's own name, ``remap.c`` and
``node_resolve_name.c`` for the rest.
"""

import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.rosnames.names import (
    MAX_TOKEN as MAX_TOKEN,
    MOST as MOST,
    NameFault as NameFault,
    check_full_name as check_full_name,
    check_name_in_code as check_name_in_code,
    check_namespace as check_namespace,
    check_node_name as check_node_name,
    check_robot_name as check_robot_name,
    check_robot_names as check_robot_names,
    check_topic_name as check_topic_name,
    expand as expand,
    numbered_names as numbered_names,
    propose_token as propose_token,
)

TOPIC_SCHEME, SERVICE_SCHEME = SCHEMES = ("rostopic://", "rosservice://")
NAMESPACE_KEY, NODE_KEYS = "__ns", ("__node", "__name")
# lexer.c S3, S9, S10: two underscores in a row end a token, so no rule can hold such a name.
_ONE = r"(?:[A-Za-z]|_(?!_))(?:[A-Za-z0-9]|_(?!_))*"
_TOKEN = lazy_compile(_ONE)
# Braces are not in the lexer's alphabet: a rule cannot hold {node} or {ns}.
_PATH = lazy_compile(rf"(?:~?/)?{_ONE}(?:/{_ONE})*")
_NAMESPACE = lazy_compile(rf"/(?:{_ONE}(?:/{_ONE})*/?)?")
_FORMS = {_PATH: "a name", _TOKEN: "a node's name", _NAMESPACE: "a namespace that starts with '/'"}
_HINTS = {mark: said for (mark,), said in ROWS["no rules"]}


class RemapRule(NamedTuple):
    """A parsed remap rule with the position of each part in its text.

    ``node`` is the empty string for a rule that holds for every node of the process; ``source`` is
    ``__ns``, ``__node`` or ``__name`` for the special rules. ``scheme`` is one of ``SCHEMES``, or
    empty for a rule that holds for topics and services alike.
    """

    node: str
    source: str
    target: str
    source_at: int
    target_at: int
    scheme: str


class BoundNode(NamedTuple):
    """A node under its rules: its final name and namespace, and where its full names are sent."""

    node: str
    namespace: str
    topics: Mapping[str, str]
    services: Mapping[str, str]


def parse_remap(text: str) -> RemapRule | None:
    """Return the rule that rcl makes of ``text``, the word after ``-r``; None if rcl refuses it."""
    rule = read_remap(text)
    return None if isinstance(rule, NameFault) else rule


def read_remap(text: str) -> RemapRule | NameFault:
    """Return the rule that rcl makes of ``text``, or the reason and place of its refusal."""
    token = _TOKEN.match(text)
    # A colon may be that of ``:=`` or of a scheme, not that of a node's name.
    colon = token.end() if token and not text.startswith(SCHEMES) else len(text)
    prefixed = text.startswith(":", colon) and not text.startswith(":=", colon)
    node = token[0] if token and prefixed else ""
    at = len(node) + 1 if node else 0
    for key, form in ((NAMESPACE_KEY, _NAMESPACE), *((key, _TOKEN) for key in NODE_KEYS)):
        if text.startswith(key, at):
            return _sides(text, node, "", (at, at + len(key)), form)
    scheme = next((scheme for scheme in SCHEMES if text.startswith(scheme, at)), "")
    at += len(scheme)
    source = _PATH.match(text, at)
    if source is None:
        return _unexpected_character(text, at, "a name")
    return _sides(text, node, scheme, source.span(), _PATH)


def _sides(
    text: str, node: str, scheme: str, source: tuple[int, int], form: re.Pattern[str]
) -> RemapRule | NameFault:
    """Return the rule with its left side up to ``source[1]`` and its right side, or its fault."""
    start, end = source
    if not text.startswith(":=", end):
        return _unexpected_character(text, end, "':='")
    target = None if text.startswith(SCHEMES, end + 2) else form.match(text, end + 2)
    if target is None:
        return _unexpected_character(text, end + 2, _FORMS[form])
    if target.end() != len(text):
        return _unexpected_character(text, target.end(), "the end")
    return RemapRule(node, text[start:end], target[0], start, end + 2, scheme)


def _unexpected_character(text: str, at: int, wanted: str) -> NameFault:
    found = next((hint for key, hint in _HINTS.items() if text.startswith(key, at)), "")
    if not found:
        found = repr(text[at]) if at < len(text) else "the end"
    return NameFault(f"character {at + 1}: expected {wanted}, found {found}", at)


def split_remap(text: str) -> RemapRule | None:
    """Split ``[node:][rostopic://]from:=[rostopic://]to`` in a file; None where it is no rule.

    Lenient where ``parse_remap`` is not: a file may hold ``${prefix}scan:=x``, whose names are not
    known before xacro has run.
    """
    left, found, right = text.partition(":=")
    colon = left.find(":")
    node = "" if colon <= 0 or left.startswith("://", colon) else left[:colon]
    at = len(node) + 1 if node else 0
    scheme = next((s for s in SCHEMES if left.startswith(s, at)), "")
    source_at = at + len(scheme)
    target_at = len(left) + 2 + next((len(s) for s in SCHEMES if right.startswith(s)), 0)
    source, target = left[source_at:], text[target_at:]
    if not found or not source.strip() or not target.strip() or ":" in source or ":=" in target:
        return None
    return RemapRule(node, source, target, source_at, target_at, scheme)


def remapped_node(node: str, namespace: str, rules: Iterable[RemapRule]) -> tuple[str, str]:
    """Return the final name and namespace of ``node``; raises UsageError if rcl refuses to start it.

    ``rules`` are the node's own ones followed by the process's (remap.c: local before global, the first
    match wins). A rule for one node's namespace asks for the node's *new* name, since rcl changes the
    name first (node.c). An empty namespace is ``/``, a missing first slash is added.
    """
    rules = tuple(rules)
    namespace = namespace if namespace.startswith("/") else f"/{namespace}"
    _raise_fault("node name", node, check_node_name(node))
    _raise_fault("namespace", namespace, check_namespace(namespace))
    node = _first_target(rules, NODE_KEYS, node) or node
    namespace = _first_target(rules, (NAMESPACE_KEY,), node) or namespace
    # rmw_create_node looks at both once more: a rule may end in a slash or be too long.
    _raise_fault("node name", node, check_node_name(node))
    _raise_fault("namespace", namespace, check_namespace(namespace))
    return node, namespace


def _first_target(rules: Iterable[RemapRule], keys: tuple[str, ...], node: str) -> str:
    """Return the right side of the first rule for the node with one of the keys on its left, or ""."""
    return next((r.target for r in rules if r.source in keys and r.node in ("", node)), "")


def _raise_fault(what: str, name: str, fault: NameFault | None) -> None:
    if fault is not None:
        raise UsageError(f"{what} {name!r}: {fault.reason}")


def bind(node: str, namespace: str, rules: Iterable[RemapRule]) -> BoundNode:
    """Put ``node`` under its rules (own ones, then the process's), for many names to be resolved.

    A rule's left side is expanded by the node's final name and namespace and compared with the
    expanded name as text; its right side is expanded likewise (remap.c). A prefix ``node:`` asks
    for the final name too. Raises UsageError where rcl refuses to start the node.
    """
    rules = tuple(rules)
    node, namespace = remapped_node(node, namespace, rules)
    topics: dict[str, str] = {}
    services: dict[str, str] = {}
    for rule in rules:
        if rule.node not in ("", node) or rule.source.startswith("__"):
            continue
        source, target = expand(rule.source, namespace, node), expand(rule.target, namespace, node)
        if rule.scheme != SERVICE_SCHEME:
            topics.setdefault(source, target)
        if rule.scheme != TOPIC_SCHEME:
            services.setdefault(source, target)
    return BoundNode(node, namespace, topics, services)


def resolve_bound(name: str, kind: str, bound: BoundNode) -> str:
    """Return the name that a name of a bound node becomes; UsageError where rcl refuses the name.

    ``kind`` is ``topic`` or ``service``. One step only: the result is not remapped again."""
    _raise_fault(f"{kind} name", name, check_topic_name(name))
    full = expand(name, bound.namespace, bound.node)
    if "{" in full:
        unknown = "{" + full.partition("{")[2].partition("}")[0] + "}"
        raise UsageError(
            f"{kind} name {name!r}: {unknown} is not known, use {{node}}, {{ns}} or {{namespace}}"
        )
    full = (bound.services if kind == "service" else bound.topics).get(full, full)
    _raise_fault(f"{kind} name", full, check_full_name(full))
    return full
