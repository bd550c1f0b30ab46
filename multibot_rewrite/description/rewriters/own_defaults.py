# SPDX-License-Identifier: Apache-2.0
"""Defaults that are made of the description's own names, and topics that switches turn off.

Sources: gazebosim/gz-sim src/systems/diff_drive/DiffDrive.cc (gz-sim8 to 10: without frames the
model's name, ``/`` and ``odom`` or the canonical link), sdformat src/Model.cc (the first link is
canonical), gazebo_ros_pkgs ros2 gazebo_ros_camera.cpp (``camera_name`` is the sensor's name).
"""

from __future__ import annotations

from collections.abc import Iterable

from lxml import etree

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import SiteRow
from multibot_rewrite.base.naming import POSTFIX, Naming
from multibot_rewrite.description.rewriters.plugin_definitions import PluginDefinition
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import (
    MODEL as OF_MODEL,
    SPAWNED,
)
from multibot_rewrite.description.rewriters.text import end_of, text_at

# What the spawner calls the model: no frame that robot_state_publisher sends has it in front.
MODEL, SENSOR = SPAWNED, "{sensor}"
# The same for a reader.
SHOWN = f"{OF_MODEL}/"
WORLD = "world"
_SLOT = lazy_compile(r"\{(\w+)\}")
Hosts = Iterable[tuple[etree._Element, PluginDefinition]]


def default_of(host: etree._Element, default: str, naming: Naming) -> str:
    """Return the value that a plugin takes for an absent site: a literal, or from another topic."""
    conditions, asked, default = default.rpartition("?")
    if asked and not all(_condition_holds(host, condition) for condition in conditions.split(",")):
        return ""
    sibling, derived, last = default.partition("/../")
    if not derived:
        return filled(host, default)
    # Only a postfix is in the segment that is replaced.
    topic = text_at(host, sibling) if naming.topics == POSTFIX else ""
    return topic[: topic.rfind("/") + 1] + last if topic else ""


def _condition_holds(host: etree._Element, condition: str) -> bool:
    child, _, wanted = condition.partition("=")
    text = text_at(host, child)
    if wanted in ("true", "false"):
        return is_true(text) == (wanted == "true")
    return text == wanted


def filled(host: etree._Element, default: str) -> str:
    """Return the default with names filled in (``MODEL``: the model's); empty if one is missing."""
    words = {it: _own_name_for(host, it) for it in _SLOT.findall(default)}
    return _SLOT.sub(lambda slot: words[slot[1]], default) if all(words.values()) else ""


def _own_name_for(host: etree._Element, word: str) -> str:
    """Return the text for ``{word}`` in a default: model, sensor, first link, or a child's; or ""."""
    if word == "model":
        return MODEL[:-1]
    if word == "sensor":
        sensor = next(host.iterancestors("sensor"), None)
        return "" if sensor is None else sensor.get("name", "")
    if word != "link":
        return text_at(host, word)
    # The link that the model's first one is made of; of a URDF its root, or what the world holds.
    model = model_of(host)
    if model.tag == "model":
        first = next(model.iter("link"), None)
        return str(model.get("canonical_link") or ("" if first is None else first.get("name", "")))
    joints = [(end_of(it, "parent"), end_of(it, "child")) for it in model.iterchildren("joint")]
    children = {child for parent, child in joints if parent != WORLD}
    links = (str(link.get("name", "")) for link in model.iterchildren("link"))
    return next((it for it in links if it not in children and it != WORLD), "")


def model_of(host: etree._Element) -> etree._Element:
    """Return the model that contains a plugin: the root, in a URDF."""
    return next(host.iterancestors("model"), host.getroottree().getroot())


def second_senders(hosts: Hosts, naming: Naming) -> frozenset[etree._Element]:
    """Return systems whose transform another one of their model sends, or of nested models."""
    # Their frames stay below the model's name, where they do not collide.
    sections = dict(hosts)
    senders = [it for it, section in sections.items() if frame_sites(it, section, naming)]
    given = {it for it in senders if any(text_at(it, at.path) for at in _of_model(sections[it]))}
    taken = {model_of(host) for host in given}
    second = set()
    for host in senders:
        model = model_of(host)
        is_nested = next(model.iterancestors("model"), None) is not None
        if host not in given and (model in taken or is_nested):
            second.add(host)
        taken.add(model)
    return frozenset(second)


def frame_sites(host: etree._Element, section: PluginDefinition, naming: Naming) -> list[SiteRow]:
    """Return the rows for frames whose default, made of the model's name, applies to a system."""
    return [it for it in _of_model(section) if default_of(host, it.default, naming)]


def _of_model(section: PluginDefinition) -> list[SiteRow]:
    """Return the rows for frames that are below the model's name by default."""
    return [it for it in section.sites if OF_MODEL in it.default and it.kinds[:1] == ("frame",)]


# As sdformat reads booleans (Param.cc, ValueFromStringImpl): case and white space around do not
# count, any other text leaves the default.
def is_true(text: str) -> bool:
    """Return whether a text turns a parameter on."""
    return text.strip().lower() in ("true", "1")


def is_false(text: str) -> bool:
    """Return whether a text turns a parameter off."""
    return text.strip().lower() in ("false", "0")


def switched_off(plugin: etree._Element, section: PluginDefinition) -> dict[str, str]:
    """Return the topics that none of their switches turns on, with the parameters that would."""
    found = [it.split("=") for it in section.switches]
    on = set()
    for parameter, topic, *usual in found:
        text = text_at(plugin, parameter)
        # One that is not there is as its code has it.
        if is_true(text) or (usual == ["on"] and not is_false(text)):
            on.add(topic)
    off = lists_by_key((topic, parameter) for parameter, topic, *_ in found if topic not in on)
    return {topic: " or ".join(parameters) for topic, parameters in off.items()}
