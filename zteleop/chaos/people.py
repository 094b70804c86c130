"""Several people at once, or one who does the wrong thing."""

from zteleop.chaos.bench import Bench
from zteleop.chaos.fault import Fault
from zteleop.chaos.operators import here

ANSWERED_WITHIN = 2.0
TWO_PEOPLE = "ann@chaos", "bob@chaos"


def press(bench: Bench) -> None:
    bench.press_stop()


def go_to_three_places(bench: Bench) -> None:
    bench.others = [bench.join() for _ in range(3)]


def press_at_three_places(bench: Bench) -> None:
    """Press Stop at places that do not know of each other."""
    for node in bench.others:
        bench.press_stop(node)


def release(bench: Bench) -> None:
    """Release whatever stop is in force, while somebody goes on all the time."""

    def released() -> bool:
        status = bench.status
        for stop in status.stops if status else ():
            bench.release(stop.id)
        return bool(status and not status.stops)

    bench.until(lambda: (status := bench.status) and status.stops, ANSWERED_WITHIN)
    bench.until(released, ANSWERED_WITHIN)


def press_by_two_people(bench: Bench) -> None:
    for by in TWO_PEOPLE:
        bench.press_stop(by=by)


def release_one_and_begin_anew(bench: Bench) -> None:
    """End the first stop while the second is in force, and let somebody try to drive."""
    first, second = TWO_PEOPLE

    def released() -> bool:
        status = bench.status
        stops = {stop.by: stop.id for stop in status.stops} if status else {}
        if first in stops:
            bench.release(stops[first])
        return set(stops) == {second}

    bench.until(released, ANSWERED_WITHIN)
    bench.meanwhile(here(bench, bench.join()))


FAULTS = (
    Fault("stop pressed", press, 0.03),
    Fault("stop pressed at three places", press_at_three_places, 0.03, before=go_to_three_places),
    Fault("of two stops one is released", press_by_two_people, 0.03, afterwards=release_one_and_begin_anew),
    Fault("stop released under a held key", press, 0.03, afterwards=release),
)
