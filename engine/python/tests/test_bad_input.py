"""Every call with what it cannot take: an exception with a sentence, nothing changed, no crash."""

import math
import threading

import numpy as np
import pytest

import toile
from conftest import CORNERS, FACES

NAN = math.nan


def sentence(error):
    text = str(error.value)
    assert text and "\n" not in text and "panick" not in text and "--" not in text, text
    return text


def refused(kind, call, *words):
    with pytest.raises(kind) as error:
        call()
    text = sentence(error)
    if isinstance(error.value, toile.ToileError):
        assert error.value.kind in ("usage", "input", "device"), text
    for word in words:
        assert word in text, f"no {word!r} in: {text}"


USAGE, INPUT = toile.UsageError, toile.InputError


def test_the_hierarchy():
    for kind, name in [(USAGE, "usage"), (INPUT, "input"), (toile.DeviceError, "device"), (toile.InternalError, "internal")]:
        assert issubclass(kind, toile.ToileError) and kind.kind == name
    assert issubclass(INPUT, ValueError)


@pytest.mark.parametrize(
    "kind, measures, words",
    [
        (INPUT, {"chest": 92}, ["chest_girth", "centimetres"]),
        (INPUT, {"stature": 1.72}, ["metres"]),
        (INPUT, {"hip": NAN}, ["hip_girth"]),
        (INPUT, {"hip": math.inf}, ["hip_girth"]),
        (INPUT, {"wasit": 760}, ["wasit", "waist_girth"]),
        (INPUT, {"chest": 900, "bust": 910}, ["twice"]),
        (USAGE, {"chest": "wide"}, ["chest", "number"]),
        (USAGE, {"chest": None}, ["chest", "number"]),
        (USAGE, {"chest": np.zeros(3)}, ["chest", "number"]),
        (USAGE, {}, ["Body.average"]),
    ],
)
def test_measures(kind, measures, words):
    refused(kind, lambda: toile.Body.from_measures("female", **measures), *words)


def test_bodies(tmp_path):
    refused(USAGE, lambda: toile.Body.average("robot"), "female")
    refused(TypeError, lambda: toile.Body.average(None))
    refused(TypeError, lambda: toile.Body())
    refused(INPUT, lambda: toile.Body.open("no-such.glb", "male"), "no-such.glb")
    refused(USAGE, lambda: toile.Body.open(None, "male"), "NoneType")
    refused(USAGE, lambda: toile.Body.open(3, "male"), "int")
    (tmp_path / "a.glb").write_bytes(b"glTF" + bytes(40))
    refused(INPUT, lambda: toile.Body.open(tmp_path / "a.glb", "male"), "a.glb")
    body = toile.Body.average("male")
    refused(INPUT, lambda: body.measure("elbow"), "chest_girth")
    refused(TypeError, lambda: body.measure(None))
    with pytest.raises(AttributeError):
        body.positions = None


def test_garments(body):
    refused(INPUT, lambda: toile.Garment("sun-drses"), "strap-dress")
    refused(INPUT, lambda: toile.Garment("no-such.obj"), "no-such.obj")
    refused(INPUT, lambda: toile.Garment(""))
    refused(INPUT, lambda: toile.Garment("a\0b"))
    refused(USAGE, lambda: toile.Garment(None), "NoneType", "str")
    refused(INPUT, lambda: toile.Garment("tee", size="gigantic"), "choose one of")
    refused(TypeError, lambda: toile.Garment("tee", size=38))
    refused(INPUT, lambda: toile.Garment("tee", fabric="coton-lawn"), "cotton-lawn")
    refused(USAGE, lambda: toile.Garment("tee", fabric=3), "int")
    refused(TypeError, lambda: toile.recommend(body, None))
    refused(TypeError, lambda: toile.recommend(None, toile.Garment("tee")))


def test_a_mesh_without_sizes_has_no_fit(body, tmp_path):
    ring = [(0.2 * math.cos(a), 0.2 * math.sin(a)) for a in np.linspace(0, 2 * math.pi, 24, endpoint=False)]
    lines = [f"v {x} {y} {z}" for y in (1.4, 1.2, 1.0) for x, z in ring]
    for row in range(2):
        for i in range(24):
            a, b = row * 24 + i + 1, row * 24 + (i + 1) % 24 + 1
            lines.append(f"f {a} {b} {b + 24} {a + 24}")
    (tmp_path / "tube.obj").write_text("\n".join(lines))
    tube = toile.Garment(tmp_path / "tube.obj")
    assert tube.sizes == ()
    refused(INPUT, lambda: toile.recommend(body, tube), "without sizes")
    refused(INPUT, lambda: toile.Garment(tmp_path / "tube.obj", size="38"), "one size")


