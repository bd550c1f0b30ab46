"""``python -m multibot_rewrite.lint``: the page of the lint's rules."""

from __future__ import annotations

import sys
from collections.abc import Iterator

from multibot_rewrite.findings.rule import Rule
from multibot_rewrite.findings.rule_docs import Group, page
from multibot_rewrite.lint.groups import GROUPS
from multibot_rewrite.lint.registry import RULES

HEAD = """\
# Rules of urdf-lint

Made by `python -m multibot_rewrite.lint > docs/lint-rules.md`; `urdf-lint --explain CODE` prints one.
An *error* is rejected by some parser or cannot work, a *warning* is very probably wrong, a *note* never
makes the lint fail. The examples are tests: the bad one has the finding, the good one does not. A
fragment belongs inside `<robot name="r">`.
"""


def rules_page() -> str:
    """The page, Markdown."""
    groups = (Group(it.start, it.title, tuple(_rules(it.start))) for it in GROUPS)
    return page(HEAD, groups)


def _rules(start: str) -> Iterator[Rule]:
    return (it for code, it in RULES.items() if code.startswith(start))


if __name__ == "__main__":
    sys.stdout.write(rules_page())
