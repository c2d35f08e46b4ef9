"""record: the suite's figures of one build as JSON, with the facts that they depend on."""

import datetime

from . import baselines, builds, json_file, machine, process, records, roofline, suite
from .console import GOOD, Failure, Progress, say
from .repository import WORK, commit_of, describe, is_dirty


def rounded(value, digits=5):
    return float(f"{value:.{digits}g}")


def entry_of(case, rates):
    entry = {"rate": rounded(case.rate)}
    if len(rates) > 1:
        entry["passes"] = rates
    if case.limit_fraction is not None:
        entry["limit_fraction"] = rounded(case.limit_fraction, 3)
    return entry


def origin_of(build, said):
    """(commit, whether the tree had changes, its date, its first line). For a user's own program: the commit `said`."""
    if build.commit is None:
        commit, dirty = commit_of(said or "HEAD"), said is None
    else:
        commit, dirty = build.commit, build.dirty and is_dirty()
    short, seconds, subject = describe(commit)
    return short, dirty, seconds, subject


def fastest_isa(cases):
    """The fastest instruction set in the names of the cases, for programs that do not print facts."""
    named = {name.split("/")[-2] for name in cases}
    return next((isa for isa in ("avx512", "avx2", "sse2", "neon64") if isa in named), "unknown")


def measure(build, cases, seconds, limits, passes):
    """The best of several passes over all cases, since a busy moment affects only one of them; and all of their rates."""
    groups = [cases[k:k + 6] for k in range(0, len(cases), 6)]
    progress = Progress(len(groups) * passes)
    best, rates = {}, {}
    for _ in range(passes):
        for group in groups:
            progress.step(f"runs {group[0]} and {len(group) - 1} more")
            for name, case in suite.run(build.program, group, seconds, limits).items():
                if case.rate == 0:
                    raise Failure(f"{name} reports no items a second")
                rates.setdefault(name, []).append(rounded(case.rate))
                if name not in best or case.rate > best[name].rate:
                    best[name] = case
    progress.end()
    return best, rates


def roofline_of(build):
    file = WORK / "roofline.json"
    file.parent.mkdir(parents=True, exist_ok=True)
    done = process.start(build.program, f"--roofline={file}")
    if done.returncode != 0:
        raise Failure(f"{build.program} --roofline failed: {done.stderr.strip()}")
    return roofline.checked(json_file.read(file), file)


def command(arguments):
    if arguments.of and not builds.is_program(arguments.commit):
        raise Failure("--of is for programs; a commit is of itself")
    build = builds.build(arguments.commit, arguments.preset, jobs=arguments.jobs)
    facts = suite.facts(build.program)
    if facts.get("planted_slowdown"):
        raise Failure(f"{build.program} was built with TESSERA_PLANT_SLOWDOWN: its figures are nobody's")
    cases = suite.names(build.program, arguments.set, arguments.filter)
    facts.setdefault("isa", fastest_isa(suite.names(build.program)))
    if machine.busy():
        say(machine.busy() + "; rates are lower than they need be")
    found, rates = measure(build, cases, arguments.seconds, not arguments.no_limits, arguments.passes)
    short, dirty, seconds, subject = origin_of(build, arguments.of)
    content = {"commit": short, "dirty": dirty, "commit_time": seconds, "subject": subject,
               "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d %H:%M:%S"),
               "machine": machine.describe(), "facts": facts,
               "cases": {name: entry_of(case, rates[name]) for name, case in found.items()}}
    if arguments.roofline:
        content["roofline"] = roofline_of(build)
    if arguments.baseline:
        path = baselines.times_file(machine.slug(), facts["isa"])
    else:
        path = arguments.output or records.new_file(WORK / "records", content["date"], short)
    json_file.write(path, content)
    print(f"{len(found)} cases of {build.label}: {path}")
    return GOOD
