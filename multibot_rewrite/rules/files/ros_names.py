# SPDX-License-Identifier: Apache-2.0
"""Names that ROS refuses, placeholders in names, and frames that tf2 refuses or takes for others."""

from __future__ import annotations

import re
from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.lazy import IN_SUBSTITUTION
from multibot_rewrite.base.rosnames import check_name_in_code, check_node_name
from multibot_rewrite.companions.engine import GRAPH
from multibot_rewrite.companions.kinds import EVERY, MOVEIT, PARAMS
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.by_kind import SPELLERS, is_filled, is_plain
from multibot_rewrite.companions.names.placeholders import is_robot
from multibot_rewrite.companions.sites import SECTION, Site
from multibot_rewrite.rules.places import remark

_IN_VALUE = re.compile(rf"<[^<>]*>|\$\({IN_SUBSTITUTION}\)|\$?\{{[^{{}}]*\}}|%\w+")
# Stand for whole names of nodes.
_ANY = ("*", "**")
# What RViz calls the frame that everything is shown in.
_FIXED = "<Fixed Frame>"


def invalid_names(file: NamedFile) -> Iterator[Finding]:
    """Names in the graph, and those of sections."""
    for site in file.names:
        fault = _section_fault(site) if site.kind == SECTION else _fault(site)
        if fault:
            what = "node" if site.kind == SECTION else site.kind
            message = f"{what} {site.text!r} is not a valid ROS name: {fault}"
            yield remark(site, message, "it stays as it is; correct it")


def _fault(site: Site) -> str:
    if site.kind not in GRAPH or not site.text or not is_filled(site.text):
        return ""
    found = check_name_in_code(site.text)
    return found.reason if found else ""


def _section_fault(site: Site) -> str:
    """What is wrong with the key of a section, which may be a pattern; ``in_key`` where there is a key
    above it."""
    if _IN_VALUE.search(site.text) or "<" in site.text or "$" in site.text or "{" in site.text:
        return ""
    if site.in_key and site.text.startswith("/"):
        return "the slash it starts with makes two slashes in a row"
    names = (it for it in site.text.strip("/").split("/") if it not in _ANY)
    faults = ((it, check_node_name(it)) for it in names)
    return next((f"{it!r}: {fault.reason}" for it, fault in faults if fault), "")


@rule("MB876", "name-in-text-block", WARNING, formats=(PARAMS, MOVEIT))
def text_block(file: NamedFile) -> Iterator[Finding]:
    """Each name in a block."""
    for site in file.names:
        if site.slot.is_block and site.kind in (*GRAPH, *SPELLERS):
            name = site.text.strip()
            message = f"the name {name!r} is in a block of text, so it is not rewritten"
            level = "" if file.is_certain or site.text != name else NOTE
            yield remark(site, message, f"write it on one line: {name}", level)


def placeholders(file: NamedFile) -> Iterator[Finding]:
    """The first placeholder of each name."""
    level = "" if file.is_certain else NOTE
    for site in file.names:
        found = _placeholder(site)
        if found:
            message = f"the placeholder {found} stays; a launch file must replace it"
            hint = "if it stands for the robot's name, write the value without it"
            yield remark(site, message, hint, level)


def _placeholder(site: Site) -> str:
    if is_plain(site.text) or is_robot(site.text) or site.text == _FIXED:
        return ""
    found = _IN_VALUE.search(site.text)
    return found[0] if found else ""


def slashes(file: NamedFile) -> Iterator[Finding]:
    """Values that are known to be frames."""
    for site in _frames(file):
        if site.text.startswith("/") and is_plain(site.text) and not _is_spaced(site.text):
            name, level = f"frame {site.text!r}", NOTE if site.bare else ""
            message = f"{name} starts with a slash, which tf2 refuses"
            if site.bare:
                message = f"{name} is written without its slash, which the node takes off"
            yield remark(site, message, f"write {site.text.lstrip('/')}", level)


@rule("MB865", "frame-with-white-space", WARNING, formats=EVERY)
def frame_with_white_space(file: NamedFile) -> Iterator[Finding]:
    """Values that are known to be frames."""
    for site in _frames(file):
        if _is_spaced(site.text) and is_filled(site.text):
            message = (
                f"frame {site.text!r} has white space in it: it is another one, and not rewritten"
            )
            yield remark(site, message, f"write {'_'.join(site.text.split())}")


def _frames(file: NamedFile) -> Iterator[Site]:
    # A block of text has a line break at its end, which is told where it is rewritten.
    free = (it for it in file.names if not it.in_key and not it.text.endswith("\n"))
    yield from (it for it in free if it.kind == "frame" and it.is_sure and it.text)


def _is_spaced(text: str) -> bool:
    return text.split() != [text]
