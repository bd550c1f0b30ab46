"""Names that are not valid in other formats (USD, MJCF), checked with the option targets."""

from __future__ import annotations

import re
from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.description.names.shared import TOKEN, named
from multibot_rewrite.rules.subject import Subject


@rule(
    "MB320",
    "invalid-usd-name",
    WARNING,
    what="A name is not a valid USD identifier (checked with the target usd).",
    why="The names of USD prims have letters, digits and underscores, without a leading digit: "
    "converters to USD replace the rest, and a program that looks for the URDF name in the stage "
    "finds nothing.",
    fix="Use underscores in place of other characters.",
    bad='<link name="left/wheel"/>',
    good='<link name="left_wheel"/>',
    options={"targets": ("usd",)},
)
def no_usd_name(subject: Subject) -> Iterator[Problem]:
    """The message has the name that a converter makes, and whether it already exists."""
    if "usd" not in subject.settings.targets:
        return
    names = {name for _, name, _ in named(subject)}
    for kind, name, element in named(subject):
        if name.strip() and not TOKEN.fullmatch(name):
            made = re.sub(r"\W", "_", name, flags=re.ASCII)
            made = f"_{made}" if made[0].isdigit() else made
            taken = ", which already exists" if made in names else ""
            message = (
                f"{kind} {name!r} is not a valid USD identifier: it becomes {_encoded(name)} in Isaac "
                f"Sim 6, {made!r}{taken} in others"
            )
            yield Problem(element, message, "name", f"use {made!r}")


def _encoded(name: str) -> str:
    """The name as Isaac Sim 6 spells it: what a prim may have, then a code of all else.

    Source: what usd-exchange 3.0.1 makes of names (getValidPrimName); strands-labs/robots#1902.
    """
    plain = re.sub(r"\W", "", name, flags=re.ASCII)
    if plain == name:
        return repr(f"tn__{name}_")
    return f"'tn__{plain}_' and a code" if plain else "'tn__' and a code"


@rule(
    "MB321",
    "slash-for-mjcf",
    WARNING,
    what="The name of a link or joint contains a slash (checked with the target mjcf).",
    why="MuJoCo accepts it; dm_control's mjcf does not: it reserves '/' for the names of attached "
    "models, and raises ValueError when the model is loaded.",
    fix="Use an underscore.",
    bad='<link name="left/wheel"/>',
    good='<link name="left_wheel"/>',
    options={"targets": ("mjcf",)},
)
def slash_for_mjcf(subject: Subject) -> Iterator[Problem]:
    """Links become bodies, joints stay joints."""
    if "mjcf" not in subject.settings.targets:
        return
    for kind, name, element in named(subject):
        if "/" in name:
            hint = f"use {name.strip('/').replace('/', '_')!r}"
            yield Problem(element, f"{kind} {name!r} contains a slash", "name", hint)
