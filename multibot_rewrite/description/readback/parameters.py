# SPDX-License-Identifier: Apache-2.0
"""Reads the value of a parameter as its consumer does: from the file, else the default.

Sources: as ``description/rewriters/own_defaults.py``; sdformat src/parser_urdf.cc (a URDF's root
link is the first of its model, one called world is the world)."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import SiteRow
from multibot_rewrite.description.readback.xml import child_text, is_on, values_at
from multibot_rewrite.description.rewriters.plugin_definitions import PluginDefinition
from multibot_rewrite.description.rewriters.plugin_definitions.grammar import (
    MODEL as OF_FILE,
    SENT,
    SPAWNED,
)
from multibot_rewrite.description.rewriters.plugin_definitions.values import WiredTopic, is_type

MODEL = SPAWNED
_SLOT = lazy_compile(r"\{([^{}]+)\}")


def values_of(host: _Element, site: SiteRow) -> list[str]:
    """Return a site's values in order, or the default; none where an empty element means another."""
    if site.when not in ("", SENT) and not _applies(host, site):
        return []
    given = list(values_at(host, site.path))
    if not any(given) and (not given or site.empty == "default"):
        given = [default_of(host, site.default)]
    return [value for value in given if value]


def _applies(host: _Element, site: SiteRow) -> bool:
    """Return whether the sibling that decides this text exists, next to the path's last step."""
    sibling, _, wanted = site.when.partition("=")
    above = site.path.rpartition("/")[0]
    texts = set(wanted.split("|"))
    if OF_FILE in texts:
        texts |= {it.get("name") or "" for it in host.getroottree().iter("robot", "model")}
    return not texts.isdisjoint(values_at(host, f"{above}/{sibling}" if above else sibling))


def default_of(host: _Element, default: str) -> str:
    """Return a default with the names of the description filled in; empty if one is missing.

    ``a=true,b=?x``: x if these siblings have these texts; ``topic/../x``: the value of a sibling
    with its last segment replaced; ``{model}/x``: x below what the model is spawned as, with
    ``MODEL``."""
    conditions, asked, default = default.rpartition("?")
    if asked and not holds(host, conditions):
        return ""
    sibling, derived, last = default.partition("/../")
    if not derived:
        words = {it: _text_for_slot(host, it) for it in _SLOT.findall(default)}
        return _SLOT.sub(lambda slot: words[slot[1]], default) if all(words.values()) else ""
    topic = child_text(host, sibling) or ""
    return f"{topic.rpartition('/')[0]}/{last}" if "/" in topic else last if topic else ""


def holds(host: _Element, conditions: str) -> bool:
    """Return whether all of ``a=true,../@b=x|y`` hold. A missing flag is off."""
    return all(_condition_holds(host, it) for it in conditions.split(","))


def _condition_holds(host: _Element, condition: str) -> bool:
    path, _, wanted = condition.rpartition("=")
    text = next(iter(given_at(host, path)), "")
    if wanted not in ("true", "false"):
        return text in wanted.split("|")
    return is_on(text, usual=False) == (wanted == "true")


def given_at(host: _Element, path: str) -> list[str]:
    """Return the values at a path below an element, or, after ``../``, below its parent."""
    below = path.removeprefix("../")
    start = host if below == path else host.getparent()
    return [] if start is None else list(values_at(start, below))


def switched_off(host: _Element, section: PluginDefinition) -> dict[str, str]:
    """Return the topics that no parameter turns on, with the parameters that would."""
    found = list(_switches(host, section))
    on = {topic for _, topic, is_set in found if is_set}
    off = lists_by_key((topic, parameter) for parameter, topic, _ in found if topic not in on)
    return {topic: " or ".join(names) for topic, names in off.items()}


def sends_odometry(host: _Element, section: PluginDefinition) -> bool:
    """Return whether the transform of odometry is on. Its switch is the first one of /tf."""
    found = [is_set for _, topic, is_set in _switches(host, section) if topic == "/tf"]
    return not found or found[0]


def _switches(host: _Element, section: PluginDefinition) -> Iterator[tuple[str, str, bool]]:
    """Yield (parameter, topic, is the switch on) for each switch of a plugin's topics."""
    for switch in section.switches:
        parameter, topic, *usual = switch.split("=")
        yield parameter, topic, is_on(child_text(host, parameter), usual=bool(usual))


def _text_for_slot(host: _Element, word: str) -> str:
    """Return the text for ``{word}`` in a default: link, sensor, model or a child's; "" if missing."""
    if word == "link":
        return _first_link_name(host)
    if word == "sensor":
        sensor = next(host.iterancestors("sensor"), None)
        return sensor.get("name", "") if sensor is not None else ""
    return MODEL[:-1] if word == "model" else child_text(host, word) or ""


def _first_link_name(host: _Element) -> str:
    model = around(host)
    if model.tag == "model":
        every = (it.get("name", "") for it in model.iter("link"))
        return model.get("canonical_link") or next(every, "")
    links = [it.get("name", "") for it in model.iterchildren("link")]
    above = {}
    for joint in model.iterchildren("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is not None and child is not None:
            above[child.get("link", "")] = parent.get("link", "")
    return next((it for it in links if it != "world" and above.get(it, "world") == "world"), "")


def around(host: _Element) -> _Element:
    """Return the model or URDF that contains a plugin."""
    return next(host.iterancestors("model", "robot"), host)


def wired_of(plugin: _Element, section: PluginDefinition) -> Iterator[tuple[WiredTopic, str]]:
    """Yield each wired topic with the path of the parameter that it is below, empty without one."""
    for it in section.wired:
        if it.when and not holds(plugin, it.when):
            continue
        path = it.name.partition("{")[2].partition("}")[0]
        for name in filled(plugin, section, it.name):
            yield it._replace(name=name, type=_type(plugin, it.type)), path


def filled(plugin: _Element, section: PluginDefinition, name: str) -> Iterator[str]:
    """Yield the name with each value that the plugin has for ``{path}`` in it."""
    head, slot, rest = name.partition("{")
    if not slot:
        yield name
        return
    path, _, tail = rest.partition("}")
    site = next((it for it in section.sites if it.path == path), None)
    # A value may hold what looks like a path: it is none.
    ends = list(filled(plugin, section, tail))
    values = given_at(plugin, path) if site is None else values_of(plugin, site)
    if "/../" in path:
        values = [it for it in (default_of(plugin, path),) if it]
    for value in values:
        yield from (f"{head}{value}{end}" for end in ends)


def _type(plugin: _Element, type_: str) -> str:
    """Return the type of ``{output_type:pkg/msg/A}``: what the plugin gets, maybe without ``msg``."""
    if not type_.startswith("{"):
        return type_
    path, _, usual = type_[1:-1].partition(":")
    text = next(iter(given_at(plugin, path)), "") or usual
    full = text if text.count("/") > 1 else text.replace("/", "/msg/")
    return full if is_type(full) else ""
