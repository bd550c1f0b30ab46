# SPDX-License-Identifier: Apache-2.0
"""What a launch says of the conditions of a node's endpoints: its program, its command line, the files
that its parameters name, and who listens. What it does not say stays open."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import pairwise

from multibot_rewrite.base.lazy import COMMENT
from multibot_rewrite.base.rosnames import BoundNode, resolve_bound
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.knowledge.conditions import ALSO, HEARD, PROGRAM, Condition, settled, words_in
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.spelling.records import Given
from multibot_rewrite.system.records import TOPIC

Decide = Callable[[Condition], bool | None]
_COMMENTS = {
    ".xml": re.compile(COMMENT.decode()),
    ".lua": re.compile(r"--[^\n]*"),
    ".yaml": re.compile(r"(?m)(?:^|\s)#.*$"),
}


def as_started(node: NodeFacts, executable: str, words: Collection[str]) -> NodeFacts:
    """The node as this program has it with these arguments. A component runs in any program."""

    def decide(it: Condition) -> bool | None:
        if it.how == ":" and it.parameter == PROGRAM and "::" not in executable:
            return executable in it.values
        if it.parameter.startswith("-") and it.how in ("set", "unset"):
            return _is_given(it.parameter, words) == (it.how == "set")
        return None

    return _as_decided(node, decide)


def as_named(node: NodeFacts, words: Sequence[str], values: Mapping[str, Given]) -> NodeFacts:
    """The node as the files have it whose paths are in its arguments and parameters. A word that is
    not there may be in a file that is included."""
    options = dict(pairwise(words))

    def decide(it: Condition) -> bool | None:
        if it.how != "names":
            return None
        given = {**{name: one.value for name, one in values.items()}, **options}
        paths = [_path(name, given) for name in it.parameter.split(ALSO)]
        return any(_has(path, it.values) for path in paths) or None

    return _as_decided(node, decide)


def as_heard(node: NodeFacts, heard: Collection[str], bound: BoundNode) -> NodeFacts:
    """The node where these topics have a subscriber."""

    def decide(it: Condition) -> bool | None:
        own = it.values if it.how == ":" and it.parameter == HEARD else ()
        return any(resolve_bound(name, TOPIC, bound) in heard for name in own) or None

    return _as_decided(node, decide)


def asks_who_listens(node: NodeFacts) -> bool:
    """Has the node an endpoint only while somebody listens?"""
    return any(True for end in node.endpoints for _ in words_in(end.when, HEARD))


def _as_decided(node: NodeFacts, decide: Decide) -> NodeFacts:
    made = [(it, settled(it.when, decide)) for it in node.endpoints]
    ends = tuple(it._replace(when=when) for it, when in made if when is not None)
    return node._replace(endpoints=ends)


def _is_given(option: str, words: Collection[str]) -> bool:
    """Is the option one of the words? ``-`` alone is any word that is no option."""
    return any(it == option if option != "-" else not it.startswith("-") for it in words)


def _path(name: str, given: Mapping[str, object]) -> str:
    """The path that a parameter or option has: ``FOLDER/FILE`` asks two of them."""
    words = [str(given.get(it) or "") for it in name.split("/")]
    return os.path.join(*words) if all(words) else ""


def _has(path: str, words: Sequence[str]) -> bool:
    """Is one of the words in a file, but for its comments and how it is spaced?"""
    if not path or not os.path.isfile(path):
        return False
    text = read_file(path).decode("utf-8", "replace")
    comments = _COMMENTS.get(os.path.splitext(path)[1])
    plain = re.sub(r"(?<!\s)\s*=\s*", " = ", comments.sub(" ", text) if comments else text)
    return any(re.search(rf"(?<![\w/]){re.escape(it)}(?!\w)", plain) for it in words)
