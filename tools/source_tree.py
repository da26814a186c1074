"""What the checks share: the tree's own source files, and C++ text without comments, strings and directives."""

import re
import sys
from pathlib import Path

FOLDERS = ("include", "src", "io", "app", "viewer", "scenes", "samples", "bench", "test", "tools")
SKIP = {"node_modules", "dist", "build", "__pycache__"}


def root_from_args():
    """Root of the tree to check: the first argument, else the tree this file lies in."""
    return Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent


def files(root, suffixes):
    """All files with one of the suffixes, as paths relative to root, in a fixed order."""
    found = []
    for folder in FOLDERS:
        for path in (root / folder).rglob("*"):
            relative = path.relative_to(root)
            if path.is_file() and path.suffix in suffixes and not SKIP.intersection(relative.parts):
                found.append(relative)
    return sorted(found)


TOKENS = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<d>[^()\\ ]*)\(.*?\)(?P=d)"|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+'|^[ \t]*#(?:\\\n|[^\n])*",
    re.S | re.M,
)


def bare(text):
    """C++ text with comments and directives blanked and literals emptied; line numbers stay."""

    def blank(match):
        token = match.group()
        quotes = '""' if token[0] in "\"'R" else ""
        return quotes + "\n" * token.count("\n")

    return TOKENS.sub(blank, text)


def finish(name, problems):
    """Prints the problems and leaves with the status that a test reads."""
    for problem in problems:
        print(problem)
    print(f"{name}: {len(problems)} problem(s)" if problems else f"{name}: ok")
    sys.exit(1 if problems else 0)
