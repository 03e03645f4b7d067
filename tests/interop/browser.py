"""Opens a job's report.html in headless Chromium with the network off and uses it.

Usage: browser.py REPORT.html [--shots DIR]

Talks to `chromium` (on the path) through its debugging pipe; needs nothing but the standard library.
"""

import argparse
import base64
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

USE = """(async () => {
  const told = {}, canvas = document.getElementById("view"), fw = window.finwright;
  const wait = (ms) => new Promise((done) => setTimeout(done, ms));
  const picture = () => canvas.toDataURL();
  const changes = async (from) => { for (let k = 0; k < 100; k++) { await wait(50); if (picture() !== from) return true; } return false; };
  const empty = () => { const c = document.createElement("canvas"); [c.width, c.height] = [canvas.width, canvas.height]; return c.toDataURL(); };
  await wait(500);
  const first = picture();
  told.draws = first.length > 2 * empty().length;
  told.parts = document.querySelectorAll(".sheet g.part").length;
  if (told.parts) {
    // The middle of a fin that is not hidden, clicked as a mouse would: whole pixels, so its neighbours must be of the same part.
    const middles = fw.corners.map((c) => c.map(fw.project)).map((c) => [(c[0][0] + c[3][0]) / 2, (c[0][1] + c[3][1]) / 2]);
    const alone = ([x, y]) => fw.pick(x, y) >= 0 && [[1, 1], [1, -1], [-1, 1], [-1, -1]].every(([a, b]) => fw.pick(x + a, y + b) === fw.pick(x, y));
    const hit = middles.find(alone), wanted = fw.pick(...hit);
    canvas.scrollIntoView();
    const box = canvas.getBoundingClientRect();
    canvas.setPointerCapture = () => {};
    const mouse = (type) => canvas.dispatchEvent(new PointerEvent(type, {clientX: box.x + hit[0], clientY: box.y + hit[1], pointerId: 1, bubbles: true}));
    mouse("pointerdown"); mouse("pointerup");
    told.recoloured = await changes(first);
    const parts = document.querySelectorAll(".sheet g.part");
    const chosen = [...document.querySelectorAll(".sheet g.chosen")].map((g) => g.dataset.part);
    told.chosen = chosen;
    told.about = document.getElementById("about").textContent;
    told.linked = chosen.length >= 1 && fw.state.part === wanted && told.about.includes(chosen[0]) && !document.getElementById("place").hidden;
    const other = [...parts].find((g) => !g.classList.contains("chosen"));
    other.dispatchEvent(new MouseEvent("click", {bubbles: true}));
    told.back = fw.state.part !== wanted && other.classList.contains("chosen");
  }
  const turn = fw.state.turn;
  canvas.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowLeft", bubbles: true}));
  told.keys = fw.state.turn !== turn;
  told.colours = [];
  for (const kind of ["planarity", "bend", "discrepancy", "part"]) { fw.colour(kind); await wait(100); told.colours.push(picture()); }
  told.colours = new Set(told.colours).size;
  const motion = document.getElementById("motion"), still = picture();
  motion.click(); told.moves = motion.disabled ? null : await changes(still); motion.click();
  if (told.parts) {
    const slider = document.getElementById("step"), whole = picture();
    slider.value = 1; slider.dispatchEvent(new Event("input"));
    told.steps = await changes(whole);
  }
  return told;
})()"""

FLAGS = ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=1300,1700", "--hide-scrollbars"]


