# SPDX-License-Identifier: Apache-2.0
"""The tree of rewriters: the sections of plugin definitions, nested the way documents nest.

A ``Node`` answers, for one element, which of its attributes and text are sites and which node
serves each child tag. Which plugin or hardware class an element is decides its node; those nodes
are made when a document first asks for them.

Threads share a tree without a lock: what is made late follows from the plugin definitions alone, is
made whole, and only then put where others find it. Threads that make one thing at once make it
alike."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from multibot_rewrite.base.loose_xml import NAMESPACES
from multibot_rewrite.base.model import DefinitionsError, SiteRow
from multibot_rewrite.description.rewriters.plugin_definitions import (
    Definitions,
    PluginDefinition,
    Values,
    advice,
    load_definitions,
    split_path,
    split_step,
)
from multibot_rewrite.description.rewriters.text import text_at

if TYPE_CHECKING:
    from lxml.etree import _Element

# How the libraries of gz-sim begin, and its classes in them.
_GZ_SIM, _GZ_CLASSES = "gz-sim", "gz::sim::systems::"


def qualified(name: str) -> str:
    """Return a tag or attribute of plugin definitions as lxml writes it."""
    prefix, colon, local = name.partition(":")
    return f"{{{NAMESPACES[prefix]}}}{local}" if colon and prefix in NAMESPACES else name


# What a node knows once it is made.
_CONTENT = (
    *("section", "children", "active", "attributes", "text"),
    *("keeps", "select", "asked", "values"),
)

# The section for unknown plugins with a <ros> block, which gazebo_ros::Node reads.
ANY_WITH_ROS = "any_with_ros"


class TreeNode:
    """What is known about the elements at one place of the document.

    ``select`` is set where the element itself decides which node serves it. ``active`` are the
    children worth a visit: those with more below them than values to keep. ``element_name``
    is that of an element's section, whose node is made when something first asks for it. ``visit``
    is what a walk asks of each element, in one look: select, active, attributes and text.
    """

    __slots__ = ("_make", "element_name", "visit", *_CONTENT)

    def __init__(
        self, section: PluginDefinition | None = None, sites: tuple[SiteRow, ...] = ()
    ) -> None:
        self._make: Callable[[str], TreeNode] | None = None
        self.element_name = ""
        self.section = section
        self.children: dict[str, TreeNode] = {}
        self.active: dict[str, TreeNode] = {}
        self.attributes: tuple[tuple[str, SiteRow], ...] = ()
        self.text: SiteRow | None = None
        self.keeps: dict[str, SiteRow] = {}
        self.select: Callable[[_Element], TreeNode] | None = None
        self.asked = ""
        self.values: dict[str, TreeNode] = {}
        for site in sites:
            self._add_site(site)

    @classmethod
    def later(cls, element_name: str, make: Callable[[str], TreeNode]) -> TreeNode:
        """Return a node that becomes the result of ``make`` for its name when more of it is needed."""
        node = cls.__new__(cls)
        node.element_name, node._make = element_name, make
        return node

    def __getattr__(self, name: str) -> Any:
        # Called for slots without a value only: a node made later that is not made yet.
        if name == "visit":
            self.visit = self.select, self.active, self.attributes, self.text
            return self.visit
        if self._make is None:
            raise AttributeError(name)
        whole = self._make(self.element_name)
        # A thread that comes in between finds a whole value, or none and makes the same again.
        for slot in _CONTENT:
            setattr(self, slot, getattr(whole, slot))
        return getattr(whole, name)

    def _add_site(self, site: SiteRow) -> None:
        steps, attribute = split_path(site.path)
        attribute = qualified(attribute)
        node = self
        for step in steps:
            node = node._child_for_step(step, site.role != "keep")
        # A plugin's own section has the last word over what holds for every plugin.
        node.keeps.pop(attribute, None)
        claim = None if site.role == "keep" else site
        if claim is None or site.when:
            node.keeps[attribute] = site
        if attribute:
            others = tuple(pair for pair in node.attributes if pair[0] != attribute)
            node.attributes = (*others, (attribute, claim)) if claim else others
        else:
            node.text = claim

    def _child_for_step(self, step: str, active: bool) -> TreeNode:
        """Return the node below for a step of a path, made if it is missing."""
        tag, attribute, value = split_step(step)
        tag = qualified(tag)
        child = self.children.setdefault(tag, TreeNode())
        if active:
            self.active[tag] = child
        if not attribute:
            return child
        child.asked, child.select = attribute, child._node_by_value
        return child.values.setdefault(value, TreeNode())

    def _node_by_value(self, element: _Element) -> TreeNode:
        """Return the node for the value of an element's ``asked`` attribute, or this node."""
        return self.values.get(element.get(self.asked, ""), self)


