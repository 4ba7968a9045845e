"""Words and plain signs for characters that a terminal, pipe or file cannot take, as with cp1252 or ASCII."""

import codecs
import sys

PLAIN = "boreprop-plain"
"""The name of the error handler for encodings that puts them in."""

SIGNS = {
    "°": "deg",
    "±": "+/-",
    "×": "x",
    "·": ".",
    "−": "-",
    "–": "-",
    "—": "-",
    "…": "...",
    "→": "->",
    "≤": "<=",
    "≥": ">=",
    "²": "^2",
    "³": "^3",
    "⁻": "^-",
    "√": "sqrt",
    "∞": "inf",
    "─": "-",
    "━": "-",
    "│": "|",
    "┃": "|",
}


def in_ascii(character: str) -> str:
    """What stands for a character: signs, the word for a Greek letter, a letter without its accent, or "?"."""
    from unicodedata import name, normalize  # imported here, since few streams need it

    words = name(character, "").split()
    if character in SIGNS:
        return SIGNS[character]
    if words[:1] == ["GREEK"] and "LETTER" in words:
        word = words[words.index("LETTER") + 1].replace("LAMDA", "LAMBDA")
        return word.capitalize() if "CAPITAL" in words else word.lower()
    return normalize("NFKD", character).encode("ascii", "ignore").decode() or "?"


def written(text: str, encoding: str | None) -> str:
    """A text as it is when it has been written in an encoding, so that a table is laid out for what will be seen."""
    encoding = encoding or "utf-8"
    return text.encode(encoding, PLAIN).decode(encoding)


def write_plainly() -> None:
    """From now on, write to stdout and stderr what they can take."""
    for stream in (sys.stdout, sys.stderr):
        if reconfigure := getattr(stream, "reconfigure", None):
            reconfigure(errors=PLAIN)


def _handle(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(in_ascii, error.object[error.start : error.end])), error.end


codecs.register_error(PLAIN, _handle)
