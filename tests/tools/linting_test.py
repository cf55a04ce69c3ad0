#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the parts of tools/lint other than clang-format and clang-tidy: joint texts of many
sources, and the sources that passed before.

    linting_test.py TOOLS_FOLDER
"""
import importlib.machinery
import importlib.util
import pathlib
import shutil
import sys
import tempfile
import unittest

TOOLS = pathlib.Path(sys.argv.pop(1))
sys.dont_write_bytecode = True
sys.path.insert(0, str(TOOLS))
from linting import clean, groups  # noqa: E402


class Case(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = pathlib.Path(scratch.name)

    def write(self, name: str, *lines: str) -> str:
        (self.root / name).write_text("".join(line + "\n" for line in lines))
        return name


class Groups(Case):
    def source(self, name: str, *lines: str) -> groups.Source:
        return groups.read_source(self.root, self.write(name, *lines), ["-Iroot"])

    def test_names_of_their_own_are_told_apart_and_lines_found_again(self):
        body = ["namespace {", "struct Span {", "  int first;", "};", "int reach(Span span) { return span.first; }", "}  // namespace"]
        first = self.source("a.cpp", "#include <vector>", *body)
        second = self.source("b.cpp", "#include <vector>", "#include <map>", *body, "int b = other.reach + reach({});")
        text, places = groups.text_of([first, second])
        lines = text.splitlines()
        self.assertEqual(lines[:2], ["#include <vector>", "#include <map>"])
        self.assertEqual(len(lines), len(places))
        self.assertEqual(lines.count("struct Span {"), 1)
        self.assertEqual(lines.count("struct Span_1 {"), 1)
        at = lines.index("int b = other.reach + reach_1({});")  # a member of another class is unchanged
        self.assertEqual(places[at], ("b.cpp", 9))
        self.assertEqual(groups.suspected(f"/x/j.cpp:{at + 1}:5: error: e [c]", pathlib.Path("/x/j.cpp"), places), {"b.cpp"})

    def test_what_is_said_of_a_header_is_no_hint_about_a_source(self):
        joint = pathlib.Path("/x/j.cpp")
        of_header = "/x/h.hpp:3:1: error: e [c]\n"
        self.assertFalse(groups.of_headers("/x/j.cpp:7:5: error: e [c]\n    note without a place\n", joint))
        self.assertTrue(groups.of_headers("/x/j.cpp:7:5: error: e [c]\n" + of_header, joint))

    def test_a_word_of_the_language_is_no_name(self):
        pair = [self.source(name, "namespace {", "static_assert(true);", "}  // namespace") for name in ("a.cpp", "b.cpp")]
        self.assertEqual(groups.text_of(pair)[0].count("static_assert(true);"), 2)

    def test_an_include_under_a_condition_stays_there(self):
        text, _ = groups.text_of([self.source("a.cpp", "#ifdef X", "#include <map>", "#endif"), self.source("b.cpp", "int b;")])
        self.assertEqual(text.splitlines()[1], "#include <map>")

    def test_tests_of_one_name_are_read_apart(self):
        pair = [self.source(name, "TEST(Rail, Clips) {", "}") for name in ("a.cpp", "b.cpp")]
        self.assertEqual(len(groups.grouped(pair)), 2)
        self.assertEqual(len(groups.grouped([pair[0], self.source("c.cpp", "TEST(Rail, Wraps) {", "}")])), 1)

    def test_a_group_is_bounded(self):
        many = [self.source(f"s{index}.cpp", "int a;") for index in range(groups.MOST_SOURCES + 1)]
        self.assertEqual([len(group) for group in groups.grouped(many)], [groups.MOST_SOURCES, 1])


class WarningsOfClang(Case):
    def complaint(self, *lines: str) -> str:
        loader = importlib.machinery.SourceFileLoader("lint", str(TOOLS / "lint"))
        lint = importlib.util.module_from_spec(importlib.util.spec_from_loader("lint", loader))
        loader.exec_module(lint)
        lint.BUILD = self.root
        shutil.copy(TOOLS.parent / ".clang-tidy", self.root)
        return lint.complaint(self.root / self.write("a.cpp", *lines), ["-Wall"])

    def test_a_warning_is_a_complaint(self):
        self.assertIn("unused-variable", self.complaint("int f() {", "  int never_read;", "  return 1;", "}"))


class CleanSources(Case):
    def known(self, depends_on: bytes = b"checks") -> clean.Clean:
        headers = [path.relative_to(self.root).as_posix() for path in self.root.rglob("*.hpp")]
        return clean.Clean(self.root, self.root / "clean", headers, depends_on)

    def setUp(self):
        super().setUp()
        (self.root / "include" / "room").mkdir(parents=True)
        self.write("include/room/far.hpp", "int far();")
        self.write("near.hpp", "#include <room/far.hpp>")
        self.write("other.hpp", "int other();")
        self.write("a.cpp", '#include "near.hpp"', "#include <vector>")
        self.known().add("a.cpp", ["-O1"])

    def test_what_has_not_changed_is_not_read_again(self):
        self.assertTrue(self.known().holds("a.cpp", ["-O1"]))
        self.write("other.hpp", "double other();")  # a.cpp does not include this header
        self.assertTrue(self.known().holds("a.cpp", ["-O1"]))

    def test_all_that_a_reading_depends_on_counts(self):
        self.assertFalse(self.known().holds("a.cpp", ["-O2"]))
        self.assertFalse(self.known(b"other checks").holds("a.cpp", ["-O1"]))
        for name, line in (("include/room/far.hpp", "double far();"), ("near.hpp", ""), ("a.cpp", "int a;")):
            kept = (self.root / name).read_text()
            self.write(name, line)
            self.assertFalse(self.known().holds("a.cpp", ["-O1"]), name)
            self.write(name, *kept.splitlines())
            self.assertTrue(self.known().holds("a.cpp", ["-O1"]), name)

    def test_headers_that_include_each_other_end(self):
        self.write("near.hpp", "#include <room/far.hpp>")
        self.write("include/room/far.hpp", '#include "near.hpp"')
        self.known().add("a.cpp", ["-O1"])
        self.assertTrue(self.known().holds("a.cpp", ["-O1"]))


if __name__ == "__main__":
    unittest.main()
