#!/usr/bin/env python3
"""Refuses an #include that does not follow the floors.

    check_includes.py ROOT

base <- sim, acoustics, estimator (siblings, none includes another) <- scenarios <- tools; tests see everything.
Each third party appears in the places listed here and nowhere else, so that it can be replaced there.
"""

import re
import sys
from pathlib import Path

from source_tree import SOURCE_SUFFIXES, all_files, report

FLOORS = {
    "base": {"base"},
    "sim": {"base", "sim"},
    "acoustics": {"base", "acoustics"},
    "estimator": {"base", "estimator"},
    "scenarios": {"base", "sim", "acoustics", "estimator", "scenarios"},
    "tools": {"base", "sim", "acoustics", "estimator", "scenarios", "tools"},
    "tests": {"base", "sim", "acoustics", "estimator", "scenarios", "tools", "tests"},
}

# (headers, files that may include them, at most one such file per floor)
THIRD_PARTIES = [
    ("Eigen", r"Eigen/", r".*", False),
    ("Random123", r"Random123/", r"base/random\.cc", False),
    ("Bullet", r"(bullet/|bt[A-Z]|LinearMath/|BulletCollision/|BulletDynamics/)", r"sim/bullet/.*", False),
    ("libsndfile", r"sndfile", r"acoustics/(audio|sound)_file\.cc", False),
    ("libsamplerate", r"samplerate", r"acoustics/[^/]*\.cc", True),
    ("kissfft", r"kiss_?fft", r"(acoustics|estimator)/[^/]*\.cc", True),
    ("yaml-cpp", r"yaml-cpp/", r"scenarios/[^/]*\.cc", False),
    ("nlohmann-json", r"nlohmann/", r"(scenarios|tools/piperun)/[^/]*\.cc", False),
    ("OpenSSL", r"openssl/", r"scenarios/[^/]*\.cc", True),
    ("SQLite", r"(sqlite3|SQLiteCpp/)", r"scenarios/[^/]*\.cc", False),
    ("CLI11", r"CLI/", r"tools/.*", False),
    ("fmt", r"fmt/", r"tools/.*", False),
    ("GoogleTest", r"(gtest|gmock)/", r"tests/.*", False),
    ("Google Benchmark", r"benchmark/", r"tests/bench/.*", False),
    ("RapidCheck", r"rapidcheck", r"tests/.*", False),
]
TESTS_MAY_READ_BACK_WITH = {"libsndfile", "nlohmann-json", "yaml-cpp", "kissfft", "Bullet"}
OPERATING_SYSTEM = re.compile(r"(unistd|fcntl|signal|dlfcn|errno|time|stdio|stdlib|string|termios)\.h$|(sys|linux)/")
OPERATING_SYSTEM_USERS = r"(scenarios|tools|tests)/.*|acoustics/(audio|sound)_file\.cc"
PRIVATE_FOLDERS = {Path("sim/bullet"): "sim"}

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:<([^>]+)>|"([^"]+)")')


def included(text):
    """(line number, header, is quoted) of every #include."""
    for number, line in enumerate(text.splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1) or match.group(2), match.group(2) is not None


def check_own_header(file, header):
    """A problem with `file` including our own "header", or None."""
    floor, target = file.parts[0], Path(header).parts[0]
    if target not in FLOORS:
        return f'"{header}" is not written from the root of the repository'
    if target not in FLOORS[floor]:
        return f"{floor}/ may not include {target}/ ({header})"
    for folder, owner in PRIVATE_FOLDERS.items():
        if folder in Path(header).parents and file.suffix == ".h" and folder not in file.parents:
            return f"{header} is private to {owner}/; a header outside {folder}/ may not include it"
        if folder in Path(header).parents and floor not in (owner, "tests"):
            return f"{header} is private to {owner}/"
    return None


def find_third_party(header):
    """The row of THIRD_PARTIES to which a header belongs, or None."""
    return next((row for row in THIRD_PARTIES if re.match(row[1], header)), None)


def check_foreign_header(file, header):
    """A problem with `file` including <header>, or None."""
    if "/" not in header and not header.endswith((".h", ".hh", ".hpp")):
        return None  # the standard library
    if OPERATING_SYSTEM.match(header):
        allowed = re.fullmatch(OPERATING_SYSTEM_USERS, file.as_posix())
        return None if allowed else f"<{header}> belongs to the operating system"
    row = find_third_party(header)
    if row is None:
        return f"<{header}> is not one of our third parties"
    name, _, allowed, _ = row
    if re.fullmatch(allowed, file.as_posix()):
        return None
    if file.parts[0] == "tests" and name in TESTS_MAY_READ_BACK_WITH:
        return None
    return f"<{header}>: {name} is not allowed here (allowed: {allowed})"


def check_single_files(uses):
    """Problems with third parties that may stand in one file per floor only. `uses`: {(name, floor): files}."""
    single = {row[0] for row in THIRD_PARTIES if row[3]}
    return [
        f"{' and '.join(sorted(files))}: {name} may stand in one file of {floor}/ only"
        for (name, floor), files in sorted(uses.items())
        if name in single and floor != "tests" and len(files) > 1
    ]


def check(root):
    """Every problem of the tree below `root`, as `file:line: problem`."""
    problems, uses = [], {}
    for file in all_files(root):
        if file.suffix not in SOURCE_SUFFIXES or file.parts[0] not in FLOORS:
            continue
        for line, header, quoted in included((root / file).read_text(encoding="utf-8")):
            check_header = check_own_header if quoted else check_foreign_header
            problem = check_header(file, header)
            if problem:
                problems.append(f"{file}:{line}: {problem}")
            row = None if quoted else find_third_party(header)
            if row:
                uses.setdefault((row[0], file.parts[0]), set()).add(file.as_posix())
    return problems + check_single_files(uses)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(report(check(Path(sys.argv[1])), "includes against the floors"))
