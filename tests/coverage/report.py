"""Reads what `tests/coverage/run` collects: how many lines of each file of lib/ the tests run, and which they do not."""

import re
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def lines(path):
    """File below the root → line → how often it ran. A line of a generic function counts as run if any copy of it ran."""
    files = defaultdict(dict)
    for row in Path(path).read_text().splitlines():
        kind, _, value = row.partition(":")
        if kind == "SF":
            counts = files[Path(value).relative_to(ROOT)]
        elif kind == "DA":
            number, count = (int(part) for part in value.split(",")[:2])
            counts[number] = max(counts.get(number, 0), count)
    return files


def code(file):
    """The lines of a file, and the number of the first that belongs to its unit tests."""
    text = (ROOT / file).read_text().splitlines()
    is_tests = re.compile(r"#\[cfg\((all\()?test\b").match
    tests = next((n for n, line in enumerate(text, 1) if is_tests(line)), len(text) + 1)
    return text, tests


def main(path, words):
    """Prints the table; for files whose names contain one of the words, the lines, too."""
    total = missed = 0
    for file, counts in sorted(lines(path).items()):
        text, tests = code(file)
        own = {number: count for number, count in counts.items() if number < tests}
        if not own:
            continue
        not_run = [number for number, count in sorted(own.items()) if count == 0]
        total, missed = total + len(own), missed + len(not_run)
        print(f"{str(file):42} {len(own) - len(not_run):5} of {len(own):5} lines  {100 - 100 * len(not_run) / len(own):6.1f} %")
        if any(word in str(file) for word in words):
            for number in not_run:
                print(f"    {number:5} {text[number - 1]}")
    print(f"{'all':42} {total - missed:5} of {total:5} lines  {100 - 100 * missed / total:6.1f} %")


main(sys.argv[1], sys.argv[2:])
