"""The page of a report: what the template shows of each entry, as text that is ready to be read."""

import base64
import hashlib
import io
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from lietool.golden import elements, explain
from lietool.golden.compare_numbers import Difference
from lietool.golden.report import CHANGED, FAILED, PASSED, Entry

_HERE = Path(__file__).parent / "page"
_SCRIPTS = ("viewer.js", "review.js", "theme.js", "page.js")
_CALLED = {"expected": "expected", "actual": "actual"}
# Twice the size that it has in the list, for screens of fine pixels.
_THUMB = (128, 96)
_MOST_PLACES = 24
# What is said of a golden's making first; what is said elsewhere on the page is left out.
_FIRST = ("renderer", "backend", "mesa", "llvm", "reason", "date", "commit")
_ELSEWHERE = {"parameters", "plate", "command", "numbers-sha256", "label-keys"}
# These differ between any two runs.
_PASSING = {"date", "commit", "reason"}


def render(
    entries: Sequence[Entry], *, title: str, about: Mapping[str, str], notes: Sequence[str], review: str
) -> str:
    """Fill the template; parameters and result are those of `report.build`."""
    from markupsafe import Markup

    counts = {kind: sum(each.kind == kind for each in entries) for kind in (FAILED, CHANGED, PASSED)}
    return (
        environment()
        .get_template("page.html")
        .render(
            title=title,
            about=about,
            notes=notes,
            summary=_summary(counts),
            counts=[("all", len(entries)), *counts.items()],
            plates=[_plate(each) for each in entries],
            report=_digest(entries),
            review=review,
            called=_CALLED,
            style=Markup(read("page.css")),
            script=Markup("\n".join(map(read, _SCRIPTS))),
        )
    )


def environment() -> Any:
    """Return what fills the templates of this folder; what they are given is text, and is escaped."""
    import jinja2

    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(_HERE),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def read(name: str) -> str:
    """Return a style sheet or script of this folder."""
    return (_HERE / name).read_text(encoding="utf-8")


def _digest(entries: Sequence[Entry]) -> str:
    """Name a report by what it shows, so that marks kept by a browser are never another report's."""
    said = json.dumps([(each.name, each.kind, each.digests) for each in entries])
    return hashlib.sha256(said.encode()).hexdigest()[:16]


def _summary(counts: Mapping[str, int]) -> str:
    number = sum(counts.values())
    if not number:
        return "Nothing was compared."
    some = [f"{count} {kind}" for kind, count in counts.items() if count]
    pictures = "1 picture" if number == 1 else f"{number} pictures"
    return f"{pictures}: {', '.join(some)}."


def _plate(entry: Entry) -> dict[str, Any]:
    bars = list(_bars(entry))
    return {
        "name": entry.name,
        "title": entry.title,
        "kind": entry.kind,
        "verdict": _verdict(entry),
        "messages": entry.messages,
        "thumb": _thumb(entry.actual or entry.expected),
        "pictures": list(_pictures(entry)),
        "words": " ".join(
            [entry.name, entry.title, entry.kind, entry.word, *map(str, entry.differences)]
        ).lower(),
        "used": None if entry.kind == PASSED else max((bar["used"] for bar in bars), default=None),
        "bars": bars,
        "because": entry.because,
        "numbers": [_group(each, entry.elements.get(each.entry, ())) for each in entry.differences],
        "blobs": [_blob(blob) for blob in entry.blobs[:_MOST_PLACES]],
        "more_blobs": _more(len(entry.blobs) - _MOST_PLACES, "place"),
        "provenance": list(_provenance(*entry.provenance)),
        "parameters": entry.parameters,
        "accept": entry.accept,
        "acceptable": bool(entry.kind != PASSED and entry.accept and entry.digests[0]),
        "data": json.dumps(_data(entry)),
    }


def _verdict(entry: Entry) -> str:
    if entry.kind == CHANGED:
        return "changed, within tolerance"
    return entry.word if entry.kind == PASSED else f"failed: {entry.word}"


def _data(entry: Entry) -> dict[str, Any]:
    """What the script needs of an entry."""
    found = entry.comparison
    picture, numbers = entry.digests
    return {
        "blobs": [blob.box for blob in entry.blobs[:_MOST_PLACES]],
        "worst": found and found.largest_delta_e_at,
        "only": "golden, equal now" if found and found.equal else "golden" if entry.expected else "now",
        "accept": entry.accept,
        "picture": picture,
        "numbers": numbers,
    }


def _pictures(entry: Entry) -> Iterator[dict[str, Any]]:
    parts = {
        "expected": (entry.expected, "the golden"),
        "actual": (entry.actual, "the picture drawn now"),
        "ssim": (entry.ssim, "where the two are unlike"),
    }
    for part, (data, says) in parts.items():
        if data is not None:
            yield picture(part, data, f"{entry.name}: {says}")


def picture(part: str, png: bytes, alt: str) -> dict[str, Any]:
    """Return what a template shows of a picture: itself, in the page."""
    width, height = _size(png)
    uri = f"data:image/png;base64,{base64.b64encode(png).decode()}"
    return {"part": part, "uri": uri, "width": width, "height": height, "alt": alt}


def _size(png: bytes) -> tuple[int, int]:
    """Of a PNG, from its header."""
    return int.from_bytes(png[16:20], "big"), int.from_bytes(png[20:24], "big")


def _thumb(png: bytes | None) -> str:
    from PIL import Image

    if png is None:
        return ""
    with Image.open(io.BytesIO(png)) as picture:
        small = picture.convert("RGB")
        small.thumbnail(_THUMB, Image.Resampling.BOX)
    file = io.BytesIO()
    small.save(file, "JPEG", quality=72)
    return f"data:image/jpeg;base64,{base64.b64encode(file.getvalue()).decode()}"


