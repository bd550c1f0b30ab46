# SPDX-License-Identifier: Apache-2.0
"""Nodes and controllers that no section is for -> sections with what must differ by robot.

Without a section a node runs with its defaults: amcl looks for base_footprint, and a controller puts an
empty prefix before joints, where the description of each robot has another name.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.naming import spelled
from multibot_rewrite.companions.context import Context, full_name
from multibot_rewrite.companions.params.sections import (
    ANY,
    MANAGER,
    PARAMETERS,
    ParamSection,
    RawSection,
    controller_types,
    flattened,
    identify_node,
    identify_sections,
    is_for,
)
from multibot_rewrite.companions.params.shared_defaults import (
    DefaultLine,
    bare_frames,
    missing_defaults,
    not_inserted,
)
from multibot_rewrite.companions.params.values import ParamsJob
from multibot_rewrite.companions.template import NAMESPACE_SLOT
from multibot_rewrite.companions.yaml_blocks import inserted, newline
from multibot_rewrite.companions.yaml_text import Splice, YamlText
from multibot_rewrite.knowledge.parameters import KnownNodes


def lacking_sections(
    job: ParamsJob, found: Sequence[RawSection], beside: Iterable[RawSection], is_first: bool
) -> Iterator[Splice | Finding]:
    """The sections that a file lacks, behind its end; ``found`` are those it has, ``beside`` those of
    the robot's other files. The first file gets those of the stack's nodes as well."""
    every = [*found, *beside]
    lacking = [(_key(path, job.context), it) for path, it in _of_controllers(job, found, every)]
    lacking += _of_nodes(job.context, job.known, job.at_run_time, every) if is_first else ()
    if takes_sections(job.document):
        end, at = newline(job.document), len(job.document.text)
        text = "".join(f"{line}{end}" for it in lacking for line in _section(*it))
        yield inserted(job.document, at, text)
        return
    for key, lines in lacking:
        yield not_inserted(job.document, found[-1].keys[0], lines, key)


def all_sections(context: Context, known: KnownNodes, at_run_time: Collection[str]) -> str:
    """The sections of a robot without a parameter file, with slots; empty if its nodes need none."""
    lacking = _of_nodes(context, known, at_run_time, ())
    return "".join(f"{line}\n" for it in lacking for line in _section(*it))


def takes_sections(document: YamlText) -> bool:
    """Can a section stand behind its last line?"""
    root = document.root
    plain = isinstance(root, yaml.MappingNode) and not root.flow_style
    ends = re.search(r"^(?:\.\.\.|---)", document.text[1:], re.MULTILINE)
    return plain and root is not None and root.start_mark.column == 0 and not ends


def _of_controllers(
    job: ParamsJob, found: Sequence[RawSection], every: Sequence[RawSection]
) -> Iterator[tuple[str, list[DefaultLine]]]:
    """The paths of controllers that no section is for, and what they need."""
    named = {it.path.rpartition("/")[2] for it in every}
    for manager in (it for it in found if it.path.rpartition("/")[2] == MANAGER):
        types = controller_types([manager])
        for name in (it for it in types if it not in named):
            node = identify_node(name, None, job.known, types)
            path = f"{manager.path.removesuffix(MANAGER)}{name}"
            lines = list(missing_defaults(job.context, node, _set(path, every))) if node else []
            if lines:
                yield path, lines


def _of_nodes(
    context: Context, known: KnownNodes, at_run_time: Collection[str], every: Sequence[RawSection]
) -> Iterator[tuple[str, list[DefaultLine]]]:
    """The full names of nodes of the stack that no section is for, and what they need."""
    types = controller_types(every)
    own = [it.full for it in identify_sections(every, context, known) if not _is_of_all(it)]
    for name, full in context.nodes.items():
        last = name.rpartition("/")[2]
        shared = NAMESPACE_SLOT not in full
        if shared or last in types or any(is_for(it, full) for it in own):
            continue
        if node := identify_node(last, None, known, types):
            bare = bare_frames(node) if last in at_run_time else ()
            lines = list(missing_defaults(context, node, {*_set(name, every), *bare}))
            if lines:
                yield full, lines


def _is_of_all(section: ParamSection) -> bool:
    """Is it for nodes of any name?"""
    return section.path.rpartition("/")[2] in ANY


def _set(path: str, every: Iterable[RawSection]) -> set[str]:
    """What sections of many nodes set for it, too."""
    fitting = (it for it in every if is_for(it.path, f"/{path.strip('/')}"))
    return {name for it in fitting for name, _ in flattened(it.body)}


def _key(path: str, context: Context) -> str:
    *above, name = path.strip("/").split("/")
    if any(it in ANY or PLACEHOLDER.search(it) for it in above):
        return f"/**/{spelled(context.topics.naming, NAMESPACE_SLOT, 'node', name)}"
    return full_name("/".join((*above, name)), context.topics.naming)


def _section(full: str, lines: Sequence[DefaultLine]) -> Iterator[str]:
    """Under keys of their own for a node in a namespace below the robot's: behind a key with a slash
    that is not at the top rcl takes the next section for one of that namespace (rcl_yaml_param_parser
    namespace.c, ``rem_name_from_ns``), and nav2_bringup puts a key above all of them."""
    yield from dict.fromkeys(it.comment for it in lines)
    *above, name = full.strip("/").split("/")
    keys = (f"/{'/'.join(above)}", name) if len(above) > 1 else (full,)
    yield from (f"{'  ' * at}{key}:" for at, key in enumerate((*keys, PARAMETERS)))
    yield from (f"{'  ' * (len(keys) + 1)}{it.path}: {it.value}" for it in lines)
