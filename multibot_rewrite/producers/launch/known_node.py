# SPDX-License-Identifier: Apache-2.0
"""What is known of a launched node, as its program has it with these arguments, or by its source.

A launch says of the conditions of its endpoints: its program, its command line, the files that its
parameters name, and who listens. What it does not say stays open. A static_transform_publisher is told
its frames."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import suppress
from itertools import pairwise

from multibot_rewrite.base.lazy import COMMENT, lazy_compile
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.rosnames import (
    BoundNode,
    check_namespace,
    check_node_name,
    propose_token,
    resolve_bound,
)
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.knowledge.conditions import ALSO, HEARD, PROGRAM, Condition, settled, words_in
from multibot_rewrite.knowledge.programs import runs
from multibot_rewrite.knowledge.records import FrameParameter, NodeFacts, SentTransform
from multibot_rewrite.planning.records import Given
from multibot_rewrite.producers.launch.programs import passes, programs
from multibot_rewrite.producers.launch.records import LaunchedNode, LaunchOrder
from multibot_rewrite.producers.launch.source_packages import packages_for
from multibot_rewrite.related_files.lua import lua_values
from multibot_rewrite.system.records import TOPIC

LUA_FLAGS = ("-configuration_directory", "-configuration_basename")  # node_main.cpp
Decide = Callable[[Condition], bool | None]
_COMMENTS = {
    ".xml": lazy_compile(COMMENT.decode()),
    ".yaml": lazy_compile(r"(?m)(?:^|\s)#.*$"),
}


def as_started(node: NodeFacts, executable: str, words: Collection[str]) -> NodeFacts:
    """Return the node as this program has it with these arguments. A component runs in any program."""

    def decide(it: Condition) -> bool | None:
        """Return whether a condition about program or arguments holds; None for another one."""
        if it.how == ":" and it.parameter == PROGRAM and "::" not in executable:
            return executable in it.values
        if it.parameter.startswith("-") and it.how in ("set", "unset"):
            # ``-`` alone is any word that is no option.
            bare = any(not word.startswith("-") for word in words)
            given = bare if it.parameter == "-" else it.parameter in words
            return given == (it.how == "set")
        return None

    return _with_decided_ends(node, decide)


def as_named(node: NodeFacts, words: Sequence[str], values: Mapping[str, Given]) -> NodeFacts:
    """Return the node as files in its arguments and parameters have it; what they lack is open."""
    options = dict(pairwise(words))

    def decide(it: Condition) -> bool | None:
        """Return True if a file names what a condition asks for; None if that is open."""
        if it.how != "names":
            return None
        given = {**{name: one.value for name, one in values.items()}, **options}
        paths = (str(given.get(name) or "") for name in it.parameter.split(ALSO))
        return any(_has(path, it.values) for path in paths) or None

    return _with_decided_ends(node, decide)


def with_options(words: Sequence[str], values: Mapping[str, Given]) -> Mapping[str, Given]:
    """Return the values with those of the Lua file that is in the arguments."""
    path = lua_file(words)
    with suppress(InputError):
        values = {**values, **lua_values(read_file(path), path)} if path else values
    return values


def lua_file(words: Sequence[str]) -> str:
    """Return the path of the Lua file that is in the arguments; empty for none."""
    options = dict(pairwise(words))
    return os.path.join(*(options.get(it, "") for it in LUA_FLAGS))


def as_heard(node: NodeFacts, heard: Collection[str], bound: BoundNode) -> NodeFacts:
    """Return the node with the ends that it has while these topics have subscribers."""

    def decide(it: Condition) -> bool | None:
        """Return True if somebody subscribes to a topic of the condition; None if that is open."""
        own = it.values if it.how == ":" and it.parameter == HEARD else ()
        return any(resolve_bound(name, TOPIC, bound) in heard for name in own) or None

    return _with_decided_ends(node, decide)


def asks_who_listens(node: NodeFacts) -> bool:
    """Return whether the node has an endpoint only while it has subscribers."""
    return any(True for end in node.endpoints for _ in words_in(end.when, HEARD))


def _with_decided_ends(node: NodeFacts, decide: Decide) -> NodeFacts:
    made = [(it, settled(it.when, decide)) for it in node.endpoints]
    ends = tuple(it._replace(when=when) for it, when in made if when is not None)
    return node._replace(endpoints=ends)


def _has(path: str, words: Sequence[str]) -> bool:
    """Return whether a file has one of the words, except in comments and however it is spaced."""
    if not os.path.isfile(path):
        return False
    text = read_file(path).decode("utf-8", "replace")
    comments = _COMMENTS.get(os.path.splitext(path)[1])
    plain = re.sub(r"(?<!\s)\s*=\s*", " = ", comments.sub(" ", text) if comments else text)
    return any(re.search(rf"(?<![\w/]){re.escape(it)}(?!\w)", plain) for it in words)


_CAMEL = lazy_compile(r"(?<=[a-z0-9])(?=[A-Z])")


def own_name(it: LaunchedNode, facts: NodeFacts | None) -> str:
    """Return the name that a node has by its code; empty if unknown."""
    return programs().names.get(f"{it.package}/{it.executable}") or (facts.name if facts else "")


def guessed_name(it: LaunchedNode) -> str:
    """Return a name for a node whose own one nobody knows, by its program, as ROS takes it."""
    return propose_token(_last_word(it))


def check_names(it: LaunchedNode) -> None:
    """Raise InputError where ROS refuses the name or the namespace that a launch file gives a node."""
    fault = check_node_name(it.name) if it.name else None
    what, given = "name", it.name
    if fault is None:
        fault = check_namespace(f"/{it.namespace.strip('/')}")
        what, given = "namespace", it.namespace
    if fault is not None:
        said = f"a node has the {what} {given!r}, which ROS refuses: {fault.reason}"
        raise InputError(f"{it.place}: {said}; write letters, digits and underscores")


def _last_word(it: LaunchedNode) -> str:
    """Return the program, or the class of a component, without its namespace."""
    return it.executable.rpartition(":")[2].removesuffix(".py")


def _snake_case(name: str) -> str:
    return _CAMEL.sub("_", name).lower()


def known_node(
    it: LaunchedNode, node_set: Sequence[NodeFacts], known: Mapping[str, NodeFacts]
) -> NodeFacts | None:
    """Return what is known of a node: by its name in a node set, or by package and executable."""
    executable = _snake_case(_last_word(it))
    program = f"{it.package}/{it.executable}"
    of_set = (node for node in node_set if node.name == it.name and node.package == it.package)
    wanted = {it.name, it.executable, executable, executable.removesuffix("_node")}
    of_package = (node for node in known.values() if node.package == it.package and not node.host)
    # A component that has a program of its own is called as its class: RectifyNode, rectify_node.
    by_word = (node for node in of_package if {node.name, _snake_case(node.name)} & wanted)
    chosen = (node for node in known.values() if runs(node, program))
    found = next(of_set, None) or next(chosen, None) or next(by_word, None)
    if found is None:
        return None
    started = as_started(found, it.executable, it.arguments)
    # Where no endpoint is left, it is started in a way that its entry does not tell.
    return started if started.endpoints or not found.endpoints else None


STATIC = "static_transform_publisher"
_PARENT, _CHILD = "frame_id", "child_frame_id"
_FLAGS = {"--frame-id": _PARENT, "--child-frame-id": _CHILD}


def with_static_transform(node: NodeFacts, words: Sequence[str]) -> NodeFacts:
    """Return the node with a static transform's frames; unchanged if it is another, or unknown."""
    if node.known != STATIC:
        return node
    named = frames_in(words)
    frames = tuple(_framed(it, named) for it in node.frames)
    known = {it.parameter for it in frames if it.given and it.default}
    sends = (SentTransform(_PARENT, _CHILD),) if {_PARENT, _CHILD} <= known else ()
    return node._replace(frames=frames, sends=sends)


