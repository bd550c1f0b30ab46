# SPDX-License-Identifier: Apache-2.0
"""What the nodes of a watched graph answer, again and again; the function that asks is passed in."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping

from multibot_rewrite.system.parameters import Answer, Question, questions
from multibot_rewrite.system.records import System

# States and parameters change without the graph: nodes are asked for them again after so long.
AGAIN_SECONDS = 10.0
Ask = Callable[[Iterable[Question]], Iterable[Answer]]


class Answers:
    """The last answers. ``parameters`` are what nodes are asked for besides; None asks nobody."""

    def __init__(self, ask: Ask, parameters: Mapping[str, Collection[str]] | None) -> None:
        self._ask, self._parameters = ask, parameters
        self._asked = -AGAIN_SECONDS
        self.states: tuple[Answer, ...] = ()

    def old(self, now: float) -> bool:
        """Whether it is time to ask again."""
        return self._parameters is not None and now - self._asked >= AGAIN_SECONDS

    def update(self, seen: System, quiet: bool, now: float) -> bool:
        """Ask the nodes of a graph that is quiet; whether an answer is another than before.

        One that does not answer now keeps what it said before, until it leaves.
        """
        there = {node.name for node in seen.nodes}
        found = {it.node: it for it in self.states if it.node in there}
        if quiet and self._parameters is not None:
            found |= {it.node: it for it in self._ask(questions(seen, self._parameters))}
            self._asked = now
        before, self.states = self.states, tuple(found[it] for it in sorted(found))
        return before != self.states
