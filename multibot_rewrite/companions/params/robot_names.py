"""Files that were written for a certain robot: its namespace, its name or a placeholder for it."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence

import yaml

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.by_kind import is_plain
from multibot_rewrite.companions.params.name_sites import SectionNames
from multibot_rewrite.companions.params.sections import ANY, ParamSection
from multibot_rewrite.companions.params.values import is_filled
from multibot_rewrite.companions.yaml_text import YamlText, found_at
from multibot_rewrite.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.system.conventions import PLACEHOLDER

_IN_VALUE = re.compile(r"<[^>]*>|\$\([^)]*\)|\$?\{[^}]*\}")

ONE_ROBOT = declare(
    "MF104",
    "section-of-one-robot",
    ERROR,
    what="The name of a section has a namespace before a node of the stack or before a wildcard.",
    why="The build puts each robot's namespace before it, so /rover/amcl becomes /robot1/rover/amcl. "
    "No node has that name, and a node without a section runs with its defaults and does not say so.",
    fix="Write the node's name without a namespace.",
    bad="""\
/rover/**:
  ros__parameters:
    use_sim_time: true
""",
    good="""\
/**:
  ros__parameters:
    use_sim_time: true
""",
    formats=("params",),
)

NAMESPACE_KEPT = declare(
    "MF105",
    "section-with-namespace",
    WARNING,
    what="The name of a section has a namespace, which is placed below each robot's.",
    why="That is right for a namespace inside of a robot, such as front/driver. If it is the name of a "
    "robot, no node has the resulting name, and the parameters have no effect.",
    fix="If the namespace is the name of a robot, remove it.",
    bad="""\
rover/driver:
  ros__parameters:
    rate: 10
""",
    good="""\
driver:
  ros__parameters:
    rate: 10
""",
    formats=("params",),
)


def namespace_findings(
    document: YamlText, section: ParamSection, context: Context
) -> Iterator[Finding]:
    """A namespace in the section's name: that of one robot, or one below each robot's."""
    tokens = section.path.split("/")
    key = section.keys[0]
    if section.path in context.nodes or tokens[0] == "**" or section.full == section.path:
        return
    if section.path != "/".join(it.value.strip("/") for it in section.keys):
        return  # what is below the robot's own namespace is meant to be there
    tails = ["/".join(tokens[at:]) for at in range(1, len(tokens))]
    stack = next((tail for tail in tails if tail in context.nodes), "")
    if stack or (tokens[-1] in ANY and tokens[0] not in ANY):
        message = f"section {section.path} is for one robot only: its name includes a namespace"
        hint = f"write {stack or '/**'}: instead; the build adds each robot's namespace"
        yield found_at(document, key, ONE_ROBOT, message, hint)
    elif tails and not section.wild and not tokens[-1].startswith(tokens[0]):
        message = (
            f"section {section.path} has a namespace; it is placed below each robot's namespace"
        )
        hint = f"if {tokens[0]} is the name of a robot, write {tails[0]}: instead"
        yield found_at(document, key, NAMESPACE_KEPT, message, hint)


PLACEHOLDER_KEPT = declare(
    "MF110",
    "placeholder-kept",
    WARNING,
    what="A section or a name holds a placeholder, such as $(var area) or <area>, that does not stand "
    "for the robot, and stays as it is.",
    why="Only a launch file can replace it. Until it does, no node has the section, and the name is "
    "the placeholder itself; what it is replaced by does not get the robot's name from the build.",
    fix="If it stands for the robot, call it so: <robot_namespace>, <robot_name>, $(var namespace) and "
    "the like are filled in. Otherwise let the launch file replace it (ParameterFile, allow_substs).",
    bad="""\
amcl:
  ros__parameters:
    scan_topic: <area>/scan
""",
    good="""\
amcl:
  ros__parameters:
    scan_topic: /scan
""",
    line=3,
    formats=("params",),
)


def placeholders_in_key(document: YamlText, section: ParamSection) -> Iterator[Finding]:
    """Placeholders in the name of a section."""
    for key in section.keys:
        if PLACEHOLDER.search(section.path) and PLACEHOLDER.search(key.value):
            message = f"section {section.path} holds a placeholder and stays as it is"
            hint = "write only the node's name; the build adds each robot's namespace"
            yield found_at(document, key, PLACEHOLDER_KEPT, message, hint)


def placeholders_in_names(document: YamlText, names: SectionNames) -> Iterator[Finding]:
    """Placeholders in the names of a section."""
    for site in names.sites:
        if is_filled(site):
            continue
        if not is_plain(site.value) and (found := _IN_VALUE.search(site.value)):
            message = f"the placeholder {found[0]} stays; a launch file must replace it"
            hint = "if it stands for the robot's name, write the value without it"
            yield found_at(document, site.scalar, PLACEHOLDER_KEPT, message, hint)


ROBOT_IN_NAME = declare(
    "MF126",
    "robot-in-parameter",
    ERROR,
    what="A name holds the name of a robot of the fleet, so the file is for that robot only.",
    why="Every robot gets the file: all others would use the names of this robot, and in its own file "
    "the name would be there twice.",
    fix="Remove the robot's name from every name; the build adds it for each robot.",
    bad="""\
amcl:
  ros__parameters:
    scan_topic: /robot2/scan
""",
    good="""\
amcl:
  ros__parameters:
    scan_topic: /scan
""",
    line=3,
    formats=("params",),
)


def robot_in_name(
    document: YamlText,
    sections: Iterable[ParamSection],
    pages: Sequence[SectionNames],
    robots: frozenset[str],
    own: Collection[str] = (),
) -> Iterator[Finding]:
    """The first name that holds one of ``robots``; a first key may hold one of ``own``."""
    scalars = [it for section in sections for it in _keys(section, own)]
    scalars += [(it.scalar, it.value) for names in pages for it in names.sites if it.kind != "keep"]
    for scalar, value in scalars:
        found = robots.intersection(value.strip("/").split("/"))
        for robot in sorted(found):
            message = f"{value} includes the robot name {robot}, so the file is for that robot only"
            hint = "remove the robot name from every name; the build adds it for each robot"
            yield found_at(document, scalar, ROBOT_IN_NAME, message, hint)
            return


def _keys(section: ParamSection, own: Collection[str]) -> Iterator[tuple[yaml.ScalarNode, str]]:
    """The keys above a section, without what its path has not: the robot that the file is for."""
    first, *rest = section.keys
    bare = first.value.strip("/")
    below = (
        bare.removeprefix(word).strip("/") for word in own if f"{bare}/".startswith(f"{word}/")
    )
    yield first, next(below, bare)
    yield from ((key, key.value) for key in rest)
