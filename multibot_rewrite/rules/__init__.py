# SPDX-License-Identifier: Apache-2.0
"""Rules that several commands ask: one a fault, whoever asks."""