def frames_in(words: Sequence[str]) -> Mapping[str, str]:
    """Return the frames in a static_transform_publisher's arguments, by their parameters."""
    flags = {flag: word for flag, word in pairwise(words) if flag.startswith("--")}
    if flags:
        return {_FLAGS[flag]: word for flag, word in flags.items() if flag in _FLAGS}
    return dict(zip((_PARENT, _CHILD), words[-2:], strict=True)) if len(words) in (8, 9) else {}


def with_frames(words: Sequence[str], frames: Mapping[str, str]) -> tuple[str, ...]:
    """Return the arguments of a static transform publisher with other frames."""
    named = frames_in(words)
    if not any(word.startswith("--") for word in words):
        return (
            (*words[:-2], *(frames.get(it, named[it]) for it in (_PARENT, _CHILD)))
            if named
            else (*words,)
        )
    flags = ("", *words[:-1])
    return tuple(
        frames.get(_FLAGS.get(flag, ""), it) for flag, it in zip(flags, words, strict=True)
    )


def _framed(frame: FrameParameter, named: Mapping[str, str]) -> FrameParameter:
    """Return a frame parameter without a leading slash, as tf2 (buffer_core.cpp, stripSlash)."""
    name = named.get(frame.parameter) or frame.default
    given = frame.given or bool(named.get(frame.parameter))
    return frame._replace(default=name.lstrip("/") if given else name, given=given)


def with_sources(
    known: Mapping[str, NodeFacts],
    nodes: Iterable[LaunchedNode],
    orders: Iterable[LaunchOrder],
    release: str,
) -> dict[str, NodeFacts]:
    """Return known nodes and, by ``package program``, unknown ones whose source is found."""
    wanted = {(it.package, it.executable): it for it in nodes if not passes(it)}
    unknown = [program for program, it in wanted.items() if known_node(it, (), known) is None]
    if not unknown:
        return dict(known)
    from multibot_rewrite.producers.sources.facts import node_of_program

    folders: dict[str, str] = {}
    for order in orders:
        folders = {**packages_for(order.file, order.roots), **folders}
    every = dict(known)
    for package, program in (it for it in unknown if it[0] in folders):
        # C++ without its reader: who says that a node is not known, says so.
        with suppress(UsageError):
            found = node_of_program(folders[package], package, program, folders, release)
            if found:
                name = f"{package} {program}"
                every[name] = found.facts._replace(known=name)
    return every
