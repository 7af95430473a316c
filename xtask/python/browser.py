"""Opens reports in headless Chromium and looks at them as a strict reader would.

Usage: browser.py JOB.json, with {"browser": file, "pages": [{"name", "file", "out"}]}

It speaks the DevTools protocol over two pipes, so it needs nothing but Python. What is measured in the page is in page.js.
"""

import base64
import json
import os
import pathlib
import re
import select
import subprocess
import sys
import tempfile
import time

from checks import Failed, NotRun, check, fail_on

WIDTH, HEIGHT = 1280, 900
CONTRAST = 4.5
PAPERS = {"A4": (8.27, 11.69), "Letter": (8.5, 11.0)}
FLAGS = [
    "--headless", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--remote-debugging-pipe",
]
PATIENCE = 60  # seconds for any one answer


class Browser:
    """A browser process and the protocol's messages."""

    def __init__(self, program, profile, log):
        if os.name == "nt":
            raise NotRun("the pipe to the browser is not made for Windows")
        import fcntl

        def moved(end):
            """The browser reads from descriptor 3 and writes to 4; the ends to hand over must not be these themselves."""
            other = fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, 10)
            os.close(end)
            return other

        to_browser, self.writer = os.pipe()
        self.reader, from_browser = os.pipe()
        to_browser, from_browser = moved(to_browser), moved(from_browser)

        def hand_over():
            os.dup2(to_browser, 3)
            os.dup2(from_browser, 4)

        flags = [*FLAGS, f"--user-data-dir={profile}"]
        if hasattr(os, "geteuid") and os.geteuid() == 0:
            flags.append("--no-sandbox")
        self.process = subprocess.Popen(
            [program, *flags, "about:blank"], stdin=subprocess.DEVNULL, stdout=log, stderr=log, close_fds=False, preexec_fn=hand_over
        )
        os.close(to_browser)
        os.close(from_browser)
        self.buffer, self.number, self.events = b"", 0, []

    def read(self, deadline):
        """The next message."""
        while b"\0" not in self.buffer:
            if not select.select([self.reader], [], [], max(0.0, deadline - time.monotonic()))[0]:
                raise Failed(f"the browser did not answer within {PATIENCE} s")
            received = os.read(self.reader, 1 << 20)
            if not received:
                raise Failed("the browser ended")
            self.buffer += received
        message, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(message)

    def send(self, method, session=None, **parameters):
        """Asks and waits for the answer; events that come meanwhile are kept."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.writer, data):]
        deadline = time.monotonic() + PATIENCE
        while True:
            answer = self.read(deadline)
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise Failed(f"{method}: {answer['error'].get('message')}")
                return answer["result"]
            if "method" in answer:
                self.events.append(answer)

    def wait_for(self, event, session):
        """Waits until the event has come."""
        deadline = time.monotonic() + PATIENCE
        while not any(known["method"] == event and known.get("sessionId") == session for known in self.events):
            message = self.read(deadline)
            if "method" in message:
                self.events.append(message)

    def close(self):
        try:
            self.send("Browser.close")
            self.process.wait(10)
        except (Failed, OSError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()


class Page:
    """One opened file."""

    def __init__(self, browser, path):
        self.browser, self.url = browser, pathlib.Path(path).resolve().as_uri()
        target = browser.send("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.send(f"{domain}.enable")
        self.resize(HEIGHT)
        self.send("Page.navigate", url=self.url)
        browser.wait_for("Page.loadEventFired", self.session)
        # Whatever a script starts after loading shall have begun.
        self.evaluate("new Promise(done => setTimeout(done, 300))")
        browser.send("Target.activateTarget", targetId=target)

    def send(self, method, **parameters):
        return self.browser.send(method, self.session, **parameters)

    def resize(self, height):
        self.send("Emulation.setDeviceMetricsOverride", width=WIDTH, height=height, deviceScaleFactor=1, mobile=False)

    def scheme(self, name):
        self.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}])

    def evaluate(self, expression):
        answer = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise Failed(describe(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def measure(self, name, *arguments):
        """Calls a function of page.js."""
        script = pathlib.Path(__file__).with_name("page.js").read_text("utf-8")
        return self.evaluate(f"(() => {{ {script}\nreturn {name}({', '.join(map(json.dumps, arguments))}); }})()")

    def events(self, *methods):
        return [event["params"] for event in self.browser.events if event["method"] in methods and event.get("sessionId") == self.session]


def describe(details):
    thrown = details.get("exception", {})
    return f"{details.get('text', '')} {thrown.get('description', thrown.get('value', ''))}".strip()


def silent(page):
    """No message on the console, no exception, nothing in the browser's log."""
    problems = [f"exception: {describe(event['exceptionDetails'])}" for event in page.events("Runtime.exceptionThrown")]
    for event in page.events("Runtime.consoleAPICalled"):
        words = [str(word.get("value", word.get("description", ""))) for word in event["args"]]
        problems.append(f"console.{event['type']}: {' '.join(words)}")
    problems += [f"log: {event['entry']['level']}: {event['entry']['text']} {event['entry'].get('url', '')}" for event in page.events("Log.entryAdded")]
    fail_on(problems)


