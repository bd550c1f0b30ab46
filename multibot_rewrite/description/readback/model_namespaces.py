# SPDX-License-Identifier: Apache-2.0
"""The namespace that Gazebo puts in front of a system's relative topics: of the models around it.

Sources: gazebosim/sdformat 43fa4a69 (#1663) src/Model.cc (``{name}`` is the model's name), parser.cc
(an empty ``<include><namespace>`` is none); gazebosim/gz-sim #3777 src/Util.cc scopedNamespace.
"""

from __future__ import annotations

from lxml.etree import _Element

from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.readback.xml import child_text
from multibot_rewrite.description.rewriters.vocabulary import VocabularySection

PLACEHOLDER = "{name}"


def reads_it(section: VocabularySection, release: str) -> bool:
    """Return whether this system puts the namespace of its model in front, in ``release``."""
    return bool(section.model_namespace) and has_release(section.model_namespace, release)


def scoped_namespace(host: _Element) -> str | None:
    """Return ``/outer/inner``; ``/`` for the root, empty where no model has one, None where it
    contains the name that the robot's model is spawned by."""
    parts: list[str] = []
    own_name = given = False
    for model in host.iterancestors("model", "include"):
        text = child_text(model, "namespace") if model.tag == "include" else model.get("namespace")
        text = (text or "").strip()
        if not text:
            continue
        given = True
        if PLACEHOLDER in text:
            name = _name(model)
            own_name = own_name or not name
            text = text.replace(PLACEHOLDER, name)
        parts.append(text.strip("/"))
        if text.startswith("/"):
            break
    if own_name:
        return None
    return "/" + "/".join(it for it in reversed(parts) if it) if given else ""


def _name(model: _Element) -> str:
    """Return a model's name in the file; empty for the outermost, which its spawner names."""
    if next(model.iterancestors("model", "include"), None) is None:
        return ""
    return (child_text(model, "name") if model.tag == "include" else model.get("name")) or ""
