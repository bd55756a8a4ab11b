"""The groups of numbers of `groups`: complex and quaternion, dual and not; nothing here checks its input."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from lietool.lie import dual_complex, dual_quaternion, quaternion
from lietool.lie.group_matrices import Array, Elements, same


def _complex(a: Array) -> NDArray[np.complex128]:
    return a[..., 0::2] + 1j * a[..., 1::2]


def _real(z: NDArray[np.complex128]) -> Array:
    return np.stack([z.real, z.imag], axis=-1).reshape(*z.shape[:-1], -1)


def _complex_product(a: Array, b: Array) -> Array:
    return _real(_complex(a) * _complex(b))


def _unit_dual_defect(a: Array) -> Array:
    z, w = a[..., :4], a[..., 4:]
    return np.maximum(np.abs(np.linalg.norm(z, axis=-1) - 1.0), np.abs(np.sum(z * w, axis=-1)))


def _numbers(
    unit: int,
    multiply: Callable[[Array, Array], Array],
    inverse: Callable[[Array], Array],
    project: Callable[[Array], Array] | None = None,
    defect: Callable[[Array], Array] | None = None,
) -> Elements:
    """Return numbers whose first `unit` components must not vanish; without `defect` that is all."""

    def inside(a: Array) -> NDArray[np.bool_]:
        return np.max(np.abs(a[..., :unit]), axis=-1) > 0

    change = project or same
    return Elements(defect or (lambda a: np.zeros(a.shape[:-1])), inside, change, change, multiply, inverse)


def _unit_defect(unit: int) -> Callable[[Array], Array]:
    return lambda a: np.abs(np.linalg.norm(a[..., :unit], axis=-1) - 1.0)


def _normalized(unit: int) -> Callable[[Array], Array]:
    return lambda a: a / np.linalg.norm(a[..., :unit], axis=-1, keepdims=True)


_C = (2, _complex_product, lambda a: _real(1.0 / _complex(a)))
_H = (4, quaternion.multiply, lambda a: quaternion.inverse(a, check=False))
_D = (4, dual_quaternion.multiply, lambda a: dual_quaternion.inverse(a, check=False))
_DUAL_C = (2, dual_complex.multiply, lambda a: dual_complex.inverse(a, check=False))

NUMBERS = {
    "C^x": _numbers(*_C),
    "S^1": _numbers(*_C, _normalized(2), _unit_defect(2)),
    "H^x": _numbers(*_H),
    "S^3": _numbers(*_H, _normalized(4), _unit_defect(4)),
    "DCN": _numbers(*_DUAL_C, _normalized(2), _unit_defect(2)),
    "DQ": _numbers(*_D, lambda a: dual_quaternion.normalize(a, check=False), _unit_dual_defect),
    "DQ^x": _numbers(*_D),
}


def _real_part(a: Array) -> Array:
    h = a.copy()
    h[..., a.shape[-1] // 2 :] = 0.0
    return h


ACTING = {
    **dict.fromkeys(("DCN", "DQ", "DQ^x"), _real_part),
    "C^x": _normalized(2),
    "H^x": _normalized(4),
}
"""The factor h of A = h k, by the name of the group."""
