# SPDX-License-Identifier: Apache-2.0
"""The robots of a fleet as one page in 3D: what they look like, where they are, what was renamed."""
