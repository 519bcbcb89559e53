#!/usr/bin/env python3
"""Check the live figures of the book in a browser, against what the programs draw.

    python3 tests/live/check.py [--screenshots FOLDER] [--page NAME]

The book must have been built with its module (`docs/live/build`, then `.ci/docs`). For every live figure: it starts when
it is scrolled near, and its first picture is the still picture, pixel by pixel. Then every knob is turned as a reader
would (sliders, lists, boxes, dragged points), and the picture must be the one that the figure's own command line draws
natively. Histories, keys, views, motion, a page without scripts, requests, complaints. It needs Python 3.10, and Chromium
or Chrome (the environment variable CHROMIUM names it if it is not in the PATH).
"""

import argparse
import base64
import functools
import http.server
import shlex
import subprocess
import sys
import threading
import time
from pathlib import Path

# The checkout stays as it is.
sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/review"))
import chromium  # noqa: E402

BOOK = ROOT / "docs/book"
# Words that the page's expressions share.
FIGURES = "[...document.querySelectorAll('figure.live')]"
HELPERS = """
window.figureAt = (index) => %s[index];
window.pixelsOf = (source, width, height) => {
    const canvas = Object.assign(document.createElement('canvas'), { width, height });
    const context = canvas.getContext('2d');
    context.drawImage(source, 0, 0);
    return context.getImageData(0, 0, width, height).data;
};
window.differences = (canvas, image) => {
    const [width, height] = [image.naturalWidth, image.naturalHeight];
    if (canvas.width !== width || canvas.height !== height)
        return `${canvas.width}x${canvas.height}, not ${width}x${height}`;
    const [a, b] = [pixelsOf(canvas, width, height), pixelsOf(image, width, height)];
    let count = 0;
    for (let at = 0; at < a.length; at += 4)
        if (a[at] !== b[at] || a[at + 1] !== b[at + 1] || a[at + 2] !== b[at + 2]) count += 1;
    return count ? `${count} pixels` : '';
};
window.loaded = (data) => new Promise((done) => {
    const image = new Image();
    image.onload = () => done(image);
    image.src = 'data:image/png;base64,' + data;
});
window.settled = () => new Promise((done) => setTimeout(() => requestAnimationFrame(() => setTimeout(done)), 200));
""" % FIGURES


def check(condition, what):
    if not condition:
        raise AssertionError(what)


class Server(http.server.ThreadingHTTPServer):
    """The book on a port of this machine."""

    def __init__(self):
        handler = functools.partial(Quiet, directory=str(BOOK))
        super().__init__(("127.0.0.1", 0), handler)
        threading.Thread(target=self.serve_forever, daemon=True).start()
        self.address = f"http://127.0.0.1:{self.server_port}"


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


# ---------------------------------------------------------------- the programs

@functools.cache
def program(name):
    path = ROOT / "target/debug" / name
    check(path.is_file(), f"no {path}: cargo build --bins")
    return path


def native(command, *more):
    """What the program that a figure's command line names gives on its standard output."""
    words = shlex.split(command)
    check(words[:3] == ["cargo", "run", "--bin"] and words[4] == "--", f"no command line: {command}")
    result = subprocess.run([program(words[3]), *words[5:], *more], stdin=subprocess.DEVNULL, capture_output=True)
    check(result.returncode == 0, f"{command}: {result.stderr.decode()}")
    return result.stdout


# ---------------------------------------------------------------- a figure

class Figure:
    """One live figure of the page that is open."""

    def __init__(self, page, index):
        self.page, self.index = page, index
        self.root = f"figureAt({index})"
        data = page.evaluate(f"({{...{self.root}.dataset}})")
        self.name = f"{data['chapter']} {data['variant']}"

    def evaluate(self, expression):
        return self.page.evaluate(expression.replace("ROOT", self.root))

    def start(self):
        self.evaluate("ROOT.scrollIntoView({ block: 'center' })")
        self.page.wait(f"{self.root}.classList.contains('runs')", 60)

    def command(self):
        return self.evaluate("ROOT.querySelector('.command code').textContent")

    def settle(self):
        self.evaluate("settled()")

    def is_still(self):
        found = self.evaluate("differences(ROOT.querySelector('canvas'), ROOT.querySelector('img'))")
        check(not found, f"{self.name}: the first picture differs from the still one: {found}")

    def is_native(self, what):
        """The canvas shows what the figure's command line draws."""
        self.settle()
        command = self.command()
        png = base64.b64encode(native(command, "--out", "-")).decode()
        found = self.evaluate(f"loaded('{png}').then((it) => differences(ROOT.querySelector('canvas'), it))")
        check(not found, f"{self.name}: {what}: differs from `{command}`: {found}")

    def center(self, selector):
        return self.evaluate(
            f"(({{ left, top, width, height }}) => [left + width / 2, top + height / 2])"
            f"(ROOT.querySelector('{selector}').getBoundingClientRect())")

    def drag(self, start, way):
        """Presses the button at a place of the window, goes a way, lets go."""
        (x, y), (right, down) = start, way
        self.page.mouse("mouseMoved", x, y)
        self.page.mouse("mousePressed", x, y, True)
        for step in (1, 2, 3):
            self.page.mouse("mouseMoved", x + right * step / 3, y + down * step / 3, True)
        self.page.mouse("mouseReleased", x + right, y + down)


