"""What of a mesh file is passed on: positions and faces, each line looked at, so that errors name it."""

import re
from collections.abc import Iterator

from lietool.mesh.files import Place


def clean_obj(place: Place, text: str) -> str:
    """Return the positions and faces of a Wavefront file alone."""
    kept: list[str] = []
    faces: list[tuple[int, list[int]]] = []
    count = 0
    for number, words in _lines(text.replace("\\\n", " ")):
        if words[0] == "v":
            _check_position(place, words[1:], number, most=7)
            kept.append("v " + " ".join([*words[1:4], "0"][:3]))
            count += 1
        elif words[0] == "f":
            indices = [w.split("/")[0] for w in words[1:]]
            if len(indices) < 3 or not all(re.fullmatch(r"-?[0-9]+", w) and int(w) for w in indices):
                place.fail("a mesh whose faces are indices from 1, at least three", _short(words), number)
            # Negative ones count back from the position read last.
            faces.append((number, [int(w) if int(w) > 0 else count + 1 + int(w) for w in indices]))
        elif not re.fullmatch(r"[A-Za-z_]\w*", words[0]):
            place.fail("a mesh, .obj", _short(words), number)
    for number, indices in faces:
        _check_range(place, indices, 1, count, number)
        kept.append("f " + " ".join(map(str, indices)))
    _check_any(place, count, len(faces))
    return "\n".join(kept) + "\n"


def clean_off(place: Place, text: str) -> str:
    """Return the positions and faces of an Object File Format file alone."""
    lines = _lines(text)
    number, words = next(lines, (1, []))
    if words and words[0] == "OFF":
        words = words[1:]
    elif words and not words[0].isdigit():
        remedy = "Normals, colours and binary files of this format are not read."
        place.fail("a mesh that begins with OFF", _short(words), number, remedy)
    if not words:
        number, words = next(lines, (number, []))
    if not 2 <= len(words) <= 3 or not all(w.isdigit() for w in words):
        place.fail("a mesh that begins with OFF and its numbers of vertices and faces", _short(words), number)
    count, total = int(words[0]), int(words[1])
    _check_any(place, count, total)
    kept = ["OFF", f"{count} {total} 0"]
    for i in range(count + total):
        what = f"vertex {i} of {count}" if i < count else f"face {i - count} of {total}"
        number, words = next(lines, (-1, []))
        if number < 0:
            place.fail(f"a whole mesh, with {what}", "its end")
        if i < count:
            _check_position(place, words, number, most=7)
            kept.append(" ".join([*words, "0"][:3]))
            continue
        corners = words[1 : 1 + int(words[0])] if words[0].isdigit() else []
        if len(corners) < 3 or len(corners) != int(words[0]) or not all(w.isdigit() for w in corners):
            place.fail(f"a mesh with {what}: a count, at least 3, and as many indices", _short(words), number)
        _check_range(place, [int(w) for w in corners], 0, count - 1, number)
        kept.append(" ".join([words[0], *corners]))
    return "\n".join(kept) + "\n"


def flat_ply(place: Place, data: bytes) -> bytes:
    """Return a Stanford file whose header has been looked at."""
    if not data.startswith(b"ply"):
        place.fail("a mesh that begins with ply", repr(data[:10].decode("ascii", "replace")), 1)
    head, found, body = data.partition(b"end_header")
    if not found:
        place.fail("a mesh whose header has an end, end_header", "none")
    if not head.isascii() or (not body.isascii() and b"ascii" in head):
        place.fail("a mesh of plain letters, ASCII", "other bytes")
    text = head.decode("ascii")
    counts = {name: int(count) for name, count in re.findall(r"^\s*element\s+(\w+)\s+(\d+)", text, re.M)}
    names = re.findall(r"^\s*property\s+\w+\s+(\w+)\s*$", text, re.M)
    if not {"x", "y"} <= set(names):
        place.fail("a mesh whose vertices have x and y", f"{', '.join(names[:6]) or 'no properties'}")
    _check_any(place, counts.get("vertex", 0), counts.get("face", 0))
    if not re.search(r"^\s*property\s+list\s+\w+\s+\w+\s+vertex_ind(ex|ices)\s*$", text, re.M):
        place.fail("a mesh whose faces are a list, vertex_indices", "no such property")
    ascii_ = re.search(r"^\s*format\s+ascii", text, re.M) is not None
    if ascii_:
        _check_ply_lines(place, text, body.decode("ascii"), sum(counts.values()))
    if "z" in names:
        return data
    if not ascii_:
        place.fail("a mesh whose vertices have z as well, as it is binary", "none", remedy="Save it as text.")
    return _with_z(text, body.decode("ascii"), counts["vertex"]).encode("ascii")


def _check_ply_lines(place: Place, head: str, body: str, wanted: int) -> None:
    first = head.count("\n") + 2
    lines = [(i, line.split()) for i, line in enumerate(body.split("\n")[1:], first) if line.strip()]
    for number, words in lines:
        if not all(_is_number(w) for w in words):
            place.fail("a mesh of finite numbers", _short(words), number)
    if len(lines) < wanted:
        place.fail(f"a whole mesh, with {wanted} lines after its header", f"{len(lines)}")


def _with_z(head: str, body: str, count: int) -> str:
    """Return a flat file with z = 0 behind the properties of its vertices."""
    lines = head.split("\n")
    start = next(i for i, line in enumerate(lines) if line.split()[:2] == ["element", "vertex"])
    stop = next((i for i in range(start + 1, len(lines)) if not lines[i].startswith("property")), len(lines))
    lines.insert(stop, "property float z")
    rows = [line for line in body.split("\n")[1:] if line.strip()]
    rows[:count] = [f"{line.rstrip()} 0" for line in rows[:count]]
    return "\n".join(lines) + "end_header\n" + "\n".join(rows) + "\n"


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    for number, line in enumerate(text.splitlines(), 1):
        words = line.split("#")[0].split()
        if words:
            yield number, words


def _is_number(word: str) -> bool:
    try:
        return abs(float(word)) <= 1e100
    except ValueError:
        return False


def _check_position(place: Place, words: list[str], line: int, most: int) -> None:
    if not 2 <= len(words) <= most or not all(_is_number(w) for w in words):
        place.fail("a mesh whose positions are two or three finite numbers", _short(words), line)


def _check_range(place: Place, indices: list[int], low: int, high: int, line: int) -> None:
    for i in indices:
        if not low <= i <= high:
            place.fail(f"a mesh whose faces use its vertices, {low} to {high}", f"{i}", line)


def _check_any(place: Place, vertices: int, faces: int) -> None:
    if not vertices or not faces:
        place.fail("a mesh with faces", f"{vertices} vertices and {faces} faces")


def _short(words: list[str]) -> str:
    text = " ".join(words)
    return repr(text if len(text) <= 40 else text[:37] + "...")
