# SPDX-License-Identifier: Apache-2.0
"""Controllers that a file declares and has no section for -> sections with what must differ by robot.

A controller without a section runs with its defaults, such as an empty prefix before names of joints,
where the description of each robot has another prefix.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

import yaml

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.naming import spelled
from multibot_rewrite.companions.context import Context, full_name
from multibot_rewrite.companions.params.sections import (
    ANY,
    MANAGER,
    PARAMETERS,
    RawSection,
    controller_types,
    flattened,
    identify_node,
    pattern_of,
)
from multibot_rewrite.companions.params.shared_defaults import (
    DefaultLine,
    missing_defaults,
)
from multibot_rewrite.companions.params.values import ParamsJob
from multibot_rewrite.companions.template import NAMESPACE_SLOT
from multibot_rewrite.companions.yaml_blocks import inserted, newline
from multibot_rewrite.companions.yaml_text import Splice, YamlText


def controller_sections(
    job: ParamsJob, found: Sequence[RawSection], beside: Iterable[RawSection]
) -> Iterator[Splice]:
    """The sections of a file's controllers, behind its end; ``found`` are the sections it has,
    ``beside`` those of the robot's other files."""
    every = [*found, *beside]
    made = [
        line
        for path, lines in _lacking(job, found, every)
        for line in _section(_key(path, job.context), lines)
    ]
    if made and takes_sections(job.document):
        end, at = newline(job.document), len(job.document.text)
        yield inserted(job.document, at, "".join(f"{it}{end}" for it in made))


def takes_sections(document: YamlText) -> bool:
    """Can a section stand behind its last line?"""
    root = document.root
    plain = isinstance(root, yaml.MappingNode) and not root.flow_style
    ends = re.search(r"^(?:\.\.\.|---)", document.text[1:], re.MULTILINE)
    return plain and root is not None and root.start_mark.column == 0 and not ends


def _lacking(
    job: ParamsJob, found: Sequence[RawSection], every: Sequence[RawSection]
) -> Iterator[tuple[str, list[DefaultLine]]]:
    """The paths of controllers that no section is for, and what they need."""
    named = {it.path.rpartition("/")[2] for it in every}
    for manager in (it for it in found if it.path.rpartition("/")[2] == MANAGER):
        types = controller_types([manager])
        for name in (it for it in types if it not in named):
            node = identify_node(name, None, job.known, types)
            path = f"{manager.path.removesuffix(MANAGER)}{name}"
            lines = list(missing_defaults(job.context, node, _set(path, every))) if node else []
            if lines:
                yield path, lines


def _set(path: str, every: Iterable[RawSection]) -> set[str]:
    """What sections of many nodes set for it, too."""
    whole = f"/{path.strip('/')}"
    fitting = (it for it in every if re.fullmatch(pattern_of(it.path), whole))
    return {name for it in fitting for name, _ in flattened(it.body)}


def _key(path: str, context: Context) -> str:
    *above, name = path.strip("/").split("/")
    if any(it in ANY or PLACEHOLDER.search(it) for it in above):
        return f"/**/{spelled(context.topics.naming, NAMESPACE_SLOT, 'node', name)}"
    return full_name("/".join((*above, name)), context.topics.naming)


def _section(key: str, lines: Sequence[DefaultLine]) -> Iterator[str]:
    yield from dict.fromkeys(it.comment for it in lines)
    yield f"{key}:"
    yield f"  {PARAMETERS}:"
    yield from (f"    {it.path}: {it.value}" for it in lines)
