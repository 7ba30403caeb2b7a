"""Plots in one house style: colour-blind-safe, readable in black and white, each as SVG and PNG.

A figure is a row of panels, a panel holds curves; where panels share curves, they share one legend. Nothing here knows
an experiment.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

try:
    import matplotlib
except ModuleNotFoundError as error:  # another python3 than Debian's may come first on the PATH
    raise SystemExit(
        "saccade: error: this python3 has no matplotlib; run scripts/install and use Debian's own, /usr/bin/python3"
    ) from error

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402  (the backend comes first)
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogFormatterSciNotation, LogLocator, NullFormatter  # noqa: E402

# Okabe and Ito's palette without its yellow, which is too pale for lines on white.
_PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000", "#7F7F7F")
_MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
_DASHES = ("-", (0, (5, 2)), (0, (1, 1.5)))
# What occurs in several figures looks the same in all: name -> place in palette and markers.
_KNOWN = {"corrective": 0, "path": 1, "raytrace": 2, "base": 7, "Cycles": 5}

_LOADED_RING = {
    "marker": "o",
    "linestyle": "",
    "color": "none",
    "markeredgecolor": "#B00000",
    "markersize": 9,
    "markeredgewidth": 0.7,
}

PANEL_WIDTH, PANEL_HEIGHT = 4.4, 3.6  # inches
_PANELS_A_ROW = 3
_PNG_DPI = 110
_LEAST_SPAN = 5.0  # of a logarithmic axis, so that noise does not look like a trend

matplotlib.rcParams.update(
    {
        "font.size": 10,
        "axes.grid": True,
        "grid.color": "#DDDDDD",
        "grid.linewidth": 0.6,
        "axes.axisbelow": True,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "lines.linewidth": 1.8,
        "lines.markersize": 5.5,
        "svg.hashsalt": "saccade",  # the same records give the same file
    }
)


@dataclass(frozen=True)
class Point:
    """One measurement; the ranges are those of its repeats."""

    x: float
    y: float
    y_range: tuple[float, float] | None = None
    x_range: tuple[float, float] | None = None
    loaded: bool = False


@dataclass
class Curve:
    name: str
    points: list[Point] = field(default_factory=list)


@dataclass(frozen=True)
class Line:
    """A horizontal line with its name: a floor that no method can pass, or a goal."""

    name: str
    y: float


@dataclass
class Panel:
    """One pair of axes; `hint` says which way is better, `diagonal` names the line y = x where that means something."""

    hint: str
    x_label: str
    y_label: str
    curves: list[Curve]
    lines: list[Line] = field(default_factory=list)
    log_x: bool = True
    log_y: bool = True
    diagonal: str = ""


@dataclass(frozen=True)
class Plot:
    """A figure on disk, its paths relative to the page's folder."""

    svg: str
    png: str
    title: str
    description: str


def _family(name: str, names: list[str]) -> str:
    """What gives a curve its colour: the curve that its name extends ("path, with this"), or else what stands before
    the first comma, unless too many curves share that."""
    words = name.split(", ")
    parents = [", ".join(words[:count]) for count in range(len(words) - 1, 0, -1)]
    for parent in parents:
        if parent in names:
            return parent
    siblings = [other for other in names if other.split(", ")[0] == words[0]]
    return words[0] if len(siblings) <= len(_DASHES) else name


def _known(family: str) -> int | None:
    """The place of a name that looks the same in all figures, with a version behind it or not."""
    return next((place for name, place in _KNOWN.items() if family == name or family.startswith(f"{name} (")), None)


