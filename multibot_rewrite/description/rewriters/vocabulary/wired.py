# SPDX-License-Identifier: Apache-2.0
"""Topics and services that a plugin's code names, as a section has them: ``odom=pkg/msg/Name``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.base.model import VocabularyError
from multibot_rewrite.base.record import NamedTuple

ROLES = ("publishes", "subscribes", "serves")


class WiredTopic(NamedTuple):
    """An end of a topic or service: its role, its name in the code, its type, empty if not known.

    ``{PATH}`` in the name is the value at a path, and ``{PATH:TYPE}`` as the type the one that is
    written there, or TYPE. ``when`` are conditions, as before the ``?`` of a default.
    """

    role: str
    name: str
    type: str = ""
    when: str = ""

    @property
    def is_moved(self) -> bool:
        """Is it below the value of a parameter, so that no rule is needed to move it?"""
        return "{" in self.name


def wired_topics(place: str, settings: Mapping[str, str]) -> Iterator[WiredTopic]:
    """The words of ``publishes:``, ``subscribes:`` and ``serves:``; raises VocabularyError."""
    for role in ROLES:
        for word in settings.get(role, "").split():
            when, asked, topic = word.rpartition("?")
            name, given, type_ = topic.partition("=")
            usual = type_[1:-1].partition(":")[2] if type_[:1] + type_[-1:] == "{}" else type_
            known = is_type(usual) or not given
            if not (known and name and name.count("{") == name.count("}") and (when or not asked)):
                raise VocabularyError(f"{place}: {role}: {word!r} is not TOPIC or TOPIC=TYPE")
            yield WiredTopic(role, name, type_, when)


def role_and_type(place: str, options: Mapping[str, str]) -> tuple[str, str]:
    """Of a row that holds a topic: ``publishes=TYPE``; raises VocabularyError."""
    role = next((it for it in options if it in ROLES), "")
    type_ = options.get(role, "")
    if role and not is_type(type_):
        raise VocabularyError(f"{place}: {role}={type_} is no type: write sensor_msgs/msg/Imu")
    return role, type_


def is_type(text: str) -> bool:
    """Is this the full name of a message or service type?"""
    package, _, rest = text.partition("/")
    kind, _, name = rest.partition("/")
    return kind in ("msg", "srv") and package.isidentifier() and name.isidentifier()
