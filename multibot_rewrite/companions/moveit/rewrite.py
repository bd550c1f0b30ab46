"""MoveIt's YAML files for any number of robots: the kind of a file, its names, their new text.

MoveItConfigsBuilder reads them with PyYAML and passes them to move_group as parameters. So there are
no sections of nodes, anchors are legal, and of a repeated key the last value counts.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import yaml

from multibot_rewrite.companions.context import Companion, Context
from multibot_rewrite.companions.moveit.name_sites import (
    FileKind,
    MoveitName,
    MoveitNames,
    entries,
    find_names,
    kinds,
)
from multibot_rewrite.companions.names.by_kind import SPELLERS, expressible, is_plain
from multibot_rewrite.companions.names.by_kind import node as node_name
from multibot_rewrite.companions.names.node_topics import (
    FROM_NODE,
    Facts,
    facts_by_name,
    spell_topic,
)
from multibot_rewrite.companions.names.rename_map import spell
from multibot_rewrite.companions.names.undeclared import (
    holds_a_name,
    is_undeclared,
    renamed_names,
    undeclared_message,
)
from multibot_rewrite.companions.params.sections import PARAMETERS
from multibot_rewrite.companions.template import (
    TAG_SLOT,
    check_no_slots,
    make_template,
)
from multibot_rewrite.companions.yaml_text import (
    Splice,
    YamlText,
    finding_at,
    is_text,
    line_of,
    quoted,
)
from multibot_rewrite.model import WARNING, Finding, InputError
from multibot_rewrite.naming import NAMESPACE
from multibot_rewrite.remap.records import NodeFacts
from multibot_rewrite.rewriters.forms import Declared
from multibot_rewrite.rosnames import check_topic_name

EMPTY = "empty"
# The nodes that read these files, as the stacks call them.
MOVE_GROUP, SERVO = "move_group", "servo_node"
_CLOSED = ("joint", "link", "frame", "group")
_GRAPH_WORDS = ("topic", "service")
# An anchor or a tag before the value.
_MARKS = re.compile(r"(?:[&!][^\s,\[\]{}]*\s+)*")
_EVALUATOR = re.compile(r"\s*(joint|link)s?\s*\(([^()]*)\)\s*")
# moveit_ros_control_interface looks for the manager below the root unless this is set.
_MANAGER = "moveit_controller_manager"
_ROS_CONTROL, _CONTROL_NAMESPACE = "moveit_ros_control_interface/", "ros_control_namespace"
_DEPTH = 4


class _MoveitJob(NamedTuple):
    """One file to rewrite, and all that its steps need; ``node`` is the node that reads it."""

    document: YamlText
    context: Context
    node: str
    facts: Facts


def rewrite_moveit(
    document: YamlText, context: Context, facts: Iterable[NodeFacts] = ()
) -> Companion:
    """A MoveIt file with slots for a robot, and the findings about it.

    Groups of an SRDF are known if ``with_srdf`` has added them; ``facts`` are those of the robot's
    nodes, whose remap rules move topics too. Raises InputError for a file that is not MoveIt's, and
    for an alias whose value would need two new names.
    """
    try:
        return _moveit(document, context, facts_by_name(facts))
    except RecursionError:
        raise InputError(
            f"{document.file}:1: the YAML is nested too deeply for a MoveIt file"
        ) from None


def with_srdf(context: Context, declared: Declared) -> Context:
    """The context with the groups and virtual joints that an SRDF declares (not rewritten)."""
    both = dict(context.names.declared)
    for kind in ("group", "joint"):
        both[kind] = {**both.get(kind, {}), **declared.get(kind, {})}
    names, topics = (it._replace(declared=both) for it in (context.names, context.topics))
    return context._replace(names=names, topics=topics)


def file_kind(document: YamlText) -> str:
    """Which kind of MoveIt file this is, by its content, else by its name; ``empty`` if it is empty.

    Raises InputError if it is not a MoveIt file.
    """
    kind = _kind(document)
    return kind.name if kind else EMPTY


def _kind(document: YamlText) -> FileKind | None:
    root = document.root
    if root is None or root.tag == "tag:yaml.org,2002:null":
        return None
    if not isinstance(root, yaml.MappingNode):
        place = f"{document.file}:{line_of(root)}"
        raise InputError(f"{place}: not a MoveIt file: it is not a map of keys and values")
    _refuse_params(document, root, _DEPTH)
    paths = set(_paths(root))
    known = (kind for kind in kinds() if not paths.isdisjoint(kind.marks))
    if kind := next(known, None) or _by_values(root) or _by_name(document.file):
        return kind
    words = ", ".join(str(key.value) for key, _ in list(entries(root))[:4])
    raise InputError(
        f"{document.file}:{line_of(root)}: not a known kind of MoveIt file: it starts with"
        f" {words or 'nothing'}; leave it out, or list a parameter file under params"
    )


def _refuse_params(document: YamlText, node: yaml.Node, depth: int) -> None:
    for key, value in entries(node) if depth else ():
        if key.value == PARAMETERS:
            place = f"{document.file}:{line_of(key)}"
            raise InputError(
                f"{place}: {PARAMETERS} makes it a parameter file; list it under params"
            )
        _refuse_params(document, value, depth - 1)


def _paths(root: yaml.Node) -> Iterator[str]:
    """The keys of the first two levels, the second with ``*`` for the first as well."""
    for key, value in entries(root):
        first, _, rest = str(key.value).partition(".")
        yield from (str(key.value), first)
        for word in (rest.partition(".")[0], *(str(below.value) for below, _ in entries(value))):
            yield from (f"{first}.{word}", f"*.{word}")


def _by_values(root: yaml.Node) -> FileKind | None:
    """A file of numbers only holds joint positions."""
    values = [value for _, value in entries(root)]
    if values and all(it.tag.endswith((":float", ":int", "!degrees", "!radians")) for it in values):
        return next(kind for kind in kinds() if kind.name == "initial_positions")
    return None


def _by_name(file: str) -> FileKind | None:
    name = file.replace("\\", "/").rpartition("/")[2].lower()
    return next((kind for kind in kinds() if any(it in name for it in kind.files)), None)


def _moveit(document: YamlText, context: Context, facts: Facts) -> Companion:
    check_no_slots(document.text, document.file)
    kind = _kind(document)
    sites = find_names(document.root, kind.names if kind else {}, context.names)
    node = SERVO if kind and kind.name == "servo" else MOVE_GROUP
    job = _MoveitJob(document, context, node, facts)
    splices = [*_spliced(job, sites.names), *_inserted(document, context)]
    shift = [Splice(0, 0, document.bom)] if document.bom else []
    found = sorted(set(_findings(document, context, sites)), key=lambda it: it[5:])
    return Companion(make_template(document.text, [*shift, *splices]), tuple(found))


def _spliced(job: _MoveitJob, sites: Iterable[MoveitName]) -> Iterator[Splice]:
    """One splice for each scalar; a key may hold several names, an alias may reach one twice."""
    texts: dict[int, dict[int, tuple[MoveitName, str]]] = {}
    for site in sites:
        new = _new_text(job, site.word, site.text)
        _, other = texts.setdefault(id(site.scalar), {}).setdefault(site.at, (site, new))
        if other != new:
            place = f"{job.document.file}:{line_of(site.scalar)}"
            raise InputError(
                f"{place}: an alias uses {site.text!r} as two kinds of name, {other!r} and {new!r};"
                " write the value out in both places".replace(TAG_SLOT, "ROBOT")
            )
    for parts in texts.values():
        scalar, value = next(iter(parts.values()))[0].scalar, ""
        value = str(scalar.value)
        for at, (site, new) in sorted(parts.items(), reverse=True):
            value = value[:at] + new + value[at + len(site.text) :]
        if value != scalar.value:
            yield _replaced(job.document, scalar, value)


def _replaced(document: YamlText, scalar: yaml.ScalarNode, new: str) -> Splice:
    """The splice for a scalar's value; its anchor and tag stay."""
    start, end = scalar.start_mark.index, scalar.end_mark.index
    if scalar.style in ("|", ">"):
        place = f"{document.file}:{line_of(scalar)}"
        raise InputError(
            f"{place}: a name is written as a block of text; write it on the line of its key"
        )
    marks = _MARKS.match(document.text, start, end)
    return Splice(marks.end() if marks else start, end, quoted(new, scalar.style or ""))


