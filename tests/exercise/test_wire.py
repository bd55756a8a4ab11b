"""Messages between the grader and a student's process: what is none is refused, and no pickle is read."""

import struct
from collections.abc import Sequence

import numpy as np
import pytest

from lietool.exercise import _student_wire

_THREE = np.zeros(3).tobytes()


@pytest.mark.parametrize(
    ("head", "blobs"),
    [
        (b"[]", []),
        (b"{}", []),
        (b'{"values": [], "sizes": [-1]}', []),
        (b'{"values": [], "sizes": [1e9]}', []),
        (b'{"values": [], "sizes": [99999999999]}', []),
        (b'{"values": [], "sizes": ' + str([0] * 1000).encode() + b"}", []),
        (b"\xff\xfe", []),
        (b"[" * 100_000, []),
        (b"1" * 100_000, []),
        (b'{"values": [{"a": ["<f8", [3]]}], "sizes": [16]}', [_THREE[:16]]),
        (b'{"values": [{"a": ["<f8", [-3]]}], "sizes": [24]}', [_THREE]),
        (b'{"values": [{"a": ["<f8", [3]]}], "sizes": []}', []),
        (b'{"values": [{"a": ["<f8", [10000000000]]}], "sizes": [24]}', [_THREE]),
        (b'{"values": [{"a": ["|O8", [3]]}], "sizes": [24]}', [_THREE]),
        (b'{"values": [{"a": ["<U2", [3]]}], "sizes": [24]}', [_THREE]),
        (b'{"values": [{"a": ["<M8[s]", [3]]}], "sizes": [24]}', [_THREE]),
        (b'{"values": [{"a": ["f8,f8", [3]]}], "sizes": [24]}', [_THREE]),
        (b'{"values": [{"a": ["<f1", [24]]}], "sizes": [24]}', [_THREE]),
        (b'{"values": [{"a": ["<f8", [true, 3]]}], "sizes": [24]}', [_THREE]),
        (b'{"values": [{"a": ["<f8", ' + str([1] * 99).encode() + b']}], "sizes": [8]}', [_THREE[:8]]),
        (b'{"values": [{"a": ["<f8", 3]}], "sizes": [24]}', [_THREE]),
        (b'{"values": [{"b": 3}], "sizes": []}', []),
        (b'{"values": [{"t": 3}], "sizes": []}', []),
        (b'{"values": [{"c": [1, "2"]}], "sizes": []}', []),
        (b'{"values": ' + b"[" + b'{"t":[' * 50 + b"]}" * 50 + b"]" + b', "sizes": []}', []),
        (b'{"values": [], "sizes": [24]}', [_THREE]),
    ],
)
def test_a_message_that_is_none_is_refused(head: bytes, blobs: Sequence[bytes]) -> None:
    incoming = _student_wire.Incoming(1 << 20)
    with pytest.raises(_student_wire.WireError) as caught:
        incoming.feed(struct.pack(">I", len(head)))
        incoming.feed(head + b"".join(blobs))
        incoming.message()
    assert "\n" not in str(caught.value)


def test_a_message_in_pieces_is_put_together() -> None:
    message = _student_wire.pack({"id": 3}, [np.arange(3.0), (1.0, [np.float32(2), None]), "x"])
    incoming = _student_wire.Incoming(1 << 20)
    whole = [incoming.feed(message[i : i + 1]) for i in range(len(message))]
    assert whole == [False] * (len(message) - 1) + [True]
    head, values = incoming.message()
    assert head["id"] == 3 and np.array_equal(values[0], np.arange(3.0))
    assert values[1:] == [(1.0, [np.float32(2), None]), "x"]
    with pytest.raises(_student_wire.WireError, match="more than one answer"):
        incoming.feed(b"x")
