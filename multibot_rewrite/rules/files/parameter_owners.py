"""Whose parameters the facts of a package are: the data of ``parameter_owners.yaml``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources import files

from multibot_rewrite.bounded import load_yaml
from multibot_rewrite.record import NamedTuple


class Owners(NamedTuple):
    """``also``: node -> packages besides its own; ``below``: package -> what is before its names."""

    also: Mapping[str, Sequence[str]]
    below: Mapping[str, str]


def owners() -> Owners:
    """What ``parameter_owners.yaml`` says."""
    text = files(__package__).joinpath("parameter_owners.yaml").read_text("utf-8")
    found = load_yaml(text)
    return Owners(found["also"], found["below"])
