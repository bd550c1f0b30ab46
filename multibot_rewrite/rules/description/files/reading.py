# SPDX-License-Identifier: Apache-2.0
"""Files that cannot be read or are no robot description yet; XML declaration, BOM and namespaces."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import islice

from multibot_rewrite.base.findings.finding import (
    ERROR,
    NOTE,
    SRDF,
    URDF,
    WARNING,
    XACRO,
    declare,
    rule,
)
from multibot_rewrite.base.lazy import ATTRIBUTES, lazy_compile
from multibot_rewrite.base.model import Edit
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.description.checks.audit import leftover_xacro, loosely_written, worlds
from multibot_rewrite.description.checks.mentions import is_macro_call
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.twice import already_rewritten
from multibot_rewrite.related_files.named_file import EVERY
from multibot_rewrite.rules.declaration import OF_TWO
from multibot_rewrite.rules.settings import EVERY_FILE, ArgumentSet
from multibot_rewrite.rules.subject import Subject

# These five are reported where a file is read or expanded: see ``failures``.
not_xml = declare("MB101", "not-xml", ERROR)

unreadable = declare("MB102", "unreadable", ERROR)

xacro_failed = declare("MB103", "xacro-failed", ERROR)

needs_argument = declare("MB145", "needs-argument", NOTE)

package_not_found = declare("MB119", "not-expanded", NOTE)


@rule("MB105", "placeholder-left", WARNING, formats=(URDF, *EVERY))
def leftover(subject: Subject) -> Iterator[Problem]:
    """Report the first ``${...}`` or ``$(...)`` that xacro left in a description, and its macros."""
    yield from leftover_xacro(subject.inventory)
    for it in filter(is_macro_call, subject.document.root.iterchildren("*")):
        message = f"<{it.tag}> is the call of a macro that xacro did not expand: nothing reads it"
        hint = f"write <xacro:{it.tag}>, and include the file that has the macro"
        yield Problem(it, message, None, hint)


@rule("MB106", "already-rewritten", WARNING, options=OF_TWO)
def already(subject: Subject) -> Iterator[Problem]:
    """Report the first robot whose name is in a file already."""
    # What has a robot's name by an argument has it by its author.
    robots = [it for it in subject.settings.robots if it not in subject.arguments]
    found = already_rewritten(subject.inventory, robots, False)
    for it in islice(found, 1):
        yield it._replace(hint="lint the source it was made from")


@rule("MB109", "sdf-world", ERROR, options=OF_TWO)
def sdf_world(subject: Subject) -> Iterator[Problem]:
    """Report every world of the file; one that is only a world has no robots."""
    return worlds(subject.inventory) if subject.settings.robots else iter(())


@rule(
    "MB144",
    "argument-not-read",
    WARNING,
    options={"arguments": (ArgumentSet(EVERY_FILE, (("tf_prefix", "left_"),)),)},
)
def argument_not_read(subject: Subject) -> Iterator[Problem]:
    """Report unread arguments of one expansion; one that is for many files need not be for each."""
    if not subject.given:
        return
    from multibot_rewrite.description.checks.references import unread_arguments
    from multibot_rewrite.description.sources.known_arguments import known_arguments

    known = known_arguments(subject.sources.values())
    lacking = known.lacks(subject.given) if known else ()
    others = subject.settings.elsewhere
    if known and others is not None:
        lacking = others.lacks(it for it in lacking if did_you_mean_one_of(it, known.names))
    if known and lacking:
        yield from unread_arguments(subject.document.root, lacking, known.names)


@rule("MB147", "default-of-another-file", WARNING)
def default_of_another_file(subject: Subject) -> Iterator[Problem]:
    """Report two files with different defaults; a file may set defaults for those it includes."""
    if len(subject.sources) < 3:
        return
    from multibot_rewrite.description.sources.included_by import includers
    from multibot_rewrite.description.sources.known_arguments import defaults_in

    by, first = includers(subject.sources.items()), dict[str, tuple[str, str]]()
    for file, text in subject.sources.items():
        above = [file]
        for it in above:  # grows
            above += sorted(by.get(it, set()) - {*above})
        for name, own in defaults_in(text).items():
            other, default = first.setdefault(name, (file, own))
            if own == default or other in above or name in subject.given or "$" in own + default:
                continue
            who, whose = os.path.basename(other), os.path.basename(file)
            message = f"argument {name} of {whose} is {default!r}, as {who} has it, and not {own!r}"
            hint = "give them arguments of other names"
            yield Problem(subject.document.root, message, None, hint)


BOM = b"\xef\xbb\xbf"
# Of nearly all files, which spares them the two expressions below.
_ENCODINGS = (b"", b" ", b' encoding="utf-8"', b' encoding="UTF-8"')
_USUAL = tuple(b'<?xml version="1.0"%b?>' % it for it in _ENCODINGS)
_DECLARED = lazy_compile(rb"<\?xml\s+version\s*=\s*[\"']([^\"']*)[\"']")
_ENCODED = lazy_compile(rb"<\?xml\s[^<>]*?\sencoding\s*=\s*[\"']([^\"'<]*)[\"']")
_NAMESPACE = lazy_compile(rb"(?<!\s)\s+xmlns:([\w.-]+)\s*=\s*(?:\"[^\"]*\"|'[^']*')")
_ROOT = lazy_compile(rb"<robot\b" + ATTRIBUTES + rb">")


@rule("MB140", "xml-declaration", WARNING)
def xml_declaration(subject: Subject) -> Iterator[Problem]:
    """Yield XML declarations of another version or encoding; a file that was read is plain ASCII."""
    source = subject.document.source
    if subject.origins or b"<?xml" not in source[:8]:
        return
    start = source.index(b"<?xml")
    if source.startswith(_USUAL, start):
        return
    for pattern, right, allowed in (
        (_DECLARED, b"1.0", (b"1.0",)),
        (_ENCODED, b"UTF-8", (b"utf-8", b"utf8", b"us-ascii", b"ascii")),
    ):
        found = pattern.match(source, start)
        if found and found[1].lower() not in allowed:
            value = found[1].decode("utf-8", "replace")
            edit = Edit(found.start(1), found.end(1), right, None)
            message = f"the XML declaration says {value!r}"
            yield Problem(subject.document.root, message, None, f"write {right.decode()}", (edit,))


@rule("MB141", "byte-order-mark", NOTE)
def byte_order_mark(subject: Subject) -> Iterator[Problem]:
    """Report a byte order mark, with a fix."""
    if subject.document.source.startswith(BOM):
        edit = Edit(0, len(BOM), b"", None)
        root = subject.document.root
        yield Problem(root, "the file starts with a byte order mark", None, "", (edit,))


@rule("MB142", "unused-namespace", NOTE)
def unused_namespace(subject: Subject) -> Iterator[Problem]:
    """Report prefixes of the root that are used nowhere else in the file."""
    root, source = subject.document.root, subject.document.source
    if not root.nsmap or subject.origins:
        return
    start = subject.document.starts[0]
    tag = _ROOT.match(source, start)
    for found in _NAMESPACE.finditer(source, start, tag.end() if tag else start):
        prefix = found[1] + b":"
        # What is left of xacro in a plain URDF is reported by MB105, its prefix as well.
        left = b"/xacro" in found[0] and (b"${" in source or b"$(" in source)
        if prefix not in source and not left:
            edit = Edit(found.start(), found.end(), b"", None)
            message = f"nothing in the file uses the prefix {found[1].decode()!r}"
            yield Problem(root, message, f"xmlns:{found[1].decode()}", "", (edit,))


@rule("MB146", "loose-xml", WARNING, formats=(URDF, SRDF, XACRO))
def loose_xml(subject: Subject) -> Iterator[Problem]:
    """Report what XML forbids, as the rewrite does; xacro itself cannot read it."""
    found = () if subject.origins else loosely_written(subject.document)
    level = ERROR if subject.format == XACRO else ""
    yield from (it._replace(level=level) for it in found)
