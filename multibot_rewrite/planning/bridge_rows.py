# SPDX-License-Identifier: Apache-2.0
"""The topics of sensors and systems of gz-sim in a release, by ``bridge.yaml``, with their gz names.

Source: gazebosim/gz-sim src/systems, as the data says; transport::TopicUtils::AsValidTopic."""

from collections.abc import Iterator, Mapping
from functools import lru_cache
from itertools import product
from typing import Any, NamedTuple

from lxml.etree import _Element

from multibot_rewrite import knowledge
from multibot_rewrite.base.bounded import load_own_yaml
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.readback.other_topics import as_valid_topic
from multibot_rewrite.description.readback.parameters import holds
from multibot_rewrite.description.readback.xml import values_at

SENSORS, PLUGINS = "sensors", "plugins"
MODEL = "model"
# Stands where the part below the model begins.
_HERE = "\0"
_SLOT = lazy_compile(r"\{([^{}]*)\}")


class BridgeRow(NamedTuple):
    """A topic of a sensor or plugin: the element that names it, its default, its types and direction.

    ``releases``, ``when``, ``needs`` and ``unless`` are what it is there for, ``ending`` follows the
    name, ``unread`` are the releases that do not read the element. ``why`` is the reason that nothing
    comes on it. Of a sensor ``element`` is what follows its topic, which is ``at`` a path.
    """

    element: str
    default: str
    ros_type: str
    gz_type: str
    way: str
    releases: str = ""
    when: str = ""
    needs: str = ""
    unless: str = ""
    ending: str = ""
    unread: str = ""
    why: str = ""
    at: str = "topic"


@lru_cache(maxsize=1)
def bridge_data() -> Mapping[str, Any]:
    """Return the data of ``bridge.yaml``."""
    data: Mapping[str, Any] = load_own_yaml(knowledge.__file__, "bridge.yaml")
    return data


# Types of sensors are texts of users.
@lru_cache(maxsize=256)
def rows_of(kind: str, name: str, release: str) -> tuple[BridgeRow, ...]:
    """Return the rows of a type of sensor, or of a section of plugins, in a release."""
    rows = (
        BridgeRow(*row[:5], **(row[5] if row[5:] else {}))
        for row in bridge_data()[kind].get(name, ())
    )
    return tuple(row for row in rows if has_release(row.releases, release))


def is_there(row: BridgeRow, host: _Element) -> bool:
    """Return whether the parameters of a sensor or plugin make it have the topic of a row."""
    there = all(next(values_at(host, it), None) is not None for it in row.needs.split())
    return there and (not row.when or holds(host, row.when))


def given_topic(row: BridgeRow, plugin: _Element, release: str) -> str:
    """Return the topic that a plugin is given; empty where it takes its default."""
    is_unread = bool(row.unread) and has_release(row.unread, release)
    given = "" if is_unread or not row.element else next(values_at(plugin, row.element), "")
    return f"{given}{row.ending}" if given else ""


def default_topics(row: BridgeRow, plugin: _Element, model: str) -> Iterator[tuple[str, str]]:
    """Yield the default topics, each with what is below the model or its namespace.

    There are several where an element is repeated, and none where one is missing."""
    above, slash, below = (row.default + row.ending).partition("}/")
    # Once for each choice of values for its slots.
    parts = _SLOT.split(f"{above}{slash}{_HERE}{below}")
    values = [_values(slot, plugin, model) for slot in parts[1::2]]
    for chosen in product(*values):
        name = "".join((*(a + b for a, b in zip(parts[::2], chosen, strict=False)), parts[-1]))
        head, _, rest = name.partition(_HERE)
        yield as_valid_topic(f"{head}{rest}"), rest if slash else ""


def _values(slot: str, plugin: _Element, model: str) -> list[str]:
    """Return the values in a plugin for ``PATH``, ``PATH*`` (all), ``PATH|model`` or ``PATH|=TEXT``."""
    for word in slot.split("|"):
        if word == MODEL:
            return [model]
        if word.startswith("="):
            return [word[1:]]
        found = [text for text in values_at(plugin, word.rstrip("*")) if text]
        if found:
            return found if word.endswith("*") else found[:1]
    return []
