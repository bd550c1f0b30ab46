"""A file beside a description, and what rules find in it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from multibot_rewrite.lint.config.settings import Settings
from multibot_rewrite.record import NamedTuple

if TYPE_CHECKING:
    import yaml

    from multibot_rewrite.companions.yaml_text import YamlText


class Beside(NamedTuple):
    """A file beside a description: its kind, its text and positions; ``memo`` as in a ``Subject``."""

    kind: str
    document: YamlText
    settings: Settings
    memo: dict[object, Any]


class Remark(NamedTuple):
    """What is wrong at a node of a file, before it has a line."""

    node: yaml.Node
    message: str
    hint: str = ""