def _bars(entry: Entry) -> Iterator[dict[str, Any]]:
    """How much of each tolerance is used; beyond one it is too much."""
    found = entry.comparison
    if found and found.same_size:
        far = f"dE {found.delta_e_limit:g}"
        yield _bar(
            f"Pixels beyond {far} in one place",
            found.crowd,
            found.pixels_limit,
            f"{found.crowd} of {found.pixels_limit}",
            _room(found.pixels_limit - found.crowd),
            found.crowd_at,
            "around" if found.crowd_at else "",
        )
        yield _bar(
            f"Pixels beyond {far} in all",
            found.over,
            found.strewn_limit,
            f"{found.over} of {found.strewn_limit}",
            _room(found.strewn_limit - found.over),
            found.largest_delta_e_at,
            f"largest dE {found.largest_delta_e:.1f}" if found.differing else "",
        )
        channel = f" of {found.lowpass_channel}" if found.lowpass_channel else ""
        yield _bar(
            "9×9 mean, in levels",
            abs(found.lowpass),
            found.lowpass_limit,
            f"{_signed(found.lowpass)} of ±{found.lowpass_limit:g}",
            f"{found.headroom_lowpass:.2f} more would pass"
            if not found.too_wide
            else f"{-found.headroom_lowpass:.2f} too much",
            found.lowpass_at,
            f"{_signed(found.lowpass)} levels{channel}" if found.differing else "",
        )
    entry_name, used = entry.nearest
    if entry.counted:
        wrong = len(entry.differences)
        numbers = f"{entry.counted} entr{'y' if entry.counted == 1 else 'ies'}"
        left = f"{wrong} differ{'s' if wrong == 1 else ''}" if wrong else "all within what is allowed"
        where = f"nearest: {entry_name}" if used and not wrong else entry_name if wrong else ""
        yield _bar("Numbers", used, 1.0, _share(used), f"{numbers}, {left}", None, where)


def _room(headroom: int) -> str:
    return f"{headroom} more would pass" if headroom >= 0 else f"{-headroom} too many"


def _bar(
    what: str, used: float, limit: float, value: str, left: str, at: tuple[int, int] | None, where: str
) -> dict[str, Any]:
    share = used / limit if limit else (0.0 if used == 0 else math.inf)
    place = f" at ({at[0]}, {at[1]})" if at else ""
    return {
        "what": what,
        "value": value,
        "used": round(min(share, 9.0), 4),
        "over": share > 1,
        "label": f"{what}: {value}, {left}",
        "left": left if at else ". ".join(filter(None, (left, where))),
        "go": json.dumps(at) if at else "",
        "where": (where + place).strip(),
    }


def _share(used: float) -> str:
    if used == 0 or used > 1e4:
        return "equal" if used == 0 else "far beyond"
    return f"{used:.2g} of what is allowed" if used < 1 else f"{used:.3g} times what is allowed"


def _signed(value: float) -> str:
    return "0" if value == 0 else f"{value:+.2f}".replace("-", "−")


def _more(count: int, what: str) -> str:
    return "" if count <= 0 else f"and {count} {what}{'s' if count > 1 else ''} more"


def _blob(blob: explain.Blob) -> dict[str, str]:
    x0, y0, x1, y1 = blob.box
    return {
        "size": f"{x1 - x0} × {y1 - y0}",
        "at": f"({x0}, {y0})",
        "says": f"{blob.pixels} px, dE {blob.delta_e:.1f}, SSIM {blob.ssim:.3f}".replace("-", "−"),
    }


def _group(found: Difference, worst: Sequence[elements.Element]) -> dict[str, Any]:
    """One entry that differs: what is allowed, and its elements, the worst first."""
    if found.kind != "value":
        words = {"missing": ("there", "missing"), "extra": ("none", "not in the golden")}
        before, after = words.get(found.kind, (str(found.expected), str(found.got)))
        return {"entry": found.entry, "says": "", "rows": [_row(found.kind, before, after)]}
    rows = [_row(each.where, _value(each.expected), _value(each.got), each.by) for each in worst]
    if not rows:
        index = f"[{', '.join(map(str, found.index))}]" if found.index else ""
        rows = [_row(index, _value(found.expected), _value(found.got), found.by)]
    says = [] if found.allowed is None else [f"{found.allowed:.2g} allowed"]
    if found.count > 1:
        says.append(f"{found.count} elements differ" + (", the worst:" if found.count > len(rows) else ""))
    return {"entry": found.entry, "says": "; ".join(says), "rows": rows}


def _row(where: str, expected: str, got: str, by: float | None = None) -> dict[str, str]:
    off = "" if by is None else f"{by:+.3g}".replace("-", "−")
    return {"where": where, "expected": expected, "got": got, "by": off}


def _value(value: object) -> str:
    # Ten digits tell a difference of the size that is allowed; repr has up to seventeen.
    return f"{value:.10g}".replace("-", "−") if isinstance(value, float) else str(value)


def _provenance(golden: Mapping[str, str], now: Mapping[str, str]) -> Iterator[dict[str, Any]]:
    keys = [*(key for key in _FIRST if key in golden or key in now)]
    keys += [key for key in {**golden, **now} if key not in keys and key not in _ELSEWHERE]
    for key in keys:
        pair = golden.get(key, ""), now.get(key, "")
        differs = all(pair) and pair[0] != pair[1] and key not in _PASSING
        yield {
            "key": key,
            "golden": pair[0] or "–",
            "now": pair[1] or "–",
            # Why it was accepted is a golden's alone.
            "same": pair[0] == pair[1] or (key == "reason" and not pair[1]),
            "differs": differs,
        }