def test_scenes(body, shirt):
    refused(TypeError, lambda: toile.Scene(None, shirt))
    refused(USAGE, lambda: toile.Scene(body, None), "garment")
    refused(USAGE, lambda: toile.Scene(body, "tee"), "garment")
    refused(USAGE, lambda: toile.Scene(body, [shirt, None]), "garment")
    refused(INPUT, lambda: toile.Scene(body, [shirt] * 40), "leave some out")
    refused(USAGE, lambda: toile.Scene(body, shirt, quality="best"), "draft")
    refused(INPUT, lambda: toile.Scene(body, shirt, workers=3), "1 or 2")
    refused(USAGE, lambda: toile.Scene(body, shirt, workers=-1), "-1")
    refused(USAGE, lambda: toile.Scene(body, shirt, motion="dancing"), "standing")
    refused(INPUT, lambda: toile.Scene(body, shirt, motion=np.zeros((3, 4))), "(3, 4)", "(23, 4)")
    refused(INPUT, lambda: toile.Scene(body, shirt, motion=np.full((23, 4), NAN)), "not finite")
    refused(INPUT, lambda: toile.Scene(body, shirt, motion=np.zeros((23, 4))), "pelvis")
    refused(USAGE, lambda: toile.Scene(body, shirt, wind=3), "Wind")
    refused(INPUT, lambda: toile.Scene(body, shirt, wind=toile.Wind((0, 0))), "(2,)")
    refused(INPUT, lambda: toile.Scene(body, shirt, wind=toile.Wind((0, NAN, 0))), "finite")
    refused(INPUT, lambda: toile.Scene(body, shirt, wind=toile.Wind((1, 0, 0), drag=NAN)))
    refused(USAGE, lambda: toile.Scene(body, shirt, tuck="tee"), "list")
    refused(INPUT, lambda: toile.Scene(body, shirt, tuck=["coat"]), "coat")


def test_scene_files(tmp_path):
    refused(INPUT, lambda: toile.Scene.open("no-such.toml"), "no-such.toml")
    refused(USAGE, lambda: toile.Scene.open(None), "NoneType")
    refused(INPUT, lambda: toile.Scene.open(tmp_path), "")
    refused(INPUT, lambda: toile.Scene.parse("[garment"), "scene:1")
    refused(INPUT, lambda: toile.Scene.parse("[garment]\nmesh = \"a.obj\"\n"), "a.obj")
    refused(USAGE, lambda: toile.Scene.parse("", {"a.obj": "text"}), "bytes")
    refused(USAGE, lambda: toile.Scene.parse("", {3: b""}), "bytes")
    refused(TypeError, lambda: toile.Scene.parse(None))


@pytest.mark.parametrize(
    "positions, faces, pins, words",
    [
        (None, FACES, [2], ["positions", "dtype"]),
        (CORNERS[:, :2], FACES, [2], ["(4, 2)", "(n, 3)"]),
        (CORNERS.ravel(), FACES, [2], ["(12,)"]),
        (CORNERS.astype(complex), FACES, [2], ["complex128", "float32"]),
        (CORNERS.astype(str), FACES, [2], ["float32"]),
        (CORNERS > 0, FACES, [2], ["bool"]),
        ([[0, 1, 0], [1]], FACES, [2], ["positions"]),
        (np.full((4, 3), NAN), FACES, [2], ["row 0", "not finite"]),
        (CORNERS.astype(np.float64) * 1e300, FACES, [2], ["not finite"]),
        (np.empty((0, 3)), FACES, [], [""]),
        (CORNERS, None, [2], ["faces", "whole numbers"]),
        (CORNERS, FACES.astype(float), [2], ["float64", "uint32"]),
        (CORNERS, FACES.astype(np.int64) - 1, [2], ["faces", "0 to 4294967295"]),
        (CORNERS, FACES.astype(np.uint64) + 2**63, [2], ["faces", "0 to 4294967295"]),
        (CORNERS, FACES + 3, [2], ["triangle 0", "vertex"]),
        (CORNERS, FACES[:, :2], [2], ["(2, 2)"]),
        (CORNERS, np.empty((0, 3), dtype=np.uint32), [2], [""]),
        (CORNERS, FACES, [7], ["7"]),
        (CORNERS, FACES, [-1], ["pins"]),
        (CORNERS, FACES, [[2]], ["pins", "(1, 1)"]),
        (CORNERS, FACES, ["two"], ["pins"]),
    ],
)
def test_meshes(positions, faces, pins, words):
    refused(INPUT, lambda: toile.Scene.of_mesh(positions, faces, pins), *words)


