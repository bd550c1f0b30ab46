# SPDX-License-Identifier: Apache-2.0
"""Results of earlier lints, kept while all that they rest on is the same."""
