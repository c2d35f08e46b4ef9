"""What the user sees: messages, progress, and how the program ends."""

import sys
import time

GOOD, REGRESSION, USAGE, FAILED, SKIPPED = 0, 1, 2, 3, 77


class Failure(Exception):
    """Something could not be done. The message says what, and what helps if that is known."""

    def __init__(self, message, status=FAILED):
        super().__init__(message)
        self.status = status


def say(text):
    print(text, file=sys.stderr, flush=True)


class Progress:
    """Shows the progress of long work: in one line on a terminal, in a line per step elsewhere."""

    def __init__(self, steps):
        self.steps, self.done, self.begun = max(1, steps), 0, time.monotonic()

    def step(self, text):
        spent = time.monotonic() - self.begun
        left = f", {self.clock(spent / self.done * (self.steps - self.done))} left" if self.done else ""
        line = f"[{self.done + 1}/{self.steps}{left}] {text}"
        if sys.stderr.isatty():
            sys.stderr.write("\r\033[K" + line[:150])
            sys.stderr.flush()
        else:
            say(line)
        self.done += 1

    def more(self, steps):
        self.steps += steps

    @staticmethod
    def end():
        if sys.stderr.isatty():
            sys.stderr.write("\r\033[K")

    @staticmethod
    def clock(seconds):
        return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"


def table(rows, right=()):
    """Rows of cells as one text with padded columns; the columns in `right` are aligned right."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    lines = []
    for row in rows:
        cells = [cell.rjust(w) if k in right else cell.ljust(w) for k, (cell, w) in enumerate(zip(row, widths))]
        lines.append("  ".join(cells).rstrip())
    return "\n".join(lines)


def scaled(rate):
    """"1.23 G", for a number of things per second."""
    for factor, letter in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if rate >= factor:
            return f"{rate / factor:.3g}{letter}"
    return f"{rate:.3g}"
