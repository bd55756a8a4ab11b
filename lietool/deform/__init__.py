"""Deformation of shapes in space: chapter 7 of the book, and its papers."""
