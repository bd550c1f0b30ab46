# SPDX-License-Identifier: Apache-2.0
"""Actions and descriptions of launch_ros whose options are made when they run.

The robot, its fleet and its names are known only then; event handlers want an action of launch_ros
before. So an object is made twice: at once with what is given, and again when it runs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from multibot_rewrite.launch.context import Action, Context
from multibot_rewrite.producers.launch.door import of_launch

Options = dict[str, Any]
# The options of an action, or the actions that run in its place.
Made = Options | list[Action]


def action(base: Any, make: Callable[[Context], Made], first: Mapping[str, Any]) -> Action:
    """Return an action of the class ``base``: with options ``first``, then with those of ``make``."""
    return _action_class(base)(make, first)


def component(base: Any, make: Callable[[Context], Options], first: Mapping[str, Any]) -> Any:
    """Return a ComposableNode: with options ``first``, then with those of ``make``."""
    return _component_class(base)(make, first)


@cache
def _action_class(base: Any) -> Any:
    """Return a class of actions that make themselves again when they run."""

    class OfRobot(base):  # type: ignore[misc]
        """An action of launch_ros for a robot."""

        def __init__(self, make: Callable[[Context], Made], first: Mapping[str, Any]) -> None:
            super().__init__(**first)
            self.__make: Callable[[Context], Made] | None = make

        def resolve(self, context: Context) -> list[Action] | None:
            """Fill in the robot's options; return the actions to run in its place, None for itself."""
            make, self.__make = self.__make, None
            made = make(context) if make else {}
            if isinstance(made, list):
                return made
            if made:
                super().__init__(**made)
            return None

        def execute(self, context: Context) -> Any:
            instead = self.resolve(context)
            return super().execute(context) if instead is None else instead

    return OfRobot


@cache
def _component_class(base: Any) -> Any:
    """Return a class of components that make themselves again when they are loaded."""

    class ComponentOfRobot(base):  # type: ignore[misc]
        """A component for a robot."""

        def __init__(self, make: Callable[[Context], Options], first: Mapping[str, Any]) -> None:
            super().__init__(**first)
            self.__make: Callable[[Context], Options] | None = make

        @property
        def package(self) -> Any:
            """The component's package; launch_ros asks for it before all else that is a robot's."""
            return [_made_text_class()(self._made)]

        def _made(self, context: Context) -> str:
            """Fill in the robot's options at the first call; return the package."""
            make, self.__make = self.__make, None
            if make:
                super().__init__(**make(context))
            return "".join(context.perform_substitution(it) for it in super().package)

    return ComponentOfRobot


@cache
def _made_text_class() -> Any:
    """Return a class of substitutions whose text a function makes."""

    class Made(of_launch().Substitution):  # type: ignore[misc]
        """A text that a function makes."""

        def __init__(self, make: Callable[[Context], str]) -> None:
            super().__init__()
            self.make = make

        def perform(self, context: Context) -> str:
            return self.make(context)

    return Made
