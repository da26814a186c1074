#!/usr/bin/env python3
"""Checks that the changelog says why test/golden_hashes.txt is what it is: a line with the first digits of its SHA-256."""

import hashlib
import re

from source_tree import finish, root_from_args


def check(root):
    kept = root / "test/golden_hashes.txt"
    if not kept.exists():
        return []
    digits = hashlib.sha256(kept.read_bytes()).hexdigest()[:8]
    changelog = (root / "CHANGELOG.md").read_text()
    if re.search(rf"^- Recorded hashes {digits}: \S", changelog, re.MULTILINE):
        return []
    return [f'CHANGELOG.md has no line "- Recorded hashes {digits}: WHY" (./dev golden WHY writes it)']


if __name__ == "__main__":
    finish("golden", check(root_from_args()))
