#!/usr/bin/python3
"""Makes docs/results.md of docs/results.md.in and docs/records/*.json.

    bench/report/results.py                  writes the page
    bench/report/results.py --take DIR       first takes over what the page needs of a new measurement
    bench/report/results.py --check          writes nothing; exit status 1 and one line for each thing that is wrong
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from pathlib import Path
from typing import Any

from book import Book
from literal_numbers import literal_numbers
from records import RecordError, load, read_raw
from results_page import book_of, committed, plots_folder, render

ROOT = Path(__file__).resolve().parents[2]


def difference(page: Path, text: str) -> list[str]:
    """The first line in which the committed page is not what the records give."""
    try:
        lines = page.read_text(encoding="utf-8").splitlines()
    except OSError:
        return [f"{page} is missing; run scripts/results"]
    wanted = text.splitlines()
    for position in range(max(len(lines), len(wanted))):
        have = lines[position] if position < len(lines) else "(end)"
        want = wanted[position] if position < len(wanted) else "(end)"
        if have != want:
            return [f'{page}:{position + 1}: is "{have}", the records give "{want}"; run scripts/results']
    return []


def check(docs: Path) -> list[str]:
    """What is wrong with the page, one line each."""
    template = docs / "results.md.in"
    wrong = literal_numbers(template)
    try:
        book = book_of(docs)
        text = render(template, book)
    except RecordError as error:
        return [*wrong, str(error)]
    return wrong + list(dict.fromkeys(book.complaints)) + difference(docs / "results.md", text)


def make(docs: Path) -> None:
    """Writes the page, and warns of what somebody has to write."""
    book = book_of(docs)
    page = docs / "results.md"
    page.write_text(render(docs / "results.md.in", book), encoding="utf-8")
    for line in dict.fromkeys(book.complaints):
        print(f"saccade: warning: {line}", file=sys.stderr)
    print(page)


def write_records(path: Path, runs: list[Any], records: list[dict[str, Any]]) -> None:
    """A records file with one record a line, so that a changed figure is one changed line; only runs in use."""
    used = sorted({record["run"] for record in records})
    lines = [json.dumps(record | {"run": used.index(record["run"])}, ensure_ascii=False) for record in records]
    head = json.dumps([runs[index] for index in used], ensure_ascii=False, indent=1)
    body = ",\n".join(lines)
    path.write_text(f'{{"schema": 1,\n"runs": {head},\n"records": [\n{body}\n]}}\n', encoding="utf-8")


def drop(path: Path, experiments: set[str]) -> None:
    """Takes an experiment's records out of a committed file; an empty file goes."""
    raw = read_raw(path)
    names = [record.experiment for record in load(path)]
    kept = [entry for entry, name in zip(raw["records"], names) if name not in experiments]
    if not kept:
        path.unlink()
    elif len(kept) < len(names):
        write_records(path, raw["runs"], kept)


def take(docs: Path, folder: Path) -> list[str]:
    """Replaces each experiment that DIR holds by those of its records that the page uses; returns their names."""
    new = {record.key: record for record in load(folder / "records.json")}
    experiments = {record.experiment for record in new.values()}
    old = {key: record for key, record in committed(docs).items() if record.experiment not in experiments}
    book = Book(old | new, plots_folder(docs))
    render(docs / "results.md.in", book)
    used = experiments & {record.experiment for key, record in book.used.items() if key in new}
    for path in sorted((docs / "records").glob("*.json")):
        drop(path, used)
    raw = read_raw(folder / "records.json")
    for experiment in sorted(used):
        entries = [
            entry | {"files": {}}
            for entry in raw["records"]
            if entry["key"] in book.used and new[entry["key"]].experiment == experiment
        ]
        write_records(docs / "records" / f"{experiment}.json", raw["runs"], entries)
    take_plots(docs, folder, book.asked_plots)
    return sorted(used)


def take_plots(docs: Path, folder: Path, names: list[str]) -> None:
    """Copies the plots that the page shows, where the measurement has them."""
    for name in names:
        drawn = folder / "plots" / f"{name}.png"
        if drawn.is_file():
            plots_folder(docs).mkdir(parents=True, exist_ok=True)
            shutil.copyfile(drawn, plots_folder(docs) / drawn.name)


def main() -> int:
    parser = argparse.ArgumentParser(description="Makes docs/results.md of its template and the committed records.")
    parser.add_argument(
        "--check", action="store_true", help="write nothing; status 1 if the page is not what records give"
    )
    parser.add_argument(
        "--take", type=Path, metavar="DIR", help="take over the records that the page shows from DIR/records.json"
    )
    parser.add_argument("--docs", type=Path, default=ROOT / "docs", help="folder of results.md.in and records/ (docs)")
    options = parser.parse_args()
    try:
        if options.check:
            wrong = check(options.docs)
            for line in wrong:
                print(f"saccade: error: {line}", file=sys.stderr)
            return 1 if wrong else 0
        if options.take:
            print("taken over: " + (", ".join(take(options.docs, options.take)) or "nothing that the page shows"))
        make(options.docs)
    except (RecordError, OSError) as error:
        print(f"saccade: error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
