# SPDX-License-Identifier: Apache-2.0
"""Arguments of an include that the launch file there does not read.

launch hands on any argument (jazzy include_launch_description.py): one that nothing reads has no
effect, and nobody says so. By the text of the file: what it declares, and the names in quotes.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterator

from multibot_rewrite.base.nearest import SLIP, differ_in_numbers, nearest
from multibot_rewrite.producers.launch.kept_paths import read_text

_DECLARED = re.compile(
    r"""DeclareLaunchArgument\(\s*(?:name\s*=\s*)?["']([\w.-]+)["']|<arg\s[^<>]*\bname="([\w.-]+)\""""
    r"""|-\s*arg:\s*(?:\{\s*)?name:\s*["']?([\w.-]+)"""
)
# It may read any name: one that is made when it runs, or one for a file that it includes itself.
_ANY = re.compile(
    r"LaunchConfiguration\(\s*(?!name)[^\s\"']|launch_configurations|nclude|import \w*\."
)


def unread(file: str, given: Collection[str]) -> Iterator[tuple[str, str]]:
    """Each argument that the file does not read, with what it declares that is called nearly so."""
    if not os.path.isfile(file):
        return
    text = read_text(file)
    declared = arguments_declared(text)
    yield from not_among(given, declared, text, whole=bool(declared) and not _ANY.search(text))


def arguments_declared(text: str) -> set[str]:
    """Return the names of the arguments that the text of a launch file declares."""
    return {name for found in _DECLARED.findall(text) for name in found if name}


def not_among(
    given: Collection[str], declared: Collection[str], text: str = "", whole: bool = False
) -> Iterator[tuple[str, str]]:
    """The same by what is declared; ``whole`` where these are all."""
    for name in given:
        if name in declared or re.search(rf"[\"'({{ ]{re.escape(name)}[\"')}}]", text):
            continue
        near = nearest(name, sorted(declared), SLIP)
        # robot1_x and robot2_x are two things; what is given as it should be needs no other name.
        if not differ_in_numbers(near, name) if near else whole:
            yield name, "" if near in given else near
