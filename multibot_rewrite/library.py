"""The one call that launch files and scripts use; the commands use it too."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from multibot_rewrite import pipeline
from multibot_rewrite.model import Change, Finding, UsageError
from multibot_rewrite.naming import SHARED_FRAMES, SHARED_TOPICS, Naming, make_naming
from multibot_rewrite.reports.changes import list_changes
from multibot_rewrite.rewriters.builtin import builtin_tree
from multibot_rewrite.rosnames import check_robot_name
from multibot_rewrite.sources.read import Source, args_for, read_source
from multibot_rewrite.steps.collect import collect
from multibot_rewrite.steps.document import read_document

if TYPE_CHECKING:
    from multibot_rewrite.reports.explain import Explanation


class Rewrite(NamedTuple):
    """A description as one robot needs it.

    ``data`` are the output bytes, ``text`` the same as str (for ``robot_description``).
    ``findings`` are warnings about the input. ``changes`` lists every renamed and inserted value.
    """

    robot: str
    data: bytes
    findings: tuple[Finding, ...]
    template: pipeline.Prepared

    @property
    def text(self) -> str:
        """The output as str."""
        return self.data.decode()

    @property
    def changes(self) -> list[Change]:
        """Every renamed or inserted value, in source order."""
        return list_changes(self.template, self.robot)


def rewrite(source: Source, robot: str, **options: object) -> Rewrite:
    """Rewrite a robot description for ``robot`` and prove the result.

    ``source`` is a path (str or PathLike), XML text (a str that starts with ``<``) or bytes; a path
    ending in ``.xacro`` is expanded. ``options`` are those of ``rewrite_all``. In a launch file:

        parameters=[{"robot_description": rewrite("rover.urdf", "robot1").text}]

    Raises InputError (cannot be read), UsageError (a wrong option or robot name), RewriteRefused
    (the content does not allow it; ``.findings``), VocabularyError, ProofError.
    """
    return next(rewrite_all(source, [robot], **options))  # type: ignore[arg-type]


def rewrite_all(
    source: Source,
    robots: Sequence[str],
    *,
    layout: str = "postfix",
    affix: str = "postfix",
    topics: str | None = None,
    separators: Mapping[str, str] | None = None,
    shared_frames: Iterable[str] = SHARED_FRAMES,
    shared_topics: Iterable[str] = SHARED_TOPICS,
    groups: str = "keep",
    urdf: Source | None = None,
    xacro_args: Mapping[str, str] | None = None,
    vocabulary: Sequence[str] = (),
    again: bool = False,
    file: str = "",
) -> Iterator[Rewrite]:
    """Rewrite one description for several robots: one parse, then about a copy of the text each.

    ``layout`` is one of tf-per-robot, frames-per-robot, both, postfix (or L1 to L4); ``affix`` is
    postfix or prefix; ``topics`` is postfix, prefix or namespace (default: what the layout
    implies); ``separators`` maps kinds to separators; ``groups`` is keep or rename: what becomes of
    an SRDF's groups and end effectors; ``urdf`` is the description an SRDF belongs to; ``again``
    allows a second rewrite; ``file`` is the name used in messages. Raises as ``rewrite`` does,
    before the first result.
    """
    naming = make_naming(layout, affix, topics, separators, shared_frames, shared_topics, groups)
    _check_robots(robots)
    tree = builtin_tree(tuple(vocabulary))
    args = xacro_args or {}
    data, name = read_source(source, args_for(source, urdf, args))
    beside = None if urdf is None else read_source(urdf, args_for(urdf, source, args))
    urdf_declarations = pipeline.prepare(*beside, naming, tree).inventory.declared if beside else {}
    template = pipeline.prepare(data, file or name, naming, tree, urdf_declarations)
    texts = pipeline.render(template, robots, again)
    findings = tuple(template.findings)
    return (Rewrite(r, t, findings, template) for r, t in zip(robots, texts, strict=True))


def explain(
    source: Source,
    line: int,
    robot: str = "robot1",
    *,
    urdf: Source | None = None,
    xacro_args: Mapping[str, str] | None = None,
    vocabulary: Sequence[str] = (),
    file: str = "",
    **policy: object,
) -> list[Explanation]:
    """What is known about the values that start on ``line``, and what they become for ``robot``.

    ``policy`` is that of ``rewrite_all``. A description that a rewrite refuses is explained all the
    same. Raises InputError, UsageError and VocabularyError as ``rewrite`` does.
    """
    naming = make_naming(**policy)  # type: ignore[arg-type]
    check_robot_name(robot)
    tree = builtin_tree(tuple(vocabulary))
    args = xacro_args or {}
    data, name = read_source(source, args_for(source, urdf, args))
    beside = None if urdf is None else read_source(urdf, args_for(urdf, source, args))
    urdf_declarations = pipeline.declarations(*beside, tree) if beside else {}
    from multibot_rewrite.reports.explain import explain_line  # a rewrite does not need it

    inventory = collect(read_document(data, file or name), tree, urdf_declarations)
    pipeline.check_urdf(inventory, urdf_declarations)
    return explain_line(inventory, naming, tree, robot, line)


def strip(
    source: Source,
    robot: str,
    *,
    naming: Naming | None = None,
    urdf: Source | None = None,
    vocabulary: Sequence[str] = (),
    file: str = "",
    **policy: object,
) -> bytes:
    """Undo ``rewrite`` from the rewritten text alone, and prove it by rewriting again.

    ``policy`` are the ``layout``, ``affix``, ``topics``, ``separators``, ``shared_frames``,
    ``shared_topics`` and ``groups`` it was made with, or ``naming`` is all of them. ``urdf`` is the
    rewritten description a rewritten SRDF belongs to. Raises as ``rewrite`` does.
    """
    data, name = read_source(source, {})
    check_robot_name(robot)
    chosen = naming or make_naming(**policy)  # type: ignore[arg-type]
    tree = builtin_tree(tuple(vocabulary))
    urdf_declarations = {} if urdf is None else pipeline.declarations(*read_source(urdf, {}), tree)
    return pipeline.strip(data, file or name, robot, chosen, tree, urdf_declarations)


def _check_robots(robots: Sequence[str]) -> None:
    for robot in robots:
        check_robot_name(robot)
    seen: set[str] = set()
    for robot in robots:
        if robot in seen:
            raise UsageError(f"robot name {robot!r} is given twice; every robot needs its own")
        seen.add(robot)
