# SPDX-License-Identifier: Apache-2.0
"""Every command line of the package as data: each command loads its own."""
