# SPDX-License-Identifier: Apache-2.0
"""Reading: what is refused and how it is said; where values stand in the bytes."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from counted_steps import growth

from multibot_rewrite import InputError, RewriteRefused, rewrite
from multibot_rewrite.base.bounded import MAX_BYTES
from multibot_rewrite.description.steps.document import attribute_slot, read_document, text_slot

ROBOT = b'<robot name="r"/>'
DECLARED = b'<?xml version="1.0"?>'


def laughs(levels: int) -> bytes:
    """Entities of which each is ten of the one before."""
    entities = [b'<!ENTITY e%d "%s">' % (n, b"&e%d;" % (n - 1) * 10) for n in range(1, levels + 1)]
    return b'<!DOCTYPE robot [<!ENTITY e0 "ha">' + b"".join(entities) + b"]>"


LAUGHS = laughs(12)
BAD = [
    pytest.param(b"hello, robot", "not XML", id="prose"),
    pytest.param(b'{"robot": 1}', "not XML", id="json"),
    pytest.param(b"", "empty", id="empty"),
    pytest.param(b" \n\t\r\n", "empty", id="white-space"),
    pytest.param(DECLARED, "XML", id="declaration-only"),
    pytest.param(b'<robot name="r"><link name="a"/>', "cut short", id="truncated"),
    pytest.param(b'<robot name="r"><link name="a', "correct the XML", id="truncated-in-a-value"),
    pytest.param(b"<robot><link></robot>", "mismatch", id="tags-mismatch"),
    pytest.param(ROBOT + ROBOT, "correct the XML", id="two-roots"),
    pytest.param(b'<robot name="a" name="b"/>', "redefined", id="attribute-twice"),
    pytest.param("<robot/>".encode("utf-16"), "-f UTF-16 -t UTF-8", id="utf16"),
    pytest.param(b"\xfe\xff" + "<robot/>".encode("utf-16-be"), "-f UTF-16", id="utf16-big"),
    pytest.param("<robot/>".encode("utf-16-le"), "-f UTF-16", id="utf16-little-no-bom"),
    pytest.param("<robot/>".encode("utf-16-be"), "-f UTF-16", id="utf16-big-no-bom"),
    pytest.param(
        b'<?xml version="1.0" encoding="ISO-8859-1"?><robot name="\xe9"/>',
        "iconv -f ISO-8859-1 -t UTF-8",
        id="latin1",
    ),
    pytest.param(b'<robot name="\xe9"/>', "UTF-8", id="latin1-undeclared"),
    pytest.param(b'<robot name="\xff\xfe"/>', "UTF-8", id="invalid-utf8"),
    pytest.param(b"<!DOCTYPE robot>" + ROBOT, "DOCTYPE", id="doctype"),
    pytest.param(b'<!DOCTYPE r SYSTEM "http://localhost/x">' + ROBOT, "DOCTYPE", id="doctype-url"),
    pytest.param(b'<!DOCTYPE r [<!ENTITY e "x">]>' + ROBOT, "DOCTYPE", id="entity"),
    pytest.param(
        b'<!DOCTYPE r [<!ENTITY e SYSTEM "file:///dev/null">]><robot>&e;</robot>',
        "DOCTYPE",
        id="entity-file",
    ),
    pytest.param(b"<robot>&nbsp;</robot>", "not defined", id="entity-undeclared"),
    pytest.param(LAUGHS + b"<robot>&e12;</robot>", "entit", id="laughs-in-text"),
    pytest.param(LAUGHS + b'<robot name="&e12;"/>', "entit", id="laughs-in-attribute"),
    pytest.param(LAUGHS + ROBOT, "DOCTYPE", id="laughs-unused"),
    pytest.param(b"<robot>" + b" " * MAX_BYTES, "over the limit", id="over-size"),
    pytest.param(b"<a>" * 5000 + b"</a>" * 5000, "nested", id="deep"),
    pytest.param(b'<?xml version="0.0"?>' + ROBOT, 'version="1.0"', id="version"),
    pytest.param(b"<robot><xacro:arg/></robot>", "xmlns:", id="undeclared-prefix"),
    pytest.param(b'<robot xacro:a="1"/>', "xmlns:", id="undeclared-attribute-prefix"),
    pytest.param(b"<a/>" + DECLARED + ROBOT, "delete what is before", id="markup-first"),
    pytest.param(b"<!--a-->" + DECLARED + ROBOT, "delete what is before", id="comment-first"),
    pytest.param(b"<robot>\0</robot>", "correct the XML", id="nul-in-text"),
    pytest.param(b'<robot name="a\0"/>', "correct the XML", id="nul-in-attribute"),
    pytest.param(ROBOT + b"\0", "correct the XML", id="nul-at-the-end"),
    pytest.param(b"\0" * 100, "no XML", id="nul-only"),
]


@pytest.mark.parametrize(("source", "words"), BAD)
def test_bad_input_is_one_line_with_a_remedy(source: bytes, words: str) -> None:
    with pytest.raises(InputError) as caught:
        rewrite(source, "r1", file="my.urdf")
    message = str(caught.value)
    assert re.match(r"my\.urdf:(\d+:\d+:)? ", message)
    assert words in message
    assert "\n" not in message
    assert ";" in message
    error = caught.value
    assert error.__context__ is None or error.__suppress_context__, "the parser's traceback shows"


@pytest.mark.more
@pytest.mark.parametrize(
    "source",
    [
        pytest.param(
            lambda size: laughs(size) + b"<robot>&e%d;</robot>" % size, id="laughs-in-text"
        ),
        pytest.param(lambda size: laughs(size) + b'<robot name="&e%d;"/>' % size, id="in-a-value"),
        pytest.param(lambda size: b"<a>" * 1000 * size + b"</a>" * 1000 * size, id="deep"),
    ],
)
def test_refusing_costs_no_more_than_the_text_is_long(source: Callable[[int], bytes]) -> None:
    def prepared(size: int) -> Callable[[], object]:
        return lambda: refused(source(size))

    assert growth(prepared, 3, 30) < 1.5


def refused(source: bytes) -> None:
    with pytest.raises(InputError):
        rewrite(source, "r1")


@pytest.mark.parametrize(
    "doctype",
    [
        pytest.param('<!DOCTYPE robot SYSTEM "{}">', id="system"),
        pytest.param('<!DOCTYPE robot PUBLIC "-//X" "{}">', id="public"),
        pytest.param('<!DOCTYPE robot [<!ENTITY % e SYSTEM "{}"> %e;]>', id="parameter-entity"),
    ],
)
def test_a_doctype_loads_no_file(tmp_path: Path, doctype: str) -> None:
    """What the file holds would show in the message, if only as an error in it."""
    other = tmp_path / "other.dtd"
    other.write_text("this is no DTD")
    with pytest.raises(InputError, match="DOCTYPE and entities are not accepted"):
        read_document(doctype.format(other).encode() + ROBOT, "my.urdf")


@pytest.mark.parametrize(
    ("source", "line", "column"),
    [
        pytest.param(b"<robot>\0</robot>", 1, 8, id="first-line"),
        pytest.param(b"<robot>\n  <a>\0</a>\n</robot>", 2, 6, id="second-line"),
        pytest.param(b"hello", 1, 1, id="start"),
    ],
)
def test_the_place_counts_from_one(source: bytes, line: int, column: int) -> None:
    with pytest.raises(InputError) as caught:
        read_document(source, "my.urdf")
    assert str(caught.value).startswith(f"my.urdf:{line}:{column}: ")


def test_the_size_in_the_message_is_over_the_limit() -> None:
    with pytest.raises(InputError) as caught:
        read_document(b"<robot>" + b" " * MAX_BYTES, "my.urdf")
    size, limit = (
        int(word.replace(",", "")) for word in re.findall(r"[\d,]{4,}", str(caught.value))
    )
    assert (size, limit) == (MAX_BYTES + 7, MAX_BYTES)


@pytest.mark.parametrize("frame", [b"%s", b"<robot>%s</robot>"])
def test_an_element_of_more_than_a_thousand_attributes_is_refused(frame: bytes) -> None:
    least, most = (b"".join(b' a%d=""' % n for n in range(count)) for count in (1000, 1001))
    read_document(frame % (b"<robot%s/>" % least), "my.urdf")
    with pytest.raises(InputError, match="1,001 attributes, over 1,000; leave some out"):
        read_document(frame % (b"<robot%s/>" % most), "my.urdf")


def test_another_root_is_refused() -> None:
    with pytest.raises(InputError, match=r"the root element is <html>, expected .*<robot>"):
        rewrite(b"<html/>", "r1")


@pytest.mark.parametrize(
    "head",
    [
        pytest.param(b"\xef\xbb\xbf", id="bom"),
        pytest.param(b"\xef\xbb\xbf" + DECLARED, id="bom-declared"),
        pytest.param(DECLARED + b"\r\n", id="declared"),
        pytest.param(b'<?xml version="1.0" encoding="utf-8"?>', id="utf8"),
        pytest.param(b'<?xml version="1.0" encoding="ISO-8859-1"?>', id="latin1-but-ascii"),
        pytest.param(b"<!-- <link name='x'> -->\n", id="comment"),
        pytest.param(b"\n\n", id="blank-lines"),
    ],
)
def test_what_stands_before_the_root_is_kept(head: bytes) -> None:
    data = rewrite(head + b"<robot name='r'><link name='a'/></robot>\r\n", "r1").data
    assert data == head + b"<robot name='r_r1'><link name='a/r1'/></robot>\r\n"


@pytest.mark.parametrize(
    "source",
    [
        pytest.param(b"<r><a/><!-- <x> <y/> --><b/></r>", id="comment"),
        pytest.param(b"<r><a/><![CDATA[<x>]]><b/></r>", id="cdata"),
        pytest.param(b"<r><a/><?go <x ?><b/></r>", id="instruction"),
        pytest.param(b"<?go <x ?><r><a/></r>", id="instruction-first"),
        pytest.param(DECLARED + b"<?go <x ?><r/><!--<x>--><?go <x?>", id="around"),
        pytest.param(b"<!--<x>--><r/>", id="comment-first"),
        pytest.param(b"<r><!-- <![CDATA[ --><a/><!-- ]]> --></r>", id="cdata-in-comments"),
        pytest.param(b"<r><![CDATA[<!--]]><a/><![CDATA[-->]]></r>", id="comments-in-cdata"),
        pytest.param(b"<r><?go <!-- ?><a/><?go --> ?></r>", id="comment-in-instructions"),
        pytest.param(b"<r><!-- ?> <? --><a/><?go ?></r>", id="instruction-in-comment"),
        pytest.param(b"<r a='>' b=\"-->\"><a b='?>'/>]]&gt;</r>", id="ends-in-values"),
        pytest.param("<r><ä/><_b/><x:c xmlns:x='x'/></r>".encode(), id="names"),
        pytest.param(b"<r\n><a\n/></r\n>", id="line-breaks"),
        pytest.param(b"\xef\xbb\xbf<r><!--<x--><a/></r>", id="bom"),
    ],
)
def test_starts_are_those_of_the_elements(source: bytes) -> None:
    document = read_document(source, "")
    tags = [str(element.tag).rpartition("}")[2] for element in document.root.iter("*")]
    found = [re.match(rb"<(?:\w+:)?([^\s/>]+)", source[at:]) for at in document.starts]
    assert [match[1].decode() for match in found if match] == tags


def marked(text: str) -> tuple[bytes, tuple[int, int]]:
    """Return the text without its «» and where they stood, in bytes."""
    head, _, rest = text.partition("«")
    inside, _, tail = rest.partition("»")
    begin = len(head.encode())
    return (head + inside + tail).encode(), (begin, begin + len(inside.encode()))


@pytest.mark.parametrize(
    "text",
    [
        pytest.param('<a n="«x»"/>', id="plain"),
        pytest.param("<a n='«x»'/>", id="single"),
        pytest.param('<a n = "«x»" />', id="spaces"),
        pytest.param('<a\n\tn\n=\n"«x»"\n/>', id="line-breaks"),
        pytest.param('<a m="1"\r\n   n="«x»"\r\n/>', id="second-line"),
        pytest.param("<a n='«x\"y»'/>", id="quote-in-single"),
        pytest.param('<a n="«x\'y»"/>', id="single-in-quotes"),
        pytest.param('<a m=">" n="«x»"/>', id="greater-before"),
        pytest.param('<a n="«x>y»" m=">"/>', id="greater-inside"),
        pytest.param('<a n="«x&amp;y»"/>', id="ampersand"),
        pytest.param('<a n="«x&#10;y»"/>', id="line-feed"),
        pytest.param('<a n="«&#x78;»"/>', id="hexadecimal"),
        pytest.param('<a n="«&quot;x&quot;»"/>', id="quotes"),
        pytest.param('<a n="«x\ny»"/>', id="line-break-inside"),
        pytest.param('<a n="«x\ty»"/>', id="tab-inside"),
        pytest.param('<a n="« x »"/>', id="blanks-inside"),
        pytest.param('<a n="«»"/>', id="empty"),
        pytest.param('<a ä="1" n="«腕»"/>', id="not-ascii"),
        pytest.param('<a nn="x" n_="x" n="«x»"/>', id="longer-names"),
        pytest.param('<a m=\'n="x"\' n="«x»"/>', id="at-the-start-of-a-value"),
        pytest.param('<a m=\' n="x"\' n="«x»"/>', id="in-a-value"),
        pytest.param("<a m=\" n='x'\" n='«x»'/>", id="in-a-value-single"),
        pytest.param("<a m=\" n='y'\" n='«x»'/>", id="another-in-a-value"),
        pytest.param("<a m=' n=\"x\">' n='«x»'/>", id="in-a-value-with-greater"),
        pytest.param('<!-- <a n="x"/> --><a n="«x»"/>', id="in-a-comment"),
        pytest.param('<a n = "«x»"><b n="x"/></a>', id="plain-in-a-child"),
        pytest.param("<a n='«x»'>n=\"x\"</a>", id="in-the-text"),
    ],
)
def test_where_an_attribute_stands(text: str) -> None:
    source, place = marked(text)
    document = read_document(source, "")
    value = document.root.get("n")
    assert value is not None
    assert attribute_slot(source, document.starts[0], "n", value) == place


@pytest.mark.parametrize(
    "text",
    [
        pytest.param("<a>«x»</a>", id="plain"),
        pytest.param("<a> \r\n\t«x» \n</a>", id="white-space"),
        pytest.param("<a b='>'>«x»</a>", id="greater"),
        pytest.param('<a b=">x">«x»</a>', id="same-in-a-value"),
        pytest.param("<a\n  b='1'\n>\n  «x»\n</a>", id="tag-over-lines"),
        pytest.param("<a>«x&amp;y»</a>", id="ampersand"),
        pytest.param("<a>«&#120;»</a>", id="reference"),
        pytest.param("<a>«x>y»</a>", id="greater-inside"),
        pytest.param("<a>«x y\nz»</a>", id="words"),
        pytest.param("<!--<a>x</a>--><a>«x»</a>", id="in-a-comment"),
        pytest.param("<a>«x»<!-- x --></a>", id="before-a-comment"),
        pytest.param("<a>«x»<b>x</b>x</a>", id="before-a-child"),
        pytest.param("<a>«腕»</a>", id="not-ascii"),
    ],
)
def test_where_a_text_stands(text: str) -> None:
    source, place = marked(text)
    document = read_document(source, "")
    value = (document.root.text or "").strip()
    assert text_slot(source, document.starts[0], value) == place


@pytest.mark.parametrize(
    "text",
    [
        pytest.param("<a><![CDATA[x]]></a>", id="cdata"),
        pytest.param("<a>x<![CDATA[y]]></a>", id="half-cdata"),
        pytest.param("<a>x\r\ny</a>", id="crlf"),
    ],
)
def test_a_text_that_does_not_read_back_is_not_edited(text: str) -> None:
    document = read_document(text.encode(), "")
    place = text_slot(document.source, document.starts[0], document.root.text or "")
    assert place is None or b"\r\n" in document.source[slice(*place)]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param('name="a&amp;b"', 'name="a&amp;b/r1"', id="ampersand"),
        pytest.param('name="a&#10;b"', 'name="a&#10;b/r1"', id="line-feed"),
        pytest.param('name="&#97;"', 'name="&#97;/r1"', id="reference"),
        pytest.param("name='a\"b'", "name='a\"b/r1'", id="quote"),
        pytest.param('name="a\nb"', 'name="a\nb/r1"', id="line-break"),
        pytest.param("m='>' name='a'", "m='>' name='a/r1'", id="greater"),
        pytest.param('m=\' name="a"\' name="a"', 'm=\' name="a"\' name="a/r1"', id="in-a-value"),
        pytest.param("\n  name = 'a'\n  ", "\n  name = 'a/r1'\n  ", id="over-lines"),
    ],
)
def test_a_link_is_renamed_in_any_spelling(old: str, new: str) -> None:
    text = '<robot name="r"><link {}/></robot>'
    assert rewrite(text.format(old), "r1").text == text.format(new).replace('"r"', '"r_r1"')


TEXT = """<robot name="r"><link name="base"/><joint name="j" type="fixed"/>
<!-- <canonicalBody>base</canonicalBody> --><gazebo>
<canonicalBody{}</canonicalBody></gazebo></robot>"""


def test_cdata_is_refused_by_place() -> None:
    with pytest.raises(RewriteRefused, match=r":3:1: error: MB104 'base' cannot be edited"):
        rewrite(TEXT.format("><![CDATA[base]]>"), "r1")
