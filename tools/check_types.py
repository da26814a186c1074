#!/usr/bin/env python3
"""Checks that no two files define a type of the same name in the same namespace: a program of both would be wrong."""

import re

from source_tree import bare, files, finish, root_from_args

# Programs of their own, each of one file.
APART = {"samples"}

TOKEN = re.compile(r"[{};]|\bnamespace\b|\b(?:enum\s+class|enum\s+struct|enum|class|struct|union)\b|[A-Za-z_]\w*(?:::\w+)*|\S")
TYPES = {"class", "struct", "union", "enum"}


def types(text):
    """(qualified name, line) of each type defined in named namespaces, outside other types and functions."""
    found, scopes, words, line, last = [], [], [], 1, 0
    text = bare(text)
    for match in TOKEN.finditer(text):
        line += text.count("\n", last, match.start())
        last = match.start()
        token = match.group()
        if token == "{":
            scopes.append(scope(words))
            kind, name = scopes[-1]
            outer = [n for k, n in scopes[:-1] if k == "namespace"]
            if kind == "type" and name and len(outer) == len(scopes) - 1 and None not in outer:
                found.append(("::".join(outer + [name]), line))
            words = []
        elif token in "};":
            if token == "}" and scopes:
                scopes.pop()
            words = []
        else:
            words.append(token)
    return found


def scope(words):
    """What a brace opens, by the words before it: a namespace, a type or something else, and its name."""
    if "namespace" in words:
        after = words[words.index("namespace") + 1 :]
        return "namespace", after[0] if after else None
    words = without_template(words)
    if not words or words[0].split()[0] not in TYPES or "(" in words or "=" in words:
        return "other", None
    name = words[1] if len(words) > 1 and re.match(r"[A-Za-z_]", words[1]) else None
    special = len(words) > 2 and words[2] == "<"  # a specialisation has another name
    return "type", None if special else name


def without_template(words):
    """The words after `template <...>`."""
    while words and words[0] == "template":
        depth = 0
        for i, word in enumerate(words):
            depth += (word == "<") - (word == ">")
            if word == ">" and depth == 0:
                words = words[i + 1 :]
                break
        else:
            return []
    return words


def check(root):
    places = {}
    for path in files(root, {".h", ".cpp"}):
        if path.parts[0] in APART:
            continue
        for name, line in types((root / path).read_text()):
            places.setdefault(name, {}).setdefault(path, line)
    problems = []
    for name, where in sorted(places.items()):
        if len(where) > 1:
            problems.append(f"{name} is defined in " + " and ".join(f"{p}:{n}" for p, n in where.items()))
    return problems


if __name__ == "__main__":
    finish("types", check(root_from_args()))
