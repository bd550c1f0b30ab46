"""What rules of several groups share."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.checks.remarks import Remark
from multibot_rewrite.lint.records import Problem


def problems(remarks: Iterable[Remark]) -> Iterator[Problem]:
    """What the checks of the rewrite remark, as problems."""
    for it in remarks:
        yield Problem(it.element, it.message, it.attribute, it.hint)
