# SPDX-License-Identifier: Apache-2.0
"""Gazebo's own namespaces in a description: is that of a model in use, in this release?"""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.releases import has_release
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.rewriters.model_namespaces import INCLUDE, MODEL, namespace_of
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps.collect import Inventory

IGNORED, IN_USE = "MB419", "MB429"
# The Gazebo of each release's packages. Source: gazebosim/ros_gz README.md, branch ros2.
GAZEBO = {"humble": "Fortress", "jazzy": "Harmonic", "kilted": "Ionic", "lyrical": "Jetty"}


def ignored_namespaces(inventory: Inventory, tree: Tree) -> Iterator[Problem]:
    """Namespaces of models that the release's Gazebo does not read."""
    release = tree.vocabulary.release
    for model in [] if _are_read(tree) else _with_namespace(inventory):
        who = f"Gazebo {GAZEBO.get(release, 'of main')} ({release})"
        message = f"{who} does not read the namespace {namespace_of(model)!r} of {_named(model)}"
        yield Problem(model, message, None, "set the topics of its plugins", (), IGNORED)


def used_namespaces(inventory: Inventory, tree: Tree) -> Iterator[Problem]:
    """Namespaces of models that plugins of theirs put in front of their relative topics."""
    models = _with_namespace(inventory) if _are_read(tree) else []
    below = _below(inventory, tree) if models else []
    for model in models:
        count = sum(model in plugin.iterancestors() for plugin in below)
        if count:
            puts = f"{plural(count, 'plugin')} {'puts' if count == 1 else 'put'}"
            what = f"the namespace {namespace_of(model)!r} of {_named(model)}"
            message = f"{puts} {what} in front of relative topics, if Gazebo was built with that"
            yield Problem(model, message, None, "absolute topics hold everywhere", (), IN_USE)


def _are_read(tree: Tree) -> bool:
    sections = tree.vocabulary.find("element", "sdf.model")
    return any(has_release(it.model_namespace, tree.vocabulary.release) for it in sections)


def _below(inventory: Inventory, tree: Tree) -> list[_Element]:
    release = tree.vocabulary.release
    sections = ((host.element, host.node.section) for host in inventory.hosts)
    words = ((element, section.model_namespace) for element, section in sections if section)
    return [element for element, of in words if of and has_release(of, release)]


def _with_namespace(inventory: Inventory) -> list[_Element]:
    if b"namespace" not in inventory.document.source:
        return []
    models = inventory.document.root.iter(MODEL, INCLUDE)
    return [model for model in models if namespace_of(model)]


def _named(model: _Element) -> str:
    name = text_at(model, "name") if model.tag == INCLUDE else model.get("name")
    return f"model {name!r}" if name else f"this <{model.tag}>"