def test_arrays_of_any_layout_are_read():
    scattered = np.asfortranarray(CORNERS.astype(np.float64))
    strided = np.repeat(CORNERS, 2, axis=0)[::2]
    swapped = CORNERS.astype(">f4")
    for positions in (scattered, strided, swapped, CORNERS.tolist()):
        with toile.Scene.of_mesh(positions, FACES.astype(np.int16), pins=(2, 3)) as scene:
            assert (scene.positions() == CORNERS).all()


def test_calls_on_a_scene(cloth, worn):
    for call in (cloth.positions, cloth.faces, cloth.normals, cloth.pinned, cloth.stats, worn.fit_map):
        refused(USAGE, lambda: call(1), "no garment 1", "counted from 0")
        refused(USAGE, lambda: call(-1), "-1")
        refused(TypeError, lambda: call(None))
        refused(TypeError, lambda: call(0.5))
        refused(OverflowError, lambda: call(2**80))
    refused(USAGE, lambda: cloth.fit_map(), "no body")
    refused(USAGE, lambda: cloth.body(), "no body")
    refused(USAGE, lambda: cloth.body_faces, "no body")
    refused(USAGE, lambda: cloth.step(-1), "-1")
    refused(USAGE, lambda: cloth.step(10**10), "fewer")
    refused(TypeError, lambda: cloth.step(None))
    refused(TypeError, lambda: cloth.step(1.5))
    refused(USAGE, lambda: cloth.step_to(np.zeros((23, 4))), "no body")
    refused(INPUT, lambda: worn.step_to(np.zeros((23, 4))), "pelvis")
    refused(INPUT, lambda: worn.step_to(None), "joints")
    refused(USAGE, lambda: cloth.picture("below"), "front")
    refused(USAGE, lambda: cloth.picture(NAN), "degrees")
    refused(USAGE, lambda: cloth.picture(size=(0, 10)), "0 x 10")
    refused(USAGE, lambda: cloth.picture(size=(100000, 100000)), "100000")
    refused(OverflowError, lambda: cloth.picture(size=(-1, 10)))
    refused(TypeError, lambda: cloth.picture(size=10))
    refused(USAGE, lambda: cloth.picture(look="x-ray"), "fit_map")
    refused(USAGE, lambda: cloth.picture(look="fit_map", size=(20, 20)), "no body")
    assert cloth.steps == 0


def test_after_close(cloth):
    positions = cloth.positions()
    cloth.close()
    cloth.close()
    calls = [
        cloth.step,
        lambda: cloth.step(0),
        lambda: cloth.step_to(np.ones((23, 3))),
        cloth.positions,
        cloth.faces,
        cloth.normals,
        cloth.pinned,
        cloth.fit_map,
        cloth.stats,
        cloth.body,
        cloth.snapshot,
        cloth.picture,
        cloth.__enter__,
        *(lambda name=name: getattr(cloth, name) for name in ("steps", "time", "time_step", "duration_steps", "garments")),
        *(lambda name=name: getattr(cloth, name) for name in ("body_faces", "state_hash", "warnings")),
    ]
    for call in calls:
        refused(USAGE, call, "closed")
    assert (positions == CORNERS).all()


def test_recordings(tmp_path):
    refused(INPUT, lambda: toile.Recording.open("no-such.mcap"), "no-such.mcap")
    refused(USAGE, lambda: toile.Recording.open(None), "NoneType")
    (tmp_path / "a.json").write_text("{}")
    refused(INPUT, lambda: toile.Recording.open(tmp_path / "a.json"), "a.json")
    refused(INPUT, lambda: toile.Recording.from_frames(), "no frame")
    refused(INPUT, lambda: toile.measure("no-such.mcap"), "no-such.mcap")
    refused(USAGE, lambda: toile.measure(None), "NoneType")
    refused(USAGE, lambda: toile.measure([None]), "depth image")
    embedded = toile.Recording.embedded()
    refused(USAGE, lambda: toile.measure(embedded, {"sex": "female"}), "Shopper")
    refused(USAGE, lambda: toile.measure(embedded, toile.Shopper(sex="robot")), "female")
    refused(INPUT, lambda: toile.measure(embedded, toile.Shopper(by_tape={"chest": 92})), "centimetres")
    refused(INPUT, lambda: toile.measure(embedded, toile.Shopper(by_tape={"chest": NAN})), "chest")
    refused(USAGE, lambda: toile.measure(embedded, toile.Shopper(by_tape={"chest": "wide"})), "number")
    refused(USAGE, lambda: embedded.depth_frame(10**6), "no depth image 1000000", "counted from 0")
    refused(USAGE, lambda: embedded.depth_frame(-1), "-1")
    refused(TypeError, lambda: embedded.track(None))
    refused(USAGE, lambda: toile.try_on(embedded, None), "garment")
    refused(USAGE, lambda: toile.try_on(embedded, toile.Garment("tee"), picture=(1, 1)), "1 x 1")
    refused(USAGE, lambda: toile.try_on(embedded, toile.Garment("tee"), quality="best"), "draft")


