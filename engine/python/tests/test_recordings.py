"""Recordings, depth images, joints, measures."""

import os
import pathlib

import numpy as np
import pytest

import toile

DATA = os.environ.get("TOILE_DATA")


@pytest.fixture(scope="module")
def recording():
    return toile.Recording.embedded()


@pytest.fixture(scope="module")
def measured(recording):
    return toile.measure(recording)


def standing(scene):
    """A depth image (mm) of what a level camera sees of triangles: every pixel's nearest point of the body, by its vertices."""
    positions, faces = scene
    corners = positions[faces.astype(np.int64)]
    steps = np.linspace(0, 1, 12)
    weights = np.array([(a, b, 1 - a - b) for a in steps for b in steps if a + b <= 1])
    points = np.einsum("kw,nwc->nkc", weights, corners).reshape(-1, 3)
    x, y, z = points[:, 0], 1.0 - points[:, 1], 2.5 - points[:, 2]
    fx, width, height = 365.0, 512, 424
    u = np.rint((width - 1) / 2 + fx * x / z).astype(int)
    v = np.rint((height - 1) / 2 + fx * y / z).astype(int)
    seen = (u >= 0) & (u < width) & (v >= 0) & (v < height)
    image = np.full((height, width), 65535, dtype=np.uint16)
    np.minimum.at(image, (v[seen], u[seen]), np.rint(z[seen] * 1000).astype(np.uint16))
    image[image == 65535] = 0
    place = np.array([[1, 0, 0, 0], [0, -1, 0, 1], [0, 0, -1, 2.5]], dtype=np.float32)
    return toile.DepthFrame(image, fx=fx, fy=fx, camera_to_world=place)


def test_a_recording_says_what_it_has(recording):
    assert recording.seconds > 1 and len(recording.joints) > 10
    joints = recording.joints
    assert joints.joints.shape == (len(joints), len(toile.JOINTS), 4) and joints.times.shape == (len(joints),)
    assert (np.diff(joints.times) > 0).all()
    assert toile.JOINTS[:2] == ("pelvis", "spine") and "left_shoulder" in toile.JOINTS


def test_measures_have_their_errors(recording, measured):
    stature = measured.measures["stature"]
    assert 1300 < stature.mm < 2100 and stature.sigma_mm > 0 and stature.definition
    known = toile.measure(recording, toile.Shopper(sex="female", by_tape={"waist": 760}))
    assert known.measures["waist_girth"].mm == pytest.approx(760, abs=1)
    assert known.measures["waist_girth"].sigma_mm < measured.measures["waist_girth"].sigma_mm
    body = measured.body(toile.Garment("tee"))
    assert body.measure("stature") == pytest.approx(stature.mm, abs=30)


def test_arrays_that_come_back_are_the_same_recording(recording, measured):
    joints, depth = recording.joints, []
    for frame in map(recording.depth_frame, range(recording.depth_count)):
        fx, fy, cx, cy = frame.intrinsics
        camera = {"fx": fx, "fy": fy, "cx": cx, "cy": cy, "camera_to_world": frame.camera_to_world}
        depth.append(toile.DepthFrame(frame.depth, time=frame.time, **camera))
    assert len(depth) == len(joints)
    again = toile.Recording.from_frames(depth, toile.Track(joints.times, joints.joints), name="again")
    assert (again.joints.joints == joints.joints).all() and again.name == "again"
    ours = toile.measure(again).measures
    assert {n: m.mm for n, m in ours.items()} == {n: m.mm for n, m in measured.measures.items()}


def test_a_scene_follows_a_track(recording, measured, shirt):
    track = recording.track(measured)
    body = measured.body(shirt)
    with toile.Scene(body, shirt, motion=track, quality="draft") as scene:
        assert scene.duration_steps > 30
        before = scene.body()[0].copy()
        scene.step(min(60, scene.duration_steps))
        assert np.abs(scene.body()[0] - before).max() > 1e-4
    with toile.Scene(body, shirt, motion=track.joints[0], quality="draft") as scene:
        scene.step_to(track.joints[0, :, :3])
        assert scene.steps == 1 and scene.duration_steps is None


def test_a_body_is_measured_in_a_depth_image(body):
    posed = toile.Scene(body, [], motion="standing")
    frame = standing((posed.body()[0], posed.body_faces))
    assert frame.depth.shape == (424, 512) and not frame.depth.flags.writeable
    points = frame.points()
    assert points.shape == (np.count_nonzero(frame.depth), 3)
    assert 1.6 < points[:, 1].max() < 1.8
    measured = toile.measure(frame, toile.Shopper(sex="female", tight_clothes=True))
    assert measured.measures["stature"].mm == pytest.approx(1720, abs=25)
    assert measured.measures["chest_girth"].mm == pytest.approx(920, abs=60)


@pytest.mark.skipif(not DATA, reason="no recordings of real sensors: set TOILE_DATA")
def test_real_sensors_are_read():
    paths = sorted(pathlib.Path(DATA).glob("skeleton/kinectron-kinect2/*.json"))
    recording = toile.Recording.open(paths[0])
    assert len(recording.joints) > 10 and recording.name
    assert toile.measure(paths[0]).measures["stature"].mm > 1000
