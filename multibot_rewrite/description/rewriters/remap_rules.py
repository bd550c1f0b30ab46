# SPDX-License-Identifier: Apache-2.0
"""What the names in a plugin's remap rules are: a left side names what its node asks for.

rcl expands a left side by the namespace and the name of the node and compares the texts (rcl remap.c,
expand_topic_name.c). So an absolute left side for a relative name moves with the namespace of the
plugin, one below the name of the node or a word of a parameter moves with these, and one for a name
that is absolute in the code stays.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.conventions import SHARED_TOPICS
from multibot_rewrite.base.model import Claim, UsageError
from multibot_rewrite.base.naming import TF_TOPICS, TOPIC_KINDS, Naming
from multibot_rewrite.base.rosnames import RemapRule, expand, remapped_node, split_remap
from multibot_rewrite.description.rewriters.forms import NamePart, remap
from multibot_rewrite.description.rewriters.own_defaults import filled
from multibot_rewrite.description.rewriters.plugin_definitions import PluginDefinition
from multibot_rewrite.description.rewriters.renaming import Rules
from multibot_rewrite.description.rewriters.text import text_at, text_of

FORMS = ("remap", "argument")
# Of a parameter whose value is a topic, or what topics are below.
HELD = frozenset({*TOPIC_KINDS, "stem"})
# Read from the plugin itself where it has no <ros>; a <ros> would hide them (gazebo_ros node.cpp).
ROS_CHILDREN = ("namespace", "remapping", "argument", "parameter", "qos")
# What every node and every broadcaster has, by names that are absolute in their code.
ABSOLUTE = frozenset({*SHARED_TOPICS, *(f"/{it}" for it in TF_TOPICS)})
# The flags whose next argument is a remap rule, and those that take none.
_REMAPS, _ALONE = ("-r", "--remap"), ("--ros-args", "--")


class _Asked(NamedTuple):
    """A name that a node asks for: in its code, or in a parameter, whose ``kind`` it has then."""

    name: str
    kind: str


class _Node(NamedTuple):
    """The node of a plugin; ``stems`` have topics below; ``known``: it asks for no other names."""

    name: str
    namespace: str
    asked: Mapping[str, _Asked]
    stems: tuple[str, ...]
    known: bool

    @property
    def root(self) -> str:
        """What is in front of its relative names."""
        bare = self.namespace.strip("/")
        return f"/{bare}/" if bare else "/"

    def full(self, name: str) -> str:
        """Return a name as rcl expands it for this node."""
        return expand(name, self.namespace, self.name)


def names_in_rules(
    claims: Iterable[Claim], served: Iterable[tuple[etree._Element, PluginDefinition]]
) -> Rules:
    """Return the names in each claimed rule, by the number of the claim."""
    rules = [(at, claim) for at, claim in enumerate(claims) if claim.site.form in FORMS]
    sections = dict(served) if rules else {}
    nodes: dict[etree._Element, _Node] = {}
    found: dict[int, tuple[NamePart, ...]] = {}
    for at, claim in rules:
        host = next((it for it in claim.element.iterancestors() if it in sections), None)
        if host is None:
            continue
        if host not in nodes:
            section = sections[host]
            bare = _Node(*named(host, section), {}, (), False)
            names = [*_asked_names(host, section)]
            stems = tuple(it.name for it in names if it.kind == "stem")
            asked = {bare.full(it.name): it for it in names if it.kind != "stem"}
            known = bool(names or section.wired) and not section.process_wide
            nodes[host] = bare._replace(asked=asked, stems=stems, known=known)
        parts = _names_in_rule(claim, nodes[host], sections[host].process_wide)
        found[at] = tuple(sorted(parts, key=lambda it: it.at))
    return found


def ros_home(host: etree._Element, section: PluginDefinition) -> etree._Element | None:
    """Return where ROS settings of a plugin go; None if a ``<ros>`` must be made first."""
    ros = host.find("ros")
    if ros is not None:
        return ros
    bare = any(site.path == "remapping" for site in section.sites)
    return host if bare and any(host.find(tag) is not None for tag in ROS_CHILDREN) else None


def rules_in(home: etree._Element | None) -> list[RemapRule]:
    """Return the remap rules in a plugin's ROS settings that rcl applies, in its order."""
    if home is None:
        return []
    arguments = (it for it in home.iterchildren("argument") if _flag(it) in ("", *_REMAPS))
    rules = (split_remap(text_of(it)) for it in (*arguments, *home.iterchildren("remapping")))
    return [it for it in rules if it is not None]


