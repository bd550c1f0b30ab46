# SPDX-License-Identifier: Apache-2.0
"""MB8: an SRDF against its URDF."""
