"""The command line of tools/perf."""

import argparse

from . import baselines, check, compare, count, export, own_program, peers, record, records, report, roofline, serial, track
from .console import FAILED, GOOD, REGRESSION, SKIPPED, USAGE, Failure, say

DESCRIPTION = """\
Catches what makes Tessera slower, on machines that do other things as well.

  tools/perf compare main .                  is this tree slower than main? Builds both, runs them in turns
  tools/perf compare v1 . --program my_bench  the same of a program that is not Tessera's
  tools/perf count --check                   does a counted case take more instructions?
  tools/perf serial tessellate a.bpt -o a.ply  which of its stages run on one thread?
  tools/perf record --roofline               this build's figures, kept in build/perf/records
  tools/perf track ./my_bench                the figures of a program that is not Tessera's, kept in perf-records
  tools/perf check                           is the newest record slower than those before it?
  tools/perf list                            what was recorded: date, commit, machine, cases
  tools/perf report                          a page of what was recorded: history, roofline, peers
  tools/perf export                          the newest figures, for github-action-benchmark
"""
STATUS = f"""\
exit status: {GOOD} good, {REGRESSION} something is slower, {USAGE} wrong arguments, {FAILED} could not be done (a build, a program, a file),
{SKIPPED} count --check was skipped: no valgrind, or the baseline is of another compiler or other libraries
"""


def number(low, high, whole=False):
    """A type for argparse: a number within a range."""
    def parse(text):
        try:
            value = int(text) if whole else float(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{text}' is no {'whole ' if whole else ''}number") from None
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text} is not within {low} to {high}")
        return value
    return parse


def option(text):
    name, equals, value = text.partition("=")
    if not name or not equals or not value:
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=VALUE")
    return text


def add_build_options(parser):
    parser.add_argument("--preset", default="release", help="CMake preset to build (default: release)")
    parser.add_argument("--jobs", type=number(1, 1024, True), metavar="N", help="number of parallel compilations")


def add_compare(commands):
    parser = commands.add_parser(
        "compare", help="two builds, run in turns", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Builds BASE and HEAD (kept in build/perf, used again), runs them in turns A B B A, and prints the median of the "
        "ratios of\ntheir times with its 95% bootstrap interval. What looks slower is run again for twice as long, which then counts.\n"
        "Exit status 1 where a case is slower by more than the threshold and 1 lies below the interval.",
        epilog="BASE and HEAD: a commit, '.' for this tree, or the path of a tessera_bench that is built already.\n"
        "example: tools/perf compare main . --filter '^evaluate.*/bicubic1000/'\n" + STATUS)
    parser.add_argument("base", metavar="BASE")
    parser.add_argument("head", metavar="HEAD")
    parser.add_argument("--set", choices=("quick", "full"), default="quick", help="of the suite (default: quick)")
    parser.add_argument("--filter", metavar="REGEX", help="cases whose name it finds")
    parser.add_argument("--threshold", type=number(0, 1000), default=1.5, metavar="PERCENT", help="default: 1.5")
    parser.add_argument("--quads", type=number(2, 1000, True), default=6, metavar="N",
                        help="turns A B B A of each case; twice as many where it looks slower (default: 6)")
    parser.add_argument("--seconds", type=number(0.001, 100), default=0.1, metavar="S",
                        help="of a case in one turn (default: 0.1)")
    for who in ("base", "head"):
        parser.add_argument(f"--{who}-option", action="append", default=[], type=option, metavar="NAME=VALUE",
                            help=f"for CMake, of {who} alone")
    parser.add_argument("--rebuild", action="store_true", help="rebuild kept builds")
    parser.add_argument("--json", metavar="FILE", help="the ratios as JSON too")
    add_build_options(parser)
    own = parser.add_argument_group(
        "a program that is not Tessera's", "BASE and HEAD are then commits of the repository in the current folder, or "
        "'.'. Each run has all cases; builds of commits stay in .git/perf-builds.")
    own.add_argument("--program", dest="own", metavar="COMMAND",
                     help="starts the program, from the root of the commit's folder: 'build/speed --json'")
    own.add_argument("--build", metavar="COMMAND", help="builds it there, by the shell: 'cmake -B build && cmake "
                     "--build build' (default: it is built already)")
    own.add_argument("--time-limit", type=number(1, 86400), default=600, metavar="S", help="of a run (default: 600)")
    parser.set_defaults(run=lambda arguments: (own_program if arguments.own else compare).command(arguments))


