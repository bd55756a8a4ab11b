"""What OpenGL is asked to do: buffers of fine samples, shader programs, batches drawn, pixels averaged."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources

import moderngl
import numpy as np

from lietool.render import context
from lietool.render.batches import Batch

_LAYOUT = {
    "surface": ("3f 3f 4f 1f", ("in_position", "in_normal", "in_color", "in_material")),
    "lines": (
        "3f 3f 3f 3f 4f 4f 1f 1f/i",
        ("in_before", "in_a", "in_b", "in_after", "in_color_a", "in_color_b", "in_half_width", "in_lift"),
    ),
    "points": (
        "3f 4f 4f 1f 1f 1f/i",
        ("in_position", "in_color", "in_rim", "in_radius", "in_shaded", "in_lift"),
    ),
    "image": ("3f 3f 3f/i", ("in_corner", "in_across", "in_up")),
}


@dataclass(frozen=True, eq=False)
class Target:
    """A buffer of fine samples, the texture that they are read from, and one of pixels."""

    samples: moderngl.Framebuffer
    texture: moderngl.Texture
    pixels: moderngl.Framebuffer


@lru_cache(maxsize=2)
def target(width: int, height: int, per_side: int) -> Target:
    """Return the buffers for so many pixels, each of so many samples by as many."""
    gl = context.get().gl
    fine = (width * per_side, height * per_side)
    texture = gl.texture(fine, 4, dtype="f2")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    samples = gl.framebuffer([texture], gl.depth_renderbuffer(fine))
    return Target(samples, texture, gl.framebuffer([gl.renderbuffer((width, height), 4, dtype="f2")]))


@lru_cache(maxsize=8)
def program(name: str) -> moderngl.Program:
    """Return a shader program of ``shaders/``, compiled once a process."""
    folder = resources.files("lietool.render") / "shaders"
    read = [(folder / f"{name}.{kind}").read_text() for kind in ("vert", "frag")]
    return context.get().gl.program(vertex_shader=read[0], fragment_shader=read[1])


def clear_depth(samples: moderngl.Framebuffer) -> None:
    """Begin a view: its depths cannot be compared with those of the views under it."""
    samples.color_mask = (False, False, False, False)
    samples.clear()
    samples.color_mask = (True, True, True, True)
    samples.use()


def draw(gl: moderngl.Context, batch: Batch, uniforms: Mapping[str, bytes], flat: bool) -> None:
    """Draw the rows of a batch, on a page where `flat`."""
    kind, data = batch.kind, batch.data
    name = "surface" if kind.startswith("glass") else kind
    shader = program(name)
    for key, value in uniforms.items():
        if key in shader:
            shader[key].write(value)  # type: ignore[union-attr]
    if name == "surface":
        shader["side"] = {"glass far": -1.0, "glass near": 1.0}.get(kind, 0.0)
        shader["lens"] = not flat
    texture = None if batch.texels is None else _texture(gl, batch.texels, batch.smooth)
    layout, attributes = _LAYOUT[name]
    buffer = gl.buffer(np.ascontiguousarray(data, "f4"))
    array = gl.vertex_array(shader, [(buffer, layout, *attributes)])
    if name == "surface":
        array.render(moderngl.TRIANGLES)
    else:
        array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=len(data))
    array.release()
    buffer.release()
    if texture:
        texture.release()


def _texture(gl: moderngl.Context, texels: np.ndarray, smooth: bool) -> moderngl.Texture:
    height, width = texels.shape[:2]
    texture = gl.texture((width, height), 4, np.ascontiguousarray(texels, "f2"), dtype="f2")
    texture.filter = (moderngl.LINEAR, moderngl.LINEAR) if smooth else (moderngl.NEAREST, moderngl.NEAREST)
    texture.repeat_x = texture.repeat_y = False
    texture.use(0)
    return texture


def resolve(gl: moderngl.Context, target: Target, per_side: int) -> np.ndarray:
    """Return the means of the samples as the bits of half floats, uint16 (h, w, 4), the upper row first."""
    target.pixels.use()
    gl.enable_only(moderngl.NOTHING)
    shader = program("resolve")
    shader["per_side"] = per_side
    target.texture.use(0)
    array = gl.vertex_array(shader, [])
    array.render(moderngl.TRIANGLES, vertices=3)
    array.release()
    width, height = target.pixels.size
    raw = np.frombuffer(target.pixels.read(components=4, dtype="f2"), np.uint16)
    return raw.reshape(height, width, 4)[::-1]
