"""Plots as SVG, for the page and for rsvg-convert."""

import math
import subprocess
from html import escape

from .console import Failure

PAPER, INK, QUIET, FAINT = "#fcfcf9", "#23272e", "#6b7078", "#e3e3dc"
# Colour-blind readers can tell these apart too (Okabe and Ito, Color Universal Design, 2008, darkened for text on
# paper).
COLOURS = ("#0072b2", "#c2500a", "#00805c", "#b0508a", "#7a6a00", "#3f7fbf", "#8a3b12", "#555b66", "#4b2e83", "#a8324a")
FONT = "font-family='DejaVu Sans, Verdana, sans-serif'"


class Canvas:
    """Shapes and words in pixels, y downwards."""

    def __init__(self, width, height):
        self.width, self.height, self.parts = width, height, []

    def line(self, x0, y0, x1, y1, colour=FAINT, width=1.0, dash=None):
        dashes = f" stroke-dasharray='{dash}'" if dash else ""
        self.parts.append(f"<line x1='{x0:.1f}' y1='{y0:.1f}' x2='{x1:.1f}' y2='{y1:.1f}' stroke='{colour}' "
                          f"stroke-width='{width}'{dashes}/>")

    def path(self, points, colour, width=2.0):
        steps = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f"<polyline points='{steps}' fill='none' stroke='{colour}' stroke-width='{width}' "
                          f"stroke-linejoin='round' stroke-linecap='round'/>")

    def dot(self, x, y, colour, radius=4.0, title=""):
        tip = f"<title>{escape(title)}</title>" if title else ""
        self.parts.append(f"<circle cx='{x:.1f}' cy='{y:.1f}' r='{radius}' fill='{colour}'>{tip}</circle>")

    def bar(self, x, y, width, height, colour, title=""):
        tip = f"<title>{escape(title)}</title>" if title else ""
        self.parts.append(f"<rect x='{x:.1f}' y='{y:.1f}' width='{max(0.5, width):.1f}' height='{height:.1f}' rx='2' "
                          f"fill='{colour}'>{tip}</rect>")

    def text(self, x, y, words, colour=INK, size=13, anchor="start", bold=False, halo=False):
        """With a halo, the grid behind the words is covered."""
        weight = " font-weight='bold'" if bold else ""
        behind = f" stroke='{PAPER}' stroke-width='4' paint-order='stroke'" if halo else ""
        self.parts.append(f"<text x='{x:.1f}' y='{y:.1f}' fill='{colour}' font-size='{size}' text-anchor='{anchor}'"
                          f"{weight}{behind}>{escape(words)}</text>")

    def svg(self):
        return (f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {self.width} {self.height}' width='{self.width}' "
                f"height='{self.height}' {FONT} role='img'><rect width='100%' height='100%' fill='{PAPER}'/>"
                + "".join(self.parts) + "</svg>")


def write_png(svg, file):
    """Writes a plot as PNG, by rsvg-convert."""
    try:
        done = subprocess.run(["rsvg-convert", "--zoom=1.5", "-o", str(file)], input=svg.encode(), capture_output=True,
                              check=False)
    except FileNotFoundError:
        raise Failure(f"{file} can't be drawn: rsvg-convert is not installed (Debian's package librsvg2-bin)") from None
    if done.returncode != 0:
        raise Failure(f"rsvg-convert can't draw {file}: {done.stderr.decode(errors='replace').strip()}")


def apart(places, gap):
    """The places of labels, in order, moved as little as possible to keep them `gap` apart."""
    order = sorted(range(len(places)), key=lambda k: places[k])
    out = list(places)
    for before, k in zip(order, order[1:]):
        out[k] = max(out[k], out[before] + gap)
    over = out[order[-1]] - max(places) if order else 0
    return [y - over / 2 for y in out]


def nice_ticks(low, high, most=8):
    """Round numbers from low to high."""
    step = 10 ** math.floor(math.log10(max(1e-12, high - low)))
    for smaller in (0.1, 0.2, 0.5, 1, 2):
        if (high - low) / (step * smaller) <= most:
            step *= smaller
            break
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, int(math.floor(high / step + 1e-9)) + 1)]


