"""How the records of one experiment become blocks of the page; sections.py says which experiment uses which."""

from __future__ import annotations

import re
from collections import Counter
from typing import Callable, Sequence

from blocks import (
    REMARKS,
    Block,
    Cell,
    Context,
    PlotBlock,
    TableBlock,
    axis_label,
    by_label,
    galleries,
    hint,
    metric_name,
    metrics_of,
    natural,
    record_table,
    value_cell,
    variant_name,
    varying,
)
from plots import Curve, Line, Panel, Point, draw, ratios
from records import Record

# Variants of a method, and the value that stands for each while another one is varied.
_USUAL = {"order": "attention", "cache": "on", "attention": "0.5"}

# Labels that say which setting a point of a curve is, not which curve.
_ALONG_A_CURVE = ("scene", "path", "quality")

# Experiments that are measured against something else than the scene's reference.
_OTHER_TRUTH = ("order", "walk-order", "peers")
# Where a record stands on the x axis, with the range of its repeats.
Place = Callable[[Record], tuple[float, tuple[float, float] | None] | None]

# Kinds of values, each with a panel of its own, and the word on its axis.
_KINDS = {"time": "time", "bytes": "memory", "rate": "rate", "error": "error", "ratio": "ratio", "count": "count"}


def _stem(*words: str) -> str:
    return re.sub(r"[^a-zA-Z0-9]+", "-", "-".join(filter(None, words))).strip("-").lower()


def _cost(record: Record) -> tuple[float, tuple[float, float] | None] | None:
    """What was spent: a frame's budget (ms) or samples as granted, seconds or a frame's time (ms) as measured, seconds
    as granted; None if nothing says."""
    for amount in ("budget_ms", "samples"):
        if amount in record.at:
            return record.at[amount], None
    for measured in ("seconds", "frame_p50"):
        if measured in record.values:
            value = record.values[measured]
            return value.median, (value.min, value.max)
    return (record.at["seconds"], None) if "seconds" in record.at else None


def _amount(record: Record) -> tuple[float, None] | None:
    """The quantity that grows: the only number that says where the record was taken."""
    return (next(iter(record.at.values())), None) if record.at else None


def point(record: Record, metric: str, place: Place = _cost) -> Point | None:
    """A record as a point of a plot of `metric`; None when it has no such value or no place on the x axis."""
    value, x = record.values.get(metric), place(record)
    if value is None or x is None:
        return None
    factor = 1e-6 if value.kind == "bytes" else 1.0  # MB, as _unit says
    return Point(x[0], value.median * factor, (value.min * factor, value.max * factor), x[1], record.loaded)


def curves(records: Sequence[Record], names: Sequence[str], metric: str, place: Place = _cost) -> list[Curve]:
    """One curve for each combination of the labels `names`; a method that was given time and, in other records, samples
    a pixel has a curve for each."""
    found: dict[str, Curve] = {}
    timed = {variant_name(record, names) for record in records if "seconds" in record.at}
    for record in records:
        where = point(record, metric, place)
        if where:
            name = variant_name(record, names) or record.experiment
            name += ", by samples a pixel" if "spp" in record.at and name in timed else ""
            found.setdefault(name, Curve(name)).points.append(where)
    return sorted(found.values(), key=lambda curve: natural(curve.name))


def _usual(records: Sequence[Record], label: str) -> str | None:
    """The value of a label that stands still while others vary: the usual one, or the most frequent."""
    values = Counter(record.labels[label] for record in records if label in record.labels)
    if not values:
        return None
    return _USUAL[label] if _USUAL[label] in values else values.most_common(1)[0][0]


def questions(records: Sequence[Record]) -> list[tuple[str, list[Record], list[str]]]:
    """(title, records, labels that name a curve): methods against one another, then each of their options alone."""
    options = [name for name in _USUAL if len({r.labels[name] for r in records if name in r.labels}) > 1]
    usual = {name: _usual(records, name) for name in options}

    def fixed(record: Record, but: str = "") -> bool:
        return all(record.labels.get(name, usual[name]) == usual[name] for name in options if name != but)

    others = [name for name in varying(records) if name not in (*_ALONG_A_CURVE, *_USUAL)]
    methods = [record for record in records if fixed(record)]
    found = [("methods", methods, others or ["method"])]
    for option in options:
        chosen = [record for record in records if option in record.labels and fixed(record, but=option)]
        if len({record.labels[option] for record in chosen}) > 1:
            found.append((option, chosen, [name for name in varying(chosen) if name not in ("scene", "path")]))
    return found


def _is_reference(record: Record) -> bool:
    return record.experiment == "reference" or record.labels.get("method") == "reference"


