#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Says the licence in each file that can hold a comment: one SPDX line at its top, below a "#!" or "<?xml" line.

usage: tests/tools/add_spdx.py            adds it where it is missing
       tests/tools/add_spdx.py --check    fails where it is missing; 77 (skipped) while no file has it
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINE = "SPDX-License-Identifier: Apache-2.0"
MARKS = {".h": "// {}", ".cpp": "// {}", ".in": "// {}", ".js": "// {}", ".css": "/* {} */", ".py": "# {}", ".cmake": "# {}",
         ".sh": "# {}", ".bash": "# {}", ".toml": "# {}", ".yaml": "# {}", ".cff": "# {}", ".xml": "<!-- {} -->"}
NAMES = {"CMakeLists.txt", ".clang-format", ".clang-tidy", ".editorconfig", ".gitignore", ".git-blame-ignore-revs"}


def mark_of(path):
    """How a comment looks in a file; None: it is no source file."""
    if path.name in NAMES:
        return "# {}"
    if path.suffix in MARKS:
        return MARKS[path.suffix]
    with path.open("rb") as file:
        return "# {}" if file.read(2) == b"#!" else None


def sources():
    listing = ["git", "-c", f"safe.directory={ROOT}", "-C", ROOT, "ls-files", "-z"]
    try:
        names = subprocess.run(listing, check=True, capture_output=True, text=True).stdout
    except (OSError, subprocess.CalledProcessError):
        print("skipped: git does not list the files; is this an unpacked archive?")
        sys.exit(77)
    for name in filter(None, names.split("\0")):
        path = ROOT / name
        if path.is_file() and not path.is_symlink() and (mark := mark_of(path)):
            yield path, mark.format(LINE)


def has_line(text, line):
    return line in text.split("\n", 2)[:2]


def with_line(text, line):
    if text.startswith(("#!", "<?xml")):
        first, rest = text.split("\n", 1)
        return f"{first}\n{line}\n{rest}"
    return f"{line}\n{text}"


def main():
    check = sys.argv[1:] == ["--check"]
    if sys.argv[1:] and not check:
        sys.exit(__doc__)
    missing = []
    count = 0
    for path, line in sources():
        count += 1
        text = path.read_text(encoding="utf-8")
        if has_line(text, line):
            continue
        missing.append(str(path.relative_to(ROOT)))
        if not check:
            path.write_text(with_line(text, line), encoding="utf-8")
    if check and len(missing) == count:
        print("skipped: no file says its licence yet; run tests/tools/add_spdx.py")
        sys.exit(77)
    if check and missing:
        sys.exit("run tests/tools/add_spdx.py: no SPDX line in\n" + "\n".join(missing))
    print(f"{count} files, {len(missing)} {'lack it' if check else 'changed'}")


if __name__ == "__main__":
    main()
