# SPDX-License-Identifier: Apache-2.0
"""The fleet file and what it names, as records."""
