# SPDX-License-Identifier: Apache-2.0
"""``urdf-lint.toml`` or ``[tool.urdf-lint]`` -> settings; what a command adds to them."""

import os
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from multibot_rewrite.base import config
from multibot_rewrite.base.findings.finding import WARNING
from multibot_rewrite.base.findings.selection import OFF
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.lint.config.values import (
    FIELDS,
    READERS,
    KeyValue,
    checked_robots,
    find_lint_codes,
    targets,
)
from multibot_rewrite.rules.settings import EVERY_FILE, ArgumentSet, Settings, matches

OWN, PROJECT, TABLE = "urdf-lint.toml", "pyproject.toml", "urdf-lint"
MARK = b"urdf"
NAMING = ("layout", "affix", "topics", "separators", "shared_frames", "shared_topics", "groups")
DEFAULT_NAMING: Mapping[str, Any] = {}


class Configured(NamedTuple):
    """The settings, and how a command treats files and findings.

    ``exclude`` are patterns for ``is_excluded``; ``fail_on`` is the lowest level that makes a lint
    fail; ``file`` is where this was read, empty for nowhere; ``distro`` is the release that it asks
    for, empty for none; ``naming`` are the options that
    ``make_naming`` made the settings' naming from.
    """

    settings: Settings = Settings()
    exclude: tuple[str, ...] = ()
    baseline: str = ""
    fail_on: str = WARNING
    file: str = ""
    naming: Mapping[str, Any] = DEFAULT_NAMING
    distro: str = ""


def configured(near: str, file: str | None) -> Configured:
    """Return the configuration in ``file`` or, without one, the nearest above ``near``.

    In one folder a urdf-lint.toml comes before a pyproject.toml, which counts if it has a table
    ``[tool.urdf-lint]``. Raises UsageError, naming the file, for anything that is wrong in it."""
    path = file or next(_configurations_above(near), "")
    result = _configured_by(path, _table(path)) if path else Configured()
    settings = result.settings
    definitions = (*config.configured_definitions(near), *settings.definitions)
    return result._replace(
        settings=settings._replace(definitions=tuple(dict.fromkeys(definitions)))
    )


def _configurations_above(near: str) -> Iterator[str]:
    for folder in config.folders_above(near):
        own, project = os.path.join(folder, OWN), os.path.join(folder, PROJECT)
        if os.path.isfile(own):
            yield own
        # Parsing is slow compared with the rest of a start, and most projects do not have the table.
        data = config.read(project) if os.path.isfile(project) else b""
        if MARK in data and _project_table(project, data) is not None:
            yield project


def _table(path: str) -> Mapping[str, object]:
    """Return the keys and values of a configuration file."""
    data = config.read(path)
    if os.path.basename(path) != PROJECT:
        return config.parse(path, data)
    table = _project_table(path, data)
    if table is None:
        raise UsageError(f"{path}: it has no table [tool.{TABLE}]; add it")
    return table


def _project_table(path: str, data: bytes) -> Mapping[str, object] | None:
    """Return the lint's table in a pyproject.toml; None without one."""
    tool = config.parse(path, data).get("tool", {})
    if not isinstance(tool, dict):
        return None
    if "urdf_lint" in tool:
        raise UsageError(f"{path}: [tool.urdf_lint] is not read, write [tool.{TABLE}]")
    table = tool.get(TABLE)
    if table is not None and not isinstance(table, dict):
        raise UsageError(f"{path}: tool.{TABLE} is {config.type_name(table)}, write [tool.{TABLE}]")
    return table


def _configured_by(path: str, table: Mapping[str, object]) -> Configured:
    """Return the configuration that the keys and values of a file make; raises UsageError."""
    folder = os.path.dirname(os.path.abspath(path))
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in READERS:
            near = nearest(key.replace("_", "-"), list(READERS))
            meant = f"did you mean {near!r}?" if near else f"use one of {', '.join(READERS)}"
            raise UsageError(f"{path}: unknown key {key!r}, {meant}")
        field = FIELDS.get(key, key.replace("-", "_"))
        values[field] = READERS[key](KeyValue(f"{path}: {key}", folder, value))
    naming_options = {name: values.pop(name) for name in NAMING if name in values}
    own = {name: values.pop(name) for name in Configured._fields if name in values}
    # Those in the folder, wherever links lead.
    whole = os.path.realpath(folder)
    roots = ((it, os.path.realpath(it)) for it in values.get("roots", ()))
    values["readable"] = tuple(it for it, at in roots if os.path.commonpath((at, whole)) == whole)
    result = Configured(Settings(**values), file=path, **own)
    try:
        return _with_naming(result, naming_options)
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None


def _with_naming(it: Configured, naming_options: Mapping[str, Any]) -> Configured:
    """Return the configuration with these options of the naming in place of its own."""
    if not naming_options:
        return it
    naming = {**it.naming, **naming_options}
    settings = it.settings._replace(naming=make_naming(**naming))
    return it._replace(settings=settings, naming=naming)


def is_excluded(path: str, it: Configured) -> bool:
    """Return whether the configuration leaves out a file that was found below a folder."""
    return any(matches(path, pattern) for pattern in it.exclude)


def with_options(it: Configured, **given: Any) -> Configured:
    """Return a configuration with the options of the command line; None and empty mean not given.

    ``ignore``, ``definitions``, ``roots`` and ``arguments`` (pairs) add to it; all else replaces it.
    Codes in ``select`` are on, whatever the configuration says about exactly these codes."""
    options = {name: value for name, value in given.items() if value not in (None, (), "")}
    naming_options = {name: options.pop(name) for name in NAMING if name in options}
    if "target" in options:
        options["targets"] = targets(KeyValue("--target", "", list(options.pop("target"))))
    if "robots" in options:
        options["robots"] = checked_robots(options["robots"], "--robots")
    if "fail_on" in options:
        options["fail_on"] = READERS["fail-on"](KeyValue("--fail-on", "", options["fail_on"]))
    for name in ("select", "ignore"):
        if name in options:
            options[name] = find_lint_codes(options[name], f"--{name}")
    own = {
        name: options.pop(name) for name in ("exclude", "baseline", "fail_on") if name in options
    }
    settings, select = it.settings, tuple(options.pop("select", ()))
    if select:
        ignore = tuple(code for code in settings.ignore if code not in select)
        levels = settings.levels.items()
        left = {code: at for code, at in levels if at != OFF or code not in select}
        settings = settings._replace(select=select, ignore=ignore, levels=left)
    if "arguments" in options:
        options["arguments"] = (ArgumentSet(EVERY_FILE, tuple(options["arguments"])),)
    options["readable"] = options.get("roots", ())
    for name in ("ignore", "definitions", "roots", "readable", "arguments"):
        if name in options:
            options[name] = (*getattr(settings, name), *options[name])
    settings = settings._replace(**options)
    return _with_naming(it._replace(settings=settings, **own), naming_options)
