# SPDX-License-Identifier: Apache-2.0
"""Which arguments the files of one expansion know: those that they declare, and those that they read.

Sources: xacro/__init__.py (``<xacro:arg name=``, ``xacro.arg('NAME')``) and xacro/substitution_args.py
(``$(arg NAME)``, ``$(eval ...)`` with names as they are). An argument that is given and that no file
knows does nothing, and xacro does not say so.
"""

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile

_DECLARED = lazy_compile(rb"<xacro:arg\s[^<]*?\bname\s*=\s*[\"']\s*([^\"'<\s]+)")
_READ = lazy_compile(rb"\$\(arg\s+([^\s)]+)|\bxacro\.arg\(\s*[\"']([^\"']+)")
_EVALUATED = lazy_compile(rb"\$\(eval\s([^<]*)")
_WORD = lazy_compile(rb"\w+")
# A name that an expression makes: any argument may be meant.
_COMPUTED = lazy_compile(rb"\bxacro\.arg\(\s*[^\"'\s]")


class KnownArguments(NamedTuple):
    """``names`` of arguments, those declared first; ``any`` of them may be read by a computed name."""

    names: tuple[str, ...] = ()
    any: bool = False

    def lacks(self, given: Iterable[str]) -> tuple[str, ...]:
        """Return the given names that are not known."""
        return () if self.any else tuple(it for it in given if it not in self.names)


def known_arguments(texts: Iterable[bytes]) -> KnownArguments:
    """Return the arguments that files know."""
    bare = [_without_comments(it) for it in texts]
    names = [name for text in bare for name in _DECLARED.findall(text)]
    names += [name for text in bare for name in _argument_names_read(text)]
    found = dict.fromkeys(it.decode("utf-8", "replace") for it in names)
    return KnownArguments(tuple(found), any(_COMPUTED.search(it) for it in bare))


def joined(known: Iterable[KnownArguments]) -> KnownArguments:
    """Return the arguments that any of them knows."""
    its = list(known)
    names = dict.fromkeys(name for it in its for name in it.names)
    return KnownArguments(tuple(names), any(it.any for it in its))


def defaults_in(text: bytes) -> dict[str, str]:
    """Return the defaults of the arguments that a file declares, but in a condition or a macro."""
    from multibot_rewrite.description.readback.xml import read_xml  # kept answers need no lxml

    root = read_xml(text, "")
    own = (it for it in root.iterchildren("*") if str(it.tag).rpartition("}")[2] == "arg")
    return {it.get("name", ""): it.get("default", "") for it in own if "default" in it.attrib}


def _argument_names_read(text: bytes) -> Iterator[bytes]:
    for found in _READ.finditer(text):
        yield found[1] or found[2]
    for found in _EVALUATED.finditer(text):
        yield from _WORD.findall(found[1])


def _without_comments(text: bytes) -> bytes:
    """Return the text without comments; one that does not end goes on to the end."""
    first, *others = re.split(b"<!--", text)
    return first + b"".join(it.partition(b"-->")[2] for it in others)
