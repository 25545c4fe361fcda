"""A garment from a file on a body of measures: size and ease, a second of cloth, where it is and how tight it sits.

    python dressed.py [GARMENT]
"""

import sys

import numpy as np
import toile

body = toile.Body.from_measures("female", stature=1720, chest=920, waist=760, hip=1000)
garment = toile.Garment(sys.argv[1] if len(sys.argv) > 1 else "tee")  # or "shirt.obj", "shirt.json", "shirt.toile"
if garment.sizes:
    fit = toile.recommend(body, garment)
    print(f"size {fit.size}: {fit.verdict}")
    for zone in fit.zones:
        print(f"  {zone.zone} {zone.ease_mm:+.0f} mm (sigma {zone.sigma_mm:.0f}): {zone.verdict}")
with toile.Scene(body, garment) as scene:  # in the size that fits
    scene.step(120)  # a second: each step is toile.TIME_STEP
    positions, faces, tightness = scene.positions(), scene.faces(), scene.fit_map()
    print(f"{len(positions)} vertices, {len(faces)} faces, the lowest at {positions[:, 1].min():.3f} m")
    print(f"tight at {np.mean(tightness > 0.5):.0%} of the vertices, state {scene.state_hash:016x}")
