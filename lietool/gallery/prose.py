"""Plain formulas in captions, as ``R_z(theta_3)``, in italics with subscripts and Greek letters.

The rule is small, and what it does not know it leaves as it is written.
"""

import html
import re
from collections.abc import Iterator

# Those of Latin shape and those that nobody uses are left out.
_NAMES = (
    *("alpha", "beta", "gamma", "delta", "epsilon", "theta", "iota", "kappa", "lambda", "mu", "nu", "xi"),
    *("pi", "rho", "sigma", "tau", "phi", "chi", "psi", "omega"),
    *("Delta", "Theta", "Phi", "Psi", "Omega"),
)
_GREEK: dict[str, str] = {name: html.unescape(f"&{name};") for name in _NAMES} | {"eps": "ε"}
# A letter that is also a word, or the shape that the pictures show, is a symbol only within a formula.
_ALSO_WORDS = "aAF"
_SIGNS = {"<=": "≤", ">=": "≥", "!=": "≠", "->": "→"}
_BASE = rf"{'|'.join(sorted(_GREEK, key=len, reverse=True))}|[A-Za-z]"
_LOW = r"_(?:\{[^{}]*\}|-?[A-Za-z0-9]+)"
_HIGH = r"\^(?:\{[^{}]*\}|\([^()]*\)|[-+]?[A-Za-z0-9]+|[-+*])"
# Between the factors of a product one of which is Greek, where a word's space would be too wide.
_NARROW = re.compile(r"(?<=[α-ω]</i>) (?=<i>)|(?<=</i>) (?=<i>[α-ω])|(?<=\d) (?=<i>[α-ω])")
_TOKEN = re.compile(
    rf"""
    (?P<panel>(?<!\S)\([a-z]\)(?=\s))
    | (?P<group>\b[OE](?=\((?:n|\d)\)))
    | (?P<dot>\([a-z]\.[a-z]\))
    | (?P<times>(?<=\d)[ ]?x[ ]?(?=\d)|(?<=\b[A-Za-z])[ ](?:x|cross)[ ](?=[A-Za-z]\b))
    | (?P<inner>(?<=\b[A-Za-z])[ ]\.[ ](?=[A-Za-z]\b))
    | (?P<digits>\d+e-?\d+)
    | (?P<positive>\b(?:GL|Aff|Sym|Diag)\^?\+(?=\(|\W|$))
    | (?<![A-Za-z'’_.])(?P<base>{_BASE})(?P<digit>\d(?!\w))?(?P<low>{_LOW})?(?P<prime>'(?!\w))?
      (?P<high>{_HIGH})?(?![\w’]|'\w|\.\w)
    | (?P<word>\b[A-Za-z0-9]+)(?P<power>{_HIGH})
    | (?P<sign><=|>=|!=|->)
    | (?P<minus>(?<![\w)])-(?=[\w(|])|(?<=[ ])-(?=[ ]))
    """,
    re.VERBOSE,
)


def to_html(text: str) -> str:
    """Return a caption or title as HTML, its formulas set.

    Parameters
    ----------
    text : str
        As it is written in a figure.

    Returns
    -------
    str
        HTML with ``i``, ``sub`` and ``sup`` only.
    """
    return _NARROW.sub("\u202f", "".join(_parts(text)))


def _parts(text: str) -> Iterator[str]:
    end = 0
    for match in _TOKEN.finditer(text):
        yield html.escape(text[end : match.start()], quote=False)
        yield _set(match, text)
        end = match.end()
    yield html.escape(text[end:], quote=False)


def _set(match: re.Match[str], text: str) -> str:
    if match["positive"]:
        return f"{match['positive'].rstrip('^+')}<sup>+</sup>"
    if match["word"]:
        return match["word"] + _raised(match["power"])
    if match["sign"]:
        return _SIGNS[match["sign"]]
    if match["times"]:
        return re.sub("x|cross", "×", match[0])
    if match["inner"]:
        return " · "
    if match["minus"]:
        return "−"
    if match["dot"]:
        return f"({_letter(match['dot'][1])} · {_letter(match['dot'][3])})"
    if match["base"] and not _is_word(match, text):
        low = match["low"]
        prime = "′" if match["prime"] else ""
        lowered = f"<sub>{_small(low[1:])}</sub>" if low else ""
        digit = f"<sub>{match['digit']}</sub>" if match["digit"] else ""
        return _letter(match["base"]) + digit + lowered + prime + _raised(match["high"])
    return html.escape(match[0], quote=False)


def _is_word(match: re.Match[str], text: str) -> bool:
    """Whether a letter is more likely a word: nothing beside it says that it stands in a formula."""
    base = match["base"]
    if match["digit"]:
        # A capital with a digit is a name, such as that of a plate.
        return base.isupper() and not (match["low"] or match["high"])
    if base.isupper() and re.match(r" \d", text[match.end() :]):
        # A text and the number of an equation in it.
        return True
    if base.isupper() and re.search(r"\d$", text[: match.start()]):
        return True
    if base not in _ALSO_WORDS or match["low"] or match["high"] or match["prime"]:
        return False
    before, after = text[: match.start()], text[match.end() :]
    if base == "A" and re.search(r"[a-z,] $", before):
        # Within a sentence no article has a capital.
        return False
    return not (
        re.match(r"\(|\)|\||, [a-z]\)| ?(?:=|[-+*] |<|>)", after)
        or re.search(r"(?:=|[-+*]|<|>) ?$|[_^][\w{}()+-]+ $", before)
    )


def _letter(base: str) -> str:
    return f"<i>{_GREEK.get(base, base)}</i>"


def _raised(high: str | None) -> str:
    return f"<sup>{_small(high[1:])}</sup>" if high else ""


def _small(text: str) -> str:
    """What is raised or lowered: numbers upright, letters as symbols, words as they are."""
    inner = text.strip("{()}").replace("-", "−").replace("'", "′")
    parts = re.split(r"([A-Za-z]+)", inner)
    return "".join(
        _letter(part)
        if part in _GREEK or (part.isalpha() and len(part) <= 2)
        else html.escape(part, quote=False)
        for part in parts
    )
