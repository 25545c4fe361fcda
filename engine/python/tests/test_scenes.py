"""Scenes: arrays that show their memory, steps without the interpreter's lock, the engine's own bits."""

import gc
import json
import multiprocessing
import os
import pathlib
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import toile
from conftest import CORNERS, FACES, GRID

ROOT = pathlib.Path(__file__).resolve().parents[3]


def test_arrays_have_their_shapes(worn):
    (garment,) = worn.garments
    positions, faces = worn.positions(), worn.faces()
    assert positions.shape == (garment.vertices, 3) and positions.dtype == np.float32
    assert faces.shape == (garment.faces, 3) and faces.dtype == np.uint32
    assert faces.max() < garment.vertices and np.isfinite(positions).all()
    normals = worn.normals()
    assert np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-3)
    tightness = worn.fit_map()
    assert tightness.shape == (garment.vertices,) and (np.abs(tightness) <= 1).all()
    body, directions = worn.body()
    assert body.shape == directions.shape and worn.body_faces.max() < len(body)
    assert garment.fit.size == garment.size
    stats = worn.stats()
    assert 0 < stats.strain_mean < stats.strain_max and stats.rolled_back == 0
    assert worn.duration_steps is None and worn.warnings == () and worn.time_step == toile.TIME_STEP


def test_positions_of_one_step_share_their_memory(cloth):
    first = cloth.positions()
    assert np.shares_memory(first, cloth.positions()) and not first.flags.owndata
    assert np.shares_memory(cloth.faces(), cloth.faces())


def test_unreferenced_memory_is_used_again(cloth):
    places = set()
    for _ in range(20):
        cloth.step()
        places.add(cloth.positions().ctypes.data)
    assert len(places) <= 2


def test_an_array_never_changes(cloth):
    kept = []
    for _ in range(10):
        kept.append((cloth.positions(), cloth.positions().copy()))
        cloth.step()
    assert all((array == copy).all() for array, copy in kept)
    assert len({array.ctypes.data for array, _ in kept}) == 10
    assert (kept[0][0] != kept[9][0]).any()


def test_nothing_that_is_shown_can_be_written(cloth, worn, body):
    shown = [cloth.positions(), cloth.faces(), cloth.normals(), cloth.pinned(), worn.fit_map(), body.positions, body.faces]
    for array in shown:
        with pytest.raises(ValueError):
            array[0] = 0
        with pytest.raises(ValueError):
            array.flags.writeable = True
        with pytest.raises(ValueError):
            array[1:].setflags(write=True)


def test_an_array_outlives_its_scene():
    scene = toile.Scene.of_mesh(CORNERS, FACES, pins=[2, 3])
    scene.step(3)
    positions, part, faces = scene.positions(), scene.positions()[1:], scene.faces()
    was = positions.copy()
    scene.close()
    del scene
    gc.collect()
    filler = [np.full((4, 3), 7.0, dtype=np.float32) for _ in range(1000)]
    assert (positions == was).all() and (part == was[1:]).all() and (faces == FACES).all()
    assert filler


def test_pins_stay_to_the_bit(cloth):
    cloth.step(50)
    assert cloth.pinned().tolist() == [2, 3]
    assert (cloth.positions()[2:] == CORNERS[2:]).all()


def test_other_threads_run_during_a_step(curtain):
    counted, done = 0, threading.Event()

    def step():
        curtain.step(60)
        done.set()

    thread = threading.Thread(target=step)
    thread.start()
    while not done.is_set():
        counted += 1
        time.sleep(0.0005)
    thread.join()
    assert curtain.steps == 60
    # Behind the interpreter's lock not one of these would have run before the end.
    assert counted > 20, counted


def test_a_call_that_comes_during_a_step_is_refused(curtain):
    refused = []
    thread = threading.Thread(target=curtain.step, args=(400,))
    thread.start()
    while not refused and thread.is_alive():
        try:
            curtain.positions()
        except toile.UsageError as error:
            refused.append(str(error))
    for call in (curtain.close, curtain.step, curtain.snapshot, lambda: curtain.steps):
        with pytest.raises(toile.UsageError, match="another call is at work"):
            call()
    thread.join()
    assert "another call is at work" in refused[0]
    assert curtain.steps == 400 and curtain.positions().shape == (3600, 3)


def test_two_scenes_step_at_once():
    scenes = [toile.Scene.parse(GRID) for _ in range(2)]
    threads = [threading.Thread(target=scene.step, args=(20,)) for scene in scenes]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert scenes[0].state_hash == scenes[1].state_hash
    assert (scenes[0].positions() == scenes[1].positions()).all()


def test_one_worker_gives_the_bits_of_two(body, shirt):
    hashes = set()
    for workers in (1, 2):
        with toile.Scene(body, shirt, workers=workers) as scene:
            scene.step(10)
            hashes.add(scene.state_hash)
    assert len(hashes) == 1