def styles(names: list[str]) -> dict[str, dict[str, object]]:
    """Colour, marker and dash of each curve: a family has one colour, its members differ in dash and marker."""
    families: dict[str, list[str]] = {}
    for name in names:
        families.setdefault(_family(name, names), []).append(name)
    taken = {_known(family) for family in families}
    free = [place for place in range(len(_PALETTE)) if place not in taken]
    result: dict[str, dict[str, object]] = {}
    turn = 0
    for family, members in families.items():
        known = _known(family)
        place, start = (free[turn % len(free)], turn // len(free)) if known is None else (known, 0)
        turn += known is None
        for step, name in enumerate(members, start):
            marker = _MARKERS[(place + step) % len(_MARKERS)]
            result[name] = {"color": _PALETTE[place], "marker": marker, "linestyle": _DASHES[step % len(_DASHES)]}
    return result


def draw(folder: Path, stem: str, title: str, panels: list[Panel]) -> Plot | None:
    """Writes folder/plots/stem.svg and .png; None when no panel has a point to show."""
    panels = [panel for panel in panels if _cleaned(panel)]
    if not panels:
        return None
    names = list(dict.fromkeys(curve.name for panel in panels for curve in panel.curves))
    shared = len(panels) == 1 or len(names) < sum(len(panel.curves) for panel in panels)
    columns = 2 if len(panels) == 4 else min(_PANELS_A_ROW, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = pyplot.subplots(
        rows,
        columns,
        figsize=((PANEL_WIDTH + (0 if shared else 1)) * columns, PANEL_HEIGHT * rows + 0.8),
        squeeze=False,
    )
    cells = list(axes.flat)
    for cell, panel in zip(cells, panels):
        _draw_panel(cell, panel, styles(names if shared else [curve.name for curve in panel.curves]))
        if not shared:
            cell.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncol=2, fontsize=8)
    for cell in cells[len(panels) :]:
        cell.axis("off")
    if shared:
        _legend(figure, cells[: len(panels)])
    height = figure.get_figheight()
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.3 / height))
    figure.suptitle(title, fontsize=12, fontweight="bold", x=0.01, ha="left", y=1.0, va="top")
    shown = ", ".join(panel.y_label for panel in panels)
    return _save(folder, stem, figure, title, f"{title}: {shown} against {panels[0].x_label}, for {', '.join(names)}")


def ratios(
    folder: Path, stem: str, title: str, x_label: str, found: list[tuple[str, float]], mark: Line
) -> Plot | None:
    """One row a name: how far its ratio lies from the line that it is compared with, on a logarithmic axis."""
    found = [(name, ratio) for name, ratio in found if ratio > 0][::-1]
    if not found:
        return None
    figure, axes = pyplot.subplots(figsize=(PANEL_WIDTH * 1.8, 1.1 + 0.3 * len(found)))
    rows, lengths = range(len(found)), [ratio for _, ratio in found]
    axes.hlines(rows, mark.y, lengths, color=_PALETTE[0], linewidth=2.5)
    axes.plot(lengths, rows, "o", color=_PALETTE[0], markersize=8)
    axes.axvline(mark.y, color="#000000", linewidth=1.2, linestyle=(0, (4, 3)))
    axes.text(mark.y, len(found) - 0.45, mark.name, va="bottom", ha="center", fontsize=9)
    axes.set_yticks(rows, [name for name, _ in found])
    axes.set_ylim(-0.6, len(found) - 0.5)
    axes.set_xscale("log")
    axes.set_xlim(min(lengths + [mark.y]) / 1.5, max(lengths + [mark.y]) * 1.5)
    axes.grid(axis="y", visible=False)
    _plain_ticks(axes, "x")
    axes.set_xlabel(x_label)
    axes.set_title(title, fontsize=12, fontweight="bold", loc="left", pad=22)
    return _save(folder, stem, figure, title, f"{title}: {x_label}, for {', '.join(name for name, _ in found[::-1])}")


def _save(folder: Path, stem: str, figure: Figure, title: str, description: str) -> Plot:
    svg, png = f"plots/{stem}.svg", f"plots/{stem}.png"
    (folder / "plots").mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / svg, metadata={"Date": None}, bbox_inches="tight")
    figure.savefig(folder / png, dpi=_PNG_DPI, metadata={"Software": None}, bbox_inches="tight")
    pyplot.close(figure)
    return Plot(svg, png, title, description)


