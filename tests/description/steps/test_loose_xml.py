# SPDX-License-Identifier: Apache-2.0
"""What TinyXML-2 reads is read, said, changed in no other byte, and the consumers read it as before."""

from __future__ import annotations

import random
import re
import shutil
import subprocess
from contextlib import suppress
from pathlib import Path

import pytest
from urdfdom_cases import CHECK, check_urdf

from multibot_rewrite import InputError, rewrite, strip
from multibot_rewrite.base import loose_xml
from multibot_rewrite.base.loose_xml import MAX_PREFIXES, well_formed
from multibot_rewrite.description.steps.document import Document, read_document

CODE = "MB146"
IGN = next(filter(None, map(shutil.which, ("gz", "ign"))), "")
DECLARATION = '<?xml version="1.0"?>'
URDF = (
    '<robot name="r"{0}><link name="a"/><link name="b"/><joint name="j" type="fixed">'
    '<parent link="a"/><child link="b"/></joint>{1}</robot>'
)
SDF = (
    '<sdf version="1.6"{0}><model name="r"><link name="a"/><link name="b"/>'
    '<joint name="j" type="fixed"><parent>a</parent><child>b</child></joint>{1}</model></sdf>'
)
# The text before the root, more attributes of the root, more in the robot, words of the warning.
LOOSE = {
    "prefix-of-an-attribute": (DECLARATION, "", '<x gz:y="1"/>', "'gz'"),
    "prefix-of-an-element": (DECLARATION, "", "<my:own>1</my:own>", "'my'"),
    "prefix-bound-elsewhere": (DECLARATION, "", '<c:d xmlns:c="u"/><c:d/>', "'c'"),
    "hyphens": (DECLARATION, "", "<!-- a -- b ---><!-- c --- -->", "-- in a comment in line 1"),
    "blank-line-first": ("\n\n" + DECLARATION, "", "", "XML declaration"),
    "declared-twice": (DECLARATION + DECLARATION, "", "", "XML declaration"),
    "default-namespace": (DECLARATION, ' xmlns="http://a.b"', "", "default namespace"),
    "all": ("\n" + DECLARATION, ' xmlns="u"', '<!-- -- --><o:p q:r="xmlns=1"/>', "'o'"),
}
# What TinyXML-2 refuses as well, or what another reader has to expand first.
FAULTS = {
    "comment-before-the-declaration": ("<!-- a -->" + DECLARATION, "", ""),
    "declaration-inside": ("", "", DECLARATION),
    "end-tag": (DECLARATION, "", '<!-- -- --><gz:a b:c="1"></gz:b>'),
    "open-comment": (DECLARATION, "", "<!-- a -- b"),
    "attribute-twice": (DECLARATION, "", '<gz:a b="1" b="2"/>'),
    "xacro": (DECLARATION, "", "<xacro:if value='1'/>"),
}


def made(form: str, start: str, attributes: str, inside: str) -> bytes:
    return f"{start}{form.format(attributes, inside)}".encode()


def ign_reads(data: bytes, folder: Path) -> bool:
    file = folder / "model.sdf"
    file.write_bytes(data)
    run = [IGN, "sdf", "-k", str(file)]
    return "Valid." in subprocess.run(run, capture_output=True, text=True, check=False).stdout


@pytest.mark.parametrize("form", [URDF, SDF], ids=("urdf", "sdf"))
@pytest.mark.parametrize("name", LOOSE)
def test_it_is_rewritten_byte_by_byte_and_said(name: str, form: str) -> None:
    *parts, words = LOOSE[name]
    data = made(form, *parts)
    done = rewrite(data, "r1")
    assert words in " ".join(it.message for it in done.findings if it.code == CODE)
    assert strip(done.data, "r1") == data
    # Nothing but names is other than in the well-formed robot.
    plain = rewrite(made(form, DECLARATION, "", ""), "r1").data
    names = re.compile(rb"[\w/]*r1\b")
    assert names.findall(done.data) == names.findall(plain)


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_that_all_readers_have_is_refused(name: str) -> None:
    with pytest.raises(InputError, match="not well-formed"):
        rewrite(made(URDF, *FAULTS[name]), "r1")


