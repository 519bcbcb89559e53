#!/usr/bin/env python3
"""Check how pictures are reviewed: what the snapshot test reports, and what review.html shows in a browser.

    python3 tests/review/check.py [--screenshots FOLDER]

It makes accepted pictures of its own, in cargo's target folder, so that the test finds each kind of failure there is:
pictures that changed, one of another size, new ones and missing ones. No file of the checkout is touched. It needs
Python 3.10, and Chromium or Chrome (the environment variable CHROMIUM names it if it is not in the PATH).
"""

import argparse
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import time
import zlib
from pathlib import Path

# The checkout stays as it is.
sys.dont_write_bytecode = True
import chromium  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
SNAPSHOTS = ROOT / "tests/snapshots"
# A few pictures of two chapters are enough: these are skipped.
SKIPPED = ["ch02_triangles", *(f"ch{number:02}" for number in range(3, 11))]

PIXEL, DIGIT, SUBPIXELS, GONE = (f"ch01_pixels__{name}" for name in ["pixel", "digit", "subpixels", "gone"])
LINE, STAR, WIREFRAME, WIDE = (
    f"ch02_dda_lines__{name}" for name in ["line", "star", "wireframe", "broken--star"])
KINDS = {
    PIXEL: "changed", DIGIT: "resized", SUBPIXELS: "new", GONE: "missing",
    WIREFRAME: "new", STAR: "new", LINE: "missing", WIDE: "changed",
}


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def equal(found, wanted):
    check(found == wanted, f"found {found!r}, wanted {wanted!r}")


# ---------------------------------------------------------------- accepted pictures of our own

def png(width, height, color, others=()):
    """A picture of one color but for others, {(x, y): color}, y up from the bottom."""
    rows = [bytearray(b"\0" + bytes(color) * width) for _ in range(height)]
    for (x, y), other in dict(others).items():
        rows[height - 1 - y][1 + 3 * x:4 + 3 * x] = bytes(other)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = zlib.compress(b"".join(rows))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def prepare(folder):
    """Makes a folder that takes the place of tests/snapshots and of the folder of failures."""
    shutil.rmtree(folder, ignore_errors=True)
    accepted = folder / "accepted"
    accepted.mkdir(parents=True)
    for file in SNAPSHOTS.iterdir():
        # Of the pictures that are drawn, one has never been accepted.
        if not file.name.startswith((*SKIPPED, SUBPIXELS)):
            shutil.copy(file, accepted)
    spoil(accepted)
    (accepted / f"{DIGIT}.snap.png").write_bytes(png(200, 100, (100, 100, 100)))
    (accepted / f"{WIDE}.snap.png").write_bytes(png(1448, 480, (0, 0, 0)))
    # New: nothing was accepted; the file is lost; it is not the picture.
    (accepted / f"{STAR}.snap.png").unlink()
    (accepted / f"{WIREFRAME}.snap.png").write_text("version https://git-lfs.github.com/spec/v1\n")
    # Missing: no variant draws it; the program cannot write it, as there are folders in its place and in that folder.
    for end in [".snap", ".snap.png"]:
        shutil.copy(SNAPSHOTS / f"{PIXEL}{end}", accepted / f"{GONE}{end}")
    (folder / "drawn" / f"{LINE}.png" / "line.png").mkdir(parents=True)


def spoil(accepted):
    """Changes two pixels of the picture that has one red pixel at (200, 200)."""
    others = {(200, 200): (255, 128, 0), (639, 479): (0, 0, 7)}
    (accepted / f"{PIXEL}.snap.png").write_bytes(png(640, 480, (0, 0, 0), others))


# ---------------------------------------------------------------- the test

def target_folder():
    command = ["cargo", "metadata", "--format-version=1", "--no-deps"]
    return Path(json.loads(subprocess.check_output(command, cwd=ROOT))["target_directory"])


