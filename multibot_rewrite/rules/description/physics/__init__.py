# SPDX-License-Identifier: Apache-2.0
"""MB6: mass, inertia, shapes, and geometry against the robot."""
