# SPDX-License-Identifier: Apache-2.0
"""MB4: what goes wrong when a second robot uses the same description."""
