"""The files of a built fleet, one module a file."""
