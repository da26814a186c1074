#!/usr/bin/env python3
"""Reports files over 500 lines, functions over 60 lines and functions of more than six parameters."""

import re

from source_tree import bare, files, finish, root_from_args

MAX_FILE, MAX_FUNCTION, MAX_PARAMETERS = 500, 60, 6

# "path" or "path:function" -> why it may be larger. Keep it short.
ALLOWED = {}

NOT_FUNCTIONS = {"if", "for", "while", "switch", "catch"}
AFTER_PARAMETERS = {"const", "noexcept", "override", "final", "try", "mutable"}


def split_top(text):
    """Number of comma-separated parts outside all brackets."""
    depth, parts = 0, 1
    for char in text:
        if char in "([{<":
            depth += 1
        elif char in ")]}>":
            depth -= 1
        elif char == "," and depth == 0:
            parts += 1
    return parts if text.strip() not in ("", "void") else 0


def matching(text, start, opening, closing):
    """Index after the bracket that closes the one at start."""
    depth = 0
    for i in range(start, len(text)):
        depth += (text[i] == opening) - (text[i] == closing)
        if depth == 0:
            return i + 1
    return len(text)


def strip_templates(head):
    """The head without template<...> prefixes and requires-clauses in parentheses."""
    while match := re.search(r"\btemplate\s*<", head):
        head = head[: match.start()] + head[matching(head, match.end() - 1, "<", ">") :]
    while match := re.search(r"\b(?:requires|alignas|decltype|explicit|__attribute__|noexcept)\s*\(", head):
        head = head[: match.start()] + head[matching(head, match.end() - 1, "(", ")") :]
    return head


def signature(head):
    """(name, parameter count) of a function whose text before the body is head, or None."""
    head = strip_templates(head)
    match = re.search(r"(operator\s*\(\s*\)|operator\s*[^\s\w(]+|[~\w:]+)\s*\(", head)
    if not match or match.group(1) in NOT_FUNCTIONS:
        return None
    if re.search(r"(?<![=!<>])=(?!=)", head[: match.start()]) and "operator" not in match.group(1):
        return None
    end = matching(head, match.end() - 1, "(", ")")
    return match.group(1), split_top(head[match.end() : end - 1])


def is_member_initialiser(head):
    """True for the brace of `a_{1}` in a constructor's initialiser list."""
    word = re.search(r"(\w+)\s*$", head)
    return bool(re.search(r"\)\s*:(?!:)", head)) and bool(word) and word.group(1) not in AFTER_PARAMETERS


def functions(text):
    """Yields (name, parameters, first line, line count) of all functions defined at namespace or class scope."""
    at, head_start = 0, 0
    while at < len(text):
        char = text[at]
        if char in ";}":
            head_start = at + 1
        elif char == "{":
            head = text[head_start:at]
            opens_scope = re.search(r"\b(namespace|class|struct|union|extern)\b", strip_templates(head).split("(")[0])
            found = None if opens_scope else signature(head)
            if opens_scope and "=" not in head:
                head_start = at + 1
            elif is_member_initialiser(head):
                at = matching(text, at, "{", "}") - 1
            else:
                end = matching(text, at, "{", "}")
                if found:
                    begin = head_start + len(head) - len(head.lstrip())
                    yield *found, text.count("\n", 0, begin) + 1, text.count("\n", begin, end) + 1
                at = end - 1
                head_start = end
        at += 1


def check(root):
    problems = []
    for path in files(root, {".h", ".cpp", ".py", ".sh", ".js", ".mjs"}):
        text = (root / path).read_text()
        lines = text.count("\n")
        if lines > MAX_FILE and str(path) not in ALLOWED:
            problems.append(f"{path}: {lines} lines (at most {MAX_FILE})")
        if path.suffix not in (".h", ".cpp"):
            continue
        for name, parameters, line, length in functions(bare(text)):
            if f"{path}:{name}" in ALLOWED:
                continue
            if length > MAX_FUNCTION:
                problems.append(f"{path}:{line}: {name} has {length} lines (at most {MAX_FUNCTION})")
            if parameters > MAX_PARAMETERS:
                problems.append(f"{path}:{line}: {name} has {parameters} parameters (at most {MAX_PARAMETERS})")
    return problems


if __name__ == "__main__":
    finish("sizes", check(root_from_args()))
