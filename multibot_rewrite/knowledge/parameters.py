# SPDX-License-Identifier: Apache-2.0
"""The parameters of known nodes in a release: by node, by the type of a controller, by their paths."""

import re
from collections.abc import Iterable, Iterator, Mapping
from fnmatch import translate
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.knowledge.node_entries import OWN_KINDS, has_default
from multibot_rewrite.knowledge.node_library import NodeLibrary
from multibot_rewrite.knowledge.node_sets import every_release, with_file
from multibot_rewrite.knowledge.records import Branch, NodeParameters, Param

# Undeclared names of these kinds stay as they are, so a wrong guess does no harm.
SAFE_KINDS = ("link", "joint")
_INDEX = "<index>"


class KnownNodes(NamedTuple):
    """All known nodes; ``names`` and ``types`` lead to them.

    ``anywhere`` is what is the same in every node that has it, ``guesses`` are last words of other
    paths (``guessing`` as one expression), ``sent`` frames that nodes send."""

    nodes: Mapping[str, NodeParameters]
    names: Mapping[str, str]
    types: Mapping[str, str]
    anywhere: Branch
    guesses: Mapping[str, tuple[str, ...]]
    guessing: re.Pattern[str]
    sent: frozenset[str]


@lru_cache
def built_in_nodes(release: str) -> KnownNodes:
    """Return the nodes that this package knows, with the defaults of a release."""
    return _known_nodes(every_release(), release)


def load_known_nodes(path: str, release: str) -> KnownNodes:
    """Return the built-in nodes with those of a user's file; raises UsageError with file and line."""
    return _known_nodes(with_file(path), release) if path else built_in_nodes(release)


def is_absolute(param: Param, release: str) -> bool:
    """Return whether a relative topic in it is outside the robot's namespace in this release."""
    return bool(param.absolute) and has_release(param.absolute, release)


def is_below_costmap(plugin: str) -> bool:
    """Return whether a plugin is the one filter with topics below the costmap in every release."""
    return "BinaryFilter" in plugin


def is_called(param: Param, name: str) -> bool:
    """Return whether a parameter of this dotted name may be the known one."""
    own, words = param.path.split("."), name.split(".")
    return len(own) == len(words) and all(
        a in (b, "*") or a.startswith("<") for a, b in zip(own, words, strict=True)
    )


def guess(known: KnownNodes, path: str) -> str:
    """Return the kind that the last word of a path suggests; empty for none."""
    found = known.guessing.fullmatch(path, path.rfind(".") + 1)
    return (found.lastgroup or "") if found else ""


def _known_nodes(library: NodeLibrary, release: str) -> KnownNodes:
    nodes = {it.name: _node_in_release(it, release) for it in library.parameters.values()}
    facts = library.parameters.values()
    names = {alias: it.name for it in facts for alias in (*it.aliases, it.name)}
    types = {type_: it.name for it in facts for type_ in it.types}
    # One expression for all guesses, with a group for each kind.
    every = {kind: "|".join(map(translate, words)) for kind, words in library.guesses.items()}
    guessing = re.compile("|".join(f"(?P<{kind}>{words})" for kind, words in every.items()))
    return KnownNodes(
        nodes,
        names | {name: name for name in nodes},
        types,
        _tree_of(_anywhere(nodes.values(), guessing)),
        library.guesses,
        guessing,
        library.sent,
    )


def _node_in_release(facts: NodeParameters, release: str) -> NodeParameters:
    """Return a node in a release; what that lacks is as the last release had it, for older files."""
    params: dict[str, Param] = {}
    for it in facts.forms:
        if it.path not in params or not has_release(params[it.path].releases, release):
            params[it.path] = it
    here = has_release(facts.releases, release)
    there = [it for it in params.values() if here and has_release(it.releases, release)]
    defaults = tuple(it for it in there if has_default(it))
    return facts._replace(params=params, tree=_tree_of(params.values()), defaults=defaults)


def _anywhere(nodes: Iterable[NodeParameters], guessing: re.Pattern[str]) -> Iterator[Param]:
    """Yield parameters that mean the same in several nodes, or whose name suggests their meaning."""
    every = (param for node in nodes for param in node.params.values())
    plain = (it for it in every if "*" not in it.path and "<" not in it.path.replace(_INDEX, ""))
    found = lists_by_key((it.path, it) for it in plain)
    for path, params in found.items():
        kind = params[0].kind
        sure = len(params) > 1 or kind in SAFE_KINDS or path.endswith(_INDEX)
        guessed = guessing.fullmatch(path.rpartition(".")[2])
        # What is [position] in a known controller may be [elbow/position] in another one.
        if kind == "keep" and guessed and guessed.lastgroup == "interface":
            continue
        alike = kind not in OWN_KINDS and len({it.kind for it in params}) == 1
        if alike and (sure or (guessed and guessed.lastgroup == kind)):
            yield params[0]._replace(default="", absolute="")


def _tree_of(params: Iterable[Param]) -> Branch:
    """Return the parameters as a tree by the segments of their paths."""
    root = Branch({}, {}, {}, [])
    for param in params:
        branch = root
        for segment in param.path.split("."):
            if segment.endswith(_INDEX):
                where, key = branch.numbered, segment.removesuffix(_INDEX)
            elif segment == "*" or segment.startswith("<"):
                where, key = branch.wild, segment.strip("<>")
            else:
                where, key = branch.exact, segment
            branch = where.setdefault(key, Branch({}, {}, {}, []))
        branch.params.append(param)
    return root
