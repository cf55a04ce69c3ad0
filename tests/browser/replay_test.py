#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The replay page in headless Chromium with software rendering: it draws, says nothing on the console and asks the
network nothing, with truth and without, and every check refuses a page that is broken on purpose.

    replay_test.py PROGRAM WORK_FOLDER
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from pictures import Picture  # noqa: E402

PROGRAM = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else None
WORK = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else None
CHROMIUM = shutil.which("chromium")
SKIPPED = 77
SCENE = (0.3, 0.02, 0.85, 0.75)   # of the window: right of the panel, above the controls, left of the clock
STRIP = (0.05, 0.86, 0.99, 0.97)
HOSTILE = "<img src=x onerror=alert(1)>.tum"


def tumble(*arguments: object) -> None:
    subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], check=True, stdout=subprocess.DEVNULL)


class Seen:
    """What a browser made of a page: its picture, its document, what its console said."""

    def __init__(self, page: pathlib.Path, address: str = "", size: str = "1000,640", flags: tuple[str, ...] = ()):
        with tempfile.TemporaryDirectory() as scratch:
            shot = pathlib.Path(scratch) / "shot.png"
            common = [CHROMIUM, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                      "--virtual-time-budget=2500", "--hide-scrollbars", f"--user-data-dir={scratch}/profile",
                      f"--window-size={size}", "--enable-logging=stderr", "--v=0", "--disable-background-networking",
                      "--disable-component-update", "--no-first-run", *flags]
            target = page.as_uri() + ("#" + address if address else "")
            drawn = subprocess.run([*common, f"--screenshot={shot}", target], capture_output=True, timeout=120, check=True)
            dumped = subprocess.run([*common, "--dump-dom", target], capture_output=True, timeout=120, check=True)
            self.picture = Picture(shot)
            self.document = dumped.stdout.decode(errors="replace")
            said = (drawn.stderr + dumped.stderr).decode(errors="replace").splitlines()
            self.console = [line for line in said if "CONSOLE" in line]

    def complaints(self) -> list[str]:
        """Why this is no replay that was drawn; empty when it is one."""
        found = [f"console: {line}" for line in self.console]
        state = re.search(r'<html[^>]*data-state="(\w+)"', self.document)
        if not state or state.group(1) != "drawn":
            found.append(f"state: {state.group(1) if state else 'none'}")
        colours = self.picture.colours(*SCENE)
        if colours < 800:
            found.append(f"scene: {colours} colours")
        return found

    def points(self) -> int:
        return int(re.search(r'data-points="(\d+)"', self.document).group(1))

    def text(self, name: str) -> str:
        return re.search(rf'id="{name}"[^>]*>([^<]*)<', self.document).group(1)


def bluish(r: int, g: int, b: int) -> bool:
    return b > 150 and b > r + 60 and b > g + 30


class ReplayPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        run = WORK / "run"
        tumble("run", "hill", "--seed", 2001, "--method", "rate/raw", "--method", "slam/tumble", "-o", run)
        recording = run / "recording.h5"
        cls.page = WORK / "replay.html"
        tumble("replay", recording, run / "estimates/slam-tumble", run / "estimates/rate-raw", "-o", cls.page)
        # the same without its truth, and with a trajectory of somebody else's under a hostile name
        tumble("export", recording, "--format", "rosbag2", "-o", WORK / "bag")
        tumble("import", WORK / "bag", "-o", WORK / "real.h5")
        theirs = WORK / HOSTILE
        tumble("export", recording, "--format", "tum", "-o", theirs)
        cls.real = WORK / "real.html"
        tumble("replay", WORK / "real.h5", theirs, "--frame", "body", "-o", cls.real)
        cls.seen = Seen(cls.page, "t=5&pause&still")

    def broken(self, old: str, new: str) -> pathlib.Path:
        text = self.page.read_text()
        self.assertIn(old, text)
        path = WORK / "broken.html"
        path.write_text(text.replace(old, new, 1))
        return path

    def test_is_drawn_and_silent(self):
        self.assertEqual(self.seen.complaints(), [])
        self.assertGreater(self.seen.points(), 20000)
        self.assertGreater(self.seen.picture.share(bluish, *SCENE), 0.01, "points that lie on the surface are blue")
        self.assertGreater(self.seen.picture.colours(*STRIP), 20, "the strip")
        self.assertLessEqual(self.page.stat().st_size, 3_000_000)

    def test_time_passes(self):
        early = Seen(self.page, "t=1&pause&still&whole")
        self.assertEqual(early.complaints(), [])
        self.assertLess(early.points(), self.seen.points())
        again = Seen(self.page, "t=1&pause&still&whole")
        late = Seen(self.page, "t=6&pause&still&whole")
        self.assertGreater(early.picture.difference(late.picture, *SCENE), 0.01)
        self.assertLess(early.picture.difference(again.picture, *SCENE), 0.001, "the same instant is the same picture")
        playing = Seen(self.page, "t=2")
        self.assertEqual(playing.complaints(), [])
        self.assertGreater(float(playing.text("clock").split()[0]), 2.2, "it plays by itself")

    def test_in_dark_and_on_a_phone(self):
        dark = Seen(self.page, "t=5&pause&still", flags=("--blink-settings=preferredColorScheme=0",))
        self.assertEqual(dark.complaints(), [])
        black = dark.picture.share(lambda r, g, b: max(r, g, b) < 60, *STRIP)
        self.assertGreater(black, 0.4)
        self.assertLess(self.seen.picture.share(lambda r, g, b: max(r, g, b) < 60, *STRIP), 0.2, "negative control")
        phone = Seen(self.page, "t=5&pause&still", size="500,900")
        self.assertEqual(phone.complaints(), [])

    def test_without_truth_and_under_a_hostile_name(self):
        real = Seen(self.real, "t=4&pause&still")
        self.assertEqual(real.complaints(), [])
        self.assertGreater(real.points(), 10000)
        self.assertIn("colour of its height", real.document)
        self.assertNotIn("<img", real.document)
        self.assertIn("&lt;img src=x onerror=alert(1)&gt;", real.document)

    def test_keys_do_what_they_say(self):
        press = "".join(f"document.dispatchEvent(new KeyboardEvent('keydown', {{key: '{key}', bubbles: true}}));"
                        for key in ("End", "2", "f", "g", "p", "+", "h", "ArrowLeft"))
        page = self.broken("</body>", f"<script>setTimeout(() => {{ {press} }}, 300);</script></body>")
        seen = Seen(page, "t=5&pause&still")
        self.assertEqual(seen.complaints(), [])
        end_s = float(re.search(r'"end_s":([\d.]+)', self.page.read_text()).group(1))
        self.assertAlmostEqual(float(seen.text("clock").split()[0]), end_s - 0.1, places=1)
        self.assertNotRegex(seen.document, r'id="keys" hidden')
        self.assertIn(">whole<", seen.document)

    def test_broken_pages_are_found(self):
        shader = Seen(self.broken("gl_PointSize =", "gl_PointSizes ="), "t=5&pause&still").complaints()
        self.assertTrue(any("shader points" in line for line in shader), shader)
        self.assertTrue(any(line.startswith("state: failed") for line in shader), shader)
        data = Seen(self.broken('"format":"tumble replay"', '"format":tumble'), "t=5&pause&still").complaints()
        self.assertTrue(any(line.startswith("scene:") for line in data), data)
        fetching = Seen(self.broken("</body>", '<img src="https://example.org/a.png"></body>'), "t=5&pause&still")
        self.assertTrue(any("Content Security Policy" in line for line in fetching.complaints()), fetching.console)


if __name__ == "__main__":
    if CHROMIUM is None:
        print("no chromium: tools/setup --for browser installs it")
        sys.exit(SKIPPED)
    unittest.main()
