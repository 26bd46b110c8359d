#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/generated/hard-cases.md and its tables hard-cases.csv and oracles.csv from the descriptions above the tests of
tests/stability, and what they measure.

usage: tests/stability/write_page.py [BUILD]     runs the tests and the oracles of BUILD (default build/release)
       tests/stability/write_page.py --keep      keeps what the tables say was measured; runs nothing
       tests/stability/write_page.py --check     fails unless page and tables say what the descriptions say; runs nothing

A description is the comment above a test: "/// ROWS | TITLE", then Others:, Here: and Holds:. ROWS are those of the
list of cases that broke renderers, or "ours".
"""
import csv
import io
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from overlay_build import write_edits

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs/generated"
ROWS = range(1, 44)
WITHOUT_TEST = {
    20: "participating media, which are not simulated (nor is row 21's equiangular sampling, which is of media)",
}
COLUMNS = ["rows", "title", "others", "here", "holds", "measured", "guarded by", "test"]
ORACLE_COLUMNS = ["function", "inputs", "error", "worst", "bound", "worst input"]
HEAD = """# Hard cases

Cases that broke other renderers, and what is done here. This page and its tables are written by
`tests/stability/write_page.py` from the tests' own descriptions and what they measure; a unit test holds them against
the descriptions. Numbers are rows of our list of failures seen in public renderers; "ours" are cases of our own design.

    ctest --preset release -L stability       the suite
    tests/stability/without_guards.py         every test with a guard removed: it must fail

[hard-cases.csv](hard-cases.csv) has a row for each case: what happened elsewhere (issues and commits as their projects
name them; no code is taken from them), what is done here, what the test asserts, the figure it measured, the test's
name, and the files in which removing a line, or changing a constant, makes the test fail
(`tests/stability/guards.json`). Where no file is named, no single line guards: the case holds by construction.
"""
ORACLES = """## Against 113-bit arithmetic

Our functions against their definitions evaluated in quadruple precision for exactly the same floats, random and
adversarial ones (`tests/oracle`; `build/release/tests/oracle_table [INPUTS]` prints the table). `Oracles.KeepTheirBounds`
holds the bounds with fewer inputs. Errors are in the unit that the column names. Numbers of inputs, and the worst one:
[oracles.csv](oracles.csv).

"""


def wrapped(text):
    return " ".join(line.strip()[3:].strip() for line in text.strip().splitlines())


def subject(text, path):
    """The comment that begins a file."""
    head = re.match(r"// SPDX[^\n]*\n// ([^\n]+)\.\n", text)
    if not head:
        sys.exit(f"{path} does not begin with what its cases are about")
    return head[1]


def descriptions():
    cases = []
    for path in sorted((ROOT / "tests/stability").glob("*_test.cpp")):
        text = path.read_text()
        for comment, macro, suite, name in re.findall(
            r"((?:^///[^\n]*\n)+)(TEST|TEST_F|TEST_P)\((\w+), (\w+)\)", text, re.M
        ):
            parts = re.split(r"\s*\b(Others|Here|Holds): ", wrapped(comment))
            head = re.fullmatch(r"([\d, ]+|ours) \| (.+)", parts[0])
            if not head or parts[1::2] != ["Others", "Here", "Holds"]:
                sys.exit(f"{path}: {suite}.{name} has no description of a case")
            rows = [] if head[1] == "ours" else [int(row) for row in head[1].split(",")]
            cases.append({"rows": rows, "title": head[2], "test": f"{suite}.{name}", "program": path.stem,
                          "subject": subject(text, path), **dict(zip(parts[1::2], parts[2::2]))})
    covered = {row for case in cases for row in case["rows"]}
    if missing := [row for row in ROWS if row not in covered and row not in WITHOUT_TEST]:
        sys.exit(f"no test for the rows {missing}")
    return sorted(cases, key=lambda case: (case["rows"] or [99]))


def guards():
    return json.loads((ROOT / "tests/stability/guards.json").read_text())


def measured(build):
    """Test to figure, by running them; of a parameterised test the last one's."""
    figures = {}
    with tempfile.NamedTemporaryFile(suffix=".json") as result:
        subprocess.run([build / "tests/stability_test", f"--gtest_output=json:{result.name}"], check=True,
                       stdout=subprocess.DEVNULL)
        for suite in json.load(open(result.name))["testsuites"]:
            for test in suite["testsuite"]:
                name = f"{suite['name'].split('/')[-1]}.{test['name'].split('/')[0]}"
                if "figure" in test:
                    figures[name] = ": ".join(test["figure"].rsplit(" ", 1))
    return figures