def _new_text(job: _MoveitJob, word: str, value: str) -> str:
    if word == "id":
        return value
    if word in _GRAPH_WORDS:
        return spell_topic(job.context, job.node, word, value, FROM_NODE, job.facts).text
    if word == "controller_topic":
        return _controller_topic(job, value)
    if word == "controller":
        return node_name(job.context, value) if is_plain(value) else value
    return SPELLERS[word](job.context, value)


def _controller_topic(job: _MoveitJob, value: str) -> str:
    """``/arm_controller/joint_trajectory``: a topic below a node is renamed with the node."""
    head, slash, rest = value.rpartition("/")
    if not is_plain(value) or not head or value.startswith("~"):
        return spell_topic(job.context, job.node, "topic", value, FROM_NODE, job.facts).text
    if job.context.topics.naming.topics == NAMESPACE:
        return spell(job.context.topics, "topic", value)
    return node_name(job.context, head) + slash + rest


def _asks_below_root(document: YamlText) -> yaml.ScalarNode | None:
    """The key that selects ros2_control, if the file does not set the manager's namespace."""
    keys = {str(key.value): (key, value) for key, value in entries(document.root)}
    if _MANAGER not in keys or _CONTROL_NAMESPACE in keys:
        return None
    key, value = keys[_MANAGER]
    return key if str(value.value).startswith(_ROS_CONTROL) else None


