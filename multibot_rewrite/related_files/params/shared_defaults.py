# SPDX-License-Identifier: Apache-2.0
"""Inserts what a parameter file lacks and robots would share; writes files for nav2_bringup.

Without a section a node runs with its defaults: amcl looks for base_footprint, and a controller
puts an empty prefix before joints, where the description of each robot has another name. The
launch files of nav2_bringup put a file below the robot's namespace (RewrittenYaml with
``root_key``), so a namespace of its own would be there twice, and rcl refuses
``/robot1//robot1/``. slam_toolbox is the one node that gets the file as it is, and only if the
file has a key of that name (HasNodeParams). Sources: nav2_bringup launch/slam_launch.py,
nav2_common rewritten_yaml.py and has_node_params.py, all releases from humble (1.1.20) to
rolling (a3a97043e)."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, declare
from multibot_rewrite.base.naming import spelled
from multibot_rewrite.knowledge.node_entries import PREFIX_KINDS
from multibot_rewrite.knowledge.parameters import KnownNodes
from multibot_rewrite.knowledge.records import NodeParameters
from multibot_rewrite.related_files.context import NAMESPACE_SLOT, Context, full_name
from multibot_rewrite.related_files.names.by_kind import SPELLERS, expressible
from multibot_rewrite.related_files.params.name_sites import SectionNames
from multibot_rewrite.related_files.params.rcl_parameters import parameters_text
from multibot_rewrite.related_files.params.sections import (
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
    raw_sections,
)
from multibot_rewrite.related_files.params.values import NO_PREFIX, ParamsJob, frames_stay
from multibot_rewrite.related_files.yaml_text import (
    Splice,
    YamlText,
    found_at,
    inserted as lines_inserted,
    line_start,
    newline,
    pairs,
    quoted,
    replaced,
    spliced,
)

DEFAULT = "# multibot: the default is every robot's"
OFF = "# multibot: the default puts the namespace before frames"
OWN_FRAME = "# multibot: the robot has this frame in the place of the default"
_FRAMES = ("frame", "link", "stem", "interface", *PREFIX_KINDS)


class DefaultLine(NamedTuple):
    """A parameter to insert: its comment, path and value as YAML."""

    comment: str
    path: str
    value: str


def default_lines(
    job: ParamsJob, pages: Sequence[tuple[ParamSection, SectionNames]], beside: Sequence[RawSection]
) -> Iterator[Splice | Finding]:
    """Yield lines for the first section of each known node, unless another file sets them."""
    # What is set for which nodes, if patterns or other files set more than the section itself.
    several = beside or any(it.wild for it, _ in pages)
    bodies = [(it.full, it.body) for it, _ in pages] if several else []
    bodies += [(f"/{it.path}", it.body) for it in beside]
    everywhere = [(full, {name for name, _ in flattened(body)}) for full, body in bodies]
    done: set[str] = set()
    for section, _ in pages:
        if section.node is None or section.shared or section.inner or section.full in done:
            continue
        done.add(section.full)
        same = [names.known for other, names in pages if other.full == section.full]
        # What is set by any section that is, or may be, for the same node.
        found: set[str] = set()
        for full, names in everywhere:
            if (
                f"/{section.path}" == full
                or ("*" in full and is_for(full, section.full))
                or (section.wild and is_for(section.full, full))
            ):
                found |= names
        here = set().union(*same) | found
        there = here | bare_frames(section.node) if frames_stay(job, section) else here
        lines = list(missing_defaults(job.context, section.node, there))
        if lines:
            yield inserted(job.document, section.body, lines)


def bare_frames(node: NodeParameters) -> set[str]:
    """Return the parameters of a node that hold frames and have a default."""
    return {it.path for it in node.defaults if it.kind == "frame"}


def missing_defaults(
    context: Context, node: NodeParameters, here: set[str]
) -> Iterator[DefaultLine]:
    """Yield the parameters of a node whose default must differ from robot to robot."""
    for param in node.defaults:
        if param.path in here:
            continue
        if param.kind == "off":
            yield DefaultLine(OFF, param.path, "false")
        elif param.kind == "no_prefix":
            yield DefaultLine(OFF, param.path, quoted(NO_PREFIX))
        elif param.kind in _FRAMES and expressible(context, param.kind):
            own = context.frames.get((node.name, param.path), param.default)
            text = SPELLERS[param.kind](context, own)
            if text != param.default:
                yield DefaultLine(
                    DEFAULT if own == param.default else OWN_FRAME, param.path, quoted(text)
                )


NOT_INSERTED = declare("MF124", "default-not-inserted", WARNING, formats=("params",))


def inserted(
    document: YamlText, body: yaml.MappingNode, lines: Sequence[DefaultLine]
) -> Splice | Finding:
    """Return the splice with lines before the first parameter, with its indentation."""
    if not body.value:
        text = ", ".join(f"{line.path}: {line.value}" for line in lines)
        at = body.start_mark.index + 1
        return Splice(at, at, text)
    at = body.value[0][0].start_mark.index
    before = document.text[line_start(document, at) : at]
    if body.flow_style:
        text = "".join(f"{line.path}: {line.value}, " for line in lines)
        return Splice(at, at, text)
    if before.strip():
        return not_inserted(document, body, lines)
    end, text = newline(document) + before, ""
    for comment in dict.fromkeys(line.comment for line in lines):
        own = (f"{it.path}: {it.value}" for it in lines if it.comment == comment)
        text += "".join(f"{it}{end}" for it in (comment, *own))
    return Splice(at, at, text)


def not_inserted(
    document: YamlText, node: yaml.Node, lines: Sequence[DefaultLine], of: str = ""
) -> Finding:
    """Return the finding that lines cannot be inserted; ``of`` is a ROS node without a section."""
    names = ", ".join(line.path for line in lines)
    whose = f"{of} has no section: " if of else ""
    message = (
        f"{whose}{names}: all robots would share the default, and no line can be inserted here"
    )
    return found_at(document, node, NOT_INSERTED, message, "write each parameter on its own line")


def lacking_sections(
    job: ParamsJob, found: Sequence[RawSection], beside: Iterable[RawSection], is_first: bool
) -> Iterator[Splice | Finding]:
    """Yield the sections to add that neither this file nor the robot's others have."""
    # The first file gets those of the node set's nodes as well.
    every, lacking = [*found, *beside], []
    named = {it.path.rpartition("/")[2] for it in every}
    for manager in (it for it in found if it.path.rpartition("/")[2] == MANAGER):
        types = controller_types([manager])
        for name in (it for it in types if it not in named):
            node = identify_node(name, None, job.known, types)
            path = f"{manager.path.removesuffix(MANAGER)}{name}"
            here = _set_by_all(path, every)
            if lines := list(missing_defaults(job.context, node, here)) if node else []:
                lacking.append((_section_key(path, job.context), lines))
    lacking += _lacking_nodes(job.context, job.known, job.at_run_time, every) if is_first else ()
    if takes_sections(job.document):
        end, at = newline(job.document), len(job.document.text)
        text = "".join(f"{line}{end}" for it in lacking for line in _section_lines(*it))
        yield lines_inserted(job.document, at, text)
        return
    for key, lines in lacking:
        yield not_inserted(job.document, found[-1].keys[0], lines, key)


