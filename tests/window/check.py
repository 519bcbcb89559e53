#!/usr/bin/env python3
"""Check the live window: what it shows for keys and mouse is what --out writes for the same settings, pixel by pixel.

    python3 tests/window/check.py [--release]

It needs Python 3.10, and Xvfb, openbox, xdotool and xwd (Debian: xvfb openbox xdotool x11-apps). The window opens on a
display of its own; nothing is seen of it.
"""

import argparse
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ["Xvfb", "openbox", "xdotool", "xwd"]
SECONDS = 10


def check(condition, what):
    if not condition:
        raise AssertionError(what)


class Picture:
    """Rows of (red, green, blue), the highest row first."""

    def __init__(self, width, height, rows):
        self.width, self.height, self.rows = width, height, rows

    def at(self, x, y):
        """The pixel at column x and row y, y up."""
        return self.rows[self.height - 1 - y][x]

    def differs(self, other):
        if (self.width, self.height) != (other.width, other.height):
            return f"{self.width}x{self.height} against {other.width}x{other.height}"
        count = sum(a != b for row, line in zip(self.rows, other.rows) for a, b in zip(row, line))
        return f"{count} pixels" if count else ""

    def part(self, left, bottom, width, height):
        top = self.height - bottom - height
        return Picture(width, height, [row[left:left + width] for row in self.rows[top:top + height]])


def read_ppm(path):
    magic, width, height, most, data = re.match(rb"(P6)\s(\d+)\s(\d+)\s(\d+)\s(.*)", Path(path).read_bytes(), re.S).groups()
    check((magic, most) == (b"P6", b"255"), f"{path} is a PPM of 8 bits")
    width, height = int(width), int(height)
    rows = [[tuple(data[3 * (y * width + x):][:3]) for x in range(width)] for y in range(height)]
    return Picture(width, height, rows)


def read_xwd(data):
    fields = struct.unpack(">25I", data[:100])
    header, width, height, order, bits, line, colors = (fields[i] for i in (0, 4, 5, 7, 11, 12, 19))
    check(bits == 32 and order == 0, "a dump of 32 bits a pixel, lowest byte first")
    pixels = data[header + 12 * colors:]

    def row(y):
        words = pixels[y * line:y * line + 4 * width]
        return list(zip(words[2::4], words[1::4], words[0::4]))

    return Picture(width, height, [row(y) for y in range(height)])


class Display:
    """An X server of its own, with a window manager: without one no key arrives."""

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", "1600x1200x24", "-nolisten", "tcp"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        # Up to the end of the line: the server ends if nobody reads it.
        with os.fdopen(read) as lines:
            number = lines.readline().strip()
        self.environment = {**os.environ, "DISPLAY": f":{number}"}
        self.manager = subprocess.Popen(["openbox"], env=self.environment, stderr=subprocess.DEVNULL)
        time.sleep(0.5)
        return self

    def __exit__(self, *_):
        for process in (self.manager, self.server):
            process.terminate()
            process.wait(SECONDS)

    def run(self, *command):
        return subprocess.run(command, env=self.environment, capture_output=True, timeout=SECONDS, check=True).stdout


