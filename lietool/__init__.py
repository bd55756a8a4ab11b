"""Lie groups for motion and deformation: every figure of the book, by real computation."""

__version__ = "0.1.0"
