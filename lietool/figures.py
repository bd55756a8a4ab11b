"""The package of figure files: ``lietool.figures.ch2.slerp`` is ``figures/ch2/slerp.py``.

A module that sets ``__path__`` is a package, so spawned workers can import a
figure by its name wherever the folder lies.
"""

from lietool.paths import FIGURES

__path__ = [str(FIGURES)]
