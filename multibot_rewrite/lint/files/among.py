"""What a file's lint has to know of the others that are linted with it."""

from __future__ import annotations

from collections.abc import Sequence

from multibot_rewrite.lint.files.included import included, known_elsewhere
from multibot_rewrite.lint.files.pairing import named_urdfs
from multibot_rewrite.rules.settings import Settings


def set_among(paths: Sequence[str], settings: Settings) -> Settings:
    """The settings with what the others include, the URDFs of SRDFs, and the arguments that xacro
    files know."""
    settings = settings._replace(included=included(paths))
    known = known_elsewhere(paths) if settings.arguments else None
    return settings._replace(urdfs=named_urdfs(paths, settings.included), elsewhere=known)
