# SPDX-License-Identifier: Apache-2.0
"""What scripts of named cases have in common: their arguments, skipping, a line for each case, and the exit code."""
import argparse
import sys
import time

SKIPPED = 77


def parser_of(description, cases):
    """Of TREEFARM SCENE [--only NAME]..."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("treefarm")
    parser.add_argument("scene")
    parser.add_argument("--only", choices=cases, action="append", help="this case; may be given again")
    return parser


def skip_for(reason):
    """Ends the script where there is a reason why it cannot run."""
    if reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)


def run_cases(names, case):
    """Prints what each case says, `case(name)`; returns how many say neither "same bits ..." nor "skipped ..."."""
    failed = 0
    for name in names:
        begin = time.monotonic()
        result = case(name)
        failed += not result.startswith(("same bits", "skipped"))
        print(f"{name:32} {result} ({time.monotonic() - begin:.0f} s)", flush=True)
    print(f"{failed} failed")
    return failed
