"""Possible defects of a source text: changed signs, factors and indices, and dropped terms."""

import re
from dataclasses import dataclass

import rust_source

KINDS = ["sign", "factor", "index", "term"]
SIGNS = {"+": "-", "-": "+", "+=": "-=", "-=": "+="}
FACTORS = {"*": "/", "/": "*", "*=": "/=", "/=": "*="}
INDICES = {"0": "1", "1": "0", "2": "1", "x": "y", "y": "x", "z": "y"}
# Tokens that end a term outside its own brackets.
ENDS = {"+", "-", ",", ";", ")", "]", "}", "{", "<", ">", "<=", ">=", "==", "!=", "&&", "||", "=>", "..", "..=", "=", "|"}


@dataclass(frozen=True)
class Defect:
    """Defect: a replaced part of a file, inside a function body."""

    file: str
    line: int
    kind: str
    body: tuple
    start: int
    end: int
    instead: str
    shown: str

    @property
    def key(self):
        return f"{self.file}:{self.start}:{self.kind}"


def is_value(token):
    """Returns True if an expression can end with this token, so that a sign after it is binary."""
    return token.kind in ("word", "float", "integer") and token.text not in ("return", "in", "else", "match", "if") or \
        token.text in (")", "]")


def changes(tokens, closes, at):
    """Yields the possible defects at a token: kind, start, end, and replacement."""
    token, before = tokens[at], tokens[at - 1]
    after = tokens[at + 1]
    binary = is_value(before) and before.end < token.start
    if token.kind == "sign" and token.text in SIGNS and binary:
        yield "sign", token.start, token.end, SIGNS[token.text]
        if token.text in ("+", "-"):
            last = at + 1
            while last < len(tokens) and tokens[last].text not in ENDS:
                last = closes.get(last, last) + 1
            # The term before it remains.
            yield "term", before.end, tokens[last - 1].end, ""
        else:
            yield "term", token.end, token.end, " 0.0 *"
    elif token.text == "-" and token.kind == "sign" and token.end == after.start and before.text != "[":
        yield "sign", token.start, token.end, ""
    elif token.kind == "sign" and token.text in FACTORS and binary:
        yield "factor", token.start, token.end, FACTORS[token.text]
    elif token.kind == "float" and float(re.sub(r"_|_?f64$", "", token.text)) != 0.0:
        yield "factor", token.start, token.end, f"(2.0 * {token.text})"
    elif token.kind == "integer" and token.text in INDICES and before.text == "[" and after.text == "]":
        yield "index", token.start, token.end, INDICES[token.text]
    elif token.kind == "integer" and token.text == "1" and before.text in ("+", "-"):
        yield "index", token.start, token.end, "0"
    elif token.text in INDICES and before.text == "." and after.text != "(":
        yield "index", token.start, token.end, INDICES[token.text]


def of_file(name, text):
    """Returns all possible defects of a file, each with the body of the innermost function around it."""
    tokens = rust_source.tokens(text[:rust_source.tests_begin(text)])
    closes = rust_source.pairs(tokens)
    all_bodies = rust_source.bodies(tokens, closes)
    found = []
    for at in range(1, len(tokens) - 1):
        around = [body for body in all_bodies if body[0] < at < body[1]]
        if not around:
            continue
        open_at, close_at = max(around)
        body = (tokens[open_at].start, tokens[close_at].end)
        for kind, start, end, instead in changes(tokens, closes, at):
            line = text.count("\n", 0, start) + 1
            begin = text.rfind("\n", 0, start) + 1
            stop = text.find("\n", end)
            shown = " ".join(f"{text[begin:start]}⟦{text[start:end]}→{instead}⟧{text[end:stop]}".split())
            found.append(Defect(name, line, kind, body, start, end, instead, shown))
    return found


def draw(random, candidates, count):
    """Returns `count` random defects, with kinds in turn. No two lie in nested bodies."""
    by_kind = {kind: [defect for defect in candidates if defect.kind == kind] for kind in KINDS}
    for some in by_kind.values():
        random.shuffle(some)
    drawn = []
    while len(drawn) < count and any(by_kind.values()):
        for kind in KINDS:
            while by_kind[kind]:
                defect = by_kind[kind].pop()
                if not any(overlaps(defect, other) for other in drawn):
                    drawn.append(defect)
                    break
    return drawn[:count]


def overlaps(a, b):
    """Returns True if one body lies within the other."""
    return a.file == b.file and a.body != b.body and a.body[0] < b.body[1] and b.body[0] < a.body[1]


def planted(text, numbered, ask):
    """Returns a file with a copy of each body for each of its defects, selected by number.

    Also returns, for each defect, the lines of its copy and the lines of all copies of its function.
    """
    by_body = {}
    for number, defect in numbered:
        by_body.setdefault(defect.body, []).append((number, defect))
    out, done, lines = [], 0, {}

    def line_now():
        return "".join(out).count("\n") + 1

    for body, there in sorted(by_body.items()):
        out.append(text[done:body[0]])
        first, alone = line_now(), {}
        out.append("{\n")
        for number, defect in there:
            begin = line_now()
            changed = text[body[0]:defect.start] + defect.instead + text[defect.end:body[1]]
            out.append(f"if {ask}({number})\n{changed}\nelse\n")
            alone[number] = (begin, line_now() - 1)
        out.append(text[body[0]:body[1]] + "\n}")
        last, done = line_now(), body[1]
        for number in alone:
            lines[number] = (alone[number], (first, last))
    out.append(text[done:])
    return "".join(out), lines
