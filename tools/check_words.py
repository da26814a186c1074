#!/usr/bin/env python3
"""Checks names that are not used here, and that the library neither prints nor reads the environment."""

import re

from source_tree import bare, files, finish, root_from_args

UNUSED = {"manager", "handler", "context", "objective", "owner", "utils", "util", "helper"}
# Names that other libraries gave.
FOREIGN = {"error_handler_t", "sa_handler", "io_context"}
SILENT = re.compile(r"\b(getenv|printf|fprintf|puts|fputs|cout|cerr|clog|perror)\b")

# A failed assert says where before it aborts.
MAY_PRINT = {"src/base/assert.cpp"}


def words(identifier):
    return re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", identifier)


def check(root):
    problems = []
    for path in files(root, {".h", ".cpp"}):
        if UNUSED.intersection(words(path.stem)):
            problems.append(f"{path}: a name that is not used here")
        for number, line in enumerate(bare((root / path).read_text()).split("\n"), 1):
            for identifier in re.findall(r"(?<!std::)\b[A-Za-z_]\w*", line):
                if identifier in FOREIGN:
                    continue
                if UNUSED.intersection(word.lower() for word in words(identifier)):
                    problems.append(f"{path}:{number}: {identifier} is a name that is not used here")
            in_library = path.parts[0] in ("src", "include") and not path.stem.endswith("_test")
            if in_library and str(path) not in MAY_PRINT and (match := SILENT.search(line)):
                problems.append(f"{path}:{number}: {match.group()}: the library is silent and reads no environment")
    return problems


if __name__ == "__main__":
    finish("words", check(root_from_args()))
