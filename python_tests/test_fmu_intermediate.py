"""FMI 3.0: the host updates inputs within communication steps, and ends steps early."""

import math

import fmpy
import fmpy.fmi3
import pytest

import scenes
from fmu_calls import unpack

STEP, PART = 0.2, 0.05


def motion(t):
    return 1.5 * math.sin(0.9 * t)


@pytest.fixture(scope="module")
def opened(package, tmp_path_factory):
    path = package("CHAIN", 3)
    return fmpy.read_model_description(str(path)), str(unpack(path, tmp_path_factory.mktemp("unpacked")))


class Host:
    """A host of one instance, whose update gives the motion within steps, unless `update` is another."""

    def __init__(self, opened, update=None, announces=True):
        description, folder = opened
        references = {v.name: v.valueReference for v in description.modelVariables}
        self.x, self.force = references["fairlead.x"], references["fairlead.fx"]
        self.times, self.forces, self.ends_at = [], [], math.inf
        moved = [references[f"fairlead.{axis}"] for axis in "xyz"]
        self.fmu = fmpy.fmi3.FMU3Slave(guid=description.guid, unzipDirectory=folder, instanceName="one",
                                       modelIdentifier=description.coSimulation.modelIdentifier)
        self.fmu.instantiate(earlyReturnAllowed=True, intermediateUpdate=update or self.update, loggingOn=False,
                             requiredIntermediateVariables=moved if announces else [])
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def update(self, _, time, asks, may_read, is_step, may_end, ends, end):
        assert asks and may_read and is_step and may_end
        self.times.append(time)
        self.forces.append(self.fmu.getFloat64([self.force])[0])
        self.fmu.setFloat64([self.x], [motion(time)])
        if time >= self.ends_at:
            ends[0], end[0] = True, time

    def step(self, time, length):
        self.fmu.setFloat64([self.x], [motion(time)])
        return self.fmu.doStep(time, length)

    def read(self):
        return self.fmu.getFloat64([self.force])[0]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.fmu.terminate()
        self.fmu.freeInstance()


def test_updates_within_a_step_give_what_shorter_steps_give(opened):
    with Host(opened) as long, Host(opened, announces=False) as short, Host(opened, announces=False) as coarse:
        for k in range(10):
            assert long.step(STEP * k, STEP)[2] is False
            coarse.step(STEP * k, STEP)
            for part in range(4):
                short.step(STEP * k + PART * part, PART)
        assert long.read() == pytest.approx(short.read(), rel=1e-9)
        assert abs(coarse.read() - short.read()) > 1e-6 * abs(short.read())
        assert long.times[:4] == pytest.approx([0.05, 0.1, 0.15, 0.25]) and len(long.times) == 30
        assert short.times == coarse.times == [] and len(set(long.forces)) == 30


def test_a_step_whose_velocities_are_given_at_its_ends_alone_has_one_part(opened):
    description, _ = opened
    speed = next(v.valueReference for v in description.modelVariables if v.name == "fairlead.vx")
    with Host(opened) as host:
        host.fmu.setFloat64([speed], [1.35])
        host.step(0.0, STEP)
        assert host.times == []


def test_a_step_that_the_host_ends_goes_on_from_there(opened):
    with Host(opened) as ended, Host(opened) as whole:
        whole.step(0.0, STEP)
        ended.ends_at = 0.099
        _, _, early, reached = ended.step(0.0, STEP)
        assert early is True and reached == pytest.approx(0.1)
        ended.ends_at = math.inf
        _, _, early, reached = ended.step(reached, STEP - reached)
        assert early is False and reached == pytest.approx(STEP)
        assert ended.read() == pytest.approx(whole.read(), rel=1e-9)


def test_calls_that_the_standard_forbids_in_an_update_are_refused(opened):
    refused = []

    def update(_, time, *rest):
        for name, call in (("step", lambda: host.fmu.doStep(time, PART)), ("save", host.fmu.getFMUState),
                           ("reset", host.fmu.reset), ("terminate", host.fmu.terminate)):
            try:
                call()
            except fmpy.fmi1.FMICallException:
                refused.append(name)

    with Host(opened, update) as host:
        host.step(0.0, 2 * PART)
        assert refused == ["step", "save", "reset", "terminate"]
        host.step(2 * PART, PART)


def test_a_failed_part_leaves_the_state_before_the_whole_step(opened):
    def update(_, time, *rest):
        host.fmu.setFloat64([host.x], [1e9])

    with Host(opened, update) as host, Host(opened, announces=False) as other:
        host.step(0.0, PART)
        other.step(0.0, PART)
        before = host.read()
        with pytest.raises(fmpy.fmi1.FMICallException):
            host.step(PART, STEP)
        assert host.read() == before == other.read()
        host.step(PART, PART)
        other.step(PART, PART)
        assert host.read() == other.read()
