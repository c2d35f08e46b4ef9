"""The records that record and track keep: read and checked, chosen by machine and program, and listed."""

import re
from pathlib import Path

from . import json_file, machine, roofline
from .console import FAILED, GOOD, Failure, say, table
from .repository import WORK

KEYS = ("commit", "date", "machine", "facts", "cases")
OWN = "tessera_bench"
TRACKED = "perf-records"  # where track keeps records, in the folder where it is started
ADVICE = "delete the file, or record again"
NOTHING = ("nothing was recorded yet: tools/perf record, or tools/perf track for programs that are not "
           "Tessera's")


def read_one(file):
    """A record with fields of the right types. None if there is no such file."""
    try:
        content = json_file.read(file, KEYS)
    except Failure as failure:
        raise Failure(f"{failure}: {ADVICE}") from None
    if content is None:
        return None
    for key, kind in (("commit", str), ("date", str), ("machine", dict), ("facts", dict), ("cases", dict)):
        if not isinstance(content[key], kind):
            raise Failure(f"{file}: \"{key}\" is {type(content[key]).__name__}; it must be {kind.__name__}: {ADVICE}")
    for case, entry in content["cases"].items():
        rate = entry.get("rate") if isinstance(entry, dict) else None
        if not json_file.is_positive(rate):
            raise Failure(f"{file}: the rate of case '{case}' is {rate}; it must be a finite number above 0: {ADVICE}")
        passes = entry.get("passes", [rate])
        if not isinstance(passes, list) or not passes or not all(map(json_file.is_positive, passes)):
            raise Failure(f"{file}: the passes of case '{case}' must be finite numbers above 0: {ADVICE}")
    if content.get("roofline"):
        roofline.checked(content["roofline"], f"{file}: roofline")
    return content


def files_of(names, folder):
    """The files for names of records and of folders of records; by default those of track in this folder, or Tessera's
    own records and baselines."""
    if not names and sorted(Path(TRACKED).glob("*.json")):
        names = [TRACKED]
    if not names:
        return sorted((WORK / "records").glob("*.json")) + sorted(Path(folder).glob("*/times.json"))
    files = []
    for name in map(Path, names):
        found = sorted(name.glob("*.json")) if name.is_dir() else [name]
        if not found:
            raise Failure(f"the folder {name} holds no record (*.json): tools/perf track --records {name} keeps some "
                          "there")
        files += found
    return files


def age(record):
    return record.get("commit_time") or 0, record["date"]


def read(names, folder):
    """Records in the order of their commits' dates."""
    records = []
    for file in files_of(names, folder):
        content = read_one(file)
        if content is None:
            raise Failure(f"there is no record {file}")
        if content not in records:  # a baseline may repeat a record that is still there
            records.append(content)
    return sorted(records, key=age)


def program_of(record):
    return record.get("program", OWN)


def place_of(record):
    """The machine and the instruction set in words. Figures of different places are not comparable."""
    isa = record["facts"].get("isa")
    return machine.title(record["machine"]) + (f", {isa}" if isa else "")


def names_of(records):
    """The programs and places of records, with the number of records of each."""
    counts = {}
    for record in records:
        kind = f"{program_of(record)} on {place_of(record)}"
        counts[kind] = counts.get(kind, 0) + 1
    return "; ".join(f"{kind} ({number} record{'' if number == 1 else 's'})" for kind, number in counts.items())


def choose(records, machine_text=None, program=None):
    """The records of the newest one's program, machine and instruction set, among those asked for; and the others."""
    fit = [r for r in records if (machine_text is None or machine_text.lower() in place_of(r).lower())
           and (program is None or program_of(r) == program)]
    if records and not fit:
        asked = {"--machine": machine_text, "--program": program}
        wanted = " ".join(f"{name} {text}" for name, text in asked.items() if text is not None)
        raise Failure(f"no record fits {wanted}; there are {names_of(records)}")
    kind = lambda r: (program_of(r), place_of(r))
    kept = [r for r in fit if kind(r) == kind(fit[-1])]
    return kept, [r for r in fit if kind(r) != kind(fit[-1])]


def left_out(others):
    """A sentence about records that are not comparable with the newest one."""
    return (f"{len(others)} {'record is' if len(others) == 1 else 'records are'} left out, of another machine, "
            f"instruction set or program than the newest one: {names_of(others)}. --machine TEXT and --program NAME "
            "choose.")


def chosen(arguments):
    """The records that the command line asks for; says which ones are left out."""
    kept, others = choose(read(arguments.records, arguments.baselines), arguments.machine, arguments.program)
    if others:
        say("perf: " + left_out(others))
    if kept and machine.title(kept[-1]["machine"]) != machine.title():
        say(f"perf: the figures are of {place_of(kept[-1])}; this machine is {machine.title()}")
    return kept, others


def new_file(folder, date, commit):
    """A name that no record has yet."""
    stem = re.sub(r"[^A-Za-z0-9.+-]+", "_", f"{date.replace(':', '')}_{commit}")
    names = [stem, *(f"{stem}_{k}" for k in range(2, 1000))]
    return next(file for name in names if not (file := Path(folder) / f"{name}.json").exists())


def command(arguments):
    """list: a line of text for each record, the oldest first."""
    found, faults = [], 0
    for file in files_of(arguments.records, arguments.baselines):
        try:
            content = read_one(file)
            if content is None:
                raise Failure(f"there is no record {file}")
            found.append((content, file))
        except Failure as failure:
            faults += 1
            say(f"perf: {failure}")
    rows = [("date", "commit", "program", "machine", "cases", "file")]
    for content, file in sorted(found, key=lambda pair: age(pair[0])):
        commit = content["commit"] + ("+" if content.get("dirty") else "")
        rows.append((content["date"], commit, program_of(content), place_of(content), str(len(content["cases"])),
                     str(file)))
    if found:
        print(table(rows, right=(4,)))
    elif not faults:
        say("perf: " + NOTHING)
    return FAILED if faults else GOOD
