# SPDX-License-Identifier: BSD-3-Clause
"""Stores which sources passed the check, so that later runs skip unchanged sources.

A digest of everything on which the check of a source depends identifies the source: its text, the headers of this tree that it
includes, its compiler arguments, the checks, the version of Clang, and the versions of all installed packages with headers. A
library header that changes without a new package version is not detected.
"""
import hashlib
import pathlib
import re
import subprocess

_INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)


def surroundings(root: pathlib.Path) -> bytes:
    """Returns the data on which every check depends: the list of checks, and the versions of Clang and of packages with headers."""
    said = [subprocess.run(command, check=True, capture_output=True).stdout
            for command in (["clang-tidy", "--version"], ["dpkg-query", "-W", "-f", "${Package} ${Version}\n", "*-dev"])]
    return b"\0".join([(root / ".clang-tidy").read_bytes(), *said])


class Clean:
    """The sources that passed the check, stored in `folder` as empty files whose names are the digests."""

    def __init__(self, root: pathlib.Path, folder: pathlib.Path, headers: list[str], depends_on: bytes):
        self._root, self._folder, self._depends_on = root, folder, depends_on
        # An include names the end of a header's path. If two headers match, the source depends on both.
        self._ending: dict[str, list[str]] = {}
        for name in headers:
            parts = pathlib.PurePath(name).parts
            for at in range(len(parts)):
                self._ending.setdefault("/".join(parts[at:]), []).append(name)
        self._read: dict[str, tuple[bytes, list[str]]] = {}
        folder.mkdir(parents=True, exist_ok=True)

    def _file(self, name: str) -> tuple[bytes, list[str]]:
        """Returns the digest of a file of the tree, and the headers of the tree that the file includes."""
        if name not in self._read:
            text = (self._root / name).read_bytes()
            named = [header for include in _INCLUDE.findall(text.decode(errors="replace")) for header in self._ending.get(include, [])]
            self._read[name] = hashlib.sha256(text).digest(), named
        return self._read[name]

    def digest(self, name: str, words: list[str]) -> str:
        reached, waiting = {name}, [name]
        while waiting:
            new = set(self._file(waiting.pop())[1]) - reached
            reached |= new
            waiting += new
        out = hashlib.sha256(self._depends_on)
        for word in [name, *words]:
            out.update(word.encode() + b"\0")
        for header in sorted(reached):
            out.update(header.encode() + b"\0" + self._file(header)[0])
        return out.hexdigest()

    def holds(self, name: str, words: list[str]) -> bool:
        return (self._folder / self.digest(name, words)).exists()

    def add(self, name: str, words: list[str]) -> None:
        (self._folder / self.digest(name, words)).touch()
