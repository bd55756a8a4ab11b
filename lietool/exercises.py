"""The package of exercise files: ``lietool.exercises.slerp`` is ``exercises/slerp.py``.

A module that sets ``__path__`` is a package, so spawned workers can import an
exercise by its name wherever the folder lies.
"""

from lietool.paths import EXERCISES

__path__ = [str(EXERCISES)]
