# SPDX-License-Identifier: Apache-2.0
"""The SDF specification's own description files -> ``rules/schema/sdf.schema``.

A checkout of sdformat has ``sdf/VERSION/*.sdf``, one folder a version: which elements there are, what
they hold, from where to where, and what is required. What its C++ adds is read beside them: the words
of enumerations, and the tags that ``parser_urdf.cc`` takes out of a ``<gazebo>`` itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.model import UsageError

# Older ones are not met any more.
OLDEST = (1, 4)
ROOTS = ("model", "link", "joint", "world")
HEAD = """\
# What SDF has in each element, by version. Made by
# python -m tools.interfaces --sdf sdformat@TAG > multibot_rewrite/rules/schema/sdf.schema
#
#   [section] FILE                        an element's children and attributes; FILE is sdf/VERSION/FILE
#   NAME TYPE LINE [>SECTION] [VERSIONS] [required] [MIN..MAX] [=DEFAULT]
#                                         @NAME is an attribute, TYPE is - for an element of elements,
#                                         VERSIONS are FIRST-LAST where not all have it
#   [words SECTION/NAME...] PATH [folded] a word that the library knows for a value, and its LINE;
#                                         folded: in capitals, too
#   [urdf] PATH                           what URDF's converter takes out of a <gazebo>: NAME TYPE LINE
#
# Source: gazebosim/sdformat {tag}
"""
# Where the library has the words of a value: the file, the names of arrays and variables, and
# whether it takes capitals too.
WORDS = {
    "sensor/@type": ("src/Sensor.cc", ("kSensorTypeStrs", "type"), False),
    "forcetorque/frame": ("src/ForceTorque.cc", ("frame",), False),
    "forcetorque/measure_direction": ("src/ForceTorque.cc", ("direction",), False),
    "camera.image/format": ("src/Camera.cc", ("kPixelFormatNames", "_format"), False),
    "joint/@type": ("src/Joint.cc", ("first",), True),
    "light/@type": ("src/Light.cc", ("typeString",), False),
    "noise/@type camera.noise/type ray.noise/type lidar.noise/type": (
        "src/Noise.cc",
        ("typeLower",),
        True,
    ),
}
# gz-sensors, and imu.sdf for the last two, which it refuses.
LOCALIZATION = """
[words imu.orientation_reference_frame/localization] gazebosim/gz-sensors src/ImuSensor.cc
ENU 172
NED 175
NWU 177
CUSTOM 179
GRAV_UP 182
GRAV_DOWN 182"""
CONVERTER = "src/parser_urdf.cc"
_TAKEN = re.compile(r'strcmp\(childElem->Name\(\), "(\w+)"\) == 0')
_BLOBS = ("visual", "collision", "material")


class Row(NamedTuple):
    """What one version says of a child or attribute; ``section`` has what is below it."""

    type: str
    line: int
    section: str
    required: bool
    range: str
    default: str


Rows = dict[tuple[str, str], dict[tuple[int, ...], Row]]


def to_schema(folder: Path) -> str:
    """The text of ``sdf.schema``; raises UsageError for what is no checkout of sdformat."""
    if not (folder / "sdf").is_dir() or "@" not in folder.name:
        raise UsageError(f"{folder}: not a checkout of sdformat called sdformat@TAG")
    versions = sorted(_version(it.name) for it in (folder / "sdf").glob("1.*"))
    versions = [it for it in versions if it >= OLDEST]
    rows: Rows = {}
    for version in versions:
        files = folder / "sdf" / ".".join(map(str, version))
        for name in ROOTS:
            _read_file(files, name, version, rows, set())
    lines = [HEAD.format(tag=folder.name.partition("@")[2])]
    lines += _sections(rows, versions)
    lines += _words(folder)
    lines += _converter((folder / CONVERTER).read_text(encoding="utf-8"))
    return "\n".join(lines) + "\n"


def _version(name: str) -> tuple[int, ...]:
    return tuple(map(int, name.split(".")))


def _read_file(
    files: Path, name: str, version: tuple[int, ...], rows: Rows, seen: set[str]
) -> None:
    """A file and those it includes; its stem is the name of its section."""
    path = files / f"{name}.sdf"
    if name in seen or not path.exists():
        return
    seen.add(name)
    root = etree.parse(str(path)).getroot()
    for other in _read_element(root, name, version, rows, files):
        _read_file(files, other, version, rows, seen)


def _read_element(
    element: etree._Element, section: str, version: tuple[int, ...], rows: Rows, files: Path
) -> Iterator[str]:
    """Fills in the rows of an element; the names of the files that it includes."""
    for child in element.iterchildren("attribute", "element", "include"):
        is_file = child.tag == "include"
        below = child.get("filename", "").removesuffix(".sdf") or child.get("ref", "")
        it = _included(files / f"{below}.sdf", child) if is_file else child
        tag = _tag(it)
        if is_file:
            yield below
        elif not below and it.tag == "element" and len(it) > 1:
            below = f"{section}.{tag}"
            yield from _read_element(it, below, version, rows, files)
        if it.get("required") != "-1":
            rows.setdefault((section, tag), {})[version] = _row(it, below)


def _tag(element: etree._Element) -> str:
    """How a row calls it: an attribute has an @, and any child that is copied is ``*``."""
    name = element.get("name", "")
    if element.get("copy_data"):
        return "*"
    return f"@{name}" if element.tag == "attribute" else name


def _included(path: Path, include: etree._Element) -> etree._Element:
    """The root of an included file, with the line and the number of the include."""
    root = etree.parse(str(path)).getroot()
    root.set("required", include.get("required", "0"))
    root.sourceline = include.sourceline
    return root


def _row(element: etree._Element, section: str) -> Row:
    low, high = element.get("min"), element.get("max")
    default = element.get("default", "")
    return Row(
        (element.get("type") or "-").replace(" ", "_"),
        element.sourceline or 0,  # type: ignore[arg-type]
        section,
        element.get("required") in ("1", "+"),
        f"{low or ''}..{high or ''}" if (low or high) and " " not in f"{low}{high}" else "",
        "" if default == "__default__" else default,
    )


def _sections(rows: Rows, versions: list[tuple[int, ...]]) -> Iterator[str]:
    for section in sorted({section for section, _ in rows}):
        yield f"\n[{section}] {section.partition('.')[0]}.sdf"
        for (own, tag), by_version in rows.items():
            if own == section:
                yield from _lines(tag, by_version, versions)


def _lines(
    tag: str, rows: Mapping[tuple[int, ...], Row], versions: list[tuple[int, ...]]
) -> Iterator[str]:
    """A line for each group of versions that say the same; the line number is the last one's."""
    groups: list[list[tuple[int, ...]]] = []
    for version in versions:
        if version not in rows:
            continue
        same = groups and rows[groups[-1][-1]]._replace(line=0) == rows[version]._replace(line=0)
        before = versions[versions.index(version) - 1]
        if same and groups[-1][-1] == before:
            groups[-1].append(version)
        else:
            groups.append([version])
    for group in groups:
        yield _line(tag, rows[group[-1]], "" if group == versions else _span(group))


