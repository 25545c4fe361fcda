"""What LiteRT computes of pictures, for tests/parity.rs: python3 reference.py FOLDER, the folder with the network's files.

Needs `pip install ai-edge-litert numpy pillow`. Writes reference.bin: of each picture the outputs of lite, full and the
detector, f32, little-endian, first by its plain kernels and then by XNNPACK; of the detector every eighth anchor. And
face_reference.bin: of a drawn face, grey and noise the same of the face mesh and of the detector of faces.
"""

import pathlib
import sys

import numpy
from ai_edge_litert.interpreter import Interpreter, OpResolverType
from PIL import Image

HERE = pathlib.Path(__file__).parent
FOLDER = pathlib.Path(sys.argv[1])


def noise(count):
    """SplitMix64 from seed 1: numbers in 0 .. 1."""
    numpy.seterr(over="ignore")
    state = numpy.uint64(1) + numpy.uint64(0x9E3779B97F4A7C15) * numpy.arange(1, count + 1, dtype=numpy.uint64)
    z = (state ^ (state >> numpy.uint64(30))) * numpy.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> numpy.uint64(27))) * numpy.uint64(0x94D049BB133111EB)
    z = z ^ (z >> numpy.uint64(31))
    return ((z >> numpy.uint64(40)).astype(numpy.float32) / numpy.float32(1 << 24)).astype(numpy.float32)


def pictures(side, names=("front", "side")):
    """A person from the front and from the side, or a face; grey, noise."""
    for name in names:
        person = Image.open(HERE / f"{name}_{side}.png").convert("RGB")
        yield numpy.asarray(person, numpy.float32) / numpy.float32(255)
    yield numpy.full((side, side, 3), 0.5, numpy.float32)
    yield noise(side * side * 3).reshape(side, side, 3)


def network(name, kernels, part=slice(None)):
    content = (FOLDER / name).read_bytes()[part]
    interpreter = Interpreter(model_content=content, num_threads=1, experimental_op_resolver_type=kernels)
    interpreter.allocate_tensors()
    return interpreter


def run(interpreter, picture, shapes):
    interpreter.set_tensor(interpreter.get_input_details()[0]["index"], picture[None].astype(numpy.float32))
    interpreter.invoke()
    for shape in shapes:
        found = next(o for o in interpreter.get_output_details() if list(o["shape"]) == shape)
        yield interpreter.get_tensor(found["index"]).astype("<f4")


parts = []
for kernels in [OpResolverType.BUILTIN_REF, OpResolverType.AUTO]:
    for name in ["pose_landmark_lite.tflite", "pose_landmark_full.tflite"]:
        interpreter = network(name, kernels)
        for picture in pictures(256):
            parts += [o.ravel() for o in run(interpreter, picture, [[1, 195], [1, 1], [1, 117]])]
    interpreter = network("pose_solution_packed_assets.data", kernels)
    for picture in pictures(224):
        scaled = picture * numpy.float32(2) - numpy.float32(1)
        parts += [o[0, ::8].ravel() for o in run(interpreter, scaled, [[1, 2254, 12], [1, 2254, 1]])]
(HERE / "reference.bin").write_bytes(numpy.concatenate(parts).astype("<f4").tobytes())

# Where the two networks lie in the face network's file.
FACE, MESH, DETECTOR = "face_mesh_solution_packed_assets.data", slice(2_495_952, 3_737_848), slice(3_757_224, 3_986_256)
parts = []
for kernels in [OpResolverType.BUILTIN_REF, OpResolverType.AUTO]:
    interpreter = network(FACE, kernels, MESH)
    for picture in pictures(192, ["face"]):
        parts += [o.ravel() for o in run(interpreter, picture, [[1, 1, 1, 1404], [1, 1, 1, 1]])]
    interpreter = network(FACE, kernels, DETECTOR)
    for picture in pictures(128, ["face"]):
        scaled = picture * numpy.float32(2) - numpy.float32(1)
        parts += [o[0, ::8].ravel() for o in run(interpreter, scaled, [[1, 896, 16], [1, 896, 1]])]
(HERE / "face_reference.bin").write_bytes(numpy.concatenate(parts).astype("<f4").tobytes())
