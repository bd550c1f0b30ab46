"""What the names of a description become under the naming of the settings."""

from __future__ import annotations

from multibot_rewrite.lint.facts.memo import memoized
from multibot_rewrite.lint.records import Subject
from multibot_rewrite.steps.renames import RenameMap, make_renames


@memoized
def rename_map(subject: Subject) -> RenameMap:
    """The rename map of a subject, made once."""
    return make_renames(subject.inventory, subject.settings.naming)
