"""Values between the grader and a student's process: a head of JSON, then the bytes of its arrays.

Both sides use it: the grader imports it, and the student's process, which knows no
lietool, reads it as a file.
Nothing is ever pickled: a head says of each array its type and shape, and only types of numbers are known.
"""

import json
import math
import re
import struct
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

# A head is some hundred characters long; the source comes in one.
HEAD = 8 << 20
_LENGTH = struct.Struct(">I")
_TYPE = re.compile(r"[<>|]([biufc])(1|2|4|8|16)")
# Arrays in one answer.
_MOST_PARTS = 100
# Of tuples in tuples, so that no answer is deeper than the one who reads it can go.
_DEPTH = 8


class WireError(ValueError):
    """What came is no message, or what was to be sent is no value."""


def pack(head: dict[str, Any], values: Sequence[Any] = ()) -> bytes:
    """Return a message.

    Parameters
    ----------
    head : dict
        What JSON can say; its key "values" is taken.
    values : sequence
        Arrays and scalars of numbers, numbers, texts, None, and tuples and lists of these.

    Returns
    -------
    bytes
        Four bytes of length, the head, and the arrays' bytes.

    Raises
    ------
    WireError
        If a value is none of these.
    """
    blobs: list[bytes] = []
    told = [_told(value, blobs) for value in values]
    text = json.dumps({**head, "values": told, "sizes": [len(blob) for blob in blobs]}).encode()
    return b"".join((_LENGTH.pack(len(text)), text, *blobs))


def _told(value: Any, blobs: list[bytes]) -> Any:
    # The exact types: numpy's double is a float too, and comes back as what it was.
    if value is None or type(value) in (bool, int, float, str):
        return value
    if type(value) is complex:
        return {"c": [value.real, value.imag]}
    if isinstance(value, np.ndarray | np.generic):
        if value.dtype.kind not in "biufc":
            raise WireError(f"an array of dtype {value.dtype}")
        blobs.append(value.tobytes())
        key = "a" if isinstance(value, np.ndarray) else "g"
        return {key: [value.dtype.str, list(value.shape)]}
    if isinstance(value, tuple | list):
        return {"t" if isinstance(value, tuple) else "l": [_told(part, blobs) for part in value]}
    raise WireError(f"a {type(value).__name__}")


def length(start: bytes | bytearray) -> int:
    """Return how long the head is, from the first four bytes."""
    (size,) = _LENGTH.unpack_from(start)
    if size > HEAD:
        raise WireError(f"a head of {size} bytes")
    return size


def head(text: bytes | bytearray) -> tuple[dict[str, Any], list[int]]:
    """Return a message's head, and how long the blobs are that follow it."""
    try:
        found = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise WireError("a head that is no JSON") from error
    if not isinstance(found, dict) or not isinstance(found.get("values"), list):
        raise WireError("a head without values")
    sizes = found.get("sizes")
    if not isinstance(sizes, list) or not all(type(size) is int and size >= 0 for size in sizes):
        raise WireError("a head without sizes")
    return found, sizes


def values(found: dict[str, Any], blobs: Sequence[bytes | bytearray]) -> list[Any]:
    """Return the values of a message.

    Parameters
    ----------
    found : dict
        From `head`.
    blobs : sequence of bytes
        As long as it said.

    Returns
    -------
    list
        Its values; arrays are copies that may be written.
    """
    left = iter(blobs)
    read = [_value(told, left, 0) for told in found["values"]]
    if next(left, None) is not None:
        raise WireError("bytes that belong to no array")
    return read


def _value(told: Any, blobs: Iterator[bytes | bytearray], depth: int) -> Any:
    if told is None or type(told) in (bool, int, float, str):
        return told
    if not isinstance(told, dict) or len(told) != 1 or depth > _DEPTH:
        raise WireError("a value of no kind")
    ((kind, inner),) = told.items()
    if not isinstance(inner, list):
        raise WireError("a value of no kind")
    if kind == "t":
        return tuple(_value(part, blobs, depth + 1) for part in inner)
    if kind == "l":
        return [_value(part, blobs, depth + 1) for part in inner]
    if kind == "c" and len(inner) == 2 and all(type(part) in (int, float) for part in inner):
        return complex(*inner)
    if kind in ("a", "g") and len(inner) == 2:
        array = _array(inner[0], inner[1], next(blobs, b""))
        return array if kind == "a" else array[()]
    raise WireError("a value of no kind")


def _array(kind: Any, shape: Any, blob: bytes | bytearray) -> np.ndarray:
    if not isinstance(kind, str) or not _TYPE.fullmatch(kind):
        raise WireError("an array of no numbers")
    if not isinstance(shape, list) or len(shape) > 32 or not all(type(n) is int and n >= 0 for n in shape):
        raise WireError("an array of no shape")
    try:
        dtype = np.dtype(kind)
    except TypeError as error:
        raise WireError("an array of no numbers") from error
    if math.prod(shape) * dtype.itemsize != len(blob):
        raise WireError(f"an array of shape {tuple(shape)} in {len(blob)} bytes")
    try:
        return np.frombuffer(bytearray(blob), dtype).reshape(shape)
    except ValueError as error:
        raise WireError(f"an array of shape {tuple(shape)}") from error


class Incoming:
    """An answer that comes in pieces; no more is taken in than it may be long."""

    def __init__(self, most: int) -> None:
        self._most, self._data = most, bytearray()
        self._begins, self._sizes = 0, [0]
        self._head: dict[str, Any] | None = None

    def feed(self, data: bytes) -> bool:
        """Take in a piece; return whether it is whole."""
        self._data += data
        if self._head is None:
            if len(self._data) < 4 or len(self._data) < 4 + length(self._data):
                return False
            self._begins = 4 + length(self._data)
            self._head, self._sizes = head(self._data[4 : self._begins])
            # A list of numbers may be long where the arrays are none.
            if sum(self._sizes) > self._most or len(self._sizes) > _MOST_PARTS:
                raise WireError(f"{sum(self._sizes)} bytes in {len(self._sizes)} arrays")
        left = len(self._data) - self._begins - sum(self._sizes)
        if left > 0:
            raise WireError("more than one answer")
        return left == 0

    def message(self) -> tuple[dict[str, Any], list[Any]]:
        """Return the head and the values."""
        assert self._head is not None
        blobs, at = [], self._begins
        for size in self._sizes:
            blobs.append(self._data[at : at + size])
            at += size
        return self._head, values(self._head, blobs)
