"""What a call costs beside its work: a table, on a scene of 4 vertices. Fails above 5 us.

    python engine/python/tests/overhead.py
"""

import sys
import time

import numpy as np
import toile

GOAL_NS = 5000
ROUNDS, CALLS = 200, 500

corners = np.array([[0, 1, 0], [0.1, 1, 0], [0, 1.1, 0], [0.1, 1.1, 0]], dtype=np.float32)
scene = toile.Scene.of_mesh(corners, [[0, 1, 2], [1, 3, 2]], pins=[2, 3])
body = toile.Body.average("female")


def refused():
    try:
        scene.positions(1)
    except toile.UsageError:
        pass


def cost(call):
    """Nanoseconds of a call: the best of many rounds, less an empty loop."""
    best = float("inf")
    for _ in range(ROUNDS):
        began = time.perf_counter_ns()
        for _ in range(CALLS):
            call()
        best = min(best, time.perf_counter_ns() - began)
    return best / CALLS


def nothing():
    pass


calls = {
    "an empty function of Python's": nothing,
    "`scene.steps`": lambda: scene.steps,
    "`scene.step(0)`, the lock of the interpreter left alone": lambda: scene.step(0),
    "`scene.positions()`, shown again": scene.positions,
    "`scene.faces()`": scene.faces,
    "`scene.pinned()`": scene.pinned,
    "`scene.state_hash`, most of it the hash": lambda: scene.state_hash,
    "`body.positions`": lambda: body.positions,
    "`body.measure(\"chest\")`": lambda: body.measure("chest"),
    "`scene.positions(1)`, refused with a sentence": refused,
}
print("| call | ns |\n|---|---|")
slow = []
for name, call in calls.items():
    ns = cost(call)
    print(f"| {name} | {ns:.0f} |")
    if ns > GOAL_NS:
        slow.append(name)


def stepped():
    scene.step()
    scene.positions()


with_step = cost(stepped)
alone = cost(scene.step)
print(f"| `scene.positions()` after a step | {with_step - alone:.0f} |")
print(f"| `scene.step()` of 4 vertices, with its work | {alone:.0f} |")
if slow or with_step - alone > GOAL_NS:
    sys.exit(f"overhead: more than {GOAL_NS} ns: {', '.join(slow) or 'positions after a step'}")
