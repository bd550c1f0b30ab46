# SPDX-License-Identifier: Apache-2.0
"""What the lint finds in a description that robots run with -> what of it stops them.

That is every error, and what Gazebo leaves out of a robot that runs in it. Where the description is
only sent, nothing counts that only a simulator reads. The build and check-launch ask it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, Rule, locate
from multibot_rewrite.description.steps.document import Document
from multibot_rewrite.rules.settings import LEFT_OUT

# What has no effect in this simulator and this ROS, a joint that is not found there, and two senders.
_NO_EFFECT = ("MB163", "MB211", "MB243")
# Names, inertias and systems that only a simulator refuses.
_OF_SIMULATOR = ("MB160", "MB305", "MB306", "MB606", "MB624")
# A robot without a shape runs, and whether its file is there depends on the machine.
_SHAPES = ("MB701", "MB703")


def may_stop(rule: Rule) -> bool:
    """Return whether a finding of the rule can be one of these."""
    return rule.level == ERROR or rule.code in (*LEFT_OUT, *_NO_EFFECT)


def in_use(found: Iterable[Finding], document: Document, simulated: bool) -> Iterator[Finding]:
    """Yield the findings that count for a robot with this document, with their level there."""
    for it in found:
        level = _in_simulator(it) if simulated else _only_sent(it, document)
        if level:
            yield it._replace(level=level)


def is_of_simulator(it: Finding, document: Document) -> bool:
    """Return whether a finding is no error if the description is only sent."""
    return _only_sent(it, document) != ERROR


def _in_simulator(it: Finding) -> str:
    if it.level == ERROR:
        return WARNING if it.code in _SHAPES else ERROR
    return WARNING if it.level == WARNING and it.code in (*LEFT_OUT, *_NO_EFFECT) else ""


def _only_sent(it: Finding, document: Document) -> str:
    if it.level != ERROR or it.code in LEFT_OUT or _is_below_gazebo(it, document):
        return ""
    return WARNING if it.code in (*_SHAPES, *_OF_SIMULATOR) else ERROR


def _is_below_gazebo(it: Finding, document: Document) -> bool:
    starts = zip(document.elements, document.starts, strict=True)
    tops = ((top, at) for top, at in starts if top.getparent() is document.root)
    before = [top for top, at in tops if locate(document.source, at)[0] <= it.line]
    return bool(before) and before[-1].tag == "gazebo"
