# SPDX-License-Identifier: Apache-2.0
"""``multibot snapshot --form nodes``: a file of nodes and stacks from nodes that are running now."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence

from multibot_rewrite.base import editors
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import facts_of_release, release_here
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli import live
from multibot_rewrite.cli.output import deliver, goes_to_file, note, say, write_files
from multibot_rewrite.cli.process import DONE, PROGRAM
from multibot_rewrite.knowledge.node_library import NodeLibrary
from multibot_rewrite.knowledge.nodl.lookup import SUFFIXES
from multibot_rewrite.knowledge.nodl.writing import NodlFile, file_name
from multibot_rewrite.knowledge.stacks import built_in
from multibot_rewrite.live.learning.choosing import choose_nodes, helpers_without_owner, left_out
from multibot_rewrite.live.learning.learn import LearnedNode, learn
from multibot_rewrite.live.learning.nodes_file import to_yaml
from multibot_rewrite.live.learning.nodl_file import to_nodl
from multibot_rewrite.system.records import System, doubts

NODES, NODL = "nodes", "nodl"


def is_asked(options: argparse.Namespace) -> bool:
    """Are nodes to be described, not a snapshot to be written? Raises UsageError."""
    if options.form in (NODES, NODL) or is_nodl(options):
        return True
    given = [f"--{it}" for it in ("node", "namespace", "stack", "distro") if getattr(options, it)]
    if given:
        raise UsageError(f"{given[0]} is for a description of nodes: add --form {NODES}")
    return False


def write(options: argparse.Namespace, graph: System) -> int:
    """Learn, write, note what is left out; returns the exit code."""
    doubtful = doubts(graph)
    for caveat in doubtful:
        say(f"incomplete: {caveat.message}", PROGRAM)
    namespace = options.namespace or "/"
    names = choose_nodes(graph, options.node, namespace)
    release = release_here(options.distro)
    library = built_in(release)
    learned = learn(graph, names, namespace, library)
    remarks = [*_notes(graph, learned, options.namespace, bool(options.node))]
    as_nodl = is_nodl(options)
    stack = options.stack or "learned"
    if as_nodl:
        remarks += _write_nodl(options, _as_nodl(options, graph, learned, library))
    else:
        deliver(options, to_yaml(learned, stack, library).encode(), editors.NODES)
    for remark in remarks:
        note(options, f"note: {remark}")
    shape = "NoDL" if as_nodl else f"stack {stack}"
    what = f"{plural(len(learned), 'node')} learned as {shape}"
    note(options, f"{what}{facts_of_release(release)}")
    return live.INCONCLUSIVE if doubtful else DONE


def is_nodl(options: argparse.Namespace) -> bool:
    """Is the result NoDL, by --form or by the name of the file? Raises UsageError."""
    named = (options.output or "").endswith(SUFFIXES)
    if named and options.form not in (None, NODL):
        form = f"--form {options.form}"
        raise UsageError(f"{options.output} is the name of a NoDL file; leave out {form}")
    return named or options.form == NODL


def _as_nodl(
    options: argparse.Namespace, graph: System, learned: Sequence[LearnedNode], library: NodeLibrary
) -> list[NodlFile]:
    in_json = (options.output or "").endswith(".json")
    return [to_nodl(it, graph, options.namespace or "/", library, in_json) for it in learned]


def _write_nodl(options: argparse.Namespace, found: Sequence[NodlFile]) -> Iterator[str]:
    """Write a document to a file or standard output, several below a folder; what is left out."""
    if not goes_to_file(options) or options.output.endswith(SUFFIXES):
        if len(found) > 1:
            hint = "name one with --node, or a folder with -o"
            raise UsageError(f"a NoDL file is for one node, here are {len(found)}; {hint}")
        deliver(options, found[0].text.encode())
    else:
        items = [(os.path.join(options.output, file_name(it.node)), it.text) for it in found]
        write_files(options, [(path, text.encode()) for path, text in items])
    for it in found:
        if it.left_out:
            yield f"{it.node}: NoDL has no form for {', '.join(it.left_out)}; left out"


def _notes(
    graph: System, learned: Sequence[LearnedNode], namespace: str | None, named: bool
) -> Iterator[str]:
    for node in learned:
        yield from (f"{node.seen}: {remark}" for remark in node.remarks)
    lost = helpers_without_owner(graph, [node.seen for node in learned])
    if lost:
        yield f"whose helpers these are is not seen, they are left out: {', '.join(lost)}"
    tools = left_out(graph, [node.seen for node in learned], namespace or "/")
    if tools and not named:
        yield f"left out as tools: {', '.join(tools)}; to learn one give its name to --node"
    first = {node.facts.name.partition("/")[0] for node in learned if "/" in node.facts.name}
    if namespace is None and len(first) == 1 and all("/" in node.facts.name for node in learned):
        where = f"/{first.pop()}"
        yield f"all are below {where}; if that is the robot's namespace, add --namespace {where}"
