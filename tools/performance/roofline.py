"""The roofline (Williams, Waterman and Patterson, Communications of the ACM 52, 2009) as tessera_bench
--roofline=FILE.json measures it: operations per second over operations per byte written.
"""

from pathlib import Path

from . import json_file
from .console import GOOD, Failure
from .labels import Box, Labels, around
from .plots import COLOURS, FAINT, INK, QUIET, Canvas, LogAxis, write_png

LEFT, RIGHT, TOP, BOTTOM = 70, 1060, 70, 500
SIZE = 13
CEILING_FROM = 0.6  # operations per byte at which the ceilings of instruction sets begin


RATES = {"isas": ("float_operations", "plain_store", "streaming_store"), "points": ("per_byte", "operations", "points")}


def checked(content, origin):
    """What tessera_bench --roofline=FILE.json wrote, with all fields that the plot needs."""
    def need(good, field):
        if not good:
            raise Failure(f"{origin}: {field} is missing or of the wrong kind; write the file anew by "
                          "'tessera_bench --roofline=FILE.json'")

    need(isinstance(content, dict), "the object of the roofline")
    need(json_file.is_positive(content.get("cache_store")), "cache_store")
    need(isinstance(content.get("machine"), str), "machine")
    for key, rates in RATES.items():
        rows = content.get(key)
        need(isinstance(rows, list) and rows and all(isinstance(row, dict) for row in rows), key)
        for row in rows:
            need(isinstance(row.get("isa" if key == "isas" else "name"), str), f"a name in {key}")
            for rate in rates:
                need(json_file.is_positive(row.get(rate)), f"{rate} in {key}")
    need(all(isinstance(row.get("in_cache"), bool) for row in content["points"]), "in_cache in points")
    return content


class Chart:
    """The axes with their ticks, and the labels placed so far."""

    def __init__(self, content):
        self.content, self.canvas = content, Canvas(1100, 560)
        self.peak = content["isas"][-1]["float_operations"]
        self.x = LogAxis(0.1, 10, LEFT, RIGHT)
        self.y = LogAxis(1e-9 * self.peak / 100, 2e-9 * self.peak, BOTTOM, TOP)
        self.labels = Labels(Box(LEFT, TOP, RIGHT, BOTTOM))

    def axes(self):
        self.canvas.text(LEFT, 28, f"{self.content['machine']}, one thread", size=16, bold=True)
        self.canvas.text(LEFT, 48, "G multiply-adds a second, over multiply-adds a byte written", QUIET, 12)
        for tick in self.x.ticks():
            self.canvas.line(self.x(tick), TOP, self.x(tick), BOTTOM)
            self.canvas.text(self.x(tick), BOTTOM + 20, f"{tick:g}", QUIET, 12, "middle")
        for tick in self.y.ticks():
            self.canvas.line(LEFT, self.y(tick), RIGHT, self.y(tick))
            self.canvas.text(LEFT - 8, self.y(tick) + 4, f"{tick:g}", QUIET, 12, "end")

    def path(self, points, colour, width):
        self.canvas.path(points, colour, width)
        self.labels.keep_off_path(points)

    def label(self, words, colour, size, place):
        """Writes a label. One without a place is left out: the tooltip of its mark names it too."""
        if place:
            x, y, anchor = place
            self.canvas.text(x, y, words, colour, size, anchor, halo=True)

    def height(self, operations):
        """The height of a rate, within the plot."""
        return self.y(min(self.y.high, max(self.y.low, 1e-9 * operations)))

    def ceilings(self):
        """The multiply-adds of each instruction set."""
        heights = [(isa["isa"], self.height(isa["float_operations"])) for isa in self.content["isas"]]
        for _, height in heights:
            self.path([(self.x(CEILING_FROM), height), (RIGHT, height)], INK, 1.5)
        return heights

    def roof(self, rate):
        """The slope and the flat part of one store bandwidth: (points, the slope's two ends)."""
        edge = min(10.0, self.peak / rate)
        start = min(max(0.1, 1e9 * self.y.low / rate), edge)
        slope = [(self.x(o), self.height(rate * o)) for o in (start, edge)]
        return slope + [(RIGHT, slope[-1][1])] if edge < 10 else slope, slope

    def draw_points(self):
        marks = []
        for p in self.content["points"]:
            x, y = self.x(min(10, max(0.1, p["per_byte"]))), self.height(p["operations"])
            marks.append((p, x, y, COLOURS[0 if p["in_cache"] else 1]))
            self.labels.keep_off_mark(x, y, 7)
        return marks


def along(height):
    """Places for the label of a horizontal line: above it and below it, from the right to the left."""
    for step in range(0, 16):
        for dy in (-8, SIZE + 6):
            yield RIGHT - 4 - 30 * step, height + dy, "end"


def beside(slope, below):
    """Places for the label of a slope, from low to high: below it to the right, or above it to the left."""
    (x0, y0), (x1, y1) = slope
    for gap in (12, 18, 30):
        for k in range(2, 39):
            x, y = x0 + (x1 - x0) * k / 40, y0 + (y1 - y0) * k / 40
            yield (x + gap, y + gap, "start") if below else (x - gap, y - 8, "end")


def draw(content):
    """The plot as SVG. Its lines and marks come first, then the labels, which keep off all of them."""
    chart = Chart(content)
    fastest = content["isas"][-1]
    chart.axes()
    ceilings = chart.ceilings()
    stores = max(fastest["plain_store"], fastest["streaming_store"])
    slopes = []
    for label, rate, colour in (("to the cache", content["cache_store"], COLOURS[0]),
                                ("to memory", stores, COLOURS[1])):
        points, slope = chart.roof(rate)
        chart.path(points, colour, 2)
        slopes.append((f"{1e-9 * rate:.3g} GB/s {label}", colour, slope, label == "to memory"))
    marks = chart.draw_points()
    for words, colour, slope, below in slopes:
        candidates = [*beside(slope, below), *beside(slope, not below)]
        chart.label(words, colour, SIZE, chart.labels.place(words, SIZE, candidates))
    for name, height in ceilings:
        chart.label(name, INK, SIZE, chart.labels.place(name, SIZE, along(height)))
    places = chart.labels.place_all([(p["name"], 12, list(around(x, y))) for p, x, y, _ in marks])
    for place, (_, x, y, _) in zip(places, marks):
        if place and abs(place[0] - x) + abs(place[1] - y) > 40:
            chart.canvas.line(x, y, place[0], place[1] - 4, FAINT)
    for place, (p, _, _, colour) in zip(places, marks):
        chart.label(p["name"], colour, 12, place)
    for p, x, y, colour in marks:
        chart.canvas.dot(x, y, colour, 5.5, f"{p['name']}: {1e-6 * p['points']:.0f} M points/s")
    return chart.canvas.svg()


def command(arguments):
    content = json_file.read(arguments.measured)
    if content is None:
        raise Failure(f"there is no {arguments.measured}: 'tessera_bench --roofline={arguments.measured}' writes it")
    svg = draw(checked(content, arguments.measured))
    output = Path(arguments.output or Path(arguments.measured).with_suffix(".svg"))
    if output.suffix not in (".svg", ".png"):
        raise Failure(f"{output}: the name must end in .svg or .png")
    if output.suffix == ".png":
        write_png(svg, output)
    else:
        json_file.write_text(output, svg)
    print(output)
    return GOOD
