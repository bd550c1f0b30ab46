"""The shape of a URDF: what its readers look for (``urdf.schema``), and every fault against it."""
