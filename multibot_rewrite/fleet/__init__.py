"""A fleet file -> everything its robots need: rewritten descriptions, tables, companion files."""
