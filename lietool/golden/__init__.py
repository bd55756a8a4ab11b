"""Goldens: the pictures and numbers that were looked at once and are compared ever since."""