def test_a_signal_ends_a_long_call(curtain):
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        curtain.step(1_000_000)
    assert 0 < curtain.steps < 1_000_000
    curtain.step()


def in_child(scene, answers):
    try:
        scene.step()
    except toile.UsageError as error:
        answers.put(str(error))


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="processes do not fork here")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_scene_does_not_go_through_a_fork(cloth):
    context = multiprocessing.get_context("fork")
    answers = context.Queue()
    child = context.Process(target=in_child, args=(cloth, answers))
    child.start()
    assert "forked" in answers.get(timeout=20)
    child.join(20)
    assert child.exitcode == 0
    cloth.step()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes do not fork here")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_scene_is_dropped_without_waiting_for_its_threads():
    scene = toile.Scene.parse(GRID)
    scene.step()
    child = os.fork()
    if child == 0:
        del scene
        gc.collect()
        os._exit(17)
    ends = time.monotonic() + 20
    while (ended := os.waitpid(child, os.WNOHANG)) == (0, 0) and time.monotonic() < ends:
        time.sleep(0.01)
    if ended == (0, 0):
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    assert ended[0] == child and os.waitstatus_to_exitcode(ended[1]) == 17
    scene.step()


def program():
    """The program `toile`, where it was built."""
    found = os.environ.get("TOILE_PROGRAM") or str(ROOT / "target/release/toile")
    return found if os.path.exists(found) else None


@pytest.mark.skipif(program() is None, reason="the program is not built: cargo build --release -p toile")
def test_a_scene_file_gives_the_programs_bits(tmp_path):
    path = tmp_path / "curtain.toml"
    path.write_text(GRID)
    line = [program(), "run", str(path), "--frames", "40", "--json", "--dump", str(tmp_path / "out")]
    said = json.loads(subprocess.run(line, check=True, capture_output=True, text=True).stdout)
    with toile.Scene.open(path) as scene:
        assert scene.duration_steps == 1200
        scene.step(40)
        state = said["state_hash"]
        assert state in (scene.state_hash, f"{scene.state_hash:016x}", f"0x{scene.state_hash:016x}")
        last = (tmp_path / "out" / "index.csv").read_text().splitlines()[-1].split(",")
        assert int(last[1]) == 40
        dumped = np.loadtxt(tmp_path / "out" / last[-1], delimiter=",", skiprows=1, dtype=np.float64)
        assert (dumped[:, 1:].astype(np.float32) == scene.positions()).all()


@pytest.mark.skipif(program() is None, reason="the program is not built: cargo build --release -p toile")
def test_a_try_on_gives_the_programs_bits(tmp_path):
    line = [program(), "try-on", "--garment", "tee", "--json", "--quiet", "--out", str(tmp_path / "out")]
    said = json.loads(subprocess.run(line, check=True, capture_output=True, text=True).stdout)
    tried = toile.try_on(toile.Recording.embedded(), toile.Garment("tee"), picture=(64, 96))
    hashes = {f"{tried.scene.state_hash:016x}", f"0x{tried.scene.state_hash:016x}", str(tried.scene.state_hash)}
    assert found(said, "state_hash") & hashes, (found(said, "state_hash"), hashes)
    assert list(tried.pictures) == list(tried.fit_maps) == ["front", "side", "back"]
    front = tried.pictures["front"]
    assert front.shape == (96, 64, 4) and front.dtype == np.uint8 and (front[..., 3] == 255).all()
    assert len(np.unique(front.reshape(-1, 4), axis=0)) > 20
    assert tried.fits[0].size == tried.scene.garments[0].size
    assert tried.measures["stature"].sigma_mm > 0


def found(said, key):
    """Every value of a key in an answer, as text."""
    if isinstance(said, dict):
        here = {str(said[key])} if key in said else set()
        return here.union(*(found(value, key) for value in said.values()))
    if isinstance(said, list):
        return set().union(*(found(value, key) for value in said))
    return set()


def test_a_picture_is_an_array(cloth):
    picture = cloth.picture("side", size=(40, 30))
    assert picture.shape == (30, 40, 4) and picture.flags.writeable
    assert (picture != cloth.picture(35.0, size=(40, 30))).any()


def test_a_snapshot_stays(worn):
    taken = worn.snapshot()
    assert taken.step == worn.steps and taken.time == worn.time
    assert (taken.garments[0] == worn.positions()).all()
    assert (taken.body == worn.body()[0]).all() and taken.body_normals.shape == taken.body.shape


def test_a_scene_of_memory_reads_its_files():
    obj = b"v 0 1 0\nv .1 1 0\nv 0 1.1 0\nf 1 2 3\n"
    with toile.Scene.parse('[garment]\nmesh = "a.obj"\n', {"a.obj": obj}) as scene:
        scene.step(2)
        assert scene.positions().shape == (3, 3)
        assert "step 2" in repr(scene)
    assert "closed" in repr(scene)
