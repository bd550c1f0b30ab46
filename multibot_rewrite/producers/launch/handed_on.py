# SPDX-License-Identifier: Apache-2.0
"""What a launch file itself gives a node that nobody knows: what is built gives it the same."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

from multibot_rewrite.base.naming import TWIN
from multibot_rewrite.base.rosnames import expand
from multibot_rewrite.producers.evidence.parameter_files import values_for
from multibot_rewrite.producers.launch.parameter_texts import document_of, has_sections
from multibot_rewrite.producers.launch.records import LaunchedNode

# Whoever starts the node decides it.
_CLOCK = "use_sim_time"


class HandedOn(NamedTuple):
    """The parameters that are in no file, the words of the program and its environment. ``is_unnamed``
    is true if it always starts, and only its code has its name."""

    values: Mapping[str, Any]
    arguments: tuple[str, ...]
    environment: Mapping[str, str]
    is_unnamed: bool = False

    @property
    def names(self) -> list[str]:
        """What all of it is called, for people."""
        return [*self.values, *self.arguments, *self.environment]

    def for_any(self, robot: str) -> HandedOn:
        """Return the same of a launch for one robot, without that robot."""
        word = re.compile(rf"(?<![A-Za-z0-9]){re.escape(robot)}(?![A-Za-z0-9])")
        return HandedOn(*(_each(it, lambda text: word.sub(TWIN, text)) for it in self))

    def for_robot(self, robot: str) -> HandedOn:
        """Return the same for a robot."""
        return HandedOn(*(_each(it, lambda text: text.replace(TWIN, robot)) for it in self))


def handed_on(node: LaunchedNode, name: str) -> HandedOn:
    """Return what a launch file gives a node that is called so, but for the files that are there
    without the launch: these are rewritten, and what they set later counts."""
    full = expand(name.rpartition("/")[2], node.namespace, "")
    values: dict[str, Any] = {}
    for it in node.parameters:
        told = values_for(full, [document_of(it.file, it.text)]) if has_sections(it) else {}
        values |= {key: one.value for key, one in told.items()}
        values = {key: one for key, one in values.items() if not (it.source and key in told)}
    values.pop(_CLOCK, None)
    is_unnamed = not (node.name or node.later)
    return HandedOn(values, node.arguments, dict(node.environment), is_unnamed)


def _each(it: Any, change: Any) -> Any:
    """Return a value with each text in it changed."""
    if isinstance(it, Mapping):
        return {key: _each(one, change) for key, one in it.items()}
    if isinstance(it, list | tuple):
        return type(it)(_each(one, change) for one in it)
    return change(it) if isinstance(it, str) else it
