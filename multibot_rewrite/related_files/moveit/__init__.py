# SPDX-License-Identifier: Apache-2.0
"""MoveIt's YAML files: kinematics, joint limits, controllers, planners, sensors, servo."""
