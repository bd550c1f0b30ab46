# SPDX-License-Identifier: Apache-2.0
"""What to lint and report: settings and their file, ignore comments, known findings, changed files."""
