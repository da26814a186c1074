#!/usr/bin/env python3
"""Shows each check of tools/ a small tree with a fault in it, and the same tree without."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parent.parent / "tools"

GOOD = {
    "include/avbd/profile.h": "enum class Stage : int { Pairs, BeginRows };\n",
    "src/base/text.h": "#pragma once\nint text(int a, int b);\n",
    "src/step/00_step.cpp": '#include "base/text.h"\nint step() { return text(1, 2); }\n',
    "src/step/10_pairs.cpp": "",
    "src/step/50_begin_rows.cpp": "",
    "docs/manual.md": "| `10_pairs` | x |\n| `50_begin_rows` | x |\n",
    "samples/hello.cpp": "int main() {}\n",
    "README.md": "```cpp\nint main() {}\n```\n[manual](docs/manual.md)\n",
    "CONTRIBUTING.md": "",
}


def run_check(name, changes):
    """Exit status and output of a check over the good tree with some files changed."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in {**GOOD, **changes}.items():
            target = Path(folder) / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text)
        done = subprocess.run([sys.executable, TOOLS / f"check_{name}.py", folder], capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr


class Checks(unittest.TestCase):
    def objects(self, name, changes, wanted):
        status, output = run_check(name, changes)
        self.assertEqual(status, 1, output)
        self.assertIn(wanted, output)

    def accepts(self, name, changes):
        status, output = run_check(name, changes)
        self.assertEqual(status, 0, output)

    def test_good_tree(self):
        for name in ("sizes", "layers", "types", "stages", "words", "readme", "golden"):
            with self.subTest(name):
                self.accepts(name, {})

    def test_sizes(self):
        long = "int f() {\n" + "  g();\n" * 59 + "}\n"
        self.objects("sizes", {"src/base/a.cpp": "\n" * 501}, "501 lines")
        self.objects("sizes", {"src/base/a.cpp": long}, "a.cpp:1: f has 61 lines")
        self.objects("sizes", {"src/base/a.cpp": "namespace n {\nstruct S {\n" + long + "};\n}\n"}, "a.cpp:3: f has 61")
        self.objects("sizes", {"src/base/a.cpp": "S::S(int x) : a_{x}, b_(2) {\n" + "  g();\n" * 60 + "}\n"}, "S::S has 62")
        self.objects("sizes", {"src/base/a.cpp": "TEST(A, B) {\n" + "  g();\n" * 60 + "}\n"}, "TEST has 62")
        self.objects("sizes", {"src/base/a.cpp": "int f(int a, int b, int c, int d, int e, int f, int g) {}\n"}, "f has 7")
        self.accepts("sizes", {"src/base/a.cpp": "int f(A<int, int> a, B<C, D> b, int c, int d, int e, int f) {}\n"})
        self.accepts("sizes", {"src/base/a.cpp": "int f() {\n" + "  // '{' and \"}\" count for nothing\n" * 58 + "}\n"})
        self.accepts("sizes", {"src/base/a.cpp": "const T k = {\n" + "  {1, 2},\n" * 90 + "};\nint f() { return 1; }\n"})

    def test_layers(self):
        step = {"src/step/x.h": ""}
        self.objects("layers", {**step, "src/base/a.cpp": '#include "step/x.h"\n'}, "base is below step")
        self.objects("layers", {"io/x.h": "", "src/step/a.cpp": '#include "io/x.h"\n'}, "src never includes io")
        self.objects("layers", {"include/avbd/a.h": '#include "base/text.h"\n'}, "only public headers")
        self.objects("layers", {"app/x.h": "", "io/a.cpp": '#include "app/x.h"\n'}, "io may not include app")
        self.objects("layers", {"io/a.cpp": '#include "base/text.h"\n'}, "io may not include src")
        self.objects("layers", {"src/new/a.cpp": '#include "base/text.h"\n'}, "without a rank")
        self.objects("layers", {"src/base/a.h": '#include "b.h"\n', "src/base/b.h": '#include "base/a.h"\n'}, "cycle")
        self.accepts("layers", {"io/a_test.cpp": '#include "base/text.h"\n'})
        self.accepts("layers", {"src/step/a.cpp": '#include <avbd/profile.h>\n#include <vector>\n'})

    def test_types(self):
        one = "namespace avbd {\nstruct A {\n  int x;\n};\n}\n"
        self.objects("types", {"src/base/a.h": one, "io/b.h": one}, "avbd::A is defined in io/b.h:2 and src/base/a.h:2")
        self.objects("types", {"src/base/a.h": one, "src/base/b.cpp": one.replace("struct A", "enum class A : int")}, "avbd::A")
        self.objects("types", {"src/base/a.h": one, "src/base/b.h": one.replace("struct A", "template <class T>\nclass A final : B<T>")}, "avbd::A")
        self.accepts("types", {"src/base/a.h": one, "src/base/b.h": one.replace("avbd", "avbd::rows")})
        self.accepts("types", {"src/base/a.h": one, "src/base/b.cpp": one.replace("{", "{ namespace {", 1) + "}\n"})
        self.accepts("types", {"src/base/a.h": one, "src/base/b.h": "namespace avbd {\nstruct A;\nstruct B { struct A {}; };\n}\n"})
        self.accepts("types", {"src/base/a.h": one, "src/base/b.h": "namespace avbd {\nstruct A f() { return {}; }\n}\n"})

    def test_stages(self):
        self.objects("stages", {"src/step/20_contacts.cpp": ""}, "src/step has")
        self.objects("stages", {"docs/manual.md": "| `50_begin_rows` | x |\n| `10_pairs` | x |\n"}, "docs/manual.md has")
        self.objects("stages", {"include/avbd/profile.h": "enum class Stage { Pairs, Rows };\n"}, "'rows'")

    def test_words(self):
        self.objects("words", {"src/base/a.cpp": "struct StepContext {};\n"}, "StepContext")
        self.objects("words", {"src/base/string_utils.h": ""}, "string_utils.h")
        self.objects("words", {"src/base/a.cpp": "int x = ::getenv(a);\n"}, "getenv")
        self.objects("words", {"src/base/a.cpp": "void f() { std::cout << 1; }\n"}, "cout")
        self.accepts("words", {"src/base/a.cpp": '// a helper\nconst char* k = "context";\n'})
        self.accepts("words", {"app/a.cpp": "void f() { std::cout << 1; }\n"})

    def test_backends(self):
        def check(source):
            with tempfile.TemporaryDirectory() as folder:
                code = Path(folder) / "a.cpp"
                code.write_text(source)
                subprocess.run(["g++", "-c", code, "-o", Path(folder) / "a_w8.cpp.o"], check=True)
                script = ["bash", TOOLS / "check_backends.sh", folder]
                return subprocess.run(script, capture_output=True, text=True).returncode

        inline = "namespace avbd { namespace %s { inline int f() { return 1; } } int g() { return %s::f(); } }\n"
        self.assertEqual(check(inline % ("w8", "w8")), 0)
        self.assertEqual(check(inline % ("w4", "w4")), 1)
        self.assertEqual(check(inline % ("rows", "rows")), 1)

    def test_readme(self):
        self.objects("readme", {"samples/hello.cpp": "int main() { }\n"}, "does not show")
        self.objects("readme", {"CONTRIBUTING.md": "[x](docs/none.md)"}, "docs/none.md does not exist")

    def test_golden(self):
        kept = {"test/golden_hashes.txt": "chain krylov 1\n"}
        line = "- Recorded hashes ded68617: the first ones\n"
        self.objects("golden", {**kept, "CHANGELOG.md": "- Something else\n"}, "Recorded hashes ded68617")
        self.objects("golden", {"test/golden_hashes.txt": "chain krylov 2\n", "CHANGELOG.md": line}, "no line")
        self.accepts("golden", {**kept, "CHANGELOG.md": line})


if __name__ == "__main__":
    unittest.main()
