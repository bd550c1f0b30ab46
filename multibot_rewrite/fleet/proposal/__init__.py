# SPDX-License-Identifier: Apache-2.0
"""A first fleet file for descriptions: what lies beside them, what they are, what follows from it."""
