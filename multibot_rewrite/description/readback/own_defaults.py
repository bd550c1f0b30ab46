"""Defaults that consumers make of names in the description: of the model, its first link, a sensor.

Sources: as ``description/rewriters/own_defaults.py``;
sdformat src/parser_urdf.cc (a URDF's root link is the first
of its model, one called world is the world).
"""

from __future__ import annotations

from lxml.etree import _Element

from multibot_rewrite.description.readback.xml import child_text

MODEL = "{model}/"


def completed(host: _Element, default: str) -> str:
    """The default with the names of the description; the model's stays a slot, since the spawner gives
    it. Empty where a name is not there."""
    for word in ("link", "sensor"):
        slot = f"{{{word}}}"
        if slot in default:
            name = _first_link(host) if word == "link" else _sensor(host)
            default = default.replace(slot, name) if name else ""
    head, slot, rest = default.removeprefix(MODEL).partition("{")
    if not slot:
        return default
    text = child_text(host, rest.partition("}")[0]) or ""
    lead = MODEL if default.startswith(MODEL) else ""
    return f"{lead}{head}{text}{rest.partition('}')[2]}" if text else ""


def _sensor(host: _Element) -> str:
    sensor = next(host.iterancestors("sensor"), None)
    return sensor.get("name", "") if sensor is not None else ""


def _first_link(host: _Element) -> str:
    model = around(host)
    links = [it.get("name", "") for it in model.iter("link")]
    if model.tag == "model":
        return model.get("canonical_link") or next(iter(links), "")
    links = [it.get("name", "") for it in model.iterchildren("link")]
    above = {}
    for joint in model.iterchildren("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is not None and child is not None:
            above[child.get("link", "")] = parent.get("link", "")
    return next((it for it in links if it != "world" and above.get(it, "world") == "world"), "")


def around(host: _Element) -> _Element:
    """The model or URDF that a plugin stands in."""
    return next(host.iterancestors("model", "robot"), host)


def is_nested(model: _Element) -> bool:
    """Is it a model in a model, which robot_state_publisher does not read?"""
    return next(model.iterancestors("model"), None) is not None
