# SPDX-License-Identifier: Apache-2.0
"""The rename map of one robot, for names in other files than its description."""

from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.naming import NAMESPACE, NOT_PLAIN, Naming, spelled
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.model_namespaces import NO_WORDS, Stems
from multibot_rewrite.description.rewriters.renaming import resolve

# Kinds of names in a description that a kind of value may refer to, tried in order.
KINDS = {kind: tuple(meant) for (kind, *meant), _ in ROWS["referred"]}
TOPIC = "topic"
NO_OWN: Mapping[tuple[str, str], str] = {}


class RelatedNames(NamedTuple):
    """The names that a description declares (not rewritten), the naming, and the robot.

    ``own`` are names (kind and text) that arguments of the xacro make another for the robot; ``words``
    are those that its systems make topics of, ``given`` the topics of Gazebo that it gives itself.
    """

    declared: Declared
    naming: Naming
    robot: str
    own: Mapping[tuple[str, str], str] = NO_OWN
    words: Stems = NO_WORDS
    given: frozenset[str] = frozenset()

    @property
    def in_full(self) -> dict[str, str]:
        """Return the topics that arguments make, with their full names where nodes have a namespace."""
        own = ((plain, text) for (kind, plain), text in self.own.items() if kind == TOPIC)
        return {plain: text for plain, text in own if self.naming.topics == NAMESPACE}


def spell(names: RelatedNames, word: str, value: str, namespaced: bool = True) -> str:
    """Return the robot's version of ``value``, a name of the kind ``word``; other values stay.

    ``namespaced`` is true if a relative topic is resolved in the robot's namespace.
    """
    if not value or not NOT_PLAIN.isdisjoint(value) or "<" in value:
        return value
    # What nodes name at run time is a frame, whatever the description calls so.
    apart = names.naming.layout.at_run_time and word == "frame"
    kinds = (word,) if apart else KINDS[word]
    kind = resolve(value, kinds, "uses", names.declared, apart=apart)
    if (kind, value) in names.own:
        return names.own[kind, value]
    if kind == TOPIC and value.lstrip("/") in names.in_full:
        return names.in_full[value.lstrip("/")]
    return spelled(names.naming, names.robot, kind, value, namespaced)


def with_srdf(declared: Declared, semantics: Declared) -> Declared:
    """Return the names that a description declares, with the groups and virtual joints of its SRDF."""
    more = {
        kind: {**declared.get(kind, {}), **semantics.get(kind, {})} for kind in ("group", "joint")
    }
    return {**declared, **more}


def related_file_names(
    declared: Declared,
    naming: Naming,
    robot: str,
    own: Mapping[tuple[str, str], str],
    words: Stems = NO_WORDS,
    in_full: Collection[str] = (),
    given: frozenset[str] = frozenset(),
) -> RelatedNames:
    """Return the names of a robot; ``own`` are declared by either of their texts."""
    # Nodes call the topics ``in_full``, which their namespace does not reach, by full names.
    if naming.topics == NAMESPACE:
        made = {key: text for key, text in own.items() if key[0] == TOPIC and text in in_full}
        own = {**own, **{key: f"/{text.lstrip('/')}" for key, text in made.items()}}
    # Without its argument a name may begin with the slash behind it: /imu.
    filled = {(kind, it): text for kind, it, text in _without_argument(robot, own)}
    own = {
        **filled,
        **{(kind, plain.lstrip("/")): text for (kind, plain), text in own.items()},
        **own,
    }
    both = {kind: dict(names) for kind, names in declared.items()}
    for (kind, plain), text in own.items():
        if text in both.get(kind, ()):
            both[kind].setdefault(plain, both[kind][text])
    return RelatedNames(both, naming, robot, own, words, given)


def _without_argument(
    robot: str, own: Mapping[tuple[str, str], str]
) -> Iterator[tuple[str, str, str]]:
    """Yield (kind, name, text) where the robot's name replaces the default of an argument."""
    # Of ``lbr_A1`` a file with ``$(var robot_name)_A1`` has ``A1``.
    for (kind, plain), text in own.items():
        rest = text.removeprefix(robot)
        if robot and rest != text and rest[:1] in ("_", "/") and plain.endswith(rest):
            yield kind, rest[1:], text


def is_declared(names: RelatedNames, word: str, value: str) -> bool:
    """Return whether the description declares this link, joint, sensor, gpio or hardware."""
    return any(value in names.declared.get(kind, ()) for kind in KINDS[word])