class Tree:
    """The whole tree for some plugin definitions; sections are read when a document first needs them.

    ``formats`` maps the sections of root elements to their nodes; ``tags`` are all tags worth a
    visit so far.
    """

    def __init__(self, definitions: Definitions) -> None:
        self.definitions = definitions
        self.formats: dict[str, TreeNode] = {}
        self.tags: set[str] = set()
        self._chosen: dict[tuple[str, str, int], TreeNode] = {}
        places = definitions.places()
        self._nodes = {name: TreeNode.later(name, self._element_node) for name in places}
        self._below: dict[str, list[str]] = {name: [] for name in places}
        for name, parents in places.items():
            for parent in parents:
                if parent == "/":
                    self.formats[name] = self._nodes[name]
                    self.tags.add(_tag(name))
                elif parent in self._below:
                    self._below[parent].append(name)
                elif not self.definitions.has("element", parent):
                    (section, *_) = self.definitions.find("element", name)
                    raise _section_error(section, f"at: {parent}: there is no [element {parent}]")

    def check(self) -> None:
        """Read every section now; raises DefinitionsError for the first mistake."""
        for node in self._nodes.values():
            assert node.section is not None

    def format_of(self, root: _Element, likely: str = "") -> str:
        """Return the section of a root element, empty without one.

        Of those with its tag it is the one that knows most of its children, or the ``likely`` one or
        the plain one.
        """
        found = [name for name in self.formats if _tag(name) == root.tag]
        found.sort(key=lambda name: (name != likely, len(name)))
        if len(found) < 2:
            return found[0] if found else ""
        tags = {child.tag for child in root}
        return max(found, key=lambda name: len(self.formats[name].children.keys() & tags))

    def _element_node(self, element_name: str) -> TreeNode:
        """Return the node of a section for an element, with those below it."""
        (section,) = self.definitions.find("element", element_name)
        node = TreeNode(section, section.sites)
        if section.select:
            if section.select not in SELECTORS:
                raise _section_error(section, f"select: is one of {', '.join(SELECTORS)}")
            node.select = self._node_selector(node, section.select)
        for name in self._below[element_name]:
            child = self._nodes[name]
            if node.children.setdefault(_tag(name), child) is not child:
                place = f"{element_name}/{_tag(name)} has a section or sites already"
                raise _section_error(self.definitions.find("element", name)[0], place)
            node.active[_tag(name)] = child
        self._note_tags(node)
        return node

    def _note_tags(self, node: TreeNode) -> None:
        """Note a node's tags before a thread can find the node and miss them."""
        waiting = [node]
        while waiting:
            for tag, child in waiting.pop().active.items():
                self.tags.add(tag)
                if not child.element_name:
                    waiting += [child, *child.values.values()]

    def _node_selector(self, base: TreeNode, type_: str) -> Callable[[_Element], TreeNode]:
        """Return a function that gives for an element the node of its own section, or ``base``."""
        keys = SELECTORS[type_]

        def select(element: _Element) -> TreeNode:
            for key in keys(element):
                found = _by_ros(self.definitions.find(type_, key), element)
                if found is not None and not _is_gz_sim_class(element, key, found):
                    return self._node_with_section(base, found)
            return base

        return select

    def _node_with_section(self, base: TreeNode, section: PluginDefinition) -> TreeNode:
        """Return a node with what ``base`` and the section have, made once."""
        assert base.section is not None
        key = (base.section.names[0], section.file, section.line)
        found = self._chosen.get(key)
        if found is None:
            node = TreeNode(section, base.section.sites + section.sites)
            node.children = base.children | node.children
            node.active = base.active | node.active
            self._note_tags(node)
            found = self._chosen.setdefault(key, node)
        return found


