# SPDX-License-Identifier: Apache-2.0
"""What is wrong in related files of a description, for ``urdf-lint`` and ``build``."""
