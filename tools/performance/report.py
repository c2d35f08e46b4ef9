"""report: one page, in a single file, of the records, counts and comparisons."""

import datetime
import math
import shutil
import subprocess
from html import escape
from pathlib import Path

from . import baselines, count, plots
from .console import GOOD, Failure, say, scaled
from .record import KEYS
from .repository import ROOT, WORK, describe, git
from .suite import read_json

STYLE = """
body{font:15px/1.5 'DejaVu Sans',Verdana,sans-serif;color:#23272e;background:#fcfcf9;max-width:1100px;margin:2em auto;padding:0 1em}
h1{font-size:26px;margin-bottom:0}h2{font-size:20px;margin-top:2em}p.quiet{color:#6b7078}
table{border-collapse:collapse;font-size:13px;width:100%}th,td{padding:2px 8px;text-align:left;border-bottom:1px solid #e3e3dc;vertical-align:middle}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}th{color:#6b7078;font-weight:normal}
.slower{color:#a8324a;font-weight:bold}.faster{color:#00805c;font-weight:bold}svg{max-width:100%;height:auto}svg.spark{display:block}
details{margin:1em 0}summary{cursor:pointer}
"""


def read_records(names, folder):
    """Records in the order of their commits' dates."""
    files = [Path(name) for name in names] or sorted((WORK / "records").glob("*.json")) + sorted(Path(folder).glob("*/times.json"))
    records = []
    for file in files:
        content = baselines.read(file, KEYS)
        if content is None:
            raise Failure(f"there is no record {file}")
        if content not in records:  # a baseline may repeat a record that is still there
            records.append(content)
    return sorted(records, key=lambda r: (r.get("commit_time", 0), r["date"]))


def comparable(records):
    """The records with the machine and instruction set of the newest one; and these two."""
    kind = lambda r: (r["machine"].get("processor"), r["facts"].get("isa"))
    newest = kind(records[-1])
    return [r for r in records if kind(r) == newest], newest


def family(case):
    return case.split("/")[0].split(".")[0]


def mean_ratio(now, first):
    """The geometric mean over the cases that both have, by family."""
    logs = {}
    for case, value in now.items():
        if case in first and value > 0 and first[case] > 0:
            logs.setdefault(family(case), []).append(math.log(value / first[case]))
    return {name: math.exp(sum(values) / len(values)) for name, values in logs.items()}


def lines_of(rows):
    """Maps each family to its ratios to the first row; a row maps cases to values."""
    means = [mean_ratio(row, rows[0]) for row in rows]
    families = sorted({name for mean in means for name in mean})
    return {name: [mean.get(name) for mean in means] for name in families}


def label_of(record):
    return (record["commit"] + ("+" if record.get("dirty") else ""), record["date"][:10])


def rates_table(records):
    last = records[-1]
    rows = ["<tr><th>case</th><th class=n>items/s</th><th class=n>of the limit</th><th>history</th>"
            "<th class=n>to the one before</th></tr>"]
    for case in sorted(last["cases"]):
        entry = last["cases"][case]
        values = [r["cases"].get(case, {}).get("rate") for r in records]
        before = next((v for v in reversed(values[:-1]) if v), None)
        ratio = entry["rate"] / before if before else None
        word = "" if ratio is None else "slower" if ratio < 0.9 else "faster" if ratio > 1.1 else ""
        change = "" if ratio is None else f"{ratio:.2f}"
        limit = entry.get("limit_fraction")
        rows.append(f"<tr><td>{escape(case)}</td><td class=n>{scaled(entry['rate'])}</td>"
                    f"<td class=n>{'' if limit is None else f'{limit:.2f}'}</td><td>{plots.spark(values)}</td>"
                    f"<td class='n {word}'>{change}</td></tr>")
    return "<table>" + "".join(rows) + "</table>"


def counts_history(isa, folder):
    """(labels, counts) of the baselines that git holds, oldest first."""
    path = baselines.counts_file(isa, folder)
    try:
        name = str(Path(path).resolve().relative_to(ROOT))
        commits = git("log", "--reverse", "--format=%H", "--", name).split()
    except (Failure, ValueError):
        commits, name = [], None
    labels, rows = [], []
    for commit in commits:
        try:
            content = read_json(git("show", f"{commit}:{name}"), name)
        except Failure:
            continue  # the commit deleted it
        short, seconds, _ = describe(commit)
        labels.append((short, datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).strftime("%Y-%m-%d")))
        rows.append(content.get("counts", {}))
    now = baselines.read(path, ("counts",))
    if now and (not rows or rows[-1] != now["counts"]):
        labels.append(("this tree", datetime.date.today().isoformat()))
        rows.append(now["counts"])
    return labels, rows