class Program:
    """A chapter's program with its window."""

    def __init__(self, display, folder, binaries, chapter, variant, *arguments):
        self.display, self.folder, self.path, self.variant = display, folder, binaries / chapter, variant
        self.base = arguments
        self.output = open(folder / "stdout", "w+")
        self.errors = open(folder / "stderr", "w+")
        self.process = subprocess.Popen(
            [self.path, variant, "--window", "--out", f"{folder}/", *arguments],
            env=display.environment, stdout=self.output, stderr=self.errors)
        self.window = self.wait(self.find, "a window")
        self.wait(lambda: " ms" in self.title(), "a first picture")
        display.run("xdotool", "windowactivate", "--sync", self.window)

    def find(self):
        found = subprocess.run(["xdotool", "search", "--name", f"^{self.variant}"],
                               env=self.display.environment, capture_output=True, timeout=SECONDS, text=True).stdout
        return found.split()[-1] if found else None

    def title_of(self, window):
        return self.display.run("xdotool", "getwindowname", window).decode()

    def title(self):
        return self.title_of(self.window).strip()

    def wait(self, condition, what):
        """Waits until something is so; a window does what it is told a moment later."""
        end = time.monotonic() + SECONDS
        while time.monotonic() < end:
            value = condition()
            if value:
                return value
            time.sleep(0.05)
        raise AssertionError(f"{self.variant}: no {what} after {SECONDS} s")

    def key(self, name, title=None):
        self.display.run("xdotool", "key", name)
        if title is not None:
            self.wait(lambda: re.search(title, self.title()), f"{title!r} after {name}")

    def place(self, x, y, height=480):
        """The pointer over a pixel, y up."""
        self.display.run("xdotool", "mousemove", "--window", self.window, str(x), str(height - 1 - y))
        time.sleep(0.15)

    def button(self, action, number):
        self.display.run("xdotool", action, str(number))
        time.sleep(0.15)

    def seen(self):
        return read_xwd(self.display.run("xwd", "-silent", "-id", self.window))

    def shows(self, wanted, what):
        """Waits until the window shows a picture."""
        last = [""]

        def same():
            last[0] = self.seen().differs(wanted)
            return not last[0]

        try:
            self.wait(same, what)
        except AssertionError as error:
            raise AssertionError(f"{error}: {last[0]}; {self.title()}") from None
        print(f"  {what}: equal")

    def drawn(self, *arguments, variant=None):
        """What the same program writes."""
        path = self.folder / "drawn.ppm"
        subprocess.run([self.path, variant or self.variant, *self.base, *arguments, "--out", path],
                       check=True, capture_output=True, timeout=60)
        return read_ppm(path)

    def close(self, key="Escape"):
        self.display.run("xdotool", "key", key)
        check(self.process.wait(SECONDS) == 0, "exit code 0")
        self.errors.seek(0)
        print(f"  closed: {self.errors.read().strip().splitlines()[-1]}")


