#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the report page in headless Chromium: in light and dark, on a phone, on paper, and with names that contain
HTML. The page must draw its plots and animations, have no broken links, write nothing to the console and make no
network requests. As negative controls, every check must fail for a damaged page.

    report_test.py PROGRAM WORK_FOLDER
"""
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import time
import unittest
import urllib.parse

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from chromium import Chromium, Page  # noqa: E402
from pictures import Picture  # noqa: E402

PROGRAM = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 2 else None
WORK = pathlib.Path(sys.argv.pop(1)) if PROGRAM else None
SYNTHETIC = pathlib.Path(__file__).parent.parent / "bench" / "synthetic_results.py"
CHROMIUM = shutil.which("chromium")
SKIPPED = 77
SUITE = """name: small
doc: Enough for a page.
scenarios: [roll]
seeds: {first: 1, last: 4}
methods: [position/rolling, position/autogain_fusion, position/tumble]
timeout_s: 60
"""
HOSTILE = "</script><img src=x onerror=alert(1)><b>\"'&amp;"
STATE = "document.documentElement.dataset.state"
WIDTH = "Math.max(document.documentElement.scrollWidth, document.body.scrollWidth)"
PHONE = 375


def tumble(*arguments: object) -> None:
    subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], check=True, stdout=subprocess.DEVNULL)


def make_hostile(small: pathlib.Path, database: pathlib.Path) -> None:
    """Generates 40 draws from four. The names of a scenario and a method, and messages, contain text that ends an HTML
    element."""
    subprocess.run([sys.executable, SYNTHETIC, small, WORK / "big", "--outcomes", "120"], check=True, stdout=subprocess.DEVNULL)
    shutil.copy(WORK / "big" / "shard_1.db", database)
    with sqlite3.connect(database) as rows:
        rows.execute("UPDATE outcomes SET status = 'failed', message = ? WHERE method = 'autogain_fusion' AND seed % 4 = 0", (HOSTILE,))
        rows.execute("UPDATE outcomes SET method = ? WHERE method = 'autogain_fusion'", (HOSTILE,))
        for table in ("outcomes", "draw_values"):
            rows.execute(f"UPDATE {table} SET scenario = ?", (HOSTILE,))
        rows.execute("UPDATE notes SET text = ? WHERE key = 'suite'", (HOSTILE,))
    rows.close()


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        (WORK / "small.yaml").write_text(SUITE)
        database = WORK / "small.db"
        tumble("sweep", WORK / "small.yaml", "--db", database, "--examples", "1")
        cls.page, cls.badge = WORK / "page.html", WORK / "badge.svg"
        tumble("report", database, "-o", cls.page, "--badge", cls.badge)
        make_hostile(database, WORK / "hostile.db")
        cls.hostile = WORK / "hostile.html"
        tumble("report", WORK / "hostile.db", "-o", cls.hostile)
        cls.browser = Chromium(CHROMIUM)
        cls.addClassCleanup(cls.browser.close)

    def open(self, path: pathlib.Path, address: str = "", size=(1200, 800), dark=False) -> Page:
        page = Page(self.browser, path, address, size, dark)
        self.addCleanup(page.close)
        return page

    def complaints(self, page: Page, seconds: float = 60.0) -> list[str]:
        """Returns the faults of the page: missing plots, console messages, requests, or broken links. Empty for a
        correct page."""
        found = []
        if not page.wait_for(f"{STATE} === 'drawn'", seconds):
            found.append("state: not drawn")
        page.value("document.querySelectorAll('details').forEach((part) => { part.open = true; })")
        for name in page.value("[...document.querySelectorAll('.plot')].map((plot) => plot.id)") or []:
            at = f"document.getElementById({name!r})" if "'" not in name else f"[...document.querySelectorAll('.plot')].find((p) => p.id === {name!r})"
            page.value(f"{at}.scrollIntoView()")
            if not page.wait_for(f"{at}.querySelector('svg.main-svg') !== null", min(seconds, 20.0)):
                found.append(f"plot: {name}")
        found += [f"console: {line}" for line in page.console()] + [f"fetched: {url}" for url in page.fetched()]
        return found + [f"link: {address}" for address in self.dead_links(page)]

    @staticmethod
    def dead_links(page: Page) -> list[str]:
        """Returns the links of the page that have no target."""
        dead = page.value("[...document.querySelectorAll('a[href^=\"#\"]')].map((a) => a.getAttribute('href')).filter("
                          "(to) => document.getElementById(decodeURIComponent(to.slice(1))) === null)") or []
        others = page.value("[...document.querySelectorAll('a:not([href^=\"#\"])')].map((a) => a.href)") or []
        for url in others:
            parts = urllib.parse.urlsplit(url)
            if parts.scheme != "file" or not pathlib.Path(urllib.parse.unquote(parts.path)).is_file():
                dead.append(url)
        return dead

    def complains(self, page: Page, told) -> None:
        """Waits for the expected fault. A browser may report faults after it has drawn the page."""
        deadline = time.monotonic() + 60.0
        found = self.complaints(page, 4.0)
        while not any(told(line) for line in found) and time.monotonic() < deadline:
            page.browser.receive(0.2)
            found = self.complaints(page, 1.0)
        self.assertTrue(any(told(line) for line in found), found)

    def drawn(self, path: pathlib.Path, **named) -> Page:
        page = self.open(path, **named)
        self.assertEqual(self.complaints(page), [])
        return page

    def broken(self, old: str, new: str) -> pathlib.Path:
        text = self.page.read_text()
        self.assertIn(old, text)
        path = WORK / "broken.html"
        path.write_text(text.replace(old, new, 1))
        return path

    def test_is_drawn_silent_and_off_line(self):
        page = self.drawn(self.page)
        self.assertGreaterEqual(page.value("document.querySelectorAll('svg.main-svg').length"), 6)
        page.value("document.getElementById('motion-map').scrollIntoView()")
        self.assertGreater(Picture(page.picture()).colours(0.05, 0.05, 0.95, 0.6), 60, "density and points")
        self.assertGreaterEqual(page.value("document.querySelectorAll('nav a').length"), 8)

    def test_the_first_screen_says_who_wins_and_moves(self):
        page = self.open(self.page)
        self.assertTrue(page.wait_for(f"{STATE} === 'drawn'"))
        for part in ("h1", ".contest.won, .contest.lost, .contest.open", ".moving img"):
            self.assertLess(page.value(f"document.querySelector('{part}').getBoundingClientRect().top"), 800, part)
        box = page.value("(() => { const b = document.querySelector('.moving img').getBoundingClientRect();"
                         "return [b.left / 1200, b.top / 800, b.right / 1200, Math.min(1, b.bottom / 800)]; })()")

        def moved(seconds: float) -> float:
            first, most = Picture(page.picture()), 0.0
            deadline = time.monotonic() + seconds
            while time.monotonic() < deadline and most < 0.02:
                page.browser.receive(0.3)
                most = max(most, Picture(page.picture()).difference(first, *box))
            return most
        self.assertGreater(moved(20.0), 0.02, "it plays by itself")
        page.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
        self.assertTrue(page.wait_for("document.querySelector('.moving img').currentSrc.startsWith('data:image/png')"))
        page.browser.receive(1.0)
        self.assertEqual(moved(3.0), 0.0, "and stands for whoever asks")

    def test_its_replay_plays(self):
        page = self.open(self.page)
        self.assertTrue(page.wait_for(f"{STATE} === 'drawn'"))
        url = page.value("document.querySelector('.moving a').href")
        replay = self.open(pathlib.Path(urllib.parse.unquote(urllib.parse.urlsplit(url).path)), "t=2&pause&still")
        self.assertTrue(replay.wait_for(f"{STATE} === 'drawn'"))

    def test_in_dark_and_on_a_phone(self):
        def black(page: Page) -> float:
            return Picture(page.picture()).share(lambda r, g, b: max(r, g, b) < 70, 0.0, 0.0, 1.0, 1.0)
        dark, light = self.open(self.page, dark=True), self.open(self.page)
        for page in (dark, light):
            self.assertTrue(page.wait_for(f"{STATE} === 'drawn'"))
        self.assertGreater(black(dark), 0.5)
        self.assertLess(black(light), 0.3, "negative control")
        for path in (self.page, self.hostile):
            phone = self.drawn(path, size=(PHONE, 800))
            self.assertLessEqual(phone.value(WIDTH), PHONE, f"{path}: it scrolls sideways")
            self.assertEqual(self.cut_off(phone), [])
        long_title = self.open(self.broken("title.text.length > most", "title.text.length > 200"), size=(PHONE, 800))
        self.assertTrue(long_title.wait_for(f"{STATE} === 'drawn'"))
        self.complaints(long_title)
        self.assertNotEqual(self.cut_off(long_title), [], "negative control")
        wide = self.open(self.broken("<main>", "<main><div style='width: 500px'>wide</div>"), size=(PHONE, 800))
        self.assertTrue(wide.wait_for(f"{STATE} === 'drawn'"))
        self.assertGreater(wide.value(WIDTH), PHONE, "negative control")

    @staticmethod
    def cut_off(page: Page) -> list[str]:
        """Returns the plots with an axis title that exceeds the plot or overlaps its legend."""
        return page.value("""[...document.querySelectorAll('.plot')].flatMap((plot) => {
          const frame = plot.getBoundingClientRect(), box = (name) => [...plot.querySelectorAll(name)].map((part) => part.getBoundingClientRect());
          const out = (b) => b.width > 0 && (b.top < frame.top - 1 || b.bottom > frame.bottom + 1 || b.left < frame.left - 1 || b.right > frame.right + 1);
          const over = (a, b) => a.width > 0 && a.left < b.right && b.left < a.right && a.top < b.bottom - 1 && b.top < a.bottom - 1;
          const legends = box('.legend .bg').concat(box('.legend .legendtext'));
          return box('.g-xtitle, .g-ytitle').some((b) => out(b) || legends.some((other) => over(b, other))) ? [plot.id] : [];
        })""")

    def test_an_address_that_is_none_is_no_trouble(self):
        page = self.drawn(self.page, address="100%")
        self.assertEqual(page.value(STATE), "drawn")

    def test_on_paper(self):
        page = self.open(self.page, dark=True)
        self.assertTrue(page.wait_for(f"{STATE} === 'drawn'"))
        folded = "document.querySelectorAll('details:not([open])').length"
        before = page.value(folded)
        self.assertGreater(before, 3)
        page.value("window.addEventListener('beforeprint', () => { document.documentElement.dataset.folded = " + folded + "; })")
        pdf = page.browser.ask("Page.printToPDF", page.session, printBackground=True)["data"]
        self.assertTrue(pdf.startswith("JVBERi"), "a PDF")
        self.assertGreater(len(pdf), 50000)
        self.assertEqual(page.value("document.documentElement.dataset.folded"), "0", "what is folded cannot be read on paper")
        self.assertEqual(page.value(folded), before, "and is as it was afterwards")
        self.assertEqual(page.console(), [])

    def test_after_paper_in_the_dark(self):
        self.assertEqual(self.in_other_colours(self.page), [])
        again = self.broken("visible(element) ? draw(element) : drawn.delete(element)", "visible(element) && draw(element)")
        self.assertNotEqual(self.in_other_colours(again), [], "negative control")

    def in_other_colours(self, path: pathlib.Path) -> list[str]:
        """Returns the plots without the text colour of the page, if they are unfolded after printing."""
        page = self.open(path, dark=True)
        self.assertTrue(page.wait_for(f"{STATE} === 'drawn'"))
        # in other browsers, a folded element has no width
        page.value("document.head.insertAdjacentHTML('beforeend',"
                   "'<style>details:not([open]) > :not(summary) { display: none }</style>')")
        page.value("dispatchEvent(new Event('beforeprint')); dispatchEvent(new Event('afterprint'));")
        page.value("document.querySelectorAll('details').forEach((part) => { part.open = true; })")
        ink = "getComputedStyle(document.documentElement).getPropertyValue('--ink').trim()"
        found = []
        for place in range(page.value("document.querySelectorAll('.plot').length")):
            plot = f"document.querySelectorAll('.plot')[{place}]"
            page.value(f"{plot}.scrollIntoView()")
            if not page.wait_for(f"{plot}.layout !== undefined && {plot}.layout.font.color === {ink}", 2.0):
                found.append(page.value(f"{plot}.id"))
        return found

    def test_hostile_names_are_text(self):
        page = self.drawn(self.hostile)
        self.assertEqual(page.value("document.querySelectorAll('img[src=\"x\"], [onerror]').length"), 0)
        self.assertIn(HOSTILE, page.value("document.body.textContent"))
        self.assertIn(HOSTILE, page.value("document.title"))
        legend = page.value("[...document.querySelectorAll('.legendtext')].map((text) => text.textContent)")
        self.assertTrue(any(HOSTILE in text for text in legend), legend)
        self.assertIn("failed", page.value("document.getElementById('failures').textContent"))

    def test_the_badge_is_a_picture(self):
        page = self.open(self.badge, size=(400, 60))
        self.assertTrue(page.wait_for("document.documentElement !== null && document.documentElement.tagName === 'svg'"))
        self.assertGreater(Picture(page.picture()).colours(0.0, 0.0, 1.0, 0.4), 10)
        self.assertIn("small", page.value("document.documentElement.textContent"))

    def test_broken_pages_are_found(self):
        self.complains(self.open(self.broken("Plotly.react(", "Plotly.reacts(")), lambda line: line.startswith("plot:"))
        self.complains(self.open(self.broken("</body>", '<img src="https://example.org/a.png"></body>')),
                       lambda line: "Content Security Policy" in line)
        self.complains(self.open(self.broken('<section id="errors">', '<section id="mistakes">')),
                       lambda line: line == "link: #errors")


if __name__ == "__main__":
    if CHROMIUM is None:
        print("no chromium: tools/setup --for browser installs it")
        sys.exit(SKIPPED)
    unittest.main()
