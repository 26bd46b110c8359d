#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/generated/hard-cases.md from the descriptions above the tests of tests/stability, and what they measure.

usage: tests/stability/write_page.py [BUILD]     runs the tests and the oracles of BUILD (default build/release)
       tests/stability/write_page.py --check     fails unless the page says what the descriptions say; runs nothing

A description is the comment above a test: "/// ROWS | TITLE", then Others:, Here: and Holds:. ROWS are those of the
list of cases that broke renderers, or "ours".
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from overlay_build import write_edits

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/generated/hard-cases.md"
ROWS = range(1, 44)
WITHOUT_TEST = {
    20: "participating media, which are not simulated (nor is row 21's equiangular sampling, which is of media)",
}
HEAD = """# Hard cases

What broke other renderers, what holds here, and the test that says so. This page is written by
`tests/stability/write_page.py` from the tests' own descriptions and what they measure; a unit test holds it against
them. Numbers before a title are rows of our list of failures seen in public renderers; "ours" are cases of our own
design. Issues and commits are named as their projects name them; no code is taken from them.

    ctest --preset release -L stability       the suite
    tests/stability/without_guards.py         every test with a guard removed: it must fail

"Guarded by" names the files in which removing a line, or changing a constant, makes the test fail
(`tests/stability/guards.json`). Where it is missing, no single line guards: the case holds by construction.
"""
ORACLES = """## Against 113-bit arithmetic

Our functions against their definitions evaluated in quadruple precision for exactly the same floats, random and
adversarial ones (`tests/oracle`; `build/release/tests/oracle_table [INPUTS]` prints the table). `Oracles.KeepTheirBounds`
holds the bounds with fewer inputs. Errors are in the unit that the column names.

"""


def wrapped(text):
    return " ".join(line.strip()[3:].strip() for line in text.strip().splitlines())


def descriptions():
    cases = []
    for path in sorted((ROOT / "tests/stability").glob("*_test.cpp")):
        for comment, macro, suite, name in re.findall(
            r"((?:^///[^\n]*\n)+)(TEST|TEST_F|TEST_P)\((\w+), (\w+)\)", path.read_text(), re.M
        ):
            parts = re.split(r"\s*\b(Others|Here|Holds): ", wrapped(comment))
            head = re.fullmatch(r"([\d, ]+|ours) \| (.+)", parts[0])
            if not head or parts[1::2] != ["Others", "Here", "Holds"]:
                sys.exit(f"{path}: {suite}.{name} has no description of a case")
            rows = [] if head[1] == "ours" else [int(row) for row in head[1].split(",")]
            cases.append({"rows": rows, "title": head[2], "test": f"{suite}.{name}", "program": path.stem,
                          **dict(zip(parts[1::2], parts[2::2]))})
    covered = {row for case in cases for row in case["rows"]}
    if missing := [row for row in ROWS if row not in covered and row not in WITHOUT_TEST]:
        sys.exit(f"no test for the rows {missing}")
    return sorted(cases, key=lambda case: (case["rows"] or [99]))


def guards():
    return json.loads((ROOT / "tests/stability/guards.json").read_text())


def measured(build, cases):
    """Test to figure, by running them; of a parameterised test the last one's."""
    figures = {}
    for program in sorted({case["program"] for case in cases}):
        with tempfile.NamedTemporaryFile(suffix=".json") as result:
            subprocess.run([build / "tests" / f"stability_{program}", f"--gtest_output=json:{result.name}"],
                           check=True, stdout=subprocess.DEVNULL)
            for suite in json.load(open(result.name))["testsuites"]:
                for test in suite["testsuite"]:
                    name = f"{suite['name'].split('/')[-1]}.{test['name'].split('/')[0]}"
                    if "figure" in test:
                        figures[name] = ": ".join(test["figure"].rsplit(" ", 1))
    return figures


def page(cases, figures, table):
    text = HEAD
    for case in cases:
        rows = ", ".join(map(str, case["rows"])) or "ours"
        text += f"\n### {rows}: {case['title']}\n\n"
        text += f"- Others: {case['Others']}\n- Here: {case['Here']}\n- Holds: {case['Holds']}\n"
        if case["test"] in figures:
            text += f"- Measured: {figures[case['test']]}.\n"
        files = sorted({edit["file"] for guard in guards() if guard["test"] == case["test"] for edit in guard["edits"]})
        if files:
            text += "- Guarded by: " + ", ".join(f"`{file}`" for file in files) + ".\n"
        text += f"- Test: `{case['test']}`\n"
    text += "\n## Rows without a test\n\n"
    for row, why in WITHOUT_TEST.items():
        text += f"- {row}: {why}.\n"
    return text + "\n" + ORACLES + table


def without_figures(text):
    text = re.sub(r"^- Measured: .*\n", "", text, flags=re.M)
    return "\n".join(line.split("|")[1] if line.startswith("| ") else line for line in text.splitlines())


def main():
    cases = descriptions()
    if sys.argv[1:] == ["--check"]:
        for guard in guards():
            with tempfile.TemporaryDirectory() as overlay:
                if stale := write_edits(guard["edits"], pathlib.Path(overlay)):
                    sys.exit(f"tests/stability/guards.json: {stale} has no such text as the guard of {guard['test']}")
        old = PAGE.read_text() if PAGE.exists() else ""
        if without_figures(old.split(ORACLES)[0]) != without_figures(page(cases, {}, "").split(ORACLES)[0]):
            sys.exit("docs/generated/hard-cases.md is out of date: run tests/stability/write_page.py")
        if old.count("\n| ") < 20:
            sys.exit("docs/generated/hard-cases.md has no table of oracles: run tests/stability/write_page.py")
        return
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release").resolve()
    table = subprocess.run([build / "tests/oracle_table"], check=True, capture_output=True, text=True).stdout
    PAGE.write_text(page(cases, measured(build, [c for c in cases]), table))


main()
