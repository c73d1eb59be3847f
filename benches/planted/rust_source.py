"""Tokens and function bodies of Rust text, as far as the search for defects needs them."""

import re

TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<string>b?r(?P<hashes>\#*)".*?"(?P=hashes) | b?"(?:\\.|[^"\\])*" | b?'(?:\\[^u]|\\u\{[^}]*\}|\\x..|[^'\\])')
      | (?P<lifetime>'[A-Za-z_]\w*)
      | (?P<float>\d[\d_]*\.\d[\d_]*(?:e[+-]?\d+)?(?:_?f64)? | \d[\d_]*e[+-]?\d+ | \d[\d_]*_f64)
      | (?P<integer>0x[\da-fA-F_]+\w* | \d[\d_]*\w*)
      | (?P<word>[A-Za-z_]\w*)
      | (?P<sign>\.\.=|\.\.\.|<<=|>>=|->|=>|::|\.\.|&&|\|\||[-+*/%^&|<>=!]=|[^\s\w])
    """,
    re.VERBOSE | re.DOTALL,
)
CLOSING = {"(": ")", "[": "]", "{": "}"}


class Token:
    """Token with its kind, text, start and end."""

    __slots__ = ("kind", "text", "start", "end")

    def __init__(self, match):
        self.kind, self.text = match.lastgroup, match.group()
        self.kind = "string" if self.kind == "hashes" else self.kind
        self.start, self.end = match.span()


def tokens(text):
    """Returns the tokens of a file without comments."""
    found = (Token(match) for match in TOKEN.finditer(text))
    return [token for token in found if token.kind != "comment"]


def pairs(all_tokens):
    """Returns the index of the closing bracket for the index of each opening bracket."""
    closes, open_at = {}, []
    for at, token in enumerate(all_tokens):
        if token.kind == "sign" and token.text in CLOSING:
            open_at.append(at)
        elif token.kind == "sign" and token.text in CLOSING.values() and open_at:
            closes[open_at.pop()] = at
    return closes


def tests_begin(text):
    """Returns the start of the unit tests, which are at the end of a file."""
    at = text.find("#[cfg(test)]\nmod ")
    return len(text) if at < 0 else at


def bodies(all_tokens, closes):
    """Returns the indices of the braces around the body of each function that is not `const`."""
    found = []
    for at, token in enumerate(all_tokens):
        if token.text != "fn" or token.kind != "word" or all_tokens[at + 1].kind != "word":
            continue
        if any(before.text == "const" for before in all_tokens[max(0, at - 2):at]):
            continue
        place = at + 2
        while place < len(all_tokens) and all_tokens[place].text not in ("{", ";"):
            # Arguments and array lengths may contain braces and semicolons.
            place = closes[place] if all_tokens[place].text in ("(", "[") else place
            place += 1
        if place < len(all_tokens) and all_tokens[place].text == "{" and place in closes:
            found.append((place, closes[place]))
    return found
