"""Plain objects: what is given along by name, and what comes back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Mapping, Optional, Sequence, Tuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ._toile import Scene

__all__ = [
    "GarmentStats",
    "Measure",
    "MeasureAdvice",
    "Recommendation",
    "Shopper",
    "SizeChance",
    "Snapshot",
    "TryOn",
    "Wind",
    "WornGarment",
    "ZoneFit",
]


@dataclass(frozen=True)
class Shopper:
    """What is known of a person before they are measured.

    Parameters
    ----------
    sex : {"female", "male"}, optional
        Whose proportions apply; otherwise depth decides where it can.
    child : bool, optional
    tight_clothes : bool
        Whether they wear nothing that stands off the skin; otherwise everyday clothes, which the body lies beneath.
    seated : bool
        Whether they sit: nothing is taken from legs and hips, which a chair hides.
    by_tape : mapping of str to float
        Measures that were taken by tape (mm), by name; all others follow them.
    """

    sex: Optional[str] = None
    child: Optional[bool] = None
    tight_clothes: bool = False
    seated: bool = False
    by_tape: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Wind:
    """Air that moves.

    Parameters
    ----------
    velocity : sequence of float
        Along x, y, z (m/s).
    drag, lift : float
        Coefficients (1), 0 to 100.
    """

    velocity: Sequence[float]
    drag: float = 0.1
    lift: float = 0.05


@dataclass(frozen=True)
class Measure:
    """A measure of a person: its name, value and standard deviation (mm), whether it was seen, where it is taken."""

    name: str
    mm: float
    sigma_mm: float
    seen: bool
    definition: str


@dataclass(frozen=True)
class SizeChance:
    """A size with the probability that it suits this person best; those of all sizes sum to 1."""

    size: str
    probability: float


@dataclass(frozen=True)
class ZoneFit:
    """How a zone of a garment fits.

    Attributes
    ----------
    zone : str
        "chest", "waist" or "hip".
    primary : bool
        Whether the size is chosen by this zone.
    ease_mm, sigma_mm : float
        Girth of the garment less that of the body, and its standard deviation (mm).
    verdict : str
        "tight", "good", "loose", or "unknown" where the body was not seen there.
    feel : str or None
        From "too tight" over "right" to "too loose".
    tightness : float or None
        -1 (loose) .. 1 (tight), within half of it where the zone is comfortable.
    sentence : str
        The same for a person to read.
    """

    zone: str
    primary: bool
    ease_mm: float
    sigma_mm: float
    verdict: str
    feel: Optional[str]
    tightness: Optional[float]
    sentence: str


@dataclass(frozen=True)
class MeasureAdvice:
    """Advice to take a girth by tape: the zone, the chance of the best size once it is known, and a sentence."""

    zone: str
    probability: float
    sentence: str


@dataclass(frozen=True)
class Recommendation:
    """A size, judged on a body.

    Attributes
    ----------
    garment, size : str
    probability : float
        That this size suits this person best.
    sizes : tuple of SizeChance
        Every size that is made, smallest first.
    uncertain : bool
        Whether no size is sure.
    advice : MeasureAdvice or None
        The measure to take by tape, where that is so and it would help.
    verdict : str
        The recommendation in sentences.
    zones : tuple of ZoneFit
        The primary ones first.
    runner_up : str or None
        The next best size, where it may be the better one.
    note : str or None
        Set where no size is made for this person, or guesses stand for measures.
    """

    garment: str
    size: str
    probability: float
    sizes: Tuple[SizeChance, ...]
    uncertain: bool
    advice: Optional[MeasureAdvice]
    verdict: str
    zones: Tuple[ZoneFit, ...]
    runner_up: Optional[str]
    note: Optional[str]


@dataclass(frozen=True)
class WornGarment:
    """A garment of a scene: name, size and fabric, how many vertices, faces and layers, its fit where it has sizes, and notes."""

    name: str
    size: str
    fabric: str
    vertices: int
    faces: int
    layers: int
    fit: Optional[Recommendation]
    notes: Tuple[str, ...]


@dataclass(frozen=True)
class GarmentStats:
    """How a garment does at the moment.

    Attributes
    ----------
    strain_mean, strain_p99, strain_max : float
        Strain of warp and weft edges, ``abs(length / rest - 1)`` (1).
    penetration_mm : float
        Deepest point of a free particle inside of the body or the colliders (mm).
    rolled_back : int
        Steps so far that were not finite and were rolled back.
    """

    strain_mean: float
    strain_p99: float
    strain_max: float
    penetration_mm: float
    rolled_back: int


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Everything that a display needs of one moment: positions of each garment and of the body (m), the body's unit normals."""

    step: int
    time: float
    garments: Tuple[NDArray[np.float32], ...]
    body: NDArray[np.float32]
    body_normals: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class TryOn:
    """What a try-on gives: measures by name, notes, the fit of each garment, pictures and fit maps by view, and the scene."""

    measures: Mapping[str, Measure]
    notes: Tuple[str, ...]
    fits: Tuple[Optional[Recommendation], ...]
    pictures: Mapping[str, NDArray[np.uint8]]
    fit_maps: Mapping[str, NDArray[np.uint8]]
    scene: Scene
