"""report: one page, in a single file, of the records, counts and comparisons."""

import datetime
import math
import shutil
from html import escape
from pathlib import Path

from . import baselines, count, json_file, machine, plots, records, roofline
from .console import GOOD, Failure, say, scaled
from .repository import ROOT, WORK, describe, git

STYLE = """
body{font:15px/1.5 'DejaVu Sans',Verdana,sans-serif;color:#23272e;background:#fcfcf9;max-width:1100px;margin:2em auto;padding:0 1em}
h1{font-size:26px;margin-bottom:0}h2{font-size:20px;margin-top:2em}p.quiet{color:#6b7078}
table{border-collapse:collapse;font-size:13px;width:100%}th,td{padding:2px 8px;text-align:left;border-bottom:1px solid #e3e3dc;vertical-align:middle}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}th{color:#6b7078;font-weight:normal}
.slower{color:#a8324a;font-weight:bold}.faster{color:#00805c;font-weight:bold}svg{max-width:100%;height:auto}svg.spark{display:block}
.gone{color:#6b7078;font-style:italic}details{margin:1em 0}summary{cursor:pointer}
"""


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


def cases_of(found):
    """The cases of all records in order. The newest record may lack some of them."""
    return sorted({case for record in found for case in record["cases"]})


def row_of(case, found):
    """A row of the table. A case that the newest record lacks keeps its last value, marked with its date."""
    values = [r["cases"].get(case, {}).get("rate") for r in found]
    known = [k for k, value in enumerate(values) if value]
    entry = found[known[-1]]["cases"][case]
    limit, mark, change, word = entry.get("limit_fraction"), "", "", ""
    if known[-1] < len(found) - 1:
        commit, date = label_of(found[known[-1]])
        mark = (f" <span class=gone>not in the newest record; last on {escape(date)} with commit {escape(commit)}"
                "</span>")
    elif len(known) > 1:
        ratio = entry["rate"] / values[known[-2]]
        change, word = f"{ratio:.2f}", "slower" if ratio < 0.9 else "faster" if ratio > 1.1 else ""
    return (f"<tr><td>{escape(case)}{mark}</td><td class=n>{scaled(entry['rate'])}</td>"
            f"<td class=n>{'' if limit is None else f'{limit:.2f}'}</td><td>{plots.spark(values)}</td>"
            f"<td class='n {word}'>{change}</td></tr>")


def rates_table(found):
    cases = cases_of(found)
    gone = len(cases) - len(found[-1]["cases"])
    rows = "".join(row_of(case, found) for case in cases)
    return (f"<details open><summary>{len(cases)} {'case' if len(cases) == 1 else 'cases'}"
            f"{f', {gone} of them not in the newest record' if gone else ''}</summary><table><tr><th>case</th>"
            "<th class=n>items/s</th><th class=n>of the limit</th><th>history</th>"
            f"<th class=n>to the one before</th></tr>{rows}</table></details>")


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
            content = json_file.parse(git("show", f"{commit}:{name}"), name)
        except Failure:
            continue  # the commit deleted it
        short, seconds, _ = describe(commit)
        labels.append((short, datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).strftime("%Y-%m-%d")))
        rows.append(content.get("counts", {}))
    now = json_file.read(path, ("counts",))
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


def peers_content(name, folder, place):
    """The comparison with peers in a named file; by default one of the machine `place`, and none of another machine."""
    if name:
        content = json_file.read(name, ("date", "rows"))
        if content is None:
            raise Failure(f"there is no {name}")
        return content
    others, own = [], [ROOT / "build" / "peers" / "peers.json"] if Path(folder) == baselines.FOLDER else []
    for path in [*own, *sorted(Path(folder).glob("*/peers.json"))]:
        content = json_file.read(path, ("date", "rows"))
        if content and content.get("machine") == place:
            return content
        others += [str(content.get("machine", "an unknown machine"))] if content else []
    if others:
        say(f"perf: the comparison with peers is left out: it was made on {'; '.join(others)}, and the records on "
            f"{place}. tools/peers.sh compares on this machine, --peers FILE shows another machine's under its name")
    return None


