"""The numbers that a picture shows: to JSON and back without losing a bit.

A nested dict of arrays, floats, integers, texts and truth values becomes JSON
that any program reads: a scalar is itself, an array is
``{"dtype": "float64", "shape": [2, 3], "data": [...]}`` with its data flat, the
last index fastest.  Every float64 is written with the digits that bring back
the same bits.  JSON has no NaN and no infinity, so within such an array they
are the texts "NaN", "Infinity" and "-Infinity"; `nonfinite` lists them, for a
golden is no place for them.
"""

import json
import math
from collections.abc import Iterator, Mapping

import numpy as np

_ARRAY = {"dtype", "shape", "data"}
_SPECIAL = {"NaN": math.nan, "Infinity": math.inf, "-Infinity": -math.inf}
KINDS = {"b": "truth values", "i": "integers", "u": "integers", "f": "floats", "U": "texts"}

Numbers = Mapping[str, object]


def dumps(values: Numbers) -> str:
    """Write numbers as JSON text, one row of an array to a line.

    Parameters
    ----------
    values : Mapping[str, object]
        Nested; its keys are texts, its leaves arrays or scalars.

    Returns
    -------
    str
        Strict JSON, the same text for the same numbers.

    Raises
    ------
    ValueError
        If an entry is none of the kinds that can be kept.
    """
    return _write(plain(values), "") + "\n"


def plain(values: Numbers) -> dict[str, object]:
    """Turn numbers into what any JSON writer takes, for output beside other things.

    Parameters
    ----------
    values : Mapping[str, object]
        As for `dumps`.

    Returns
    -------
    dict
        Of dicts, lists, texts, floats, integers and truth values.

    Raises
    ------
    ValueError
        As `dumps`.
    """
    return {key: _plain(_key(key, ""), value) for key, value in values.items()}


def loads(text: str) -> dict[str, object]:
    """Read back what `dumps` wrote.

    Parameters
    ----------
    text : str
        JSON.

    Returns
    -------
    dict
        With the arrays, of the same type and shape, and the scalars.

    Raises
    ------
    ValueError
        If the text is not JSON of this form.
    """
    try:
        read = json.loads(text, parse_constant=_refuse_constant)
        if not isinstance(read, dict):
            raise ValueError(f"a {type(read).__name__} at the top")
        return {key: _unplain(value) for key, value in read.items()}
    except (ValueError, TypeError, KeyError, OverflowError, RecursionError) as error:
        raise ValueError(
            f"numbers.loads: text must be the JSON that dumps writes; got {error}. Write it again."
        ) from error


def nonfinite(values: Numbers) -> list[str]:
    """List the entries that hold NaN or an infinity, with the index of the first.

    Parameters
    ----------
    values : Mapping[str, object]
        As for `dumps`.

    Returns
    -------
    list of str
        Such as "angles[3, 1] is nan"; empty when all is finite.
    """
    found = []
    for entry, value in leaves(values):
        array = array_of(entry, value)
        if array.dtype.kind == "f" and not np.isfinite(array).all():
            index = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
            found.append(f"{entry}{list(index) if index else ''} is {float(array[index])}")
    return found


def leaves(values: Numbers, under: str = "") -> Iterator[tuple[str, object]]:
    """Walk through the entries, each with its dotted name.

    Parameters
    ----------
    values : Mapping[str, object]
        As for `dumps`.
    under : str
        What the names begin with.

    Returns
    -------
    iterator of (str, object)
        Such as ("euler.angles", array).
    """
    for key, value in values.items():
        entry = under + _key(key, under)
        if isinstance(value, Mapping):
            yield from leaves(value, entry + ".")
        else:
            yield entry, value


def _key(key: object, under: str) -> str:
    if not isinstance(key, str) or not key or key in _ARRAY:
        raise ValueError(
            f"numbers.dumps: keys must be texts other than dtype, shape, data; got {key!r}"
            f" in {under or 'the top'}. Rename it."
        )
    return key


