#!/usr/bin/python3
"""Makes the page of a measurement: DIR/records.json -> DIR/plots/*.svg, *.png and DIR/index.html.

    bench/report/report.py DIR

The page opens from disk: one file, no scripts, pictures by relative path. docs/benchmarks.md says how to read it.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

from blocks import LOADED_MARK, Block, Context
from records import Record, RecordError, Run, load
from sections import SECTIONS, section_of

try:
    import jinja2
except ModuleNotFoundError as error:
    raise SystemExit(
        "saccade: error: this python3 has no jinja2; run scripts/install and use Debian's own, /usr/bin/python3"
    ) from error


@dataclass(frozen=True)
class Shown:
    """A section with everything that the template needs."""

    id: str
    title: str
    question: str
    sources: list[str]
    blocks: list[Block]


def runs_of(records: list[Record]) -> list[Run]:
    """The runs that the records come from, each once."""
    found: list[Run] = []
    for record in records:
        if record.run not in found:
            found.append(record.run)
    return found


def experiments_of(records: list[Record]) -> list[str]:
    """Experiments that have records: known ones in the page's order, then the others."""
    present = list(dict.fromkeys(record.experiment for record in records))
    return [name for name in SECTIONS if name in present] + [name for name in present if name not in SECTIONS]


def build_sections(folder: Path, records: list[Record]) -> list[Shown]:
    sections = []
    for name in experiments_of(records):
        own = [record for record in records if record.experiment == name]
        section = section_of(name)
        sources = [f"{run.command} (commit {run.commit})" for run in runs_of(own)]
        sections.append(
            Shown(name, section.title, section.question, sources, section.build(Context(folder, own, records)))
        )
    return sections


def write_page(folder: Path) -> Path:
    """Writes plots and page; returns the page's path. Raises RecordError."""
    records = load(folder / "records.json")
    if not records:
        raise RecordError(f"{folder / 'records.json'} holds no records; run `saccade bench quick -o {folder}`")
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    html = environment.get_template("page.html.j2").render(
        runs=runs_of(records),
        sections=build_sections(folder, records),
        loaded=sum(record.loaded for record in records),
        total=len(records),
        mark=LOADED_MARK,
        downloads=[name for name in ("records.json", "records.csv") if (folder / name).is_file()],
    )
    page = folder / "index.html"
    page.write_text(html, encoding="utf-8")
    return page


def main() -> int:
    parser = argparse.ArgumentParser(
        description="Makes plots and one HTML page of the records that `saccade bench` wrote."
    )
    parser.add_argument("folder", type=Path, metavar="DIR", help="the folder that holds records.json")
    try:
        print(write_page(parser.parse_args().folder))
    except (RecordError, OSError) as error:
        print(f"saccade: error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
