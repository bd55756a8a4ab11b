r"""Formulas of a statement as plain text for a terminal: ``$\theta_3 \in \mathbb{R}$`` is "θ₃ ∈ ℝ".

It is for reading, not for typesetting: what it does not know it leaves as it is written, without a backslash.
"""

import re

# Names and letters in turn.
_GREEK = re.findall(
    r"\S+",
    """
    alpha α beta β gamma γ delta δ zeta ζ eta η theta θ iota ι kappa κ lambda λ mu μ nu ν xi ξ pi π rho ρ
    sigma σ tau τ phi φ chi χ psi ψ omega ω Gamma Γ Delta Δ Theta Θ Lambda Λ Xi Ξ Pi Π Sigma Σ Phi Φ Psi Ψ
    Omega Ω varepsilon ε epsilon ε varphi φ ell ℓ nabla ∇ partial ∂
    """,
)
# With a space on both sides, and without.
_BETWEEN = {
    **{"in": "∈", "to": "→", "mapsto": "↦", "times": "×", "neq": "≠", "ne": "≠", "leq": "≤", "le": "≤"},
    **{"geq": "≥", "ge": "≥", "pm": "±", "oplus": "⊕", "otimes": "⊗", "simeq": "≃", "approx": "≈"},
    **{"equiv": "≡", "cup": "∪", "cap": "∩", "subset": "⊂", "setminus": "∖", "mid": "|", "ltimes": "⋉"},
    **{"cdot": "·", "wedge": "∧", "iff": "⇔", "Rightarrow": "⇒", "rightarrow": "→", "circ": "∘", "sim": "~"},
}
_ALONE = {
    **{"sum": "Σ", "prod": "Π", "int": "∫", "infty": "∞", "cdots": "⋯", "ldots": "…", "dots": "…"},
    **{"vdots": "⋮", "ddots": "⋱", "top": "⊤", "prime": "′", "star": "*", "langle": "⟨", "rangle": "⟩"},
    **{"lVert": "‖", "rVert": "‖", "|": "‖", "lvert": "|", "rvert": "|", "{": "{", "}": "}", "%": "%"},
    **{"quad": "   ", "qquad": "      ", ",": " ", ";": " ", ":": " ", " ": " ", "!": "", "\\": "; "},
    **{"left": "", "right": "", "big": "", "Big": "", "bigl": "", "bigr": "", "Bigl": "", "Bigr": ""},
    **{"bigg": "", "biggl": "", "biggr": "", "displaystyle": "", "textstyle": "", "limits": ""},
}
_SIGNS = dict(zip(_GREEK[::2], _GREEK[1::2], strict=True)) | _ALONE
_SIGNS |= {name: f" {sign} " for name, sign in _BETWEEN.items()}
_DOUBLE = {"R": "ℝ", "C": "ℂ", "H": "ℍ", "N": "ℕ", "Z": "ℤ", "Q": "ℚ"}
# Over a letter, as a combining sign.
_OVER = {"hat": "\u0302", "bar": "\u0304", "tilde": "\u0303", "dot": "\u0307", "vec": "\u20d7"}
_OVER |= {"overline": "\u0304", "widehat": "\u0302", "widetilde": "\u0303"}
_PLAIN = (
    "mathbf",
    "mathrm",
    "mathit",
    "mathfrak",
    "mathcal",
    "mathsf",
    "boldsymbol",
    "text",
    "textrm",
    "textbf",
)
_PLAIN += ("operatorname", "bm")
_HIGH = dict(zip("0123456789+-()nTit", "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁽⁾ⁿᵀⁱᵗ", strict=True)) | {"−": "⁻"}
_LOW = dict(zip("0123456789+-()aeijkmnopx", "₀₁₂₃₄₅₆₇₈₉₊₋₍₎ₐₑᵢⱼₖₘₙₒₚₓ", strict=True)) | {"−": "₋"}
_MATH = re.compile(r"\$\$(.+?)\$\$|(?<![\\$])\$([^$]+?)\$", re.DOTALL)
_CODE = re.compile(r"(```.*?```|`[^`\n]*`)", re.DOTALL)
_MATRIX = re.compile(
    r"\\begin\{([a-z]*matrix|cases|aligned|array)\}(?:\{[lcr| ]*\})?(.*?)\\end\{\1\}", re.DOTALL
)
_GROUP = r"\{((?:[^{}]|\{[^{}]*\})*)\}"
_FRACTION = re.compile(rf"\\[dt]?frac\s*{_GROUP}\s*{_GROUP}")
_ROOT = re.compile(rf"\\sqrt\s*{_GROUP}")
_STYLED = re.compile(rf"\\(mathbb|{'|'.join(_PLAIN)})\s*(?:{_GROUP}|([A-Za-z0-9]))")
_ACCENT = re.compile(rf"\\({'|'.join(_OVER)})\s*(?:{_GROUP}|(\\?[A-Za-z]+))")
_SCRIPT = re.compile(rf"([_^])\s*(?:{_GROUP}|(\\[A-Za-z]+|[^\s{{}}\\]))")
_NAME = re.compile(r"\\([A-Za-z]+|.)\s*", re.DOTALL)
# Between a function and what it is of.
_OF = re.compile(r"(?<=sin|cos|tan|exp|log|det|min|max) \(|(?<=diag) \(|(?<=tr) \(")
_SIMPLE = re.compile(r"[\w.′⊤]+[²³ᵀ]?|\([^()]*\)")