def counts_part(folder, pictures):
    parts, columns = [], {}
    for isa in count.ISAS:
        labels, rows = counts_history(isa, folder)
        if not rows:
            continue
        columns[isa] = rows
        if len(rows) > 1:
            name = f"counts_{isa}"
            pictures[name] = plots.history(f"Instructions on {isa}", labels, lines_of(rows),
                                           "geometric means of a family's counts, over the first baseline's: more is worse")
            parts.append(pictures[name])
    if not columns:
        return ""
    cases = sorted({case for rows in columns.values() for case in rows[-1]})
    head = "".join(f"<th class=n>{isa}</th><th class=n>over the one before</th>" for isa in columns)
    body = ""
    for case in cases:
        body += f"<tr><td>{escape(case)}</td>"
        for rows in columns.values():
            now = rows[-1].get(case)
            before = rows[-2].get(case) if len(rows) > 1 else None
            body += f"<td class=n>{'' if now is None else f'{now:,}'}</td>"
            body += f"<td class=n>{f'{now / before:.4f}' if now and before else ''}</td>"
        body += "</tr>"
    return ("<h2>Instructions</h2><p>Of fixed work, one thread, by callgrind, the baselines that <code>tools/test.sh</code> holds "
            "builds to.</p>" + "".join(parts) + f"<details><summary>{len(cases)} cases</summary><table><tr><th>case</th>{head}</tr>{body}"
            "</table></details>")


def peers_content(name, folder):
    if name:
        content = baselines.read(name, ("date", "rows"))
        if content is None:
            raise Failure(f"there is no {name}")
        return content
    for path in [ROOT / "build" / "peers" / "peers.json", *sorted(Path(folder).glob("*/peers.json"))]:
        content = baselines.read(path, ("date", "rows"))
        if content:
            return content
    return None


def peers_part(content, pictures):
    rows = "".join(f"<tr><td>{escape(r['task'])}</td><td>{escape(r['peer'])}</td><td>{escape(r['way'])}</td>"
                   f"<td class=n>{scaled(r['rate'])}</td><td>{escape(r['against'])}</td><td class=n>{r['ratio']:.3g}</td></tr>"
                   for r in content["rows"])
    bars = [(f"{r['task']}: {r['peer']}, {r['way']}", r["ratio"]) for r in content["rows"] if r.get("main", True)]
    pictures["peers"] = plots.ratios("Beside other programs, in one run", bars)
    return (f"<h2>Peers</h2><p>{escape(content['date'])}, {escape(content.get('machine', ''))}, one thread each, in turns; every "
            f"answer was compared first.</p>{pictures['peers']}<details><summary>{len(content['rows'])} comparisons</summary>"
            "<table><tr><th>task</th><th>program</th><th>way</th><th class=n>items/s</th><th>Tessera's way</th>"
            f"<th class=n>Tessera is faster by</th></tr>{rows}</table></details>")


def page(records, folder, peers):
    """(HTML, name to SVG)"""
    pictures, body = {}, ""
    title, quiet = "Tessera, measured", ""
    if records:
        records, (processor, isa) = comparable(records)
        last = records[-1]
        quiet = (f"{last['date']}, commit {last['commit']}{' and changes' if last.get('dirty') else ''}: {last.get('subject', '')}. "
                 f"{processor}, {last['machine'].get('cores')} cores, {isa}, {last['facts'].get('compiler', 'compiler unknown')}")
        body += ("<h2>History</h2><p>Each record is one run, on a machine that did other things as well: read trends here. Whether a "
                 "commit is slower than another one, <code>tools/perf compare</code> finds out.</p>")
        if len(records) > 1:
            rows = [{case: entry["rate"] for case, entry in r["cases"].items()} for r in records]
            pictures["history"] = plots.history("Rates", [label_of(r) for r in records], lines_of(rows),
                                                "geometric means of a family's rates, over the first record's: more is better")
            body += pictures["history"]
        body += f"<details open><summary>{len(last['cases'])} cases</summary>{rates_table(records)}</details>"
        drawn = next((r["roofline"] for r in reversed(records) if r.get("roofline")), None)
        if drawn:
            pictures["roofline"] = plots.roofline(drawn)
            body += ("<h2>Roofline</h2><p>Grids of bicubic patches in blocks: blue where the output stays in the second-level cache, "
                     f"orange where it goes to memory.</p>{pictures['roofline']}")
    body += counts_part(folder, pictures)
    if peers:
        body += peers_part(peers, pictures)
    if not body:
        raise Failure("nothing was recorded yet: tools/perf record")
    html = (f"<!doctype html><html lang=en><head><meta charset=utf-8><title>{title}</title><style>{STYLE}</style></head><body>"
            f"<h1>{title}</h1><p class=quiet>{escape(quiet)}</p>{body}</body></html>\n")
    return html, pictures


def write_pictures(pictures, folder):
    """Writes the plots as PNG if rsvg-convert is installed."""
    if not shutil.which("rsvg-convert"):
        say("perf: no PNG of the plots: rsvg-convert is not installed (Debian's package librsvg2-bin)")
        return []
    written = []
    for name, svg in pictures.items():
        file = folder / f"{name}.png"
        done = subprocess.run(["rsvg-convert", "--zoom=1.5", "-o", str(file)], input=svg.encode(), capture_output=True, check=False)
        if done.returncode != 0:
            raise Failure(f"rsvg-convert can't draw {file}: {done.stderr.decode().strip()}")
        written.append(file)
    return written


def command(arguments):
    records = read_records(arguments.records, arguments.baselines)
    html, pictures = page(records, arguments.baselines, peers_content(arguments.peers, arguments.baselines))
    output = Path(arguments.output) if arguments.output else WORK / "report.html"
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(html, encoding="utf-8")
    print(f"{len(records)} records: {output}")
    for file in write_pictures(pictures, output.parent):
        print(file)
    return GOOD
