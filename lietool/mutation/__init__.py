"""Mutants: small, named, plausible mistakes in the library, to try whether the plates notice them.

A catalogue is a file ``catalogue/<area>.toml`` with a table ``[[mutant]]`` for each:

.. code-block:: toml

    [[mutant]]
    name = "axis_angle.rotation: half of the angle"     # where: what
    module = "lietool.lie.axis_angle"
    old = 'c, s = np.cos(angle), np.sin(angle)'          # occurs exactly once in the module's file
    new = 'c, s = np.cos(angle / 2.0), np.sin(angle / 2.0)'
    mistake = "half angle"                               # one of `mutant.MISTAKES`
    says = "A sentence for a student: what this computes instead, and what it should be."
    harmless = "Only where nothing can be seen: why."    # most have none

Several lines are written in ``'''`` with their indentation.  A new file in that folder is found by itself;
``tests/mutation/test_catalogue.py`` tries every entry, and ``lietool figures mutants NAME`` runs those whose
name begins so.
"""

from lietool.mutation.hook import function as function
from lietool.mutation.mutant import Mutant as Mutant
from lietool.mutation.mutant import MutantError as MutantError
from lietool.mutation.mutant import catalogue as catalogue
