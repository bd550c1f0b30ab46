# SPDX-License-Identifier: Apache-2.0
"""Replaces ``<include>`` in the models of an SDF by the included model, as Gazebo does.

With ``merge="true"`` it is the parts of the model. Sources: gazebosim/sdformat src/parser.cc
(readXml, insertIncludedElement, merged parts get the frame ``_merged__NAME__model__``),
src/SDF.cc (findFile: SDF_PATH), gazebosim/gz-sim src/Util.cc (resourcePaths:
GZ_SIM_RESOURCE_PATH, IGN_GAZEBO_RESOURCE_PATH). What is inserted is in one line: every line
keeps its number."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from copy import deepcopy

from lxml import etree
from lxml.etree import _Element

from multibot_rewrite.base.bounded import MAX_BYTES, read_bytes
from multibot_rewrite.base.lazy import COMMENT, lazy_compile
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.outside import is_file, outside, real_path, variable
from multibot_rewrite.description.rewriters.text import text_at
from multibot_rewrite.description.steps.document import Document, read_document

VARIABLES = ("GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH", "GAZEBO_MODEL_PATH")
# An include of an include, and so on.
_DEEPEST = 10
_OWN = "__model__"
_MERGED = frozenset({"link", "model", "joint", "frame", "gripper", "plugin"})
# Before 1.7 a pose had a frame, and an axis that of the model above: not the same text in a new file.
_OLD = lazy_compile(rb"\bframe\s*=|use_parent_model_frame")
_SPACES = lazy_compile(rb"(?<!\s)\s*\n\s*")
_END = lazy_compile(COMMENT + rb"|</include\s*>|<include\b[^<>]*/>")


def with_includes(data: bytes, file: str, above: tuple[str, ...] = ()) -> bytes:
    """Return the text of a model with each included model in it that is found; others stay.

    ``above``: the files that include this one. Raises InputError if a model includes itself.
    """
    document = _try_read(data, file) if b"<include" in data and len(above) <= _DEEPEST else None
    if document is None or document.root.tag != "sdf" or document.root.find("world") is not None:
        return data
    above = (*above, real_path(file))
    source, last = document.source, 0
    done: list[bytes] = []
    for element, start in zip(document.elements, document.starts, strict=True):
        parent = element.getparent()
        if element.tag != "include" or parent is None or parent.tag != "model":
            continue
        made = _included_text(element, document.file, above)
        end = next((it.end() for it in _END.finditer(source, start) if it[0][:4] != b"<!--"), 0)
        if made and end and len(made) + len(source) <= MAX_BYTES:
            done += (source[last:start], made, b"\n" * source.count(b"\n", start, end))
            last = end
    return b"".join((*done, source[last:]))


def _included_text(include: _Element, file: str, above: tuple[str, ...]) -> bytes:
    """Return the text in place of an include; nothing if its model is not found or too new."""
    uri = text_at(include, "uri")
    path = model_file(uri, os.path.dirname(os.path.abspath(file)))
    if not path:
        return b""
    if real_path(path) in above:
        raise InputError(
            f"{file}:{include.sourceline}: {uri!r} leads back to the model that includes it, and "
            "Gazebo reads until its memory is full; leave out one of the <include>"
        )
    data = with_includes(_bytes_or_empty(path), path, above)
    root = _root_without_comments(data, path)
    model = root.find("model") if root is not None else None
    if root is None or model is None or (_version_numbers(root) < (1, 7) and _OLD.search(data)):
        return b""
    if next(model.iter("include"), None) is not None:  # it would be lost
        return b""
    model = deepcopy(model)
    # A path of a mesh or picture is looked up beside the file that names it.
    folder = os.path.dirname(path)
    for element in model.iter("uri", "filename", "albedo_map", "normal_map"):
        text = (element.text or "").strip()
        if text and "://" not in text and is_file(os.path.join(folder, text)):
            element.text = "file://" + os.path.join(folder, text)
    is_merged = include.get("merge", "").strip().lower() in ("true", "1")
    parts = _merged(include, model) if is_merged else [_nested(include, model)]
    return b"".join(_SPACES.sub(b" ", etree.tostring(it, with_tail=False)) for it in parts)


def _try_read(data: bytes, path: str) -> Document | None:
    with suppress(InputError):
        return read_document(data, path)
    return None


def _root_without_comments(data: bytes, path: str) -> _Element | None:
    document = _try_read(data, path)
    if document is None:
        return None
    etree.strip_tags(document.root, etree.Comment)
    return document.root


def _nested(include: _Element, model: _Element) -> _Element:
    """Return the model with the name, pose and plugins of its include."""
    model.set("name", _model_name(include, model))
    if text_at(include, "placement_frame"):
        model.set("placement_frame", text_at(include, "placement_frame"))
    for tag in ("pose", "static"):
        given = include.find(tag)
        if given is not None:
            model[:] = [it for it in model if it.tag != tag]
            model.append(deepcopy(given))
    model.extend(deepcopy(it) for it in include.iterchildren("plugin"))
    return model


def _merged(include: _Element, model: _Element) -> Iterator[_Element]:
    """Yield the parts of the model, placed from a frame in its place."""
    proxy = f"_merged__{_model_name(include, model)}__model__"
    first = model.find("link")
    usual = first.get("name", "") if first is not None else ""
    frame = etree.Element("frame", name=proxy, attached_to=model.get("canonical_link") or usual)
    given = include.find("pose") if include.find("pose") is not None else model.find("pose")
    pose = deepcopy(given) if given is not None else etree.Element("pose")
    pose.set("relative_to", pose.get("relative_to") or _OWN)
    frame.append(pose)
    yield frame
    for part in (*model, *(deepcopy(it) for it in include.iterchildren("plugin"))):
        if part.tag in _MERGED:
            _placed(part, proxy)
            yield part


def _placed(part: _Element, proxy: str) -> None:
    """Redirect the references of a part to its model to the frame for the model."""
    if part.tag in ("link", "model") and part.find("pose") is None:
        etree.SubElement(part, "pose").text = "0 0 0 0 0 0"
    if part.tag == "frame" and part.get("attached_to", _OWN) == _OWN:
        part.set("attached_to", proxy)
    for pose in part.iterchildren("pose"):
        told = pose.get("relative_to", "")
        if told == _OWN or (not told and part.tag in ("link", "model")):
            pose.set("relative_to", proxy)
    for end in part.iterchildren("parent", "child") if part.tag == "joint" else ():
        if (end.text or "").strip() == _OWN:
            end.text = proxy
    for axis in part.iterfind(".//xyz[@expressed_in]"):
        if axis.get("expressed_in") == _OWN:
            axis.set("expressed_in", proxy)


def _model_name(include: _Element, model: _Element) -> str:
    return text_at(include, "name") or model.get("name", "")


def model_file(uri: str, folder: str) -> str:
    """Return the file of an included model, looked up as Gazebo does, then near the file's folder."""
    name = uri.removeprefix("model://").strip("/")
    if not name or "://" in name or name.startswith("/") or ".." in name.split("/"):
        return ""
    above = os.path.dirname(folder)
    beside = (folder, above, os.path.join(above, "models"))
    paths = os.pathsep.join(variable(name) or "" for name in VARIABLES)
    for home in (*[it for it in paths.split(os.pathsep) if it], *beside):
        if found := _in_folder(os.path.join(home, name)):
            return found
    return ""


def _in_folder(path: str) -> str:
    """Return the newest file that the model.config of a folder names, or the file itself."""
    if path.endswith(".sdf"):
        return path if is_file(path) else ""
    config = os.path.join(path, "model.config")
    said = _root_without_comments(_bytes_or_empty(config), config) if is_file(config) else None
    files = sorted(said.iter("sdf"), key=_version_numbers) if said is not None else []
    name = (files[-1].text or "").strip() if files else ""
    found = os.path.join(path, name)
    return found if name and "/" not in name and is_file(found) else ""


def _version_numbers(element: _Element) -> tuple[int, ...]:
    parts = element.get("version", "").split(".")
    return tuple(int(it) for it in parts) if all(it.isdigit() for it in parts) else ()


@outside
def _bytes_or_empty(path: str) -> bytes:
    try:
        return read_bytes(path, MAX_BYTES)
    except (OSError, ValueError):
        return b""
