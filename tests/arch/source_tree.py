"""The files of the repository, as the architecture checks see them."""

import os
from pathlib import Path

SKIPPED_FOLDERS = {".git", "build", "install", "runs", "__pycache__"}
SOURCE_SUFFIXES = {".h", ".cc"}


def all_files(root):
    """Every file below `root` that could be committed, as paths relative to it, in a fixed order."""
    found = []
    for folder, subfolders, names in os.walk(root):
        subfolders[:] = sorted(s for s in subfolders if s not in SKIPPED_FOLDERS)
        found += [(Path(folder) / name).relative_to(root) for name in names]
    return sorted(found)


def report(problems, what):
    """Prints what is wrong, one line each, and returns the exit code."""
    for problem in problems:
        print(problem)
    print(f"{len(problems)} {what}")
    return 1 if problems else 0
