# SPDX-License-Identifier: Apache-2.0
"""What has to be added: defaults and hard-wired topics that every robot would share otherwise."""

from collections.abc import Iterator
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.loose_xml import ESCAPES
from multibot_rewrite.base.naming import FRAME_KINDS, NAMESPACE, Naming, spelled
from multibot_rewrite.base.rosnames import SERVICE_SCHEME, TOPIC_SCHEME, expand
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.model_namespaces import has_own_names
from multibot_rewrite.description.rewriters.own_defaults import (
    MODEL,
    SENSOR,
    SHOWN,
    Hosts,
    default_of,
    filled,
    second_senders,
)
from multibot_rewrite.description.rewriters.plugin_definitions import (
    PluginDefinition,
    split_path,
    split_step,
)
from multibot_rewrite.description.rewriters.remap_rules import named, relative, ros_home, rules_in
from multibot_rewrite.description.rewriters.renaming import ROBOT_SLOT, respelled, spell_default
from multibot_rewrite.description.rewriters.text import text_at, text_of
from multibot_rewrite.knowledge.controller_ways import controller_way


class Insertion(NamedTuple):
    """An element to insert into ``parent``, inside a new ``wrap`` element unless that is empty.

    ``xml`` and ``new`` hold ``ROBOT_SLOT`` where the robot's name goes; ``old`` is what the consumer
    would use without it. ``step`` finds the element in ``parent`` where it is there and empty: then
    nothing but its text is put into it. ``shared`` tells that all robots would have ``old``, else it is
    a name that nothing else has. ``of_controllers`` tells that controllers of the plugin have it.
    """

    parent: etree._Element
    wrap: str
    xml: str
    kind: str
    old: str
    new: str
    step: str = ""
    shared: bool = True
    of_controllers: bool = False

    @property
    def filled(self) -> etree._Element | None:
        """The empty element that gets the text; None if an element is inserted."""
        return self.parent.find(query(self.step)) if self.step else None


def insertions(hosts: Hosts, declared: Declared, naming: Naming) -> list[Insertion]:
    """Return everything that must be inserted into ``hosts``."""
    served = [(host, section) for host, section in hosts if section.inserts]
    silent = second_senders(served, naming)
    every: list[Insertion] = []
    for host, section in served:
        home = ros_home(host, section)
        # What stands in the host itself has no step for it in its path.
        hidden = "ros/" if home is host else ""
        found = list(_of_defaults(host, section, declared, naming, hidden))
        if any(site.path == "ros/remapping" for site in section.sites):
            found += _remaps(host, section, naming, home)
        if naming.separators:
            found += _ros_1_namespaces(host, section, naming)
        if section.helper and naming.separators and naming.topics != NAMESPACE:
            found += _namespace_without_rules(host, section, declared, naming, home)
        every += (item for item in found if item.shared or host not in silent)
    return every


def _ros_1_namespaces(
    host: etree._Element, section: PluginDefinition, naming: Naming
) -> Iterator[Insertion]:
    """Yield the namespace of a ROS 1 plugin if it would be the root or the model's name."""
    # With a layout of namespaces both are inserted, otherwise only the first.
    for site in section.sites if has_own_names(section) else ():
        if site.kinds != ("namespace",) or site.default or site.form != "whole":
            continue
        there = host.find(site.path)
        if there is not None and not text_of(there) and site.empty != "model":
            made = _insertion_at(host, site.path, "namespace", "/", f"/{ROBOT_SLOT}")
            yield _filling(made, there, site.path)
        elif there is None and naming.topics == NAMESPACE:
            made = _insertion_at(host, site.path, "model", SHOWN, f"/{ROBOT_SLOT}")
            yield made._replace(shared=False)


def _namespace_without_rules(
    host: etree._Element,
    section: PluginDefinition,
    declared: Declared,
    naming: Naming,
    home: etree._Element | None,
) -> Iterator[Insertion]:
    """Yield a namespace for a node that takes no rules, and a rule that keeps the plugin's own."""
    # Rules for all nodes would be those of the first robot in the process.
    if any(it.source == "__ns" and it.node for it in rules_in(home)):
        return
    parent, wrap = (host, "ros") if home is None else (home, "")
    given = "" if home is None else text_at(home, "namespace").strip()
    if not given:
        made = _insertion_at(parent, "namespace", "node", section.helper, f"/{ROBOT_SLOT}")
        there = parent.find("namespace") if home is not None else None
        yield made._replace(wrap=wrap) if there is None else _filling(made, there, "namespace")
    site = next(it for it in section.sites if it.kinds[:1] == ("node",) and it.default)
    name = text_at(host, site.path) or site.default
    name = respelled(name, spell_default(site, name, declared, naming), ROBOT_SLOT)
    xml = f"<remapping>{name}:__ns:=/{given.strip('/')}</remapping>"
    yield Insertion(parent, wrap, xml, "node", section.helper, name, shared=False)


def lacks_namespace(
    host: etree._Element, section: PluginDefinition, declared: Declared, naming: Naming
) -> bool:
    """Return whether a host needs a namespace that it does not set itself."""
    sites = tuple([it for it in section.sites if "namespace" in it.kinds])
    if not sites or not section.inserts:
        return False
    hidden = "ros/" if ros_home(host, section) is host else ""
    asked = section._replace(sites=sites)
    return any(it.kind == "namespace" for it in _of_defaults(host, asked, declared, naming, hidden))


