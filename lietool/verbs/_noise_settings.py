"""Harmless ways to draw the same: backends, threads, and what processors Mesa and numpy are told of."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

BACKENDS = ("osmesa", "egl")
THREADS = (0, 1, 2, 7)
# Whatever the processor has, and less.
CAPS = ("", "avx", "sse4.1", "sse2")
WIDTHS = (128, 256)

# Sums come in another order, and the last bit of a coordinate with them.
COMPUTING = ("as it is", "short vectors", "haswell")
# What a setting decides, so that nothing of the caller's is left of it.
_DECIDED = (
    "LIETOOL_BACKEND",
    "LP_NUM_THREADS",
    "LP_NATIVE_VECTOR_WIDTH",
    "GALLIUM_OVERRIDE_CPU_CAPS",
    "GALLIUM_DRIVER",
    "MESA_SHADER_CACHE_DIR",
    "NPY_DISABLE_CPU_FEATURES",
    "OPENBLAS_CORETYPE",
)


@dataclass(frozen=True)
class Setting:
    """One way to draw: of `CAPS` the empty text is what the processor has, `computing` one of `COMPUTING`."""

    backend: str = "osmesa"
    threads: int = 2
    caps: str = ""
    width: int = 256
    computing: str = COMPUTING[0]

    def __str__(self) -> str:
        """Say it in one line."""
        computed = "" if self.computing == COMPUTING[0] else f", computed with {self.computing}"
        return f"{self.backend}, {self.threads} threads, {self.caps or 'all'} {self.width} bits{computed}"

    @property
    def shaders(self) -> str:
        """The name of a folder for compiled shaders, which Mesa does not tell apart by processor."""
        return f"shaders-{self.caps or 'all'}-{self.width}"


def every(backends: Sequence[str] = BACKENDS) -> list[Setting]:
    """List all combinations that are drawn, and the usual one with each way of computing."""
    found = [
        Setting(backend, threads, caps, width)
        for backend in backends
        for caps in CAPS
        for width in WIDTHS
        for threads in THREADS
    ]
    return [*found, *_computed()]


def few(backends: Sequence[str] = BACKENDS) -> list[Setting]:
    """List the settings that are farthest from each other: enough to notice what any of them would."""
    found = [Setting(backends[0], 1, "sse2", 128), Setting(backends[-1], 7, "avx", 128)]
    return [*found, *_computed()]


def _computed() -> Iterator[Setting]:
    return (Setting(computing=name) for name in COMPUTING[1:])


def _computing(name: str) -> dict[str, str]:
    """What makes numpy and its BLAS compute as on another processor."""
    import numpy as np

    if name == COMPUTING[0]:
        return {}
    if name == "haswell":
        return {"OPENBLAS_CORETYPE": "Haswell"}
    # Which there are to leave out differs between numpy's versions, and it warns of others.
    found = np.show_config(mode="dicts").get("SIMD Extensions", {}).get("found", [])
    return {"NPY_DISABLE_CPU_FEATURES": " ".join(found), "OPENBLAS_CORETYPE": "Prescott"}


def environment(setting: Setting, shaders: str) -> dict[str, str]:
    """Return all variables of a process that draws in this way.

    Parameters
    ----------
    setting : Setting
        The way.
    shaders : str
        Folder for compiled shaders.

    Returns
    -------
    dict
        This process's, with what the setting decides.
    """
    mesa = {
        "LIETOOL_BACKEND": setting.backend,
        "LP_NUM_THREADS": str(setting.threads),
        "LP_NATIVE_VECTOR_WIDTH": str(setting.width),
        "MESA_SHADER_CACHE_DIR": shaders,
    }
    caps = {"GALLIUM_OVERRIDE_CPU_CAPS": setting.caps} if setting.caps else {}
    return kept() | mesa | caps | _computing(setting.computing)


def kept() -> dict[str, str]:
    """Return this process's variables without what a setting decides."""
    return {name: value for name, value in os.environ.items() if name not in _DECIDED}
