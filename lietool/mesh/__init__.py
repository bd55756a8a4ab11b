"""Triangle meshes and outlines: what they are, how they are read, how their parts hang together."""