def _is_gz_sim_class(element: _Element, key: str, section: PluginDefinition) -> bool:
    """Return whether an element loads a gz-sim class from a library named like Gazebo Classic's."""
    # In Classic the name is that of a node.
    of_node = any(it.path == "@name" and it.role == "declares" for it in section.sites)
    return of_node and "::" in element.get("name", "") and not key.startswith("gazebo_ros")


def _tag(name: str) -> str:
    """Return the tag that a section is for: ``srdf.group`` is about ``<group>``."""
    return qualified(name.rpartition(".")[2])


def _section_error(section: PluginDefinition, message: str) -> DefinitionsError:
    return DefinitionsError(f"{section.file}:{section.line}: [{section.name}] {message}")


def plugin_keys(element: _Element) -> list[str]:
    """Return the names a ``<plugin>`` may be known by: its library, or its class."""
    known = library_and_class(element.get("filename", ""), element.get("name", ""))
    return known if element.find("ros") is None else [*known, ANY_WITH_ROS]


def library_and_class(filename: str, name: str) -> list[str]:
    """Return the names for a library and a class, without the plugin's contents.

    gz-sim's loader reads ``ignition-gazebo`` as ``gz-sim`` and takes versioned library names.
    """
    known = [library_key(filename.strip().rpartition("/")[2])]
    # Without a scope it is a label, in Gazebo Classic a node name: anything at all.
    if "::" in name:
        known.append(name.strip().replace("ignition::gazebo::", "gz::sim::"))
    return known


def values_of_plugin(
    element: _Element, definitions: Definitions, of_ros_1: bool = False
) -> Values | None:
    """Return the known values of a plugin, by its library, or by its class.

    A class of gz-sim in a library of another name is another class: asv_wave_sim has a Hydrodynamics of
    its own.
    """
    library, *others = plugin_keys(element)
    forked = library and not library.startswith(_GZ_SIM)
    keys = [library, *(it for it in others if not (forked and it.startswith(_GZ_CLASSES)))]
    return next(filter(None, (definitions.values(it, of_ros_1) for it in keys)), None)


def library_key(library: str) -> str:
    """Return the key of a library: ``libignition-gazebo6-imu-system.so`` -> ``gz-sim-imu-system``."""
    key = library.removesuffix(".so").removesuffix(".dylib").removeprefix("lib")
    for family in ("ignition-gazebo", _GZ_SIM):
        if key.startswith(family):
            return _GZ_SIM + key[len(family) :].lstrip("0123456789")
    return key


def hardware_keys(element: _Element) -> list[str]:
    """Return the class a ``<ros2_control>`` loads."""
    class_ = text_at(element, "hardware/plugin")
    return [class_] if class_ else []


SELECTORS: dict[str, Callable[[_Element], list[str]]] = {
    "plugin": plugin_keys,
    "hardware": hardware_keys,
    "sensor": lambda element: [element.get("type", "").strip()],
}


def _by_ros(found: Sequence[PluginDefinition], element: _Element) -> PluginDefinition | None:
    """Return the ROS 1 or ROS 2 definition of plugins with one file name, by the children."""
    # ROS 2 if they do not tell. Nothing in ROS 1 reads a ``ros`` child. What decides for the whole
    # document: ``sources/release_said.py``. Source: gazebo_ros_pkgs branches noetic-devel
    # (camelCase, robotNamespace), ros2 (snake_case).
    if element.find("ros") is not None:
        found = [section for section in found if section.ros != "1"]
    if len(found) < 2:
        return found[0] if found else None
    tags = {child.tag for child in element}
    return max(found, key=lambda section: (len(section.tags & tags), section.ros))


@lru_cache(maxsize=16)
def builtin_tree(definitions: tuple[str, ...], release: str, ros: str = "") -> Tree:
    """Return the tree of built-in, installed and these definitions; ``ros`` is "1", "2" or open."""
    sections = load_definitions(definitions, release, ros=ros)
    try:
        tree = Tree(sections)
        if sections.extended:
            tree.check()
        return tree
    except DefinitionsError as error:
        raise DefinitionsError(f"{error}{advice(str(error))}") from None
