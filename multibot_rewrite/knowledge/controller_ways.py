# SPDX-License-Identifier: Apache-2.0
"""How the controllers of ros2_control get remap rules, by release.

Source: ros2_control ``controller_manager.cpp`` (``determine_controller_node_options``), ``spawner.py``.
"""

from typing import NamedTuple

from multibot_rewrite.base.releases import has_release


class ControllerWay(NamedTuple):
    """How the controllers of ros2_control get rules in some releases.

    ``spawner``: its option --controller-ros-args has them. ``forwarded``: those of the controller
    manager are theirs, too. ``process_wide``: those of the whole process are.
    """

    releases: str
    spawner: bool
    forwarded: bool
    process_wide: bool
    source: str

    @property
    def of_manager(self) -> bool:
        """Return whether the manager's rules, also those in a plugin's tag, reach its controllers."""
        return self.forwarded or self.process_wide


_IN = "controller_manager/src/controller_manager.cpp"
CONTROLLER_WAYS = (
    ControllerWay("<=humble", False, False, True, f"ros-controls/ros2_control@2.54.0 {_IN}"),
    # The spawner's option came with 4.22.0, the forwarding with 4.16.1; it warns since then.
    ControllerWay("jazzy, kilted", True, True, False, f"ros-controls/ros2_control@4.46.0 {_IN}"),
    ControllerWay("lyrical+", True, False, False, f"ros-controls/ros2_control@6.5.0 {_IN}"),
)


def controller_way(release: str) -> ControllerWay:
    """Return how controllers get rules in a release."""
    return next(it for it in CONTROLLER_WAYS if has_release(it.releases, release))
