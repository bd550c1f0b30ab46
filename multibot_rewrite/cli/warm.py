# SPDX-License-Identifier: Apache-2.0
"""Loads what most answers of ``urdf-lint --lsp`` need, once for all their processes."""

from multibot_rewrite.cli import answers  # noqa: F401
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.rules.settings import Settings

_PLUGIN = b'<gazebo><plugin filename="libgazebo_ros_diff_drive.so" name="p"/></gazebo>'
lint_data("warm.urdf", b'<robot name="warm"><link name="a"/>%b</robot>' % _PLUGIN, Settings())
lint_data("warm.yaml", b"amcl:\n  ros__parameters:\n    base_frame_id: a\n", Settings())
