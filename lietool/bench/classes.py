"""A class of submissions made from a solution: right ones, untouched starters, and what people get wrong.

A wrong one has one slip or two in the code: a sign, a factor, sine for cosine, an index, a transposition, a
check left out.  A few have what a grader must live through: an endless loop, no end of recursion, an exit.
"""

import ast
import copy
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass

# Of a class, by parts: nothing wrong, nothing written, one slip, two slips, trouble.
_SHARES = {"right": 30, "starter": 8, "slip": 45, "two slips": 12, "trouble": 5}
_TROUBLES = {
    "loop": "while True:\n    pass",
    "recursion": "return {name}({args})",
    "exit": "raise SystemExit(0)",
    "import": "import scipy\nreturn scipy",
    "memory": "return np.ones((1 << 17, 1 << 17))",
}
_OTHER = {"sin": "cos", "cos": "sin", "arctan2": "hypot", "arccos": "arcsin", "arcsin": "arccos"}
_OTHER |= {"sinh": "sin", "tan": "sin", "exp": "expm1", "minimum": "maximum", "maximum": "minimum"}
_OTHER |= {"cumsum": "sum", "zeros": "ones", "eye": "ones"}
_SIGNS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.MatMult: ast.Mult,
}


@dataclass(frozen=True)
class Made:
    """A submission: its text, and what was done to the solution, in words."""

    source: str
    says: str


def make(solution: str, starter: str, count: int, seed: int) -> list[Made]:
    """Make a class.

    Parameters
    ----------
    solution, starter : str
        Files of an exercise; their comments before the first blank line are kept.
    count : int
        How many submissions.
    seed : int
        Equal seeds make equal classes.

    Returns
    -------
    list of Made
        In no order.

    Raises
    ------
    SyntaxError
        If the solution is no Python.
    """
    lot = random.Random(seed)
    kinds = lot.choices(list(_SHARES), list(_SHARES.values()), k=count)
    return [_made(kind, solution, starter, lot) for kind in kinds]


def _made(kind: str, solution: str, starter: str, lot: random.Random) -> Made:
    if kind == "right":
        return Made(solution, kind)
    if kind == "starter":
        return Made(starter, kind)
    head = solution.partition("\n\n")[0]
    tree = ast.parse(solution)
    if kind == "trouble":
        said = _troubled(tree, lot)
    else:
        said = "; ".join(_slip(tree, lot) for _ in range(2 if kind == "two slips" else 1))
    return Made(f"{head}\n\n{ast.unparse(tree)}\n", said)


def _troubled(tree: ast.Module, lot: random.Random) -> str:
    name = lot.choice(list(_TROUBLES))
    function = lot.choice([node for node in tree.body if isinstance(node, ast.FunctionDef)])
    args = ", ".join(arg.arg for arg in function.args.args)
    body = _TROUBLES[name].format(name=function.name, args=args)
    function.body = ast.parse(f"def f():\n{_indented(body)}").body[0].body  # type: ignore[attr-defined]
    return name


def _indented(text: str) -> str:
    return "\n".join(f"    {line}" for line in text.splitlines())


def _slip(tree: ast.Module, lot: random.Random) -> str:
    """Change one thing, and say which; nothing where there is nothing to be changed."""
    slips = [
        slip
        for function in tree.body
        if isinstance(function, ast.FunctionDef)
        for node in ast.walk(function)
        for slip in _slips(node)
    ]
    if not slips:
        return "nothing"
    says, change = lot.choice(slips)
    change()
    ast.fix_missing_locations(tree)
    return says


def _slips(node: ast.AST) -> Iterator[tuple[str, Callable[[], object]]]:
    """Yield what could be got wrong at a place, in words, and what does it."""
    was = ast.unparse(node) if isinstance(node, ast.expr) else ""
    if isinstance(node, ast.BinOp) and type(node.op) in _SIGNS:
        other = _SIGNS[type(node.op)]
        yield f"{other.__name__} in {was}", lambda: setattr(node, "op", other())
        if isinstance(node.op, ast.Sub | ast.Div | ast.MatMult):
            yield f"the wrong way round: {was}", lambda: _swap(node)
    elif isinstance(node, ast.Attribute) and node.attr in _OTHER:
        yield f"{_OTHER[node.attr]} for {was}", lambda: setattr(node, "attr", _OTHER[node.attr])
    elif isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        twice = 2 * node.value or 1
        yield f"{twice} for {was}", lambda: setattr(node, "value", twice)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield f"no minus in {was}", lambda: setattr(node, "op", ast.UAdd())
    elif isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Lt | ast.Gt):
        other = ast.Gt if isinstance(node.ops[0], ast.Lt) else ast.Lt
        yield f"turned: {was}", lambda: setattr(node, "ops", [other(), *node.ops[1:]])
    elif isinstance(node, ast.If) and any(isinstance(x, ast.Raise) for x in node.body):
        yield "nothing is refused", lambda: setattr(node, "body", [ast.Pass()])
    elif isinstance(node, ast.Return) and isinstance(node.value, ast.expr):
        value = copy.deepcopy(node.value)
        yield "minus the result", lambda: setattr(node, "value", ast.UnaryOp(ast.USub(), value))


def _swap(node: ast.BinOp) -> None:
    node.left, node.right = node.right, node.left
