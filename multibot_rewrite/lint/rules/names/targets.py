"""Names that other formats cannot take, where they are asked for (USD, MJCF)."""

from __future__ import annotations

import re
from collections.abc import Iterator

from multibot_rewrite.findings.finding import WARNING
from multibot_rewrite.findings.rule import rule
from multibot_rewrite.lint.records import Problem, Subject
from multibot_rewrite.lint.rules.names.shared import TOKEN, named


@rule(
    "MB320",
    "no-usd-name",
    WARNING,
    what="A name is no USD identifier (asked with the target usd).",
    why="A prim is called by letters, digits and underscores, no digit in front: converters to USD "
    "replace the rest, and what looks for the URDF's name in the stage finds nothing.",
    fix="Write underscores for what is not a letter or digit.",
    bad='<link name="left/wheel"/>',
    good='<link name="left_wheel"/>',
    options={"targets": ("usd",)},
)
def no_usd_name(subject: Subject) -> Iterator[Problem]:
    """The message says what a converter makes of it, and whether that name exists."""
    if "usd" not in subject.settings.targets:
        return
    names = {name for _, name, _ in named(subject)}
    for kind, name, element in named(subject):
        if name.strip() and not TOKEN.fullmatch(name):
            made = re.sub(r"\W", "_", name, flags=re.ASCII)
            made = f"_{made}" if made[0].isdigit() else made
            taken = ", which is there already" if made in names else ""
            message = f"{kind} {name!r} is no USD identifier: it becomes {made!r}{taken}"
            yield Problem(element, message, "name", f"write {made!r}")


@rule(
    "MB321",
    "slash-for-mjcf",
    WARNING,
    what="The name of a link or joint holds a slash (asked with the target mjcf).",
    why="MuJoCo takes it; dm_control's mjcf does not: it keeps '/' for the names of attached models, "
    "and raises ValueError when the model is loaded.",
    fix="Write an underscore.",
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
            hint = f"write {name.strip('/').replace('/', '_')!r}"
            yield Problem(element, f"{kind} {name!r} holds a slash", "name", hint)
