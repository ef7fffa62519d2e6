"""Colours: linear Rec. 709, three channels, as everywhere in isolux."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from .errors import ParameterError

Color: TypeAlias = float | Sequence[float] | npt.NDArray[Any]
"""A number for all three channels, or three numbers: red, green, blue."""

Floats: TypeAlias = npt.NDArray[np.float32]
Integers: TypeAlias = npt.NDArray[Any]

LUMINANCE = np.array([0.2126, 0.7152, 0.0722], dtype=np.float32)
"""Weight of each channel in lumens, lux and candela (Rec. 709)."""


def luminance(values: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """What a luxmeter reads of colours of shape (..., 3): `0.2126 r + 0.7152 g + 0.0722 b`, of shape (...).

    The error of a luminance is this of the errors of its channels, which ride on the same rays.
    """
    return np.asarray(values) @ LUMINANCE


def color(name: str, value: Color) -> tuple[float, float, float]:
    """Three channels, finite and not negative; `name` is for messages."""
    channels = np.asarray(value, dtype=float)
    if channels.shape == ():
        channels = np.repeat(channels, 3)
    if channels.shape != (3,) or not np.isfinite(channels).all() or (channels < 0).any():
        raise ParameterError.of(name, value, "one number, or three for red, green and blue; none below 0")
    return float(channels[0]), float(channels[1]), float(channels[2])


def reflectivity(name: str, value: Color) -> tuple[float, float, float]:
    """A colour below 1: a surface that reflects everything would never let the light come to rest."""
    channels = color(name, value)
    if max(channels) >= 1:
        raise ParameterError.of(name, value, "shares of the light, below 1")
    return channels


def from_srgb(values: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Linear values of sRGB ones, both between 0 and 1 (IEC 61966-2-1)."""
    values = np.asarray(values, dtype=float)
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