def test_depth_images():
    def frame(depth=np.zeros((4, 6), dtype=np.uint16), **camera):
        return toile.DepthFrame(depth, **{"fx": 10.0, "fy": 10.0, **camera})

    assert frame().depth.shape == (4, 6) and frame().intrinsics == (10.0, 10.0, 2.5, 1.5)
    assert frame(np.ones((4, 6), dtype=np.int64), time=0.5).time == 0.5
    refused(INPUT, lambda: frame(np.zeros((4, 6))), "float64", "uint16")
    refused(INPUT, lambda: frame(np.zeros((4, 6, 1), dtype=np.uint16)), "(4, 6, 1)")
    refused(INPUT, lambda: frame(np.full((4, 6), -1)), "0 to 65535")
    refused(INPUT, lambda: frame(np.full((4, 6), 65536)), "0 to 65535")
    refused(INPUT, lambda: frame(None), "depths")
    refused(INPUT, lambda: frame(np.zeros((0, 6), dtype=np.uint16)), "0 pixels")
    refused(INPUT, lambda: frame(fx=NAN), "camera")
    refused(INPUT, lambda: frame(cx=math.inf), "camera")
    refused(INPUT, lambda: frame(time=-1.0), "-1 s")
    refused(INPUT, lambda: frame(time=NAN), "NaN")
    refused(INPUT, lambda: frame(camera_to_world=np.eye(3)), "(3, 3)", "(3, 4)")
    refused(INPUT, lambda: frame(camera_to_world=np.full((3, 4), NAN)), "finite")
    refused(INPUT, lambda: frame(camera_to_world=np.eye(4) * 3), "last row")
    refused(INPUT, lambda: frame(camera_to_world=np.eye(4)[:3] * 3), "rotation")
    refused(INPUT, lambda: toile.measure(frame(np.zeros((480, 640), dtype=np.uint16), fx=575.0, fy=575.0)))


def test_tracks():
    joints = np.ones((2, 23, 3))
    assert len(toile.Track([0.0, 0.1], joints)) == 2
    refused(INPUT, lambda: toile.Track([0.0], joints), "1 times", "2 frames")
    refused(INPUT, lambda: toile.Track([0.0, NAN], joints), "NaN")
    refused(INPUT, lambda: toile.Track([0.0, -1.0], joints), "-1")
    refused(INPUT, lambda: toile.Track([0.0, 1e9], joints), "86400")
    refused(INPUT, lambda: toile.Track([0.0, 0.1], joints[:, :5]), "(2, 5, 3)", "(n, 23, 4)")
    refused(INPUT, lambda: toile.Track(None, joints), "times")
    refused(INPUT, lambda: toile.Track([0.0, 0.1], None), "joints")
    backwards = toile.Track([0.1, 0.0], joints)
    refused(INPUT, lambda: toile.Recording.from_frames(joints=backwards))


def test_a_fit_map_of_no_numbers():
    refused(INPUT, lambda: toile.fit_colours(None), "fit map")
    refused(INPUT, lambda: toile.fit_colours([[1.0]]), "(1, 1)")


def test_many_threads_close_and_read_one_scene():
    for _ in range(20):
        scene = toile.Scene.of_mesh(CORNERS, FACES, pins=[2, 3])
        faults = []

        def work(number, scene=scene, faults=faults):
            for _ in range(30):
                try:
                    (scene.step, scene.positions, scene.snapshot, scene.close)[number % 4]()
                except toile.UsageError as error:
                    if "closed" not in str(error) and "another call" not in str(error):
                        faults.append(str(error))

        threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert not faults