def history(title, labels, lines, unit):
    """`lines` maps names to values, one per label, None if there is none; draws them relative to the first one."""
    canvas = Canvas(1100, 440)
    left, right, top, bottom = 70, 850, 60, 370
    values = [v for line in lines.values() for v in line if v is not None] + [1.0]
    low, high = min(values), max(values)
    margin = max(0.02, 0.08 * (high - low))
    low, high = low - margin, high + margin
    x = lambda k: left + (right - left) * (k / max(1, len(labels) - 1) if len(labels) > 1 else 0.5)
    y = lambda v: bottom - (bottom - top) * (v - low) / (high - low)
    canvas.text(left, 28, title, size=16, bold=True)
    canvas.text(left, 47, unit, QUIET, 12)
    for tick in nice_ticks(low, high):
        canvas.line(left, y(tick), right, y(tick), INK if abs(tick - 1) < 1e-9 else FAINT, 1)
        canvas.text(left - 8, y(tick) + 4, f"{tick:.3g}", QUIET, 12, "end")
    every = max(1, math.ceil(len(labels) / 9))
    for k, label in enumerate(labels):
        if k % every == 0 or k == len(labels) - 1:
            canvas.text(x(k), bottom + 22, label[0], QUIET, 12, "middle")
            canvas.text(x(k), bottom + 38, label[1], QUIET, 11, "middle")
    ends, names = [], []
    for k, (name, line) in enumerate(lines.items()):
        points = [(x(i), y(v)) for i, v in enumerate(line) if v is not None]
        if not points:
            continue
        colour = COLOURS[k % len(COLOURS)]
        canvas.path(points, colour)
        for i, v in enumerate(line):
            if v is not None:
                canvas.dot(x(i), y(v), colour, 3.5, f"{name}, {labels[i][0]}: {v:.3f}")
        ends.append(points[-1])
        names.append((name, colour, next(v for v in reversed(line) if v is not None)))
    for (px, py), place, (name, colour, value) in zip(ends, apart([e[1] for e in ends], 17), names):
        canvas.line(px + 6, py, right + 18, place, FAINT)
        canvas.text(right + 22, place + 4, f"{name}  {value:.2f}", colour, 13)
    return canvas.svg()


def spark(values):
    """A case's history in a row of a table; None if a record lacks it."""
    width, height = 120, 22
    known = [v for v in values if v is not None]
    low, high = min(known), max(known)
    span = max(high - low, 0.1 * high)
    middle = (low + high) / 2
    x = lambda k: 4 + (width - 8) * k / max(1, len(values) - 1)
    y = lambda v: height / 2 - (v - middle) / span * (height - 8)
    points = [(x(k), y(v)) for k, v in enumerate(values) if v is not None]
    steps = " ".join(f"{px:.1f},{py:.1f}" for px, py in points)
    return (f"<svg class='spark' viewBox='0 0 {width} {height}' width='{width}' height='{height}'><polyline points='{steps}' "
            f"fill='none' stroke='{COLOURS[0]}' stroke-width='1.5'/><circle cx='{points[-1][0]:.1f}' "
            f"cy='{points[-1][1]:.1f}' r='2.5' fill='{COLOURS[0]}'/></svg>")


class LogAxis:
    def __init__(self, low, high, start, end):
        self.low, self.high, self.start, self.end = low, high, start, end

    def __call__(self, value):
        share = math.log(value / self.low) / math.log(self.high / self.low)
        return self.start + (self.end - self.start) * share

    def ticks(self):
        decade = 10 ** math.floor(math.log10(self.low))
        while decade <= self.high * 1.0001:
            for step in (1, 2, 5):
                if self.low * 0.9999 <= decade * step <= self.high * 1.0001:
                    yield decade * step
            decade *= 10


def ratios(title, rows):
    """Bars on a logarithmic axis: `rows` of (label, ratio). Left of 1 the other program is the faster one."""
    height = 80 + 24 * len(rows)
    canvas = Canvas(1100, height)
    left, right, top, bottom = 600, 1030, 62, height - 18
    low = min([0.5] + [r / 1.3 for _, r in rows])
    high = max([2.0] + [r * 1.3 for _, r in rows])
    x = LogAxis(low, high, left, right)
    canvas.text(20, 28, title, size=16, bold=True)
    canvas.text(20, 47, "how many times as fast Tessera is; left of 1 it is slower", QUIET, 12)
    for tick in x.ticks():
        if f"{tick:e}"[0] == "1" or high / low < 30:
            canvas.line(x(tick), top, x(tick), bottom, INK if tick == 1 else FAINT)
            canvas.text(x(tick), top - 4, f"{tick:g}", QUIET, 11, "middle")
    for k, (label, ratio) in enumerate(rows):
        at = top + 6 + 24 * k
        canvas.text(left - 10, at + 13, label, INK, 12, "end")
        colour = COLOURS[0] if ratio >= 1 else COLOURS[1]
        canvas.bar(min(x(1), x(ratio)), at, abs(x(ratio) - x(1)), 16, colour, f"{label}: {ratio:.3g}")
        canvas.text(max(x(1), x(ratio)) + 6, at + 13, f"{ratio:.3g}", INK, 12)
    return canvas.svg()
