# SPDX-License-Identifier: Apache-2.0
"""Imported by the process of which those of ``urdf-lint --lsp`` are forked: what most of them need."""

from argparse import Namespace

from multibot_rewrite.cli import answers
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.rules.settings import Settings

_PLUGIN = b'<gazebo><plugin filename="libgazebo_ros_diff_drive.so" name="p"/></gazebo>'
lint_data("warm.urdf", b'<robot name="warm"><link name="a"/>%b</robot>' % _PLUGIN, Settings())
lint_data("warm.yaml", b"amcl:\n  ros__parameters:\n    base_frame_id: a\n", Settings())
answers.explain(Namespace(definitions=[], distro=""), "-", ["link"])
