# SPDX-License-Identifier: Apache-2.0
"""What is wrong in related files of a description: ``urdf-lint`` asks it of files that it reads,
``build`` of those that it rewrites."""
