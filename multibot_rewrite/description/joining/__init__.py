# SPDX-License-Identifier: Apache-2.0
"""Descriptions joined at a link: a gripper on an arm, an arm on a base; and taken apart again."""
