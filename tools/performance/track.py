"""track: the figures of a program that is not Tessera's. engine/docs/tracking-speed.md says what it must print."""

import datetime
import math
import os
import shutil
from pathlib import Path

from . import json_file, machine, process, records
from .console import GOOD, Failure, say
from .repository import commit_of, describe, is_dirty

SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
FACTS = ("compiler", "flags", "build_type", "isa", "version")
CONTRACT = "engine/docs/tracking-speed.md says what a tracked program prints"
ADVICE = "a program that uses Google Benchmark needs the argument --benchmark_format=json"


def rate_of(entry, origin):
    """Items per second; calls per second if the case counts no items."""
    key = "items_per_second" if "items_per_second" in entry else "real_time"
    value, unit = entry.get(key), entry.get("time_unit", "ns")
    if not json_file.is_positive(value):
        raise Failure(f"{origin} has the {key} {value}; it must be a finite number above 0")
    if key == "items_per_second":
        return value
    if unit not in SECONDS:
        raise Failure(f"{origin} has the time_unit '{unit}'; it must be one of {', '.join(SECONDS)}")
    return 1 / (value * SECONDS[unit])


def entry_of(found, origin):
    """The entry of a record for an entry of Google Benchmark's JSON."""
    if found.get("error_occurred"):
        raise Failure(f"{origin} failed its check: {found.get('error_message', 'no message')}")
    entry = {"rate": float(f"{rate_of(found, origin):.5g}")}
    limit = found.get("limit_fraction")
    if limit is not None:
        if not isinstance(limit, (int, float)) or not 0 <= limit < math.inf:
            raise Failure(f"{origin} has the limit_fraction {limit}; it must be a finite number, 0 or above")
        entry["limit_fraction"] = float(f"{limit:.3g}")
    return entry


def cases_of(content, origin):
    """Maps names to entries of a record. A case that is repeated counts by its best rate; aggregates don't count."""
    benchmarks = content.get("benchmarks") if isinstance(content, dict) else None
    if not isinstance(benchmarks, list):
        raise Failure(f"{origin} printed JSON without a list \"benchmarks\": {CONTRACT}")
    cases = {}
    for number, found in enumerate(benchmarks):
        name = found.get("name") if isinstance(found, dict) else None
        if not isinstance(name, str) or not name:
            raise Failure(f"{origin} printed benchmarks[{number}] without a \"name\": {CONTRACT}")
        if found.get("run_type") == "aggregate":
            continue
        entry = entry_of(found, f"{origin}: case '{name}'")
        if name not in cases or entry["rate"] > cases[name]["rate"]:
            cases[name] = entry
    if not cases:
        raise Failure(f"{origin} printed no case: its list \"benchmarks\" is empty")
    return cases


def facts_of(content):
    context = content.get("context")
    return {key: str(context[key]) for key in FACTS if key in context} if isinstance(context, dict) else {}


def run(program, words, limit):
    """(cases, facts) of one run."""
    done = process.start(program, *words, limit=limit)
    if done.returncode != 0:
        raise Failure(f"{program} ended with {process.ending(done)}")
    if not done.stdout.strip():
        raise Failure(f"{program} printed nothing on standard output: {CONTRACT}; {ADVICE}")
    try:
        content = json_file.parse(done.stdout, f"what {program} printed")
    except Failure as failure:
        first = done.stdout.strip().splitlines()[0][:60]
        raise Failure(f"{failure}; it begins with '{first}'. {CONTRACT}; {ADVICE}") from None
    return cases_of(content, program), facts_of(content)


def best(program, words, limit, passes):
    """The best figures of several runs, which must have the same cases."""
    cases, facts = run(program, words, limit)
    for number in range(2, passes + 1):
        again, _ = run(program, words, limit)
        if again.keys() != cases.keys():
            odd = sorted(again.keys() ^ cases.keys())[0]
            raise Failure(f"{program}: case '{odd}' is not in all runs: run 1 has {len(cases)} cases, run {number} has "
                          f"{len(again)}")
        for name, entry in cases.items():
            rates = entry.get("passes", [entry["rate"]]) + [again[name]["rate"]]
            cases[name] = {**max(entry, again[name], key=lambda e: e["rate"]), "passes": rates}
    return cases, facts


def origin_of(said):
    """(commit, whether the tree had changes, its date, its first line) in the current folder; or the version `said`."""
    here = os.getcwd()
    try:
        short, seconds, subject = describe(commit_of(said or "HEAD", cwd=here), cwd=here)
    except Failure:
        if said is None:
            raise Failure(f"{here} is in no git repository with a commit: start tools/perf in the program's "
                          "repository, or name the version by --of TEXT") from None
        return said, False, int(datetime.datetime.now().timestamp()), ""
    return short, said is None and is_dirty(here), seconds, subject


def command(arguments):
    program = shutil.which(arguments.tracked) or shutil.which(os.path.join(".", arguments.tracked))
    if program is None:
        raise Failure(f"{arguments.tracked} is no program: there is no such file, or it is not executable")
    short, dirty, seconds, subject = origin_of(arguments.of)
    if machine.busy():
        say(machine.busy() + "; rates are lower than they need be")
    cases, facts = best(program, arguments.arguments, arguments.time_limit, arguments.passes)
    content = {"program": arguments.name or Path(program).name, "commit": short, "dirty": dirty, "commit_time": seconds,
               "subject": subject, "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M:%S"),
               "machine": machine.describe(), "facts": facts, "cases": cases}
    path = arguments.output or records.new_file(arguments.records, content["date"], short)
    json_file.write(path, content)
    print(f"{len(cases)} {'case' if len(cases) == 1 else 'cases'} of {content['program']}: {path}")
    return GOOD
