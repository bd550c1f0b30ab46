"""MB0: the lint itself: rules that crash, files that take too long, comments that keep it silent."""

from __future__ import annotations

from multibot_rewrite.findings.finding import ERROR, WARNING
from multibot_rewrite.findings.rule import declare

# Reported where rules are asked: see ``failures``.
rule_crashed = declare(
    "MB001",
    "rule-crashed",
    ERROR,
    what="A rule fell over the file: the rule did not look at all of it.",
    why="What this rule is for may be wrong in the file, and nobody says so.",
    fix="Report it with the file; go on with --ignore and the code in the message.",
    bad="",
    good="",
    formats=(),
)

# Reported when all rules were asked: see ``suppress``.
unused_suppression = declare(
    "MB002",
    "unused-suppression",
    WARNING,
    what="A `urdf-lint: ignore` comment names a code that it does not keep silent: nothing of that "
    "code is found on its line, in the element below it, or (ignore-file) in the file.",
    why="What was excused is mended or has moved, and the comment now hides the next mistake of "
    "that kind.",
    fix="Delete the code or the comment (--fix does), or put the comment alone on the line above "
    "the element.",
    bad='<link name="a"/>\n<!-- urdf-lint: ignore MB501 - bolted on by the launch file -->\n',
    good='\n<!-- urdf-lint: ignore MB501 - bolted on by the launch file -->\n<link name="a"/>\n',
    line=2,
    formats=(),
)

# Reported when comments are read: see ``config.directives``.
broken_suppression = declare(
    "MB003",
    "broken-suppression",
    ERROR,
    what="A `urdf-lint:` comment cannot be followed: an unknown word, no code or no full one, a "
    "code that no rule has or that no comment can silence, a reason without a dash before it, or "
    "an ignore-file behind the first element.",
    why="It silences nothing, or less than was meant.",
    fix="Write `urdf-lint: ignore CODE, CODE - reason` or `urdf-lint: ignore-file CODE - reason`.",
    bad='<!-- urdf-lint: disable MB501 -->\n<link name="a"/>',
    good='<!-- urdf-lint: ignore MB501 -->\n<link name="a"/>',
    formats=(),
)

# Reported by the clock: see ``failures``.
took_too_long = declare(
    "MB004",
    "took-too-long",
    ERROR,
    what="The file took longer than `seconds` allows (60 s if nothing is said) and was left.",
    why="The lint knows nothing of the rest; who expands or loads the file waits as long.",
    fix="Look for a macro or an include that calls itself; give large files more with `seconds`.",
    bad="",
    good="",
    formats=(),
)
