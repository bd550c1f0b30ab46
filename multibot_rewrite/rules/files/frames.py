"""Frames that tf2 refuses or takes for others: with a slash in front, or white space."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import NOTE, WARNING
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.companions.kinds import EVERY
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.names.by_kind import is_filled, is_plain
from multibot_rewrite.companions.sites import Site
from multibot_rewrite.rules.files.examples import a_section
from multibot_rewrite.rules.files.records import Remark, remark


def slashes(file: NamedFile) -> Iterator[Remark]:
    """Values that are known to be frames."""
    for site in _frames(file):
        if site.text.startswith("/") and is_plain(site.text) and not _is_spaced(site.text):
            name, level = f"frame {site.text!r}", NOTE if site.bare else ""
            message = f"{name} starts with a slash, which tf2 refuses"
            if site.bare:
                message = f"{name} is written without its slash, which the node takes off"
            yield remark(site, message, f"write {site.text.lstrip('/')}", level)


@rule(
    "MB865",
    "frame-with-white-space",
    WARNING,
    what="A file names a frame with white space in it.",
    why="tf takes any text for a frame, so 'odom ' is another one than 'odom', which nothing sends. It "
    "is not rewritten: nodes of all robots that send it send one frame.",
    fix="Remove the white space.",
    bad=a_section("amcl", 'odom_frame_id: "odom "'),
    good=a_section("amcl", "odom_frame_id: odom"),
    line=3,
    formats=EVERY,
)
def frame_with_white_space(file: NamedFile) -> Iterator[Remark]:
    """Values that are known to be frames."""
    for site in _frames(file):
        if _is_spaced(site.text) and is_filled(site.text):
            message = (
                f"frame {site.text!r} has white space in it: it is another one, and not rewritten"
            )
            yield remark(site, message, f"write {'_'.join(site.text.split())}")


def _frames(file: NamedFile) -> Iterator[Site]:
    # A block of text has a line break at its end, which is told where it is rewritten.
    free = (it for it in file.names if not it.in_key and not it.text.endswith("\n"))
    yield from (it for it in free if it.kind == "frame" and it.is_sure and it.text)


def _is_spaced(text: str) -> bool:
    return text.split() != [text]
