# SPDX-License-Identifier: Apache-2.0
"""Renames topics in parameters, and finds the robot's absolute topic for a topic in a file.

A name read from a parameter is remapped like any other. So the new value must resolve, with the
robot's remap rules, to the robot's version of the name that the old value resolves to without
rules."""

from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.naming import NAMESPACE, NOT_PLAIN
from multibot_rewrite.base.rosnames import bind, check_name_in_code, expand, resolve_bound
from multibot_rewrite.knowledge.node_sets import built_in, is_apart
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.of_runs import asked_alone, parsed, placed, target_of
from multibot_rewrite.planning.records import Table
from multibot_rewrite.planning.table import run_of
from multibot_rewrite.related_files.context import NAMESPACE_SLOT, Context
from multibot_rewrite.related_files.names.by_kind import is_plain
from multibot_rewrite.related_files.names.rename_map import RelatedNames, spell
from multibot_rewrite.related_files.sites import FROM_NODE, FROM_PARENT, IN_FULL
from multibot_rewrite.system.records import ACTION, TOPIC

Facts = Mapping[str, NodeFacts]


class TopicText(NamedTuple):
    """The new text for a topic; ``wrong_target`` is what it resolves to if that is wrong.

    ``made_absolute`` is true if a relative name had to be made absolute."""

    text: str
    wrong_target: str = ""
    made_absolute: bool = False


@lru_cache
def built_in_facts(release: str) -> Facts:
    """Return facts by node, as in the node sets; nodes with their own remap rules first."""
    library = built_in(release)
    facts = [node for node_set in library.node_sets.values() for node in node_set.nodes]
    facts.sort(key=lambda it: not any(endpoint.remapped for endpoint in it.endpoints))
    found: dict[str, NodeFacts] = {}
    for node in (*facts, *library.nodes.values()):
        found.setdefault(node.name, node)
    return found


def facts_by_name(facts: Iterable[NodeFacts], release: str) -> Facts:
    """Return the facts of the robots' nodes by name, or the built-in ones of a release."""
    return {it.name: it for it in facts} or built_in_facts(release)


def spell_topic(
    context: Context, node: str, kind: str, value: str, reach: str, facts: Facts
) -> TopicText:
    """Return the robot's version of a topic or service in a parameter of ``node``."""
    if not is_plain(value) or value.startswith("~") or check_name_in_code(value):
        return TopicText(value)
    meant = value
    # Only a full name is right where a name is resolved in another namespace than the layout's: one
    # that goes to a costmap, and those of nodes that stand apart.
    apart = facts[node].apart if node in facts else is_apart(node, context.distro)
    if (reach == FROM_PARENT or apart) and context.topics.naming.topics != NAMESPACE:
        meant = expand(value, f"/{node.rpartition('/')[0]}" if reach == FROM_NODE else "/", "")
    text = _name_for_robot(context, kind, meant, reach == IN_FULL)
    made_absolute = reach == IN_FULL and not value.startswith("/")
    is_started = node in context.nodes or facts is not built_in_facts(context.distro)
    ruled = _ruled_node(facts.get(node), value, context) if is_started else None
    if not ruled:
        return TopicText(text, made_absolute=made_absolute)
    return _ruled_text(context, kind, (text, value), reach, ruled)._replace(
        made_absolute=made_absolute
    )


def _name_for_robot(context: Context, kind: str, value: str, absolute: bool) -> str:
    """Return the name for a robot; ``absolute`` if it is not resolved in the robot's namespace."""
    naming = context.topics.naming
    lead = "" if value.startswith("/") else "/"
    if value.strip("/") in naming.shared_topics:
        return lead + value if absolute or naming.topics == NAMESPACE else value
    full = lead + value if absolute else value
    # A name below another node's, such as its private services, follows the node's name.
    head, slash, rest = full.strip("/").partition("/")
    place = context.nodes.get(head, "")
    if slash and place and naming.topics != NAMESPACE:
        relative = not full.startswith("/") and place.count("/") == 1
        return f"{place.lstrip('/') if relative else place}/{rest}"
    return spell(context.topics, kind, full)


def _ruled_node(node: NodeFacts | None, value: str, context: Context) -> NodeFacts | None:
    """Return the node with only those endpoints whose rules could match the name."""
    if node is None or node.shared:
        return None
    bare, naming = value.strip("/"), context.topics.naming
    found = (it for it in node.endpoints if it.name.strip("/") == bare and not it.fixed)
    ruled = [
        it for it in found if it.remapped or target_of(it.name, it.kind, NAMESPACE_SLOT, naming)
    ]
    return node._replace(endpoints=tuple(ruled)) if ruled else None


def _ruled_text(
    context: Context, kind: str, texts: tuple[str, str], reach: str, node: NodeFacts
) -> TopicText:
    """Return the new name if it resolves correctly, or the old one if a rule moves that."""
    naming = context.topics.naming
    table = run_of(NAMESPACE_SLOT, node, naming, context.nodes)
    bound = bind(table.name, table.namespace, parsed(table.rules))
    # The robot's name for the topic that the text means for a single robot with the node set's rules.
    meant = expand(texts[1], "/", "")
    remapped = {expand(it.name, "/", ""): it.remapped for it in node.endpoints}.get(meant, "")
    wanted = _name_for_robot(context, kind, expand(remapped or meant, "/", ""), True)
    wanted = wanted if wanted.startswith("/") else f"/{wanted}"
    parent = placed(NAMESPACE_SLOT, "node", naming, node.apart)[0]
    root = parent if reach == FROM_PARENT else table.namespace
    resolved = [resolve_bound(expand(text, root, table.name), kind, bound) for text in texts]
    good = [text for text, full in zip(texts, resolved, strict=True) if full == wanted]
    if not good:
        return TopicText(texts[0], resolved[0])
    # A rule also moves names that the node derives: <costmap>_updates, <image>/compressed.
    ruled = naming.topics != NAMESPACE and reach == FROM_NODE
    return TopicText(good[-1] if ruled else good[0])


NOTHING: Mapping[str, str] = {}


def is_topic(value: str) -> bool:
    """Return whether a value is a topic name: not empty, not private, without placeholders."""
    if not value or value.startswith("~") or not NOT_PLAIN.isdisjoint(value):
        return False
    return check_name_in_code(value) is None


def robot_topic(names: RelatedNames, value: str, known: Mapping[str, str] = NOTHING) -> str:
    """Return the robot's absolute topic; ``value`` itself if it is shared or not a topic name.

    ``known`` is ``fleet_topics`` of the robot, for topics that do not follow the general rule.
    """
    if not is_topic(value):
        return value
    full = f"/{value.lstrip('/')}"
    if full in known:
        return value if known[full] == full else known[full]
    target = target_of(full, TOPIC, names.robot, names.naming)
    if not target:
        return value
    return f"/{names.robot}/{target}" if names.naming.topics == NAMESPACE else target


def fleet_topics(table: Table, facts: Iterable[NodeFacts], robot: str) -> dict[str, str]:
    """Return the topics of ``robot`` in a fleet, by those of a single robot's nodes."""
    ours = {node.name for node in facts if not node.shared}
    own = [it for it in table.runs if it.robot == robot]
    node_set = {it.full_name: it.node for it in own if it.node in ours}
    found: dict[str, str] = {}
    for run in (it for it in own if it.full_name in node_set):
        above, _, node = node_set[run.full_name].rpartition("/")
        for end, name in (it for it in run.names if it[0].kind in (TOPIC, ACTION)):
            asked = end.remapped or asked_alone(run.fact, end)
            found.setdefault(expand(asked, above, node), name)
    return found
