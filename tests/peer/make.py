#!/usr/bin/env python3
"""Renders the scenes of this folder with Mitsuba 3.9.1 (`pip install mitsuba==3.9.1`): `make.py [NAME...]`.

Every NAME.xml gives NAME.exr, 32 pixels wide and 64 high: two independent halves, one below the other, in half floats. A scene whose name is
given is rendered anew, or without names each that has no picture yet.
"""
import pathlib
import sys

import mitsuba
import numpy

mitsuba.set_variant("llvm_ad_rgb" if "--llvm" in sys.argv else "scalar_rgb")
HERE = pathlib.Path(__file__).resolve().parent
SAMPLES = 4096



def layers(file, picture, names):
    """Writes what an `aov` makes beside its picture: a layer below the other, in the first of three bands where there are fewer."""
    tiles = {}
    # The first four are the picture's own.
    for name, channel in zip(names[4:], numpy.moveaxis(picture, 2, 0)[4 - len(names) :]):
        tiles.setdefault(name.rsplit(".", 1)[0], []).append(channel)
    rows = [numpy.stack((tile + [0 * tile[0]] * 2)[:3], axis=2) for tile in tiles.values()]
    mitsuba.Bitmap(numpy.concatenate(rows).astype(numpy.float16)).write(str(file))


names = [word for word in sys.argv[1:] if not word.startswith("-")]
for file in sorted(HERE.glob("*.xml")):
    picture = file.with_suffix(".exr")
    if file.stem not in names if names else picture.exists():
        continue
    scene = mitsuba.load_file(str(file))
    halves = [numpy.array(mitsuba.render(scene, spp=SAMPLES, seed=seed)) for seed in (1, 2)]
    if halves[0].shape[2] > 4:
        layers(file.with_suffix(".layers.exr"), sum(halves) / 2, scene.integrator().aov_names())
    halves = [half[:, :, :3] for half in halves]
    both = mitsuba.Bitmap(numpy.concatenate(halves).astype(numpy.float16))
    both.write(str(picture))
    print(file.stem, f"{float(numpy.mean(halves)):.5f}")
