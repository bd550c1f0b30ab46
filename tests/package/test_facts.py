# SPDX-License-Identifier: Apache-2.0
"""Every fact that was read from public source has a row of the plugin definitions, or a stated reason.

``fixtures/facts.tsv`` holds a line for each thing an element, plugin or hardware class reads: type,
names, ROS version, path, kind. ``fixtures/facts_exceptions.tsv`` holds, for the lines that the
definitions decides otherwise, type, first name, path and the reason.
"""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import pytest
from lxml import etree
from paths import FIXTURES

from multibot_rewrite.base.model import SiteRow
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.rewriters.plugin_definitions import (
    PluginDefinition,
    load_definitions,
    split_path,
    split_step,
)
from multibot_rewrite.description.rewriters.tree import TreeNode, builtin_tree, qualified

LEAST_FACTS = 1500
# Kinds of facts that are no name of ours: nothing may be renamed there.
NO_NAMES = {"value", "param_name", "param_file", "material", "visual", "light"}
# What the facts call a kind, and what the plugin definitions may call it.
KINDS = {
    "node_name": {"node"},
    "remap": {"topic"},
    "camera": {"stem", "sensor", "topic"},
    "plugin": {"node"},
    "scoped_name": {"link", "joint", "model", "frame"},
    "link or joint": {"link", "joint"},
    "link or frame": {"link", "frame"},
    "hardware_group": {"hardware"},
    "end_effector": {"group"},
    "frame": {"frame", "link", "joint"},
    "link": {"link", "frame", "collision"},
    "collision": {"collision", "link", "model"},
    "topic": {"topic", "subtopic", "stem"},
    "service": {"service", "subtopic", "topic"},
    "namespace": {"namespace", "stem", "subtopic", "topic"},
    "model": {"model"},
    "sensor": {"sensor"},
}


class Fact(NamedTuple):
    """One line of ``facts.tsv``; ``path`` is empty where the plugin reads no name at all."""

    type: str
    names: tuple[str, ...]
    ros: str
    path: str
    kind: str

    @property
    def key(self) -> tuple[str, str, str]:
        """What exceptions are listed by."""
        return self.type, self.names[0] if self.names else "", self.path


def facts() -> list[Fact]:
    """All of them."""
    rows = [row.split("\t") for row in (FIXTURES / "facts.tsv").read_text().splitlines()]
    return [Fact(t, tuple(names.split()), ros, path, kind) for t, names, ros, path, kind in rows]


def exceptions() -> dict[tuple[str, str, str], str]:
    """(type, first name, path) -> the reason why the plugin definitions does not follow the fact."""
    rows = (FIXTURES / "facts_exceptions.tsv").read_text().splitlines()
    return {(t, name, path): reason for t, name, path, reason in (row.split("\t") for row in rows)}


FACTS = facts()
EXCEPTIONS = exceptions()


def test_nothing_was_lost() -> None:
    assert len(FACTS) >= LEAST_FACTS
    assert not [key for key, count in Counter((f.key, f.ros) for f in FACTS).items() if count > 1]


@pytest.mark.more
def test_every_fact_is_followed_or_excepted() -> None:
    wrong = {fact.key: trouble(fact) for fact in FACTS if trouble(fact)}
    assert {key: words for key, words in wrong.items() if key not in EXCEPTIONS} == {}


def test_every_exception_is_needed_and_says_why() -> None:
    needed = {fact.key for fact in FACTS if trouble(fact)}
    assert sorted(EXCEPTIONS.keys() - needed) == []
    assert all(len(reason.split()) >= 3 for reason in EXCEPTIONS.values())


def trouble(fact: Fact) -> str:
    """Return what is wrong with the plugin definitions by this fact; empty where nothing is."""
    return element_trouble(fact) if fact.type == "element" else host_trouble(fact)


def host_trouble(fact: Fact) -> str:
    """Return the same for a plugin or a hardware class, under each of its names."""
    for name in fact.names:
        found = load_definitions((), NEWEST_LTS).find(fact.type, name)
        flavours = [
            r for r in found if not (fact.ros in ("1", "2") and r.ros not in ("", fact.ros))
        ]
        if not flavours:
            return f"no section [{fact.type} {name}]{' for ROS ' + fact.ros if found else ''}"
        for section in flavours:
            words = site_trouble(fact, host_site(section, fact.path))
            if words:
                return words
    return ""


def host_site(section: PluginDefinition, path: str) -> SiteRow | None:
    """Return the row of a plugin or hardware class for a path, its own or one that holds for all."""
    common = {"plugin": "plugin", "hardware": "ros2_control"}[section.type]
    (shared,) = load_definitions((), NEWEST_LTS).find("element", common)
    return {site.path: site for site in shared.sites + section.sites}.get(path)


def element_trouble(fact: Fact) -> str:
    """Return the same for a place in a document."""
    steps, attribute = split_path(fact.path[1:])
    tree = builtin_tree((), NEWEST_LTS)
    node: TreeNode | None = tree.formats.get(steps[0])
    for step in steps[1:]:
        tag, asked, value = split_step(step)
        node = node and node.children.get(qualified(tag))
        if node and asked:
            node = node.select(etree.Element(tag, {asked: value})) if node.select else None
    if node is None:
        return site_trouble(fact, None)
    sites = dict(node.attributes) | node.keeps | ({"": node.text} if node.text else {})
    return site_trouble(fact, sites.get(attribute))


def site_trouble(fact: Fact, site: SiteRow | None) -> str:
    """Whether a row, or its absence, says what the fact says."""
    if fact.kind == "-":
        return ""
    kinds = set(site.kinds) if site and site.role != "keep" else set()
    if fact.kind in NO_NAMES:
        return f"{sorted(kinds)} for what is no name" if kinds else ""
    if not kinds:
        return f"no site for the {fact.kind}"
    wanted = KINDS.get(fact.kind, {fact.kind})
    return "" if kinds & wanted else f"{sorted(kinds)} for a {fact.kind}"


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        pytest.param("/robot/link/colour", "link", id="a-missing-row"),
        pytest.param("/robot/joint/parent@link", "joint", id="another-kind"),
        pytest.param("/robot/joint/parent@link", "value", id="a-name-that-is-none"),
    ],
)
def test_a_wrong_fact_is_noticed(path: str, kind: str) -> None:
    assert trouble(Fact("element", (), "", path, kind))
