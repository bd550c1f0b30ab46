# SPDX-License-Identifier: Apache-2.0
"""A scene -> one HTML file that fetches nothing."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable, Mapping, Sequence
from html import escape
from importlib.resources import files
from typing import Any

from multibot_rewrite.base.wording import one_line, plural
from multibot_rewrite.base.workers import limit_time, worker_pool
from multibot_rewrite.pages.page import Framed, source_hash
from multibot_rewrite.pages.view.models import Mesh, Model, load_mesh, prepare_meshes, three_js
from multibot_rewrite.pages.view.scene import DEGREES, METRES, ShownScene, ViewedRobot

MESH_SECONDS = 10.0
# Meshes by their files, or why one cannot be shown.
Meshes = Mapping[str, Mesh | str]


def meshes_of(scene: ShownScene, tell: Callable[[str], None] = lambda _: None) -> Meshes:
    """Return the meshes of all robots, each read once by a limited worker; ``tell`` gets its name."""
    shapes = (it for robot in scene.robots for its in robot.model.links.values() for it in its)
    paths = [path for path in dict.fromkeys(it.mesh for it in shapes) if path]
    prepare_meshes()

    def within(path: str) -> Mesh | str:
        limit_time(MESH_SECONDS)
        return load_mesh(path)

    def lost(path: str, _: int) -> str:
        return f"{path}: reading it takes more than {MESH_SECONDS:g} s, or too much memory"

    with worker_pool(within, paths, lost, min(2, len(paths))) as workers:
        found = {}
        for path, mesh in zip(paths, workers.results(), strict=True):
            found[path] = mesh
            tell(f"{len(found)} of {plural(len(paths), 'mesh file')}: {path}")
        return found


def to_html(scene: ShownScene, meshes: Meshes, title: str) -> bytes:
    """Return the page; raises Unusable without trimesh."""
    return to_frame(scene, meshes, title).html.encode()


def to_frame(scene: ShownScene, meshes: Meshes, title: str) -> Framed:
    """Return the page, to be put into another; raises Unusable without trimesh."""
    library, own = three_js(), _asset_text("viewer.js") + _asset_text("heard.js")
    style = _asset_text("viewer.css")
    scripts = f"{source_hash(library)} {source_hash(own)}"
    policy = (
        f"default-src 'none'; style-src {source_hash(style)}; img-src data: blob:;"
        f" script-src {scripts}; base-uri 'none'; form-action 'none'"
    )
    head = escape(one_line(title))
    data = json.dumps(_scene_json(scene, meshes), separators=(",", ":")).replace("<", "\\u003c")
    page = (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>{head}</title>\n<style>{style}</style>\n</head>\n<body>\n"
        f"<header><h1>{head}</h1>{_BAR}</header>\n"
        '<main><nav id="tree"></nav><div id="stage"></div><aside id="about"></aside></main>\n'
        f'<script type="application/json" id="data">{data}</script>\n'
        f"<script>{library}</script>\n<script>{own}</script>\n</body>\n</html>\n"
    )
    return Framed(page, source_hash(style), scripts)


_BAR = (
    '<span id="bar"><label>left <select id="left"></select></label>'
    '<label>right <select id="right"></select></label>'
    '<label><input type="checkbox" id="frames" checked> frames</label>'
    '<label><input type="checkbox" id="labels"> names</label>'
    '<label id="ghosts" hidden><input type="checkbox" id="tf" checked> tf as heard</label>'
    '<button id="fit" type="button">fit</button></span>'
)


def remark_if_empty(model: Model) -> str:
    """Return a remark on a robot that has nothing to show; empty for others."""
    return "" if any(model.links.values()) else "its links have no <visual>: only frames are shown"


def title_of(robots: Sequence[ViewedRobot], layout: str) -> str:
    """Return the heading of a page."""
    return f"{plural(len(robots), 'robot')}, layout {layout}"


def _asset_text(name: str) -> str:
    return files(__package__).joinpath(name).read_text("utf-8")


def _scene_json(scene: ShownScene, meshes: Meshes) -> dict[str, Any]:
    numbers = {path: at for at, path in enumerate(meshes)}
    return {
        "meshes": [
            {"missing": it}
            if isinstance(it, str)
            else {
                key: base64.b64encode(data).decode()
                for key, data in zip("vfc", (it.vertices, it.faces, it.colours), strict=True)
            }
            for it in meshes.values()
        ],
        "robots": [_robot_json(it, numbers, meshes) for it in scene.robots],
        "trees": scene.trees,
        "same": [METRES, DEGREES],
    }


def _robot_json(it: ViewedRobot, numbers: Mapping[str, int], meshes: Meshes) -> Any:
    names = {one.after: [one.before, one.line] for one in it.names}
    links: dict[str, list[Any]] = {}
    for link, shapes in it.model.links.items():
        links[link] = rows = []
        for shape in shapes:
            mesh = meshes[shape.mesh] if shape.mesh else None
            missing = mesh if isinstance(mesh, str) else shape.missing
            number = numbers.get(shape.mesh, -1)
            rows.append([shape.kind, shape.size, shape.pose, shape.colour, number, missing])
    changes = [[at.line, at.kind, at.path, at.old, at.new, at.rule] for at in it.changes]
    own = {"names": names, "links": links, "joints": it.model.joints, "changes": changes}
    return {**it._asdict(), "model": None, **own, "bare": remark_if_empty(it.model)}