def floor(context: Context, records: Sequence[Record], metric: str) -> list[Line]:
    """The error of what the records were measured against: of their experiment's own reference (a record of method
    "reference", or a value own_METRIC), else of the scene's, unless the experiment has another truth."""
    experiment, scene = records[0].experiment, records[0].labels.get("scene", "")
    of_scene = [record for record in context.everything if record.labels.get("scene", "") == scene]
    found = [r.median(metric) for r in of_scene if r.experiment == experiment and _is_reference(r)]
    found += [r.median(f"own_{metric}") for r in of_scene if r.experiment == experiment]
    if experiment not in _OTHER_TRUTH:
        found += [r.median(metric) for r in of_scene if r.experiment == "reference"]
    errors = [error for error in found if error]
    return [Line("the reference's own error", errors[0])] if errors else []


def _exact_motion(records: Sequence[Record], metric: str) -> list[Curve]:
    """What moves from frame to frame though nothing is wrong, where the records know it (METRIC_raytrace)."""
    found = {p.x: p for p in (point(record, f"{metric}_raytrace") for record in records) if p}
    return [Curve("exact frames", list(found.values()))] if found else []


def error_against_cost(
    context: Context, metrics: Sequence[str], x_label: str, timing: Sequence[str] = ()
) -> list[Block]:
    """For each scene (and path): a figure for each question, the times behind it, all numbers, all pictures."""
    found: list[Block] = []
    for scene, group in by_label(context.records, "scene").items():
        for path, records in by_label(group, "path").items():
            place = ", ".join(filter(None, (scene, path)))
            main = [r for r in records if not _is_reference(r) and _cost(r) and any(m in r.values for m in metrics)]
            if main:
                found += _error_figures(context, main, place, metrics, x_label, timing)
                found += _numbers_and_pictures(context, main, place)
            found += _other_tables([record for record in records if record not in main], place)
    return found


def _numbers_and_pictures(context: Context, records: Sequence[Record], place: str) -> list[Block]:
    names = [name for name in varying(records) if name not in ("scene", "path")] or ["method"]
    ordered = sorted(records, key=lambda record: (natural(variant_name(record, names)), sum(record.at.values())))
    table = record_table(ordered, f"{place}: all numbers, median and range", names)
    return [table, *galleries(context, ordered, f"{place}: pictures")]


def _other_tables(records: Sequence[Record], place: str) -> list[Block]:
    """What is no point of a curve, a table for each set of metrics."""
    families: dict[tuple[str, ...], list[Record]] = {}
    for record in records:
        families.setdefault(tuple(metrics_of([record])), []).append(record)
    caption = f"{place}: further figures".lstrip(": ")
    return [record_table(group, caption) for group in families.values()]


def _error_figures(
    context: Context, records: Sequence[Record], place: str, metrics: Sequence[str], x_label: str, timing: Sequence[str]
) -> list[Block]:
    """The plots of one scene and path, one a question."""
    found: list[Block] = []
    name = records[0].experiment
    for title, chosen, names in questions(records):
        panels = []
        for metric in metrics:
            shown = curves(chosen, names, metric) + _exact_motion(chosen, metric)
            panels.append(
                Panel(hint(chosen, [metric]), x_label, axis_label(metric), shown, floor(context, chosen, metric))
            )
        found += _plot(context, _stem(name, place, title), f"{place}: {title}", panels)
        if timing and title == "methods":
            panels = _timing_panels(chosen, names, timing, x_label)
            found += _plot(context, _stem(name, place, "times"), f"{place}: what a frame costs", panels)
    return found


def _timing_panels(
    records: Sequence[Record], names: Sequence[str], metrics: Sequence[str], x_label: str
) -> list[Panel]:
    panels = []
    for metric in metrics:
        diagonal = "the budget itself" if metric.startswith("frame_") else ""
        log_y = not metric.startswith("missed")
        unit = _unit(records, metric)
        panels.append(
            Panel(
                hint(records, [metric]),
                x_label,
                axis_label(metric, unit),
                curves(records, names, metric),
                [],
                True,
                log_y,
                diagonal,
            )
        )
    return panels


def _plot(context: Context, stem: str, title: str, panels: list[Panel]) -> list[Block]:
    plot = draw(context.folder, stem, title, panels)
    return [PlotBlock(plot)] if plot else []


def _unit(records: Sequence[Record], metric: str) -> str:
    for record in records:
        value = record.values.get(metric)
        if value:
            return "MB" if value.kind == "bytes" else value.unit
    return ""


def growth(context: Context, x_units: dict[str, str], group: str = "quantity") -> list[Block]:
    """For each quantity a figure, on logarithmic axes: a panel each for times, bytes and what else was measured."""
    found: list[Block] = []
    for quantity, records in by_label(context.records, group).items():
        records = sorted(records, key=lambda record: sum(record.at.values()))
        names = [name for name in varying(records) if name != group]
        panels = [
            panel for kind in _KINDS for panel in _kind_panels(records, names, kind, x_units.get(quantity, quantity))
        ]
        found += _plot(context, _stem(records[0].experiment, quantity), quantity or records[0].experiment, panels)
        found.append(
            record_table(
                records,
                f"{quantity}: all numbers, median and range".lstrip(": "),
                [group] + names if quantity else names,
            )
        )
    return found