SLIDE = """((input) => {
    input.value = Number(input.min) + 0.7 * (input.max - input.min);
    input.dispatchEvent(new Event('input'));
    input.dispatchEvent(new Event('change'));
})(%s)"""
OTHER = """((input) => {
    if (input.type === 'checkbox') input.checked = !input.checked;
    else if (input.type === 'color') input.value = '#3c78b4';
    else input.selectedIndex = input.options.length - 1;
    input.dispatchEvent(new Event('input'));
    input.dispatchEvent(new Event('change'));
})(%s)"""


def turn_all(figure):
    """Every knob, one after the other; then the picture is compared. Gives how many there are."""
    count = figure.evaluate("ROOT.querySelectorAll('.knob').length")
    for knob in range(count):
        input = f"ROOT.querySelectorAll('.knob')[{knob}].querySelector('input, select')"
        if figure.evaluate(f"{input} !== null"):
            is_slider = figure.evaluate(f"{input}.type === 'range'")
            figure.evaluate((SLIDE if is_slider else OTHER) % input)
    points = figure.evaluate("ROOT.querySelectorAll('.point').length")
    if points:
        figure.evaluate("ROOT.querySelector('.stage').scrollIntoView({ block: 'center' })")
        before = figure.command()
        figure.drag(figure.center(".point"), (30, -20))
        check(figure.command() != before, f"{figure.name}: the point was dragged, and nothing came of it")
    if count:
        figure.is_native("knobs")
    return count


def look_at_views(figure):
    """The remedy and the difference; the difference of a mistake is not empty."""
    buttons = figure.evaluate("[...ROOT.querySelectorAll('.views button')].map((it) => it.textContent)")
    if not buttons:
        return
    check(len(buttons) == 3, f"{figure.name}: {buttons}")
    press = "ROOT.querySelectorAll('.views button')[%d].click()"
    figure.evaluate(press % 1)
    figure.is_native("remedy")
    # As the knobs stand now, nothing may be wrong; at their defaults something is.
    reset(figure)
    figure.evaluate(press % 2)
    figure.settle()
    magenta = figure.evaluate("""((canvas) => {
        const data = pixelsOf(canvas, canvas.width, canvas.height);
        let count = 0;
        for (let at = 0; at < data.length; at += 4)
            if (data[at] === 255 && data[at + 1] === 0 && data[at + 2] === 255) count += 1;
        return count;
    })(ROOT.querySelector('canvas'))""")
    check(magenta > 0, f"{figure.name}: nothing differs from the remedy")
    figure.evaluate(press % 0)


def ask_a_pixel(figure):
    """A click tells the history that the program tells."""
    figure.evaluate("ROOT.querySelector('.stage').scrollIntoView({ block: 'center' })")
    x, y = figure.center("canvas")
    figure.drag((x, y), (0, 0))
    title = figure.evaluate("ROOT.querySelector('.history summary').textContent")
    pixel = title[title.index("(") + 1:title.index(")")].replace(" ", "")
    found = figure.evaluate("ROOT.querySelector('.history pre').textContent")
    expected = native(figure.command(), "--inspect", pixel).decode().rstrip()
    check(found == expected, f"{figure.name}: the history of {pixel} differs:\n{found}\n---\n{expected}")


def use_keys(figure):
    """The keyboard alone: a pixel is chosen and told, a point moved, a slider turned."""
    figure.evaluate("ROOT.querySelector('canvas').focus()")
    figure.page.press("ArrowRight")
    check(figure.evaluate("!ROOT.querySelector('.loupe').hidden"), f"{figure.name}: no loupe at an arrow key")
    told = figure.evaluate("ROOT.querySelector('.told').textContent")
    figure.page.press("ArrowUp")
    check(figure.evaluate("ROOT.querySelector('.told').textContent") != told, f"{figure.name}: the loupe stays")
    figure.page.press("Enter")
    check(figure.evaluate("ROOT.querySelector('.history').open"), f"{figure.name}: Enter tells no history")
    for selector in [".point", ".knob input[type=range]"]:
        if figure.evaluate(f"ROOT.querySelector('{selector}') !== null"):
            before, after = figure.command(), None
            figure.evaluate(f"ROOT.querySelector('{selector}').focus()")
            # It may stand at one end of its range.
            for key in ("ArrowLeft", "ArrowRight"):
                figure.page.press(key)
                figure.settle()
                after = after if after not in (None, before) else figure.command()
            check(after != before, f"{figure.name}: an arrow key does nothing to {selector}: {after}")
    unnamed = figure.evaluate("""[...ROOT.querySelectorAll('button, input, select, canvas')].filter((it) =>
        !(it.ariaLabel || it.labels?.length || it.textContent.trim()) || it.tabIndex < 0).length""")
    check(unnamed in (0, 1), f"{figure.name}: {unnamed} controls have no name or no place in the order")


