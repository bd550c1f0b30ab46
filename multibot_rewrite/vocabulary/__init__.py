"""The vocabulary: which tag of which plugin holds which name. Data in ``*.vocab``, read lazily.

A file is a list of sections. The whole grammar:

    # a comment
    [element sensor]                     an XML element; names after the first are aliases
    at: gazebo link                      the elements it may stand in ("/" is the document)
    @name        declares sensor         the value at this path declares a name of this kind
    plugin/frame uses frame              the value refers to one (kinds are tried in order)
    @type        keep an enumeration     the value is never renamed, and why

A path is child steps, then ``@attribute`` for an attribute; a step may ask for an attribute:
``param[@name=mimic]``. After the kinds may stand ``form=NAME`` (where in the value the names are)
and ``default=TEXT`` (the literal the consumer falls back to; ``topic/../x`` is the value at ``topic``
with its last segment replaced) and ``when=SIBLING=TEXT`` (else it is no name of ours), then
``# a note``.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import lru_cache

from multibot_rewrite.model import Site, VocabularyError
from multibot_rewrite.vocabulary.grammar import (
    FORMS,
    KINDS,
    TYPES,
    Rewriter,
    assemble,
    merge,
    read_header,
    read_section,
    split_path,
    split_step,
)

HERE = os.path.dirname(__file__)
Raw = tuple[str, int, str]

__all__ = [
    "FORMS",
    "KINDS",
    "TYPES",
    "Rewriter",
    "Vocabulary",
    "check_vocabulary",
    "load_vocabulary",
    "split_path",
    "split_step",
]


class Vocabulary:
    """The sections of several files, parsed on demand; build with ``load_vocabulary``."""

    def __init__(self, texts: Mapping[str, str]) -> None:
        self._raw: dict[tuple[str, str], list[Raw]] = {}
        self._found: dict[tuple[str, str], list[Rewriter]] = {}
        for file, text in texts.items():
            self._index(file, text)

    def _index(self, file: str, text: str) -> None:
        preamble, *chunks = ("\n" + text).split("\n[")
        line = 0
        for line, row in enumerate(preamble.split("\n")):
            if row.strip() and not row.startswith("#"):
                raise VocabularyError(f"{file}:{line}: text before the first [section]")
        for chunk in chunks:
            line += 1
            type_, *names = read_header(f"{file}:{line}", chunk.partition("\n")[0])
            for name in names:
                self._raw.setdefault((type_, name), []).append((file, line, chunk))
            line += chunk.count("\n")

    def find(self, type_: str, name: str) -> list[Rewriter]:
        """The rewriters of that type under that name: more than one where ROS 1 and 2 differ.

        Sections of one flavour are one; a later one without ``ros:`` adds to every flavour.
        """
        key = (type_, name)
        if key not in self._found:
            self._found[key] = []
            for raw in self._raw.get(key, ()):
                self._add(self._found[key], self._read(*raw))
        return self._found[key]

    def _add(self, found: list[Rewriter], new: Rewriter) -> None:
        same = [at for at, old in enumerate(found) if new.ros in ("", old.ros)]
        for at in same:
            found[at] = merge(found[at], new)
        if not same:
            found.append(new)

    def names(self, type_: str) -> list[str]:
        """Every name and alias of that type."""
        return [name for kind, name in self._raw if kind == type_]

    def rewriters(self, *types: str) -> list[Rewriter]:
        """All rewriters of these types, parsed and checked, in file order."""
        found = [r for type_, name in self._raw if type_ in types for r in self.find(type_, name)]
        return list({(rewriter.file, rewriter.line): rewriter for rewriter in found}.values())

    def _read(self, file: str, line: int, chunk: str) -> Rewriter:
        rows = chunk.split("\n")
        settings, own = read_section(file, line, rows)
        sites: dict[str, Site] = {}
        for name in settings.get("with", "").split():
            sites |= {site.path: site for site in self._block(f"{file}:{line}", name).sites}
        header = read_header(f"{file}:{line}", rows[0])
        return assemble(file, line, header, settings, list((sites | own).values()))

    def _block(self, place: str, name: str) -> Rewriter:
        found = self.find("block", name)
        if not found:
            known = ("block", name) in self._raw
            wrong = f"[block {name}] stands in a circle" if known else f"there is no [block {name}]"
            raise VocabularyError(f"{place}: with: {name}: {wrong}")
        return found[0]


@lru_cache(maxsize=8)
def load_vocabulary(extra: tuple[str, ...] = ()) -> Vocabulary:
    """The built-in vocabulary and the files named in ``extra``.

    Raises VocabularyError, naming file and line, for a mistake: at once where there are
    ``extra`` files, else in a section that is used.
    """
    builtin = sorted(name for name in os.listdir(HERE) if name.endswith(".vocab"))
    texts = {name: _text(f"{HERE}/{name}") for name in builtin}
    vocabulary = Vocabulary(texts | {path: _text(path) for path in extra})
    if extra:
        check_vocabulary(vocabulary)
    return vocabulary


def _text(path: str) -> str:
    try:
        with open(path, encoding="utf-8-sig") as file:
            return file.read()
    except OSError as error:
        raise VocabularyError(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise VocabularyError(
            f"{path}: cannot be read: it is not UTF-8; save it as UTF-8"
        ) from None


def check_vocabulary(vocabulary: Vocabulary) -> list[Rewriter]:
    """Parse every section; raises VocabularyError for the first mistake."""
    return vocabulary.rewriters(*TYPES)