def _kind_panels(records: Sequence[Record], names: Sequence[str], kind: str, x_label: str) -> list[Panel]:
    """A panel for all metrics of a kind that share a unit; its curves carry the metrics' names."""
    units: dict[str, list[str]] = {}
    for metric in metrics_of(records):
        if any(metric in record.values and record.values[metric].kind == kind for record in records):
            units.setdefault(_unit(records, metric), []).append(metric)
    panels = []
    for unit, metrics in units.items():
        found = []
        for metric in metrics:
            for curve in curves(records, names, metric, _amount):
                plain = curve.name == records[0].experiment
                variant = curve.name.removeprefix(f"{names[0]} ") if len(names) == 1 else curve.name
                curve.name = metric_name(metric) if plain else f"{metric_name(metric)}, {variant}"
                found.append(curve)
        word = _KINDS[kind]
        panels.append(Panel(hint(records, metrics), x_label, f"{word} ({unit})" if unit else word, found))
    return panels


def error_against_share(
    context: Context, metrics: Sequence[str], share: str, x_label: str, group: str
) -> list[Block]:
    """For each value of the label `group` a figure: errors by another measured share, a curve for each variant."""

    def place(record: Record) -> tuple[float, None] | None:
        return (record.values[share].median, None) if share in record.values else None

    found: list[Block] = []
    for value, records in by_label(context.records, group).items():
        points = [record for record in records if record.at and share in record.values]
        names = [name for name in varying(points) if name not in (group, *points[0].at)] if points else []
        panels = [
            Panel(hint(points, [metric]), x_label, axis_label(metric), curves(points, names, metric, place), [], False, False)
            for metric in metrics
            if any(metric in record.values for record in points)
        ]
        found += _plot(context, _stem(records[0].experiment, value), value, panels)
    return found + plain(context)


_HARD_LABELS = ("number", "title", "case", "test")
_ARROWS = {"lower": " ↓", "higher": " ↑"}


def ratio_rows(context: Context, metric: str, x_label: str, mark: str, caption: str) -> list[Block]:
    """A line for each record's ratio from the line at 1, and the table behind it."""
    names = varying(context.records) or list(context.records[0].labels)
    shown = [(record, record.values[metric]) for record in context.records if metric in record.values]
    found = [(variant_name(record, names) + _ARROWS.get(value.better, ""), value.median) for record, value in shown]
    stem = _stem(context.records[0].experiment, metric)
    plot = ratios(context.folder, stem, caption, x_label, found, Line(mark, 1.0))
    return ([PlotBlock(plot)] if plot else []) + [record_table(context.records, "All numbers, median and range")]


def hard_cases(context: Context) -> list[Block]:
    """A table of every case with its share of what is allowed; shares above 1 are failures."""
    rows, shares = [], []
    ordered = sorted(context.records, key=lambda record: natural(record.labels.get("number", "")))
    for record in ordered:
        achieved, allowed = record.median("achieved"), record.median("allowed")
        share = achieved / allowed if achieved is not None and allowed else None
        failed = record.labels.get("result") == "failed" or (share is not None and share > 1)
        if share:
            shares.append((f"{record.labels.get('number', '')} {record.labels.get('case', record.key)}".strip(), share))
        cells = [Cell(record.labels.get(label, "")) for label in _HARD_LABELS]
        cells += [value_cell(record, "achieved"), value_cell(record, "allowed")]
        cells += [Cell("" if share is None else f"{share:.2g}", number=True, bad=failed)]
        rows.append(cells + [Cell(record.labels.get("result", ""), bad=failed)])
    title, x_label = "Error as a share of what is allowed", "achieved / allowed, lower is better"
    plot = ratios(context.folder, "hard", title, x_label, shares, Line("allowed", 1.0))
    table = TableBlock("Every case", [*_HARD_LABELS, "achieved", "allowed", "share", ""], rows)
    return ([PlotBlock(plot)] if plot else []) + [table] + galleries(context, ordered, "Pictures")


def plain(context: Context) -> list[Block]:
    """What any experiment gets: its records as tables, one for each set of labels, and its pictures."""
    families: dict[tuple[str, ...], list[Record]] = {}
    for record in context.records:
        families.setdefault(tuple(name for name in record.labels if name not in REMARKS), []).append(record)
    tables = [record_table(group, "All numbers, median and range") for group in families.values()]
    return [*tables, *galleries(context, context.records, "Pictures")]