def alone(page):
    """The file asks for nothing but itself; what it carries inside as data is no request."""
    asked = {event["request"]["url"].split("#")[0] for event in page.events("Network.requestWillBeSent")}
    fail_on([f"requests {url}" for url in sorted(asked) if url != page.url and not url.startswith(("data:", "blob:"))])


def contrast(page, scheme):
    page.scheme(scheme)
    # Everything must be inside the window to see what lies under it.
    page.resize(max(HEIGHT, min(20000, page.evaluate("document.documentElement.scrollHeight"))))
    found = page.measure("contrasts", CONTRAST)
    page.resize(HEIGHT)
    if found["judged"] <= found["unknown"]:
        raise Failed(f"only {found['judged']} texts could be judged, {found['unknown']} are covered or stand on a picture")
    fail_on(found["problems"])


def printed(page, paper, out):
    """A PDF with pages."""
    page.scheme("light")
    width, height = PAPERS[paper]
    answer = page.send("Page.printToPDF", paperWidth=width, paperHeight=height, printBackground=True)
    data = base64.b64decode(answer["data"])
    (out / f"report-{paper}.pdf").write_bytes(data)
    pages = len(re.findall(rb"/Type\s*/Page\b", data))
    if not data.startswith(b"%PDF-") or pages == 0:
        raise Failed(f"{len(data)} bytes with {pages} pages")


def picture(page, scheme, out):
    page.scheme(scheme)
    answer = page.send("Page.captureScreenshot", format="png", captureBeyondViewport=True)
    (out / f"report-{scheme}.png").write_bytes(base64.b64decode(answer["data"]))


def opened(browser, job):
    if not pathlib.Path(job["file"]).is_file():
        raise Failed(f"{job['file']} does not exist")
    return Page(browser, job["file"])


def wanted_figures(job):
    """The figures that stand beside the report as files; every mechanism has at least its drawing and its force, torque or stiffness."""
    found = {path.stem for path in pathlib.Path(job["file"]).parent.glob("*.svg")}
    main = next((name for name in ("torque", "force", "stiffness", "characteristic") if name in found), "force")
    return sorted(found | {"mechanism", main})


def look_at(browser, job):
    name, out = job["name"], pathlib.Path(job["out"])
    out.mkdir(parents=True, exist_ok=True)
    page = check(f"{name} opens", lambda: opened(browser, job))
    if page is None:
        return
    check(f"{name}: every figure shows a drawing", lambda: fail_on(page.measure("figures", wanted_figures(job))))
    check(f"{name}: nothing is wider than {WIDTH} px", lambda: fail_on(page.measure("overflow")))
    check(f"{name}: no text outside its drawing", lambda: fail_on(page.measure("textsOutside")))
    check(f"{name}: no texts over each other in a drawing", lambda: fail_on(page.measure("textsOverlapping")))
    check(f"{name}: every frame of a film can be seen, by itself", lambda: fail_on(page.measure("frames")))
    for scheme in ("light", "dark"):
        check(f"{name}: contrast of text, {scheme}", lambda scheme=scheme: contrast(page, scheme))
        check(f"{name}: picture, {scheme}", lambda scheme=scheme: picture(page, scheme, out))
    for paper in PAPERS:
        check(f"{name}: prints on {paper}", lambda paper=paper: printed(page, paper, out))
    # Last, so that they cover everything above.
    check(f"{name}: console is silent", lambda: silent(page))
    check(f"{name}: requests nothing but itself", lambda: alone(page))


def start(job, profile, log):
    browser = Browser(job["browser"], profile, log)
    try:
        browser.send("Browser.getVersion")
    except (Failed, OSError) as error:
        browser.process.kill()
        browser.process.wait()
        log.seek(0)
        last = log.read().decode(errors="replace").strip().splitlines()[-3:]
        raise Failed(f"{job['browser']} does not start: {error}", *last) from None
    return browser


def main():
    job = json.loads(pathlib.Path(sys.argv[1]).read_text("utf-8"))
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile, tempfile.TemporaryFile() as log:
        browser = check("the browser starts", lambda: start(job, profile, log))
        if browser is None:
            return
        try:
            for page in job["pages"]:
                look_at(browser, page)
        finally:
            browser.close()


if __name__ == "__main__":
    main()
