# SPDX-License-Identifier: Apache-2.0
"""MB2: names that nothing declares, or that are declared twice."""
