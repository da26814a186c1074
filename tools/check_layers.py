#!/usr/bin/env python3
"""Checks the include graph: layers never look up, public headers see only public headers, no cycles."""

import re

from source_tree import files, finish, root_from_args

# Inside src/: a file may include folders of its own or a lower rank.
RANK = {"base": 0, "lane": 0, "rows": 1, "geom": 2, "collide": 3, "world": 4, "query": 5, "solve": 5, "step": 5, "api": 6}

# Around the library: what each folder may include besides the public headers and itself.
AROUND = {
    "io": {"io"},
    "viewer": {"viewer", "io"},
    "scenes": {"scenes", "io"},
    "bench": {"bench", "scenes", "io"},
    "app": {"app", "bench", "scenes", "viewer", "io"},
    "samples": {"samples", "io"},
}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<(avbd/[^>]+)>)', re.M)


def resolve(root, path, name):
    """The file that an include names, relative to root, or None if it is not ours."""
    for base in (path.parent, root / "include", root / "src", root):
        target = (root / base / name).resolve()
        if target.is_file() and target.is_relative_to(root):
            return target.relative_to(root)
    return None


def refusal(path, target):
    """Why path must not include target, or None."""
    where, what = path.parts[0], target.parts[0]
    if where == "include":
        return None if what == "include" else "a public header may include only public headers"
    if what == "include" or where in ("test", "tools"):
        return None
    if where == "src":
        if what != "src":
            return f"src never includes {what}"
        own, other = RANK.get(path.parts[1]), RANK.get(target.parts[1])
        if own is None or other is None:
            return "folder without a rank: add it to tools/check_layers.py"
        return f"{path.parts[1]} is below {target.parts[1]}" if other > own else None
    if what in AROUND.get(where, ()):
        return None
    # A unit test or a micro-benchmark may look inside the library.
    return None if path.stem.endswith(("_test", "_bench")) else f"{where} may not include {what}"


def cycles(graph):
    """Each include cycle once, as text."""
    found, state = [], {}

    def visit(node, trail):
        state[node] = "open"
        for after in graph.get(node, ()):
            if state.get(after) == "open":
                loop = trail[trail.index(after) :] if after in trail else [node]
                found.append("include cycle: " + " -> ".join(map(str, loop + [after])))
            elif after not in state:
                visit(after, trail + [after])
        state[node] = "done"

    for node in sorted(graph):
        if node not in state:
            visit(node, [node])
    return found


def check(root):
    problems, graph = [], {}
    for path in files(root, {".h", ".cpp"}):
        text = (root / path).read_text()
        for match in INCLUDE.finditer(text):
            name = match.group(1) or match.group(2)
            target = resolve(root, path, name)
            if target is None:
                continue
            graph.setdefault(path, []).append(target)
            if why := refusal(path, target):
                problems.append(f"{path}:{text.count(chr(10), 0, match.start()) + 1}: includes {name}: {why}")
    return problems + cycles(graph)


if __name__ == "__main__":
    finish("layers", check(root_from_args()))
