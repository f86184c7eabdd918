#!/usr/bin/env python3
"""Runs every study with the options given, and writes OUTPUT/report.html: all figures, and a table of the paper's and
asterflow's results with their difference. A study that fails is reported and the others go on.

    studies/report.py --quick --output quick-look
    studies/report.py --output study-results               # the paper's settings: hours
    studies/report.py --output study-results --drawing-only
"""

import html
import json
import subprocess
import sys
from pathlib import Path

from study import parse_options

HERE = Path(__file__).resolve().parent
FIGURES = ("figure02", "figure03", "figure04", "figure05", "figure06", "figure10", "figure11", "figure12_14", "figure15",
           "figure16")
STYLE = "body{font-family:sans-serif;max-width:75em;margin:auto}table{border-collapse:collapse}td,th{border:1px solid #ccc;padding:.2em .6em;text-align:left}img{max-width:100%}"


def difference(paper, ours):
    """'+12 %' between two numbers, else nothing."""
    if not all(isinstance(value, (int, float)) for value in (paper, ours)) or paper == 0:
        return ""
    return f"{100 * (ours / paper - 1):+.0f} %"


def table_of(records):
    head = "<tr><th>quantity</th><th>paper</th><th>asterflow</th><th>difference</th><th>note</th></tr>"
    rows = []
    for record in records:
        cells = (record["quantity"], record["paper"], record["asterflow"], difference(record["paper"], record["asterflow"]),
                 record["note"])
        rows.append("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in cells) + "</tr>")
    return "<table>" + head + "".join(rows) + "</table>"


def section_of(folder, figure):
    title = (HERE / f"{figure}.py").read_text().split('"""')[1].replace("\n", " ")
    parts = [f"<h2>{html.escape(title)}</h2>"]
    record_file = folder / f"{figure}.json"
    if not record_file.exists():
        return parts[0] + "<p>not run</p>"
    content = json.loads(record_file.read_text())
    settings = content["settings"]
    words = [f"{settings['fibers']} microtubules", f"seeds {settings['seeds']}", *settings["set"], *["quick"] * settings["quick"]]
    parts.append(f"<p>{html.escape(', '.join(words))}</p>")
    parts.append(f'<p><img src="{figure}.png" alt="{figure}"></p>' + table_of(content["records"]))
    return "".join(parts)


def markdown_table(folder):
    """The same table for docs/paper."""
    lines = ["| figure | quantity | paper | asterflow | difference | note |", "|---|---|---|---|---|---|"]
    for figure in FIGURES:
        file = folder / f"{figure}.json"
        for r in json.loads(file.read_text())["records"] if file.exists() else []:
            cells = (r["figure"][6:], r["quantity"], r["paper"], r["asterflow"], difference(r["paper"], r["asterflow"]), r["note"])
            lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    options = parse_options(__doc__)
    for figure in FIGURES:
        if subprocess.run([sys.executable, HERE / f"{figure}.py", *sys.argv[1:]]).returncode != 0:
            print(f"{figure} has failed; the report goes on without it", file=sys.stderr)
    body = "".join(section_of(options.output, figure) for figure in FIGURES)
    page = options.output / "report.html"
    page.write_text(f"<!doctype html><meta charset='utf-8'><title>asterflow and the paper</title><style>{STYLE}</style>"
                    f"<h1>asterflow and the paper</h1>{body}\n")
    (options.output / "results.md").write_text(markdown_table(options.output))
    print(page)


if __name__ == "__main__":
    main()
