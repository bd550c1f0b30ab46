"""Keys that are repeated, overridden or without a value."""

from __future__ import annotations

import re
from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.companions.kinds import MOVEIT, PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.params.sections import ParamSection, flattened, pattern_of
from multibot_rewrite.companions.yaml_text import line_of
from multibot_rewrite.rules.files.examples import a_section
from multibot_rewrite.rules.files.records import Remark, remark, remark_at

_ONE = "amcl:\n  ros__parameters:\n    alpha1: 0.1\n"


@rule(
    "MB859",
    "repeated-key",
    WARNING,
    what="A parameter, or a key of a file of MoveIt, is set twice in one map.",
    why="The later value counts, and no message says so: a change of the first one has no effect.",
    fix="Remove one of them.",
    bad=a_section("amcl", "alpha1: 0.1\n    alpha1: 0.2"),
    good=a_section("amcl", "alpha1: 0.2"),
    line=4,
    formats=(PARAMS, MOVEIT),
)
def repeated_key(file: NamedFile) -> Iterator[Remark]:
    """Every key that is there before in the same map."""
    for site in file.twice:
        message = f"{site.text!r} is set twice; the later value counts"
        yield remark(site, message, "remove one of them")


@rule(
    "MB866",
    "repeated-section",
    WARNING,
    what="A file has two sections for one node.",
    why="rcl merges the two. PyYAML keeps only the last, and with it every launch file that reads "
    "parameters in Python (RewrittenYaml of Nav2, composable nodes): parameters vanish without a "
    "message.",
    fix="Merge the two into one section.",
    bad=f"{_ONE}amcl:\n  ros__parameters:\n    alpha2: 0.1\n",
    good=f"{_ONE}    alpha2: 0.1\n",
    line=4,
    formats=(PARAMS,),
)
def repeated_section(file: NamedFile) -> Iterator[Remark]:
    """Every section of a node but its first."""
    first: dict[str, ParamSection] = {}
    for section, _ in file.pages:
        earlier = first.setdefault(section.path, section)
        if earlier is not section:
            line = line_of(earlier.keys[-1])
            message = f"section {section.path} is repeated; the first is in line {line}"
            hint = "rcl merges the two, PyYAML keeps only the last; merge them into one"
            yield remark_at(section.keys[-1], message, hint)


@rule(
    "MB867",
    "wildcard-overrides-section",
    WARNING,
    what="A wildcard section sets a parameter that an earlier section of one node sets too.",
    why="rcl applies all sections that match a node in the order of the file, and the last one wins. "
    "The value that was meant for the node has no effect.",
    fix="Put wildcard sections first.",
    bad=f"{_ONE}/**:\n  ros__parameters:\n    alpha1: 0.2\n",
    good=f"/**:\n  ros__parameters:\n    alpha1: 0.2\n{_ONE}",
    line=6,
    formats=(PARAMS,),
)
def overridden(file: NamedFile) -> Iterator[Remark]:
    """What a wildcard section sets after the section of a node that it matches."""
    sections = [section for section, _ in file.pages]
    for at, section in enumerate(sections):
        if not section.wild or not any(not it.wild for it in sections[:at]):
            continue
        matches = re.compile(pattern_of(section.full)).fullmatch
        here = dict(flattened(section.body))
        for earlier in sections[:at]:
            if earlier.wild or not matches(earlier.full):
                continue
            for name in here.keys() & dict(flattened(earlier.body)).keys():
                message = (
                    f"{name} of {earlier.path} is overridden by the later section {section.path}"
                )
                yield remark_at(here[name], message, "put wildcard sections first")


@rule(
    "MB868",
    "parameter-without-value",
    WARNING,
    what="A parameter has no value.",
    why="rcl rejects the whole file (No value), so every node that is started with it fails.",
    fix='Write a value; "" is an empty text.',
    bad=a_section("amcl", "map_topic:"),
    good=a_section("amcl", "map_topic: map"),
    line=3,
    formats=(PARAMS,),
)
def no_value(file: NamedFile) -> Iterator[Remark]:
    """Keys of parameters without a value."""
    for _, names in file.pages:
        for key in names.empty:
            message = f"{key.value!r} has no value"
            yield remark_at(key, message, 'rcl rejects the whole file; write a value, or ""')
