# SPDX-License-Identifier: Apache-2.0
"""Every command line of the package: what it takes, what it is for, what its exit codes mean."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from multibot_rewrite.cli.declared.description import ADOPT, JOIN, LINT, POSTFIX, RENAME
from multibot_rewrite.cli.declared.fleet import BUILD, INIT, PLAN, REHEARSE, VIEW
from multibot_rewrite.cli.declared.graph import CHECK, CHECK_LAUNCH, SNAPSHOT
from multibot_rewrite.cli.declared.knowledge import INSPECT
from multibot_rewrite.cli.options import Command

PROGRAMS = (POSTFIX, LINT)
COMMANDS: Mapping[str, Command] = MappingProxyType(
    {
        it.name: it
        for it in (
            ADOPT,
            BUILD,
            CHECK,
            CHECK_LAUNCH,
            INIT,
            INSPECT,
            JOIN,
            PLAN,
            REHEARSE,
            RENAME,
            SNAPSHOT,
            VIEW,
        )
    }
)