def rows_of(case):
    return ", ".join(map(str, case["rows"])) or "ours"


def table(cases, figures):
    """The rows of hard-cases.csv."""
    rows = []
    for case in cases:
        files = sorted({edit["file"] for guard in guards() if guard["test"] == case["test"] for edit in guard["edits"]})
        rows.append([rows_of(case), case["title"], case["Others"], case["Here"], case["Holds"],
                     figures.get(case["test"], ""), " ".join(files), case["test"]])
    return rows


def oracles(markdown):
    """The rows of oracles.csv, of what oracle_table prints."""
    lines = [line for line in markdown.splitlines() if line.startswith("| ")]
    return [[cell.strip().strip("`") for cell in line.split("|")[1:-1]] for line in lines[1:]]


def page(cases, oracle_rows):
    text = HEAD
    for program in sorted({case["program"] for case in cases}):
        own = [case for case in cases if case["program"] == program]
        text += f"\n## {own[0]['subject']}\n\n| | case | here |\n|---|---|---|\n"
        for case in own:
            text += f"| {rows_of(case)} | {case['title']} | {case['Here']} |\n"
    text += "\n## Rows without a test\n\n"
    for row, why in WITHOUT_TEST.items():
        text += f"- {row}: {why}.\n"
    text += "\n" + ORACLES + "| function | error | worst | bound |\n|---|---|---|---|\n"
    for row in oracle_rows:
        text += f"| {row[0]} | {row[2]} | {row[3]} | {row[4]} |\n"
    return text


def write_csv(name, columns, rows):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([columns, *rows])
    (FOLDER / name).write_text(text.getvalue())


def read_csv(name, columns):
    """The rows of a table; none where the file is absent or has other columns."""
    if not (FOLDER / name).exists():
        return []
    with open(FOLDER / name, newline="") as file:
        rows = list(csv.reader(file))
    return rows[1:] if rows and rows[0] == columns else []


def write(cases, figures, oracle_rows):
    write_csv("hard-cases.csv", COLUMNS, table(cases, figures))
    write_csv("oracles.csv", ORACLE_COLUMNS, oracle_rows)
    (FOLDER / "hard-cases.md").write_text(page(cases, oracle_rows))


def check(cases):
    for guard in guards():
        with tempfile.TemporaryDirectory() as overlay:
            if stale := write_edits(guard["edits"], pathlib.Path(overlay)):
                sys.exit(f"tests/stability/guards.json: {stale} has no such text as the guard of {guard['test']}")
    without_figures = [[cell for name, cell in zip(COLUMNS, row) if name != "measured"]
                       for row in read_csv("hard-cases.csv", COLUMNS)]
    if without_figures != [[cell for name, cell in zip(COLUMNS, row) if name != "measured"] for row in table(cases, {})]:
        sys.exit("docs/generated/hard-cases.csv is out of date: run tests/stability/write_page.py")
    oracle_rows = read_csv("oracles.csv", ORACLE_COLUMNS)
    if len(oracle_rows) < 20:
        sys.exit("docs/generated/oracles.csv has no table of oracles: run tests/stability/write_page.py")
    old = FOLDER / "hard-cases.md"
    if not old.exists() or old.read_text() != page(cases, oracle_rows):
        sys.exit("docs/generated/hard-cases.md is out of date: run tests/stability/write_page.py")


def main():
    cases = descriptions()
    if sys.argv[1:] == ["--check"]:
        check(cases)
        return
    if sys.argv[1:] == ["--keep"]:
        figures = {row[-1]: row[COLUMNS.index("measured")] for row in read_csv("hard-cases.csv", COLUMNS)}
        write(cases, figures, read_csv("oracles.csv", ORACLE_COLUMNS))
        return
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release").resolve()
    printed = subprocess.run([build / "tests/oracle_table"], check=True, capture_output=True, text=True).stdout
    write(cases, measured(build), oracles(printed))


if __name__ == "__main__":
    main()
