# SPDX-License-Identifier: Apache-2.0
"""Missing Python packages of launch files: what they have is a substitution without a text."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any, cast

import yaml

from multibot_rewrite.producers.launch.door import of_launch
from multibot_rewrite.system.parameters import ANY_NAME


def add_unknown(name: str) -> None:
    """Make a package importable for a launch file's Python; in YAML its values are a text."""
    sys.meta_path.append(_Finder(name))
    for dumper in ("Dumper", "SafeDumper", "CDumper", "CSafeDumper"):
        if made := getattr(yaml, dumper, None):
            made.add_multi_representer(Unknown, lambda it, _: it.represent_str(STOOD_FOR))


def is_unknown(value: object) -> bool:
    """Return whether a value is a package that is not here, or something taken from it."""
    return isinstance(value, Unknown | _Module)


def imported() -> list[str]:
    """Return those of such packages that a launch file has imported."""
    return [it.asked for it in sys.meta_path if isinstance(it, _Finder) and it.asked]


# How it is called in a text that is made of it.
STOOD_FOR = __name__


class UnknownError(ModuleNotFoundError):
    """A text is made of a package that is not here."""

    def __init__(self, module: str) -> None:
        super().__init__(f"No module named {module!r}")


class Unknown:
    """What nothing is known of but the module that it is taken from; it has nothing in it."""

    def __init__(self, module: str) -> None:
        self._multibot_module = module

    @property  # type: ignore[misc]
    def __class__(self) -> type:
        # launch asks for its own class where it takes texts.
        found: type = of_launch().Substitution
        return found

    def __mro_entries__(self, _: tuple[object, ...]) -> tuple[type]:
        """Return a base class for one that extends this: what it takes from the base is unknown."""
        own = {"_multibot_module": self._multibot_module, "__init__": lambda *_, **__: None}
        return (type("Base", (Unknown,), own),)

    def __getattr__(self, name: str) -> Unknown:
        if name.startswith("__"):
            raise AttributeError(name)
        return Unknown(self._multibot_module)

    def __call__(self, *_: object, **__: object) -> Unknown:
        """Return another unknown value of the module."""
        return Unknown(self._multibot_module)

    def __getitem__(self, _: object) -> Unknown:
        return Unknown(self._multibot_module)

    def __setitem__(self, _: object, __: object) -> None:
        """Do nothing: no value is kept."""

    def __iter__(self) -> Iterator[Any]:
        return iter(())

    def __len__(self) -> int:
        return 0

    def keys(self) -> tuple[str, ...]:
        """Return names that nobody knows, for use as a dictionary."""
        return (ANY_NAME,)

    def __fspath__(self) -> str:
        return "unknown"

    def __add__(self, _: object) -> Unknown:
        return Unknown(self._multibot_module)

    __radd__ = __truediv__ = __or__ = __ror__ = __add__

    def perform(self, _: object) -> str:
        """Raise UnknownError: there is no text."""
        raise UnknownError(self._multibot_module)


class _Module(ModuleType):
    def __getattr__(self, name: str) -> Unknown:
        if name.startswith("__"):
            raise AttributeError(name)
        return Unknown(self.__name__)


class _Finder:
    """Finds and loads; importlib.abc, which has the classes for that, is slow to import."""

    def __init__(self, name: str) -> None:
        self._name, self.asked = name, ""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the module itself, and whatever is below it."""
        mine = fullname == self._name or fullname.startswith(f"{self._name}.")
        return ModuleSpec(fullname, cast(Any, self), is_package=True) if mine else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return a module that has every name."""
        self.asked = self._name
        return _Module(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing: the module has no code."""
