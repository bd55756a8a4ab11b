"""The one OpenGL context of a process, from the first library that gives one.

OSMesa first, then EGL on a software device: both are Mesa's llvmpipe and draw
the same pixels.  Nothing outside this package knows where OpenGL comes from.
"""

import os
from dataclasses import dataclass, field
from typing import Any

import moderngl

from lietool.render import osmesa


class NoRendererError(RuntimeError):
    """Nothing on this machine can render; the message says what to install."""


@dataclass(frozen=True)
class Context:
    """The OpenGL context of this process."""

    gl: moderngl.Context
    backend: str
    canonical: bool
    info: dict[str, Any] = field(default_factory=dict)


_context: Context | None = None


def get(backend: str | None = None) -> Context:
    """Return the context of this process, made at the first call."""
    global _context
    if _context is None:
        try:
            loader = osmesa.Loader(osmesa.load())
        except OSError as error:
            raise NoRendererError(f"no OpenGL renderer: {error}") from None
        gl = moderngl.create_context(require=330, context=loader, standalone=True)
        gl.gc_mode = "auto"
        _context = Context(gl, "osmesa", gl.info["GL_RENDERER"].startswith("llvmpipe"))
    return _context
