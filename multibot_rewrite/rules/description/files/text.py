# SPDX-License-Identifier: Apache-2.0
"""The XML declaration, byte order mark and namespaces."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.findings.rule import SRDF, URDF, XACRO, rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.markup import ATTRIBUTES
from multibot_rewrite.base.model import Edit
from multibot_rewrite.description.checks.loose import loosely_written
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.rules.subject import Subject

BOM = b"\xef\xbb\xbf"
# Of nearly all files, which spares them the two expressions below.
_ENCODINGS = (b"", b" ", b' encoding="utf-8"', b' encoding="UTF-8"')
_USUAL = tuple(b'<?xml version="1.0"%b?>' % it for it in _ENCODINGS)
_DECLARED = lazy_compile(rb"<\?xml\s+version\s*=\s*[\"']([^\"']*)[\"']")
_ENCODED = lazy_compile(rb"<\?xml\s[^<>]*?\sencoding\s*=\s*[\"']([^\"'<]*)[\"']")
_NAMESPACE = lazy_compile(rb"(?<!\s)\s+xmlns:([\w.-]+)\s*=\s*(?:\"[^\"]*\"|'[^']*')")
_ROOT = lazy_compile(rb"<robot\b" + ATTRIBUTES + rb">")


@rule(
    "MB140",
    "xml-declaration",
    WARNING,
    what="The XML declaration names a version other than 1.0, or an encoding other than UTF-8.",
    why="urdfdom and Gazebo read the file as UTF-8, whatever it declares. expat (xacro, Python "
    "launch files) rejects encodings such as gb2312 and decodes letters differently.",
    fix='Write <?xml version="1.0" encoding="UTF-8"?>.',
    bad='<?xml version="1.0" encoding="ISO-8859-1"?><robot name="r"><link name="a"/></robot>',
    good='<?xml version="1.0" encoding="utf-8"?><robot name="r"><link name="a"/></robot>',
    fixed='<?xml version="1.0" encoding="UTF-8"?><robot name="r"><link name="a"/></robot>',
)
def xml_declaration(subject: Subject) -> Iterator[Problem]:
    """With a fix: a file of another encoding that was read at all is plain ASCII."""
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


@rule(
    "MB141",
    "byte-order-mark",
    NOTE,
    what="The file starts with a byte order mark.",
    why="UTF-8 needs none. XML parsers skip it at the start of a file, but reject it where a "
    "script or template puts the description after other text.",
    fix="Save the file as UTF-8 without it.",
    bad='\ufeff<robot name="r"><link name="a"/></robot>',
    good='<robot name="r"><link name="a"/></robot>',
    fixed='<robot name="r"><link name="a"/></robot>',
)
def byte_order_mark(subject: Subject) -> Iterator[Problem]:
    """With a fix."""
    if subject.document.source.startswith(BOM):
        edit = Edit(0, len(BOM), b"", None)
        root = subject.document.root
        yield Problem(root, "the file starts with a byte order mark", None, "", (edit,))


@rule(
    "MB142",
    "unused-namespace",
    NOTE,
    what="The root element declares a namespace prefix that the file does not use.",
    why="It has no effect. A xacro prefix in a plain URDF makes programs look for macros that do "
    "not exist.",
    fix="Delete the declaration.",
    bad='<robot name="r" xmlns:drake="http://drake.mit.edu"><link name="a"/></robot>',
    good='<robot name="r" xmlns:drake="http://drake.mit.edu"><drake:joint name="j"/></robot>',
    fixed='<robot name="r"><link name="a"/></robot>',
)
def unused_namespace(subject: Subject) -> Iterator[Problem]:
    """Prefixes of the root that are written nowhere else in the file."""
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


@rule(
    "MB146",
    "loose-xml",
    WARNING,
    what="A prefix that nothing declares (gz:type), -- in a comment, an XML declaration behind blank "
    "lines, or a default namespace (xmlns=).",
    why="urdfdom, sdformat and ros2_control read XML with TinyXML-2, which takes it: a prefix is "
    "part of the name. xacro, launch files and spawn_entity.py of Gazebo Classic read it with "
    "Python's parsers. These reject the first three, and find no <link> in a default namespace. In "
    "a xacro file it is an error.",
    fix='Declare the prefix on the root element, as xmlns:gz="http://gazebosim.org/schema"; write == '
    "for --; delete what is before <?xml, and the default namespace.",
    bad='<link name="a"/>\n<!-- old -- and wrong -->\n<link name="b"/>',
    good='<link name="a"/>\n<!-- old and wrong -->\n<link name="b"/>',
    line=3,
    formats=(URDF, SRDF, XACRO),
)
def loose_xml(subject: Subject) -> Iterator[Problem]:
    """As the rewrite says it; xacro itself cannot read what is wrong here."""
    found = () if subject.origins else loosely_written(subject.document)
    level = ERROR if subject.format == XACRO else ""
    yield from (it._replace(level=level) for it in found)
