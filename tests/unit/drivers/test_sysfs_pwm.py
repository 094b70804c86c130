"""Linux's own PWM files, with a kernel in memory that refuses what the real one does."""

import errno
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.drivers.kernel import FakeKernel, refuse

from zteleop.drivers.sysfs_pwm import SysfsPwm, SysfsPwmSettings, open_driver
from zteleop.errors import ConfigError, DeviceError

NEUTRAL = {0: 1500.0, 1: 1530.0}
DRIVEN = {0: 1800.0, 1: 1200.0}
PERIOD = "16666667"


@pytest.fixture
def kernel() -> FakeKernel:
    return FakeKernel()


def driver_on(kernel: FakeKernel, **settings: object) -> SysfsPwm:
    return SysfsPwm(SysfsPwmSettings(**settings), kernel, lambda _: None)  # type: ignore[arg-type]


@pytest.fixture
def driving(kernel: FakeKernel) -> SysfsPwm:
    driver = driver_on(kernel)
    driver.start(NEUTRAL)
    kernel.log.clear()
    return driver


def test_a_channel_is_exported_given_its_period_and_then_enabled(kernel: FakeKernel) -> None:
    driver_on(kernel).start({0: 1500.0})
    assert kernel.log == [
        ("export", "0"),
        ("pwm0/period", PERIOD),
        ("pwm0/duty_cycle", "1500000"),
        ("pwm0/enable", "1"),
    ]


def test_a_channel_that_runs_is_taken_over_without_a_gap(kernel: FakeKernel, driving: SysfsPwm) -> None:
    driving.write(DRIVEN)
    kernel.log.clear()
    driver_on(kernel).start(NEUTRAL)
    assert kernel.log == [("pwm0/duty_cycle", "1500000"), ("pwm1/duty_cycle", "1530000")]


def test_a_channel_with_another_period_is_stopped_before_it_is_given_its_own(
    kernel: FakeKernel, driving: SysfsPwm
) -> None:
    driver_on(kernel, frequency_hz=400).start({0: 1500.0})
    assert kernel.log == [
        ("pwm0/enable", "0"),
        ("pwm0/period", "2500000"),
        ("pwm0/duty_cycle", "1500000"),
        ("pwm0/enable", "1"),
    ]


def test_a_pulse_that_is_longer_than_the_new_period_goes_first(kernel: FakeKernel) -> None:
    slow = driver_on(kernel, frequency_hz=24)
    slow.start({0: 20_000.0})
    kernel.log.clear()
    driver_on(kernel).start({0: 1500.0})
    assert kernel.log[:3] == [("pwm0/enable", "0"), ("pwm0/duty_cycle", "0"), ("pwm0/period", PERIOD)]
    assert kernel.width_ns(0) == 1_500_000


def test_an_inverted_channel_is_put_right_while_it_is_off(kernel: FakeKernel, driving: SysfsPwm) -> None:
    kernel.files[f"{kernel.chip}/pwm0/polarity"] = "inversed"
    driver_on(kernel).start(NEUTRAL)
    assert ("pwm0/polarity", "normal") in kernel.log
    assert kernel.width_ns(0) == 1_500_000


def test_a_chip_with_one_polarity_shows_no_file_of_it(kernel: FakeKernel, driving: SysfsPwm) -> None:
    del kernel.files[f"{kernel.chip}/pwm0/polarity"]
    driver_on(kernel).start(NEUTRAL)
    assert kernel.width_ns(0) == 1_500_000


def test_it_waits_for_udev_to_give_the_channel_to_its_group(kernel: FakeKernel) -> None:
    kernel.locked = 5
    driver_on(kernel).start(NEUTRAL)
    assert kernel.width_ns(1) == 1_530_000


def test_what_is_written_is_read_and_outlives_its_driver(kernel: FakeKernel, driving: SysfsPwm) -> None:
    driving.write(DRIVEN)
    driving.close()
    assert driver_on(kernel).read([0, 1]) == DRIVEN


def test_no_pulse_is_none(kernel: FakeKernel, driving: SysfsPwm) -> None:
    kernel.files[f"{kernel.chip}/pwm0/enable"] = "0"
    kernel.files[f"{kernel.chip}/pwm1/duty_cycle"] = "0"
    assert driving.read([0, 1, 2]) == {0: None, 1: None, 2: None}


