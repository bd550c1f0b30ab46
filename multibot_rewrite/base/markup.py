# SPDX-License-Identifier: Apache-2.0
"""Parts of patterns that read XML, Python and substitutions, each in linear time.

A search for something without an end would start again at the next place that looks like its start.
What has no end therefore goes to the end of the text, or stops where the next one starts.
"""

from multibot_rewrite.base.lazy import lazy_compile

COMMENT = rb"<!--(?s:.*?)(?:-->|\Z)"
# What holds no tags.
SILENT = COMMENT + rb"|<!\[CDATA\[(?s:.*?)(?:\]\]>|\Z)|<\?(?s:.*?)(?:\?>|\Z)"
# Inside a start tag, behind its name: no value of an attribute holds a "<".
ATTRIBUTES = rb"(?:[^<>\"']|\"[^\"<]*\"|'[^'<]*')*"
# Inside an expression ${...} of xacro, and inside a substitution $(...).
IN_EXPRESSION = r"(?:[^$}]|\$(?!\{))*"
IN_SUBSTITUTION = r"(?:[^$)]|\$(?!\())*"
FILLED_IN = rf"\$\{{{IN_EXPRESSION}\}}|\$\({IN_SUBSTITUTION}\)"
_SILENT = lazy_compile(SILENT)


def without_comments(source: bytes) -> bytes:
    """Return a text of XML without its comments and processing instructions."""
    return _SILENT.sub(lambda found: found[0] if found[0].startswith(b"<![") else b"", source)