def peers_part(content, pictures, place):
    """The comparison with peers; its title says if it was made on another machine than the records."""
    rows = "".join(f"<tr><td>{escape(r['task'])}</td><td>{escape(r['peer'])}</td><td>{escape(r['way'])}</td>"
                   f"<td class=n>{scaled(r['rate'])}</td><td>{escape(r['against'])}</td><td class=n>{r['ratio']:.3g}</td></tr>"
                   for r in content["rows"])
    bars = [(f"{r['task']}: {r['peer']}, {r['way']}", r["ratio"]) for r in content["rows"] if r.get("main", True)]
    pictures["peers"] = plots.ratios("Beside other programs, in one run", bars)
    elsewhere = "" if content.get("machine") == place else " on another machine"
    return (f"<h2>Peers{elsewhere}</h2><p>{escape(content['date'])}, {escape(content.get('machine', ''))}, one thread "
            f"each, in turns; every answer was compared first.</p>{pictures['peers']}<details><summary>"
            f"{len(content['rows'])} comparisons</summary>"
            "<table><tr><th>task</th><th>program</th><th>way</th><th class=n>items/s</th><th>Tessera's way</th>"
            f"<th class=n>Tessera is faster by</th></tr>{rows}</table></details>")


def history_part(found, others, pictures):
    """The figures of comparable records, and a sentence about the others."""
    own = records.program_of(found[-1]) == records.OWN
    html = ("<h2>History</h2><p>Each record is one run, on a machine that did other things as well: read trends here."
            + (" Whether a commit is slower than another one, <code>tools/perf compare</code> finds out."
               if own else "") + "</p>")
    if others:
        html += f"<p class=quiet>{escape(records.left_out(others))}</p>"
    if len(found) > 1:
        rows = [{case: entry["rate"] for case, entry in r["cases"].items()} for r in found]
        unit = "geometric means of a family's rates, over the first record's: more is better"
        pictures["history"] = plots.history("Rates", [label_of(r) for r in found], lines_of(rows), unit)
        html += pictures["history"]
    html += rates_table(found)
    drawn = next((r["roofline"] for r in reversed(found) if r.get("roofline")), None)
    if drawn:
        pictures["roofline"] = roofline.draw(drawn)
        html += ("<h2>Roofline</h2><p>Grids of bicubic patches in blocks: blue where the output stays in the "
                 f"second-level cache, orange where it goes to memory.</p>{pictures['roofline']}")
    return html


def summary(last):
    """The commit, machine and compiler of a record."""
    subject = f": {last['subject']}" if last.get("subject") else ""
    return (f"{last['date']}, commit {last['commit']}{' and changes' if last.get('dirty') else ''}{subject}. "
            f"{records.place_of(last)}, {last['facts'].get('compiler', 'compiler unknown')}")


def page(found, others, folder, peers):
    """(HTML, name to SVG). Counts of instructions and peers are Tessera's: pages of other programs are without."""
    pictures, body, quiet = {}, "", ""
    program = records.program_of(found[-1]) if found else records.OWN
    title = f"{'Tessera' if program == records.OWN else program}, measured"
    if found:
        quiet = summary(found[-1])
        body += history_part(found, others, pictures)
    if program == records.OWN:
        body += counts_part(folder, pictures)
    if peers:
        body += peers_part(peers, pictures, machine.title(found[-1]["machine"] if found else None))
    if not body:
        raise Failure(records.NOTHING)
    html = (f"<!doctype html><html lang=en><head><meta charset=utf-8><title>{escape(title)}</title>"
            f"<style>{STYLE}</style></head><body><h1>{escape(title)}</h1><p class=quiet>{escape(quiet)}</p>"
            f"{body}</body></html>\n")
    return html, pictures


def write_pictures(pictures, folder):
    """Writes the plots as PNG if rsvg-convert is installed; the page holds them anyway."""
    if not shutil.which("rsvg-convert"):
        return []
    files = {name: folder / f"{name}.png" for name in pictures}
    for name, svg in pictures.items():
        plots.write_png(svg, files[name])
    return list(files.values())


def command(arguments):
    found, others = records.chosen(arguments)
    peers = None
    if arguments.peers or not found or records.program_of(found[-1]) == records.OWN:
        place = machine.title(found[-1]["machine"] if found else None)
        peers = peers_content(arguments.peers, arguments.baselines, place)
    html, pictures = page(found, others, arguments.baselines, peers)
    output = Path(arguments.output) if arguments.output else WORK / "report.html"
    json_file.write_text(output, html)
    print(f"{len(found)} {'record' if len(found) == 1 else 'records'}: {output}")
    for file in write_pictures(pictures, output.parent):
        print(file)
    return GOOD