def test_what_is_written_in_values_and_texts_is_no_name() -> None:
    """A default namespace in a value, hyphens and prefixes in CDATA and in texts stay."""
    inner = b"<a b=\" xmlns='u' -- c:d=1\">e:f<![CDATA[<!-- a--b --><g:h/>]]></a>"
    data = b'<robot name="r">%s</robot>' % inner
    assert well_formed(data).text == data
    assert not [it for it in rewrite(data, "r1").findings if it.code == CODE]


@pytest.mark.skipif(CHECK is None, reason="check_urdf is missing: pip install pin")
@pytest.mark.parametrize(
    "name", [*LOOSE, *(it for it in FAULTS if it not in ("xacro", "attribute-twice"))]
)
def test_urdfdom_reads_what_is_read_here(name: str, tmp_path: Path) -> None:
    """``xacro`` is for xacro to read; the second of two attributes is nothing to TinyXML-2."""
    if name in FAULTS:
        assert not check_urdf(made(URDF, *FAULTS[name]).decode(), tmp_path).reads
        return
    data = made(URDF, *LOOSE[name][:3])
    assert check_urdf(data.decode(), tmp_path).reads
    assert check_urdf(rewrite(data, "r1").text, tmp_path).reads


@pytest.mark.slow
@pytest.mark.skipif(
    not IGN, reason="libsdformat is missing: apt install ignition-tools libsdformat-dev"
)
@pytest.mark.parametrize("name", LOOSE)
def test_libsdformat_reads_what_is_read_here(name: str, tmp_path: Path) -> None:
    data = made(SDF, *LOOSE[name][:3])
    assert ign_reads(data, tmp_path)
    assert ign_reads(rewrite(data, "r1").data, tmp_path)


@pytest.mark.more
@pytest.mark.parametrize("part", [b"<a ", b"<!--", b"<![CDATA[", b"<?xml ", b"<?xml ?>", b"<a b='"])
def test_a_text_made_to_hurt_is_looked_at_once(part: bytes) -> None:
    """Each would take hours if every part were looked for up to the end of the text."""
    text = b"\n" + part * 200_000
    assert len(well_formed(text).text) == len(text)


def test_no_robot_has_that_many_prefixes() -> None:
    names = [f"<p{at}:a/>" for at in range(MAX_PREFIXES + 1)]
    with pytest.raises(InputError, match="Namespace prefix"):
        rewrite(made(URDF, "", "", "".join(names)), "r1")
    assert rewrite(made(URDF, "", "", "".join(names[1:])), "r1").data


PIECES = (
    b"<!--",
    b"-->",
    b"-",
    b"--",
    b"<?xml version='1.0'?>",
    b"\xef\xbb\xbf",
    b" ",
    b"<a>",
    b"a",
)
CLOSED = (*(it for it in PIECES if it != b"<a>"), b"<a/>", b"<a b='xmlns='/>", b"<a xmlns='x'/>")


@pytest.mark.more
def test_a_text_that_is_read_as_it_is_has_no_slips() -> None:
    chance = random.Random(5)
    parts = (b"".join(chance.choices(CLOSED, k=chance.randint(0, 6))) for _ in range(6000))
    texts = [b"%b<robot>%b</robot>" % pair for pair in zip(parts, parts, strict=True)]
    read = [document for it in texts if (document := _document(it))]
    plain = [it.source for it in read if not it.is_mended]
    assert 50 < len(plain) < len(read) - 50
    assert not [it for it in plain if any(loose_xml.slips(it))]


def _document(text: bytes) -> Document | None:
    with suppress(InputError):
        return read_document(text, "r.urdf")
    return None
