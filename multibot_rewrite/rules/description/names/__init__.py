# SPDX-License-Identifier: Apache-2.0
"""MB3: how names are written."""
