"""What many tests take: a body, a garment, a small cloth."""

import numpy as np
import pytest

import toile

CORNERS = np.array([[0, 1, 0], [0.1, 1, 0], [0, 1.1, 0], [0.1, 1.1, 0]], dtype=np.float32)
FACES = np.array([[0, 1, 2], [1, 3, 2]], dtype=np.uint32)


@pytest.fixture(scope="session")
def body():
    return toile.Body.from_measures("female", stature=1720, chest=920, waist=760, hip=1000)


@pytest.fixture(scope="session")
def shirt():
    return toile.Garment("tee")


@pytest.fixture(scope="session")
def worn(body, shirt):
    """A dressed body that is never stepped."""
    return toile.Scene(body, shirt)


@pytest.fixture
def cloth():
    """Two triangles that hang by their upper edge."""
    with toile.Scene.of_mesh(CORNERS, FACES, pins=[2, 3]) as scene:
        yield scene


GRID = """
duration = 10
[garment]
grid = { rows = 60, columns = 60, width = 1.0, height = 1.0 }
position = [0, 2, 0]
pin = { vertices = [0, 59] }
"""


@pytest.fixture
def curtain():
    """3,600 vertices, whose steps take a while."""
    with toile.Scene.parse(GRID) as scene:
        yield scene