def all_sections(context: Context, known: KnownNodes, at_run_time: Collection[str]) -> str:
    """Return the sections of a robot without a parameter file, with slots; possibly empty."""
    lacking = _lacking_nodes(context, known, at_run_time, ())
    return "".join(f"{line}\n" for it in lacking for line in _section_lines(*it))


def takes_sections(document: YamlText) -> bool:
    """Return whether a section can follow its last line."""
    root = document.root
    plain = isinstance(root, yaml.MappingNode) and not root.flow_style
    ends = re.search(r"^(?:\.\.\.|---)", document.text[1:], re.MULTILINE)
    return plain and root is not None and root.start_mark.column == 0 and not ends


def _lacking_nodes(
    context: Context, known: KnownNodes, at_run_time: Collection[str], every: Sequence[RawSection]
) -> Iterator[tuple[str, list[DefaultLine]]]:
    """Yield (full name, lines) of each node in the node sets without a section it needs."""
    types = controller_types(every)
    found = identify_sections(every, context, known)
    # Those for nodes of any name are nobody's own.
    own = [it.full for it in found if it.path.rpartition("/")[2] not in ANY]
    for name, full in context.nodes.items():
        last = name.rpartition("/")[2]
        shared = NAMESPACE_SLOT not in full
        if shared or last in types or any(is_for(it, full) for it in own):
            continue
        if node := identify_node(last, None, known, types):
            bare = bare_frames(node) if last in at_run_time else ()
            lines = list(missing_defaults(context, node, {*_set_by_all(name, every), *bare}))
            if lines:
                yield full, lines


