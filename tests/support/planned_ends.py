# SPDX-License-Identifier: Apache-2.0
"""Ends as a plan has them: nothing is known of them that only a running system shows."""

from __future__ import annotations

from multibot_rewrite.system.records import End


def planned_end(
    node: str,
    kind: str,
    role: str,
    name: str,
    type_: str = "",
    code_name: str = "",
    also: tuple[str, ...] = (),
) -> End:
    return End(kind, role, name, type_, node=node, code_name=code_name, also=also)