def without(item: Insertion, release: str) -> str:
    """Return the start of a comment: what would be wrong without the insertion."""
    if item.of_controllers and not controller_way(release).of_manager:
        return "all but controllers, whose rules are their spawner's, would share"
    if item.shared:
        return "all robots would share"
    if item.kind in ("node", "model"):
        return "its namespace would be that of"
    return "tf would not have" if item.kind in FRAME_KINDS else "topics would move with the sensor"


def _of_defaults(
    host: etree._Element,
    section: PluginDefinition,
    declared: Declared,
    naming: Naming,
    hidden: str,
) -> Iterator[Insertion]:
    """Yield the defaults of a plugin that must differ for each robot."""
    for site in section.sites:
        default = default_of(host, site.default, naming) if site.default else ""
        if not default:
            continue
        of_model = default.startswith(MODEL)
        path = site.path.removeprefix(hidden)
        # The first element at ``path`` that has its attribute.
        steps, attribute = split_path(path)
        found = host.find("/".join(query(step) for step in steps))
        there = found if found is None or not attribute or attribute in found.attrib else None
        if there is not None and (site.empty != "default" or "@" in path or text_of(there)):
            continue
        wanted = filled(host, site.fill) or default.removeprefix(MODEL)
        # A naming that renames nothing is for one robot as it is.
        if of_model and not naming.separators:
            continue
        spelling = spell_default(site, wanted, declared, naming)
        new = respelled(wanted, spelling, ROBOT_SLOT)
        # What the consumer has where nothing is inserted: a sensor may be renamed itself.
        is_sensor = site.default == SENSOR
        unset = spelled(naming, ROBOT_SLOT, "sensor", default) if is_sensor else default
        if not of_model and new == unset:
            continue
        kind = spelling[0].kind if spelling else site.kinds[0]
        shared = not of_model and unset == default
        old = default.replace(MODEL, SHOWN) if of_model else default
        made = _insertion_at(host, path, kind, old, new)._replace(shared=shared)
        yield made if there is None else _filling(made, there, path)


def query(step: str) -> str:
    """Return the step as lxml's find takes it."""
    tag, attribute, value = split_step(step)
    return f"{tag}[@{attribute}='{value}']" if attribute else tag


def _insertion_at(host: etree._Element, path: str, kind: str, old: str, new: str) -> Insertion:
    steps, attribute = split_path(path)
    parent, wrap = host, ""
    for step in steps[:-1]:
        child = parent.find(query(step))
        if child is None:
            wrap = split_step(step)[0]
        else:
            parent = child
    tag, key, value = split_step(steps[-1])
    given = f' {key}="{value}"' if key else ""
    text = new.translate(ESCAPES)
    xml = f'<{tag}{given} {attribute}="{text}"/>' if attribute else f"<{tag}{given}>{text}</{tag}>"
    return Insertion(parent, wrap, xml, kind, old, new)


def _filling(made: Insertion, there: etree._Element, path: str) -> Insertion:
    """Return the insertion for an existing empty element: its text alone."""
    parent = there.getparent()
    assert parent is not None, "a path has a step"
    step = split_path(path)[0][-1]
    tag = split_step(step)[0]
    xml = f"<{tag}>{made.new.translate(ESCAPES)}</{tag}>"
    return made._replace(parent=parent, wrap="", xml=xml, step=step)


def _remaps(
    host: etree._Element, section: PluginDefinition, naming: Naming, home: etree._Element | None
) -> Iterator[Insertion]:
    """Yield a rule for each topic that only a remap can move, unless the file has one."""
    rules = rules_in(home)
    parent, wrap = (host, "ros") if home is None else (home, "")
    node, namespace = named(host, section)
    of_node = ("", "" if section.process_wide else node)
    for wired in (it for it in section.wired if not it.is_moved):
        topic, target = wired.name, _remap_target(wired.name, naming)
        full = expand(topic, namespace, node)
        # The rules that rcl asks for it.
        other = TOPIC_SCHEME if wired.role == "serves" else SERVICE_SCHEME
        asked = (it for it in rules if it.scheme != other and it.node in of_node)
        there = [it for it in asked if expand(it.source, namespace, node) == full]
        if not target or any(
            naming.topics != NAMESPACE or it.source.startswith("/") for it in there
        ):
            continue
        if there:
            target = spelled(naming, ROBOT_SLOT, "topic", there[0].target, True)
        xml = f"<remapping>{topic}:={target}</remapping>"
        of_controllers = section.process_wide and topic in section.publishes
        made = Insertion(parent, wrap, xml, "topic", topic, target)
        yield made._replace(of_controllers=of_controllers)
    # Of a whole process those of the first robot count: they have to be the same for all.
    sources = {it.source for it in rules}
    for rule in rules if naming.topics == NAMESPACE else ():
        old, _, new = relative(rule, namespace, section, naming).partition(":=")
        if old and old not in sources:
            made = Insertion(parent, "", f"<remapping>{old}:={new}</remapping>", "topic", old, new)
            yield made._replace(of_controllers=True)


def _remap_target(topic: str, naming: Naming) -> str:
    """Return the relative target of a topic's rule; empty if the topic may stay."""
    # A robot's rules in gz_ros2_control are process-wide; a relative target still is in its
    # namespace.
    relative = topic.lstrip("/")
    if topic.startswith("~") or relative in naming.shared_topics:
        return ""
    if naming.topics == NAMESPACE:
        return relative if topic.startswith("/") else ""
    target = spelled(naming, ROBOT_SLOT, "topic", relative)
    return target if target != relative else ""
