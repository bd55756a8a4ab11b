"""What a wheel gets besides the files: the index of numbered equations, for it has no tests to read."""

import importlib.util
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class EquationsHook(BuildHookInterface):
    """Write ``lietool/verbs/equations.json`` into the wheel, read from the sources as they are now."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Make the index and say where it goes."""
        if version == "editable":
            # There the sources are read whenever they are asked for.
            return
        root = Path(self.root)
        index = _load(root / "lietool" / "verbs" / "_equations_index.py")
        listed = index.catalogue(root / "lietool" / "verbs" / "equations.toml")
        found = index.scan(root / "lietool", root / "figures", root / "tests")
        self._folder = tempfile.TemporaryDirectory(prefix="lietool-build-")
        file = Path(self._folder.name, "equations.json")
        file.write_text(index.dumps(index.join(listed, found)), encoding="utf-8")
        build_data["force_include"][str(file)] = "lietool/verbs/equations.json"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove what `initialize` wrote."""
        if version != "editable":
            self._folder.cleanup()


def _load(file: Path) -> Any:
    """Import one file that needs the standard library only, without the package around it."""
    spec = importlib.util.spec_from_file_location(file.stem, file)
    if spec is None or spec.loader is None:
        raise FileNotFoundError(file)
    module = importlib.util.module_from_spec(spec)
    # Dataclasses look their module up by its name.
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    return module
