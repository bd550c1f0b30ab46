# SPDX-License-Identifier: Apache-2.0
"""Builds the part of tf2_msgs the tests need, for machines where ROS comes from PyPI without it.

Needs cmake, a C++ compiler and the generator wheels beside rclpy; takes some seconds.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from contextlib import suppress
from pathlib import Path

from paths import fixture_text, write_files

# The wheels' targets name a Python include folder of the machine they were made on.
_CMAKE = fixture_text("tf2_build_cmake.txt")
_FILES = {
    "msg/TFMessage.msg": "geometry_msgs/TransformStamped[] transforms\n",
    "action/LookupTransform.action": (
        "string target_frame\nstring source_frame\n---\n"
        "geometry_msgs/TransformStamped transform\n---\n"
    ),
    "package.xml": (
        '<package format="3"><name>tf2_msgs</name><version>0.36.0</version>'
        "<description>tf2_msgs, in part</description>"
        '<maintainer email="nobody@example.com">nobody</maintainer><license>BSD</license>'
        "<buildtool_depend>ament_cmake</buildtool_depend><depend>geometry_msgs</depend>"
        "<depend>action_msgs</depend>"
        "<member_of_group>rosidl_interface_packages</member_of_group></package>\n"
    ),
    "CMakeLists.txt": _CMAKE,
}


def missing() -> str:
    """Return what a build lacks on this machine and how to get it; empty where nothing is lacking."""
    path = _environ()["PATH"]
    tools = [tool for tool in ("cmake", "c++", "make") if shutil.which(tool, path=path) is None]
    if tools:
        return f"no {' and no '.join(tools)}"
    generators = Path(sys.prefix, "share", "rosidl_default_generators")
    if not generators.is_dir() or importlib.util.find_spec("catkin_pkg") is None:
        return "no message generators: pip install '.[tf2-build]'"
    return ""


def build(cache: Path) -> dict[str, str]:
    """Return the environment variables that make tf2_msgs importable; built at the first call.

    ``cache`` is a folder that may be kept for the next run.
    """
    key = hashlib.sha256(f"{_FILES}{sys.prefix}{sys.version}".encode()).hexdigest()[:16]
    installed = cache / key
    if not installed.is_dir():
        with tempfile.TemporaryDirectory(dir=cache) as folder:
            _run_cmake(Path(folder))
            # Somebody else may have been quicker.
            with suppress(OSError):
                Path(folder, "installed").rename(installed)
    return _variables(installed)


def _run_cmake(folder: Path) -> None:
    write_files(folder / "source", _FILES)
    for step in (
        ["cmake", "-S", "source", "-B", "build", *_options(folder / "installed")],
        ["cmake", "--build", "build", "-j4"],
        ["cmake", "--install", "build"],
    ):
        done = subprocess.run(
            step, cwd=folder, env=_environ(), capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]


def _options(installed: Path) -> list[str]:
    import numpy

    return [
        f"-DPython3_EXECUTABLE={sys.executable}",
        f"-DPYTHON_EXECUTABLE={sys.executable}",
        f"-DPYTHON_FOLDERS={sysconfig.get_path('include')};{numpy.get_include()}",
        f"-DCMAKE_INSTALL_PREFIX={installed}",
        "-DCMAKE_BUILD_TYPE=None",
    ]


def _environ() -> dict[str, str]:
    return {
        **os.environ,
        "AMENT_PREFIX_PATH": sys.prefix,
        "CMAKE_PREFIX_PATH": sys.prefix,
        "PATH": f"{Path(sys.prefix, 'bin')}{os.pathsep}{os.environ['PATH']}",
    }


def _variables(installed: Path) -> dict[str, str]:
    site = Path(sysconfig.get_path("purelib", vars={"base": str(installed)}))
    return {
        "PYTHONPATH": _first(str(site), "PYTHONPATH"),
        "LD_LIBRARY_PATH": _first(str(installed / "lib"), "LD_LIBRARY_PATH"),
    }


def _first(path: str, variable: str) -> str:
    return os.pathsep.join(filter(None, [path, os.environ.get(variable, "")]))
