"""Git, and the places of files in this repository."""

import subprocess
from pathlib import Path

from .console import Failure

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "perf"  # ignored by git: builds, records, reports


def git(*words, cwd=ROOT):
    """The output of a git command."""
    try:
        done = subprocess.run(["git", *words], cwd=cwd, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise Failure("git is not installed") from None
    if done.returncode != 0:
        raise Failure(f"git {' '.join(words)}: {done.stderr.strip()}")
    return done.stdout


def commit_of(name, cwd=ROOT):
    """The full hash of a commit by any of its names."""
    try:
        return git("rev-parse", "--verify", "--quiet", name + "^{commit}", cwd=cwd).strip()
    except Failure:
        raise Failure(f"'{name}' is no commit of {cwd} and no program") from None


def is_dirty(cwd=ROOT):
    return bool(git("status", "--porcelain", "--untracked-files=no", cwd=cwd).strip())


def describe(commit, cwd=ROOT):
    """(short hash, seconds since 1970, first line of the message)"""
    short, seconds, subject = git("log", "-1", "--format=%h%x00%ct%x00%s", commit, cwd=cwd).strip().split("\0")
    return short, int(seconds), subject
