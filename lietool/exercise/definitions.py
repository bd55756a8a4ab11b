"""What a function needs of a file, or of the cells of a notebook: all of it but tests, plots and prints."""

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

_EVERYTHING = "*"
_SCOPES = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef | ast.Lambda
_SIMPLE = ast.Assign | ast.AnnAssign | ast.Import | ast.ImportFrom | _SCOPES


@dataclass(frozen=True)
class _Statement:
    text: str
    binds: frozenset[str]
    changes: frozenset[str]
    uses: frozenset[str]


def needed(cells: Sequence[str], wanted: Sequence[str]) -> str:
    """Return a file with what some functions need of a notebook.

    Parameters
    ----------
    cells, wanted : sequence of str
        As of `statements`.

    Returns
    -------
    str
        A file in which each name has the value that it has last.
    """
    return "".join(f"{text}\n" for text in statements(cells, wanted))


def statements(cells: Sequence[str], wanted: Sequence[str]) -> list[str]:
    """Return the definitions, imports and assignments that some functions need, as they are written.

    Parameters
    ----------
    cells : sequence of str
        What was run, in its order; of a cell that was run again, each time.
    wanted : sequence of str
        The names of the functions.

    Returns
    -------
    list of str
        In their order.  Calls for their own sake, as of `print`, are left out, and so is what is no Python.
    """
    found = [statement for cell in cells for statement in _statements(cell)]
    kept: set[int] = set()
    todo = {(name, len(found)) for name in wanted}
    seen = set(todo)
    while todo:
        for i in _giving(found, *todo.pop()):
            if i not in kept:
                kept.add(i)
                # What the statement itself reads it has from before; a function looks when it is called.
                new = {(name, k) for name in found[i].uses for k in (i, len(found))} - seen
                seen |= new
                todo |= new
    return [found[i].text for i in sorted(kept)]


def _giving(found: Sequence[_Statement], name: str, before: int) -> Iterator[int]:
    """Yield what gives a name its value: where it was last set, and what has changed it since."""
    for i in range(before - 1, -1, -1):
        statement = found[i]
        if name in statement.changes or _EVERYTHING in statement.binds:
            yield i
        elif name in statement.binds:
            yield i
            return


def _statements(cell: str) -> Iterator[_Statement]:
    try:
        tree = ast.parse(cell)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    lines = cell.splitlines()
    for node in tree.body:
        if isinstance(node, ast.Expr):
            continue
        # Two may stand on a line; but a segment is without what decorates it.
        text = ast.get_source_segment(cell, node) or ""
        if decorators := getattr(node, "decorator_list", ()):
            text = "\n".join(lines[decorators[0].lineno - 1 : node.end_lineno])
        names = frozenset(_bound(node))
        changed = frozenset(_changed(node))
        read = (x for x in ast.walk(node) if isinstance(x, ast.Name) and isinstance(x.ctx, ast.Load))
        used = frozenset(x.id for x in read)
        # What a loop or an if sets may have been set before it, and stay so.
        binds, changes = (
            (names - changed, changed) if isinstance(node, _SIMPLE) else (frozenset(), names | changed)
        )
        yield _Statement(text, binds, changes, used)


def _bound(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.Import | ast.ImportFrom):
        for alias in node.names:
            yield alias.asname or alias.name.partition(".")[0]
    elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
        yield node.id
    elif isinstance(node, _SCOPES):
        # What is set inside is another's name.
        yield getattr(node, "name", "")
        return
    for child in ast.iter_child_nodes(node):
        yield from _bound(child)


def _changed(node: ast.AST) -> Iterator[str]:
    """Yield the names whose values a statement changes without setting them: ``x[0] = 1``, ``x += 1``."""
    if isinstance(node, _SCOPES):
        return
    if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name):
        yield node.target.id
    if isinstance(node, ast.Subscript | ast.Attribute) and isinstance(node.ctx, ast.Store):
        base: ast.AST = node
        while isinstance(base, ast.Subscript | ast.Attribute):
            base = base.value
        if isinstance(base, ast.Name):
            yield base.id
    for child in ast.iter_child_nodes(node):
        yield from _changed(child)
