"""Which experiment is shown how: the table SECTIONS maps its name to a question and a builder.

A new experiment without a line there is shown as a table with its pictures; one line gives it plots.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Callable

from blocks import Block, Context
from builders import error_against_cost, error_against_share, growth, hard_cases, plain, ratio_rows

Builder = Callable[[Context], list[Block]]


@dataclass(frozen=True)
class Section:
    title: str
    question: str
    build: Builder


_ERRORS = ("relmse", "flip", "flip_salient")
_MOVING = ("flip", "flip_salient", "flip_step", "relmse")
_TIMES = ("frame_p95", "missed_share", "samples_per_second", "rays_per_second", "peak_bytes")
_GROWTH = {
    "triangles": "triangles in the scene",
    "samples": "cached samples",
    "objects": "objects",
    "pixels": "pixels of the picture",
    "threads": "tracer threads",
}

SECTIONS: dict[str, Section] = {
    "still": Section(
        "Still views",
        "The camera rests: how far is each method's picture from the reference after so many seconds?",
        partial(error_against_cost, metrics=_ERRORS, x_label="time spent (s)"),
    ),
    "order": Section(
        "Orders of samples",
        "Which order of samples nears the converged picture with the fewest?",
        partial(error_against_cost, metrics=_ERRORS, x_label="corrective samples"),
    ),
    "walk-order": Section(
        "Orders of samples on a walk",
        "Does it pay to correct first what attracts the eye, at 1, 5 and 20 thousand samples a frame?",
        partial(error_against_cost, metrics=("flip_salient", "flip", "rmse"), x_label="new samples a frame"),
    ),
    "moving": Section(
        "Moving camera",
        "The camera walks a path and every frame has a deadline: how far off are the frames, and are they in time?",
        partial(
            error_against_cost,
            metrics=_MOVING,
            x_label="budget of a frame, or its time without one (ms)",
            timing=_TIMES,
        ),
    ),
    "validity": Section(
        "Validity of cached samples",
        "How valid are the cached samples that aging keeps, and how many valid ones does it drop?",
        partial(
            error_against_share,
            metrics=("error", "precision", "walk_flip"),
            share="reuse",
            x_label="share of cached samples kept",
            group="kind",
        ),
    ),
    "maps": Section(
        "Illumination maps",
        "How far are the maps from the light that is there after so many seconds, beside path tracing from every texel?",
        partial(error_against_cost, metrics=("relerr",), x_label="time spent (s)"),
    ),
    "peers": Section(
        "Beside other renderers",
        "The same scene by Blender's Cycles and by us: whose picture is nearer to the reference after so many seconds?",
        partial(error_against_cost, metrics=_ERRORS, x_label="time spent (s)"),
    ),
    "paper": Section(
        "Beside the papers",
        "What the papers report for their machines, and what this one gives.",
        partial(
            ratio_rows,
            metric="ratio",
            x_label="ours / the paper's (↓ lower is better, ↑ higher is better)",
            mark="as the paper's",
            caption="Ours over the paper's",
        ),
    ),
    "figures": Section(
        "Figures of the papers", "What our splats and reused samples look like beside the papers' own figures.", plain
    ),
    "untraced": Section(
        "The frame without tracing",
        "What do drawing, warping, splatting, read-back and composing cost beside the bare draw?",
        plain,
    ),
    "cache": Section(
        "Large caches",
        "Do aging, warping and splatting stay linear in the cached samples?",
        partial(growth, x_units={"": "cached samples"}),
    ),
    "gallery-walk": Section(
        "The gallery walk", "Does the frame rate hold, and how many new samples does a frame get?", plain
    ),
    "recording": Section("Recording", "What does recording a walk cost the frame, and how large does it get?", plain),
    "growth": Section(
        "Growth",
        "How do frame time and memory grow with the scene, the cache, the picture and the threads?",
        partial(growth, x_units=_GROWTH),
    ),
    "rays": Section(
        "Rays",
        "How much of bare Embree's speed is left in the corrective loop? (loop over bare replay of the same rays)",
        plain,
    ),
    "hard": Section(
        "Hard cases", "The error that each numerically hard case shows, beside what its truth allows.", hard_cases
    ),
    "quality": Section(
        "Converged against path-traced", "How far is the converged picture from the path-traced one, and why?", plain
    ),
    "many-lights": Section(
        "Many lamps",
        "What does a light sample cost, and how noisy is it, among many lamps?",
        partial(growth, x_units={"": "lamps"}),
    ),
    "attention": Section(
        "The saliency model", "What does it cost beside plain OpenCV, and does it foretell where people look?", plain
    ),
    "approximation": Section(
        "Until an object is corrected", "How near are light probes to the converged picture before samples arrive?", plain
    ),
    "load": Section(
        "From file to first frame", "Seconds and bytes until the first picture, beside a bare parse of the file.", plain
    ),
    "first-frame": Section(
        "The window's first frame", "Seconds from the program's start to a scene's first picture, maps ready.", plain
    ),
    "reference": Section("References", "The pictures that everything is measured against, and their own error.", plain),
}


def section_of(experiment: str) -> Section:
    return SECTIONS.get(experiment, Section(experiment.replace("-", " ").capitalize(), "", plain))
