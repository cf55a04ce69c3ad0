# SPDX-License-Identifier: BSD-3-Clause
"""Joins many sources to one text, so that Clang reads the library headers only once.

Most of the time of a check is spent in the headers of Eigen, GoogleTest and JSON, which clang-tidy also checks. A joint file
therefore contains all includes first, then the sources one after the other. If two sources have equal names in unnamed
namespaces, the second name is changed. Names may clash in other ways, so Clang's messages about a joint file are only hints.
The caller therefore checks the sources with messages separately.
"""
import dataclasses
import pathlib
import re

MOST_SOURCES = 24  # larger groups save little time and need more memory
MOST_LINES = 5000

_OWN_BEGINS, _OWN_ENDS = "namespace {", "}  // namespace"
_TYPE = re.compile(r"(?:struct|class|enum(?: class)?|union|concept|using)\s+(\w+)\s*(?:=|\{|:(?!:)|final|$)")
_FUNCTION = re.compile(r"[^(]*?(?<![:.~\w])(\w+)\(")
_VARIABLE = re.compile(r"[\w:<>,&* ]+[\s&*](\w+)(?:\[[^\]]*\])*\s*(?:=|\{|;)")
_TEST = re.compile(r"(?:TYPED_TEST|TEST|MATCHER|INSTANTIATE_TEST_SUITE|TYPED_TEST_SUITE|BENCHMARK)(?:_[A-Z]\d*)?\(([^)]*)")


@dataclasses.dataclass
class Source:
    name: str
    text: str
    words: list[str]  # arguments of the source's compilation
    own: set[str]     # names in its unnamed namespaces; other sources may have the same names
    tests: set[str]   # names of its tests; no other source of the group may have them


def read_source(root: pathlib.Path, name: str, words: list[str]) -> Source:
    text = (root / name).read_text()
    own, tests = set(), set()
    inside = False
    for line in text.splitlines():
        if line in (_OWN_BEGINS, _OWN_ENDS):
            inside = line == _OWN_BEGINS
        elif found := _TEST.match(line):
            tests.add(found[1])
        elif (line[:1].isalpha() or line.startswith("[")) and not line.startswith("static_assert"):
            line = re.sub(r"^(?:\[\[\w+\]\]|template <[^;{]*?>)\s*(?=[a-zA-Z])", "", line.split("//")[0].rstrip())
            if inside or line.startswith(("static ", "int main(")):
                own |= {found[1] for found in [_declared(line)] if found}
    return Source(name, text, words, own, tests)


def _declared(line: str) -> re.Match | None:
    begins = line.find("(")
    is_function = begins >= 0 and "=" not in line[:begins]
    return _TYPE.match(line) or (_FUNCTION.match(line) if is_function else _VARIABLE.match(line))


def grouped(sources: list[Source]) -> list[list[Source]]:
    """Assigns each source, in the given order, to the first group that has room and no test of the same name."""
    groups: list[list[Source]] = []
    for source in sources:
        for group in groups:
            lines = sum(member.text.count("\n") for member in group)
            if len(group) < MOST_SOURCES and lines < MOST_LINES and all(source.tests.isdisjoint(member.tests) for member in group):
                group.append(source)
                break
        else:
            groups.append([source])
    return groups


def words_of(root: pathlib.Path, group: list[Source]) -> list[str]:
    """Returns compiler arguments for the whole group, whose include path contains the folders of all sources."""
    folders = dict.fromkeys(str((root / source.name).parent) for source in group)
    out = [*group[0].words, *(word for folder in folders for word in ("-iquote", folder))]
    for source in group[1:]:
        words = iter(source.words)
        for word in words:
            pair = [word, next(words)] if word == "-isystem" else [word]
            if len(pair) == 2 and pair[1] not in out or len(pair) == 1 and word not in out:
                out += pair
    return out


def text_of(group: list[Source]) -> tuple[str, list[tuple[str, int]]]:
    """Returns the joint text, and the source and line number of each of its lines."""
    included: dict[str, tuple[str, int]] = {}
    body, places = [], []
    taken: set[str] = set()
    for at, source in enumerate(group):
        renamed = source.own & taken
        taken |= source.own
        # Members and qualified names belong to other classes or namespaces, so they stay unchanged.
        pattern = re.compile(r"(?<![.>:\w])(" + "|".join(sorted(renamed)) + r")\b") if renamed else None
        depth = 0  # depth of preprocessor conditions; a conditional include is not moved
        for number, line in enumerate(source.text.splitlines(), 1):
            depth += line.startswith("#if")
            depth -= line.startswith("#endif")
            if depth == 0 and line.startswith("#include"):
                included.setdefault(line.split("//")[0].strip(), (source.name, number))
                line = ""
            body.append(pattern.sub(rf"\1_{at}", line) if pattern else line)
            places.append((source.name, number))
    return "\n".join([*included, *body]) + "\n", [*included.values(), *places]


def of_headers(said: str, joint: pathlib.Path) -> bool:
    """Returns true if a message belongs to a file other than the joint text."""
    return any(found[1] != str(joint) for found in re.finditer(r"^([^\s:]+):\d+:\d+: (?:warning|error): ", said, re.MULTILINE))


def suspected(said: str, file: pathlib.Path, places: list[tuple[str, int]]) -> set[str]:
    """Returns the sources that have messages about their lines in the joint file."""
    return {places[int(line) - 1][0] for line in re.findall(re.escape(str(file)) + r":(\d+):\d+: (?:error|warning):", said)}
