# SPDX-License-Identifier: Apache-2.0
"""Gazebo's own namespaces: what ``<model namespace="...">`` and ``<include><namespace>`` do to claims.

A release whose Gazebo does not read them leaves them out, and so does a rewrite. Where they are
read, they get the robot's name, and relative topics of the systems below them are left alone: they
would have the name twice. Which systems do is ``model_namespace:`` in the plugin definitions.

Sources: gazebosim/sdformat 43fa4a69 (#1663, in sdformat17_17.0.0-pre1) sdf/1.12/model.sdf,
world.sdf; gazebosim/gz-sim #3777 (scopedNamespace: those of nested models are joined, one with a
leading slash is absolute)."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from multibot_rewrite.base.model import Claim, SiteRow
from multibot_rewrite.base.naming import TOPIC_KINDS
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.rewriters.text import text_at

if TYPE_CHECKING:
    from collections.abc import Container, Iterable

    from lxml.etree import _Element

    from multibot_rewrite.description.rewriters.vocabulary import VocabularySection

MODEL, INCLUDE = "model", "include"
# Sections of these elements, and where their namespace is.
PLACES = {("element sdf.model", "@namespace"), ("element sdf.include", "namespace")}


def is_model_namespace(site: SiteRow) -> bool:
    """Return whether this site holds the namespace of a model."""
    return (site.section, site.path) in PLACES


def below_models(claims: list[Claim], source: bytes, release: str) -> list[Claim]:
    """Return the claims of a document for ``release``: without the namespaces of models if these are
    not read, otherwise with relative topics below them as subtopics."""
    if b"namespace" not in source:
        return claims
    made = []
    for claim in claims:
        site = claim.site
        is_topic = site.below_model and site.kinds[0] in TOPIC_KINDS
        is_read = is_topic and has_release(site.below_model, release)
        if is_read and stands_below(claim):
            made.append(claim._replace(site=_subtopic(site)))
        elif is_read or not (is_topic and is_model_namespace(site)):
            made.append(claim)
    return made


@cache
def _subtopic(site: SiteRow) -> SiteRow:
    """Return the site as a subtopic, the same object each time: the check knows sites by identity."""
    return site._replace(kinds=("subtopic",))


def own_namespaces(
    claims: list[Claim], hosts: Iterable[tuple[_Element, VocabularySection]]
) -> list[Claim]:
    """Return the claims for a layout without namespaces. A plugin's namespace is then a word like any
    other if nothing else keeps robots apart: relative names in the code of a ROS 1 plugin (a node of
    gzserver has no rules of its own, roscpp names.cpp) and a ``helper``."""
    fixed = {it for it, section in hosts if section.helper or has_own_names(section)}
    return [_word_of(it, fixed) for it in claims] if fixed else claims


def _word_of(claim: Claim, plugins: Container[_Element]) -> Claim:
    whole = claim.site.form in ("whole", "below") and claim.value.strip()
    if claim.site.kinds != ("namespace",) or not whole:
        return claim
    plugin = next(claim.element.iterancestors("plugin"), None)
    return claim._replace(site=_word(claim.site)) if plugin in plugins else claim


def has_own_names(section: VocabularySection) -> bool:
    """Return whether a ROS 1 plugin has names in its code that only its namespace changes."""
    if not any(it.name[:1] not in "/{" for it in section.wired):
        return False
    paths = {it.path for it in section.sites}
    return "robotNamespace" in paths and "ros/namespace" not in paths


@cache
def _word(site: SiteRow) -> SiteRow:
    return site._replace(kinds=("stem",), namespaced=False)


def stands_below(claim: Claim) -> bool:
    """Return whether a model around this value has a namespace. The root is none."""
    element: _Element | None = claim.element
    if is_model_namespace(claim.site) and not claim.attribute:
        element = claim.element.getparent()
    assert element is not None, "a namespace is in its <include>"
    for model in element.iterancestors(MODEL, INCLUDE):
        namespace = namespace_of(model)
        if namespace.strip("/"):
            return True
        if namespace:
            return False
    return False


def namespace_of(model: _Element) -> str:
    """Return the namespace that a ``<model>`` or ``<include>`` is given, empty for none."""
    if model.tag == INCLUDE:
        return text_at(model, "namespace").strip()
    return model.get("namespace", "").strip()
