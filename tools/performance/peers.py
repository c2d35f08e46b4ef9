"""peers: one table of the results of tools/peers.sh, with date, machine and versions."""

import datetime

from . import json_file, machine
from .console import GOOD, Failure, scaled

KEYS = ("task", "peer", "way", "rate", "against", "ratio", "main")


def read_lines(path):
    """Lines of JSON as bench/peers/results.h writes them."""
    try:
        with open(path, encoding="utf-8") as file:
            lines = [line for line in file if line.strip()]
    except (OSError, UnicodeDecodeError) as error:
        raise Failure(f"{path} can't be read: {error}") from None
    rows = []
    for number, line in enumerate(lines, 1):
        row = json_file.parse(line, f"line {number} of {path}")
        missing = [key for key in KEYS if not isinstance(row, dict) or key not in row]
        if missing:
            raise Failure(f"line {number} of {path} has no \"{missing[0]}\"")
        rows.append(row)
    if not rows:
        raise Failure(f"{path} holds no comparison")
    return rows


def ratio_text(ratio):
    """A ratio with three digits."""
    return f"{ratio:.0f}" if ratio >= 100 else f"{ratio:.3g}"


def markdown(content):
    """The table as Markdown: one row for each way of a peer, with Tessera's ways side by side."""
    lines = [f"{content['date']}, {content['machine']}, one thread each, in turns:", "",
             "| task | program | its rate a second | how many times as fast Tessera is |", "| --- | --- | --- | --- |"]
    groups = {}
    for row in content["rows"]:
        groups.setdefault((row["task"], row["peer"], row["way"]), []).append(row)
    for (task, peer, way), rows in groups.items():
        ratios = ", ".join(f"{r['against']} {ratio_text(r['ratio'])}" for r in rows)
        lines.append(f"| {task} | {peer}, {way} | {scaled(rows[0]['rate'])} | {ratios} |")
    return "\n".join(lines)


def command(arguments):
    content = {"date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d"),
               "machine": machine.title(), "rows": read_lines(arguments.results)}
    if arguments.output:
        json_file.write(arguments.output, content)
    print(markdown(content))
    return GOOD
