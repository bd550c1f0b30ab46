# SPDX-License-Identifier: Apache-2.0
"""Topics of Gazebo that are made of names: ``/model/rover/joint/fin/cmd_thrust``.

What one system makes of the model, a word of a parameter, a link, joint or sensor, another one may
be told as a text. Both are one topic, so the names in the text are renamed as the system renames
them.

Sources: gazebosim/gz-sim src/Util.cc (scopedName), src/systems/thruster/Thruster.cc (a ``<namespace>``
stands for the model), joint_controller, multicopter_motor_model (``<robotNamespace>``).
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import Claim
from multibot_rewrite.description.rewriters.forms import Declared, NamePart
from multibot_rewrite.description.rewriters.spelling import Rules

# What is before the model: a world, which is nobody's.
_HEAD = lazy_compile(r"/?(?:world/[^/]+/)?model/")
_PART = lazy_compile(r"/(model|link|joint|sensor)/")
_ENDS = lazy_compile(r"/|$")
# A word of a parameter -> the joints of the systems that have it.
Stems = Mapping[str, frozenset[str]]
NO_WORDS: Stems = {}
STEM = ("stem",)


def names_in_topics(claims: Iterable[Claim], declared: Declared, of_models: bool) -> Rules:
    """Return the names in each Gazebo topic that is built from names, by the number of the claim.
    ``of_models`` tells whether models get other names."""
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
    """Return the words that systems build topics from, each with the joints that are named with it."""
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
    """Yield the names in a topic, in order; none if it begins with no model or word of this file."""
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
