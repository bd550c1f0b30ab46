"""The structure of a URDF: what parsers look for (``urdf.schema``), and every fault against it."""
