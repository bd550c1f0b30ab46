"""Every command line of the package: what it takes, what it is for, what its exit codes mean."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from multibot_rewrite.cli.declared.description import LINT, POSTFIX
from multibot_rewrite.cli.declared.fleet import BUILD, INIT, PLAN, REHEARSE, REMAP
from multibot_rewrite.cli.declared.graph import (
    CHECK,
    CHECK_LAUNCH,
    DOCTOR,
    LEARN,
    SNAPSHOT,
    ZENOH_FILES,
)
from multibot_rewrite.cli.declared.knowledge import (
    ARGUMENTS,
    COVERAGE,
    EXPLAIN,
    HELP,
    VOCABULARY_LOOKUP,
)
from multibot_rewrite.cli.declared.view import VIEW
from multibot_rewrite.cli.options import Command

PROGRAMS = (POSTFIX, LINT)
COMMANDS: Mapping[str, Command] = MappingProxyType(
    {
        it.name: it
        for it in (
            ARGUMENTS,
            BUILD,
            CHECK,
            CHECK_LAUNCH,
            COVERAGE,
            DOCTOR,
            EXPLAIN,
            HELP,
            INIT,
            LEARN,
            PLAN,
            REHEARSE,
            REMAP,
            SNAPSHOT,
            VIEW,
            VOCABULARY_LOOKUP,
            ZENOH_FILES,
        )
    }
)
