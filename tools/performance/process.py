"""Runs a program to its end, or to a limit of time."""

import os
import signal
import subprocess

from .console import Failure


def end(process):
    """Ends a program and all that it started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.communicate()


def start(program, *words, environment=None, limit=None):
    """The ended program with its standard output and error as texts. It has `limit` seconds, for ever if None."""
    try:
        process = subprocess.Popen([str(program), *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True,
                                   env=dict(os.environ, **(environment or {})))
    except FileNotFoundError:
        raise Failure(f"there is no program {program}") from None
    except OSError as error:
        raise Failure(f"{program} does not start: {error.strerror}") from None
    try:
        out, err = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        end(process)
        raise Failure(f"{program} did not end within {limit:g} s and was stopped: --time-limit S gives it "
                      "longer") from None
    except BaseException:
        end(process)
        raise
    return subprocess.CompletedProcess(process.args, process.returncode, out, err)


def ending(done):
    """How a program ended, in words, with the last lines of its messages."""
    last = "".join("\n  " + line for line in done.stderr.strip().splitlines()[-5:])
    if done.returncode >= 0:
        return f"exit status {done.returncode}{last}"
    try:
        name = signal.Signals(-done.returncode).name
    except ValueError:
        name = "unknown"
    return f"signal {-done.returncode}, {name}{last}"