def test_two_failures_are_made_good_and_a_third_is_an_error_in_words(
    kernel: FakeKernel, driving: SysfsPwm
) -> None:
    for act in (lambda: driving.write(DRIVEN), lambda: driving.read([0]), driving.check):
        kernel.failing = [refuse(errno.EIO)] * 2
        act()
        kernel.failing = [refuse(errno.EIO)] * 3
        with pytest.raises(DeviceError, match=f"^{kernel.chip}: refused$"):
            act()
        kernel.failing.clear()


def test_a_channel_that_fails_keeps_no_other_from_its_pulse(kernel: FakeKernel, driving: SysfsPwm) -> None:
    kernel.broken.add(f"{kernel.chip}/pwm0/duty_cycle")
    with pytest.raises(DeviceError):
        driving.write(DRIVEN)
    assert kernel.width_ns(1) == 1_200_000


@pytest.mark.parametrize(("name", "value"), [("enable", "0"), ("period", "20000000")])
def test_check_notices_what_somebody_else_changed(
    kernel: FakeKernel, driving: SysfsPwm, name: str, value: str
) -> None:
    driving.check()
    kernel.files[f"{kernel.chip}/pwm1/{name}"] = value
    with pytest.raises(DeviceError, match=f"{name} of channel 1 reads {value}"):
        driving.check()
    driving.start(NEUTRAL)
    driving.check()


def test_a_module_that_was_loaded_anew_is_noticed_and_brought_up_again(
    kernel: FakeKernel, driving: SysfsPwm
) -> None:
    kernel.power_cycle()
    assert driving.read([0]) == {0: None}
    with pytest.raises(DeviceError):
        driving.check()
    driving.start(NEUTRAL)
    assert kernel.width_ns(0) == 1_500_000


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (errno.EACCES, "usermod -aG gpio"),
        (errno.EBUSY, "used by something else"),
        (errno.ENODEV, "no such channel"),
        (errno.EINVAL, "set another frequency_hz"),
    ],
)
def test_each_refusal_says_what_to_do(kernel: FakeKernel, number: int, words: str) -> None:
    kernel.failing = [refuse(number)] * 3
    with pytest.raises(DeviceError, match=words):
        driver_on(kernel).start(NEUTRAL)


def test_a_chip_that_is_not_there_is_said(kernel: FakeKernel) -> None:
    with pytest.raises(
        DeviceError, match="/sys/class/pwm/pwmchip7: there is no such PWM chip; set chip to one"
    ):
        driver_on(kernel, chip=7).start(NEUTRAL)


def test_a_channel_it_has_not_is_said(kernel: FakeKernel) -> None:
    with pytest.raises(DeviceError, match=r"no such channel; .*npwm says how many"):
        driver_on(kernel).start({5: 1500.0})


def test_a_file_that_holds_no_number_is_an_error_in_words(kernel: FakeKernel, driving: SysfsPwm) -> None:
    kernel.files[f"{kernel.chip}/pwm0/duty_cycle"] = "odd"
    with pytest.raises(DeviceError, match="expected a number of ns"):
        driving.read([0])


@pytest.mark.parametrize("pulse_us", [{16: 1500.0}, {0: 0.0}, {0: -1.0}, {0: 16_700.0}, {0: float("nan")}])
def test_a_pulse_that_cannot_be_is_refused_before_anything_is_written(
    kernel: FakeKernel, driving: SysfsPwm, pulse_us: dict[int, float]
) -> None:
    with pytest.raises(ConfigError, match=r"expected a channel of 0\.\.15 and a pulse within the period"):
        driving.write({1: 1400.0} | pulse_us)
    assert kernel.log == []


@given(st.dictionaries(st.sampled_from([0, 1]), st.floats(1, 16_000), min_size=1), st.floats(24, 60))
def test_any_pulses_come_back_within_half_a_count(pulse_us: dict[int, float], frequency_hz: float) -> None:
    driver = driver_on(FakeKernel(), frequency_hz=frequency_hz)
    driver.start(pulse_us)
    assert driver.read(pulse_us) == pytest.approx(pulse_us, abs=driver.tick_us / 2)


def test_a_second_driver_of_one_chip_is_refused_unless_it_is_the_watchdogs_hand(tmp_path: Path) -> None:
    settings = SysfsPwmSettings(folder=str(tmp_path))
    first = open_driver(settings)
    with pytest.raises(DeviceError, match="is driven by process"):
        open_driver(settings)
    open_driver(settings, exclusive=False).close()
    assert len(first.shared()) == 1
    first.close()
    open_driver(settings).close()