def mistake(display, folder, binaries):
    """Chapter 5: a knob, the remedy, the difference, overdraw, single pixels, a click, saving, a larger window."""
    program = Program(display, folder, binaries, "ch05_perspective_correct", "affine")
    program.shows(program.drawn(), "the first picture")
    program.key("Right", "tilt = 31 ")
    program.key("Right", "tilt = 32 ")
    tilt = "tilt=32"
    turned = program.drawn("--set", tilt)
    check(turned.differs(program.drawn()), "the knob changes the picture")
    program.shows(turned, f"a knob turned to {tilt}")

    remedied = program.drawn("--set", tilt, variant="correct")
    program.key("m", "remedy")
    program.shows(remedied, "M, the remedy")
    three = program.drawn("--set", tilt, "--compare")
    program.key("d", "difference")
    program.shows(three.part(2 * 644, 0, 640, 480), "D, the difference")
    overdrawn = program.drawn("--set", tilt, "--overdraw")
    program.key("o", "overdraw")
    program.shows(overdrawn.part(0, overdrawn.height - 480, 640, 480), "O, overdraw")
    program.key("o", "^affine ")

    program.place(60, 120)
    program.wait(lambda: "(60, 120) #" in program.title(), "pixel under the pointer")
    red, green, blue = turned.at(60, 120)
    check(f"(60, 120) #{red:02x}{green:02x}{blue:02x}" in program.title(), "its color")
    program.button("mousedown", 1)
    program.button("mouseup", 1)
    asked = subprocess.run([program.path, "affine", "--set", tilt, "--inspect", "60,120"],
                           check=True, capture_output=True, text=True, timeout=60).stdout
    told = lambda: Path(program.output.name).read_text()
    program.wait(lambda: asked.strip() in told(), "history of the pixel that was clicked")
    print("  a click: the history that --inspect prints")

    for _ in range(5):
        program.button("click", 4)
    program.wait(lambda: "8×" in program.title(), "8×")
    near = program.seen()
    # 80 × 60 pixels are shown, each as 8 × 8; the one under the pointer has stayed there.
    for x in range(80):
        for y in range(60):
            check(near.at(8 * x + 3, 8 * y + 3) == turned.at(60 - 60 // 8 + x, 120 - 120 // 8 + y), f"magnified pixel {x}, {y}")
    check(near.at(7, 7) == near.at(15, 7), "the grid")
    print("  the wheel: single pixels, equal")
    program.key("s")
    saved = program.wait(lambda: list(folder.glob("affine-tilt-*seen.png")), "a saved picture")
    print(f"  S: {saved[0].name}")
    program.key("Home", r"tilt = 30 ")
    program.shows(program.drawn(), "Home")
    program.key("k")
    program.wait(lambda: "tilt = 30 " not in program.title(), "knob that runs")
    program.key("k")
    program.key("Home", r"tilt = 30 ")
    program.key("equal", "2×")
    program.key("minus", r"^(?!.*×)")
    print("  K, +, -: the knob runs, pixels grow")

    display.run("xdotool", "windowsize", "--sync", program.window, "1300", "1000")
    wanted = program.drawn()
    double = lambda: [[seen.rows[20 + 2 * y + i][10 + 2 * x + j] for i in (0, 1) for j in (0, 1)] for seen in [program.seen()]
                      for y, x in [(0, 0), (240, 60), (479, 639), (100, 97)]]
    program.wait(lambda: double() == [[wanted.rows[y][x]] * 4 for y, x in [(0, 0), (240, 60), (479, 639), (100, 97)]],
                 "picture at twice the size in the middle")
    print("  a larger window: a whole-number scale")
    program.key("2", "^correct ")
    program.key("period", "^affine ")
    program.key("comma", "^correct ")
    program.key("h")
    program.wait(lambda: Path(program.errors.name).read_text().count("Esc") == 2, "the keys, told")
    program.close()


def points(display, folder, binaries):
    """Chapter 2: a vertex is dragged."""
    program = Program(display, folder, binaries, "ch02_triangles", "flat")
    before = program.drawn()
    knobs = subprocess.run([program.path, "flat", "--knobs"], check=True, capture_output=True, text=True).stdout
    name, x, y = re.search(r"(\S+) = (\d+),(\d+) ", knobs).groups()
    program.place(int(x), int(y))
    program.button("mousedown", 1)
    program.place(222, 333)
    program.button("mouseup", 1)
    setting = f"{name}=222,333"
    wanted = program.drawn("--set", setting)
    check(wanted.differs(before), "the point changes the picture")
    program.shows(wanted, f"{setting}, dragged")
    program.close()


def model(display, folder, binaries):
    """Chapter 10: a model is dragged, drawn by another rasterizer, and runs."""
    program = Program(display, folder, binaries, "ch10_matrices_lighting", "turntable")
    program.shows(program.drawn(), "the first picture")
    program.key("r", " scanline")
    program.shows(program.drawn("--rasterizer", "scanline"), "R, another rasterizer")
    program.place(300, 200)
    program.button("mousedown", 1)
    program.place(340, 200)
    program.button("mouseup", 1)
    program.wait(lambda: "azimuth = 15 " in program.title(), "orbit by 20°")
    program.key("Tab", "elevation = ")
    program.key("Up", "azimuth = ")
    program.key("space")
    program.wait(lambda: re.search(r"frame [1-9]", program.title()), "frames, running")
    program.key("space")
    time.sleep(0.5)
    frame = re.search(r"frame (\d+)", program.title())[1]
    program.shows(program.drawn("--rasterizer", "scanline", "--eye", "15,25", "--frame", frame), f"frame {frame}, stopped")
    program.close()


def slow(display, folder, binaries):
    """Chapter 10: a picture that takes long is a draft until it is there."""
    program = Program(display, folder, binaries, "ch10_matrices_lighting", "still-life", "--size", "640x480")
    program.shows(program.drawn(), "the first picture")
    program.key("r", " scanline .*drawing")
    program.shows(program.drawn("--rasterizer", "scanline"), "R, another rasterizer, slowly")
    program.wait(lambda: "drawing" not in program.title(), "end of drawing")
    for _ in range(12):
        program.key("Right")
    program.shows(program.drawn("--rasterizer", "scanline", "--set", "azimuth=32"), "a knob, twelve times")
    program.close()


def without_display(binaries):
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    run = subprocess.run([binaries / "ch01_pixels", "--window"], env=environment, capture_output=True, text=True, timeout=SECONDS)
    check(run.returncode == 1 and len(run.stderr.strip().splitlines()) == 1, f"one line: {run.stderr}")
    print(f"  without a display: {run.stderr.strip()}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--only", help="one of mistake, points, model, slow")
    parser.add_argument("--release", action="store_true", help="the release build, to measure")
    arguments = parser.parse_args()
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        sys.exit(f"error: {', '.join(missing)} not found (Debian: apt-get install xvfb openbox xdotool x11-apps)")
    profile = ["--release"] if arguments.release else []
    subprocess.run(["cargo", "build", "--quiet", "--features", "window", "--bins", *profile], cwd=ROOT, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    binaries = target / ("release" if arguments.release else "debug")
    with tempfile.TemporaryDirectory() as folder, Display() as display:
        for scene in (mistake, points, model, slow):
            if arguments.only not in (None, scene.__name__):
                continue
            print(scene.__doc__)
            inner = Path(folder) / scene.__name__
            inner.mkdir()
            scene(display, inner, binaries)
    without_display(binaries)
    print("the window: all checks passed")


if __name__ == "__main__":
    main()
