# SPDX-License-Identifier: Apache-2.0
"""The one door to launch and launch_ros: imported where they are needed, never before."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def of_launch(module: str = "") -> Any:
    """Return launch, or a module of it; raises ImportError."""
    import launch

    return import_module(f"{launch.__name__}.{module}") if module else launch


def of_launch_ros(module: str) -> Any:
    """Return a module of launch_ros; raises ImportError."""
    import launch_ros

    return import_module(f"{launch_ros.__name__}.{module}")


def is_installed(package: str) -> bool:
    """Return whether a package of ROS is installed. Raises ImportError."""
    from ament_index_python.packages import PackageNotFoundError, get_package_prefix

    try:
        get_package_prefix(package)
    except PackageNotFoundError:
        return False
    return True


def is_there() -> bool:
    """Return whether launch and launch_ros can be imported."""
    try:
        of_launch_ros("actions")
    except ImportError:
        return False
    return not missing()


def missing() -> str:
    """Return why launch cannot be imported; empty if it can."""
    try:
        _ = of_launch("frontend").expose_action
    except (ImportError, AttributeError) as error:
        return f"{type(error).__name__}: {error}"
    return ""