def array_of(entry: str, value: object) -> np.ndarray:
    """Make an array of any leaf, so that there is one way to compare and one to refuse.

    Parameters
    ----------
    entry : str
        Its name, for the message.
    value : object
        An array, a scalar or a sequence of them.

    Returns
    -------
    ndarray
        Of one of the kinds that can be kept.

    Raises
    ------
    ValueError
        If it is none of them.
    """
    ragged = "a sequence of unlike things"
    try:
        array = np.asarray(value)
    except ValueError:
        array, got = np.array(None), ragged
    else:
        got = f"{type(value).__name__} of {array.dtype}" if array.ndim else type(value).__name__
    if array.dtype.kind == "U" and isinstance(value, list | tuple) and not _all_texts(value):
        array, got = np.array(None), ragged
    if array.dtype.kind not in KINDS or (array.dtype.kind == "f" and array.dtype.itemsize > 8):
        raise ValueError(
            f"numbers.dumps: {entry} must be floats, integers, texts or truth values; got {got}. "
            "Split it into entries of one kind (a complex array into its two parts)."
        )
    return array


def _all_texts(value: object) -> bool:
    return all(map(_all_texts, value)) if isinstance(value, list | tuple) else isinstance(value, str)


def _plain(entry: str, value: object) -> object:
    if isinstance(value, Mapping):
        return {key: _plain(f"{entry}.{_key(key, entry)}", inner) for key, inner in value.items()}
    array = array_of(entry, value)
    if array.ndim == 0 and (array.dtype.kind != "f" or np.isfinite(array)):
        return array.item()
    data = array.reshape(-1).tolist()
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        data = [number if math.isfinite(number) else _name(number) for number in data]
    dtype = "str" if array.dtype.kind == "U" else array.dtype.name
    return {"dtype": dtype, "shape": list(array.shape), "data": data}


def _name(number: float) -> str:
    return "NaN" if math.isnan(number) else "Infinity" if number > 0 else "-Infinity"


def _unplain(value: object) -> object:
    if not isinstance(value, dict):
        if not isinstance(value, bool | int | float | str):
            raise ValueError(f"a bare {type(value).__name__}")
        return value
    if set(value) != _ARRAY:
        return {key: _unplain(inner) for key, inner in value.items()}
    dtype = np.dtype(value["dtype"])
    if dtype.kind not in KINDS:
        raise ValueError(f"an array of {dtype}")
    data = (
        [_SPECIAL[x] if isinstance(x, str) else x for x in value["data"]]
        if dtype.kind == "f"
        else value["data"]
    )
    array = np.array(data, dtype).reshape(value["shape"])
    return array if array.ndim else array.item()


def _refuse_constant(name: str) -> float:
    raise ValueError(f"a bare {name}")


def _write(value: object, margin: str) -> str:
    if not isinstance(value, dict):
        return json.dumps(value, ensure_ascii=False)
    inner = margin + "  "
    if set(value) == _ARRAY:
        return _write_array(value, inner)
    if not value:
        return "{}"
    lines = [
        f"{inner}{json.dumps(key, ensure_ascii=False)}: {_write(item, inner)}" for key, item in value.items()
    ]
    return "{\n" + ",\n".join(lines) + f"\n{margin}}}"


def _write_array(value: dict, margin: str) -> str:
    data, shape = value["data"], value["shape"]
    row = shape[-1] if len(shape) > 1 and shape[-1] else max(len(data), 1)
    rows = [
        ", ".join(json.dumps(item, ensure_ascii=False) for item in data[i : i + row])
        for i in range(0, len(data), row)
    ]
    gap = f"\n{margin}  "
    body = (gap + f",{gap}".join(rows) + f"\n{margin}") if len(rows) > 1 else "".join(rows)
    return f'{{"dtype": "{value["dtype"]}", "shape": {json.dumps(shape)}, "data": [{body}]}}'