def _cleaned(panel: Panel) -> bool:
    """Drops what a logarithmic axis cannot show; whether anything is left."""
    for curve in panel.curves:
        curve.points = sorted(
            (p for p in curve.points if (p.x > 0 or not panel.log_x) and (p.y > 0 or not panel.log_y)),
            key=lambda p: p.x,
        )
    panel.curves = [curve for curve in panel.curves if curve.points]
    panel.lines = [line for line in panel.lines if line.y > 0 or not panel.log_y]
    return bool(panel.curves)


def _spread(values: list[float], ranges: list[tuple[float, float] | None]) -> list[list[float]] | None:
    """Matplotlib's error bars: distances below and above, none of them negative."""
    if not any(ranges):
        return None
    below = [max(0.0, v - r[0]) if r else 0.0 for v, r in zip(values, ranges)]
    above = [max(0.0, r[1] - v) if r else 0.0 for v, r in zip(values, ranges)]
    return [below, above]


def _draw_panel(axes: Axes, panel: Panel, looks: dict[str, dict[str, object]]) -> None:
    for curve in panel.curves:
        xs, ys = [p.x for p in curve.points], [p.y for p in curve.points]
        axes.errorbar(
            xs,
            ys,
            yerr=_spread(ys, [p.y_range for p in curve.points]),
            xerr=_spread(xs, [p.x_range for p in curve.points]),
            label=curve.name,
            capsize=2.5,
            elinewidth=1.0,
            **looks[curve.name],
        )
        loaded = [p for p in curve.points if p.loaded]
        axes.plot([p.x for p in loaded], [p.y for p in loaded], **_LOADED_RING)
    if panel.log_x:
        axes.set_xscale("log")
    if panel.log_y:
        axes.set_yscale("log")
    for line in panel.lines:
        axes.axhline(line.y, color="#555555", linewidth=1.2, linestyle=(0, (4, 3)))
        axes.text(
            0.01,
            line.y,
            f" {line.name}",
            transform=axes.get_yaxis_transform(),
            va="bottom",
            fontsize=8,
            color="#333333",
        )
    if panel.diagonal:
        xs = sorted({p.x for curve in panel.curves for p in curve.points})
        axes.plot(xs, xs, color="#555555", linewidth=1.2, linestyle=(0, (4, 3)))
        axes.text(xs[-1], xs[-1], f"{panel.diagonal} ", va="bottom", ha="right", fontsize=8, color="#333333")
    axes.set_title(panel.hint, fontsize=9, loc="left", color="#555555")
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)
    for name, log in (("x", panel.log_x), ("y", panel.log_y)):
        if log:
            _plain_ticks(axes, name)
        elif name == "y":
            axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))


def _plain_ticks(axes: Axes, name: str) -> None:
    """A logarithmic axis that spans at least a factor of five, its numbers as people write them."""
    axis = axes.xaxis if name == "x" else axes.yaxis
    low, high = axes.get_xlim() if name == "x" else axes.get_ylim()
    if high / low < _LEAST_SPAN:
        middle = math.sqrt(low * high)
        low, high = middle / math.sqrt(_LEAST_SPAN), middle * math.sqrt(_LEAST_SPAN)
        (axes.set_xlim if name == "x" else axes.set_ylim)(low, high)
    span = high / low
    subs = (1.0, 2.0, 5.0) if span < 50 else (1.0, 3.0) if span < 500 else (1.0,)
    axis.set_major_locator(LogLocator(subs=subs, numticks=12))
    wide = high > 1e6 or low < 1e-4 or span > 1e5
    plain = FuncFormatter(lambda tick, _: f"{tick:,.0f}" if tick >= 10000 else f"{tick:g}")
    axis.set_major_formatter(LogFormatterSciNotation(minor_thresholds=(math.inf, math.inf)) if wide else plain)
    axis.set_minor_formatter(NullFormatter())


def _legend(figure: Figure, cells: list[Axes]) -> None:
    entries = {label: handle for cell in cells for handle, label in zip(*cell.get_legend_handles_labels())}
    figure.legend(entries.values(), entries.keys(), loc="upper left", bbox_to_anchor=(1.0, 0.92), fontsize=9)
