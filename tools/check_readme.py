#!/usr/bin/env python3
"""Checks that the README shows samples/hello.cpp word for word, that it fits 20 lines, and that links lead somewhere."""

import re

from source_tree import finish, root_from_args


def check(root):
    problems = []
    hello = (root / "samples/hello.cpp").read_text()
    readme = (root / "README.md").read_text()
    if f"```cpp\n{hello}```" not in readme:
        problems.append("README.md does not show samples/hello.cpp as it is")
    if hello.count("\n") > 20:
        problems.append("samples/hello.cpp has more than 20 lines")
    for page in [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").glob("*.md"))]:
        for link in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
            if not (page.parent / link).exists():
                problems.append(f"{page.relative_to(root)}: {link} does not exist")
    return problems


if __name__ == "__main__":
    finish("readme", check(root_from_args()))
