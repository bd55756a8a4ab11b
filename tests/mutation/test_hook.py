"""Mutants in place of modules: every copy of a name has the mistake, and no other process or caller does."""

import subprocess
import sys

import numpy as np
import pytest

from lietool import mutation
from lietool.lie import blend, so3
from lietool.mutation import hook
from lietool.mutation.mutant import Mutant, MutantError

TURN = np.array([0.3, -0.2, 0.5])
DOUBLED = Mutant(
    "so3.exp: half angle missing",
    "lietool.lie.kernels",
    "a = 0.5 * series.sinc(h)\n    return matrix((np.cos(h), a * x, a * y, a * z))",
    "a = 0.5 * series.sinc(h)\n    return matrix((np.cos(h), -a * x, -a * y, -a * z))",
    "sign",
    "The other way round.",
)


def test_a_function_has_the_mistake_and_the_library_does_not():
    before = dict(sys.modules)
    wrong = mutation.function(DOUBLED, "so3.exp")
    np.testing.assert_allclose(wrong(TURN), so3.exp(-TURN), atol=1e-15)
    assert not np.allclose(wrong(TURN), so3.exp(TURN))
    assert {k: v for k, v in sys.modules.items() if k.startswith("lietool.")} == {
        k: v for k, v in before.items() if k.startswith("lietool.")
    }
    import lietool.lie

    assert lietool.lie.so3 is so3
    assert lietool.lie.blend is blend


def test_a_function_may_be_named_in_full():
    assert mutation.function(DOUBLED, "lietool.lie.so3.hat")(TURN) == pytest.approx(so3.hat(TURN))


@pytest.mark.parametrize("name", ["so3.nothing", "so9.exp", "exp"])
def test_a_function_that_is_none_is_refused(name):
    with pytest.raises(MutantError, match=f"there is no function {name}"):
        mutation.function(DOUBLED, name)


def test_a_process_that_knows_the_library_cannot_have_a_mutant():
    with pytest.raises(MutantError, match=r"lietool\.\S+ is imported already"):
        hook.install(DOUBLED)


def test_a_fresh_process_has_the_mistake_in_every_copy():
    code = (
        "from lietool.mutation import catalogue, hook\n"
        "hook.install(next(m for m in catalogue() if m.name == 'slerp: normalised linear interpolation'))\n"
        "from lietool.lie import quaternion, slerp\n"
        "assert quaternion.slerp is slerp.slerp\n"
        "a, b = [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]\n"
        "print((quaternion.slerp(a, b, 0.3) == quaternion.nlerp(a, b, 0.3)).all())\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.strip() == "True", done.stderr