def _span(group: list[tuple[int, ...]]) -> str:
    return "-".join(".".join(map(str, it)) for it in (group[0], group[-1]))


def _line(tag: str, row: Row, span: str) -> str:
    words = (
        *(tag, row.type, str(row.line), row.section and f">{row.section}", span),
        *("required" * row.required, row.range, row.default and f"={row.default}"),
    )
    return " ".join(it for it in words if it)


def _words(folder: Path) -> Iterator[str]:
    """The words of enumerations, from arrays and from what a variable is compared with."""
    for name, (path, variables, folded) in WORDS.items():
        if name == "light/@type":
            yield LOCALIZATION
        text = (folder / path).read_text(encoding="utf-8")
        yield f"\n[words {name}] {path}{' folded' * folded}"
        found: dict[str, int] = {}
        for at, word in _known_words(text, variables):
            found.setdefault(word, text.count("\n", 0, at) + 1)
        yield from (f"{word} {line}" for word, line in found.items() if not word.startswith("UNKN"))


def _known_words(text: str, variables: Iterable[str]) -> Iterator[tuple[int, str]]:
    for variable in variables:
        array = re.search(rf"\b{variable}\s*=\s*\{{([^}}]*)\}}", text)
        for it in re.finditer(r'"(\w+)"', array[1]) if array else ():
            yield (array.start(1) if array else 0) + it.start(), it[1]
        for it in re.finditer(rf'\b{variable} == "(\w+)"', text):
            yield it.start(), it[1]


def _converter(text: str) -> Iterator[str]:
    """The tags that the converter of URDF reads itself, and what it makes of their values."""
    yield f"\n[urdf] {CONVERTER}"
    found = list(_TAKEN.finditer(text))
    ends = [it.start() for it in found[1:]] + [len(text)]
    lines: dict[str, str] = {}
    for it, end in zip(found, ends, strict=True):
        line = text.count("\n", 0, it.start()) + 1
        lines.setdefault(it[1], f"{it[1]} {_taken_as(text[it.end() : end])} {line}")
    yield from (line for tag, line in lines.items() if tag not in _BLOBS)


def _taken_as(code: str) -> str:
    """What the code between this tag and the next one makes of the value."""
    branch = code.partition("else if (strcmp")[0]
    if "std::stod" in branch or "std::stoi" in branch:
        return "double"
    return "truth" if '"true"' in branch or '"false"' in branch else "string"
