# SPDX-License-Identifier: Apache-2.0
"""Names that Gazebo makes: its namespaces, and topics like ``/model/rover/joint/fin/cmd_thrust``.

What ``<model namespace="...">`` and ``<include><namespace>`` do to claims: a release whose Gazebo does
not read them leaves them out, and so does a rewrite. Where they are read, they get the robot's name,
and relative topics of the systems below them are left alone: they would have the name twice. Which
systems do is ``model_namespace:`` in the plugin definitions.

What one system makes of the model, a word of a parameter, a link, joint or sensor, another one may
be told as a text. Both are one topic, so the names in the text are renamed as the system renames
them.

Sources: gazebosim/sdformat 43fa4a69 (#1663, in sdformat17_17.0.0-pre1) sdf/1.12/model.sdf,
world.sdf; gazebosim/gz-sim #3777 (scopedNamespace: those of nested models are joined, one with a
leading slash is absolute), src/Util.cc (scopedName), src/systems/thruster/Thruster.cc (a
``<namespace>`` stands for the model), joint_controller, multicopter_motor_model
(``<robotNamespace>``)."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import TYPE_CHECKING

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Claim, SiteRow
from multibot_rewrite.base.naming import TOPIC_KINDS
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.rewriters.forms import Declared, NamePart
from multibot_rewrite.description.rewriters.renaming import Rules
from multibot_rewrite.description.rewriters.text import text_at

if TYPE_CHECKING:
    from collections.abc import Container

    from lxml.etree import _Element

    from multibot_rewrite.description.rewriters.plugin_definitions import PluginDefinition

MODEL, INCLUDE = "model", "include"
# Sections of these elements, and where their namespace is.
PLACES = {("element sdf.model", "@namespace"), ("element sdf.include", "namespace")}


def is_model_namespace(site: SiteRow) -> bool:
    """Return whether this site holds the namespace of a model."""
    return (site.section, site.path) in PLACES


def below_models(claims: list[Claim], source: bytes, release: str) -> list[Claim]:
    """Return a release's claims; if it reads models' namespaces, topics are subtopics of them."""
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
    claims: list[Claim], hosts: Iterable[tuple[_Element, PluginDefinition]]
) -> list[Claim]:
    """Return the claims for a layout without namespaces, with some plugins' as renamed names."""
    # So if nothing else keeps robots apart: relative names in the code of a ROS 1 plugin (a node of
    # gzserver has no rules of its own, roscpp names.cpp) and a ``helper``.
    fixed = {it for it, section in hosts if section.helper or has_own_names(section)}
    return [_as_renamed_name(it, fixed) for it in claims] if fixed else claims


def _as_renamed_name(claim: Claim, plugins: Container[_Element]) -> Claim:
    whole = claim.site.form in ("whole", "below") and claim.value.strip()
    if claim.site.kinds != ("namespace",) or not whole:
        return claim
    plugin = next(claim.element.iterancestors("plugin"), None)
    return claim._replace(site=_stem_site(claim.site)) if plugin in plugins else claim


def has_own_names(section: PluginDefinition) -> bool:
    """Return whether a ROS 1 plugin has names in its code that only its namespace changes."""
    if not any(it.name[:1] not in "/{" for it in section.wired):
        return False
    paths = {it.path for it in section.sites}
    return "robotNamespace" in paths and "ros/namespace" not in paths


@cache
def _stem_site(site: SiteRow) -> SiteRow:
    return site._replace(kinds=("stem",), namespaced=False)


def stands_below(claim: Claim) -> bool:
    """Return whether a model around a claimed value has a namespace. The root is none."""
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


# What is before the model: a world, which is nobody's.
_HEAD = lazy_compile(r"/?(?:world/[^/]+/)?model/")
_PART = lazy_compile(r"/(model|link|joint|sensor)/")
_ENDS = lazy_compile(r"/|$")
# A word of a parameter -> the joints of the systems that have it.
Stems = Mapping[str, frozenset[str]]
NO_WORDS: Stems = {}
STEM = ("stem",)


def names_in_topics(claims: Iterable[Claim], declared: Declared, of_models: bool) -> Rules:
    """Return the names in each Gazebo topic built from names; ``of_models``: models are renamed."""
    stems: Stems | None = None
    found: dict[int, tuple[NamePart, ...]] = {}
    for at, claim in enumerate(claims):
        # Most values have none: a look that costs less than a call.
        whole = claim.value.startswith("/") or _HEAD.match(claim.value)
        if "/" in claim.value and whole and _is_topic(claim):
            if stems is None:
                stems = words_of(claims)
            parts = tuple(parts_of(claim.value, stems, declared))
            if parts and (of_models or parts[0].kinds == STEM):
                found[at] = parts
    return found


def _is_topic(claim: Claim) -> bool:
    site = claim.site
    return site.kinds[:1] == ("topic",) and site.form == "whole" and not site.namespaced


def given_topics(claims: Iterable[Claim]) -> frozenset[str]:
    """Return the topics of Gazebo that a description gives, without the slash in front."""
    return frozenset(it.value.strip().lstrip("/") for it in claims if _is_topic(it))


def words_of(claims: Iterable[Claim]) -> Stems:
    """Return the names that systems build topics from, each with its joints."""
    beside: dict[object, list[str]] = defaultdict(list)
    words: list[tuple[str, object]] = []
    for claim in claims:
        if claim.site.namespaced or claim.site.form != "whole" or claim.attribute:
            continue
        if claim.site.kinds[:1] == ("joint",):
            beside[claim.element.getparent()].append(claim.value.strip())
        elif claim.site.kinds[:1] == STEM and claim.value.strip("/ "):
            words.append((claim.value.strip().strip("/"), claim.element.getparent()))
    found: dict[str, frozenset[str]] = {}
    for word, host in words:
        found[word] = found.get(word, frozenset()).union(beside[host])
    return found


def parts_of(value: str, stems: Stems, declared: Declared) -> Iterator[NamePart]:
    """Yield the names in a topic, in order; none if its first name is not of this file."""
    bare = len(value) - len(value.lstrip().lstrip("/"))
    head = _HEAD.match(value, bare)
    at = head.end() if head else bare
    model = _longest(value, at, declared.get("model", ())) if head else ""
    word = _longest(value, at, stems)
    if word and word == model:
        # Of a system with this word, or of one that takes the model's name?
        behind = value[at + len(word) :]
        ours = (re.match(rf"/joint/{re.escape(it)}(?:/|$)", behind) for it in stems[word])
        word = word if any(ours) else ""
    if head and not word and not model:
        # A word with its own ``model/`` in front.
        at, word = bare, _longest(value, bare, stems)
    kinds, name = (STEM, word) if word else (("model",), model)
    if not name:
        return
    yield NamePart(at, name, kinds, False, kinds)
    at += len(name)
    # The links, joints and sensors below a model, each declared in this file.
    while part := _PART.match(value, at):
        kind, start = part[1], part.end()
        name = _longest(value, start, declared.get(kind, ()))
        if not name:
            return
        yield NamePart(start, name, (kind,), True, (kind,))
        at = start + len(name)


def _longest(value: str, at: int, names: Iterable[str]) -> str:
    """Return the longest of these names that is at this place as whole words of the path."""
    there = (it for it in names if it and value.startswith(it, at))
    return max((it for it in there if _ENDS.match(value, at + len(it))), key=len, default="")
