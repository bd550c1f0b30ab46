"""Every command line of the package as data: each command loads its own."""