def _inserted(document: YamlText, context: Context) -> Iterator[Splice]:
    """The namespace of the controller manager, if it is not set: the default is the root."""
    key = _asks_below_root(document)
    default = SPELLERS["namespace"](context, "/")
    flow = isinstance(document.root, yaml.MappingNode) and document.root.flow_style
    if key is None or default == "/":
        return
    if flow:
        at = key.start_mark.index
        yield Splice(at, at, f"{_CONTROL_NAMESPACE}: {default}, ")
        return
    end = "\r\n" if "\r\n" in document.text else "\n"
    at = key.start_mark.index
    yield Splice(at, at, f"{_CONTROL_NAMESPACE}: {default}{end}{' ' * key.start_mark.column}")


def _findings(document: YamlText, context: Context, sites: MoveitNames) -> Iterator[Finding]:
    for key in sites.twice:
        message = f"{key.value!r} is set twice; PyYAML keeps only the last value"
        yield finding_at(document, key, "MF303", WARNING, message, "remove one of them")
    yield from _unreachable(document, context, sites)
    reported: set[tuple[str, str]] = set()
    for site in sites.names:
        for word, text in _named(site):
            if (word, text) not in reported:
                reported.add((word, text))
                yield from _name_finding(document, context, site, (word, text))
    yield from _mentions(document, context, sites.unclaimed)


def _unreachable(document: YamlText, context: Context, sites: MoveitNames) -> Iterator[Finding]:
    """Without namespaces each robot's controller manager has a different name."""
    keys = [
        _asks_below_root(document),
        *(it.scalar for it in sites.names if it.word == "namespace"),
    ]
    for key in keys if context.names.naming.topics != NAMESPACE else ():
        if key is not None:
            message = "MoveIt looks for /controller_manager, but each robot's has a different name"
            hint = "use moveit_simple_controller_manager or a layout with namespaces"
            yield finding_at(document, key, "MF308", WARNING, message, hint)


def _named(site: MoveitName) -> Iterator[tuple[str, str]]:
    """The names that the description must declare."""
    found = _EVALUATOR.fullmatch(site.text) if site.word == "words" else None
    if found:
        yield from ((found[1], word.strip()) for word in found[2].split(","))
    else:
        yield site.word, site.text


def _name_finding(
    document: YamlText, context: Context, site: MoveitName, name: tuple[str, str]
) -> Iterator[Finding]:
    word, text = name
    naming = context.names.naming
    if word in _CLOSED and is_undeclared(context, word, text):
        yield finding_at(
            document, site.scalar, "MF301", WARNING, *undeclared_message(context, word, text)
        )
    elif text and not is_plain(text) and _matters(context, word):
        message = f"{word} {text!r} holds a substitution and stays unchanged"
        hint = "make sure that it results in the robot's own name"
        yield finding_at(document, site.scalar, "MF304", WARNING, message, hint)
    elif word == "group" and "group" in naming.separators and not _has_groups(context):
        message = f"groups are renamed, but no SRDF is given, so {text!r} stays unchanged"
        yield finding_at(
            document, site.scalar, "MF305", WARNING, message, "name the SRDF under srdf:"
        )
    elif not expressible(context, word):
        message = f"{word} can only add a prefix, but the fleet uses a postfix"
        yield finding_at(document, site.scalar, "MF306", WARNING, message, "set affix: prefix")
    elif word in _GRAPH_WORDS and is_plain(text) and (fault := check_topic_name(text)):
        message = f"{text!r} is not a valid {word} name: {fault.reason}"
        hint = "it stays unchanged; correct it"
        yield finding_at(document, site.scalar, "MF307", WARNING, message, hint)


def _has_groups(context: Context) -> bool:
    """Are the groups of an SRDF known?"""
    return bool(context.names.declared.get("group"))


def _matters(context: Context, word: str) -> bool:
    """Would a name of this kind be renamed for a robot?"""
    if word in _CLOSED:
        return word in context.names.naming.separators
    return word in _GRAPH_WORDS or word == "controller"


def _mentions(
    document: YamlText, context: Context, unclaimed: Iterable[yaml.ScalarNode]
) -> Iterator[Finding]:
    names = renamed_names(context)
    for scalar in unclaimed:
        text = str(scalar.value)
        if is_text(scalar) and holds_a_name(text, names):
            message = f"{text!r} is a name of the robot, but its use here is not known"
            hint = "it stays unchanged; if each robot needs its own, rename it by hand"
            yield finding_at(document, scalar, "MF302", WARNING, message, hint)
