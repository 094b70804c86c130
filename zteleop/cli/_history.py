"""What was said on a topic before anybody here listened, asked of its robot's black box."""

from collections import Counter
from collections.abc import Iterator

from zteleop.bus import clock
from zteleop.bus.names import Name
from zteleop.bus.service import ANSWERED_WITHIN, call
from zteleop.bus.session import Sample, Session
from zteleop.errors import BusError
from zteleop.messages import GetHistoryRequest, GetHistoryResponse, Said
from zteleop.nodes.history import SERVICE
from zteleop.recording.ring import SECONDS

OVERLAP = 0.2
"""s after the answer in which what waits to be heard may be what was answered"""


class History:
    """What was said on a topic in the last seconds; made once the topic is heard, so that nothing is missed.

    Raises BusError where nobody answers.
    """

    def __init__(self, session: Session, name: Name, seconds: float) -> None:
        if seconds > SECONDS:
            raise BusError(f"a black box keeps {SECONDS:g} s, found {seconds:g}")
        began = clock.now()
        found = list(_ask(session, name, seconds))
        self._ended = clock.now()
        self.samples = [_sample(name.robot, said) for said in found]
        """the oldest first"""
        newest = found[-1].at if found else 0.0
        late = (_sample(name.robot, said) for said in found if said.at > newest - (self._ended - began))
        self._twice = Counter(late)

    def holds(self, sample: Sample, now: float) -> bool:
        """Say whether what is heard only now was answered already; each once."""
        heard = sample._replace(attachment=None)
        if now - self._ended > OVERLAP or not self._twice[heard]:
            return False
        self._twice[heard] -= 1
        return True


def _sample(robot: str, said: Said) -> Sample:
    return Sample(f"robot/{robot}/{said.path}", said.payload, said.encoding)


def _ask(session: Session, name: Name, seconds: float) -> Iterator[Said]:
    service = Name(name.robot, SERVICE)
    after, had, more = 0.0, 0, True
    while more:
        request = GetHistoryRequest(name.path, seconds, after, had)
        response = call(session, service, request, GetHistoryResponse, ANSWERED_WITHIN)
        for said in response.messages:
            had = had + 1 if said.at == after else 1
            after = said.at
            yield said
        more = response.more and bool(response.messages)
