# SPDX-License-Identifier: Apache-2.0
"""What every package uses: names and how they are renamed, records, findings, bounds."""
