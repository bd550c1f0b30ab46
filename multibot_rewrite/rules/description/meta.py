# SPDX-License-Identifier: Apache-2.0
"""MB0: the lint itself: rules that crash, files that take too long, comments that suppress findings."""

from __future__ import annotations

from multibot_rewrite.base.findings.finding import ERROR, WARNING
from multibot_rewrite.base.findings.rule import declare

# Reported where rules are run: see ``failures``.
rule_crashed = declare(
    "MB001",
    "rule-crashed",
    ERROR,
    what="A rule crashed on this file, so it did not check all of it.",
    why="The problem that this rule looks for may be in the file and is not reported.",
    fix="Report it together with the file. To go on, use --ignore with the code in the message.",
    bad="",
    good="",
    formats=(),
)

# Reported after all rules have run: see ``config.comments``.
unused_suppression = declare(
    "MB002",
    "unused-suppression",
    WARNING,
    what="A `urdf-lint: ignore` comment names a code that it does not suppress. There is no "
    "finding with that code on its line, in the element below it, or (ignore-file) in the file.",
    why="The problem was fixed or has moved, and the comment would hide the next one of that kind.",
    fix="Delete the code or the comment (--fix does), or put the comment alone on the line above "
    "the element.",
    bad='<link name="a"/>\n<!-- urdf-lint: ignore MB501 - bolted on by the launch file -->\n',
    good='\n<!-- urdf-lint: ignore MB501 - bolted on by the launch file -->\n<link name="a"/>\n',
    line=2,
    fixed='<link name="a"/>\n',
    formats=(),
)

# Reported when comments are read: see ``config.directives``.
broken_suppression = declare(
    "MB003",
    "broken-suppression",
    ERROR,
    what="A `urdf-lint:` comment is not understood. It has an unknown word, no code or only a part"
    " of one, or a code that does not exist or cannot be suppressed. Or a reason has no dash "
    "before it, or an ignore-file is after the first element.",
    why="It suppresses nothing, or less than intended.",
    fix="Write `urdf-lint: ignore CODE, CODE - reason` or `urdf-lint: ignore-file CODE - reason`.",
    bad='<!-- urdf-lint: disable MB501 -->\n<link name="a"/>',
    good='<!-- urdf-lint: ignore MB501 -->\n<link name="a"/>',
    formats=(),
)

# Reported when the time is over: see ``failures``.
took_too_long = declare(
    "MB004",
    "took-too-long",
    ERROR,
    what="The file took longer than `seconds` allows (60 s by default), and urdf-lint stopped "
    "checking it.",
    why="The rest of the file was not checked. Every program that expands or loads the file may "
    "take as long.",
    fix="Look for a macro or an include that calls itself; allow more `seconds` for large files.",
    bad="",
    good="",
    formats=(),
)