def add_count(commands):
    parser = commands.add_parser(
        "count", help="instructions of fixed work, by valgrind", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Counts the instructions of the counted cases (bench/counting.cpp), one thread, on AVX2 and on SSE2. The same on busy\n"
        "machines as on idle ones. Counts depend on compiler, flags and libraries: the baselines in bench/baselines say which.",
        epilog=STATUS)
    parser.add_argument("--program", metavar="FILE", help="a tessera_bench (default: this tree's build of the preset)")
    parser.add_argument("--preset", default="dev", help="whose build (default: dev, what tools/test.sh builds)")
    parser.add_argument("--isa", action="append", choices=count.ISAS, help="on this one alone")
    parser.add_argument("--filter", metavar="REGEX", help="cases whose name it finds")
    parser.add_argument("--repeat", type=number(1, 100, True), default=1, metavar="N",
                        help="number of processes; prints how much they differ")
    parser.add_argument("--check", action="store_true", help="exit status 1 where a count is above the baseline's")
    parser.add_argument("--threshold", type=number(0, 1000), default=1.0, metavar="PERCENT",
                        help="that a count may grow by (default: 1)")
    parser.add_argument("--update", action="store_true", help="write the baselines")
    parser.add_argument("--baselines", default=baselines.FOLDER, metavar="FOLDER",
                        help="default: bench/baselines")
    parser.set_defaults(run=count.command)


def add_serial(commands):
    parser = commands.add_parser(
        "serial", help="which stages of the command line run on one thread",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Counts the instructions of 'tessera tessellate', stage by stage, and of them those that only one thread can do,\n"
        "by valgrind with AVX2. They bound what more threads gain. Work of the system, as for files and pages, is not counted.",
        epilog="Example: tools/perf serial tessellate tools/models/teapot.bpt -o /tmp/teapot.ply --tolerance 1e-4\n" + STATUS)
    parser.add_argument("--program", metavar="FILE", help="a tessera (default: this tree's build of the preset)")
    parser.add_argument("--preset", default="dev", help="whose build (default: dev, what tools/test.sh builds)")
    parser.add_argument("arguments", nargs=argparse.REMAINDER, metavar="tessellate ...", help="the command")
    parser.set_defaults(run=serial.command)


def add_record(commands):
    parser = commands.add_parser(
        "record", help="the suite's figures of one build, as JSON", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Runs the suite and keeps its rates with machine, instruction set, compiler, libraries and commit.",
        epilog=STATUS)
    parser.add_argument("commit", nargs="?", default=".", metavar="COMMIT",
                        help="a commit, '.' for this tree (the default), or a tessera_bench that is built already")
    parser.add_argument("--set", choices=("quick", "full"), default="quick", help="of the suite (default: quick)")
    parser.add_argument("--filter", metavar="REGEX", help="cases whose name it finds")
    parser.add_argument("--seconds", type=number(0.001, 100), default=0.1, metavar="S", help="of a case (default: 0.1)")
    parser.add_argument("--passes", type=number(1, 100, True), default=1, metavar="N",
                        help="over all cases, of which the best counts (default: 1)")
    parser.add_argument("--no-limits", action="store_true", help="without the distance to the machine's limits: quicker")
    parser.add_argument("--roofline", action="store_true", help="with the machine's roofline")
    parser.add_argument("--of", metavar="COMMIT", help="what a program that is built already was built from")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("-o", "--output", metavar="FILE", help="default: build/perf/records/DATE_COMMIT.json")
    where.add_argument("--baseline", action="store_true", help="into bench/baselines/MACHINE_ISA/times.json")
    add_build_options(parser)
    parser.set_defaults(run=record.command)


def add_track(commands):
    parser = commands.add_parser(
        "track", help="the figures of a program that is not Tessera's",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Runs PROGRAM, which must print the JSON of Google Benchmark to standard output, and keeps its\n"
        "rates with machine, commit and date. engine/docs/tracking-speed.md says which fields count.",
        epilog="The program's arguments come last: tools/perf track --passes 3 ./my_bench --benchmark_format=json\n"
        + STATUS)
    parser.add_argument("tracked", metavar="PROGRAM", help="a file, or a name in PATH")
    parser.add_argument("arguments", nargs=argparse.REMAINDER, metavar="...", help="its arguments")
    parser.add_argument("--name", help="of the program in records and reports (default: that of its file)")
    parser.add_argument("--of", metavar="TEXT", help="a commit or another name of the version that is measured "
                        "(default: the commit of the git repository in the current folder)")
    parser.add_argument("--passes", type=number(1, 100, True), default=1, metavar="N",
                        help="runs of the program; each case counts by its best rate, and check by their range (default: 1)")
    parser.add_argument("--time-limit", type=number(0.01, 1e6), default=600, metavar="S",
                        help="for one run, after which the program is stopped (default: 600)")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("-o", "--output", metavar="FILE", help="default: DATE_COMMIT.json in the folder of records")
    where.add_argument("--records", default=records.TRACKED, metavar="FOLDER", help=f"default: {records.TRACKED}")
    parser.set_defaults(run=track.command)


