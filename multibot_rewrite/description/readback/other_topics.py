# SPDX-License-Identifier: Apache-2.0
"""The topics of something that is no ROS 2 node: of Gazebo's transport, and of plugins of ROS 1.

Sources: gazebosim/sdformat 43fa4a69 (#1663) src/Model.cc (``{name}`` is the model's name), parser.cc
(an empty ``<include><namespace>`` is none); gazebosim/gz-sim #3777 src/Util.cc scopedNamespace.
"""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import SiteRow
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.readback.active import TRANSFORMS_ON
from multibot_rewrite.description.readback.nodes import (
    BELOW,
    SERVES,
    SERVICE,
    TF_TOPICS,
    TOPIC,
    holds_topic,
    is_of_others,
)
from multibot_rewrite.description.readback.parameters import (
    around,
    switched_off,
    values_of,
    wired_of,
)
from multibot_rewrite.description.readback.xml import child_text, values_at
from multibot_rewrite.description.rewriters.plugin_definitions import PluginDefinition

_NOT_VALID = lazy_compile("@|~|//|:=")
# Elements whose topics are those of Gazebo's transport.
OF_GZ = frozenset({"sensor", "particle_emitter"})


def resolved(
    host: _Element, section: PluginDefinition, release: str
) -> Iterator[tuple[str, str, str]]:
    """Yield (kind, name, parameter) of the topics of something that is no ROS 2 node."""
    # Those named after the model are left out: each robot has its own.
    above = _namespace(host, section)
    releases = section.model_namespace
    if releases and has_release(releases, release) and scoped_namespace(host) != "":
        above = scoped_namespace(host)
        # Its default topics are below it, too.
        yield from [(BELOW, above, "model@namespace")] if above else []
    stems = [site for site in section.sites if site.kinds[:1] == ("stem",) and site.form == "whole"]
    words = [(site.path, value) for site in stems for value in values_of(host, site)]
    if above is not None:
        yield from ((BELOW, _join(above, word), path) for path, word in words)
    # A word that topics are made of and that is there and empty: it takes the place of the model's
    # name, so that no robot is in them (gz-sim Thruster.cc: HasElement("namespace")).
    for site in stems:
        given = [*values_at(host, site.path)] if site.empty not in ("default", "model") else []
        if given and not any(given):
            yield BELOW, "/", site.path
    for site in filter(holds_topic, section.sites):
        kind = SERVICE if site.kinds[0] == SERVICE else TOPIC
        below = above
        if site.kinds[0] == "subtopic" and stems and above is not None:
            below = _join(above, words[0][1]) if words else None
        yield from ((kind, it, site.path) for it in _full_names(host, section, site, below))
    # The names in the code of what is no ROS 2 node, as those of ROS 1: roscpp puts the namespace
    # in front of relative ones (names.cpp), and tf's broadcaster has an absolute one (tf2_ros
    # transform_broadcaster.cpp).
    off = switched_off(host, section)
    for wired, path in wired_of(host, section):
        if wired.name not in off and (above is not None or wired.name.startswith("/")):
            kind = SERVICE if wired.role == SERVES else TOPIC
            name = wired.name if wired.name.startswith("/") else _join(above or "", wired.name)
            yield TRANSFORMS_ON if wired.name in TF_TOPICS else kind, name, path or wired.name


def of_others(host: _Element, section: PluginDefinition) -> Iterator[tuple[str, str]]:
    """Yield (name, parameter) of topics that are the world's or unchanged, below its namespace."""
    # The model's name may also be before a slash (rotors_simulator gazebo_mavlink_interface.cpp).
    # One without a name gets it from its spawner.
    model = around(host).get("name") or "~"
    of_model = any(it.kinds[:1] == ("stem",) for it in section.sites)
    above = None if of_model else _namespace(host, section)
    for site in filter(is_of_others, section.sites):
        if "model" in section.opens:
            yield from ((_join(model, it), site.path) for it in values_of(host, site))
        else:
            yield from ((it, site.path) for it in _full_names(host, section, site, above))


def _full_names(
    host: _Element, section: PluginDefinition, site: SiteRow, above: str | None
) -> Iterator[str]:
    """Yield the full names at a site, but those below a node or model that the simulator names."""
    of_gz = section.names[0].startswith("gz") or host.tag in OF_GZ
    names = values_of(host, site)
    for name in map(as_valid_topic, names) if of_gz else names:
        if name.startswith("/"):
            yield name
        elif above is not None and not name.startswith("~"):
            yield _join(above, name)


def as_valid_topic(name: str) -> str:
    """Return the topic that gz-transport makes of a text, without unknown characters and ``~``."""
    # TopicUtils.cc AsValidTopic, which gz-sim's validTopic and gz-sensors call.
    return _NOT_VALID.sub("", name.replace(" ", "_"))


def _namespace(host: _Element, section: PluginDefinition) -> str | None:
    """Return the text that the plugin puts before relative names; None for the model's name."""
    named = (it for it in section.sites if it.kinds[:1] == ("namespace",) and it.form == "whole")
    # What is below a <ros> is a node's of ROS 2.
    sites = [it for it in named if it.path[:4] != "ros/" or host.find("ros") is not None]
    values = [value for site in sites for value in values_of(host, site)]
    if not values and any(it.empty == "itself" and [*values_at(host, it.path)] for it in sites):
        return "/"
    return values[0] if values else None if sites else "/"


def _join(above: str, name: str) -> str:
    """Return an absolute topic below another name."""
    return f"/{above.strip('/')}/{name.strip('/')}".replace("//", "/")


def scoped_namespace(host: _Element) -> str | None:
    """Return ``/outer/inner`` or ``/``; empty if no model has one, None if its spawner decides."""
    parts: list[str] = []
    own_name = given = False
    for model in host.iterancestors("model", "include"):
        text = child_text(model, "namespace") if model.tag == "include" else model.get("namespace")
        text = (text or "").strip()
        if not text:
            continue
        given = True
        if "{name}" in text:
            name = _name(model)
            own_name = own_name or not name
            text = text.replace("{name}", name)
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
