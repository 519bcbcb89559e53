#!/usr/bin/env python3
"""Check how pictures are shown in a terminal: what tmux has on its screen after --show, against the picture itself.

    python3 tests/terminal/check.py

It draws a few pictures into files, shows the same ones in a tmux of its own, and compares the color of each half of each
cell with the mean of the pixels that it stands for. No file of the checkout is touched. It needs Python 3.10 and tmux.
"""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COLUMNS, ROWS = 100, 40
# Below the picture: what is said of it, and the prompt.
LINES_BELOW = 3
SHADES = " ░▒▓█"


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def equal(found, wanted):
    check(found == wanted, f"found {found!r}, wanted {wanted!r}")


# ---------------------------------------------------------------- the programs, and tmux

def build():
    """Builds the programs: the folder they are in, and one for our files."""
    subprocess.run(["cargo", "build", "--quiet", "--bins"], cwd=ROOT, check=True)
    command = ["cargo", "metadata", "--format-version=1", "--no-deps"]
    target = Path(json.loads(subprocess.check_output(command, cwd=ROOT))["target_directory"])
    return target / "debug", target / "tmp/terminal-check"


class Tmux:
    """A tmux with one window at a time, apart from the user's own: no configuration, a socket of its own."""

    def __init__(self, folder):
        self.socket = f"{folder}/socket"

    def call(self, *arguments):
        done = subprocess.run(["tmux", "-u", "-S", self.socket, "-f", "/dev/null", *arguments], text=True, capture_output=True)
        check(done.returncode == 0, f"tmux {arguments[0]}: {done.stderr}")
        return done.stdout

    def screen(self, command, variables):
        """The rows of cells on the screen after a command has run."""
        # The variables of whoever runs this are not to decide how pictures are shown.
        unset = ["NO_COLOR", "COLORTERM", "TERM_PROGRAM", "LC_TERMINAL", "KITTY_WINDOW_ID", "WT_SESSION", "KONSOLE_VERSION"]
        words = ["env", *(word for name in unset for word in ("-u", name)), *variables, *command]
        script = "\"$@\"; code=$?; printf 'exit %s' $code; exec sleep 600"
        self.call("new-session", "-d", "-x", str(COLUMNS), "-y", str(ROWS), "sh", "-c", script, "sh", *map(str, words))
        try:
            self.wait_for_end()
            return cells(self.call("capture-pane", "-e", "-p"))
        finally:
            self.call("kill-session")

    def wait_for_end(self):
        for _ in range(600):
            found = re.search(r"^exit (\d+)$", self.call("capture-pane", "-p"), re.MULTILINE)
            if found:
                equal(int(found[1]), 0)
                return
            time.sleep(0.1)
        check(False, f"no end:\n{self.call('capture-pane', '-p')}")


def cells(captured):
    """What a screen shows: rows of cells, each with its character, foreground and background. A color is (r, g, b), a number
    of the 256, or None for the terminal's own."""
    rows, colors = [[]], [None, None]
    for sequence, character in re.findall(r"\x1b\[([\d;]*)m|([^\x1b])", captured):
        if character == "\n":
            rows.append([])
            continue
        if character:
            rows[-1].append((character, *colors))
            continue
        codes = [int(code or 0) for code in sequence.split(";")]
        while codes:
            code = codes.pop(0)
            if code in (38, 48):
                count = {2: 3, 5: 1}[codes.pop(0)]
                colors[code == 48] = tuple(codes[:count]) if count == 3 else codes[0]
                codes = codes[count:]
            elif code == 0:
                colors = [None, None]
            elif code in (39, 49):
                colors[code == 49] = None
            else:
                check(False, f"an unexpected code {code} in {sequence!r}")
    return rows


def text_of(row):
    return "".join(character for character, *_ in row).rstrip()


# ---------------------------------------------------------------- the picture

def read_ppm(path):
    """Rows of pixels, the highest first."""
    whole = path.read_bytes()
    head = re.match(rb"P6 (\d+) (\d+) 255\s", whole)
    check(head, "no PPM")
    width, height = int(head[1]), int(head[2])
    data = whole[head.end():]
    equal(len(data), 3 * width * height)
    pixels = [tuple(data[i:i + 3]) for i in range(0, len(data), 3)]
    return [pixels[i:i + width] for i in range(0, len(pixels), width)]


def light(value):
    value /= 255
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def stored(amount):
    return 255 * (12.92 * amount if amount <= 0.0031308 else 1.055 * amount ** (1 / 2.4) - 0.055)


LIGHT = [light(value) for value in range(256)]


