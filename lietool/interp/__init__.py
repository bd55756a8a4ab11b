"""Interpolation of triangles and of triangulated shapes: chapters 5 and 6 of the book."""
