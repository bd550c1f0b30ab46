# SPDX-License-Identifier: Apache-2.0
"""A robot's parameter file in the form that nav2_bringup takes: its sections have no namespace.

The launch files there put a file below the robot's namespace (RewrittenYaml with ``root_key``), so a
namespace of its own would be there twice, and rcl refuses ``/robot1//robot1/``. slam_toolbox is the one
node that gets the file as it is, and only if the file has a key of that name (HasNodeParams).
Sources: nav2_bringup launch/slam_launch.py, nav2_common rewritten_yaml.py and has_node_params.py, all
releases from humble (1.1.20) to rolling (a3a97043e).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.findings.finding import ERROR, Finding, declare
from multibot_rewrite.companions.params.rcl_parameters import parameters_text
from multibot_rewrite.companions.params.sections import RawSection, raw_sections
from multibot_rewrite.companions.params.shared_defaults import DefaultLine, inserted
from multibot_rewrite.companions.yaml_text import (
    Splice,
    YamlText,
    found_at,
    pairs,
    quoted,
    replaced,
    spliced,
)

_SLAM = "slam_toolbox"
_WHY = "# nav2_bringup wants this key, and gives slam_toolbox the file without a namespace.\n"
_MAP_NAME = DefaultLine(
    "# /map by default, and nothing would move /map_metadata", "map_name", "map"
)

OUTSIDE = declare(
    "MF132",
    "section-outside-of-bringup",
    ERROR,
    formats=("params",),
    options={"stack": ["nav2", "rviz"], "params_style": "bringup", "layout": "both"},
)


Values = Mapping[str, Mapping[str, object]]
NO_MORE: Values = {}


def for_bringup(
    document: YamlText, namespace: str, more: Values = NO_MORE
) -> tuple[str, tuple[Finding, ...]]:
    """Return the text of a file made for the robot in ``namespace``, without that namespace.

    ``more`` are further values of nodes that have a section in it: there is one file for all that is
    started. Raises InputError for a file that rcl rejects.
    """
    sections = {id(it.keys[0]): it for it in raw_sections(document)}
    made = [it for section in sections.values() for it in _changed(document, section, namespace)]
    splices = [it for it in made if isinstance(it, Splice)]
    findings = tuple(it for it in made if isinstance(it, Finding))
    named = {below_namespace(it.path, namespace) for it in sections.values()}
    added = {f"**/{node}": values for node, values in more.items() if node in named}
    # The keys of these sections are others than those of the file.
    behind = f"\n{parameters_text(added)[1:-1]}\n" if added else ""
    return spliced(document, splices) + behind, findings


def _changed(document: YamlText, section: RawSection, namespace: str) -> Iterator[Splice | Finding]:
    """Yield the new key of a section, with more values if it is the first below that key."""
    key = section.keys[0]
    below = below_namespace(key.value, namespace)
    if PLACEHOLDER.search(key.value):
        return
    if below is None:
        message = f"section {key.value} is for a node that is not in the namespace /{namespace}"
        hint = "nav2_bringup puts all sections there; put this one into a file of its own"
        yield found_at(document, key, OUTSIDE, message, hint)
    elif below == _SLAM:
        at, column = key.start_mark.index, key.start_mark.column
        new = f"{_WHY}{' ' * column}{_SLAM}: {{}}\n{' ' * column}{quoted(f'**/{_SLAM}')}"
        yield Splice(at, key.end_mark.index, new)
        if _MAP_NAME.path not in {it.value for it, _ in pairs(section.body)}:
            yield inserted(document, section.body, [_MAP_NAME])
    else:
        yield replaced(key, below)


def below_namespace(key: str, namespace: str) -> str | None:
    """Return the rest of a section's name below a namespace; None if no node there has it.

    below_namespace("/robot1/amcl", "robot1") == "amcl"
    below_namespace("/**", "robot1") == "**"
    """
    tokens = key.strip("/").split("/")
    for word in namespace.split("/"):
        if tokens and tokens[0] == "**":
            break
        if not tokens or tokens[0] not in (word, "*"):
            return None
        tokens.pop(0)
    return "/".join(tokens) or "**"
