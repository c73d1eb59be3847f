"""Rust text as tokens, and the bodies of its functions: as much of the language as finding a place to change needs."""

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
    """A piece of the text: what kind it is, what it says, and from where to where it goes."""

    __slots__ = ("kind", "text", "start", "end")

    def __init__(self, match):
        self.kind, self.text = match.lastgroup, match.group()
        self.kind = "string" if self.kind == "hashes" else self.kind
        self.start, self.end = match.span()


def tokens(text):
    """The tokens of a file, comments left out."""
    found = (Token(match) for match in TOKEN.finditer(text))
    return [token for token in found if token.kind != "comment"]


def pairs(all_tokens):
    """For each opening bracket the place of the one that closes it."""
    closes, open_at = {}, []
    for at, token in enumerate(all_tokens):
        if token.kind == "sign" and token.text in CLOSING:
            open_at.append(at)
        elif token.kind == "sign" and token.text in CLOSING.values() and open_at:
            closes[open_at.pop()] = at
    return closes


def tests_begin(text):
    """Where the unit tests of a file begin, which are at its end."""
    at = text.find("#[cfg(test)]\nmod ")
    return len(text) if at < 0 else at


def bodies(all_tokens, closes):
    """Of every function that can ask at run time: the tokens of the braces around its body."""
    found = []
    for at, token in enumerate(all_tokens):
        if token.text != "fn" or token.kind != "word" or all_tokens[at + 1].kind != "word":
            continue
        if any(before.text == "const" for before in all_tokens[max(0, at - 2):at]):
            continue
        place = at + 2
        while place < len(all_tokens) and all_tokens[place].text not in ("{", ";"):
            # Arguments and lengths of arrays may hold braces and semicolons of their own.
            place = closes[place] if all_tokens[place].text in ("(", "[") else place
            place += 1
        if place < len(all_tokens) and all_tokens[place].text == "{" and place in closes:
            found.append((place, closes[place]))
    return found
