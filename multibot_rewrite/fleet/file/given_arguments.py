"""The xacro arguments that a fleet file gives to a robot."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.description.sources.own_names import filled
from multibot_rewrite.description.sources.read import is_xacro


def given_arguments(
    data: Mapping[str, Any], own: Mapping[str, Any], description: str, place: str
) -> dict[str, str]:
    """The xacro arguments of a robot, over those of the fleet; only for xacro files.

    Raises InputError for arguments without a xacro, and for an unknown placeholder.
    """
    files = (description, *(own.get(it, data.get(it, "")) for it in ("srdf", "simulated")))
    if not any(is_xacro(it) for it in files):
        if own.get("arguments"):
            hint = "remove them, or give a xacro"
            raise InputError(f"{place}: {own['name']!r} has arguments but no xacro file; {hint}")
        return {}
    arguments = {**data.get("arguments", {}), **own.get("arguments", {})}
    # YAML's true is xacro's true.
    texts = {k: str(it).lower() if isinstance(it, bool) else str(it) for k, it in arguments.items()}
    try:
        filled(texts, own["name"])
    except UsageError as error:
        raise InputError(f"{place}: {own['name']!r}: {error}") from None
    return texts