class Browser:
    """Chromium with one page."""

    def __init__(self, scratch: str) -> None:
        names = ("chromium", "chromium-browser", "google-chrome")
        program = next(filter(None, map(shutil.which, names)), None)
        if program is None:
            raise SystemExit("there is no Chromium on the path")
        theirs_in, self.ours_out = os.pipe()
        self.ours_in, theirs_out = os.pipe()
        # The pipe is descriptors 3 and 4 on the other side.
        command = f'exec "{program}" {" ".join(FLAGS)} --user-data-dir="{scratch}" --remote-debugging-pipe 3<&{theirs_in} 4>&{theirs_out}'
        self.process = subprocess.Popen(["bash", "-c", command], pass_fds=(theirs_in, theirs_out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(theirs_in)
        os.close(theirs_out)
        self.rest, self.count, self.session, self.errors = b"", 0, None, []
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for method in ("Page.enable", "Runtime.enable", "Log.enable", "Network.enable"):
            self.ask(method)
        self.ask("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)

    def ask(self, method: str, **params: object) -> dict:
        self.count += 1
        message = {"id": self.count, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.ours_out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.hear()
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def hear(self) -> dict:
        while b"\0" not in self.rest:
            more = os.read(self.ours_in, 1 << 16)
            if not more:
                raise SystemExit("Chromium went away")
            self.rest += more
        text, _, self.rest = self.rest.partition(b"\0")
        heard = json.loads(text)
        method, params = heard.get("method"), heard.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.errors.append(params["exceptionDetails"]["text"])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning"):
            self.errors.append(str(params["args"]))
        elif method == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"]["text"])
        return heard

    def open(self, page: Path) -> float:
        """Seconds until the page was loaded and its script had run."""
        began = time.monotonic()
        self.ask("Page.navigate", url=page.as_uri())
        while self.hear().get("method") != "Page.loadEventFired":
            pass
        self.ask("Runtime.evaluate", expression="new Promise((done) => requestAnimationFrame(done))", awaitPromise=True)
        return time.monotonic() - began

    def run(self, script: str) -> dict:
        done = self.ask("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in done:
            self.errors.append(json.dumps(done["exceptionDetails"])[:600])
            return {}
        return done["result"].get("value", {})

    def shot(self, path: Path) -> None:
        path.write_bytes(base64.b64decode(self.ask("Page.captureScreenshot", format="png")["data"]))

    def close(self) -> None:
        self.process.terminate()
        self.process.wait()


def use(report: Path, shots: Path | None) -> dict:
    """What the page did when it was used."""
    text = report.read_text("utf-8")
    loads = re.findall(r'(?:\ssrc|\shref)="(?!#)[^"]*"|url\((?!#)|@import', text)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as scratch:
        browser = Browser(scratch)
        try:
            # The best of three: the first time Chromium starts its drawing too, and machines are shared.
            seconds = min(browser.open(report) for _ in range(3))
            if shots:
                shots.mkdir(parents=True, exist_ok=True)
                browser.shot(shots / "loaded.png")
            told = browser.run(USE)
            if shots:
                browser.shot(shots / "used.png")
        finally:
            browser.close()
    return {**told, "errors": browser.errors, "loads": loads, "seconds": round(seconds, 2), "bytes": len(text.encode("utf-8"))}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("report", type=Path)
    parser.add_argument("--shots", type=Path)
    options = parser.parse_args()
    told = use(options.report.resolve(), options.shots)
    print(json.dumps(told))
    claims = {
        "no console error": told["errors"] == [],
        "nothing is loaded": told["loads"] == [],
        "the view draws": told.get("draws") is True,
        "keys turn it": told.get("keys") is True,
        "colours differ": told.get("colours", 0) >= 2,
        "the motion plays": told.get("moves") in (True, None) and "moves" in told,
        "under 8 MB": told["bytes"] < 8_000_000,
        "loaded in 3 s": told["seconds"] < 3,
    }
    # A refused job may have no parts to click.
    if told.get("parts") != 0:
        claims |= {
            "a click in space marks that part on its sheet": told.get("linked") is True,
            "and in space": told.get("recoloured") is True,
            "a click on the sheet chooses in space": told.get("back") is True,
            "steps take parts away": told.get("steps") is True,
        }
    for claim, holds in claims.items():
        print("PASS" if holds else "MISS", claim)
    return 0 if all(claims.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
