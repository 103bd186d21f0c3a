#!/usr/bin/env python3
"""Refuses text that has no place in the repository: a machine's paths, and what makes runs irreproducible.

    check_text.py ROOT
"""

import re
import sys
from pathlib import Path

from source_tree import all_files, report

EVERYTHING = r".*"
CODE = r".*\.(h|cc)"
FLOORS_BELOW_THE_CLOCK = r"(base|sim|acoustics|estimator)/.*\.(h|cc)"
BUILD_FILES = r".*(CMakeLists\.txt|\.cmake|\.cmake\.in|\.json)|tools/[^/.]*|\.ci/.*"

# (pattern, files it is looked for in, why not). The patterns are written so that they do not match themselves.
RULES = [
    (r"(?<![\w.])/(?:work|root|home)/", EVERYTHING, "a path of one machine"),
    (r"-ffast[-]math|-Ofast\b", BUILD_FILES, "changes results between compilers"),
    (r"-march=[n]ative", BUILD_FILES, "changes results between machines"),
    (r"#\s*include\s*<random>", CODE, "distributions differ between standard libraries; use base/random.h"),
    (r"\brandom_[d]evice\b", CODE, "not reproducible; use base/random.h"),
    (r"\b(normal|uniform_real|uniform_int)_[d]istribution\b", CODE, "differs between standard libraries"),
    (r"\bstd::[s]huffle\b", CODE, "differs between standard libraries"),
    (r"\bstd::[h]ash\b", CODE, "differs between standard libraries; use HashName"),
    (r"(::|\.set)[R]andom\s*\(", CODE, "Eigen's generator has a hidden state; use base/random.h"),
    (r"(?<![\w.:>])(std::)?s?[r]and\s*\(", CODE, "has a hidden state; use base/random.h"),
    (r"\b(steady|system|high_resolution)_[c]lock\b|\bstd::time\s*\(", FLOORS_BELOW_THE_CLOCK,
     "a run is a pure function: no clock below scenarios/"),
    (r"\b(t|time|time_s)\s*\+=\s*(dt|dt_s|step_s|period_s)\b", FLOORS_BELOW_THE_CLOCK,
     "accumulated time drifts; use SampleTime(k, rate)"),
]


def read_text(path):
    """The file's text, or nothing when it is not text."""
    data = path.read_bytes()
    if b"\0" in data:
        return ""
    return data.decode("utf-8", errors="replace")


def check(root):
    """Every problem of the tree below `root`, as `file:line: problem`."""
    rules = [(re.compile(pattern), re.compile(files), reason) for pattern, files, reason in RULES]
    problems = []
    for file in all_files(root):
        wanted = [(pattern, reason) for pattern, files, reason in rules if files.fullmatch(file.as_posix())]
        for number, line in enumerate(read_text(root / file).splitlines(), 1):
            for pattern, reason in wanted:
                match = pattern.search(line)
                if match:
                    problems.append(f"{file}:{number}: '{match.group(0)}': {reason}")
    return problems


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(report(check(Path(sys.argv[1])), "forbidden words"))
