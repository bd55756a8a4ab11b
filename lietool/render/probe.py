"""A backend tried out in a process of its own, so that one which crashes or hangs can be told of."""

import hashlib
import json
import os
import signal
import struct
import subprocess
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from lietool.paths import PACKAGE

# OpenGL is imported by the process that tries it, and its absence reported like any other failure.
if TYPE_CHECKING:
    import moderngl

SIZE = (64, 48)

_VERTEX = """#version 330
in vec2 place; in vec3 light; out vec3 colour;
void main() { colour = light; gl_Position = vec4(place, 0.0, 1.0); }
"""
_FRAGMENT = """#version 330
in vec3 colour; out vec4 result;
void main() { result = vec4(pow(colour, vec3(1.0 / 2.2)), 1.0); }
"""
_TRIANGLE = (-0.9, -0.8, 1, 0, 0, 0.95, -0.7, 0, 1, 0, 0.1, 0.9, 0, 0, 1)


def picture(gl: "moderngl.Context") -> bytes:
    """Return a small shaded triangle: the least that shows whether a renderer renders.

    Parameters
    ----------
    gl : moderngl.Context
        A context, current.

    Returns
    -------
    bytes
        RGBA rows of `SIZE`, from the bottom.
    """
    program = gl.program(vertex_shader=_VERTEX, fragment_shader=_FRAGMENT)
    corners = gl.buffer(struct.pack(f"{len(_TRIANGLE)}f", *_TRIANGLE))
    triangle = gl.vertex_array(program, [(corners, "2f 3f", "place", "light")])
    target = gl.framebuffer([gl.renderbuffer(SIZE)])
    target.use()
    target.clear(1.0, 1.0, 1.0, 1.0)
    triangle.render()
    return target.read(components=4)


def run(
    backend: str | None = None, env: Mapping[str, str] | None = None, timeout: float = 120
) -> dict[str, Any]:
    """Return what a fresh process finds when it renders.

    Parameters
    ----------
    backend : str, optional
        As in `context.get`.
    env : mapping, optional
        Variables set beside those of this process.
    timeout : float
        Seconds after which it counts as hung.

    Returns
    -------
    dict
        `Context.info` and ``picture``, the SHA-256 of its triangle; or ``error``, one line, with
        ``skipped`` when no backend worked.
    """
    find = f"import sys; sys.path.append({str(PACKAGE.parent)!r})"
    code = f"{find}; from lietool.render import probe; probe.main({backend!r})"
    try:
        done = subprocess.run(
            [sys.executable, "-c", code],
            env=os.environ | dict(env or {}),
            capture_output=True,
            text=True,
            timeout=timeout,
        )
    except subprocess.TimeoutExpired:
        return {"error": f"hung for {timeout:g} s"}
    if done.returncode < 0:
        return {"error": f"crashed with {signal.Signals(-done.returncode).name}"}
    if done.returncode > 0:
        return {"error": (done.stderr.strip().splitlines() or [f"ended with {done.returncode}"])[-1]}
    return json.loads(done.stdout)


def main(backend: str | None = None) -> None:
    """Print what `run` returns, as JSON.

    Parameters
    ----------
    backend : str, optional
        As in `context.get`.
    """
    from lietool.render import context

    try:
        found = context.get(backend)
    except context.NoRendererError as error:
        print(json.dumps({"error": str(error).partition("\n")[0], "skipped": error.tried}))
        return
    print(json.dumps(found.info | {"picture": hashlib.sha256(picture(found.gl)).hexdigest()}))