def named(host: etree._Element, section: PluginDefinition) -> tuple[str, str]:
    """Return the name and namespace of a plugin's node, after the rules for these."""
    home = ros_home(host, section)
    # Beside a helper in the plugin's namespace the node is where a rule for its own name places it.
    sites = section.sites if section.helper else ()
    site = next((it for it in sites if it.kinds[:1] == ("node",) and it.default), None)
    own = host.get("name", "").strip() or section.names[0].replace("-", "_")
    name = own if site is None else text_at(host, site.path) or site.default
    namespace = "" if home is None else text_at(home, "namespace")
    try:
        return remapped_node(name, namespace, rules_in(home))
    except UsageError:  # a placeholder, or what rcl refuses
        return name, namespace


def relative(rule: RemapRule, namespace: str, section: PluginDefinition, naming: Naming) -> str:
    """Return an absolute rule of a whole process without the plugin's ``namespace``, or nothing."""
    # Nothing for a rule that is not below it, or names of which stay absolute.""
    wide = section.process_wide and not (section.helper or rule.node or rule.scheme)
    root = f"/{namespace.strip('/')}/" if namespace.strip("/") else "/"
    names = (rule.source, rule.target)
    stay = ABSOLUTE.intersection(names) or rule.target.strip("/") in naming.shared_topics
    if not wide or stay or not all(it.startswith(root) for it in names):
        return ""
    return ":=".join(it.removeprefix(root) for it in names)


def _flag(argument: etree._Element) -> str:
    """Return the flag before an ``<argument>`` that is its value, as ``-p``; empty without one."""
    before = next(argument.itersiblings("argument", preceding=True), None)
    text = "" if before is None else text_of(before)
    return text if text.startswith("-") and text not in _ALONE else ""


def _asked_names(host: etree._Element, section: PluginDefinition) -> Iterator[_Asked]:
    """Yield the names in a node's code without a parameter, and those that its parameters hold."""
    yield from (_Asked(name, "") for name in section.topics)
    for site in section.sites:
        if site.role == "uses" and site.form == "whole" and site.kinds[0] in HELD:
            value = text_at(host, site.path) if "@" not in site.path else ""
            # Other defaults are made of other names, and belong to no plugin with rules.
            value = value or filled(host, site.default if "?" not in site.default else "")
            if value and "qos" not in site.path:
                yield _Asked(value, site.kinds[0])


def _names_in_rule(claim: Claim, node: _Node, process_wide: bool) -> Iterator[NamePart]:
    """Yield the names in a claimed remap rule: its target, and its left side if it is this node's."""
    if claim.site.form == "argument" and _flag(claim.element) not in ("", *_REMAPS):
        return
    yield from remap(claim.value, claim.site.kinds, {})
    rule = split_remap(claim.value.strip())
    if rule is None or rule.source.startswith(("__", "~")):
        return
    if process_wide or rule.node in ("", node.name):
        lead = len(claim.value) - len(claim.value.lstrip())
        yield from _names_in_left_side(rule.source, lead + rule.source_at, node)


def _names_in_left_side(source: str, at: int, node: _Node) -> Iterator[NamePart]:
    """Yield the names in a rule's left side that starts at character ``at``."""
    # None in a relative one for an absolute name: these have robots' names at different places.
    full = node.full(source)
    asked = node.asked.get(full)
    if asked is not None and asked.name.startswith("/"):
        if asked.kind and source.startswith("/"):
            yield NamePart(at, source, (asked.kind,))
        return
    stem = next((it for it in node.stems if f"{full}/".startswith(f"{node.full(it)}/")), "")
    if source.startswith("/") and not stem.startswith("/") and _is_moved(full, asked, stem, node):
        yield NamePart(at, source, ("namespace",))
    # What is behind the namespace is the same in a relative and an absolute left side.
    rest = full.removeprefix(node.root)
    behind = at + len(source) - len(rest)
    if stem.startswith("/"):
        if source.startswith("/"):
            yield NamePart(at, stem, ("stem",))
    elif stem:
        yield NamePart(behind, stem, ("stem",))
    elif asked is not None and asked.name.startswith("~"):
        yield NamePart(behind, node.name, ("node",))
    elif asked is not None and asked.kind:
        yield NamePart(behind, rest, (asked.kind,))


def _is_moved(full: str, asked: _Asked | None, stem: str, node: _Node) -> bool:
    """Return whether a name moves with its node's namespace, as most of an unknown node's do."""
    if not full.startswith(node.root):
        return False
    if asked is not None or stem or not node.known:
        return full not in ABSOLUTE or asked is not None
    # An image transport has topics below that of the image (image_transport publisher.cpp).
    return any(full.startswith(f"{it}/") for it, of in node.asked.items() if of.name[0] != "/")
