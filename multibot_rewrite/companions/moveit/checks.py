"""Names of a MoveIt file that a rewrite cannot spell for several robots."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import Rule, declare
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.moveit.controller_manager import unreachable_managers
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.by_kind import expressible
from multibot_rewrite.companions.params import name_checks
from multibot_rewrite.companions.sites import Site, found_in
from multibot_rewrite.companions.yaml_text import YamlText

# The rule, the message and the hint.
_Problem = tuple[Rule, str, str]


def file_findings(document: YamlText, file: NamedFile) -> tuple[Finding, ...]:
    """The findings about the rewrite of a file, each once, in the order of the lines."""
    found = [*unreachable_managers(document, file), *_name_findings(file)]
    return tuple(sorted(dict.fromkeys(found), key=lambda it: (it.line, it.column)))


def _name_findings(file: NamedFile) -> Iterator[Finding]:
    """What is wrong with each name, at its first place."""
    first: dict[tuple[str, str], Site] = {}
    for site in file.names:
        first.setdefault((site.kind, site.text), site)
    for (kind, text), site in first.items():
        problems = (check(file.context, kind, text) for check in _CHECKS)
        if problem := next(filter(None, problems), None):
            yield found_in(file.file, site.slot, *problem)


GROUPS_WITHOUT_SRDF = declare(
    "MF305",
    "moveit-groups-without-srdf",
    WARNING,
    what="The fleet renames planning groups (groups: rename), but no SRDF is given.",
    why="Only the SRDF says which names are groups, so the groups in this file stay unchanged. "
    "move_group gets an SRDF with other groups from elsewhere and finds no solver or planner for "
    "them.",
    fix="Name the SRDF under srdf: in the fleet file.",
    bad="""\
groups: rename
companions: {moveit: kinematics.yaml}
""",
    good="""\
groups: rename
srdf: robot.srdf
companions: {moveit: kinematics.yaml}
""",
    formats=("fleet",),
    beside={
        "kinematics.yaml": "arm: {kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin}\n",
        "robot.srdf": '<robot name="rover"><group name="arm"><link name="wheel"/></group></robot>',
    },
)


def _no_srdf(context: Context, word: str, text: str) -> _Problem | None:
    renamed = word == "group" and "group" in context.names.naming.separators
    if not renamed or context.names.declared.get("group"):
        return None
    message = f"groups are renamed, but no SRDF is given, so {text!r} stays unchanged"
    return GROUPS_WITHOUT_SRDF, message, "name the SRDF under srdf:"


def _prefix_only(context: Context, word: str, text: str) -> _Problem | None:
    if expressible(context, word):
        return None
    return name_checks.PREFIX_ONLY, *name_checks.prefix_only_message(word)


# Only the first problem of a name is reported.
_CHECKS = (_no_srdf, _prefix_only)
