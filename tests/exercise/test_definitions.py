"""What of a notebook's cells a function needs."""

import pytest

from lietool.exercise.definitions import needed


@pytest.mark.parametrize(
    ("cells", "kept"),
    [
        (
            ["import numpy as np\nimport os", "def f(x):\n    return np.sin(x)"],
            ["import numpy as np", "def f(x):"],
        ),
        (["def f():\n    return g()", "print(1)", "def g():\n    return 1\n"], ["def f():", "def g():"]),
        # The last is what counts, also of a cell that was run again.
        (["def f():\n    return 1", "def f():\n    return A", "A = 1", "A = 2"], ["def f():", "A = 2"]),
        # What was read at once was read then.
        (
            ["A = 1", "B = A + 1", "A = 5", "def f():\n    return B"],
            ["A = 1", "B = A + 1", "A = 5", "def f():"],
        ),
        (["A = [0, 0]", "A[0] = 1; x = 3", "def f():\n    return A"], ["A = [0, 0]", "A[0] = 1", "def f():"]),
        (["A = 1", "A += 1", "f = lambda: A"], ["A = 1", "A += 1", "f = lambda: A"]),
        (
            ["A = 1", "if B:\n    A = 2", "B = 0", "B = 1\nf = lambda: A"],
            ["A = 1", "if B:", "B = 1", "f = lambda: A"],
        ),
        (["from math import *", "f = lambda x: sin(x)"], ["from math import *", "f = lambda x: sin(x)"]),
        (["import a.b", "f = lambda x: a.b.c"], ["import a.b", "f = lambda x: a.b.c"]),
        (
            ["@g\ndef f():\n    pass", "def g(x):\n    return x", "class C(D):\n    x = 1"],
            ["@g", "def g(x):"],
        ),
        (["def f(:", "f = 1 +", "f = 3"], ["f = 3"]),
        (["x = 1"], []),
    ],
)
def test_definitions_are_found(cells, kept):
    text = needed(cells, ["f"])
    # Of each its first line, and of f itself not everywhere.
    lines = [line for line in text.splitlines() if not line.startswith(" ")]
    assert [line for line in lines if line in kept or line != "def f():"] == kept


def test_it_is_python_that_gives_the_same():
    cells = [
        "import math\nN = 2",
        "N *= 2",
        "def half(x): return x / N",
        "half(3)",
        "def f(x):\n    return half(math.pi * x)",
    ]
    space: dict = {}
    exec(needed(cells, ["f"]), space)
    assert space["f"](4) == pytest.approx(3.14159265)
