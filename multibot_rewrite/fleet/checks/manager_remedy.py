# SPDX-License-Identifier: Apache-2.0
"""What to do where no node and no plugin of a launch is the controller manager that its spawners wait
for: the argument with which one is, tried out."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from itertools import islice

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.fleet.file.simulator_switch import MOST, is_called_as_switch
from multibot_rewrite.producers.launch.include_arguments import arguments_declared
from multibot_rewrite.producers.launch.kept_paths import read_text
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.producers.launch.records import LaunchOrder
from multibot_rewrite.rules.launch.judge import judge_launch
from multibot_rewrite.rules.launch.started import START_MANAGER, no_manager

Read = Callable[[Sequence[LaunchOrder]], Launched]


def with_remedies(
    found: Iterable[Finding], orders: Sequence[LaunchOrder], read: Read
) -> list[Finding]:
    """Return the findings, those of managers that nothing starts with what starts them; ``read`` reads
    launch files with other arguments."""
    every = list(found)
    if not any(_is_open(it) for it in every):
        return every
    remedy = _argument(orders, read) or START_MANAGER
    return [it._replace(hint=remedy) if _is_open(it) else it for it in every]


def _is_missing(it: Finding) -> bool:
    return it.code == no_manager.code


def _is_open(it: Finding) -> bool:
    return _is_missing(it) and it.level == ERROR and it.hint == START_MANAGER


def _argument(orders: Sequence[LaunchOrder], read: Read) -> str:
    """Return the argument of a launch file with which no manager is missing; empty for none."""
    for name, value in islice(_choices(orders), MOST):
        with suppress(MultibotError):
            other = read([_with(it, name, value) for it in orders])
            if other.models.found and not any(map(_is_missing, judge_launch(other))):
                return f"add {name}:={value}, with which a manager is started"
    return ""


def _choices(orders: Sequence[LaunchOrder]) -> Iterator[tuple[str, str]]:
    """Yield the arguments that may switch to another manager, with both values."""
    declared: dict[str, None] = {}
    for it in orders:
        declared |= dict.fromkeys(sorted(arguments_declared(read_text(it.file))))
    given = {it for order in orders for it in order.arguments}
    for name in filter(is_called_as_switch, declared):
        yield from ((name, it) for it in ("true", "false") if (name, it) not in given)


def _with(it: LaunchOrder, name: str, value: str) -> LaunchOrder:
    others = (one for one in it.arguments if one[0] != name)
    return it._replace(arguments=(*others, (name, value)))
