# SPDX-License-Identifier: Apache-2.0
"""Between versions of URDF: edits that keep every pose and shape, and the proof that they do."""
