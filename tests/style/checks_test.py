"""Each check is given a small tree with one mistake and must name its line; and a clean tree, which it must accept."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
CLEAN = "/// What it is for.\n#pragma once\n"


def run(check, files):
    """(exit status, output) of the check over a tree that holds the files."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, SCRIPTS / check, folder], capture_output=True, text=True)
        return done.returncode, done.stdout


class CheckLayers(unittest.TestCase):
    def refused(self, name, include):
        status, output = run("check_layers", {name: CLEAN + f"#include {include}\n"})
        self.assertEqual(status, 1, output)
        self.assertIn(f"{name}:3: ", output)

    def accepted(self, name, include):
        status, output = run("check_layers", {name: CLEAN + f"#include {include}\n"})
        self.assertEqual(status, 0, output)

    def test_refuses_each_arrow_that_points_up(self):
        for name, include in [
            ("models/raster/edge.h", '"hw/base/unit.h"'),
            ("models/raster/edge.h", '"traces/command_stream.h"'),
            ("models/raster/edge.h", '"models/reference/reference.h"'),
            ("models/reference/reference.h", '"models/raster/edge.h"'),
            ("hw/raster/coarse.h", '"traces/command_stream.h"'),
            ("hw/raster/coarse.h", '"pipeline/machine/machine.h"'),
            ("hw/base/unit.h", '"hw/raster/coarse.h"'),
            ("traces/file.h", '"scenes/scene.h"'),
            ("scenes/scene.h", '"pipeline/machine/machine.h"'),
            ("pipeline/machine/machine.h", '"scenes/scene.h"'),
            ("models/raster/edge.h", "<systemc>"),
            ("scenes/scene.h", "<systemc>"),
            ("pipeline/machine/machine.h", "<tiny_gltf.h>"),
            ("models/raster/edge.h", "<fstream>"),
            ("hw/raster/coarse.h", "<chrono>"),
            ("models/raster/edge.h", '"edge_function.h"'),
        ]:
            with self.subTest(name=name, include=include):
                self.refused(name, include)

    def test_accepts_what_the_table_allows(self):
        for name, include in [
            ("models/raster/edge.h", '"models/base/error.h"'),
            ("models/reference/reference.h", '"traces/command_stream.h"'),
            ("hw/raster/coarse.h", '"models/raster/edge.h"'),
            ("hw/base/unit.h", "<systemc>"),
            ("scenes/scene.h", '"traces/command_stream.h"'),
            ("pipeline/machine/machine.h", '"hw/raster/coarse.h"'),
            ("cli/render.h", '"scenes/scene.h"'),
            ("tests/hw/raster/coarse_test.h", '"hw/raster/coarse.h"'),
        ]:
            with self.subTest(name=name, include=include):
                self.accepted(name, include)


class CheckNames(unittest.TestCase):
    def findings(self, name, text):
        status, output = run("check_names", {name: text})
        self.assertEqual(status, 1 if ":" in output.replace("check_names:", "") else 0, output)
        return output

    def test_finds_each_mistake(self):
        for name, text, found in [
            ("models/utils.h", CLEAN, "models/utils.h:1: "),
            ("hw/raster/coarse_v2.h", CLEAN, "coarse_v2.h:1: "),
            ("hw/raster/Coarse.h", CLEAN, "Coarse.h:1: "),
            ("hw/raster/coarse.h", "#pragma once\n", "coarse.h:1: a file opens"),
            ("hw/raster/coarse.h", "/// What it is for.\nint x;\n", "coarse.h:1: a header"),
            ("hw/raster/coarse.h", CLEAN + "// TO" + "DO later\n", "coarse.h:3: unfinished"),
            ("hw/raster/coarse.h", CLEAN + 'auto p = "/ho' + 'me/me/x";\n', "coarse.h:3: a path"),
            ("hw/raster/coarse.h", CLEAN + "// " + "x" * 250 + "\n", "coarse.h:3: 253 columns"),
        ]:
            with self.subTest(name=name, found=found):
                self.assertIn(found, self.findings(name, text))

    def test_finds_what_ctest_or_catch_would_misread_in_the_name_of_a_case(self):
        for text, found in [
            ('TEST_CASE("unit: this; that") {}\n', "hw/x_test.cpp:1: ';' in the name"),
            ('int x;\nTEST_CASE(\n    "unit: this, "\n    "and; that", "[slow]") {}\n', "hw/x_test.cpp:2: ';' in the name"),
            ('TEST_CASE("-unit: this") {}\n', "hw/x_test.cpp:1: '-' in the name"),
            ('TEST_CASE("~unit: this") {}\n', "hw/x_test.cpp:1: '~' in the name"),
            ('TEST_CASE("unit: a*b") {}\n', "hw/x_test.cpp:1: '*' in the name"),
            ('TEST_CASE("unit: a \\"b\\"") {}\n', "hw/x_test.cpp:1: '\\' in the name"),
        ]:
            with self.subTest(text=text):
                self.assertIn(found, self.findings("hw/x_test.cpp", text))
        status, output = run("check_names", {"hw/x_test.cpp": 'TEST_CASE("unit: a-b") { f("a; b"); }\n'})
        self.assertEqual(status, 0, output)

    def test_accepts_a_clean_file_and_a_source_whose_header_speaks_for_it(self):
        status, output = run("check_names", {"models/edge.h": CLEAN, "models/edge.cpp": '#include "models/edge.h"\n'})
        self.assertEqual(status, 0, output)


class CheckLinks(unittest.TestCase):
    ROWS = '| <a id="D1"></a>D1 |\n'

    def findings(self, files):
        return run("check_links", {"docs/deviations.md": self.ROWS, **files})

    def test_finds_each_broken_reference(self):
        for files, found in [
            ({"README.md": "[kernel](docs/kernel.md)\n"}, "README.md:1: docs/kernel.md does not exist"),
            ({"docs/a.md": "\n[b](b.md#part)\n"}, "docs/a.md:2: b.md does not exist"),
            ({"hw/x.h": "/// (docs/deviations.md#D2)\n"}, "hw/x.h:1: docs/deviations.md has no row D2"),
            ({"hw/x.h": "/// (docs/deviations.md#D1), more (#D3)\n"}, "hw/x.h:1: docs/deviations.md has no row D3"),
            ({"hw/x.h": "/// docs/isa.md\n"}, "hw/x.h:1: docs/isa.md does not exist"),
            ({"docs/deviations.md": self.ROWS * 2}, "row D1 is there twice"),
        ]:
            with self.subTest(found=found):
                status, output = self.findings(files)
                self.assertEqual(status, 1, output)
                self.assertIn(found, output)

    def test_accepts_references_that_lead_somewhere(self):
        status, output = self.findings({
            "README.md": "[deviations](docs/deviations.md#D1) [site](https://example.org/x)\n",
            "hw/x.h": "/// docs/deviations.md#D1\n",
        })
        self.assertEqual(status, 0, output)


if __name__ == "__main__":
    unittest.main()