def run(folder, command=None, **variables):
    """Runs the test, or another command, on our own pictures: (exit code, what it says)."""
    command = command or "cargo test --quiet --test snapshots -- " + " ".join(f"--skip {name}" for name in SKIPPED)
    # How this script was started is not to change what the test does.
    inherited = {name: value for name, value in os.environ.items() if not name.startswith("INSTA_") and name != "CI"}
    environment = {**inherited, "RASTERBOOK_SNAPSHOTS": str(folder), **variables}
    done = subprocess.run(["bash", "-c", command], cwd=ROOT, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout


def check_log(folder):
    """A failure says what is general once, and names files that are there. Returns the page and the log."""
    code, log = run(folder)
    check(code == 101, f"exit code {code}:\n{log}")
    check(f"{PIXEL}: 2 of 307200 pixels differ" in log, log)
    check("(200, 200) was [255, 128, 0], is [255, 0, 0]" in log, log)
    check("the size was (200, 100) and is" in log, log)
    for general in ["INSTA_UPDATE=always", "review.html", "report.png", "git status"]:
        equal((general, log.count(general)), (general, 1))
    found = re.search(r"^(\d+) pictures to review: (.+)$", log, re.MULTILINE)
    check(found and int(found[1]) == len(KINDS), log)
    page = Path(found[2])
    check(page.is_file(), f"{page} is not there")
    check((page.parent / f"{PIXEL}.report.png").is_file(), "no report")
    return page, log


def check_accepting(folder, command):
    """The command that the page gives accepts its picture alone; accepting all says how many were replaced."""
    _, log = run(folder, command)
    check(f"Accepted: 1 picture replaced, 0 added, in {folder / 'accepted'}" in log, log)
    check(f"{len(KINDS) - 1} pictures to review" in log, log)

    for end in [".snap", ".snap.png"]:
        (folder / "accepted" / f"{GONE}{end}").unlink()
    shutil.rmtree(folder / "drawn" / f"{LINE}.png")
    code, log = run(folder, INSTA_UPDATE="always")
    equal(code, 0)
    check("Accepted: 3 pictures replaced, 2 added" in log, log)
    check("to review" not in log, log)
    left = {path.name for path in (folder / "failures").iterdir()}
    equal(left, set())
    for name in [PIXEL, DIGIT, SUBPIXELS, STAR, WIREFRAME, WIDE]:
        for end in [".snap", ".snap.png"]:
            check((folder / "accepted" / f"{name}{end}").is_file(), f"{name}{end} was not accepted")

    # A run that is told to pass, as cargo-insta does, still leaves the picture for a review.
    spoil(folder / "accepted")
    code, log = run(folder, INSTA_FORCE_PASS="1")
    equal(code, 0)
    check("1 picture to review" in log and "Accepted" not in log, log)


# ---------------------------------------------------------------- the page

class Review:
    """The page in a browser."""

    def __init__(self, page):
        self.page = page

    def text(self, what):
        return self.page.evaluate(f"document.querySelector({json.dumps(what)}).innerText").replace("\xa0", " ")

    def value(self, expression):
        return self.page.evaluate(expression)

    def wait_for(self, name):
        self.page.wait(f"document.getElementById('name').textContent === {json.dumps(name)} && state.pixels !== null")

    def go(self, name):
        self.page.evaluate(f"location.hash = {json.dumps('#' + name)}")
        self.wait_for(name)

    def mode(self):
        return self.value("document.querySelector('[data-mode][aria-pressed=true]').dataset.mode")

    def canvases(self):
        """Of each picture on the stage its kind, its size, and whether it is seen."""
        return self.value("""[...document.querySelectorAll('#stage canvas')].map(canvas =>
            [canvas.className, canvas.width, canvas.height, getComputedStyle(canvas).visibility === 'visible'])""")

    def color(self, kind, x, y):
        """The color that a picture on the stage has at (x, y), y up."""
        return self.value(f"""(() => {{
            const canvas = document.querySelector('#stage canvas.{kind}');
            const data = canvas.getContext('2d').getImageData({x}, canvas.height - 1 - {y}, 1, 1).data;
            return [...data.slice(0, 3)]; }})()""")

    def place(self, x, y, frame=0):
        """Where the middle of a pixel is on the screen."""
        return self.value(f"""(() => {{
            const frame = document.querySelectorAll('.frame')[{frame}], bounds = frame.getBoundingClientRect();
            const scale = bounds.width / frame.dataset.width;
            return [bounds.left + ({x} + .5) * scale, bounds.bottom - ({y} + .5) * scale]; }})()""")

    def point(self, x, y, frame=0):
        self.page.mouse("mouseMoved", *self.place(x, y, frame))

    def press(self, *keys):
        for key in keys:
            self.page.press(key)

    def fits(self):
        return self.value("""[...document.querySelectorAll('.scroll')].every(scroll =>
            scroll.scrollWidth <= scroll.clientWidth && scroll.scrollHeight <= scroll.clientHeight)
            && document.documentElement.scrollWidth <= innerWidth""")


def check_contents(review, log):
    review.page.wait("document.getElementById('total').textContent !== ''")
    equal(review.text("#total"), "2 changed, 1 resized, 3 new, 2 missing")
    equal(review.value("[...document.querySelectorAll('#list h2')].map(it => it.textContent)"),
          ["ch01_pixels", "ch02_dda_lines"])
    links = review.value("[...document.querySelectorAll('#list a')].map(it => [it.hash.slice(1), it.lastChild.textContent])")
    # In the order of the chapters' tables; what no variant draws comes last.
    equal([name for name, _ in links][:4], [PIXEL, DIGIT, SUBPIXELS, GONE])
    differ = re.search(rf"{WIDE}: (\d+) of", log)[1]
    briefs = {**{name: kind for name, kind in KINDS.items()}, PIXEL: "2", WIDE: f"{int(differ):,}"}
    equal(dict(links), briefs)
    for name, kind in KINDS.items():
        review.go(name)
        equal((name, review.text("#kind")), (name, kind))
        equal(review.value("document.querySelector('#list a[aria-current]').hash"), f"#{name}")
    check(review.text("#numbers").startswith(f"{int(differ):,} of 695,040 pixels differ"), review.text("#numbers"))


def check_changed(review):
    review.go(PIXEL)
    equal(review.text("#numbers"), "2 of 307,200 pixels differ (less than 0.01 %), "
          "between (200, 200) and (639, 479) · largest channel difference 128")
    check(review.text("#look").startswith("What to look for: one red pixel"), review.text("#look"))
    check("(200, 200) was [255, 128, 0], is [255, 0, 0]" in review.value("document.getElementById('reason').textContent"),
          "no report")

    review.press("1")
    equal(review.mode(), "side")
    equal(review.canvases(), [["expected", 640, 480, True], ["actual", 640, 480, True]])
    equal([review.color("expected", 200, 200), review.color("actual", 200, 200)], [[255, 128, 0], [255, 0, 0]])
    check_pixel(review)

    review.press("2")
    equal(review.mode(), "blink")
    seen = lambda: [kind for kind, _, _, is_seen in review.canvases() if is_seen]
    first = seen()
    review.page.wait(f"document.querySelector('#stage canvas.{first[0]}').style.visibility === 'hidden'", 5)
    equal(len(seen()), 1)
    review.press(" ")
    still = seen()
    equal([review.text("#stage figcaption")], [{"expected": "accepted", "actual": "new"}[still[0]]])
    time.sleep(1)
    equal(seen(), still)
    review.press(" ")
    check(len(seen()) == 1 and seen() != still, "space does not flip")

    review.press("3")
    equal(review.mode(), "slider")
    clip = lambda kind: review.value(f"document.querySelector('canvas.{kind}').style.clipPath")
    equal([clip("expected"), clip("actual")], ["inset(0px 50% 0px 0px)", "inset(0px 0px 0px 50%)"])
    review.page.mouse("mousePressed", *review.place(320, 200))
    review.page.mouse("mouseMoved", *review.place(159, 200), is_down=True)
    review.page.mouse("mouseReleased", *review.place(159, 200))
    share = float(re.fullmatch(r"inset\(0px 0px 0px (.+)%\)", clip("actual"))[1])
    check(abs(share - 25) < 0.5, f"the slider is at {share} %")
    review.value("document.getElementById('split').focus()")
    review.press("ArrowRight")
    check("the slider has the arrows while it has the focus", review.text("#name") == PIXEL)
    equal(float(re.fullmatch(r"inset\(0px 0px 0px (.+)%\)", clip("actual"))[1]), round(share) + 1)
    review.value("document.activeElement.blur()")

    review.press("4")
    equal(review.mode(), "difference")
    equal(review.canvases(), [["difference", 640, 480, True]])
    equal([review.color("difference", x, y) for x, y in [(200, 200), (639, 479), (0, 0)]],
          [[255, 0, 255], [255, 0, 255], [0, 0, 0]])
    check("differs" in review.text("#stage figcaption"), "no legend")
    equal(review.value("document.querySelectorAll('.box').length"), 2)

    # The mode stays when another picture is shown, and space goes to blinking from any.
    review.press(" ")
    equal(review.mode(), "blink")
    review.press("1")


def check_pixel(review):
    """The pixel under the pointer, in both pictures and from either."""
    for frame in [0, 1]:
        review.point(200, 200, frame)
        equal([review.text(what) for what in ["#place-of", "#was", "#is", "#change"]],
              ["(200, 200)", "255, 128, 0", "255, 0, 0", "0, −128, 0"])
    review.point(0, 0)
    equal([review.text(what) for what in ["#place-of", "#was", "#is"]], ["(0, 0)", "0, 0, 0", "0, 0, 0"])
    review.point(639, 479)
    equal([review.text(what) for what in ["#place-of", "#was", "#change"]], ["(639, 479)", "0, 0, 7", "0, 0, −7"])
    review.press("i")
    check_copied(review, "cargo run --bin ch01_pixels -- pixel --inspect 639,479")
    for place, (x, y) in enumerate([(200, 200), (639, 479), (200, 200)]):
        review.press("d")
        equal(review.text("#to-difference"), f"Next difference ({place % 2 + 1} of 2)")
        equal(review.value("scaleNow()"), 16)
        for frame in [0, 1]:
            check(review.value(f"""(() => {{ const [x, y] = {json.dumps(review.place(x, y, frame))};
                return document.elementFromPoint(x, y)?.closest('.frame') === document.querySelectorAll('.frame')[{frame}]
            }})()"""), f"({x}, {y}) is not seen")
    review.press("-")
    equal(review.text("#scale"), "800 %")
    review.press("0")
    check(review.fits(), "0 does not fit the picture")


def check_copied(review, command):
    review.page.wait("document.getElementById('said').textContent !== ''")
    equal(review.value("navigator.clipboard.readText()"), command)
    equal(review.text("#said"), f"Copied: {command}")
    review.value("document.getElementById('said').textContent = ''")


def check_resized(review):
    review.go(DIGIT)
    check(review.text("#numbers").startswith("The size was 200 × 100 and is "), review.text("#numbers"))
    _, width, height, _ = review.canvases()[1]
    review.press("1")
    equal(review.canvases()[0][:3], ["expected", 200, 100])
    review.point(199, 99)
    equal([review.text("#place-of"), review.text("#was")], ["(199, 99)", "100, 100, 100"])
    review.point(width - 1, height - 1, 1)
    equal([review.text("#place-of"), review.text("#was"), review.text("#change")],
          [f"({width - 1}, {height - 1})", "none", ""])
    review.press("2")
    # In the same place means: with the same lower left corner.
    equal(review.value("""new Set([...document.querySelectorAll('#stage canvas')].map(canvas => {
        const bounds = canvas.getBoundingClientRect(); return `${bounds.left} ${bounds.bottom}` })).size"""), 1)
    review.press("3")
    review.press("4")
    equal(review.canvases(), [["difference", width, height, True]])
    equal(review.color("difference", 0, height - 1), [0, 190, 255])
    check("only in the new one" in review.text("#stage figcaption"), "no legend")


def check_new(review):
    review.press("4")
    for name, reason in [(SUBPIXELS, "there is no accepted picture yet"), (STAR, "its .snap.png file is missing"),
                         (WIREFRAME, "it is a pointer of Git LFS")]:
        review.go(name)
        check(reason in review.text("#reason"), review.text("#reason"))
        equal(review.text(".frame.empty"), "no accepted picture")
        equal([kind for kind, *_ in review.canvases()], ["actual"])
        for key in "234 d":
            review.press(key)
            equal(review.mode(), "side")
        equal(review.value("[...document.querySelectorAll('[data-mode]')].map(it => it.disabled)"),
              [False, True, True, True])
        review.point(3, 4, 1)
        equal([review.text("#place-of"), review.text("#was")], ["(3, 4)", "none"])
        review.press("a")
        check_copied(review, f"INSTA_UPDATE=always cargo test --test snapshots -- --exact {name}")


def check_missing(review):
    for name, numbers, reason in [(GONE, "No variant draws this picture any more.", "no variant draws it"),
                                  (LINE, "No new picture was drawn.", "no new picture was drawn: error: ")]:
        review.go(name)
        equal(review.text("#numbers"), numbers)
        check(reason in review.text("#reason"), review.text("#reason"))
        equal(review.text(".frame.empty"), "no new picture")
        equal([kind for kind, *_ in review.canvases()], ["expected"])
        review.point(5, 6)
        equal([review.text("#place-of"), review.text("#is")], ["(5, 6)", "none"])
    equal([review.text("#accept-title"), review.value("document.getElementById('command').textContent")],
          ["There is nothing to accept.", ""])
    review.go(GONE)
    review.press("a")
    check_copied(review, f"git rm tests/snapshots/{GONE}.snap tests/snapshots/{GONE}.snap.png")


def check_keys(review):
    names = review.value("pictures.map(picture => picture.name)")
    review.press("Home")
    review.wait_for(names[0])
    for key, index in [("ArrowRight", 1), ("ArrowDown", 2), ("ArrowLeft", 1), ("ArrowUp", 0), ("ArrowLeft", 0),
                       ("End", len(names) - 1), ("ArrowRight", len(names) - 1)]:
        review.press(key)
        review.wait_for(names[index])
        equal(review.text("#place"), f"{index + 1} of {len(names)}")
    # Also after a button was pressed with the mouse.
    review.go(PIXEL)
    x, y = review.value("""(() => { const b = document.querySelector('[data-mode=difference]').getBoundingClientRect();
        return [b.left + 5, b.top + 5] })()""")
    for kind in ["mousePressed", "mouseReleased"]:
        review.page.mouse(kind, x, y)
    review.page.wait("document.activeElement === document.body")
    equal(review.mode(), "difference")
    review.press(" ")
    equal(review.mode(), "blink")
    review.press("ArrowRight")
    review.wait_for(names[1])
    listed = review.text("footer dl")
    for key in ["←", "→", "Space", "1", "4", "+", "−", "0", "D", "A", "I"]:
        check(key in listed, f"{key} is not in the list of keys")
    review.go(PIXEL)
    review.press("a")
    check_copied(review, f"INSTA_UPDATE=always cargo test --test snapshots -- --exact {PIXEL}")


def check_no_jump(review):
    """Pointing at a pixel does not move what is pointed at."""
    for name in [PIXEL, DIGIT, WIDE, GONE]:
        review.go(name)
        review.press("1")
        before = review.place(0, 0)
        review.point(10, 10)
        equal(review.place(0, 0), before)


def check_fitting(review):
    """Wide pictures fit, in every mode, in wide and narrow windows."""
    for size in [(1600, 1000), (1280, 720), (1000, 900), (420, 800)]:
        review.page.resize(*size)
        for name in [WIDE, PIXEL, DIGIT, SUBPIXELS]:
            review.go(name)
            for key in "1234":
                review.press(key)
                review.page.wait("new Promise(resolve => requestAnimationFrame(() => requestAnimationFrame(() => resolve(true))))")
                check(review.fits(), f"{name} does not fit into {size} in the mode {review.mode()}")
    review.page.resize(1440, 900)


CONTRAST = """(() => {
  const rgba = text => text.match(/[\\d.]+/g).map(Number);
  const light = color => { const [r, g, b] = color.map(c => (c /= 255) <= .04045 ? c / 12.92 : ((c + .055) / 1.055) ** 2.4);
    return .2126 * r + .7152 * g + .0722 * b };
  const faint = [];
  for (const item of document.querySelectorAll('body *')) {
    const hasText = [...item.childNodes].some(node => node.nodeType === 3 && node.data.trim());
    if (!hasText || item.disabled || !item.checkVisibility() || item.closest('main')) continue;
    let behind = item;
    while (behind && (rgba(getComputedStyle(behind).backgroundColor)[3] ?? 1) === 0) behind = behind.parentElement;
    const of = element => light(rgba(element).slice(0, 3));
    const [a, b] = [of(getComputedStyle(item).color), of(getComputedStyle(behind ?? document.body).backgroundColor)];
    const ratio = (Math.max(a, b) + .05) / (Math.min(a, b) + .05);
    if (ratio < 4.5) faint.push(`${item.id || item.className || item.tagName} ${ratio.toFixed(2)}`);
  }
  return faint; })()"""


def check_schemes(review):
    backgrounds = set()
    for scheme in ["light", "dark"]:
        review.page.prefer(prefers_color_scheme=scheme)
        for name in [PIXEL, SUBPIXELS, GONE]:
            review.go(name)
            equal((scheme, name, review.value(CONTRAST)), (scheme, name, []))
        backgrounds.add(review.value("getComputedStyle(document.body).backgroundColor"))
    equal(len(backgrounds), 2)
    review.page.prefer(prefers_reduced_motion="reduce")
    review.go(PIXEL)
    review.press("2")
    equal(review.value("state.isBlinking"), False)
    review.page.prefer()


def check_access(review):
    """Every control has a name, and is reached with the tabulator."""
    review.go(PIXEL)
    review.press("3")
    nodes = review.page.call("Accessibility.getFullAXTree")["nodes"]
    controls = [node for node in nodes if node.get("role", {}).get("value") in ["button", "link", "slider", "image"]]
    check(len(controls) > 20, "too few controls")
    for node in controls:
        check(node.get("name", {}).get("value", "").strip(), f"a control without a name: {node}")
    reached = set()
    for _ in range(60):
        review.press("Tab")
        reached.add(review.value("document.activeElement.id || document.activeElement.dataset.mode || document.activeElement.hash"))
    for control in ["side", "difference", "smaller", "larger", "split", "copy", "next", f"#{WIDE}"]:
        check(control in reached, f"{control} is not reached with the tabulator")
    review.value("document.activeElement.blur()")


def take_screenshots(review, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for scheme in ["light", "dark"]:
        review.page.prefer(prefers_color_scheme=scheme)
        for name in [PIXEL, DIGIT, SUBPIXELS, GONE, WIDE]:
            review.go(name)
            for key, mode in zip("1234", ["side", "blink", "slider", "difference"]):
                review.press(key)
                if review.mode() == mode:
                    review.point(200, 90)
                    review.page.screenshot(folder / f"{name}-{mode}-{scheme}.png")
    review.page.prefer()


def check_page(page_file, log, screenshots):
    """All that the page shows. Returns the command by which it accepts the picture that changed."""
    page = chromium.Page(chromium.find(), 1440, 900)
    try:
        page.call("Browser.grantPermissions", permissions=["clipboardReadWrite", "clipboardSanitizedWrite"])
        page.open(page_file)
        review = Review(page)
        review.wait_for(PIXEL)
        for part in [check_changed, check_resized, check_new, check_missing, check_keys, check_no_jump, check_fitting,
                     check_schemes, check_access]:
            part(review)
            print(f"ok: {part.__name__.removeprefix('check_')}")
        check_contents(review, log)
        print("ok: contents")
        if screenshots:
            take_screenshots(review, screenshots)
        review.go(PIXEL)
        equal(page.complaints, [])
        foreign = [url[:80] for url in page.requests if not url.startswith(("file:", "data:"))]
        equal(foreign, [])
        return review.text("#command")
    finally:
        page.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--screenshots", type=Path, metavar="FOLDER", help="write pictures of the page into a folder")
    options = parser.parse_args()
    if not chromium.find():
        sys.exit("error: neither Chromium nor Chrome is in the PATH; the environment variable CHROMIUM can name it")
    folder = target_folder() / "tmp/review-check"
    prepare(folder)
    page, log = check_log(folder)
    print("ok: the log")
    command = check_page(page, log, options.screenshots)
    check_accepting(folder, command)
    print("ok: accepting")
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