def readable(text: str, *, markdown: bool = False) -> str:
    """Return a statement with its formulas as plain text.

    Parameters
    ----------
    text : str
        With TeX between dollars; what is between backquotes stays.
    markdown : bool
        Whether it goes on as Markdown, in which a star or an underscore must not be taken for emphasis.

    Returns
    -------
    str
        A formula of a line of its own is indented, or quoted in Markdown.
    """

    def replaced(match: re.Match[str]) -> str:
        formula = plain(match[1] or match[2])
        if markdown:
            formula = re.sub(r"([*_`\[\]<])", r"\\\1", formula)
        if match[1] is None:
            return formula
        return f"\n\n{'>' if markdown else '   '} {formula}\n\n"

    parts = _CODE.split(text)
    made = "".join(part if k % 2 else _MATH.sub(replaced, part) for k, part in enumerate(parts))
    return re.sub(r"\n{3,}", "\n\n", made)


def plain(tex: str) -> str:
    """Return a formula as plain text in one line."""
    text = _flat(tex).translate({0: None, 1: "{", 2: "}", 3: "^", 4: "_"})
    text = _OF.sub("(", text.replace("~", " ").replace("-", "−"))
    return re.sub(r" +([,.;)\]])", r"\1", re.sub(r"(?<=\S) {2,3}(?=\S)", " ", text)).strip()


def _flat(tex: str) -> str:
    """Return a formula without backslashes and groups; signs that have been read are marked."""
    text = " ".join(tex.split())
    text = _MATRIX.sub(lambda m: _matrix(m[2]), text)
    for _ in range(4):
        # From the inside: groups within groups are text by now.
        text = _STYLED.sub(_styled, text)
        text = _FRACTION.sub(lambda m: f"{_grouped(m[1])}/{_grouped(m[2])}", text)
        text = _ROOT.sub(lambda m: f"√{_grouped(m[1], always=True)}", text)
        text = _ACCENT.sub(_accented, text)
    text = _SCRIPT.sub(_script, text)
    return _NAME.sub(_named, text).replace("{", "").replace("}", "")


def _named(match: re.Match[str]) -> str:
    name = match[1]
    if name in "{}":
        return "\1" if name == "{" else "\2"
    if name in _SIGNS:
        return _SIGNS[name]
    # sin x, log R: a function, and room for what it is of.
    after = match.string[match.end() : match.end() + 1]
    spaced = after.isalnum() and after not in _HIGH.values() and after not in _LOW.values()
    return name + (" " if spaced or after in ("\\", "\0") else "")


def _styled(match: re.Match[str]) -> str:
    inner = match[2] if match[2] is not None else match[3]
    # Marked, lest it becomes a part of the name before it.
    return "\0" + (_DOUBLE.get(inner, inner) if match[1] == "mathbb" else inner)


def _accented(match: re.Match[str]) -> str:
    inner = _flat(match[2] if match[2] is not None else match[3])
    inner = inner.replace("\0", "")
    return inner + _OVER[match[1]] if len(inner) == 1 else f"{match[1].removeprefix('wide')}({inner})"


def _script(match: re.Match[str]) -> str:
    inner = _flat(match[2] if match[2] is not None else match[3]).replace(" ", "")
    if match[1] == "^" and inner in ("′", "⊤", "*", "T"):
        return {"T": "ᵀ"}.get(inner, inner)
    table = _HIGH if match[1] == "^" else _LOW
    inner = inner.replace("\0", "").replace("-", "−")
    if inner and all(c in table for c in inner):
        return "".join(table[c] for c in inner)
    return ("\3" if match[1] == "^" else "\4") + (inner if len(inner) == 1 else f"({inner})")


def _grouped(inner: str, always: bool = False) -> str:
    text = _flat(inner).replace("\0", "")
    return text if not always and _SIMPLE.fullmatch(text) else f"({text})"


def _matrix(body: str) -> str:
    rows = [
        ", ".join(cell.strip() for cell in row.split("&")) for row in re.split(r"\\\\", body) if row.strip()
    ]
    return f"[{' ; '.join(rows)}]"
