"""Scenes that were spoilt inside an FMU: instantiation fails with one message that says why, and the process lives on."""

import random

import pytest

import scenes
from fmu_calls import Slave

WHOLE = scenes.CHAIN.encode()
SPOILT = {
    "empty": b"",
    "blank": b"\n\n",
    "binary": b"\x7fELF\x02\x01\x01\x00\x00",
    "not UTF-8": WHOLE.replace(b"one chain", b"one ch\xe4in"),
    "UTF-16": scenes.CHAIN.encode("utf-16"),
    "cut": WHOLE[: len(WHOLE) // 2],
    "a deck": scenes.DECK.encode(),
    "not a number": WHOLE.replace(b"mass = 113.35", b"mass = nan"),
    "infinite": WHOLE.replace(b"mass = 113.35", b"mass = inf"),
    "too great": WHOLE.replace(b"mass = 113.35", b"mass = 1e300"),
    "too small": WHOLE.replace(b"axial_stiffness = 753.6e6", b"axial_stiffness = 1e-300"),
    "negative diameter": WHOLE.replace(b"diameter = 0.0766", b"diameter = -0.0766"),
    "missing key": WHOLE.replace(b"diameter = 0.0766\n", b""),
    "unknown key": WHOLE.replace(b"diameter =", b"diametre ="),
    "wrong name": WHOLE.replace(b'to = "fairlead"', b'to = "farlead"'),
    "loop": WHOLE.replace(b'to = "fairlead"', b'to = "anchor"'),
    "no elements": WHOLE.replace(b"elements = 20", b"elements = 0"),
    "all elements": WHOLE.replace(b"elements = 20", b"elements = 1000000000"),
    "deep": b"a = " + b"[" * 100_000,
}


def refused(library, folder, scene):
    (folder / "scene.toml").write_bytes(scene)
    one = Slave(library, resources=str(folder))
    assert not one.handle
    (message,) = one.messages
    assert message[1] == "logStatusError" and len(message[2]) > 20
    return message[2]


@pytest.mark.parametrize("name", SPOILT)
def test_a_spoilt_scene_is_refused_at_instantiation(library, version, tmp_path, name):
    assert SPOILT[name] != WHOLE
    text = refused(library("CHAIN", version), tmp_path, SPOILT[name])
    words = {"negative diameter": "diameter", "wrong name": "farlead", "loop": "both ends", "unknown key": "diametre",
             "no elements": "elements", "all elements": "100000", "not a number": "mass", "a deck": "a deck of another program"}
    assert words.get(name, "") in text


def test_a_hundred_scenes_with_wrong_bytes_are_refused_and_the_library_still_works(library, version, tmp_path):
    one = library("CHAIN", version)
    chance = random.Random(20261121)
    for _ in range(100):
        scene = bytearray(WHOLE)
        for _ in range(chance.randint(1, 8)):
            scene[chance.randrange(len(scene))] = chance.randrange(256)
        if chance.random() < 0.3:
            del scene[chance.randrange(len(scene)):]
        if bytes(scene) != WHOLE:
            refused(one, tmp_path, bytes(scene))
    good = Slave(one).initialize()
    good.run(2)
    good.free()