def _set_by_all(path: str, every: Iterable[RawSection]) -> set[str]:
    """Return the parameters that sections of several nodes set for this node, too."""
    fitting = (it for it in every if is_for(it.path, f"/{path.strip('/')}"))
    return {name for it in fitting for name, _ in flattened(it.body)}


def _section_key(path: str, context: Context) -> str:
    """Return the full name of a robot's node for a section; for a pattern one in any namespace."""
    *above, name = path.strip("/").split("/")
    if any(it in ANY or PLACEHOLDER.search(it) for it in above):
        return f"/**/{spelled(context.topics.naming, NAMESPACE_SLOT, 'node', name)}"
    return full_name("/".join((*above, name)), context.topics.naming)


def _section_lines(full: str, lines: Sequence[DefaultLine]) -> Iterator[str]:
    """Yield the lines of a section, with nested keys for a node below the robot's namespace."""
    # After a key with a slash that is not at the top rcl takes the next section for one of that
    # namespace (rcl_yaml_param_parser namespace.c, ``rem_name_from_ns``), and nav2_bringup puts a
    # key above all of them.
    yield from dict.fromkeys(it.comment for it in lines)
    *above, name = full.strip("/").split("/")
    keys = (f"/{'/'.join(above)}", name) if len(above) > 1 else (full,)
    yield from (f"{'  ' * at}{key}:" for at, key in enumerate((*keys, PARAMETERS)))
    yield from (f"{'  ' * (len(keys) + 1)}{it.path}: {it.value}" for it in lines)


_SLAM = "slam_toolbox"
_WHY = "# nav2_bringup wants this key, and gives slam_toolbox the file without a namespace.\n"
_MAP_NAME = DefaultLine(
    "# /map by default, and nothing would move /map_metadata", "map_name", "map"
)

OUTSIDE = declare(
    "MF132",
    "section-outside-of-bringup",
    ERROR,
    formats=("params",),
    options={
        "node_sets": ["nav2", "rviz"],
        "shared_nodes": ["rviz2"],
        "params_style": "bringup",
        "layout": "both",
    },
)


Values = Mapping[str, Mapping[str, object]]
NO_MORE: Values = {}


def for_bringup(
    document: YamlText, namespace: str, more: Values = NO_MORE
) -> tuple[str, tuple[Finding, ...]]:
    """Return the text of a file made for the robot in ``namespace``, without that namespace.

    ``more`` are further values of nodes that have a section in it: there is one file for all that is
    started. Raises InputError for a file that rcl rejects.
    """
    sections = {id(it.keys[0]): it for it in raw_sections(document)}
    made = [it for section in sections.values() for it in _new_key(document, section, namespace)]
    splices = [it for it in made if isinstance(it, Splice)]
    findings = tuple(it for it in made if isinstance(it, Finding))
    named = {below_namespace(it.path, namespace) for it in sections.values()}
    added = {f"**/{node}": values for node, values in more.items() if node in named}
    # The keys of these sections are others than those of the file.
    behind = f"\n{parameters_text(added)[1:-1]}\n" if added else ""
    return spliced(document, splices) + behind, findings


def _new_key(document: YamlText, section: RawSection, namespace: str) -> Iterator[Splice | Finding]:
    """Yield the new key of a section, with more values if it is the first below that key."""
    key = section.keys[0]
    below = below_namespace(key.value, namespace)
    if PLACEHOLDER.search(key.value):
        return
    if below is None:
        message = f"section {key.value} is for a node that is not in the namespace /{namespace}"
        hint = "nav2_bringup puts all sections there; put this one into a file of its own"
        yield found_at(document, key, OUTSIDE, message, hint)
    elif below == _SLAM:
        at, column = key.start_mark.index, key.start_mark.column
        new = f"{_WHY}{' ' * column}{_SLAM}: {{}}\n{' ' * column}{quoted(f'**/{_SLAM}')}"
        yield Splice(at, key.end_mark.index, new)
        if _MAP_NAME.path not in {it.value for it, _ in pairs(section.body)}:
            yield inserted(document, section.body, [_MAP_NAME])
    else:
        yield replaced(key, below)


def below_namespace(key: str, namespace: str) -> str | None:
    """Return the rest of a section's name below a namespace; None if no node there has it.

    below_namespace("/robot1/amcl", "robot1") == "amcl"
    below_namespace("/**", "robot1") == "**"
    """
    tokens = key.strip("/").split("/")
    for word in namespace.split("/"):
        if tokens and tokens[0] == "**":
            break
        if not tokens or tokens[0] not in (word, "*"):
            return None
        tokens.pop(0)
    return "/".join(tokens) or "**"
