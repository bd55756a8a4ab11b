"""The kinds of weights of probes; alone, for what a figure declares is read without numpy."""

DISTANCES = ("inverse-distance", "cutoff", "gaussian")
SMOOTH = ("harmonic", "biharmonic")
