"""Bodies, garments, size and fit."""

import dataclasses
import math
import pickle

import numpy as np
import pytest

import toile


def test_a_body_has_the_measures_that_were_given(body):
    assert body.sex == "female"
    assert body.measure("chest") == pytest.approx(920, abs=2)
    assert body.measures["stature"] == pytest.approx(1720, abs=2)
    assert set(body.measures) == set(toile.measure_names())
    assert "stature 1720" in repr(body)


def test_a_bodys_mesh_is_shown_without_a_copy(body):
    positions, faces = body.positions, body.faces
    assert positions.dtype == np.float32 and positions.shape[1] == 3
    assert faces.dtype == np.uint32 and faces.shape[1] == 3
    assert faces.max() < len(positions)
    assert np.isfinite(positions).all()
    assert np.shares_memory(positions, body.positions) and np.shares_memory(faces, body.faces)
    height = positions[:, 1].max() - positions[:, 1].min()
    assert height == pytest.approx(1.72, abs=0.02)


def test_the_average_body_is_the_one_of_its_measures():
    average = toile.Body.average("male")
    assert average.sex == "male" and average.notes == ()
    names = ["stature", "shoulder_breadth", "chest_girth", "waist_girth", "hip_girth"]
    again = toile.Body.from_measures("male", **{name: average.measure(name) for name in names})
    assert np.allclose(average.positions, again.positions, atol=1e-3)


def of_the_table(garment):
    """The sizes that a recommendation weighs: all but the one that is cut for a body."""
    return [size for size in garment.sizes if size != "to measure"]


def test_a_garment_says_what_it_is(shirt):
    assert shirt.name == "tee" and shirt.size is None
    assert len(shirt.sizes) > 2 and shirt.fabric in toile.fabric_names()
    assert "tee" in toile.garment_names()
    own = toile.Garment("tee", size=shirt.sizes[0], fabric="jersey-dots")
    assert own.size == shirt.sizes[0] and own.fabric == "jersey-dots"


def test_a_recommendation_is_of_plain_objects(body, shirt):
    fit = toile.recommend(body, shirt)
    assert fit.size in shirt.sizes and fit.garment == "tee"
    assert [chance.size for chance in fit.sizes] == of_the_table(shirt)
    assert sum(chance.probability for chance in fit.sizes) == pytest.approx(1, abs=1e-4)
    assert fit.zones and all(isinstance(zone.ease_mm, float) and zone.sigma_mm > 0 for zone in fit.zones)
    assert {zone.verdict for zone in fit.zones} <= {"tight", "good", "loose"}
    assert shirt.fit(body) == fit
    assert pickle.loads(pickle.dumps(fit)) == fit
    assert dataclasses.asdict(fit)["zones"][0]["zone"] == fit.zones[0].zone


def test_a_smaller_size_has_less_ease(body, shirt):
    eases = [toile.Garment("tee", size=size).fit(body).zones[0].ease_mm for size in of_the_table(shirt)]
    assert eases == sorted(eases) and eases[0] < eases[-1]


def test_colours_of_the_fit_map_are_steps():
    colours = toile.fit_colours([-1.0, 0.0, 1.0, math.nan])
    assert colours.shape == (4, 3) and colours.dtype == np.uint8
    assert tuple(colours[3]) == (128, 128, 128)
    assert len({tuple(colour) for colour in colours.tolist()}) == 4
