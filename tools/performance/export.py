"""export: the newest record's figures in the format of another tool."""

import json

from . import json_file, records
from .console import GOOD, Failure

FORMATS = ("github-action-benchmark",)


def github_action_benchmark(record, figure):
    """The entries of the tools customBiggerIsBetter (rates) and customSmallerIsBetter (times) of that action."""
    entries = []
    for case, entry in sorted(record["cases"].items()):
        rate, limit = entry["rate"], entry.get("limit_fraction")
        extra = [f"{limit:.3g} of the machine's limit"] if limit is not None else []
        entries.append({"name": case, "unit": "items/s" if figure == "rate" else "ns/item",
                        "value": rate if figure == "rate" else float(f"{1e9 / rate:.5g}"),
                        "extra": "\n".join([*extra, records.place_of(record)])})
    return entries


def command(arguments):
    found, _ = records.chosen(arguments)
    if not found:
        raise Failure(records.NOTHING)
    content = github_action_benchmark(found[-1], arguments.figure)
    if arguments.output:
        json_file.write(arguments.output, content)
        print(f"{len(content)} cases of {found[-1]['commit']}: {arguments.output}")
    else:
        print(json.dumps(content, indent=1))
    return GOOD
