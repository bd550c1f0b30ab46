"""What the names of a description become under the naming of the settings."""

from __future__ import annotations

from typing import TYPE_CHECKING

from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject

if TYPE_CHECKING:
    from multibot_rewrite.description.steps.renames import RenameMap


@memoized
def rename_map(subject: Subject) -> RenameMap:
    """The rename map of a subject, made once."""
    from multibot_rewrite.description.steps.renames import make_renames  # most lints name no robots

    return make_renames(subject.inventory, subject.settings.naming)
