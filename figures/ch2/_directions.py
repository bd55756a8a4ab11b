"""Vectors that a user gives as directions."""

import numpy as np


def length(v: tuple[float, ...]) -> float:
    """Return |v|, which neither overflows nor vanishes on the way."""
    largest = float(np.max(np.abs(v)))
    return largest * float(np.linalg.norm(np.array(v) / largest)) if largest else 0.0


def unit(name: str, v: tuple[float, ...]) -> np.ndarray:
    """Return v / |v| for the parameter `name`.

    Raises
    ------
    ValueError
        If it has no direction, or is so long or short that its digits are lost.
    """
    if not 1e-150 < length(v) < 1e150:
        example = ",".join("1" if k == 0 else "0" for k in range(len(v)))
        raise ValueError(
            f"{name} must have a length of 1e-150 to 1e150; got {v}. Write for example {example}"
        )
    return np.array(v) / length(v)
