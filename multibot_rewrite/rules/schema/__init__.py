# SPDX-License-Identifier: Apache-2.0
"""The structure of a URDF: what parsers look for (``urdf.schema``), and every fault against it."""