def mean(picture, x, y, width, height):
    """The mean light of the pixels that the pixel (x, y), counted from the top, of a smaller picture stands for."""
    def shares(place, old, new):
        start, end = place * old / new, (place + 1) * old / new
        last = min(int(end) + 1, old)
        return [(i, min(end, i + 1) - max(start, i)) for i in range(int(start), last) if min(end, i + 1) > max(start, i)]

    sums, total = [0, 0, 0], 0
    for row, high in shares(y, len(picture), height):
        for column, wide in shares(x, len(picture[0]), width):
            total += high * wide
            for k in range(3):
                sums[k] += LIGHT[picture[row][column][k]] * high * wide
    return tuple(stored(amount / total) for amount in sums)


def color_of_256(number):
    check(16 <= number < 256, f"color {number} is the user's own")
    if number >= 232:
        return (8 + 10 * (number - 232),) * 3
    cube = [0, 95, 135, 175, 215, 255]
    return tuple(cube[(number - 16) // step % 6] for step in (36, 6, 1))


# ---------------------------------------------------------------- checks

def drawn_and_shown(tmux, programs, folder, program, arguments, variables=()):
    """The picture in a file, the rows of the screen that show it, and the texts below."""
    file = folder / "picture.ppm"
    command = [programs / program, *arguments]
    subprocess.run([*command, "--out", file], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    rows = tmux.screen([*command, "--show"], variables)
    below = next(i for i, row in enumerate(rows) if re.match(r"[\w@-]+: \d+×\d+", text_of(row)))
    return read_ppm(file), rows[:below], [text_of(row) for row in rows[below:]]


def check_colors(tmux, programs, folder, program, arguments, width, height):
    """Each half of each cell has the color of its pixels."""
    picture, rows, below = drawn_and_shown(tmux, programs, folder, program, arguments)
    check(re.fullmatch(rf"{arguments[0]}\S*: {len(picture[0])}×{len(picture)}", below[0]), below[0])
    check("exit 0" in below[1:3], f"the cursor is not on a fresh line: {below}")
    equal([len(row) for row in rows], [width] * ((height + 1) // 2))
    check(width <= COLUMNS and len(rows) <= ROWS - LINES_BELOW, "too large")
    for y, row in enumerate(rows):
        for x, (character, *halves) in enumerate(row):
            equal(character, "▀")
            for y_half, found in enumerate(halves, 2 * y):
                if y_half == height:
                    equal(found, None)
                    continue
                wanted = mean(picture, x, y_half, width, height)
                check(isinstance(found, tuple) and max(abs(a - b) for a, b in zip(found, wanted)) <= 1,
                      f"{arguments} at column {x}, row {y_half}: {found} for {wanted}")


def check_few_colors(tmux, programs, folder):
    """The 256 colors, and none."""
    program, arguments = "ch05_perspective_correct", ["affine"]
    # As if it were not tmux.
    variables = ["-u", "TMUX", "TERM=xterm-256color"]
    picture, rows, _ = drawn_and_shown(tmux, programs, folder, program, arguments, variables)
    width, height = len(rows[0]), 2 * len(rows)
    for y, row in enumerate(rows):
        for x, (character, *halves) in enumerate(row):
            equal(character, "▀")
            for y_half, number in enumerate(halves, 2 * y):
                wanted = mean(picture, x, y_half, width, height)
                # The widest gap of a channel is from 0 to 95.
                off = max(abs(a - b) for a, b in zip(color_of_256(number), wanted))
                check(off <= 48, f"column {x}, row {y_half}: {number} for {wanted}")

    _, rows, below = drawn_and_shown(tmux, programs, folder, program, arguments, ["NO_COLOR=1"])
    shown = {character for row in rows for character, *_ in row}
    check(shown <= set(SHADES) and len(shown) > 2, f"not only shades: {shown}")
    check(all(colors == [None, None] for row in rows for _, *colors in row), "colors")
    check("NO_COLOR is set" in "".join(below), below)


def check_all(tmux, programs, folder):
    # 37 rows are 74 pixels high.
    for program, arguments, width, height in [
        ("ch05_perspective_correct", ["affine"], 99, 74),
        ("ch05_perspective_correct", ["affine", "--compare"], 100, 25),
        ("ch05_perspective_correct", ["correct", "--size", "30x17"], 90, 51),
        ("ch10_matrices_lighting", ["lit", "--frame", "40"], 99, 74),
    ]:
        check_colors(tmux, programs, folder, program, arguments, width, height)
        print("ok:", program, *arguments)
    check_few_colors(tmux, programs, folder)
    print("ok: few colors")


def main():
    if not shutil.which("tmux"):
        sys.exit("error: tmux is not in the PATH; it is the terminal of this check")
    programs, folder = build()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    # The path of a socket must be short.
    with tempfile.TemporaryDirectory() as socket_folder:
        check_all(Tmux(socket_folder), programs, folder)
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
