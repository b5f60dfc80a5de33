# SPDX-License-Identifier: MIT
"""When is a picture right? The two words of docs/design.md, section 8, for pictures given as (height, width, channels)
arrays of uint8, top row first:

same   every pixel identical.
match  for several tiles against one window, where no reference can be made whose viewport is offset in the same way and
       rounds as theirs does: few pixels differ by more than 2 levels, and next to none lie outside the range of the
       reference's 3x3 neighbourhood widened by 8.

As a program: compare.py same|match REFERENCE.png PICTURE.png [--diff DIFF.png]; exit code 1 if it is not.
"""
from __future__ import annotations

import argparse
import dataclasses
import sys
from pathlib import Path

import cv2
import numpy as np

LEVELS = 2  # a rounding difference that does not count, of 255
WIDENED_BY = 8  # levels around the reference's 3x3 neighbourhood
DIFFERING_SHARE = 1e-4  # of the pixels, may differ by more than LEVELS
OUTSIDE_SHARE = 1e-5  # of the pixels, may lie outside the widened neighbourhood ...
OUTSIDE_PIXELS = 4  # ... or this many, whichever is more


@dataclasses.dataclass(frozen=True)
class Verdict:
    """What a comparison found. Counts are pixels; a pixel counts once however many of its channels differ."""

    word: str
    good: bool
    pixels: int = 0
    unequal: int = 0
    differing: int = 0
    outside: int = 0
    largest: int = 0
    reason: str = ""

    def __str__(self) -> str:
        if self.reason:
            return f"not {self.word}: {self.reason}"
        return (f"{'' if self.good else 'not '}{self.word}: {self.unequal} of {self.pixels} pixels unequal, "
                f"{self.differing} by more than {LEVELS}, {self.outside} outside their neighbourhood, "
                f"largest difference {self.largest}")


def difference(reference: np.ndarray, picture: np.ndarray) -> np.ndarray:
    """Per pixel, the largest difference of any channel, as (height, width) uint8."""
    return cv2.absdiff(reference, picture).reshape(*reference.shape[:2], -1).max(axis=2)


def outside_neighbourhood(reference: np.ndarray, picture: np.ndarray) -> np.ndarray:
    """Per pixel, whether any channel leaves the range of the reference's 3x3 neighbourhood widened by WIDENED_BY."""
    kernel = np.ones((3, 3), np.uint8)
    low = cv2.erode(reference, kernel, borderType=cv2.BORDER_REPLICATE).astype(np.int16) - WIDENED_BY
    high = cv2.dilate(reference, kernel, borderType=cv2.BORDER_REPLICATE).astype(np.int16) + WIDENED_BY
    wide = picture.astype(np.int16)
    return ((wide < low) | (wide > high)).reshape(*reference.shape[:2], -1).any(axis=2)


def _measure(word: str, reference: np.ndarray, picture: np.ndarray) -> Verdict:
    if reference.shape != picture.shape:
        return Verdict(word, False, reason=f"reference is {reference.shape}, picture is {picture.shape}")
    if reference.dtype != np.uint8 or picture.dtype != np.uint8:
        return Verdict(word, False, reason=f"types {reference.dtype}, {picture.dtype} instead of uint8")
    if reference.size == 0:
        return Verdict(word, False, reason="pictures are empty")
    far = difference(reference, picture)
    return Verdict(word, False, far.size, int(np.count_nonzero(far)), int(np.count_nonzero(far > LEVELS)),
                   int(np.count_nonzero(outside_neighbourhood(reference, picture))), int(far.max()))


def same(reference: np.ndarray, picture: np.ndarray) -> Verdict:
    found = _measure("same", reference, picture)
    return found if found.reason else dataclasses.replace(found, good=found.unequal == 0)


def match(reference: np.ndarray, picture: np.ndarray) -> Verdict:
    found = _measure("match", reference, picture)
    if found.reason:
        return found
    outside_limit = max(OUTSIDE_SHARE * found.pixels, OUTSIDE_PIXELS)
    good = found.differing <= DIFFERING_SHARE * found.pixels and found.outside <= outside_limit
    return dataclasses.replace(found, good=good)


WORDS = {"same": same, "match": match}


def difference_picture(reference: np.ndarray, picture: np.ndarray) -> np.ndarray:
    """Reference, picture and their difference side by side (height, 3 x width, 3); differences up to LEVELS are dark
    grey, larger ones are at least half bright and coloured by channel."""
    if reference.shape != picture.shape:
        height = max(reference.shape[0], picture.shape[0])
        return np.hstack([_padded(reference, height), _padded(picture, height)])
    far = cv2.absdiff(reference, picture)
    shown = np.where(far > 0, np.maximum(far, 128), 0).astype(np.uint8)
    shown[(difference(reference, picture) > 0) & (difference(reference, picture) <= LEVELS)] = 48
    return np.hstack([_padded(each, reference.shape[0]) for each in (reference, picture, shown)])


def _padded(picture: np.ndarray, height: int) -> np.ndarray:
    colour = picture if picture.ndim == 3 else picture[..., None]
    colour = colour[..., :3] if colour.shape[2] >= 3 else np.repeat(colour[..., :1], 3, axis=2)
    return np.pad(colour, ((0, height - colour.shape[0]), (0, 0), (0, 0)))


def load_png(path: Path | str) -> np.ndarray:
    """A PNG file as RGB."""
    picture = cv2.imread(str(path), cv2.IMREAD_COLOR)
    if picture is None:
        raise OSError(f"{path}: no readable picture")
    return picture[..., ::-1].copy()


def save_png(path: Path | str, picture: np.ndarray) -> None:
    """Writes RGB."""
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    if not cv2.imwrite(str(path), picture[..., ::-1]):
        raise OSError(f"{path}: cannot write")


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("word", choices=sorted(WORDS))
    arguments.add_argument("reference", type=Path)
    arguments.add_argument("picture", type=Path)
    arguments.add_argument("--diff", type=Path, help="write reference, picture and difference here if it fails")
    options = arguments.parse_args()
    reference, picture = load_png(options.reference), load_png(options.picture)
    verdict = WORDS[options.word](reference, picture)
    print(verdict)
    if not verdict.good and options.diff:
        save_png(options.diff, difference_picture(reference, picture))
    return 0 if verdict.good else 1


if __name__ == "__main__":
    sys.exit(main())
