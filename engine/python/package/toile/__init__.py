"""A virtual fitting room: bodies of measures, garments, cloth that moves, size and fit.

>>> import toile
>>> body = toile.Body.from_measures("female", stature=1720, chest=920, waist=760, hip=1000)
>>> shirt = toile.Garment("tee")  # or a file: "shirt.obj"
>>> fit = toile.recommend(body, shirt)
>>> with toile.Scene(body, shirt) as scene:
...     scene.step(120)
...     positions, faces, tightness = scene.positions(), scene.faces(), scene.fit_map()

Metres and seconds; what is taken by tape, and ease, in millimetres. Right-handed, y up, the floor at y = 0, a body facing +z. The
guide is docs/python.md.
"""

from ._toile import (
    JOINTS,
    TIME_STEP,
    Body,
    DepthFrame,
    Garment,
    Measured,
    Recording,
    Scene,
    Track,
    __version__,
    fabric_names,
    fit_colours,
    garment_names,
    measure,
    measure_names,
    recommend,
    study_row,
    try_on,
)
from .answers import (
    GarmentStats,
    Measure,
    MeasureAdvice,
    Recommendation,
    Shopper,
    SizeChance,
    Snapshot,
    TryOn,
    Wind,
    WornGarment,
    ZoneFit,
)
from .errors import DeviceError, InputError, InternalError, ToileError, UsageError

__all__ = [
    "JOINTS",
    "TIME_STEP",
    "Body",
    "DepthFrame",
    "DeviceError",
    "Garment",
    "GarmentStats",
    "InputError",
    "InternalError",
    "Measure",
    "MeasureAdvice",
    "Measured",
    "Recommendation",
    "Recording",
    "Scene",
    "Shopper",
    "SizeChance",
    "Snapshot",
    "ToileError",
    "Track",
    "TryOn",
    "UsageError",
    "Wind",
    "WornGarment",
    "ZoneFit",
    "__version__",
    "fabric_names",
    "fit_colours",
    "garment_names",
    "measure",
    "measure_names",
    "recommend",
    "study_row",
    "try_on",
]
