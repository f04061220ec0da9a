"""Scripts written for MoorDyn's Python package run with the import changed."""

import importlib.util
import math

import numpy as np
import pytest

from moorline import InputError, moordyn

DECK = """MoorDyn v2: one chain
---------------------- LINE TYPES -----------------------------------
TypeName   Diam    Mass/m     EA         BA/-zeta    EI    Cd    Ca   CdAx  CaAx
(name)     (m)     (kg/m)     (N)        (N-s/-)   (N-m2)  (-)   (-)  (-)   (-)
chain      0.144   126.0      5.5e8      -0.5        0     1.3   1.0  0.1   0.0
---------------------- POINTS ---------------------------------------
ID     Type      X        Y      Z      Mass  Volume  CdA   CA
(-)    (-)       (m)     (m)    (m)     (kg)  (m3)   (m2)  (-)
1     Fixed    405.0     0.0  -120.0    0      0      0     0
2     Coupled    5.0     0.0   -10.0    0      0      0     0
---------------------- LINES ----------------------------------------
ID    LineType   AttachA  AttachB  UnstrLen   NumSegs  LineOutputs
(-)    (name)      (#)     (#)       (m)       (-)      (-)
1      chain        1       2       450.0      30        p
---------------------- OPTIONS --------------------------------------
120.0    WtrDpth
1025.0   WtrDnsty
3.0e6    kBot
3.0e5    cBot
0.002    dtM
RK2      tScheme
1.0      dtIC
800.0    TmaxIC
5.0      CdScaleIC
1.0e-8   threshIC
0        writeLog
---------------------- need this line -------------------------------
"""


@pytest.fixture
def deck(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lines.txt").write_text(DECK)
    return "lines.txt"


def place(t):
    """Displacement of the fairlead [m]."""
    return (1.0 - math.cos(math.pi * min(t / 10.0, 1.0))) * math.sin(2.0 * math.pi / 12.0 * t)


def driven(module, deck, end=24.0, dt=0.02):
    """A script of a host, for either module: forces on the fairlead in time. The velocity is the mean over a step: MoorDyn's points jump at
    the end of a step with another."""
    system = module.Create(deck)
    assert module.NCoupledDOF(system) == 3
    module.Init(system, [5.0, 0.0, -10.0], [0.0] * 3)
    forces = []
    for k in range(round(end / dt)):
        t = k * dt
        velocity = [(place(t + dt) - place(t)) / dt, 0.0, 0.0]
        forces.append(module.Step(system, [5.0 + place(t), 0.0, -10.0], velocity, t, dt))
    line = module.GetLine(system, 1)
    shape = [module.GetLineNodePos(line, i) for i in range(module.GetLineNumberNodes(line))]
    tension = module.GetLineFairTen(line)
    module.Close(system)
    return np.array(forces), np.array(shape), tension


@pytest.mark.skipif(importlib.util.find_spec("moordyn") is None, reason="needs MoorDyn's package")
def test_a_script_gives_moordyns_forces_with_the_import_changed(deck):
    import moordyn as peer

    (forces, shape, tension), (expected, known, known_tension) = driven(moordyn, deck), driven(peer, deck)
    late = slice(forces.shape[0] // 6, None)  # behind the peer's relaxation
    difference, force = [np.sqrt(np.mean(part[late][:, [0, 2]] ** 2, axis=0)) for part in (forces - expected, expected)]
    print("RMS of the difference over that of the force, in x and z:", difference / force)
    assert (difference / force).max() < 0.005
    assert np.abs(shape - known).max() < 0.01 and tension == pytest.approx(known_tension, rel=0.005)


def test_a_state_is_saved_and_loaded_to_the_last_bit(deck):
    system = moordyn.Create(deck)
    x, v = [5.0, 0.0, -10.0], [0.3, 0.0, 0.0]
    moordyn.Init(system, x, [0.0] * 3)

    def steps():
        return [moordyn.Step(system, [5.0 + 0.3 * 0.05 * k, 0.0, -10.0], v, 0.05 * k, 0.05) for k in range(20)]

    data = moordyn.Serialize(system)
    moordyn.Save(system, "state")
    first = steps()
    moordyn.Deserialize(system, data)
    assert steps() == first
    moordyn.Load(system, "state")
    assert steps() == first


def test_objects_are_counted_from_one(deck):
    system = moordyn.Create(deck)
    start = moordyn.GetPointPos(moordyn.GetPoint(system, 2))  # of the deck, from which a host may start
    moordyn.Init(system, start, [0.0] * 3)
    counts = [getattr(moordyn, f"GetNumber{kind}")(system) for kind in ("Bodies", "Rods", "Points", "Lines")]
    assert counts == [0, 0, 2, 1]
    point, line = moordyn.GetPoint(system, 2), moordyn.GetLine(system, 1)
    assert moordyn.GetPointPos(point) == pytest.approx((5.0, 0.0, -10.0)) and moordyn.GetPointVel(point) == (0.0, 0.0, 0.0)
    attached, end = moordyn.GetPointAttached(point, 0)
    assert (moordyn.GetLineID(attached), end, moordyn.GetPointNAttached(point)) == (1, 1, 1)
    assert moordyn.GetLineUnstretchedLength(line) == 450.0 and moordyn.GetLineN(line) == 30
    fair_h, fair_v, anchor_h, anchor_v = moordyn.GetFASTtens(system, 1)
    assert fair_h[0] == pytest.approx(anchor_h[0], rel=1e-6) and abs(fair_v[0]) > abs(anchor_v[0])
    assert fair_h[0] < moordyn.GetLineFairTen(line) == moordyn.GetLineMaxTen(line)
    with pytest.raises(InputError, match="counted from 1"):
        moordyn.GetLine(system, 0)


def test_what_is_not_modelled_is_refused_by_name(deck):
    system = moordyn.Create(deck)
    for name in moordyn.REFUSED:
        with pytest.raises(NotImplementedError, match=f"no {name}: "):
            getattr(moordyn, name)(system)


@pytest.mark.skipif(importlib.util.find_spec("moordyn") is None, reason="needs MoorDyn's package")
def test_every_function_of_moordyns_package_is_there_or_refused():
    import inspect

    import moordyn as peer

    names = [name for name, value in vars(peer).items() if inspect.isfunction(value) and name[0].isupper()]
    assert len(names) > 80
    assert [name for name in names if not hasattr(moordyn, name)] == []


def test_wrong_numbers_and_an_uninitialised_system_are_refused(deck):
    system = moordyn.Create(deck)
    with pytest.raises(InputError, match="call Init first"):
        moordyn.Step(system, [5.0, 0.0, -10.0], [0.0] * 3, 0.0, 0.1)
    with pytest.raises(InputError, match="3 coupled degrees of freedom"):
        moordyn.Init(system, [5.0], [0.0])
