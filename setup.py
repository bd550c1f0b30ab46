# SPDX-License-Identifier: Apache-2.0
"""For colcon, which builds ament_python packages by setup.py; pip goes by pyproject.toml alone.

What pyproject.toml says is read here instead of by setuptools: that of Ubuntu 24.04 refuses its
license, colcon cannot read what becomes of requires-python, and a build with --symlink-install runs
in a folder without the file.
"""

import sys
from importlib import import_module
from pathlib import Path

from setuptools import Distribution, find_packages, setup

# Reads TOML: of Python 3.11 and later, or for 3.10 of pip and of Ubuntu 22.04, whose key rosdep has.
PARSERS = "tomllib", "tomli", "toml"


class FromHere(Distribution):
    """Takes what setup is told, and setup.cfg."""

    def parse_config_files(self, filenames=None, ignore_option_errors=False):
        super().parse_config_files(filenames or ["setup.cfg"], ignore_option_errors)


def found(*patterns):
    """Return the files of patterns, relative to this folder."""
    here = Path(__file__).resolve().parent
    paths = (path for pattern in patterns for path in here.glob(pattern))
    return sorted(str(path.relative_to(here)) for path in paths)


def parsed(text):
    """Return the content of a TOML file."""
    for name in PARSERS:
        try:
            return import_module(name).loads(text)
        except ModuleNotFoundError:
            continue
    sys.exit("setup.py: Python 3.10 has no tomllib; install another: sudo apt install python3-toml")


def options():
    """Return the arguments of ``setup`` by pyproject.toml, for colcon."""
    text = Path(__file__).resolve().with_name("pyproject.toml").read_text("utf-8")
    toml = parsed(text)
    project, packaging = toml["project"], toml["tool"]["setuptools"]
    name = project["name"]
    groups = {"console_scripts": project["scripts"], **project["entry-points"]}
    return {
        "distclass": FromHere,
        "name": name,
        "version": project["version"],
        "description": project["description"],
        "license": project["license"],
        "packages": find_packages(include=packaging["packages"]["find"]["include"]),
        "package_data": packaging["package-data"],
        "entry_points": {
            group: [f"{key} = {value}" for key, value in points.items()]
            for group, points in groups.items()
        },
        # What the ament index knows a package by.
        "data_files": [
            ("share/ament_index/resource_index/packages", [f"resource/{name}"]),
            (f"share/{name}", ["package.xml"]),
            # A workspace that is sourced has bin/ on the path, and lib/ not.
            ("bin", found("resource/bin/*")),
            *((home, found(*patterns)) for home, patterns in packaging["data-files"].items()),
        ],
    }


by_pip = "setuptools.build_meta" in sys.modules
setup(**({} if by_pip else options()))