def add_records(parser, choice=True):
    """The arguments that name records, and choose among them."""
    parser.add_argument("records", nargs="*", metavar="RECORD",
                        help="of record or track, or folders of them (default: perf-records in this folder, if "
                        "there is one, else Tessera's own: build/perf/records and the times in bench/baselines)")
    parser.add_argument("--baselines", default=baselines.FOLDER, metavar="FOLDER", help="default: bench/baselines")
    if choice:
        parser.add_argument("--machine", metavar="TEXT", help="records of machines with this text in their name, as "
                            "list prints it (default: the newest record's machine)")
        parser.add_argument("--program", metavar="NAME",
                            help="records of this program (default: the newest record's program)")


def add_check(commands):
    parser = commands.add_parser(
        "check", help="whether the newest record is slower than those before",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Compares each case of the newest record with the median of up to 20 records before it, of the same program,\n"
        "machine and instruction set. A case is slower where its time grew by more than the threshold, and by more than\n"
        "chance explains: three standard deviations of the records before; with fewer than four of these the range of\n"
        "passes, and at least 20%. Record several passes each (track --passes 5).", epilog=STATUS)
    add_records(parser)
    parser.add_argument("--threshold", type=number(0, 1000), default=5, metavar="PERCENT", help="default: 5")
    parser.set_defaults(run=check.command)


def add_list(commands):
    parser = commands.add_parser(
        "list", help="date, commit, machine and cases of records",
        formatter_class=argparse.RawDescriptionHelpFormatter, epilog=STATUS,
        description="Prints a line of text for each record, the oldest first. A commit with + had changes.")
    add_records(parser, choice=False)
    parser.set_defaults(run=records.command)


def add_export(commands):
    parser = commands.add_parser(
        "export", help="the newest record's figures, for other tools",
        formatter_class=argparse.RawDescriptionHelpFormatter, epilog=STATUS,
        description="Prints the figures of the newest record as JSON. github-action-benchmark reads rates as its tool\n"
        "customBiggerIsBetter, and times as customSmallerIsBetter.")
    add_records(parser)
    parser.add_argument("--format", choices=export.FORMATS, default=export.FORMATS[0],
                        help=f"default: {export.FORMATS[0]}")
    parser.add_argument("--figure", choices=("rate", "time"), default="rate",
                        help="items per second, or nanoseconds per item (default: rate)")
    parser.add_argument("-o", "--output", metavar="FILE", help="default: standard output")
    parser.set_defaults(run=export.command)


def add_report(commands):
    parser = commands.add_parser(
        "report", help="a page of what was recorded", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Writes one page of HTML that needs no other file: the history of rates and of instructions, the roofline, the peers.\n"
        "Where rsvg-convert is installed, its plots lie beside it as PNG.", epilog=STATUS)
    add_records(parser)
    parser.add_argument("-o", "--output", metavar="FILE", help="default: build/perf/report.html; plots lie beside it")
    parser.add_argument("--peers", metavar="FILE", help="what tools/peers.sh left (default: build/peers/peers.json, "
                        "else the table in bench/baselines; of the records' machine in each case)")
    parser.set_defaults(run=report.command)


def add_roofline(commands):
    parser = commands.add_parser(
        "roofline", help="a picture of the machine's limits", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Draws what 'tessera_bench --roofline=FILE.json' measured. PNG needs rsvg-convert (Debian's package\n"
        "librsvg2-bin).", epilog=STATUS)
    parser.add_argument("measured", metavar="FILE.json")
    parser.add_argument("-o", "--output", metavar="FILE", help=".svg or .png (default: FILE.svg)")
    parser.set_defaults(run=roofline.command)


def add_peers(commands):
    parser = commands.add_parser(
        "peers", help="the table of what tools/peers.sh found", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Prints the ratios of one run of tools/peers.sh as a table, which runs this in the end.", epilog=STATUS)
    parser.add_argument("results", metavar="RESULTS", help="lines of JSON (build/peers/results.jsonl)")
    parser.add_argument("-o", "--output", metavar="FILE", help="all of it as JSON, for the report")
    parser.set_defaults(run=peers.command)


def make_parser():
    parser = argparse.ArgumentParser(prog="tools/perf", description=DESCRIPTION, epilog=STATUS,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    for add in (add_compare, add_count, add_serial, add_record, add_track, add_check, add_list, add_report, add_export,
                add_roofline, add_peers):
        add(commands)
    return parser


def main(words):
    arguments = make_parser().parse_args(words)  # exits with status 2 if they are wrong
    try:
        return arguments.run(arguments)
    except Failure as failure:
        say(f"perf: {failure}")
        return failure.status
    except KeyboardInterrupt:
        say("perf: interrupted")
        return 130
    except BrokenPipeError:
        return FAILED
