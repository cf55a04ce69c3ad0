# SPDX-License-Identifier: BSD-3-Clause
"""Controls a headless Chromium through pipes (Chrome DevTools Protocol, --remote-debugging-pipe). A message is JSON
text that ends in a zero byte. Chromium renders in software and needs no display."""
import base64
import json
import os
import pathlib
import select
import subprocess
import tempfile
import time

FLAGS = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars",
         "--disable-background-networking", "--disable-component-update", "--no-first-run", "--remote-debugging-pipe"]


class Chromium:
    def __init__(self, program: str):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        # Chromium reads from its descriptor 3 and writes to 4
        read_here, write_there = os.pipe()
        read_there, self.to = os.pipe()
        high_read, high_write = os.dup2(read_there, 103, True), os.dup2(write_there, 104, True)
        command = [program, *FLAGS, f"--user-data-dir={self.profile.name}", "about:blank"]
        self.child = subprocess.Popen(["bash", "-c", 'exec "$@" 3<&103 4>&104', "bash", *command],
                                      pass_fds=(high_read, high_write), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for descriptor in (read_there, write_there, high_read, high_write):
            os.close(descriptor)
        self.answers = read_here
        self.text, self.count, self.events = b"", 0, []

    def close(self) -> None:
        self.child.terminate()
        self.child.wait(20)
        os.close(self.to)
        os.close(self.answers)
        self.profile.cleanup()

    def receive(self, seconds: float) -> None:
        """Waits at most this time for a message, and appends it to the events."""
        if not select.select([self.answers], [], [], max(seconds, 0.0))[0]:
            return
        chunk = os.read(self.answers, 1 << 20)
        assert chunk, "the browser has ended"
        *whole, self.text = (self.text + chunk).split(b"\0")
        self.events += [json.loads(message) for message in whole]

    def ask(self, method: str, session: str = "", seconds: float = 90.0, **parameters: object) -> dict:
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters} | ({"sessionId": session} if session else {})
        remaining = json.dumps(message).encode() + b"\0"
        while remaining:
            remaining = remaining[os.write(self.to, remaining):]
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            for i, event in enumerate(self.events):
                if event.get("id") == self.count:
                    del self.events[i]
                    assert "error" not in event, event
                    return event["result"]
            self.receive(1.0)
        raise TimeoutError(method)


class Page:
    """A page in a separate window. Returns its console messages, requests and screenshots."""

    def __init__(self, browser: Chromium, path: pathlib.Path, address: str, size: tuple[int, int], dark: bool):
        self.browser = browser
        self.target = browser.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.ask("Target.attachToTarget", targetId=self.target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.ask(domain + ".enable")
        self.ask("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1, mobile=False)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.ask("Emulation.setEmulatedMedia", features=[scheme, {"name": "prefers-reduced-motion", "value": "no-preference"}])
        self.address = path.as_uri() + ("#" + address if address else "")
        self.ask("Page.navigate", url=self.address)

    def ask(self, method: str, **parameters: object) -> dict:
        return self.browser.ask(method, self.session, **parameters)

    def value(self, expression: str) -> object:
        return self.ask("Runtime.evaluate", expression=expression, returnByValue=True)["result"].get("value")

    def wait_for(self, expression: str, seconds: float = 60.0) -> bool:
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            if self.value(expression):
                return True
            self.browser.receive(0.1)
        return False

    def mine(self, method: str) -> list[dict]:
        return [event["params"] for event in self.browser.events
                if event.get("sessionId") == self.session and event.get("method") == method]

    def console(self) -> list[str]:
        """Returns all console messages: from the page, of uncaught errors, and from the browser."""
        said = [" ".join(str(word.get("value", word.get("description"))) for word in one["args"])
                for one in self.mine("Runtime.consoleAPICalled")]
        said += [str(one["exceptionDetails"].get("exception", {}).get("description", one["exceptionDetails"]["text"]))
                 for one in self.mine("Runtime.exceptionThrown")]
        return said + [one["entry"]["text"] for one in self.mine("Log.entryAdded")]

    def fetched(self) -> list[str]:
        """Returns the addresses that the page requested, except its own address and data URLs."""
        own = self.address.split("#")[0]
        asked = [one["request"]["url"] for one in self.mine("Network.requestWillBeSent")]
        return [url for url in asked if url.split("#")[0] not in (own, "about:blank") and not url.startswith("data:")]

    def picture(self) -> bytes:
        return base64.b64decode(self.ask("Page.captureScreenshot", format="png")["data"])

    def close(self) -> None:
        self.browser.ask("Target.closeTarget", targetId=self.target)
