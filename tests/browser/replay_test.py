#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the replay page in headless Chromium with software rendering, with and without truth. The page must draw, write
nothing to the console, and make no network requests. As negative controls, every check must fail for a damaged page.

    replay_test.py PROGRAM WORK_FOLDER
"""
import pathlib
import re
import shutil
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from chromium import Chromium, Page  # noqa: E402
from pictures import Picture  # noqa: E402

PROGRAM = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 2 else None
WORK = pathlib.Path(sys.argv.pop(1)) if PROGRAM else None
CHROMIUM = shutil.which("chromium")
SKIPPED = 77
SCENE = (0.34, 0.02, 0.85, 0.75)   # box in the window: right of the panel, above the controls, left of the clock
STRIP = (0.05, 0.86, 0.99, 0.97)
HOSTILE = "<img src=x onerror=alert(1)>.tum"
AT_REST = "document.documentElement.dataset.state === 'drawn' && document.documentElement.dataset.moving === 'false'"
OVER = f"document.documentElement.dataset.state === 'failed' || {AT_REST}"


def tumble(*arguments: object) -> None:
    subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], check=True, stdout=subprocess.DEVNULL)


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
        # the same recording without truth, and with an external trajectory whose name contains HTML
        tumble("export", recording, "--format", "rosbag2", "-o", WORK / "bag")
        tumble("import", WORK / "bag", "-o", WORK / "real.h5")
        theirs = WORK / HOSTILE
        tumble("export", recording, "--format", "tum", "-o", theirs)
        cls.real = WORK / "real.html"
        tumble("replay", WORK / "real.h5", theirs, "--frame", "body", "-o", cls.real)
        # a recording that contains only poses
        tumble("import", theirs, "--format", "tum", "-o", WORK / "poses.h5")
        cls.poses = WORK / "poses.html"
        tumble("replay", WORK / "poses.h5", "-o", cls.poses)
        cls.browser = Chromium(CHROMIUM)
        cls.addClassCleanup(cls.browser.close)

    def open(self, path: pathlib.Path, address: str = "t=5&pause&still", size=(1000, 640), dark=False) -> Page:
        page = Page(self.browser, path, address, size, dark)
        self.addCleanup(page.close)
        return page

    def complaints(self, page: Page, seconds: float = 60.0) -> list[str]:
        """Returns the faults of the page: console messages, requests, or a missing picture. Empty for a correct page."""
        page.wait_for(OVER, seconds)
        found = [f"console: {line}" for line in page.console()] + [f"fetched: {url}" for url in page.fetched()]
        state = page.value("document.documentElement.dataset.state")
        if state != "drawn":
            found.append(f"state: {state}")
        colours = Picture(page.picture()).colours(*SCENE)
        if colours < 300:
            found.append(f"scene: {colours} colours")
        return found

    def complains(self, page: Page, told, seconds: float = 60.0, drawn_s: float = 60.0) -> list[str]:
        """Waits for the expected fault and returns all faults. A browser may report faults after it has drawn the page."""
        found = self.complaints(page, drawn_s)
        deadline = time.monotonic() + seconds
        while not any(told(line) for line in found) and time.monotonic() < deadline:
            page.browser.receive(0.2)
            found = self.complaints(page, 1.0)
        self.assertTrue(any(told(line) for line in found), found)
        return found

    def drawn(self, path: pathlib.Path, *arguments, **named) -> tuple[Page, Picture]:
        page = self.open(path, *arguments, **named)
        self.assertEqual(self.complaints(page), [])
        return page, Picture(page.picture())

    @staticmethod
    def points(page: Page) -> int:
        return int(page.value("document.documentElement.dataset.points"))

    @staticmethod
    def clock(page: Page) -> float:
        return float(str(page.value("document.getElementById('clock').textContent")).split()[0])

    def broken(self, old: str, new: str) -> pathlib.Path:
        text = self.page.read_text()
        self.assertIn(old, text)
        path = WORK / "broken.html"
        path.write_text(text.replace(old, new, 1))
        return path

    def test_is_drawn_silent_and_off_line(self):
        page, picture = self.drawn(self.page)
        self.assertGreater(self.points(page), 20000)
        blue = picture.share(lambda r, g, b: b > 150 and b > r + 60 and b > g + 30, *SCENE)
        self.assertGreater(blue, 0.005, "points that lie on the surface are blue")
        self.assertGreater(picture.colours(*STRIP), 20, "the strip")
        self.assertLessEqual(self.page.stat().st_size, 3_000_000)

    def test_time_passes(self):
        early, at_first = self.drawn(self.page, "t=1&pause&still&whole")
        _, again = self.drawn(self.page, "t=1&pause&still&whole")
        late, at_last = self.drawn(self.page, "t=6&pause&still&whole")
        self.assertLess(self.points(early), self.points(late))
        self.assertLess(at_first.difference(again, *SCENE), 0.001, "the same instant is the same picture")
        self.assertGreater(at_first.difference(at_last, *SCENE), 0.01)
        playing = self.open(self.page, "t=2")
        self.assertTrue(playing.wait_for("parseFloat(document.getElementById('clock').textContent) > 2.5"), "by itself")
        self.assertEqual(playing.console(), [])

    def test_in_dark_and_on_a_phone(self):
        def black(picture: Picture) -> float:
            return picture.share(lambda r, g, b: max(r, g, b) < 60, *STRIP)
        self.assertGreater(black(self.drawn(self.page, dark=True)[1]), 0.4)
        self.assertLess(black(self.drawn(self.page)[1]), 0.2, "negative control")
        for width in (400, 390, 320):
            phone, _ = self.drawn(self.page, size=(width, 800))
            # the page does not scroll, so controls outside of the window cannot be reached
            beyond = phone.value("[...document.querySelectorAll('footer button, footer select, footer input, footer canvas')]"
                                 f".filter((e) => e.getBoundingClientRect().right > {width}).map((e) => e.id)")
            self.assertEqual(beyond, [], width)
            slider = phone.value("document.getElementById('scrub').getBoundingClientRect().width")
            self.assertGreater(slider, 100, width)

    def test_without_truth_and_under_a_hostile_name(self):
        page, _ = self.drawn(self.real, "t=4&pause&still")
        self.assertGreater(self.points(page), 10000)
        self.assertIn("colour of each lidar point shows its height", page.value("document.body.innerText"))
        self.assertEqual(page.value("document.images.length"), 0)
        self.assertIn("<img src=x onerror=alert(1)>", page.value("document.getElementById('actors').textContent"))

    def test_poses_alone(self):
        page = self.open(self.poses, "t=4&pause&still")
        page.wait_for(OVER)
        self.assertEqual((page.console(), page.fetched()), ([], []))
        self.assertGreater(Picture(page.picture()).colours(*SCENE), 60, "a body above an empty ground")

    def test_keys_do_what_they_say(self):
        page, _ = self.drawn(self.page)
        end_s = float(re.search(r'"end_s":([\d.]+)', self.page.read_text()).group(1))
        for key in ("End", "2", "f", "g", "p", "+", "h", "ArrowLeft"):
            page.value(f"document.dispatchEvent(new KeyboardEvent('keydown', {{key: '{key}', bubbles: true}}))")
        self.assertEqual(self.complaints(page), [])
        self.assertAlmostEqual(self.clock(page), end_s - 0.1, delta=0.011)
        said = page.value("['axis', 'speed', 'placed'].map((id) => document.getElementById(id).value).join()")
        self.assertEqual(said, "x,2,0", "speed 1 to 2, points by the truth")
        self.assertFalse(page.value("document.getElementById('keys').hidden"))
        self.assertEqual(page.value("document.getElementById('camera').textContent"), "whole")
        self.assertFalse(page.value("document.querySelectorAll('#actors input')[1].checked"))

    def test_a_drag_turns_and_a_click_on_the_strip_goes_there(self):
        page, before = self.drawn(self.page)
        def mouse(kind, x, y):
            page.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)
        for kind, x, y in (("mousePressed", 600, 200), ("mouseMoved", 700, 240), ("mouseReleased", 700, 240)):
            mouse(kind, x, y)
        self.assertTrue(page.wait_for("document.documentElement.dataset.moving === 'true'"))
        self.assertEqual(self.complaints(page), [])
        self.assertGreater(Picture(page.picture()).difference(before, *SCENE), 0.1)
        mouse("mousePressed", 960, 580)
        mouse("mouseReleased", 960, 580)
        self.assertGreater(self.clock(page), 9.0)

    def test_broken_pages_are_found(self):
        shader = self.complains(self.open(self.broken("gl_PointSize =", "gl_PointSizes =")), lambda line: "shader points" in line)
        self.assertIn("state: failed", shader)
        data = self.complains(self.open(self.broken('"format":"tumble replay"', '"format":tumble')), lambda line: "JSON" in line, drawn_s=4.0)
        self.assertTrue(any(line.startswith("scene:") for line in data), data)
        self.complains(self.open(self.broken("</body>", '<img src="https://example.org/a.png"></body>')),
                       lambda line: "Content Security Policy" in line)
        policy = re.search(r'<meta http-equiv="Content-Security-Policy"[^>]*>', self.page.read_text()).group(0)
        self.complains(self.open(self.broken(policy, '<link rel="stylesheet" href="absent.css">')),
                       lambda line: line.startswith("fetched:"))



if __name__ == "__main__":
    if CHROMIUM is None:
        print("no chromium: tools/setup --for browser installs it")
        sys.exit(SKIPPED)
    unittest.main()
