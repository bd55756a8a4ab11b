"""Modules with a mistake in them: put in while they are imported, so that every copy of a name has it."""

import contextlib
import importlib
import sys
from collections.abc import Callable, Iterator, Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType, ModuleType
from typing import Any

from lietool.mutation.mutant import Mutant, MutantError

SUBJECTS = ("lietool.lie", "lietool.mesh", "lietool.interp", "lietool.deform")
"""The packages that mutants are for."""
# And what is built on them, which keeps copies of their names.
_DEPENDENT = (*SUBJECTS, "lietool.bench", "lietool.figures", "lietool_project")


class _Loader(SourceFileLoader):
    """Loads a module from other text than its file has, past the byte code that is kept of it."""

    def __init__(self, mutant: Mutant) -> None:
        super().__init__(mutant.module, str(mutant.file))
        self.text = mutant.source

    def get_code(self, fullname: str) -> CodeType:
        return compile(self.text, self.path, "exec", dont_inherit=True)


class _Finder(MetaPathFinder):
    """Finds the mutated module before anybody else does."""

    def __init__(self, mutant: Mutant) -> None:
        self.mutant = mutant

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname != self.mutant.module:
            return None
        spec = PathFinder.find_spec(fullname, path)
        if spec is not None:
            spec.loader = _Loader(self.mutant)
        return spec


def install(mutant: Mutant) -> None:
    """Let this process import a mutant in place of its module, for good.

    Parameters
    ----------
    mutant : Mutant
        The mistake.

    Raises
    ------
    MutantError
        If something that might have a copy of the right module is imported already, or the mutant does
        not fit its module.
    """
    if known := _imported(_DEPENDENT):
        raise MutantError(
            f"mutant {mutant.name!r}: {known[0]} is imported already, and keeps what it has. "
            "Use a fresh process"
        )
    sys.meta_path.insert(0, _finder(mutant))


def function(mutant: Mutant, name: str) -> Callable[..., Any]:
    """Return a function of the library as it is with a mistake in it.

    All the subjects are imported anew for it, so that the mistake may stand in another module that the
    function uses; the modules that are imported already stay as they are.  What a function imports only
    when it is called comes without the mistake.

    Parameters
    ----------
    mutant : Mutant
        The mistake.
    name : str
        The module and the function: "so3.exp" of the mutant's package, or "lietool.lie.so3.exp".

    Returns
    -------
    callable
        The function.

    Raises
    ------
    MutantError
        If there is no such function.
    """
    module, _, attribute = name.rpartition(".")
    if not module.startswith("lietool."):
        module = f"{mutant.module.rpartition('.')[0]}.{module}"
    with _fresh(mutant):
        try:
            found = getattr(importlib.import_module(module), attribute)
        except (ImportError, AttributeError):
            raise MutantError(
                f"mutant {mutant.name!r}: there is no function {name}. Write it as so3.exp or "
                "lietool.lie.so3.exp"
            ) from None
    return found


@contextlib.contextmanager
def _fresh(mutant: Mutant) -> Iterator[None]:
    """Import the subjects anew and with a mistake meanwhile, and put back what was there."""
    import lietool

    before = {name: sys.modules.pop(name) for name in _imported(_DEPENDENT)}
    parts = {name: value for name, value in vars(lietool).items() if isinstance(value, ModuleType)}
    finder = _finder(mutant)
    sys.meta_path.insert(0, finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)
        for name in _imported(_DEPENDENT):
            del sys.modules[name]
        sys.modules.update(before)
        # A package has its modules as attributes too, which importing anew has replaced.
        for name, part in parts.items():
            setattr(lietool, name, part)


def _finder(mutant: Mutant) -> _Finder:
    finder = _Finder(mutant)
    # Now rather than in the middle of an import, where it would look like a fault of the library.
    _Loader(mutant)
    return finder


def _imported(packages: Sequence[str]) -> list[str]:
    return [
        name
        for name in sys.modules
        if any(name == package or name.startswith(f"{package}.") for package in packages)
    ]