def reset(figure):
    figure.evaluate("[...ROOT.querySelectorAll('.bar button')].at(-1).click()")
    figure.settle()


def measure(figure):
    """How long a turn of the first slider takes to be seen, in milliseconds: the median of 20."""
    times = figure.evaluate("""(async () => {
        const slider = ROOT.querySelector('.knob input[type=range]');
        if (!slider) return [];
        const canvas = ROOT.querySelector('canvas');
        const times = [];
        for (let step = 1; step <= 20; step += 1) {
            slider.value = Number(slider.min) + (slider.max - slider.min) * step / 20;
            await new Promise(requestAnimationFrame);
            slider.dispatchEvent(new Event('input'));
            const begin = performance.now();
            await new Promise(requestAnimationFrame);
            times.push(performance.now() - begin);
        }
        return times;
    })()""")
    return sorted(times)[len(times) // 2] if times else None


def page_is_right(page, address, name, screenshots):
    """Opens a page and checks all its live figures. Gives how many there are, how many knobs, and the times."""
    page.call("Page.navigate", url=f"{address}/{name}")
    page.wait("document.readyState === 'complete'")
    page.evaluate(HELPERS)
    count = page.evaluate(f"{FIGURES}.length")
    started = page.evaluate(f"{FIGURES}.filter((it) => it.classList.contains('runs')).length")
    check(count < 4 or started < count, f"{name}: all figures started before they were near")
    knobs, times = 0, {}
    for index in range(count):
        figure = Figure(page, index)
        figure.start()
        figure.is_still()
        knobs += turn_all(figure)
        look_at_views(figure)
        ask_a_pixel(figure)
        use_keys(figure)
        reset(figure)
        if "@" not in page.evaluate(f"{figure.root}.querySelector('img').src"):
            figure.is_still()
        times[figure.name] = measure(figure)
        reset(figure)
    if screenshots:
        take_screenshots(page, name, screenshots)
    return count, knobs, times


def take_screenshots(page, name, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for width in (1200, 390):
        for scheme in ("light", "dark"):
            page.prefer(prefers_color_scheme=scheme)
            theme = {"light": "light", "dark": "coal"}[scheme]
            page.resize(width, 1000)
            page.call("Page.reload")
            page.wait("document.readyState === 'complete'")
            page.evaluate(f"document.documentElement.className = '{theme} js'")
            for index in range(page.evaluate(f"{FIGURES}.length")):
                page.evaluate(f"{FIGURES}[{index}].scrollIntoView()")
                page.wait(f"{FIGURES}[{index}].classList.contains('runs')", 60)
            height = page.evaluate("document.documentElement.scrollHeight")
            page.resize(width, min(16000, height))
            time.sleep(0.3)
            page.screenshot(folder / f"{Path(name).stem}-{width}-{scheme}.png")
    page.resize(1200, 1000)


def still_without_scripts(page, address, name):
    page.call("Emulation.setScriptExecutionDisabled", value=True)
    page.call("Page.navigate", url=f"{address}/{name}")
    time.sleep(1)
    page.call("Emulation.setScriptExecutionDisabled", value=False)
    shown = page.evaluate("""[...document.querySelectorAll('figure.live')].every((it) =>
        it.querySelector('img').getBoundingClientRect().width > 50 && !it.querySelector('canvas'))""")
    check(shown, f"{name}: without scripts the still pictures do not stand")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--screenshots", type=Path, help="a folder for pictures of every page, two widths, light and dark")
    parser.add_argument("--page", help="only this page, such as ch05_perspective_correct.html")
    options = parser.parse_args()
    program_of_browser = chromium.find()
    check(program_of_browser, "no Chromium or Chrome")
    pages = sorted(it.name for it in BOOK.glob("*.html") if 'class="live"' in it.read_text() and it.name != "print.html")
    pages = [name for name in pages if options.page in (None, name)]
    check(options.page or len(pages) >= 11, f"live figures on {pages} only: docs/live/build, then .ci/docs")
    server = Server()
    page = chromium.Page(program_of_browser, 1200, 1000)
    try:
        for name in pages:
            begin = time.monotonic()
            count, knobs, times = page_is_right(page, server.address, name, options.screenshots)
            slowest = max(((took, which) for which, took in times.items() if took), default=(0, "-"))
            print(f"{name}: {count} live figures, {knobs} knobs; the slowest follows in {slowest[0]:.1f} ms"
                  f" ({slowest[1]}); checked in {time.monotonic() - begin:.0f} s", flush=True)
        still_without_scripts(page, server.address, pages[0])
        outside = [it for it in page.requests if not it.startswith((server.address, "data:", "about:"))]
        check(not outside, f"requests leave the site: {outside}")
        check(not page.complaints, f"complaints: {page.complaints}")
    finally:
        page.close()
        server.shutdown()
    print("the live figures draw what the programs draw")


if __name__ == "__main__":
    main()
