#!/usr/bin/env python3
"""Checks that the stages of a step read the same in the enum, the files of src/step and the manual."""

import re

from source_tree import bare, finish, root_from_args


def in_enum(root):
    text = bare((root / "include/avbd/profile.h").read_text())
    body = re.search(r"enum class Stage[^{]*{([^}]*)}", text).group(1)
    names = [part.split("=")[0].strip() for part in body.split(",") if part.strip()]
    return [re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower() for name in names]


def in_files(root):
    numbered = sorted(p.stem for p in (root / "src/step").glob("[0-9][0-9]_*.cpp"))
    return [name[3:] for name in numbered if name != "00_step" and not re.search(r"_(test|w\d+)$", name)]


def in_manual(root):
    text = (root / "docs/manual.md").read_text()
    return re.findall(r"^\| `\d\d_(\w+)` \|", text, re.M)


def check(root):
    enum, problems = in_enum(root), []
    for where, names in (("src/step", in_files(root)), ("docs/manual.md", in_manual(root))):
        if names != enum:
            problems.append(f"{where} has {names}, enum Stage has {enum}")
    return problems


if __name__ == "__main__":
    finish("stages", check(root_from_args()))
