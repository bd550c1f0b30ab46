"""What is wrong with the sections of a parameter file: repeated, shared, misnamed, without effect."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.params.sections import (
    ANY,
    PLACEHOLDER,
    ParamSection,
    flattened,
    pattern_of,
)
from multibot_rewrite.companions.yaml_text import YamlText, finding_at, line_of
from multibot_rewrite.model import ERROR, WARNING, Finding
from multibot_rewrite.rosnames import check_node_name


def section_findings(
    document: YamlText, sections: Sequence[ParamSection], context: Context
) -> Iterator[Finding]:
    """What is wrong with sections: repeated, shared, for one robot, without effect."""
    shared = set()
    first: dict[str, ParamSection] = {}
    for section in sections:
        key = section.keys[-1]
        earlier = first.setdefault(section.path, section)
        if earlier is not section:
            first_line = line_of(earlier.keys[-1])
            message = f"section {section.path} is repeated; the first is in line {first_line}"
            hint = "rcl merges the two, PyYAML keeps only the last; merge them into one"
            yield finding_at(document, key, "MF102", WARNING, message, hint)
        if section.shared and section.path not in shared:
            shared.add(section.path)
            message = f"{section.path} serves all robots, so its section stays as it is"
            yield finding_at(
                document, key, "MF103", WARNING, message, "start it once, with this file"
            )
        else:
            yield from _about_namespace(document, section, context)
        yield from _about_name(document, section)
    yield from _shadowed(document, sections)


def _about_namespace(
    document: YamlText, section: ParamSection, context: Context
) -> Iterator[Finding]:
    """A namespace in the section's name: that of one robot, or one below each robot's."""
    tokens = section.path.split("/")
    key = section.keys[0]
    if section.path in context.nodes or tokens[0] == "**" or section.full == section.path:
        return
    tails = ["/".join(tokens[at:]) for at in range(1, len(tokens))]
    stack = next((tail for tail in tails if tail in context.nodes), "")
    if stack or (tokens[-1] in ANY and tokens[0] not in ANY):
        message = f"section {section.path} is for one robot only: its name includes a namespace"
        hint = f"write {stack or '/**'}: instead; the build adds each robot's namespace"
        yield finding_at(document, key, "MF104", ERROR, message, hint)
    elif tails and not section.wild and not tokens[-1].startswith(tokens[0]):
        message = (
            f"section {section.path} has a namespace; it is placed below each robot's namespace"
        )
        hint = f"if {tokens[0]} is the name of a robot, write {tails[0]}: instead"
        yield finding_at(document, key, "MF105", WARNING, message, hint)


def _about_name(document: YamlText, section: ParamSection) -> Iterator[Finding]:
    for at, key in enumerate(section.keys):
        if PLACEHOLDER.search(key.value):
            message = f"section {section.path} holds a placeholder and stays as it is"
            hint = "write only the node's name; the build adds each robot's namespace"
            yield finding_at(document, key, "MF110", WARNING, message, hint)
            continue
        names = (it for it in key.value.strip("/").split("/") if it not in ANY)
        faults = ((it, check_node_name(it)) for it in names)
        bad = next((f"{it!r}: {fault.reason}" for it, fault in faults if fault), "")
        if at and key.value.startswith("/"):
            bad = f"{key.value!r}: the slash it starts with makes two slashes in a row"
        if bad:
            hint = "rcl rejects the file, or no node matches this section; fix the name"
            message = f"not a valid node name: {bad}"
            yield finding_at(document, key, "MF106", WARNING, message, hint)


def _shadowed(document: YamlText, sections: Sequence[ParamSection]) -> Iterator[Finding]:
    """A later wildcard section overrides what an exact section sets (rcl merges in order)."""
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
                hint = "put wildcard sections first"
                yield finding_at(document, here[name], "MF107", WARNING, message, hint)
