# SPDX-License-Identifier: MIT
"""Line charts as SVG: both axes logarithmic, a mark for each point, a line's name at its end."""
from __future__ import annotations

import dataclasses
import html
import math
from pathlib import Path

WIDTH, HEIGHT = 720, 420  # pixels
LEFT, RIGHT, TOP, BOTTOM = 70, 150, 40, 55
NAME_HEIGHT = 14
COLORS = ["#1b6ca8", "#c8553d", "#2d7d46", "#7a4fa3", "#b8860b", "#444444", "#0b8a8a"]


@dataclasses.dataclass
class Line:
    name: str
    points: list[tuple[float, float]]  # x and y, both above 0


def chart(title: str, x_name: str, y_name: str, lines: list[Line], x_labels: dict[float, str]) -> str:
    """`x_labels`: where the x axis has marks, and what stands there."""
    xs = [x for line in lines for x, _ in line.points]
    ys = [y for line in lines for _, y in line.points]
    low, high = _decade(min(ys), math.floor), _decade(max(ys), math.ceil)

    def place(x: float, y: float) -> tuple[float, float]:
        across = (math.log(x) - math.log(min(xs))) / max(1e-9, math.log(max(xs)) - math.log(min(xs)))
        up = (math.log(y) - math.log(low)) / max(1e-9, math.log(high) - math.log(low))
        return LEFT + across * (WIDTH - LEFT - RIGHT), HEIGHT - BOTTOM - up * (HEIGHT - TOP - BOTTOM)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" '
           f'font-size="12" role="img"><title>{html.escape(title)}</title>',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
           _text(WIDTH / 2, 22, title, 'text-anchor="middle" font-size="15"'),
           _text(LEFT + (WIDTH - LEFT - RIGHT) / 2, HEIGHT - 12, x_name, 'text-anchor="middle"'),
           _text(16, TOP + (HEIGHT - TOP - BOTTOM) / 2, y_name, 'text-anchor="middle" transform="rotate(-90 16 '
                 f'{TOP + (HEIGHT - TOP - BOTTOM) / 2:.0f})"')]
    for x, label in x_labels.items():
        across = place(x, low)[0]
        out += [_line(across, TOP, across, HEIGHT - BOTTOM), _text(across, HEIGHT - BOTTOM + 18, label,
                                                                   'text-anchor="middle"')]
    for y in _marks(low, high):
        up = place(min(xs), y)[1]
        out += [_line(LEFT, up, WIDTH - RIGHT, up), _text(LEFT - 8, up + 4, f"{y:,g}", 'text-anchor="end"')]
    for number, line in enumerate(lines):
        color = COLORS[number % len(COLORS)]
        places = [place(*point) for point in line.points]
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        out.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="2"/>')
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="white" stroke="{color}" stroke-width="1.5"/>'
                for x, y in places]
    least = float(TOP)
    for end, number in sorted((place(*line.points[-1])[1], number) for number, line in enumerate(lines)):
        least = max(end, least)
        color = COLORS[number % len(COLORS)]
        out.append(_text(WIDTH - RIGHT + 10, least + 4, lines[number].name, f'fill="{color}"'))
        least += NAME_HEIGHT  # of the next one, which hides no other
    return "\n".join([*out, "</svg>", ""])


def save(path: Path, picture: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(picture)


def _decade(value: float, rounded) -> float:
    return 10.0 ** rounded(math.log10(value) - 1e-9 if rounded is math.ceil else math.log10(value))


def _marks(low: float, high: float) -> list[float]:
    decades = round(math.log10(high / low))
    steps = (1, 2, 5) if decades <= 3 else (1,)
    return [low * 10.0**decade * step for decade in range(decades + 1) for step in steps
            if low * 10.0**decade * step <= high * 1.001]


def _text(x: float, y: float, text: str, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" {more}>{html.escape(text)}</text>'


def _line(x0: float, y0: float, x1: float, y1: float) -> str:
    return f'<line x1="{x0:.1f}" y1="{y0:.1f}" x2="{x1:.1f}" y2="{y1:.1f}" stroke="#dddddd"/>'
