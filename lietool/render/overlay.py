"""Colours for programs that blend them as encoded: viewers of SVG and PDF know no linear light.

What is half transparent looks another way there.  So opacity and colour are chosen anew: laid over the
paper they give what linear light gives, and the colour stays as near as may be to what it was.
"""

import numpy as np

# Between opacities that an image of bytes can have.
_LEVELS = 255.0


def encoded(light: np.ndarray) -> np.ndarray:
    """Return linear light as sRGB, 0 to 1."""
    light = np.clip(light, 0.0, 1.0)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1.0 / 2.4) - 0.055)


def colors(rgba: np.ndarray, paper: np.ndarray) -> np.ndarray:
    """Return colours to be blended as encoded.

    Parameters
    ----------
    rgba : ndarray, shape (..., 4)
        Linear red, green, blue and the opacity, not premultiplied.
    paper : ndarray, shape (3,)
        Linear.

    Returns
    -------
    ndarray, shape (..., 4)
        sRGB and opacity, 0 to 1, not premultiplied.
    """
    rgba = np.asarray(rgba, float)
    alpha = rgba[..., 3:]
    target = encoded(rgba[..., :3] * alpha + paper * (1.0 - alpha))
    return _over(target, encoded(rgba[..., :3]), alpha, encoded(paper))


def pixels(samples: np.ndarray, paper: np.ndarray) -> np.ndarray:
    """Return an image to be blended as encoded.

    Parameters
    ----------
    samples : ndarray, shape (h, w, 4)
        Linear light, premultiplied, and the opacity.
    paper : ndarray, shape (3,)
        Linear.

    Returns
    -------
    ndarray of uint8, shape (h, w, 4)
        sRGB and opacity, not premultiplied.
    """
    alpha = np.clip(samples[..., 3:].astype(np.float32), 0.0, 1.0)
    light, paper = samples[..., :3].astype(np.float32), paper.astype(np.float32)
    target = encoded(light + paper * (1.0 - alpha))
    own = encoded(light / np.maximum(alpha, 1e-6))
    return np.rint(_LEVELS * _over(target, own, alpha, encoded(paper), _LEVELS)).astype(np.uint8)


def _over(
    target: np.ndarray, own: np.ndarray, alpha: np.ndarray, paper: np.ndarray, levels: float = 0.0
) -> np.ndarray:
    """The colour and opacity that give `target` over `paper`; `own` is the colour without the paper."""
    change, toward = target - paper, own - paper
    length = np.sum(toward * toward, axis=-1, keepdims=True)
    share = np.sum(change * toward, axis=-1, keepdims=True) / np.maximum(length, 1e-12)
    share = np.where(length > 1e-6, share, alpha)
    # With less than this no colour reaches the target.
    room = np.where(change > 0.0, 1.0 - paper, paper)
    least = np.max(np.abs(change) / np.maximum(room, 1e-6), axis=-1, keepdims=True)
    share = np.where(alpha >= 1.0, 1.0, np.clip(np.maximum(share, least), 0.0, 1.0))
    if levels:
        share = np.ceil(levels * share - 1e-3) / levels
    share = np.where(alpha > 0.0, share, 0.0)
    color = paper + change / np.where(share > 0.0, share, 1.0)
    return np.concatenate([np.clip(color, 0.0, 1.0), share], axis=-1)
