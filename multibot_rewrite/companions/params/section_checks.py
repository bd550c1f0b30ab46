"""Sections and parameters that are repeated, overridden, shared, wrongly named or without a value."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from multibot_rewrite.companions.params.name_sites import SectionNames
from multibot_rewrite.companions.params.sections import ANY, ParamSection, flattened, pattern_of
from multibot_rewrite.companions.yaml_text import YamlText, found_at, line_of
from multibot_rewrite.findings.finding import WARNING, Finding
from multibot_rewrite.findings.rule import declare
from multibot_rewrite.rosnames import check_node_name
from multibot_rewrite.system.conventions import PLACEHOLDER

SHARED_NODE = declare(
    "MF103",
    "section-of-shared-node",
    WARNING,
    what="A section is for a node that serves all robots, so it stays as it is.",
    why="The file of every robot has this section. If the node is started with each of them, several "
    "nodes of one name publish the same topics.",
    fix="Start the node once, with one of the files, or move its section to a file of its own.",
    bad="""\
map_server:
  ros__parameters:
    yaml_filename: hall.yaml
""",
    good="""\
amcl:
  ros__parameters:
    alpha1: 0.1
""",
    formats=("params",),
    beside={"nodes.yaml": "stacks: {own: {nodes: [amcl, {node: map_server, shared: true}]}}"},
    options={"stack": "own", "nodes": "nodes.yaml"},
)


def shared_findings(document: YamlText, sections: Sequence[ParamSection]) -> Iterator[Finding]:
    """Each node that serves all robots, at its first section."""
    first = {it.path: it for it in reversed(sections) if it.shared}
    for path, section in first.items():
        message = f"{path} serves all robots, so its section stays as it is"
        hint = "start it once, with this file"
        yield found_at(document, section.keys[-1], SHARED_NODE, message, hint)


REPEATED_SECTION = declare(
    "MF102",
    "repeated-section",
    WARNING,
    what="A file has two sections for one node.",
    why="rcl merges the two. PyYAML keeps only the last, and with it every launch file that reads "
    "parameters in Python (RewrittenYaml of Nav2, composable nodes): parameters vanish without a "
    "message.",
    fix="Merge the two into one section.",
    bad="""\
amcl:
  ros__parameters:
    alpha1: 0.1
amcl:
  ros__parameters:
    alpha2: 0.1
""",
    good="""\
amcl:
  ros__parameters:
    alpha1: 0.1
    alpha2: 0.1
""",
    line=4,
    formats=("params",),
)


def repeated_sections(document: YamlText, sections: Sequence[ParamSection]) -> Iterator[Finding]:
    """Every section of a node but its first."""
    first: dict[str, ParamSection] = {}
    for section in sections:
        earlier = first.setdefault(section.path, section)
        if earlier is not section:
            line = line_of(earlier.keys[-1])
            message = f"section {section.path} is repeated; the first is in line {line}"
            hint = "rcl merges the two, PyYAML keeps only the last; merge them into one"
            yield found_at(document, section.keys[-1], REPEATED_SECTION, message, hint)


SECTION_NAME = declare(
    "MF106",
    "section-name-invalid",
    WARNING,
    what="The name of a section is not a valid node name.",
    why="Node names have only letters, digits and underscores and do not start with a digit; * and ** "
    "stand for whole names. rcl rejects the file, or no node has this name: it runs with its defaults.",
    fix="Write the name that the node runs under.",
    bad="""\
base-controller:
  ros__parameters:
    publish_rate: 50.0
""",
    good="""\
base_controller:
  ros__parameters:
    publish_rate: 50.0
""",
    formats=("params",),
)


def invalid_names(document: YamlText, section: ParamSection) -> Iterator[Finding]:
    """Keys of a section that are no node names, those with a placeholder left out."""
    for at, key in enumerate(section.keys):
        if PLACEHOLDER.search(key.value):
            continue
        if not at and key.value == "/" and len(section.keys) > 1:
            continue  # the root namespace
        names = (it for it in key.value.strip("/").split("/") if it not in ANY)
        faults = ((it, check_node_name(it)) for it in names)
        bad = next((f"{it!r}: {fault.reason}" for it, fault in faults if fault), "")
        if at and key.value.startswith("/"):
            bad = f"{key.value!r}: the slash it starts with makes two slashes in a row"
        if bad:
            hint = "rcl rejects the file, or no node matches this section; fix the name"
            message = f"not a valid node name: {bad}"
            yield found_at(document, key, SECTION_NAME, message, hint)


OVERRIDDEN = declare(
    "MF107",
    "wildcard-overrides-section",
    WARNING,
    what="A wildcard section sets a parameter that an earlier section of one node sets too.",
    why="rcl applies all sections that match a node in the order of the file, and the last one wins. "
    "The value that was meant for the node has no effect.",
    fix="Put wildcard sections first.",
    bad="""\
amcl:
  ros__parameters:
    alpha1: 0.1
/**:
  ros__parameters:
    alpha1: 0.2
""",
    good="""\
/**:
  ros__parameters:
    alpha1: 0.2
amcl:
  ros__parameters:
    alpha1: 0.1
""",
    line=6,
    formats=("params",),
)


def overridden(document: YamlText, sections: Sequence[ParamSection]) -> Iterator[Finding]:
    """What a wildcard section sets after the section of a node that it matches."""
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
                yield found_at(
                    document, here[name], OVERRIDDEN, message, "put wildcard sections first"
                )


REPEATED_KEY = declare(
    "MF108",
    "repeated-parameter",
    WARNING,
    what="A section sets a parameter twice.",
    why="The later value counts, and no message says so: a change of the first one has no effect.",
    fix="Remove one of them.",
    bad="""\
amcl:
  ros__parameters:
    alpha1: 0.1
    alpha1: 0.2
""",
    good="""\
amcl:
  ros__parameters:
    alpha1: 0.2
""",
    line=4,
    formats=("params",),
)


NO_VALUE = declare(
    "MF109",
    "parameter-without-value",
    WARNING,
    what="A parameter has no value.",
    why="rcl rejects the whole file (No value), so every node that is started with it fails.",
    fix='Write a value; "" is an empty text.',
    bad="""\
amcl:
  ros__parameters:
    map_topic:
""",
    good="""\
amcl:
  ros__parameters:
    map_topic: map
""",
    line=3,
    formats=("params",),
)


def key_findings(document: YamlText, names: SectionNames) -> Iterator[Finding]:
    """Repeated keys and missing values of a section."""
    for key in names.twice:
        message = f"{key.value!r} is set twice in one section; the later value counts"
        yield found_at(document, key, REPEATED_KEY, message, "remove one of them")
    for key in names.empty:
        message = f"{key.value!r} has no value"
        hint = 'rcl rejects the whole file; write a value, or ""'
        yield found_at(document, key, NO_VALUE, message, hint)


def section_findings(document: YamlText, sections: Sequence[ParamSection]) -> Iterator[Finding]:
    """What is wrong with the sections of a file."""
    yield from repeated_sections(document, sections)
    yield from shared_findings(document, sections)
    for section in sections:
        yield from invalid_names(document, section)
    yield from overridden(document, sections)
